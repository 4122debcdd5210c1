//! The labs in the report of one mesh: orders, growth and why.

use std::num::NonZeroU32;
use std::path::Path;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};

use sixfold::UnknownName;
use sixfold_results::{Finding, Results};
use sixfold_study::{GrowthSettings, Operation, Settings, StudyMesh, Timing, WhySettings};

use super::folder::Folder;
use crate::failure::Failure;
use crate::launches::{self, Launching, Part};
use crate::measure::with_command;
use crate::progress::Bar;
use crate::text::{TextOutput, print_notice, sanitize, take_notices};
use crate::{growth, orders, why};

sixfold_core::named! {
    pub(crate) enum Lab: "lab" {
        /// The mesh in several orders, as in `sixfold orders`.
        Orders = "orders",
        /// A shape in several sizes, as in `sixfold growth`.
        Growth = "growth",
        /// The reads of queries, as in `sixfold why`.
        Why = "why",
    }
}

#[derive(Clone, Debug)]
pub(crate) struct LabSelection(Vec<Lab>);

impl FromStr for LabSelection {
    type Err = UnknownName;

    /// Parses `all`, `none`, or names separated by commas.
    fn from_str(text: &str) -> Result<Self, UnknownName> {
        let labs = match text.trim() {
            "all" => Lab::ALL.into(),
            "none" => Vec::new(),
            names => names.split(',').map(str::parse).collect::<Result<_, _>>()?,
        };
        Ok(Self(labs))
    }
}

/// Returns the labs of the report: the selected labs, or all labs by default. A report on several
/// meshes has no labs.
pub(super) fn selected_labs(
    selection: Option<&LabSelection>,
    single: bool,
) -> Result<Vec<Lab>, Failure> {
    match (selection, single) {
        (Some(LabSelection(labs)), false) if !labs.is_empty() => Err(Failure::usage(
            "--labs is for the report of one mesh: use `sixfold orders`, `growth` and `why` instead",
        )),
        (_, false) => Ok(Vec::new()),
        (Some(LabSelection(labs)), true) => Ok(labs.clone()),
        (None, true) => Ok(Lab::ALL.into()),
    }
}

/// Measures labs. The fields are the shared input of all labs.
pub(super) struct LabRunner<'a> {
    pub(super) study_mesh: &'a StudyMesh,
    /// The settings of the command. The effort is that of all launches of a lab.
    pub(super) settings: &'a Settings,
    /// The number of launches of each lab; `None` for as many as its time holds.
    pub(super) launches: Option<NonZeroU32>,
    /// The file of the mesh.
    pub(super) path: Option<&'a Path>,
    pub(super) stop: &'a AtomicBool,
}

/// Where the findings of labs are kept.
pub(super) struct Kept<'a> {
    pub(super) folder: &'a Folder,
    /// True if an earlier run finished the study. The folder then has results of the same mesh and
    /// settings.
    pub(super) resumed: bool,
    pub(super) triangulate: bool,
}

impl LabRunner<'_> {
    /// Measures the labs that are not in the folder, and adds their findings. A lab that fails is
    /// reported and left out. A lab that cannot be saved is still added; the first error of saving
    /// is returned at the end.
    pub(super) fn run(
        &self,
        selected: &[Lab],
        kept: &Kept<'_>,
        results: &mut Results,
    ) -> Result<(), Failure> {
        let mut written = Ok(());
        for (i, &lab) in selected.iter().enumerate() {
            let saved = match kept.resumed {
                true => kept.folder.load_lab(lab.name()),
                false => None,
            };
            if let Some(saved) = saved {
                results.add_notices(saved.notices);
                saved
                    .findings
                    .into_iter()
                    .for_each(|saved| results.add(saved));
                continue;
            }
            if self.stop.load(Ordering::Relaxed) {
                continue;
            }
            let bar = Bar::after(&format!("{} of {}: ", i + 2, selected.len() + 1));
            match self.measure(lab, &bar) {
                Ok(Some(finding)) => {
                    let mut document = Results::from(with_command(finding, kept.triangulate));
                    document.notices = take_notices();
                    if !self.stop.load(Ordering::Relaxed) {
                        written = written.and(kept.folder.save_lab(lab.name(), &document));
                    }
                    results.add_notices(document.notices);
                    document
                        .findings
                        .into_iter()
                        .for_each(|new| results.add(new));
                }
                Ok(None) => print_notice(&format!(
                    "note: the report is without {}: none of the selected operations is a relation",
                    lab.name()
                )),
                Err(failure) => print_notice(&format!(
                    "note: the report is without {}: {}",
                    lab.name(),
                    failure.message
                )),
            }
        }
        written
    }

    /// Measures a lab, in this process or in several launches. Returns `None` if none of the operations belongs to
    /// the lab.
    pub(super) fn measure(&self, lab: Lab, bar: &Bar) -> Result<Option<Finding>, Failure> {
        let Settings {
            backends,
            operations,
            effort,
            confidence,
            seed,
            heap,
            caches,
            ..
        } = self.settings;
        let whole = Settings {
            backends: backends.clone(),
            operations: operations.clone(),
            effort: *effort,
            confidence: *confidence,
            seed: *seed,
            heap: *heap,
            caches: *caches,
            ..Settings::default()
        };
        let launching = Launching {
            wanted: self.launches,
            paths: self.path.into_iter().collect(),
            part: Some(Part::Lab(lab.name().to_owned())),
            stop: self.stop,
            pool: sixfold_study::pool_launches,
        };
        let effort = launches::effort(*effort);
        Ok(match lab {
            Lab::Orders => {
                let settings = Settings { effort, ..whole };
                let orders = orders::measure(self.study_mesh, &settings, &launching, bar)?;
                Some(orders.into())
            }
            Lab::Growth => {
                // All launches have the same sizes, which follow from the time of the whole lab.
                let mut settings = GrowthSettings::from_study(whole);
                settings.study.effort = effort;
                Some(growth::measure(&settings, &launching, bar)?.into())
            }
            Lab::Why => {
                let relations = operations.iter().filter_map(|operation| match operation {
                    Operation::Relation(relation) => Some(*relation),
                    _ => None,
                });
                let timing = Timing {
                    effort,
                    seed: *seed,
                    confidence: *confidence,
                };
                let settings = WhySettings {
                    backends: backends.clone(),
                    relations: relations.collect(),
                    timing: Some(timing),
                    ..WhySettings::default()
                };
                if settings.relations.is_empty() && !operations.is_empty() {
                    return Ok(None);
                }
                Some(why::measure(self.study_mesh, &settings, &launching, bar)?.into())
            }
        })
    }
}

pub(super) fn print(results: &Results, text: &mut TextOutput) {
    let orders = results.orders().map(|orders| {
        let title = format!("Effect of the order of {}", sanitize(&orders.mesh.name));
        (title, &orders.sentences)
    });
    let growth = results.growth().map(|growth| {
        (
            format!("How costs grow: {}", growth.shape),
            &growth.sentences,
        )
    });
    for (title, sentences) in orders.chain(growth) {
        text.print_line("");
        text.print_line(&title);
        text.print_list("- ", sentences);
    }
}

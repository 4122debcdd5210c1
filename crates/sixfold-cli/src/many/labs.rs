//! The labs in the report of one mesh besides its study: orders, growth and why.

use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_study::unknown;
use sixfold_study::{GrowthSettings, Labs, Operation, Results, Settings, Specimen, WhySettings};

use super::folder::Folder;
use crate::failure::Failure;
use crate::text::{Text, complain, hanging, tame};
use crate::{growth, orders, why};

/// A lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lab {
    /// The mesh in several orders, as measured by `sixfold orders`.
    Orders,
    /// A shape in several sizes, as measured by `sixfold growth`.
    Growth,
    /// The reads of queries, as counted by `sixfold why`.
    Why,
}

impl Lab {
    const ALL: [Self; 3] = [Self::Orders, Self::Growth, Self::Why];

    const fn name(self) -> &'static str {
        match self {
            Self::Orders => "orders",
            Self::Growth => "growth",
            Self::Why => "why",
        }
    }
}

/// The labs selected by `--labs`.
#[derive(Clone, Debug)]
pub(crate) struct Chosen(Vec<Lab>);

impl FromStr for Chosen {
    type Err = String;

    /// Parses `all`, `none`, or names separated by commas.
    fn from_str(text: &str) -> Result<Self, String> {
        let named = |name: &str| {
            let lab = Lab::ALL.into_iter().find(|lab| lab.name() == name.trim());
            lab.ok_or_else(|| unknown("lab", name.trim(), &Lab::ALL.map(Lab::name)))
        };
        let labs = match text.trim() {
            "all" => Lab::ALL.into(),
            "none" => Vec::new(),
            names => names.split(',').map(named).collect::<Result<_, _>>()?,
        };
        Ok(Self(labs))
    }
}

/// Returns the labs of the report: the selected ones, or all by default. Several meshes have no
/// labs.
pub(super) fn wanted(chosen: Option<&Chosen>, single: bool) -> Result<Vec<Lab>, Failure> {
    match (chosen, single) {
        (Some(Chosen(labs)), false) if !labs.is_empty() => Err(Failure::usage(
            "--labs is for the report of one mesh: use `sixfold orders`, `growth` and `why` instead",
        )),
        (_, false) => Ok(Vec::new()),
        (Some(Chosen(labs)), true) => Ok(labs.clone()),
        (None, true) => Ok(Lab::ALL.into()),
    }
}

/// The input of the labs.
pub(super) struct Measuring<'a> {
    pub(super) specimen: &'a Specimen,
    pub(super) settings: &'a Settings,
    pub(super) folder: &'a Folder,
    /// The study was finished by an earlier run: the folder has results of the same mesh and
    /// settings.
    pub(super) resumed: bool,
    pub(super) stop: &'a AtomicBool,
}

impl Measuring<'_> {
    /// Measures the labs that are not in the folder yet. A lab that cannot be measured is reported
    /// and left out.
    pub(super) fn labs(&self, wanted: &[Lab]) -> Result<Labs, Failure> {
        let mut labs = Labs::default();
        for &lab in wanted {
            let known = match self.resumed {
                true => self.folder.lab(lab.name()),
                false => None,
            };
            if known.is_none() && self.stop.load(Ordering::Relaxed) {
                continue;
            }
            let found = match known {
                Some(known) => Ok(Some(known)),
                None => self.measured(lab),
            };
            match found {
                Ok(Some(results)) => {
                    if !self.stop.load(Ordering::Relaxed) {
                        self.folder.keep_lab(lab.name(), &results)?;
                    }
                    labs.take(results);
                }
                Ok(None) => complain(&format!(
                    "note: the report is without {}: none of the selected operations is a relation",
                    lab.name()
                )),
                Err(failure) => complain(&format!(
                    "note: the report is without {}: {}",
                    lab.name(),
                    failure.message
                )),
            }
        }
        Ok(labs)
    }

    fn measured(&self, lab: Lab) -> Result<Option<Results>, Failure> {
        let Settings {
            backends,
            operations,
            budget,
            seed,
            heap,
            caches,
            ..
        } = self.settings;
        let settings = || Settings {
            backends: backends.clone(),
            operations: operations.clone(),
            budget: *budget,
            seed: *seed,
            heap: *heap,
            caches: *caches,
            ..Settings::default()
        };
        Ok(match lab {
            Lab::Orders => {
                let orders = orders::measured(self.specimen, &settings(), self.stop)?;
                Some(Results::Orders(orders.into()))
            }
            Lab::Growth => {
                let settings = GrowthSettings::within(settings());
                let growth = growth::measured(&settings, self.stop)?;
                Some(Results::Growth(growth.into()))
            }
            Lab::Why => {
                let relations = operations.iter().filter_map(|operation| match operation {
                    Operation::Relation(relation) => Some(*relation),
                    _ => None,
                });
                let settings = WhySettings {
                    backends: backends.clone(),
                    relations: relations.collect(),
                    ..WhySettings::default()
                };
                if settings.relations.is_empty() && !operations.is_empty() {
                    return Ok(None);
                }
                let why = why::measured(self.specimen, settings, Some(*budget), self.stop)?;
                Some(Results::Why(why.into()))
            }
        })
    }
}

/// Prints the findings of the labs; the report has the rest.
pub(super) fn print(labs: &Labs, text: &mut Text) {
    let orders = { labs.orders.iter() }.map(|orders| {
        let title = format!("Effect of the order of {}", tame(&orders.mesh.name));
        (title, &orders.words)
    });
    let growth = { labs.growth.iter() }
        .map(|growth| (format!("How costs grow: {}", growth.shape), &growth.words));
    for (title, words) in orders.chain(growth) {
        text.say("");
        text.say(&title);
        for words in words {
            text.say(&hanging("- ", words));
        }
    }
}

//! Named baselines: results with which later ones are compared. A baseline is the file `.sixfold/NAME.json`, a
//! document as `--json` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use sixfold_results::{CompareSettings, Results, compare};

use crate::arguments::ResultFiles;
use crate::compare::print;
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::shown;
use crate::output::{Output, cannot_write};
use crate::text::{TextOutput, print_notice};

const FOLDER: &str = ".sixfold";

/// The baselines of a command.
#[derive(Default)]
pub(crate) struct Baselines {
    /// The name of the baseline to compare with, and its results.
    known: Option<(String, Results)>,
    /// The name under which the results are kept.
    save: Option<String>,
}

impl Baselines {
    /// Reads the baseline before the measurement.
    ///
    /// # Errors
    ///
    /// Returns an error if it does not exist or is not a document.
    pub(crate) fn open(files: &ResultFiles) -> Result<Self, Failure> {
        let known = files.baseline.as_ref().map(|name| {
            let path = path_of(name);
            match path.is_file() {
                true => Ok((name.clone(), load::read_results(&path)?)),
                false => Err(Failure::usage(format!(
                    "there is no baseline {name}{}: keep one with --save-baseline {name}",
                    others()
                ))),
            }
        });
        Ok(Self {
            known: known.transpose()?,
            save: files.save_baseline.clone(),
        })
    }

    /// Prints what changed since the baseline.
    pub(crate) fn print_changes(&self, results: &Results, text: &mut TextOutput) {
        let Some((name, before)) = &self.known else {
            return;
        };
        text.print_line("");
        text.print_line(&format!("Compared with the baseline {name}:"));
        match compare(before, results, CompareSettings::default()) {
            Ok(changes) => print(&changes, false, text),
            Err(error) => print_notice(&format!("note: not compared with {name}: {error}")),
        }
    }

    /// Keeps the results, if that was asked for.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be written.
    pub(crate) fn save(&self, results: &Results) -> Result<(), Failure> {
        let Some(name) = &self.save else {
            return Ok(());
        };
        let made = fs::create_dir_all(FOLDER);
        made.map_err(|cause| cannot_write(FOLDER, &cause))?;
        let output = Output::open(&path_of(name))?;
        output.finish(|writer| results.write_json(writer))
    }
}

fn path_of(name: &str) -> PathBuf {
    Path::new(FOLDER).join(format!("{name}.json"))
}

/// Names the baselines that exist.
fn others() -> String {
    let files = fs::read_dir(FOLDER).into_iter().flatten().flatten();
    let names = files.filter_map(|file| {
        let path = file.path();
        let is_document = path.extension().is_some_and(|e| e == "json");
        let stem = path.file_stem().filter(|_| is_document)?;
        Some(shown(Path::new(stem)))
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    match names.is_empty() {
        true => format!(" in {FOLDER}"),
        false => format!(" in {FOLDER}, only {}", names.join(", ")),
    }
}

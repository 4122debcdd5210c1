//! `sixfold merge`: merges documents of results.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use sixfold_results::{Policy, Results};
use sixfold_study::pool_launches;

use super::folder::Folder;
use crate::arguments::Merge;
use crate::failure::Failure;
use crate::listed_folder::ListedFolder;
use crate::load;
use crate::measure::{Session, command_line, exit_code};
use crate::output::check_not_overwritten;
use crate::paper;

pub(crate) fn run(arguments: &Merge) -> Result<ExitCode, Failure> {
    let options = arguments.files.options();
    let folders = [&arguments.report, &arguments.figures];
    if options.iter().all(|(_, path)| path.is_none()) && folders.iter().all(|f| f.is_none()) {
        return Err(Failure::usage(
            "no output given: use --report DIR, --figures DIR, --markdown FILE, or --json FILE (- for standard output)",
        ));
    }
    for place in &arguments.results {
        let file = load::results_path(place);
        check_not_overwritten("the results", &file, &options)?;
    }
    let mut merged = match arguments.repeat {
        true => repeated(&arguments.results)?,
        false => merged(&arguments.results)?,
    };
    let paper = ListedFolder::open_if(arguments.figures.as_ref())?;
    let mut session = Session::open(None::<&Path>, &arguments.files, Policy::System)?;
    super::print_all(&merged, &mut session.text);
    let mut written = session.write(&mut merged);
    if let Some(path) = &arguments.report {
        written = written
            .and(Folder::create(path, arguments.force)?.write_report(&merged, &command_line()));
    }
    let written = written.and(paper::write_if(
        paper.as_ref(),
        &merged,
        &command_line(),
        None,
    ));
    exit_code(written, &merged, false)
}

/// Reads the results in `places`, and pools them as launches of one measurement.
fn repeated(places: &[PathBuf]) -> Result<Results, Failure> {
    let mut launches: Vec<Results> = Vec::new();
    for place in places {
        let results = load::read_results(place)?;
        let checked = launches
            .iter()
            .try_for_each(|earlier| earlier.check_repeats(&results));
        checked.map_err(|error| {
            let file = load::results_path(place);
            Failure::usage(format!("{}: {error}", file.display()))
        })?;
        launches.push(results);
    }
    pool_launches(launches).map_err(Failure::usage)
}

/// Reads and merges the results in `places`.
pub(super) fn merged(places: &[PathBuf]) -> Result<Results, Failure> {
    let mut merged = Results::default();
    for place in places {
        let results = load::read_results(place)?;
        merged.merge(results).map_err(|error| {
            let file = load::results_path(place);
            Failure::usage(format!("{}: {error}", file.display()))
        })?;
    }
    Ok(merged)
}

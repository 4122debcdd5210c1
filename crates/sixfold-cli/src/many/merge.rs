//! `sixfold merge`: merges the shards of a study of many meshes.

use std::process::ExitCode;

use sixfold_study::Collection;

use super::folder::Folder;
use crate::arguments::Merge;
use crate::failure::Failure;
use crate::load;
use crate::measured::{studies_ended, typed};
use crate::output::{Output, check_kept, is_stdout};
use crate::text::Text;

/// Reads the results of the shards, and writes them as the results of a single run.
pub(crate) fn run(arguments: &Merge) -> Result<ExitCode, Failure> {
    if arguments.json.is_none() && arguments.report.is_none() {
        return Err(Failure::usage(
            "no output given: use --report DIR, or --json FILE (- for standard output)",
        ));
    }
    let mut merged: Option<Collection> = None;
    for place in &arguments.shards {
        let file = load::results_in(place);
        check_kept("a shard", &file, &[("--json", arguments.json.as_ref())])?;
        let shard = load::results(&file, Collection::read_json)?;
        match &mut merged {
            None => merged = Some(shard),
            Some(merged) => merged
                .merge(shard)
                .map_err(|error| Failure::usage(format!("{}: {error}", file.display())))?,
        }
    }
    let Some(merged) = merged else {
        return Err(Failure::usage("name the folders or files to merge"));
    };
    let on_stdout = arguments.json.as_deref().is_some_and(is_stdout);
    let mut text = Text::shown(!on_stdout);
    super::print(&merged, &mut text);
    let mut written = text.finish();
    if let Some(path) = &arguments.json {
        let output = Output::open(path)?;
        written = written.and(output.finish(|writer| merged.write_json(writer)));
    }
    if let Some(path) = &arguments.report {
        written = written.and(Folder::made(path)?.finish(&merged, &typed()));
    }
    studies_ended(written, &merged.studies, merged.labs.mismatches(), false)
}

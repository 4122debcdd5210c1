//! `sixfold merge`: merges the shards of a study of many meshes.

use std::process::ExitCode;

use sixfold_study::Collection;

use super::folder::Folder;
use crate::arguments::Merge;
use crate::failure::Failure;
use crate::load;
use crate::outcome::{command_line, studies_exit_code};
use crate::output::{Output, check_not_overwritten, is_stdout};
use crate::text::TextOutput;

pub(crate) fn run(arguments: &Merge) -> Result<ExitCode, Failure> {
    if arguments.json.is_none() && arguments.report.is_none() {
        return Err(Failure::usage(
            "no output given: use --report DIR, or --json FILE (- for standard output)",
        ));
    }
    let mut merged: Option<Collection> = None;
    for place in &arguments.shards {
        let file = load::results_path(place);
        check_not_overwritten("a shard", &file, &[("--json", arguments.json.as_ref())])?;
        let shard = load::read_results(&file, Collection::read_json)?;
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
    let mut text = TextOutput::new(!on_stdout);
    super::print(&merged, &mut text);
    let mut written = text.finish();
    if let Some(path) = &arguments.json {
        let output = Output::open(path)?;
        written = written.and(output.finish(|writer| merged.write_json(writer)));
    }
    if let Some(path) = &arguments.report {
        written = written.and(Folder::create(path)?.write_report(&merged, &command_line()));
    }
    studies_exit_code(written, &merged.studies, merged.labs.mismatches(), false)
}

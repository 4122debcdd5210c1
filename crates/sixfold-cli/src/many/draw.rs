//! `sixfold report`: draws saved results on one page.

use std::process::ExitCode;

use sixfold_study::{Collection, Results};

use super::folder::Folder;
use crate::arguments::Draw;
use crate::failure::Failure;
use crate::load;
use crate::outcome::command_line;

pub(crate) fn run(arguments: &Draw) -> Result<ExitCode, Failure> {
    let mut collection = Collection::empty();
    for place in &arguments.results {
        let file = load::results_path(place);
        let results = load::read_results(&file, Results::read_json)?;
        collection
            .add(results)
            .map_err(|error| Failure::usage(format!("{}: {error}", file.display())))?;
    }
    Folder::create(&arguments.to)?.write_page(&collection, &command_line())?;
    Ok(ExitCode::SUCCESS)
}

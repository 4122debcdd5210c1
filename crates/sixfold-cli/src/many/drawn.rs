//! `sixfold report`: draws saved results on one page.

use std::process::ExitCode;

use sixfold_study::{Collection, Results};

use super::folder::Folder;
use crate::arguments::Draw;
use crate::failure::Failure;
use crate::load;
use crate::measured::typed;

/// Reads the results and draws them.
pub(crate) fn run(arguments: &Draw) -> Result<ExitCode, Failure> {
    let mut collection = Collection::empty();
    for place in &arguments.results {
        let file = load::results_in(place);
        let results = load::results(&file, Results::read_json)?;
        collection
            .take(results)
            .map_err(|error| Failure::usage(format!("{}: {error}", file.display())))?;
    }
    Folder::made(&arguments.to)?.draw(&collection, &typed())?;
    Ok(ExitCode::SUCCESS)
}

//! `sixfold report`: draws saved results on one page.

use std::process::ExitCode;

use super::folder::Folder;
use super::merge::merged;
use crate::arguments::Draw;
use crate::failure::Failure;
use crate::measure::command_line;

pub(crate) fn run(arguments: &Draw) -> Result<ExitCode, Failure> {
    let results = merged(&arguments.results)?;
    Folder::create(&arguments.to)?.write_page(&results, &command_line())?;
    Ok(ExitCode::SUCCESS)
}

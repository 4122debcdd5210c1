//! `sixfold report`: draws saved results on one page, or as figures for a paper.

use std::process::ExitCode;

use super::folder::Folder;
use super::merge::merged;
use crate::arguments::Draw;
use crate::failure::Failure;
use crate::listed_folder::ListedFolder;
use crate::measure::command_line;
use crate::paper;

pub(crate) fn run(arguments: &Draw) -> Result<ExitCode, Failure> {
    let results = merged(&arguments.results)?;
    let paper = ListedFolder::open_if(arguments.figures.as_ref())?;
    if let Some(to) = &arguments.to {
        Folder::create(to, arguments.force)?.write_page(&results, &command_line())?;
    }
    paper::write_if(paper.as_ref(), &results, &command_line(), arguments.width)?;
    Ok(ExitCode::SUCCESS)
}

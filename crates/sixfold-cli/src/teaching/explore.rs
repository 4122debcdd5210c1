//! `sixfold explore`: writes a page that runs Sixfold itself, and opens it in the browser.

mod page;
mod situation;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use sixfold_core::UnknownName;

use crate::arguments::Explore;
use crate::failure::Failure;
use crate::output::{Output, cannot_write, check_outputs};
use crate::teaching::lessons::LESSONS;
use crate::text::{TextOutput, print_stderr, sanitize};

pub(crate) use page::{COLOURS, LESSONS_DATA, page};
pub(crate) use situation::Situation;

pub(crate) fn run(arguments: &Explore) -> Result<ExitCode, Failure> {
    check_outputs(
        arguments.mesh.as_deref(),
        &[("--output", arguments.output.as_ref())],
    )?;
    let mut situation = match &arguments.mesh {
        Some(path) => Situation::of_file(path)?,
        None => Situation::default(),
    };
    if let Some(name) = &arguments.lesson {
        let mut names = LESSONS.iter().map(|(name, _)| *name);
        if !names.any(|known| known == name) {
            let names = LESSONS.iter().map(|(name, _)| *name);
            return Err(Failure::usage(UnknownName::new("lesson", name, names)));
        }
        situation.open_lesson(name);
    }
    let path = match &arguments.output {
        Some(path) => path.clone(),
        None => temporary()?,
    };
    let output = Output::open(&path)?;
    output.finish(|writer| writer.write_all(page(&situation).as_bytes()))?;
    let mut text = TextOutput::new(true);
    let shown = sanitize(&path.display().to_string());
    text.print_line(&shown);
    text.finish()?;
    if !arguments.no_open {
        open_in_browser(&path);
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns a new file in the folder for temporary files. It stays there, because the browser reads it later.
fn temporary() -> Result<PathBuf, Failure> {
    let mut builder = tempfile::Builder::new();
    let file = builder
        .prefix("sixfold-explorer-")
        .suffix(".html")
        .tempfile();
    let file = file.map_err(|cause| cannot_write("a temporary file", &cause))?;
    let kept = file.into_temp_path().keep();
    kept.map_err(|error| cannot_write("a temporary file", &error.error))
}

fn open_in_browser(path: &Path) {
    if let Err(cause) = open::that_detached(path) {
        print_stderr(&format!(
            "no browser was opened ({cause}): open this file in a browser"
        ));
    }
}

//! `sixfold inspect`: shows facts about a mesh, and the backends that can hold it.

use std::process::ExitCode;

use sixfold_study::Backend;

use crate::arguments::Inspect;
use crate::facts_text::{facts_text, verdicts_text};
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::exit_on_interrupt;
use crate::text::TextOutput;

pub(crate) fn run(arguments: &Inspect) -> Result<ExitCode, Failure> {
    exit_on_interrupt();
    check_outputs(
        Some(&arguments.mesh),
        &[("--json", arguments.json.as_ref())],
    )?;
    let study_mesh = load::study_mesh(&arguments.mesh)?;
    let inspection = sixfold_study::inspect(&study_mesh, &Backend::structures());
    let json = Output::open_if(arguments.json.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    text.print_line(&facts_text(&inspection.mesh));
    text.print_line("");
    text.print_line(&verdicts_text(&inspection.mesh, &inspection.backends));
    // Print the text first, so that it is not lost if writing a file fails.
    let mut done = text.finish();
    if let Some(output) = json {
        done = done.and(output.finish(|writer| inspection.write_json(writer)));
    }
    done?;
    Ok(ExitCode::SUCCESS)
}

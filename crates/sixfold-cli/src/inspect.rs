//! `sixfold inspect`: facts and verdicts.

use std::process::ExitCode;

use crate::arguments::Inspect;
use crate::facts_text::{facts_text, verdicts_text};
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, is_stdout};
use crate::text::Text;

/// Says what the mesh is and who can hold it.
pub(crate) fn run(arguments: &Inspect) -> Result<ExitCode, Failure> {
    let specimen = load::specimen(&arguments.mesh)?;
    let inspection = ::study::inspect(&specimen);
    if let Some(path) = &arguments.json {
        let output = Output::open(path)?;
        output.finish(|writer| inspection.write_json(writer))?;
    }
    let mut text = Text::shown(!arguments.json.as_deref().is_some_and(is_stdout));
    text.say(&facts_text(&inspection.mesh));
    text.say("");
    text.say(&verdicts_text(&inspection.mesh, &inspection.backends));
    Ok(ExitCode::SUCCESS)
}

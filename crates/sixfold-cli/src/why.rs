//! `sixfold why`: explains the time of queries by the memory that they read.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold_study::{
    Budget, MachineClock, MemorySpeed, Policy, Settings, StudyError, StudyMesh, Timing, WhySettings,
};

use crate::arguments::Why;
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::load;
use crate::outcome::{command_line, exit_code, warn_of_debug_build};
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::{Bar, Spinner, interrupt_flag};
use crate::text::{TextOutput, hanging_indent};
use crate::why_text::{legend, memory_text, relation_text, sentence};

/// Prints the text before the files are written, so that the text is not lost if writing fails.
pub(crate) fn run(arguments: &Why) -> Result<ExitCode, Failure> {
    check_outputs(
        arguments.mesh.as_deref(),
        &[("--json", arguments.json.as_ref())],
    )?;
    // Set the handler before the draft is created, so that Ctrl-C always deletes the draft.
    let stop = interrupt_flag(Policy::Kept);
    let json = Output::open_if(arguments.json.as_ref())?;
    let study_mesh = match &arguments.mesh {
        Some(path) => load::for_study(path, false, arguments.triangulate)?,
        None => load::built_in(),
    };
    let budget = match arguments.counts_only {
        true => None,
        false => {
            warn_of_debug_build();
            Some(arguments.budget)
        }
    };
    let settings = WhySettings {
        backends: arguments.backends.clone(),
        relations: arguments.relations.clone(),
        ..WhySettings::default()
    };
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    let chosen = Settings {
        backends: arguments.backends.clone(),
        ..Settings::default()
    };
    print_before_measuring(&study_mesh, &chosen, &mut text);
    let why = measure(&study_mesh, settings, budget, &stop, &Bar::new())?;

    print(&why, !arguments.relations.is_empty(), &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        done = done.and(output.finish(|writer| why.write_json(writer)));
    }
    exit_code(done, why.mismatches(), why.interrupted)
}

/// Counts reads. If there is a `budget`, also measures times.
pub(crate) fn measure(
    study_mesh: &StudyMesh,
    mut settings: WhySettings,
    budget: Option<Duration>,
    stop: &AtomicBool,
    bar: &Bar,
) -> Result<sixfold_study::Why, Failure> {
    settings.timing = budget.and_then(|budget| timing(budget, stop));
    let why = sixfold_study::why(study_mesh, &settings, stop, &mut |at| bar.show(at));
    bar.clear();
    let mut why = why.map_err(|error| match error {
        StudyError::NoneHolds { .. } => Failure::unsupported(error),
        error => Failure::usage(error),
    })?;
    if let Some(environment) = &mut why.environment {
        environment.command = Some(command_line());
    }
    Ok(why)
}

/// Measures the speed of memory. Returns `None` if interrupted.
fn timing(budget: Duration, stop: &AtomicBool) -> Option<Timing> {
    let budget = Budget::start(budget);
    let spinner = Spinner::start("measuring the speed of memory".into());
    let memory = MemorySpeed::measure(&MachineClock::start(), stop);
    spinner.clear();
    Some(Timing {
        budget: budget.left(),
        memory: memory?,
    })
}

fn print(why: &sixfold_study::Why, with_sentences: bool, text: &mut TextOutput) {
    if let Some(buffers) = &why.memory {
        text.print_line("");
        text.print_line(&memory_text(buffers));
    }
    for rows in why
        .rows
        .chunk_by(|a, b| a.reads.relation == b.reads.relation)
    {
        text.print_line("");
        text.print_line(&relation_text(rows, why.memory.is_some()));
        if with_sentences {
            text.print_line("");
            for row in rows {
                text.print_line(&hanging_indent("- ", &sentence(row)));
            }
        }
    }
    text.print_line("");
    text.print_line(&legend(why));
}

//! `sixfold why`: explains the time of queries by the memory that they read.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold_study::{MachineClock, MemorySpeed, Policy, Specimen, StudyError, Timing, WhySettings};

use crate::arguments::Why;
use crate::facts_text::{facts_text, verdicts_text};
use crate::failure::Failure;
use crate::load;
use crate::measured::{ended, tell_of_debug_build, typed};
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Bar, Waiting, interrupt_flag};
use crate::text::{Text, hanging};
use crate::why_text::{legend, memory_text, relation_text, sentence};

/// Counts, measures unless `--counts-only`, and shows the result. Text is printed first, so that it
/// is not lost if a file fails.
pub(crate) fn run(arguments: &Why) -> Result<ExitCode, Failure> {
    check_places(
        arguments.mesh.as_deref(),
        &[("--json", arguments.json.as_ref())],
    )?;
    // Before the draft of the output is opened, so that Ctrl-C cannot leave a draft behind.
    let stop = interrupt_flag(Policy::Kept);
    let json = Output::open_if(arguments.json.as_ref())?;
    let specimen = match &arguments.mesh {
        Some(path) => load::for_study(path, false, arguments.triangulate)?,
        None => load::built_in(),
    };
    let budget = match arguments.counts_only {
        true => None,
        false => {
            tell_of_debug_build();
            Some(arguments.budget)
        }
    };
    let settings = WhySettings {
        backends: arguments.backends.clone(),
        relations: arguments.relations.clone(),
        ..WhySettings::default()
    };
    let why = measured(&specimen, settings, budget, &stop)?;

    let mut text = Text::shown(!arguments.json.as_deref().is_some_and(is_stdout));
    print(&why, !arguments.relations.is_empty(), &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        done = done.and(output.finish(|writer| why.write_json(writer)));
    }
    ended(done, why.mismatches(), why.interrupted)
}

/// Counts reads, and measures times if there is a `budget`.
pub(crate) fn measured(
    specimen: &Specimen,
    mut settings: WhySettings,
    budget: Option<Duration>,
    stop: &AtomicBool,
) -> Result<sixfold_study::Why, Failure> {
    settings.timing = budget.and_then(|budget| timing(budget, stop));
    let bar = Bar::new();
    let why = sixfold_study::why(specimen, &settings, stop, &mut |at| bar.show(at));
    bar.clear();
    let mut why = why.map_err(|error| match error {
        StudyError::NoneHolds { .. } => Failure::unsupported(error),
        error => Failure::usage(error),
    })?;
    if let Some(environment) = &mut why.environment {
        environment.command = Some(typed());
    }
    Ok(why)
}

/// Measures the speed of memory; returns `None` if interrupted.
fn timing(budget: Duration, stop: &AtomicBool) -> Option<Timing> {
    let waiting = Waiting::shown("measuring the speed of memory".into());
    let memory = MemorySpeed::measure(&MachineClock::start(), stop);
    waiting.clear();
    Some(Timing {
        budget,
        memory: memory?,
    })
}

fn print(why: &sixfold_study::Why, sentences: bool, text: &mut Text) {
    text.say(&facts_text(&why.mesh));
    text.say("");
    text.say(&verdicts_text(&why.mesh, &why.backends));
    if let Some(rungs) = &why.memory {
        text.say("");
        text.say(&memory_text(rungs));
    }
    for rows in why
        .rows
        .chunk_by(|a, b| a.reads.relation == b.reads.relation)
    {
        text.say("");
        text.say(&relation_text(rows, why.memory.is_some()));
        if sentences {
            text.say("");
            for row in rows {
                text.say(&hanging("- ", &sentence(row)));
            }
        }
    }
    text.say("");
    text.say(&legend(why));
}

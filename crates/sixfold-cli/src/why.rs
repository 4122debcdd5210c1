//! `sixfold why`: what queries read, and whether that is what they take their time for.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use ::study::{MachineClock, MemorySpeed, Policy, Specimen, StudyError, Timing, WhySettings};

use crate::arguments::Why;
use crate::facts_text::{facts_text, verdicts_text};
use crate::failure::Failure;
use crate::load;
use crate::measured::{ended, tell_of_debug_build, typed};
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Bar, Waiting, interrupt_flag};
use crate::text::{Text, hanging};
use crate::why_text::{legend, memory_text, relation_text, sentence};

/// Counts, measures if asked to, and shows; text first, so that no file that fails can take it along.
pub(crate) fn run(arguments: &Why) -> Result<ExitCode, Failure> {
    check_places(
        arguments.mesh.as_deref(),
        &[("--json", arguments.json.as_ref())],
    )?;
    // Before the draft of the output, so that Ctrl-C can leave none behind.
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

/// Counts, and measures if there is a `budget`.
pub(crate) fn measured(
    specimen: &Specimen,
    mut settings: WhySettings,
    budget: Option<Duration>,
    stop: &AtomicBool,
) -> Result<::study::Why, Failure> {
    settings.timing = budget.and_then(|budget| timing(budget, stop));
    let bar = Bar::new();
    let why = ::study::why(specimen, &settings, stop, &mut |at| bar.show(at));
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

/// Measures the memory; `None` if interrupted meanwhile.
fn timing(budget: Duration, stop: &AtomicBool) -> Option<Timing> {
    let waiting = Waiting::shown("measuring how fast memory is read".into());
    let memory = MemorySpeed::measure(&MachineClock::start(), stop);
    waiting.clear();
    Some(Timing {
        budget,
        memory: memory?,
    })
}

fn print(why: &::study::Why, sentences: bool, text: &mut Text) {
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

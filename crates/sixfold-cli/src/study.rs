//! `sixfold study`: measure and show.

use std::path::PathBuf;
use std::process::ExitCode;

use ::study::{Environment, Operation, Report, Settings, StudyError};

use crate::arguments::{STUDY_EXAMPLES, Study};
use crate::facts_text::{facts_text, verdicts_text};
use crate::failure::Failure;
use crate::load;
use crate::numbers::counted;
use crate::output::{Output, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::results_table::results_table;
use crate::text::{Text, complain, hanging};

/// The study found that backends disagree.
const MISMATCH: u8 = 1;
/// The study was ended before its time.
const INTERRUPTED: u8 = 4;

/// Measures what was asked for; files first, then text.
pub(crate) fn run(arguments: &Study) -> Result<ExitCode, Failure> {
    check_outputs(arguments)?;
    // Before the drafts of the outputs, so that Ctrl-C can leave none behind.
    let stop = interrupt_flag();
    let json = Output::open_if(arguments.json.as_ref())?;
    let csv = Output::open_if(arguments.csv.as_ref())?;
    let specimen = match &arguments.mesh {
        Some(path) => load::for_study(path, arguments.strict, arguments.triangulate)?,
        None => load::built_in(),
    };
    let settings = Settings {
        backends: arguments.backends.clone(),
        extra: Vec::new(),
        operations: arguments.operations.clone(),
        budget: arguments.budget,
        seed: arguments.seed,
    };
    if cfg!(debug_assertions) {
        complain("note: this is a debug build, and its times mean nothing: build with --release");
    }
    let bar = Bar::new();
    let report = ::study::study(&specimen, &settings, &stop, &mut |at| bar.show(at));
    bar.clear();
    let report = report.map_err(failure)?;

    if let Some(output) = json {
        output.finish(|writer| report.write_json(writer))?;
    }
    if let Some(output) = csv {
        output.finish(|writer| report.write_csv(writer))?;
    }
    let data = [&arguments.json, &arguments.csv];
    let data_on_stdout = data.into_iter().flatten().any(|path| is_stdout(path));
    let mut text = Text::shown(!data_on_stdout);
    print(&report, &mut text);

    let mismatches = report.mismatches().count();
    if mismatches > 0 {
        let results = counted(mismatches, "result differs", "results differ");
        complain(&format!(
            "error: {results} from those of other backends for the same work: a fault in Sixfold, please report it"
        ));
        return Ok(ExitCode::from(MISMATCH));
    }
    if report.interrupted {
        complain("interrupted: what was finished is kept");
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}

/// What help says after the options: examples, how it measures, and the names that there are.
pub(crate) fn help() -> String {
    let backends = sixfold::roster();
    let backends: Vec<&str> = backends.iter().map(|backend| backend.name).collect();
    let operations = Operation::ALL.map(Operation::name).join(", ");
    let backends = hanging("Backends:    ", &backends.join(", "));
    let operations = hanging("Operations:  ", &operations);
    format!("{STUDY_EXAMPLES}\n\n{backends}\n{operations}")
}

/// Refuses two outputs to one place.
fn check_outputs(arguments: &Study) -> Result<(), Failure> {
    let same = |a: &PathBuf, b: &PathBuf| a == b;
    match (&arguments.json, &arguments.csv) {
        (Some(json), Some(csv)) if same(json, csv) => {
            let place = json.display();
            Err(Failure::usage(format!(
                "--json and --csv both write to {place}: name two places"
            )))
        }
        _ => Ok(()),
    }
}

fn failure(error: StudyError) -> Failure {
    match error {
        StudyError::NoneHolds { .. } => Failure::unsupported(error),
        _ => Failure::usage(error),
    }
}

fn print(report: &Report, text: &mut Text) {
    text.say(&facts_text(&report.mesh));
    text.say("");
    text.say(&verdicts_text(&report.mesh, &report.backends));
    text.say("");
    text.say(&results_table(report, text.bold()));
    text.say("");
    for words in &report.words {
        text.say(&hanging("- ", words));
    }
    text.say("");
    text.say(&hanging("", &setting(report)));
}

/// How and where it was measured, in a line.
fn setting(report: &Report) -> String {
    let Environment {
        rustc,
        profile,
        cpu_model,
        cores,
        load_average,
        clock,
        seed,
        ..
    } = &report.environment;
    let rustc = rustc.split(" (").next().unwrap_or_default();
    let mut parts = Vec::new();
    parts.extend(cpu_model.clone());
    parts.extend(cores.map(|cores| counted(cores, "core", "cores")));
    parts.extend(load_average.map(|load| format!("load {load:.2} at the start")));
    parts.push(format!("{rustc}, {profile}"));
    parts.push(match clock.as_str() {
        "thread-cpu" => "processor time of the thread".into(),
        _ => "wall time".into(),
    });
    let most = report.results.iter().map(|row| row.samples).max();
    let rounds = counted(most.unwrap_or(0), "round", "rounds");
    parts.push(format!("medians of up to {rounds}"));
    parts.push(format!("seed {seed}"));
    parts.join("; ") + "."
}

//! `sixfold study`: measures operations on every backend and shows the result.

use std::path::PathBuf;
use std::process::ExitCode;

use sixfold_study::{
    BackendReport, Environment, Operation, Report, SCHEMA, Settings, StudyError, StudyMesh, Timer,
};

use crate::arguments::{STUDY_EXAMPLES, Study};
use crate::facts_text::{print_before_measuring, verdicts_text};
use crate::failure::Failure;
use crate::load;
use crate::many;
use crate::outcome::{command_line, studies_exit_code, warn_of_debug_build};
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::results_table::{left_out_notes, results_table};
use crate::text::{TextOutput, hanging_indent};
use sixfold_study::numbers::counted;

/// Prints the text before the files are written, so that it is not lost if writing a file fails.
pub(crate) fn run(arguments: &Study) -> Result<ExitCode, Failure> {
    let settings = Settings {
        backends: arguments.backends.clone(),
        externals: arguments.externals.clone(),
        external_timeout: arguments.patience,
        operations: arguments.operations.clone(),
        budget: arguments.budget.unwrap_or(Settings::default().budget),
        seed: arguments.seed,
        heap: arguments.memory.heap,
        caches: arguments.memory.caches,
        ..Settings::default()
    };
    let several = arguments.meshes.len() > 1 || arguments.meshes.iter().any(|path| path.is_dir());
    if several || arguments.report.is_some() {
        return many::run(arguments, &settings);
    }
    let mesh = arguments.meshes.first();
    check_outputs(
        mesh.map(PathBuf::as_path),
        &[
            ("--json", arguments.json.as_ref()),
            ("--csv", arguments.csv.as_ref()),
        ],
    )?;
    // Set the handler before the drafts are created, so that Ctrl-C always deletes the drafts.
    let stop = interrupt_flag(settings.heap);
    let json = Output::open_if(arguments.json.as_ref())?;
    let csv = Output::open_if(arguments.csv.as_ref())?;
    let study_mesh = match mesh {
        Some(path) => load::for_study(path, arguments.strict, arguments.triangulate)?,
        None => load::built_in(),
    };
    warn_of_debug_build();
    let data = [&arguments.json, &arguments.csv];
    let data_on_stdout = data.into_iter().flatten().any(|path| is_stdout(path));
    let mut text = TextOutput::new(!data_on_stdout);
    print_before_measuring(&study_mesh, &settings, &mut text);
    let bar = Bar::new();
    let report = sixfold_study::study(&study_mesh, &settings, &stop, &mut |at| bar.show(at));
    bar.clear();
    let report = match report {
        Ok(mut report) => {
            report.environment.command = Some(command_line());
            report
        }
        // If every backend refuses the mesh, the list of reasons is the result.
        Err(error @ StudyError::NoneHolds { .. }) => {
            let refusals = refusals(&study_mesh, &settings)?;
            write_files(&refusals, json, csv)?;
            return Err(Failure::unsupported(error));
        }
        Err(error) => return Err(Failure::usage(error)),
    };

    print(&report, &mut text);
    let done = text.finish().and(write_files(&report, json, csv));

    studies_exit_code(done, [&report], 0, report.interrupted)
}

/// Returns the help text after the options.
pub(crate) fn help() -> String {
    format!("{STUDY_EXAMPLES}\n\n{}", name_lists())
}

pub(crate) fn name_lists() -> String {
    let backends = sixfold::structure_infos();
    let backends: Vec<&str> = backends.iter().map(|backend| backend.name).collect();
    let operations = Operation::ALL.map(Operation::name).join(", ");
    let backends = hanging_indent("Backends:    ", &backends.join(", "));
    let operations = hanging_indent("Operations:  ", &operations);
    format!("{backends}\n{operations}")
}

/// Writes the selected files. If the first file fails, writes the second file anyway.
pub(crate) fn write_files(
    report: &Report,
    json: Option<Output>,
    csv: Option<Output>,
) -> Result<(), Failure> {
    let mut done = Ok(());
    if let Some(output) = json {
        done = done.and(output.finish(|writer| report.write_json(writer)));
    }
    if let Some(output) = csv {
        done = done.and(output.finish(|writer| report.write_csv(writer)));
    }
    done
}

/// Returns the report on a mesh that every selected backend refuses.
fn refusals(study_mesh: &StudyMesh, settings: &Settings) -> Result<Report, Failure> {
    let selected = settings.chosen_backends().map_err(Failure::usage)?;
    let inspection = sixfold_study::inspect(study_mesh, &selected);
    Ok(Report {
        schema: SCHEMA,
        mesh: inspection.mesh,
        backends: inspection.backends,
        results: Vec::new(),
        refusals: Vec::new(),
        control: None,
        sentences: Vec::new(),
        warnings: Vec::new(),
        raw: Vec::new(),
        timer: None,
        interrupted: false,
        environment: Environment::detect(settings.seed, settings.budget.as_secs_f64()),
    })
}

/// Prints the results, which follow [`print_before_measuring`]. External programs say only when they
/// run whether they can hold the mesh.
pub(crate) fn print(report: &Report, text: &mut TextOutput) {
    let programs = report.backends.iter().filter(|b| b.external.is_some());
    let programs: Vec<BackendReport> = programs.cloned().collect();
    if !programs.is_empty() {
        text.print_line(&verdicts_text(&report.mesh, &programs));
    }
    text.print_line("");
    text.print_line(&results_table(report, text.bold()));
    text.print_line("");
    for sentence in &report.sentences {
        text.print_line(&hanging_indent("- ", sentence));
    }
    for warning in &report.warnings {
        text.print_line(&hanging_indent("! ", warning));
    }
    for note in left_out_notes(report) {
        text.print_line(&hanging_indent("", &note));
    }
    text.print_line("");
    let most = report.results.iter().map(|row| row.samples).max();
    let settings = describe_environment(&report.environment, most.unwrap_or(0));
    text.print_line(&hanging_indent("", &settings));
    if let Some(timer) = report.timer {
        text.print_line(&hanging_indent("", &clock_text(timer)));
    }
}

fn clock_text(timer: Timer) -> String {
    let error = timer.largest_share.map_or("unknown".into(), |share| {
        format!("at most {:.2} % of the shortest sample", 100.0 * share)
    });
    format!(
        "Reading the clock takes {:.0} ns. This time is subtracted; the remaining error is \
         {error}.",
        timer.overhead_ns
    )
}

/// Describes the machine and the settings in one line.
pub(crate) fn describe_environment(environment: &Environment, most_rounds: usize) -> String {
    let Environment {
        rustc,
        profile,
        cpu_model,
        cores,
        load_average,
        clock,
        seed,
        ..
    } = environment;
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
    parts.extend(environment.memory_phrases());
    let rounds = counted(most_rounds, "round", "rounds");
    parts.push(format!("medians of up to {rounds}"));
    parts.push(format!("seed {seed}"));
    parts.join("; ") + "."
}

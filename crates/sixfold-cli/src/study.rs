//! `sixfold study`: measures operations on every backend and shows the result.

use std::path::Path;
use std::process::ExitCode;

use sixfold_results::{BackendReport, Environment, Finding, Report, Run, Timer};
use sixfold_study::{Operation, Progress, Settings, StudyError, StudyMesh};

use crate::arguments::{STUDY_EXAMPLES, Study};
use crate::facts_text::{print_before_measuring, verdicts_text};
use crate::failure::Failure;
use crate::launches::{self, Launch, Launching, Part, Work, chosen};
use crate::left_out::left_out_notes;
use crate::listed_folder::ListedFolder;
use crate::load;
use crate::many;
use crate::measure::{Session, command_line, measured_code, warn_of_debug_build, with_command};
use crate::paper;
use crate::progress::Bar;
use crate::results_table::results_table;
use crate::text::{TextOutput, hanging_indent};
use sixfold_results::numbers::counted;

pub(crate) fn run(arguments: &Study) -> Result<ExitCode, Failure> {
    let launch = Launch::current();
    let settings = Settings {
        backends: arguments.backends.clone(),
        externals: arguments.externals.clone(),
        external_timeout: arguments.external_timeout,
        operations: arguments.operations.selected(),
        force: arguments.force,
        warm_up: arguments.warmup,
        confidence: arguments.launching.confidence,
        effort: launches::effort(arguments.effort(1)),
        seed: launches::seed(arguments.seed),
        heap: arguments.memory.heap,
        caches: arguments.memory.caches,
        ..Settings::default()
    };
    if arguments.list {
        return list(&settings.operations);
    }
    let several = arguments.meshes.len() > 1 || arguments.meshes.iter().any(|path| path.is_dir());
    if (several || arguments.report.is_some()) && launch.is_none() {
        return many::run(arguments, &settings);
    }
    let found = match launch.and_then(|launch| launch.part.as_ref()) {
        Some(Part::Mesh(name)) => many::find_mesh(&arguments.meshes, name)?,
        Some(Part::Lab(lab)) => {
            let lab = lab.parse().map_err(Failure::usage)?;
            return many::run_lab(arguments, &settings, lab);
        }
        None => arguments.meshes.first().cloned(),
    };
    let mesh = found.as_deref();
    let figures = arguments.figures.as_ref().filter(|_| launch.is_none());
    let paper = ListedFolder::open_if(figures)?;
    let studied = run_single(arguments, &settings, mesh, paper.as_ref());
    if let (Err(_), Some(paper)) = (&studied, &paper) {
        paper.remove_if_empty();
    }
    studied
}

/// Prints the names of the selected operations, or of all.
fn list(selected: &[Operation]) -> Result<ExitCode, Failure> {
    let mut text = TextOutput::new(true);
    for operation in Operation::ALL {
        if selected.is_empty() || selected.contains(&operation) {
            text.print_line(operation.name());
        }
    }
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Studies one mesh, or the built-in mesh.
fn run_single(
    arguments: &Study,
    settings: &Settings,
    mesh: Option<&Path>,
    paper: Option<&ListedFolder>,
) -> Result<ExitCode, Failure> {
    let mut session = Session::open(mesh, &arguments.files, settings.heap)?;
    let study_mesh = load::mesh_or_built_in(
        mesh,
        arguments.read,
        arguments.strict,
        arguments.triangulate,
    )?;
    let study_mesh = session.drawn(study_mesh);
    warn_of_debug_build();
    print_before_measuring(&study_mesh, settings, &mut session.text);
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: mesh.into_iter().collect(),
        part: None,
        stop: &session.stop,
        pool: sixfold_study::pool_launches,
    };
    let measured = measure(&study_mesh, settings, &launching, &Bar::new());
    match measured {
        Ok(report) => {
            print(&report, &mut session.text);
            let mut results = finding(report, arguments).into();
            let written = session.write(&mut results);
            let written = written.and(paper::write_if(paper, &results, &command_line(), None));
            let interrupted = results.is_interrupted();
            let keep_going = arguments.launching.keep_going;
            measured_code(written, &results, interrupted, keep_going)
        }
        // If every backend refuses the mesh, the list of reasons is the result.
        Err(failure) if failure.is_unsupported() => {
            let refusals = refusals(&study_mesh, settings)?;
            session.write(&mut finding(refusals, arguments).into())?;
            Err(failure)
        }
        Err(failure) => Err(failure),
    }
}

/// Studies a mesh: in this process, or in several launches, which read it again.
pub(crate) fn measure(
    study_mesh: &StudyMesh,
    settings: &Settings,
    launching: &Launching<'_>,
    bar: &Bar,
) -> Result<Report, Failure> {
    let work = Work::new(
        study_mesh.polygons.face_count(),
        chosen(&settings.operations, Operation::ALL.len()),
        &settings.backends,
    );
    let plan = launching.plan(settings.effort, work)?;
    let meshes = Some(vec![study_mesh.report()]);
    let report = plan.measure(meshes, &|done, what| bar.set(done, what), || {
        let mut show = |at: Progress<'_>| bar.show(at);
        let report = sixfold_study::study(study_mesh, settings, launching.stop, &mut show);
        report.map_err(|error| match error {
            StudyError::NoneHolds { .. } => Failure::unsupported(error),
            error => Failure::usage(error),
        })
    });
    bar.clear();
    report
}

/// Completes a study by the arguments that only the command knows.
pub(crate) fn finding(report: Report, arguments: &Study) -> Finding {
    let mut finding = with_command(report, arguments.triangulate);
    let settings = &mut finding.run_mut().settings;
    settings.strict = arguments.strict;
    settings.reading = arguments.read.given();
    finding
}

/// Returns the help text after the options.
pub(crate) fn help() -> String {
    format!("{STUDY_EXAMPLES}\n\n{}", name_lists())
}

pub(crate) fn name_lists() -> String {
    let backends = sixfold::structure_infos();
    let backends: Vec<&str> = backends.iter().map(|backend| backend.name).collect();
    let backends = hanging_indent("Backends:    ", &backends.join(", "));
    let operations = "Operations:  see `sixfold operations`";
    format!("{backends}\n{operations}")
}

/// Returns the report on a mesh that every selected backend refuses.
fn refusals(study_mesh: &StudyMesh, settings: &Settings) -> Result<Report, Failure> {
    let selected = settings.chosen_backends().map_err(Failure::usage)?;
    let inspection = sixfold_study::inspect(study_mesh, &selected);
    Ok(Report {
        run: sixfold_study::start_run(settings.run_settings()),
        mesh: inspection.mesh,
        backends: inspection.backends,
        ..Report::default()
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
    text.print_answer(&report.sentences, &report.warnings);
    text.print_line(&results_table(report, text.bold()));
    text.print_line("");
    let samples = report.results.iter().map(|row| row.samples);
    let mut notes = report.notes.clone();
    notes.extend(left_out_notes(report));
    print_end(notes, &report.run, samples, text);
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

/// Prints the end of the results: notes, and how the times were measured. `samples` has the number of
/// samples of each time.
pub(crate) fn print_end(
    notes: Vec<String>,
    run: &Run,
    samples: impl Iterator<Item = usize>,
    text: &mut TextOutput,
) {
    for note in &notes {
        // Some notes begin with the sign of the figures that they explain.
        let sign = ["– ", "≥ "].into_iter().find(|sign| note.starts_with(sign));
        let (sign, note) = sign.map_or(("- ", note.as_str()), |sign| (sign, &note[sign.len()..]));
        text.print_list(sign, [note]);
    }
    if !notes.is_empty() {
        text.print_line("");
    }
    text.print_list("", [describe_run(run, samples.max().unwrap_or(0))]);
}

/// Describes the machine and the settings in one line.
pub(crate) fn describe_run(run: &Run, most_rounds: usize) -> String {
    let Environment {
        rustc,
        profile,
        cpu_model,
        cores,
        clock,
        ..
    } = &run.environment;
    let (load_average, seed) = (run.start.load_average, run.settings.seed);
    let rustc = rustc.split(" (").next().unwrap_or_default();
    let mut parts = Vec::new();
    parts.extend(cpu_model.clone());
    parts.extend(cores.map(|cores| counted(cores, "core", "cores")));
    parts.extend(load_average.map(|load| format!("load {load:.2} at the start")));
    parts.push(format!("{rustc}, {profile}"));
    parts.push(clock.words().into());
    parts.extend(run.environment.memory_phrases());
    let rounds = counted(most_rounds, "round", "rounds");
    parts.push(match run.settings.launches {
        None => format!("medians of up to {rounds}"),
        Some(launches) => {
            format!("means over {launches} launches of medians; up to {rounds} in total")
        }
    });
    parts.push(format!("seed {seed}"));
    parts.join("; ") + "."
}

//! `sixfold pick`: finds the backend that fits a mesh and a workload.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use sixfold_results::{Failed, OwnBytes, OwnData, PickReport, Results};
use sixfold_study::{
    ElementKind, Part, PickSettings, Prediction, ProgramSettings, StudyMesh, Workload,
    pool_launches, suite_of_trace,
};

use crate::arguments::Pick;
use crate::failure::Failure;
use crate::launches::{self, Launch, Launching, Work};
use crate::many::find_meshes;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::text::{TextOutput, hanging_indent, print_notice, print_stderr, sanitize};
use crate::workloads::{read_trace, workload};
use sixfold_measure::command::answer::print;
use sixfold_measure::command::load::study_meshes as load_meshes;
use sixfold_results::numbers::{counted, figure, grouped};

/// How much longer than building it takes to prepare a mix on all backends, with copies of the mesh, and to run it once:
/// 4.7 s (remeshing) to 7.8 s (rendering-upload) on 200,000 faces, where a study takes 0.8 s.
const PREPARATION: usize = 4;
/// The exit code if no backend qualifies.
const NONE_QUALIFIES: u8 = 1;

pub(crate) fn run(arguments: &Pick) -> Result<ExitCode, Failure> {
    if let Some(path) = &arguments.trace {
        return run_trace(path, arguments);
    }
    let workload = workload(&arguments.workload)?;
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    let paths = meshes.iter().filter_map(|mesh| mesh.path.as_deref());
    let mut session = Session::open(paths.clone(), &arguments.files, arguments.heap)?;
    let (study_meshes, failed) =
        load_meshes(&meshes, arguments.read.into(), arguments.triangulate)?;
    let drawn = study_meshes.into_iter().map(|mesh| session.drawn(mesh));
    let study_meshes: Vec<StudyMesh> = drawn.collect();
    let settings = PickSettings {
        workload,
        backends: arguments.backends.clone(),
        extra: Vec::new(),
        needs: arguments.needs.clone(),
        max_memory: arguments.max_memory,
        effort: arguments.effort.effort(),
        confidence: arguments.launching.confidence,
        seed: launches::seed(arguments.seed),
        heap: arguments.heap,
    };
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: paths.collect(),
        part: None,
        stop: &session.stop,
        pool: pool_launches,
    };
    let faces = study_meshes.iter().map(|mesh| mesh.polygons.face_count());
    // The operations of the mix are timed together and one by one, and building.
    let timed = settings.workload.mix.len() + 2;
    let mean = faces.sum::<usize>() / study_meshes.len();
    let work = Work::new(PREPARATION * mean, timed, &settings.backends);
    let plan = launching.plan(settings.effort, work.times(study_meshes.len()))?;
    warn_of_debug_build();
    if Launch::current().is_none() {
        print_before_measuring(&study_meshes, &settings, &session.stop, &mut session.text);
    }
    let bar = Bar::new();
    let reports = study_meshes.iter().map(StudyMesh::report).collect();
    let report = plan.measure(Some(reports), &|done, what| bar.set(done, what), || {
        let mut show = |done: f64, what: &str| bar.set(done, what);
        let report = sixfold_study::pick(&study_meshes, &settings, &session.stop, &mut show);
        report.map_err(Failure::usage)
    });
    bar.clear();
    let report: PickReport = report?;
    finish(report, session, failed, arguments)
}

/// Ranks the structures for the calls of a trace.
fn run_trace(path: &Path, arguments: &Pick) -> Result<ExitCode, Failure> {
    let trace = read_trace(path)?;
    let settings = ProgramSettings {
        backends: arguments.backends.clone(),
        runs: 1,
        max_memory: arguments.max_memory,
        effort: arguments.effort.effort(),
        confidence: arguments.launching.confidence,
        seed: launches::seed(arguments.seed),
        heap: arguments.heap,
        isolation: None,
    };
    let suite = suite_of_trace(trace);
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    let paths = meshes.iter().filter_map(|mesh| mesh.path.as_deref());
    let mut session = Session::open(paths.clone(), &arguments.files, settings.heap)?;
    let read = arguments.read.into();
    let (study_meshes, failed) = load_meshes(&meshes, read, arguments.triangulate)?;
    let drawn = study_meshes.into_iter().map(|mesh| session.drawn(mesh));
    let study_meshes: Vec<StudyMesh> = drawn.collect();
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: paths.chain([path]).collect(),
        part: None,
        stop: &session.stop,
        pool: pool_launches,
    };
    let faces = study_meshes.iter().map(|mesh| mesh.polygons.face_count());
    let work = Work {
        faces: faces.sum(),
        entries: None,
        spare_s: 0.0,
    };
    let plan = launching.plan(settings.effort, work)?;
    warn_of_debug_build();
    print_model(&mut session.text, "trace");
    for study_mesh in &study_meshes {
        print_mesh(study_mesh, &mut session.text);
    }
    for program in suite.programs().iter().filter(|p| p.own_ns() != 0.0) {
        let line = format!(
            "{} ns of each run are the program's own work; added to every time",
            figure(program.own_ns())
        );
        session
            .text
            .print_line(&hanging_indent("Trace:    ", &line));
    }
    let bar = Bar::new();
    let reports = study_meshes.iter().map(StudyMesh::report).collect();
    let report = plan.measure(Some(reports), &|done, what| bar.set(done, what), || {
        let mut show = |done: f64, what: &str| bar.set(done, what);
        let stop = &session.stop;
        let reports = sixfold_study::pick_for_programs(
            &study_meshes,
            &suite,
            &settings,
            stop,
            &mut show,
            &mut |_| (),
        );
        let mut reports = reports.map_err(Failure::usage)?.into_iter();
        let none = || Failure::usage("interrupted before the first result");
        reports.next().ok_or_else(none)
    });
    bar.clear();
    let report: PickReport = report?;
    let text = &mut session.text;
    text.print_line("");
    let name = sanitize(&report.workload.name);
    text.print_line(&hanging_indent("Program:  ", &name));
    text.print_line("");
    finish(report, session, failed, arguments)
}

/// Says that the ranking is that of a model. On 48 cases, the structure that a workload or a trace named was within 5 % of the
/// fastest in 45 and 46 of them (reports/validity).
fn print_model(text: &mut TextOutput, model: &str) {
    let line = format!(
        "this {model} stands for a program. The program itself decides: `sixfold new DIR` measures yours, the first \
         time in about two minutes"
    );
    text.print_line(&hanging_indent("Model:    ", &line));
}

fn print_mesh(study_mesh: &StudyMesh, text: &mut TextOutput) {
    let vertices = counted(study_mesh.polygons.vertex_count(), "vertex", "vertices");
    let faces = counted(study_mesh.polygons.face_count(), "face", "faces");
    let line = format!("{}: {vertices}, {faces}", sanitize(&study_mesh.name));
    text.print_line(&hanging_indent("Mesh:     ", &line));
}

/// Prints the answer, writes the files, and returns the exit code.
fn finish(
    report: PickReport,
    mut session: Session,
    failed: Vec<Failed>,
    arguments: &Pick,
) -> Result<ExitCode, Failure> {
    print(&report, &mut session.text);
    let none_qualifies = report.ranking.is_empty() && !report.interrupted;
    let mut results = Results::from(with_command(report, arguments.triangulate));
    results.add_failures(failed);
    let code = session.finish(results, arguments.launching.keep_going)?;
    if none_qualifies {
        print_stderr(
            "error: no backend qualifies: relax --needs, --max-memory or --backends, or repair the \
             mesh (see `sixfold inspect`)",
        );
        return Ok(ExitCode::from(NONE_QUALIFIES));
    }
    Ok(code)
}

/// Describes the program's own data. Returns an empty text if the program has no data of its own.
fn own_data(data: &OwnData) -> String {
    let kinds = ElementKind::ALL.map(|kind| (kind.name(), kind.own_bytes(data)));
    let described = kinds
        .iter()
        .filter(|(_, bytes)| *bytes != OwnBytes::default());
    let described = described.map(|(kind, OwnBytes { read, written })| {
        format!("; {read} bytes read and {written} written of own data at each {kind}")
    });
    described.collect()
}

/// Prints the facts that are known before the measurement: the meshes, the mix, and the backends
/// that qualify. Also prints the predicted costs for the first mesh. Prints nothing if an error
/// follows.
fn print_before_measuring(
    study_meshes: &[StudyMesh],
    settings: &PickSettings,
    stop: &AtomicBool,
    text: &mut TextOutput,
) {
    print_model(text, "workload");
    for study_mesh in study_meshes {
        print_mesh(study_mesh, text);
    }
    let workload = &settings.workload;
    let summary = format!("{}. {}", workload.name, workload.summary);
    text.print_line(&hanging_indent("Workload: ", &sanitize(summary.trim())));
    let weighted = |part: &Part| format!("{} {}", part.weight, part.action);
    let mix: Vec<String> = workload.mix.iter().map(weighted).collect();
    let operations = operations(study_meshes, workload);
    let rebuilt = match workload.rebuilds {
        0 => String::new(),
        times => format!(", rebuilt {}", counted(times as usize, "time", "times")),
    };
    let own = match workload.own_ns {
        0.0 => String::new(),
        ns => format!(
            "; {} ns of the program's own work per operation",
            figure(ns)
        ),
    };
    let own_data = own_data(&workload.own_data);
    let mix = format!(
        "{}; {}; {operations}{rebuilt}{own}{own_data}",
        mix.join(", "),
        workload.access
    );
    text.print_line(&hanging_indent("Mix:      ", &mix));
    let first = study_meshes.first();
    if let Some(Ok(prediction)) = first.map(|mesh| sixfold_study::predict(mesh, settings, stop)) {
        // Several meshes share one mix, so one prediction is enough.
        let of = match study_meshes {
            [first, _, ..] => format!(", on {} only", sanitize(&first.name)),
            _ => String::new(),
        };
        for (name, line) in predicted_lines(&prediction, &of) {
            text.print_line(&hanging_indent(name, &line));
        }
    }
    text.print_line("");
}

/// Returns the number of operations in one use of the mesh, as the mean over the meshes.
fn operations(study_meshes: &[StudyMesh], workload: &Workload) -> String {
    let on = |study_mesh: &StudyMesh| {
        let counts = study_mesh.polygons.counts(study_mesh.facts.edges);
        workload.operations_on(&counts)
    };
    let sum: f64 = study_meshes.iter().map(on).sum();
    let mean = sum / study_meshes.len().max(1) as f64;
    counted(mean.round() as usize, "operation", "operations")
}

/// Returns the prediction in a few lines, each with its title. `of` names the mesh if there are
/// several.
fn predicted_lines(prediction: &Prediction, of: &str) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    let local = || prediction.candidates.iter().filter(|p| p.scans.is_empty());
    let counted = local().map(|p| Some(format!("{} {}", p.backend, figure(p.reads?))));
    let counted: Option<Vec<String>> = counted.collect();
    if let Some(counted) = counted.filter(|counted| !counted.is_empty()) {
        let patch = prediction.patch_faces.map_or(String::new(), |faces| {
            format!(" on a patch of {} faces", grouped(faces))
        });
        let text = format!(
            "{} table rows per operation (counted{patch}{of}, not timed; sorted by rows, then by bytes)",
            counted.join(", ")
        );
        lines.push(("Reads:    ", text));
    }
    let scanning = prediction.candidates.iter().filter(|p| !p.scans.is_empty());
    let scanning: Vec<&str> = scanning.map(|p| p.backend.as_str()).collect();
    if !scanning.is_empty() {
        let verb = if scanning.len() == 1 { "scans" } else { "scan" };
        let text = format!(
            "{} {verb} all faces for each element: expect much longer times",
            scanning.join(", ")
        );
        lines.push(("Scans:    ", text));
    }
    lines
}

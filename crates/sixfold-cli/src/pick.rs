//! `sixfold pick`: finds the backend that fits a mesh and a workload.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use comfy_table::{Cell, CellAlignment};
use sixfold_study::{
    BreakEven, Part, PickReport, PickSettings, Prediction, Ranked, StudyMesh, Workload,
};

use crate::arguments::Pick;
use crate::failure::Failure;
use crate::load;
use crate::many::{Mesh, find_meshes};
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::tables::table;
use crate::text::{TextOutput, hanging_indent, print_stderr, sanitize};
use crate::workloads::workload;
use sixfold_study::numbers::{counted, duration, figure, grouped};

/// The exit code if no backend qualifies.
const NONE_QUALIFIES: u8 = 1;

pub(crate) fn run(arguments: &Pick) -> Result<ExitCode, Failure> {
    let workload = workload(&arguments.workload)?;
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_stderr(note))?;
    let paths = meshes.iter().filter_map(|mesh| mesh.path.as_deref());
    let mut session = Session::open(paths, &arguments.files, arguments.heap)?;
    let study_meshes = study_meshes(&meshes, arguments)?;
    let settings = PickSettings {
        workload,
        backends: arguments.backends.clone(),
        extra: Vec::new(),
        needs: arguments.needs.clone(),
        max_memory: arguments.max_memory,
        budget: arguments.budget,
        seed: arguments.seed,
        heap: arguments.heap,
    };
    warn_of_debug_build();
    print_before_measuring(&study_meshes, &settings, &session.stop, &mut session.text);
    let bar = Bar::new();
    let mut show = |done: f64, what: &str| bar.set(done, what);
    let report = sixfold_study::pick(&study_meshes, &settings, &session.stop, &mut show);
    bar.clear();
    let report = report.map_err(Failure::usage)?;
    print(&report, &mut session.text);
    let none_qualifies = report.ranking.is_empty() && !report.interrupted;
    let code = session.finish(&with_command(report, arguments.triangulate).into())?;
    if none_qualifies {
        print_stderr(
            "error: no backend qualifies: relax --needs, --max-memory or --backends, or repair the \
             mesh (see `sixfold inspect`)",
        );
        return Ok(ExitCode::from(NONE_QUALIFIES));
    }
    Ok(code)
}

fn study_meshes(meshes: &[Mesh], arguments: &Pick) -> Result<Vec<StudyMesh>, Failure> {
    let read = |mesh: &Mesh| match (&mesh.path, &mesh.problem) {
        (Some(path), _) => load::for_study(path, false, arguments.triangulate),
        (None, Some(problem)) => Err(Failure::usage(format!("{}: {problem}", mesh.name))),
        (None, None) => Ok(load::built_in()),
    };
    meshes.iter().map(read).collect()
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
    for study_mesh in study_meshes {
        let vertices = counted(study_mesh.polygons.vertex_count(), "vertex", "vertices");
        let faces = counted(study_mesh.polygons.face_count(), "face", "faces");
        let line = format!("{}: {vertices}, {faces}", sanitize(&study_mesh.name));
        text.print_line(&hanging_indent("Mesh:     ", &line));
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
    let mix = format!(
        "{}; {}; {operations}{rebuilt}",
        mix.join(", "),
        workload.access
    );
    text.print_line(&hanging_indent("Mix:      ", &mix));
    let first = study_meshes.first();
    if let Some(Ok(prediction)) = first.map(|mesh| sixfold_study::predict(mesh, settings, stop)) {
        for (name, line) in predicted_lines(&prediction) {
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

/// Returns the prediction in a few lines, each with its title.
fn predicted_lines(prediction: &Prediction) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    let local = || prediction.candidates.iter().filter(|p| p.scans.is_empty());
    let counted = local().map(|p| Some(format!("{} {}", p.backend, figure(p.lines?))));
    let counted: Option<Vec<String>> = counted.collect();
    if let Some(counted) = counted.filter(|counted| !counted.is_empty()) {
        let text = format!(
            "{} cache lines per operation (counted, not timed)",
            counted.join(", ")
        );
        lines.push(("Reads:    ", text));
    }
    let scanning = prediction.candidates.iter().filter(|p| !p.scans.is_empty());
    let scanning: Vec<&str> = scanning.map(|p| p.backend.as_str()).collect();
    if !scanning.is_empty() {
        let text = format!(
            "{} scan all faces for each element: expect much longer times",
            scanning.join(", ")
        );
        lines.push(("Scans:    ", text));
    }
    for excluded in &prediction.excluded {
        let text = format!("{}: {}", excluded.backend, sanitize(&excluded.reason));
        lines.push(("Excluded: ", text));
    }
    lines
}

/// Prints the results, which follow [`print_before_measuring`].
fn print(report: &PickReport, text: &mut TextOutput) {
    if !report.ranking.is_empty() {
        text.print_line(&ranking(report));
        text.print_line("");
    }
    for sentence in &report.sentences {
        text.print_line(&hanging_indent("- ", sentence));
    }
    for excluded in &report.excluded {
        let line = format!("{} is excluded: {}.", excluded.backend, excluded.reason);
        text.print_line(&hanging_indent("- ", &line));
    }
    for warning in &report.warnings {
        text.print_line(&hanging_indent("! ", warning));
    }
}

/// Returns the table of backends, the fastest first.
fn ranking(report: &PickReport) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let header = [
        "",
        "operation",
        "ratio",
        "interval",
        "1st build",
        "rebuild",
        "B/vertex",
        "pays after",
    ];
    let mut rows = table(header.iter().map(|name| right((*name).into())).collect());
    let mut notes = [false; 4];
    let several_tied = report.ranking.iter().filter(|r| r.tied_with_best).count() > 1;
    for ranked in &report.ranking {
        let mark = match (ranked.estimated, ranked.sampled) {
            (true, _) => "?",
            (_, true) => "~",
            _ => "",
        };
        notes[0] |= ranked.sampled && !ranked.estimated;
        notes[1] |= ranked.estimated;
        notes[2] |= ranked.tied_with_best && several_tied;
        notes[3] |= ranked.tied_with_best && !several_tied;
        let tied = match (ranked.tied_with_best, several_tied) {
            (false, _) => "",
            (true, false) => " *",
            (true, true) => " =",
        };
        let interval = ranked.ci_low.zip(ranked.ci_high);
        let interval = interval.map_or("–".into(), |(low, high)| {
            format!("{} to {}", ratio(low), ratio(high))
        });
        rows.add_row(vec![
            Cell::new(&ranked.backend),
            right(format!("{}{mark}", duration(ranked.ns_per_operation))),
            right(ratio(ranked.ratio_to_best) + tied),
            right(interval),
            right(ranked.first_build_ns.map_or("–".into(), duration)),
            right(duration(ranked.build_ns)),
            right(format!("{:.1}", ranked.bytes_per_vertex)),
            right(pays_after(report, ranked)),
        ]);
    }
    let mut text = rows.trim_fmt();
    let legend = [
        "~ measured on a sample of the elements, because each query scans all faces",
        "? estimated, because a full run would exceed the budget",
        "= tied with the fastest: no measurable difference",
        "* fastest",
    ];
    for (line, _) in legend.into_iter().zip(notes).filter(|(_, note)| *note) {
        text += "\n";
        text += line;
    }
    let tables = report
        .ranking
        .iter()
        .find_map(|ranked| ranked.made_from.as_deref());
    if let Some(over) = tables {
        text += &format!(
            "\nrelation-tables: flat tables of only the relations in the mix, made from {over}"
        );
    }
    text + "\noperation: mean time of an operation of the mix\n\
            ratio: to the time of the fastest, with its 95 % confidence interval\n\
            1st build: time to build on new memory pages\n\
            rebuild: time to build on memory pages that were used before\n\
            pays after: number of operations after which the 1st build and the operations take\n\
            less time than the operations on an indexed face set that is already built"
}

/// Formats a ratio as `1.04`, `12.3` or `1,230`.
fn ratio(ratio: f64) -> String {
    match ratio < 1.0 {
        true => format!("{ratio:.2}"),
        false => figure(ratio),
    }
}

fn pays_after(report: &PickReport, ranked: &Ranked) -> String {
    let row = |row: &&BreakEven| row.backend == ranked.backend;
    match report.break_even.iter().find(row) {
        None => "–".into(),
        Some(BreakEven {
            operations: None, ..
        }) => "never".into(),
        Some(BreakEven {
            operations: Some(operations),
            ..
        }) if *operations < 1e15 => grouped(operations.ceil() as usize),
        Some(_) => "never".into(),
    }
}

//! `sixfold pick`: finds the backend that fits a mesh and a workload.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use sixfold_results::{
    BreakEven, Failed, OwnBytes, OwnData, PickReport, Ranked, Results, Standing,
};
use sixfold_study::{
    ElementKind, Part, PickSettings, Prediction, ProgramSettings, StudyMesh, Suite, Trace, Workload,
};

use crate::arguments::{Pick, ReadFiles};
use crate::column_table::{Column, column_table};
use crate::failure::Failure;
use crate::launches::{self, Launch, Launching, Work};
use crate::load;
use crate::many::{Mesh, find_meshes};
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::programs::{Limits, Measurement, default_memory_limit};
use crate::progress::Bar;
use crate::signs::Signs;
use crate::text::{TextOutput, hanging_indent, print_notice, print_stderr, sanitize};
use crate::workloads::workload;
use sixfold_results::numbers::{approximate, counted, duration, figure, grouped, rounded_down};

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
    let (study_meshes, failed) = study_meshes(&meshes, arguments.read, arguments.triangulate)?;
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

/// Ranks the structures for the calls of a trace.
fn run_trace(path: &Path, arguments: &Pick) -> Result<ExitCode, Failure> {
    let shown = path.display().to_string();
    let cannot_read = |error: std::io::Error| Failure::usage(format!("{shown}: {error}"));
    let file = std::fs::File::open(path).map_err(cannot_read)?;
    let trace = Trace::read(&shown, std::io::BufReader::new(file));
    let mut trace = trace.map_err(Failure::usage)?;
    if trace.program.is_empty() {
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        trace.program = stem.to_string_lossy().into_owned();
    }
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
    let measurement = Measurement {
        suite: &Suite::new().trace(trace),
        settings: &settings,
        meshes: &arguments.meshes,
        read: arguments.read,
        triangulate: arguments.triangulate,
        trace: Some(path),
        launching: arguments.launching,
        files: &arguments.files,
        limits: Limits::new(settings.effort, default_memory_limit()),
    };
    measurement.run()
}

/// Reads the meshes. Without a path, a mesh is the built-in mesh. Of several, those that cannot be read are
/// noted and returned as the second list.
///
/// # Errors
///
/// Fails if no mesh can be read.
pub(crate) fn study_meshes(
    meshes: &[Mesh],
    files: ReadFiles,
    triangulate: bool,
) -> Result<(Vec<StudyMesh>, Vec<Failed>), Failure> {
    let read = |mesh: &Mesh| match (&mesh.path, &mesh.problem) {
        (None, Some(problem)) => Err(Failure::usage(format!("{}: {problem}", mesh.name))),
        (path, _) => load::mesh_or_built_in(path.as_deref(), files, false, triangulate),
    };
    if let [only] = meshes {
        return Ok((vec![read(only)?], Vec::new()));
    }
    let (mut loaded, mut failed) = (Vec::new(), Vec::new());
    for mesh in meshes {
        match read(mesh) {
            Ok(study_mesh) => loaded.push(study_mesh),
            Err(failure) => {
                print_notice(&format!("note: not measured: {}", failure.message));
                failed.push(mesh.not_measured(&failure));
            }
        }
    }
    match loaded.is_empty() {
        true => Err(Failure::usage(
            "none of the meshes can be measured: correct the files that the notes above name",
        )),
        false => Ok((loaded, failed)),
    }
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

/// Prints the results, which follow [`print_before_measuring`].
pub(crate) fn print(report: &PickReport, text: &mut TextOutput) {
    let (answer, reasons) = report.sentences.split_at(report.sentences.len().min(1));
    text.print_answer(answer, &report.warnings);
    if !report.ranking.is_empty() {
        text.print_line(&ranking(report));
        text.print_line("");
    }
    if report.program.is_some() && !report.mismatches.is_empty() {
        text.print_line(&results(report));
        text.print_line("");
    }
    text.print_list("- ", reasons);
    let excluded = report.excluded.iter();
    let excluded = excluded.map(|e| format!("{} is excluded: {}.", e.backend, e.reason));
    text.print_list("- ", excluded);
    if !report.usage.is_empty() {
        text.print_line("\nTo use it in your package:");
        for line in &report.usage {
            text.print_line(&format!("  {line}"));
        }
    }
}

/// Returns the table of the results of a program that differ, each with the part by which it differs from the result
/// of the fastest backend that agrees with the others.
fn results(report: &PickReport) -> String {
    let differs = |ranked: &Ranked| report.mismatches.contains(&ranked.backend);
    let expected = report.ranking.iter().find(|ranked| !differs(ranked));
    // If no two results agree, the others differ from the first.
    let expected = expected.or(report.ranking.first());
    let expected = expected.and_then(|ranked| ranked.result);
    let rows = || report.ranking.iter();
    let names = Column::words("", rows().map(|ranked| ranked.backend.clone()));
    let values = rows().map(|ranked| ranked.result.map_or("–".into(), |x| format!("{x:?}")));
    let apart = rows().map(|ranked| match (ranked.result, expected) {
        (Some(x), Some(expected)) if differs(ranked) && x != expected => {
            format!("{:.1e}", (x - expected).abs() / expected.abs().max(x.abs()))
        }
        _ => String::new(),
    });
    let columns = [
        Column::figures("result", values),
        Column::figures("differs by", apart),
    ];
    column_table(&names, &columns)
}

/// Returns the table of backends, the fastest first, and its legend.
fn ranking(report: &PickReport) -> String {
    let pays_after: Vec<String> = report
        .ranking
        .iter()
        .map(|ranked| pays_after(report, ranked))
        .collect();
    // If one operation, or one run, pays for every build that pays, there is nothing to read.
    let pays_at_once = pays_after
        .iter()
        .all(|after| ["1", "–", "never"].contains(&after.as_str()));
    let mut signs = Signs::new(false);
    let has_winner = report
        .ranking
        .iter()
        .all(|ranked| ranked.estimated || ranked.has_enough_samples());
    let tied = || report.ranking[1..].iter().filter(|r| r.tied_with_best);
    let mut times = Vec::new();
    let mut ratios = Vec::new();
    let is_measured = report.ranking.iter().any(|ranked| !ranked.estimated);
    for (place, ranked) in report.ranking.iter().enumerate() {
        let ratio = ranked.shown_ratio(&report.ranking[0]);
        if ranked.estimated {
            let sign = signs.record('≥');
            let ns = rounded_down(ranked.ns_per_operation);
            times.push(format!("{sign}{}", duration(ns)));
            ratios.push(match is_measured {
                true => format!("{sign}{}", figure(rounded_down(ratio))),
                false => "–".into(),
            });
            continue;
        }
        let sign = match ranked.sampled {
            true => signs.record('~').into(),
            false => String::new(),
        };
        times.push(format!("{sign}{}", duration(ranked.ns_per_operation)));
        // The fastest is as sure as those that it shares the first place with.
        let is_equal = match place {
            0 => tied().all(Ranked::is_equal_to_best),
            _ => ranked.is_equal_to_best(),
        };
        let standing = match ranked.tied_with_best && has_winner {
            false => None,
            true if tied().next().is_none() => Some(Standing::Best),
            true if is_equal => Some(Standing::Equal),
            true => Some(Standing::Undecided),
        };
        ratios.push(format!("{}{}", signs.standing(standing), figure(ratio)));
    }
    let of = |figure: &dyn Fn(&Ranked) -> String| -> Vec<String> {
        report.ranking.iter().map(figure).collect()
    };
    let interval = |ranked: &Ranked| {
        let interval = ranked.ci_low.zip(ranked.ci_high);
        interval.map_or("–".into(), |(low, high)| {
            format!("{}–{}", figure(low), figure(high))
        })
    };
    let first_build = |ranked: &Ranked| ranked.first_build_ns.map_or("–".into(), duration);
    let mut columns = vec![
        Column::figures(report.unit(), times),
        Column::figures("ratio", ratios),
        Column::figures("interval", of(&interval)),
        Column::figures("1st build", of(&first_build)),
        Column::figures("rebuild", of(&|ranked| duration(ranked.build_ns))),
        Column::figures(
            "B/vertex",
            of(&|ranked| format!("{:.1}", ranked.bytes_per_vertex)),
        ),
    ];
    if !pays_at_once {
        columns.push(Column::figures("pays", pays_after));
    }
    let names = Column::words("", of(&|ranked| ranked.backend.clone()));
    let table = column_table(&names, &columns);
    let unit = report.unit();
    signs.explain(match report.program {
        None => "operation: mean time of an operation of the mix",
        Some(_) => "run: time of a run of the program",
    });
    let confidence = report.run.settings.confidence;
    signs.explain(&format!(
        "ratio: to the time of the fastest, with its {confidence} interval"
    ));
    signs.explain("1st build: time to build on new memory pages");
    signs.explain("rebuild: on pages that were used before");
    if !pays_at_once {
        signs.explain(&format!(
            "pays: number of {unit}s after which the 1st build and the {unit}s take less time than \
             the {unit}s on an indexed face set that is already built; – for this set"
        ));
    }
    let mut made_from = report
        .ranking
        .iter()
        .filter_map(|ranked| ranked.made_from.as_deref());
    if let Some(over) = made_from.next() {
        signs.explain(&format!(
            "relation-tables: flat tables of only the relations in the mix, made from {over}"
        ));
    }
    format!("{table}\n{}", signs.legend())
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
        }) if *operations < 1e15 => approximate(operations.max(1.0)),
        Some(_) => "never".into(),
    }
}

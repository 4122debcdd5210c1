//! Times operations of Sixfold for a comparison with other libraries. The comparison programs of
//! the other libraries have the same arguments and the same output format as this program.
//!
//! `peer --mesh FILE.obj [--op NAME …] [--reps N] [--budget SECONDS] [--backend NAME] [--way NAME]
//! [--threads N]` prints one JSON object per line. Every operation first runs without timing. Then
//! `--reps` gives the number of measurements, which use the same code as a study. A short operation
//! is repeated until 200 µs have passed. An operation that changes the mesh works on a copy of the
//! mesh. The copy is restored while the clock is stopped. Freed memory pages stay with the process.
//!
//! The name of a subdivision contains the scheme and the number of steps: `catmull_clark_2`,
//! `loop_1`, `sqrt3_1`. The values of `--way` (the method of subdivision) are `gather`, `scatter`,
//! `native_fresh` and `native`. If `--threads` is above 1, the times of a subdivision are wall
//! times.

use std::path::Path;
use std::process::ExitCode;

use serde_json::json;
use sixfold::io;
use sixfold::subdivision::{BoundaryRule, Scheme};
use sixfold::{Creases, PolygonMesh};
use sixfold_results::{Policy, Time};
use sixfold_study::{
    Backend, BackendRunner, HeapGuard, MachineClock, Operation, SubdivisionJob, Way, timed,
};

/// Minimum time of a sample, in nanoseconds.
const SHORTEST_SAMPLE_NS: f64 = 200_000.0;

struct Arguments {
    mesh: String,
    backend: String,
    operations: Vec<String>,
    way: Way,
    threads: usize,
    reps: usize,
    budget_s: f64,
}

fn main() -> ExitCode {
    match arguments().and_then(|arguments| run(&arguments)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn arguments() -> Result<Arguments, String> {
    let mut found = Arguments {
        mesh: String::new(),
        backend: "half-edge".into(),
        operations: Vec::new(),
        way: Way::Native,
        threads: 1,
        reps: 11,
        budget_s: 20.0,
    };
    let mut words = std::env::args().skip(1).peekable();
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        let number = |text: String| text.parse().map_err(|_| format!("{text} is not a number"));
        match word.as_str() {
            "--mesh" => found.mesh = value()?,
            "--backend" => found.backend = value()?,
            "--way" => {
                let name = value()?;
                let way = Way::ALL.into_iter().find(|way| way.name() == name);
                found.way = way.ok_or(format!("{name} is not a way to subdivide"))?;
            }
            "--threads" => found.threads = number(value()?)? as usize,
            "--reps" => found.reps = number(value()?)? as usize,
            "--budget" => found.budget_s = number(value()?)?,
            "--op" => {
                while let Some(name) = words.next_if(|next| !next.starts_with("--")) {
                    found.operations.push(name);
                }
            }
            other => return Err(format!("unknown argument {other}")),
        }
    }
    match found.mesh.is_empty() {
        true => Err("usage: peer --mesh FILE.obj [--op NAME …] [--reps N] [--backend NAME]".into()),
        false => Ok(found),
    }
}

fn find(backend: &str) -> Result<Backend, String> {
    Backend::find(backend).ok_or(format!("no backend is called `{backend}`"))
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let path = Path::new(&arguments.mesh);
    let (polygons, _) = io::read(path).map_err(|e| e.to_string())?.into_polygons();
    let mesh = path.file_stem().unwrap_or_default().to_string_lossy();
    let peer = format!("sixfold {}", arguments.backend);
    let _heap = HeapGuard::acquire(Policy::Kept).map_err(|e| e.to_string())?;
    let backend = find(&arguments.backend)?;
    let mut runner = BackendRunner::new(&backend, &polygons).map_err(|e| e.to_string())?;
    let wanted = |name: &str| {
        arguments.operations.is_empty() || arguments.operations.iter().any(|o| o == name)
    };
    if wanted("memory") {
        let bytes = runner.bytes();
        let per_vertex = bytes as f64 / polygons.vertex_count() as f64;
        println!(
            "{}",
            json!({"peer": peer, "mesh": mesh, "op": "memory", "bytes": bytes,
                   "bytes_per_vertex": per_vertex, "how": "tables"})
        );
    }
    for operation in Operation::ALL {
        // Operations that make or edit a mesh are run only if they are named. Subdivisions by
        // levels are run below.
        let unnamed = operation.creates_mesh() && arguments.operations.is_empty();
        if unnamed || !wanted(operation.name()) {
            continue;
        }
        let clock = MachineClock::start();
        let row = Row::measure(arguments, operation.name(), || {
            let run = runner.run(operation, &clock);
            (run.time, run.checksum, run.elements)
        });
        row.print(&peer, &mesh);
    }
    for name in &arguments.operations {
        if let Some((scheme, levels)) = subdivision(name) {
            let row = refined(arguments, &polygons, name, scheme, levels)?;
            row.print(&format!("{peer} {}", arguments.way), &mesh);
        }
    }
    Ok(())
}

/// Returns the scheme and the number of steps of a name such as `catmull_clark_2`.
fn subdivision(name: &str) -> Option<(Scheme, u32)> {
    let (scheme, levels) = name.rsplit_once('_')?;
    let scheme = scheme.replace('_', "-").parse().ok()?;
    let levels = levels.parse().ok()?;
    (1..=16).contains(&levels).then_some((scheme, levels))
}

/// Measures a subdivision on its own thread pool.
fn refined(
    arguments: &Arguments,
    polygons: &PolygonMesh,
    name: &str,
    scheme: Scheme,
    levels: u32,
) -> Result<Row, String> {
    let mut job = SubdivisionJob::new(scheme, arguments.way, levels);
    // The other libraries use this boundary rule.
    job.subdivision.boundary = BoundaryRule::EdgeOnly;
    let backend = find(&arguments.backend)?;
    let refiner = job.prepare(&backend, polygons, &Creases::default());
    let refiner = refiner.ok_or(format!("{name} cannot run this way on this backend"))?;
    let mut refiner = refiner.map_err(|e| e.to_string())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads);
    let pool = pool.build().map_err(|e| e.to_string())?;
    pool.install(|| {
        refiner.run().map_err(|e| e.to_string())?;
        // With one thread, the clock of that thread measures all the work.
        let clock = MachineClock::start();
        let mut runs = 1;
        Ok(Row::measure(arguments, name, || {
            let time = timed(&clock, || {
                (0..runs).for_each(|_| refiner.run().expect("it has run before"));
            });
            let mut time = time.scaled(1.0 / f64::from(runs));
            runs = (SHORTEST_SAMPLE_NS / time.ns().max(1.0)).ceil() as u32;
            if arguments.threads > 1 {
                time.cpu_ns = None;
            }
            let (faces, checksum) = refiner.result();
            (time, checksum, faces as u64)
        }))
    })
}

struct Row {
    operation: String,
    wall: Vec<f64>,
    cpu: Vec<f64>,
    checksum: f64,
    elements: u64,
}

impl Row {
    /// Warms up the operation. Then runs it as often as the arguments say, within the budget.
    fn measure(
        arguments: &Arguments,
        operation: &str,
        mut run: impl FnMut() -> (Time, f64, u64),
    ) -> Self {
        let (_, checksum, elements) = run();
        let mut row = Self {
            operation: operation.to_owned(),
            wall: Vec::new(),
            cpu: Vec::new(),
            checksum,
            elements,
        };
        let mut total = 0.0;
        while row.wall.len() < arguments.reps.max(1) {
            let (time, ..) = run();
            row.wall.push(time.wall_ns);
            row.cpu.push(time.ns());
            total += time.wall_ns * 1e-9;
            if row.wall.len() >= 3 && total > arguments.budget_s {
                break;
            }
        }
        row.wall.sort_by(f64::total_cmp);
        row.cpu.sort_by(f64::total_cmp);
        row
    }

    fn print(&self, peer: &str, mesh: &str) {
        let Self {
            operation,
            wall,
            cpu,
            checksum,
            elements,
        } = self;
        let median =
            |times: &[f64]| f64::midpoint(times[(times.len() - 1) / 2], times[times.len() / 2]);
        println!(
            "{}",
            json!({"peer": peer, "mesh": mesh, "op": operation, "reps": wall.len(),
                   "min_ns": wall[0], "median_ns": median(wall),
                   "cpu_min_ns": cpu[0], "cpu_median_ns": median(cpu),
                   "checksum": checksum, "elements": elements,
                   "ns_per_element": median(wall) / *elements as f64,
                   "cpu_min_ns_per_element": cpu[0] / *elements as f64})
        );
    }
}

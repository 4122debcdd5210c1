//! Sixfold's own column beside the established libraries: arguments and output as theirs.
//!
//! `peer --mesh FILE.obj [--op NAME …] [--reps N] [--budget SECONDS] [--backend NAME]` prints one
//! JSON object a line. Every operation runs once to warm up and then `N` times, alone; the code is
//! that of a study. Processor time is that of the only thread.

use std::path::Path;
use std::process::ExitCode;

use serde_json::json;
use sixfold::mesh_io::read_obj;
use study::{MachineClock, Operation, Solo};

struct Arguments {
    mesh: String,
    backend: String,
    operations: Vec<String>,
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
        reps: 11,
        budget_s: 20.0,
    };
    let mut words = std::env::args().skip(1).peekable();
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} wants a value"));
        let number = |text: String| text.parse().map_err(|_| format!("{text} is no number"));
        match word.as_str() {
            "--mesh" => found.mesh = value()?,
            "--backend" => found.backend = value()?,
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

fn run(arguments: &Arguments) -> Result<(), String> {
    let path = Path::new(&arguments.mesh);
    let (polygons, _) = read_obj(path).map_err(|e| e.to_string())?.into_polygons();
    let mesh = path.file_stem().unwrap_or_default().to_string_lossy();
    let peer = format!("sixfold {}", arguments.backend);
    let mut solo = Solo::new(&arguments.backend, &polygons).map_err(|e| e.to_string())?;
    let wanted = |name: &str| {
        arguments.operations.is_empty() || arguments.operations.iter().any(|o| o == name)
    };
    if wanted("memory") {
        let bytes = solo.bytes();
        let per_vertex = bytes as f64 / polygons.vertex_count() as f64;
        println!(
            "{}",
            json!({"peer": peer, "mesh": mesh, "op": "memory", "bytes": bytes,
                   "bytes_per_vertex": per_vertex, "how": "tables"})
        );
    }
    for operation in Operation::ALL {
        if !wanted(operation.name()) {
            continue;
        }
        let clock = MachineClock::start();
        let (mut wall, mut cpu, mut total) = (Vec::new(), Vec::new(), 0.0);
        let mut last = solo.run(operation, &clock);
        while wall.len() < arguments.reps.max(1) {
            last = solo.run(operation, &clock);
            wall.push(last.time.wall_ns);
            cpu.push(last.time.ns());
            total += last.time.wall_ns * 1e-9;
            if wall.len() >= 3 && total > arguments.budget_s {
                break;
            }
        }
        for times in [&mut wall, &mut cpu] {
            times.sort_by(f64::total_cmp);
        }
        let median =
            |times: &[f64]| f64::midpoint(times[(times.len() - 1) / 2], times[times.len() / 2]);
        println!(
            "{}",
            json!({"peer": peer, "mesh": mesh, "op": operation.name(), "reps": wall.len(),
                   "min_ns": wall[0], "median_ns": median(&wall),
                   "cpu_min_ns": cpu[0], "cpu_median_ns": median(&cpu),
                   "checksum": last.checksum, "elements": last.elements,
                   "ns_per_element": median(&wall) / last.elements as f64,
                   "cpu_min_ns_per_element": cpu[0] / last.elements as f64})
        );
    }
    Ok(())
}

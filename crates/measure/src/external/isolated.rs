//! Programs of users in child processes, so that a program that crashes, does not end or uses too
//! much memory ends only its own process.
//!
//! The child runs one program on one structure, and answers requests on its standard input by the
//! protocol of external programs. The requests are `build`, `run` (the program), `rebuild` and
//! `asked`.

use std::ffi::OsString;
use std::io::{self, BufRead, Write};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use crate::pages::HeapGuard;
use crate::{
    Contestant, Job, MachineClock, Operation, Outcome, Series, Suite, Task, TimedBackend, TimedRun,
};
use serde::{Deserialize, Serialize};
use serde_json::json;
use sixfold::{Facts, PolygonMesh, QueryCost};
use sixfold_results::{AskedCount, Excluded, Policy, Time, sanitize};

use super::program::{PROTOCOL, Program, STOPPED};
use super::subject::ExternalSubject;
use crate::pick::programs::Qualification;
use crate::refusal;

/// How programs run in child processes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Isolation {
    /// The executable of the child, and its first arguments. `--child` and a [`ChildTask`] as JSON follow. The
    /// executable must call [`serve_program`].
    pub command: Vec<OsString>,
    /// The time limit for one answer of a child.
    pub time_limit: Duration,
    /// The memory limit of a child in bytes; `None` for no limit.
    pub memory_limit: Option<u64>,
}

/// What a child runs.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ChildTask {
    /// The name of the mesh.
    pub mesh: String,
    /// The name of the program.
    pub program: String,
    /// The name of the structure.
    pub backend: String,
    /// The longest time of one run on a structure that scans the mesh, in nanoseconds; `None` for no
    /// limit.
    pub longest_run_ns: Option<u64>,
    /// What happens to freed memory pages.
    pub heap: Policy,
    /// The limit of the address space in bytes; `None` for no limit.
    pub memory_limit: Option<u64>,
}

/// A program on one structure in a child process.
pub struct Isolated<'a> {
    child: ExternalSubject<'a>,
    costs: [QueryCost; 9],
    merged_vertices: usize,
}

impl<'a> Isolated<'a> {
    /// Starts the child. The error is the exclusion if the program does not run on the structure.
    pub fn start(
        isolation: &Isolation,
        task: &ChildTask,
        contestant: &Contestant,
        stop: &'a AtomicBool,
    ) -> Result<Self, Excluded> {
        let name = contestant.name();
        let excluded = |reason: String| Excluded::new(name, reason);
        let json = serde_json::to_string(task).map_err(|error| excluded(error.to_string()))?;
        let mut arguments = isolation.command.clone();
        arguments.extend(["--child".into(), json.into()]);
        let mut program = Program::start(&arguments, Policy::System, isolation.time_limit, stop)
            .map_err(excluded)?;
        let handshake = program.handshake().map_err(|reason| Excluded {
            failed: reason != STOPPED,
            ..excluded(reason)
        })?;
        if !handshake.holds {
            let reason = handshake.reason.as_deref().map(sanitize);
            return Err(Excluded {
                failed: handshake.failed,
                ..excluded(reason.unwrap_or_else(|| "it gives no reason".into()))
            });
        }
        let bytes = handshake.bytes.unwrap_or(0);
        Ok(Self {
            child: ExternalSubject::new(contestant.name().to_owned(), bytes, program),
            costs: contestant.info().costs,
            merged_vertices: handshake.merged_vertices,
        })
    }

    /// Returns what the program asks in one run; `None` if this is unknown.
    pub fn asked(&mut self) -> Option<Vec<AskedCount>> {
        self.child.request("asked", 1).ok()?.asked
    }
}

impl TimedBackend for Isolated<'_> {
    fn name(&self) -> &str {
        self.child.name()
    }

    fn costs(&self) -> [QueryCost; 9] {
        self.costs
    }

    fn merged_vertices(&self) -> usize {
        self.merged_vertices
    }

    fn bytes(&self) -> usize {
        self.child.bytes()
    }

    fn rebuild(&mut self) {
        // If the child has failed, the next run reports the reason.
        let _ = self.child.request("rebuild", 1);
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        match job.task {
            Task::Operation(Operation::Build) => self.child.run_named("build", series),
            Task::Program => self.child.run_named("run", series),
            _ => TimedRun::refused("a program runs only as a whole".into(), series),
        }
    }
}

/// A request that a child reads.
#[derive(Deserialize)]
struct ChildRequest {
    run: String,
    times: u32,
}

/// Runs a program of `suite` on one structure, as requested by the lines of `input`. Returns at the
/// end of `input`.
///
/// # Errors
///
/// Returns an error if the memory limit cannot be set, if another heap policy is active in this
/// process, if a line is not a request, or if `output` cannot be written.
pub fn serve_program(
    suite: &Suite,
    task: &ChildTask,
    polygons: &PolygonMesh,
    input: impl BufRead,
    mut output: impl Write,
) -> io::Result<()> {
    limit_memory(task.memory_limit)?;
    let _heap = HeapGuard::acquire(task.heap).map_err(io::Error::other)?;
    let mut answer = |value: serde_json::Value| {
        writeln!(output, "{value}")?;
        output.flush()
    };
    let refused = |Excluded { reason, failed, .. }: Excluded| json!({"protocol": PROTOCOL, "holds": false, "reason": reason, "failed": failed});
    let programs = suite.programs().iter();
    let mut named = programs.filter(|program| program.name() == task.program);
    let contestants = named.next().map(|program| program.contestants().iter());
    let mut contestants = contestants.into_iter().flatten();
    let Some(contestant) = contestants.find(|c| c.name() == task.backend) else {
        return answer(refused(Excluded::new(
            &task.backend,
            "the child process does not know the program".into(),
        )));
    };
    let facts = Facts::from_polygons(polygons);
    let clock = MachineClock::start();
    let qualification = Qualification {
        refusals: refusal::BuildInput::with_facts(polygons, &facts),
        longest_run_ns: task.longest_run_ns.map_or(f64::INFINITY, |ns| ns as f64),
        machine: &clock,
    };
    let mut backend = match qualification.prepare(contestant) {
        Ok(backend) => backend,
        Err(excluded) => return answer(refused(excluded)),
    };
    answer(json!({
        "protocol": PROTOCOL,
        "holds": true,
        "bytes": backend.bytes(),
        "merged_vertices": backend.merged_vertices(),
    }))?;
    for line in input.lines() {
        let request: ChildRequest = serde_json::from_str(&line?)?;
        let task = match request.run.as_str() {
            "build" => Task::Operation(Operation::Build),
            "run" => Task::Program,
            "rebuild" => {
                backend.rebuild();
                answer(json!({}))?;
                continue;
            }
            "asked" => {
                let asked = contestant.record(polygons).and_then(Result::ok);
                answer(json!({"asked": asked.map(|asked| asked.counts())}))?;
                continue;
            }
            other => {
                answer(json!({"refused": format!("unknown request `{other}`")}))?;
                continue;
            }
        };
        let series = Series::with_runs(request.times.max(1), &clock).with_result();
        let run = backend.run(&Job::new(task), &series);
        answer(described(&run, series.runs))?;
    }
    Ok(())
}

/// Returns the answer to a request. The times are those of all runs.
fn described(run: &TimedRun, times: u32) -> serde_json::Value {
    let Time {
        cpu_ns, wall_ns, ..
    } = run.time.scaled(f64::from(times));
    let Outcome {
        checksum, elements, ..
    } = run.outcome.unwrap_or(Outcome::new(f64::NAN, 0));
    match &run.refusal {
        Some(reason) => json!({"refused": reason}),
        None => json!({
            "wall_ns": wall_ns,
            "cpu_ns": cpu_ns,
            "checksum": checksum,
            "elements": elements,
        }),
    }
}

/// Limits the address space of this process.
#[cfg(unix)]
fn limit_memory(limit: Option<u64>) -> io::Result<()> {
    use nix::sys::resource::{Resource, setrlimit};

    let Some(limit) = limit else {
        return Ok(());
    };
    setrlimit(Resource::RLIMIT_AS, limit, limit).map_err(io::Error::from)
}

/// Does nothing, because this platform has no limit of the address space.
#[cfg(not(unix))]
fn limit_memory(_: Option<u64>) -> io::Result<()> {
    Ok(())
}

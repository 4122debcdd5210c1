//! The command line of programs of a user: measures them on every structure.

use std::fmt::Display;
use std::io::{self, Write};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use sixfold::UnknownName;
use sixfold_results::numbers::{bytes, counted, list};
use sixfold_results::{Failed, FailureKind, Finding, PickReport, Results};

use crate::command::arguments::{self, Arguments, Asked};
use crate::command::failure::Failure;
use crate::command::free_memory::used_memory;
use crate::command::launches::{self, Launch, Launching, Work};
use crate::command::load::{mesh_or_built_in, study_meshes};
use crate::command::mesh_files::shown;
use crate::command::meshes::{find_mesh, find_meshes};
use crate::command::output::{Output, check_outputs, exit_without_drafts, is_stdout};
use crate::command::progress::{INTERRUPTED, Line, interrupt_flag};
use crate::command::run::{warn_of_debug_build, with_command};
use crate::command::text::{
    TextOutput, hanging_indent, print_notice, print_stderr, sanitize, take_notices,
};
use crate::command::{answer, order, record};
use crate::launches::pool_programs;
use crate::{
    ChildTask, Effort, Isolation, ProgramSettings, StudyMesh, Suite, SuiteProgram, free_memory,
    pick_for_programs, serve_program,
};

/// The exit code if no structure qualifies for a program.
const NONE_QUALIFIES: u8 = 1;

/// The time after which a program counts as endless: the budget times this factor, and
/// [`MOST_OVERTIME`].
const OVERTIME_FACTOR: u32 = 3;
/// The time that a run may take after an interrupt.
const STOP_LIMIT: Duration = Duration::from_secs(3);
/// The interval between two checks of the limits.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// The least default of the time limit of a sample in a child process.
const LEAST_TIME_LIMIT: Duration = Duration::from_secs(1);
/// A time that no program reaches. It can be added to the present time.
const NO_TIME_LIMIT: Duration = Duration::from_secs(100 * 365 * 24 * 3600);
/// The time that a command may take longer than [`OVERTIME_FACTOR`] times its budget.
const MOST_OVERTIME: Duration = Duration::from_secs(30);

/// Reads the arguments, measures the programs of `suite`, prints the answer and writes the files.
pub fn run(suite: Suite) -> Result<ExitCode, Failure> {
    let names: Vec<&str> = suite.programs().iter().map(SuiteProgram::name).collect();
    let arguments = match arguments::parse(std::env::args_os().skip(1))? {
        Asked::Measure(arguments) => *arguments,
        Asked::Help => return print(&arguments::help(&names)),
        Asked::Version => return print(concat!("sixfold-measure ", env!("CARGO_PKG_VERSION"))),
    };
    let known = names.iter().copied();
    UnknownName::check("program", &arguments.programs, known).map_err(Failure::usage)?;
    let suite = match arguments.programs.is_empty() {
        true => suite,
        false => suite.only(&arguments.programs),
    };
    if let Some(task) = &arguments.child {
        return serve(&suite, task, &arguments);
    }
    if arguments.canonical_order {
        return order::run(&suite, &arguments);
    }
    let memory_limit = arguments.memory_limit.or_else(default_memory_limit);
    let settings = ProgramSettings {
        isolation: arguments
            .isolate
            .then(|| isolation(&arguments, memory_limit))
            .transpose()?,
        backends: arguments.backends.clone(),
        runs: arguments.runs,
        max_memory: arguments.max_memory,
        effort: arguments.effort,
        confidence: arguments.confidence,
        seed: launches::seed(arguments.seed),
        heap: arguments.heap,
    };
    if let Some(folder) = &arguments.record {
        return record::run(&suite, &settings, folder, &arguments);
    }
    measure(&suite, &settings, &arguments, memory_limit)
}

fn print(text: &str) -> Result<ExitCode, Failure> {
    let mut to = TextOutput::new(true);
    to.print_line(text.trim_end());
    to.finish().map(|()| ExitCode::SUCCESS)
}

/// Returns how child processes run the programs.
fn isolation(arguments: &Arguments, memory_limit: Option<u64>) -> Result<Isolation, Failure> {
    // Each child reads the mesh again.
    let is_read_once =
        |path: &&PathBuf| is_stdout(path) || (path.exists() && !path.is_file() && !path.is_dir());
    if let Some(path) = arguments.meshes.iter().find(is_read_once) {
        return Err(Failure::usage(format!(
            "{}: --isolate reads the mesh once for each structure: save it to a file",
            shown(path)
        )));
    }
    let executable = std::env::current_exe().map_err(|error| {
        Failure::usage(format!("--isolate: the executable is unknown: {error}"))
    })?;
    let quarter = match arguments.effort.budget() {
        Some(budget) => (budget / 4).max(LEAST_TIME_LIMIT),
        None => NO_TIME_LIMIT,
    };
    let budget = arguments.effort.budget();
    if let Some((limit, _)) = arguments
        .time_limit
        .zip(budget)
        .filter(|(limit, budget)| limit > budget)
    {
        print_notice(&format!(
            "note: --time-limit {:.1}s is longer than the --budget: a structure that does not end takes the time of the others",
            limit.as_secs_f64()
        ));
    }
    let command = [executable.into()].into_iter();
    Ok(Isolation {
        command: command.chain(std::env::args_os().skip(1)).collect(),
        time_limit: arguments.time_limit.unwrap_or(quarter),
        memory_limit,
    })
}

/// Returns nine tenths of the free memory; `None` if it is unknown.
fn default_memory_limit() -> Option<u64> {
    free_memory().map(|free| free / 10 * 9)
}

/// Runs a program in this process as the parent process requests.
fn serve(suite: &Suite, task: &str, arguments: &Arguments) -> Result<ExitCode, Failure> {
    let wrong = |error: &dyn Display| Failure::usage(format!("--child: {error}"));
    let task: ChildTask = serde_json::from_str(task).map_err(|error| wrong(&error))?;
    let path = find_mesh(&arguments.meshes, &task.mesh)?;
    let (path, read) = (path.as_deref(), arguments.read);
    let mesh = mesh_or_built_in(path, read, false, arguments.triangulate)?;
    let (input, output) = (io::stdin().lock(), io::stdout().lock());
    let served = serve_program(suite, &task, &mesh.polygons, input, output);
    served.map_err(|error| wrong(&error))?;
    Ok(ExitCode::SUCCESS)
}

/// Measures the programs in this process or in several launches, prints the answers and writes the files.
fn measure(
    suite: &Suite,
    settings: &ProgramSettings,
    arguments: &Arguments,
    memory_limit: Option<u64>,
) -> Result<ExitCode, Failure> {
    let meshes = find_meshes(&arguments.meshes, &mut |note| print_notice(note))?;
    let paths = meshes.iter().filter_map(|mesh| mesh.path.as_deref());
    let stop = interrupt_flag(settings.heap);
    let mut session = Session::open(paths.clone(), arguments, &stop)?;
    let (study_meshes, failed) = study_meshes(&meshes, arguments.read, arguments.triangulate)?;
    let launching = Launching {
        wanted: match arguments.isolate {
            // Each structure has a process of its own, and a structure that fails would fail in each launch.
            true => Some(NonZeroU32::MIN),
            false => arguments.launches,
        },
        paths: paths.collect(),
        part: None,
        stop: &stop,
        pool: pool_programs,
    };
    let programs = suite.programs();
    let faces = study_meshes.iter().map(|mesh| mesh.polygons.face_count());
    let work = Work {
        faces: programs.len() * faces.sum::<usize>(),
        entries: None,
        spare_s: 0.0,
    };
    let plan = launching.plan(settings.effort, work)?;
    warn_of_debug_build();
    print_meshes(&study_meshes, &mut session.text);
    let kept = Kept::new(session, failed, arguments.keep_going);
    let line = Line::new();
    if plan.is_here() {
        let limits = Limits {
            sample: arguments.time_limit.filter(|_| !arguments.isolate),
            ..Limits::new(settings.effort, memory_limit)
        };
        kept.end_at(limits, Arc::clone(&stop));
        let mut show = |done: f64, what: &str| {
            line.set(done, what);
            kept.lock().begin_step(what);
        };
        let mut finished = |report: &PickReport| {
            line.clear();
            kept.add(report, arguments.triangulate);
        };
        let reports = pick_for_programs(
            &study_meshes,
            suite,
            settings,
            &stop,
            &mut show,
            &mut finished,
        );
        line.clear();
        reports.map_err(Failure::usage)?;
    } else {
        let reports = study_meshes.iter().map(StudyMesh::report).collect();
        let results = plan.launched(Some(reports), &|done, what| line.set(done, what));
        line.clear();
        let results = results?;
        results
            .picks()
            .for_each(|report| kept.add(report, arguments.triangulate));
    }
    kept.finish()
}

pub(super) fn print_meshes(study_meshes: &[StudyMesh], text: &mut TextOutput) {
    for study_mesh in study_meshes {
        let vertices = counted(study_mesh.polygons.vertex_count(), "vertex", "vertices");
        let faces = counted(study_mesh.polygons.face_count(), "face", "faces");
        let line = format!("{}: {vertices}, {faces}", sanitize(&study_mesh.name));
        text.print_line(&hanging_indent("Mesh:     ", &line));
    }
}

/// A command between the opening of its files and the writing of the results.
struct Session {
    /// Prints nothing if results are written to standard output.
    text: TextOutput,
    json: Option<Output>,
    tags: Vec<(String, String)>,
}

impl Session {
    /// Opens the files. Returns an error if a file cannot be written or would overwrite one of `meshes`.
    fn open<'p>(
        meshes: impl Iterator<Item = &'p Path>,
        arguments: &Arguments,
        stop: &Arc<AtomicBool>,
    ) -> Result<Self, Failure> {
        if let Some(launch) = Launch::current() {
            launch.stop_with_parent(stop);
            return Ok(Self {
                text: TextOutput::new(false),
                json: Some(Output::open(Path::new("-"))?),
                tags: Vec::new(),
            });
        }
        let files = [("--json", arguments.json.as_ref())];
        for mesh in meshes {
            check_outputs(Some(mesh), &files)?;
        }
        Ok(Self {
            text: TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout)),
            json: Output::open_if(arguments.json.as_ref())?,
            tags: arguments.tags.clone(),
        })
    }

    /// Prints the remaining text and writes the file.
    fn write(self, results: &mut Results) -> Result<(), Failure> {
        results.add_notices(take_notices());
        for finding in &mut results.findings {
            finding.run_mut().tags.extend(self.tags.iter().cloned());
        }
        let done = self.text.finish();
        let Some(json) = self.json else { return done };
        done.and(json.finish(|writer: &mut dyn Write| {
            launches::mark_document(writer)?;
            results.write_json(writer)
        }))
    }
}

/// The finished results, which are written even if a program does not end.
#[derive(Clone)]
struct Kept(Arc<Mutex<KeptState>>);

struct KeptState {
    /// `None` after the results were written.
    session: Option<Session>,
    findings: Vec<Finding>,
    /// The meshes that could not be read.
    failed: Vec<Failed>,
    /// Whether it is no error if a part cannot be measured.
    keep_going: bool,
    none_qualifies: Vec<String>,
    /// The programs that fail on some structures, each with their names.
    failing: Vec<String>,
    /// The current step, such as `geodesics: measuring run on half-edge`, and its start.
    step: String,
    step_start: Instant,
}

impl KeptState {
    fn begin_step(&mut self, step: &str) {
        self.step.clear();
        self.step.push_str(step);
        self.step_start = Instant::now();
    }
}

/// The limits at which the process ends, because a run of a program cannot be stopped in another way.
#[derive(Clone, Copy)]
struct Limits {
    /// The time limit for the command.
    command: Duration,
    /// The time limit for each sample; `None` for no limit.
    sample: Option<Duration>,
    /// The limit of the memory of the process in bytes; `None` for no limit.
    memory: Option<u64>,
}

impl Limits {
    /// Returns the limits of a command that measures with `effort`, without a limit for each sample.
    fn new(effort: Effort, memory: Option<u64>) -> Self {
        Self {
            command: match effort.budget() {
                Some(budget) => OVERTIME_FACTOR * budget + MOST_OVERTIME,
                None => NO_TIME_LIMIT,
            },
            sample: None,
            memory,
        }
    }

    /// Describes the limit that is exceeded; `None` if no limit is exceeded.
    fn exceeded(&self, command: Duration, sample: Duration) -> Option<String> {
        let took = |limit: Duration| format!("did not end within {:.1} s", limit.as_secs_f64());
        if command > self.command {
            return Some(took(self.command));
        }
        if let Some(limit) = self.sample.filter(|&limit| sample > limit) {
            return Some(took(limit));
        }
        let (most, used) = self.memory.zip(used_memory())?;
        (used > most).then(|| format!("uses more memory than {}", bytes(most as usize)))
    }
}

impl Kept {
    fn new(session: Session, failed: Vec<Failed>, keep_going: bool) -> Self {
        Self(Arc::new(Mutex::new(KeptState {
            session: Some(session),
            findings: Vec::new(),
            failed,
            keep_going,
            none_qualifies: Vec::new(),
            failing: Vec::new(),
            step: "loading".into(),
            step_start: Instant::now(),
        })))
    }

    fn lock(&self) -> MutexGuard<'_, KeptState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Prints a finished report and keeps it for the files.
    fn add(&self, report: &PickReport, triangulate: bool) {
        let mut kept = self.lock();
        let name = sanitize(&report.workload.name);
        let failed: Vec<String> = report.failed().map(|e| e.backend.clone()).collect();
        if report.ranking.is_empty() && !report.interrupted {
            kept.none_qualifies.push(name.clone());
        } else if !failed.is_empty() {
            kept.failing.push(format!("{name} on {}", list(failed)));
        }
        if let Some(session) = &mut kept.session {
            let text = &mut session.text;
            text.print_line("");
            text.print_line(&hanging_indent("Program:  ", &name));
            text.print_line("");
            answer::print(report, text);
        }
        let finding = with_command(report.clone(), triangulate);
        kept.findings.push(finding);
    }

    /// Writes the results and returns the exit code.
    fn finish(&self) -> Result<ExitCode, Failure> {
        let mut kept = self.lock();
        let Some(session) = kept.session.take() else {
            return Ok(ExitCode::from(INTERRUPTED));
        };
        let results = {
            let mut results = Results::default();
            for finding in std::mem::take(&mut kept.findings) {
                results.add(finding);
            }
            results.add_failures(std::mem::take(&mut kept.failed));
            results
        };
        let interrupted = results.is_interrupted();
        let mut results = results;
        let written = session.write(&mut results);
        let code = exit_code(
            written,
            &results,
            interrupted,
            &kept.failing,
            kept.keep_going,
        )?;
        if kept.none_qualifies.is_empty() || launches::has_ended_early() {
            return Ok(code);
        }
        print_stderr(&format!(
            "error: no structure is ranked for {}, for the reasons above: correct the program, relax --max-memory or \
             --backends, use a longer --budget, cut the faces with --triangulate, or repair the mesh (see `sixfold inspect`)",
            kept.none_qualifies.join(", ")
        ));
        Ok(ExitCode::from(NONE_QUALIFIES))
    }

    /// Starts a thread that writes the finished results and ends the process if a limit is exceeded.
    /// After an interrupt, a run has [`STOP_LIMIT`] to end.
    fn end_at(&self, limits: Limits, stop: Arc<AtomicBool>) {
        let kept = self.clone();
        let start = Instant::now();
        std::thread::spawn(move || {
            let mut stopped_for = Duration::ZERO;
            let why = loop {
                let sample = kept.lock().step_start.elapsed();
                if let Some(why) = limits.exceeded(start.elapsed(), sample) {
                    break why;
                }
                if stopped_for > STOP_LIMIT {
                    break "did not end after the interrupt".into();
                }
                std::thread::sleep(CHECK_INTERVAL);
                if stop.load(Ordering::Relaxed) {
                    stopped_for += CHECK_INTERVAL;
                }
            };
            let step = kept.lock().step.clone();
            print_stderr(&format!(
                "error: a program {why}, at: {}. Finished programs are kept. Correct the program, \
                 leave out the structure with --backends, or measure the other structures with \
                 --isolate.",
                sanitize(&step)
            ));
            if let Err(failure) = kept.finish() {
                print_stderr(&format!("error: {}", failure.message));
            }
            exit_without_drafts(INTERRUPTED.into());
        });
    }
}

/// The exit code if results differ, if a part could not be measured, or if a program fails.
const MISMATCH: u8 = 1;

/// Prints the final messages and returns the exit code. An error of writing (`written`) takes precedence over different
/// results, and different results take precedence over an interruption. If a part could not be measured, or a program fails
/// on a structure (`failing`), this is an error, or a note if `keep_going` is set.
fn exit_code(
    written: Result<(), Failure>,
    results: &Results,
    interrupted: bool,
    failing: &[String],
    keep_going: bool,
) -> Result<ExitCode, Failure> {
    let differing = results.mismatches();
    if differing > 0 {
        print_stderr(&format!(
            "error: {} from the results of other backends for the same work: see the likely reasons above. The result of a \
             program must not depend on the order in which a query lists the neighbours",
            counted(differing, "result differs", "results differ")
        ));
    }
    written?;
    if interrupted {
        print_stderr(match results.findings.is_empty() {
            true => "interrupted: no result was finished",
            false => "interrupted: finished results are kept",
        });
    }
    if differing > 0 {
        return Ok(ExitCode::from(MISMATCH));
    }
    if interrupted || launches::has_ended_early() {
        return Ok(ExitCode::from(INTERRUPTED));
    }
    let failed = results.failures.iter();
    let failed = failed.filter(|failed| failed.kind == FailureKind::NotMeasured);
    let failed: Vec<&str> = failed.map(|failed| failed.mesh.as_str()).collect();
    let mut lacking = Vec::new();
    if !failing.is_empty() {
        lacking.push(format!(
            "a program fails: {}: correct it, for the reasons above (RUST_BACKTRACE=1 prints the calls of a panic), or \
             leave out the structures with --backends",
            failing.join("; ")
        ));
    }
    if !failed.is_empty() {
        lacking.push(format!(
            "not measured: {}: repair the files, for the reasons in the notes above, or leave them out",
            sanitize(&failed.join(", "))
        ));
    }
    if launches::has_died() {
        lacking.push("a launch is missing, for the reason in the note above: measure again".into());
    }
    for what in &lacking {
        print_stderr(&match keep_going {
            true => format!("note: {what}"),
            false => format!(
                "error: {what}. The other results are complete; with --keep-going, this is no error"
            ),
        });
    }
    Ok(match lacking.is_empty() || keep_going {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(MISMATCH),
    })
}

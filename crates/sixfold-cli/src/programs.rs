//! The command line of programs of a user: measures them on every structure.

mod record;

use std::fmt::Display;
use std::io;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use clap::{CommandFactory, FromArgMatches};
use sixfold::UnknownName;
use sixfold_results::numbers::{bytes, counted, figure};
use sixfold_results::{Failed, Finding, PickReport, Results};
use sixfold_study::{
    ChildTask, Effort, Isolation, ProgramSettings, StudyMesh, Suite, SuiteProgram, free_memory,
    serve_program,
};

use crate::arguments::{LaunchArgs, Programs, ReadFiles, ResultFiles};
use crate::failure::Failure;
use crate::free_memory::used_memory;
use crate::help::fit_to_width;
use crate::launches::{self, Launching, Work};
use crate::load;
use crate::many::find_meshes;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::output::exit_without_drafts;
use crate::pick;
use crate::progress::{Bar, INTERRUPTED};
use crate::text::{TextOutput, hanging_indent, print_notice, print_stderr, sanitize};

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
pub(crate) fn run(suite: Suite) -> Result<ExitCode, Failure> {
    let names: Vec<&str> = suite.programs().iter().map(SuiteProgram::name).collect();
    let definition = fit_to_width(Programs::command().after_help(after_help(&names)));
    let matches = definition.try_get_matches();
    let arguments = matches.and_then(|matches| Programs::from_arg_matches(&matches));
    let arguments = match arguments {
        Ok(arguments) => arguments,
        Err(error) => return crate::print_clap_message(error),
    };
    let known = names.iter().copied();
    UnknownName::check("program", &arguments.programs, known).map_err(Failure::usage)?;
    let suite = match arguments.programs.is_empty() {
        true => suite,
        false => suite.only(&arguments.programs),
    };
    if let Some(task) = &arguments.child {
        return serve(&suite, task, &arguments.meshes, arguments.read);
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
        effort: arguments.effort.effort(),
        confidence: arguments.launching.confidence,
        seed: launches::seed(arguments.seed),
        heap: arguments.heap,
    };
    if let Some(folder) = &arguments.record {
        return record::run(&suite, &settings, folder, &arguments);
    }
    let measurement = Measurement {
        suite: &suite,
        settings: &settings,
        meshes: &arguments.meshes,
        read: arguments.read,
        triangulate: arguments.triangulate,
        trace: None,
        launching: match arguments.isolate {
            // Each structure has a process of its own, and a structure that fails would fail in each launch.
            true => LaunchArgs {
                launches: Some(NonZeroU32::MIN),
                ..arguments.launching
            },
            false => arguments.launching,
        },
        files: &arguments.files,
        limits: Limits {
            sample: arguments.time_limit.filter(|_| !arguments.isolate),
            ..Limits::new(settings.effort, memory_limit)
        },
    };
    measurement.run()
}

/// Returns how child processes run the programs.
fn isolation(arguments: &Programs, memory_limit: Option<u64>) -> Result<Isolation, Failure> {
    let executable = std::env::current_exe().map_err(|error| {
        Failure::usage(format!("--isolate: the executable is unknown: {error}"))
    })?;
    let quarter = match arguments.effort.effort().budget() {
        Some(budget) => (budget / 4).max(LEAST_TIME_LIMIT),
        None => NO_TIME_LIMIT,
    };
    Ok(Isolation {
        executable,
        time_limit: arguments.time_limit.unwrap_or(quarter),
        memory_limit,
    })
}

/// Returns nine tenths of the free memory; `None` if it is unknown.
pub(crate) fn default_memory_limit() -> Option<u64> {
    free_memory().map(|free| free / 10 * 9)
}

/// Runs a program in this process as the parent process requests.
fn serve(
    suite: &Suite,
    task: &str,
    meshes: &[PathBuf],
    files: ReadFiles,
) -> Result<ExitCode, Failure> {
    let wrong = |error: &dyn Display| Failure::usage(format!("--child: {error}"));
    let task: ChildTask = serde_json::from_str(task).map_err(|error| wrong(&error))?;
    let [mesh] = meshes else {
        return Err(wrong(&"expected one mesh"));
    };
    let polygons = load::for_study(mesh, files, false, false)?.polygons;
    let (input, output) = (io::stdin().lock(), io::stdout().lock());
    let served = serve_program(suite, &task, &polygons, input, output);
    served.map_err(|error| wrong(&error))?;
    Ok(ExitCode::SUCCESS)
}

fn after_help(names: &[&str]) -> String {
    format!(
        "Programs: {}\n\nLaunches: Fresh processes of this command measure one after the other, each all \
         programs. What\nthey print is not shown. If a program does not end or uses too much memory, \
         its launch is the last\none. If a program crashes, its launch is left out.\n\nExit codes: 0 success; \
         1 no structure qualifies for a program, results differ between structures,\na launch is \
         left out, or a mesh of several cannot be read; 2 wrong usage or unusable input, or all launches\nare left out; \
         4 interrupted, or a program did not end; finished results are kept.",
        names.join(", ")
    )
}

/// What a command line of programs measures, and where the results go.
pub(crate) struct Measurement<'a> {
    pub(crate) suite: &'a Suite,
    pub(crate) settings: &'a ProgramSettings,
    pub(crate) meshes: &'a [PathBuf],
    pub(crate) read: ReadFiles,
    pub(crate) triangulate: bool,
    /// The file with the calls of the program, if it is a trace.
    pub(crate) trace: Option<&'a Path>,
    pub(crate) launching: LaunchArgs,
    pub(crate) files: &'a ResultFiles,
    pub(crate) limits: Limits,
}

impl Measurement<'_> {
    /// Measures the programs in this process or in several launches, prints the answers and writes the files.
    pub(crate) fn run(&self) -> Result<ExitCode, Failure> {
        let meshes = find_meshes(self.meshes, &mut |note| print_notice(note))?;
        let paths = meshes.iter().filter_map(|mesh| mesh.path.as_deref());
        let mut session = Session::open(paths.clone(), self.files, self.settings.heap)?;
        let (study_meshes, failed) = pick::study_meshes(&meshes, self.read, self.triangulate)?;
        let drawn = study_meshes.into_iter().map(|mesh| session.drawn(mesh));
        let study_meshes: Vec<StudyMesh> = drawn.collect();
        let stop = Arc::clone(&session.stop);
        let launching = Launching {
            wanted: self.launching.launches,
            paths: paths.chain(self.trace).collect(),
            part: None,
            stop: &stop,
        };
        let programs = self.suite.programs();
        let faces = study_meshes.iter().map(|mesh| mesh.polygons.face_count());
        let work = Work {
            faces: programs.len() * faces.sum::<usize>(),
            entries: None,
            spare_s: 0.0,
        };
        let plan = launching.plan(self.settings.effort, work)?;
        warn_of_debug_build();
        print_meshes(&study_meshes, &mut session.text);
        for program in programs.iter().filter(|p| p.own_ns() != 0.0) {
            let line = format!(
                "{} ns of each run are the program's own work; added to every time",
                figure(program.own_ns())
            );
            session
                .text
                .print_line(&hanging_indent("Trace:    ", &line));
        }
        let kept = Kept::new(session, failed, self.launching.keep_going);
        let bar = Bar::new();
        if plan.is_here() {
            self.measure_here(&study_meshes, &kept, &bar, &stop)?;
        } else {
            let reports = study_meshes.iter().map(StudyMesh::report).collect();
            let results = plan.launched(Some(reports), &|done, what| bar.set(done, what));
            bar.clear();
            let results = results?;
            results
                .picks()
                .for_each(|report| kept.add(report, self.triangulate));
        }
        kept.finish()
    }

    /// Measures the programs in this process, and keeps the report of each.
    fn measure_here(
        &self,
        study_meshes: &[StudyMesh],
        kept: &Kept,
        bar: &Bar,
        stop: &Arc<AtomicBool>,
    ) -> Result<(), Failure> {
        kept.end_at(self.limits, Arc::clone(stop));
        let mut show = |done: f64, what: &str| {
            bar.set(done, what);
            kept.lock().begin_step(what);
        };
        let mut finished = |report: &PickReport| kept.add(report, self.triangulate);
        let reports = sixfold_study::pick_for_programs(
            study_meshes,
            self.suite,
            self.settings,
            stop,
            &mut show,
            &mut finished,
        );
        bar.clear();
        reports.map(|_| ()).map_err(Failure::usage)
    }
}

fn print_meshes(study_meshes: &[StudyMesh], text: &mut TextOutput) {
    for study_mesh in study_meshes {
        let vertices = counted(study_mesh.polygons.vertex_count(), "vertex", "vertices");
        let faces = counted(study_mesh.polygons.face_count(), "face", "faces");
        let line = format!("{}: {vertices}, {faces}", sanitize(&study_mesh.name));
        text.print_line(&hanging_indent("Mesh:     ", &line));
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
pub(crate) struct Limits {
    /// The time limit for the command.
    command: Duration,
    /// The time limit for each sample; `None` for no limit.
    sample: Option<Duration>,
    /// The limit of the memory of the process in bytes; `None` for no limit.
    memory: Option<u64>,
}

impl Limits {
    /// Returns the limits of a command that measures with `effort`, without a limit for each sample.
    pub(crate) fn new(effort: Effort, memory: Option<u64>) -> Self {
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
        if report.ranking.is_empty() && !report.interrupted {
            kept.none_qualifies.push(report.workload.name.clone());
        }
        if let Some(session) = &mut kept.session {
            let text = &mut session.text;
            text.print_line("");
            text.print_line(&hanging_indent(
                "Program:  ",
                &sanitize(&report.workload.name),
            ));
            text.print_line("");
            pick::print(report, text);
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
        let code = session.finish(results, kept.keep_going)?;
        if kept.none_qualifies.is_empty() || launches::has_ended_early() {
            return Ok(code);
        }
        print_stderr(&format!(
            "error: no structure qualifies for {}: relax --max-memory or --backends, use a longer \
             --budget, or repair the mesh (see `sixfold inspect`)",
            sanitize(&kept.none_qualifies.join(", "))
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

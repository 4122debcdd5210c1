//! Several launches of a command: fresh processes that measure the same.
//!
//! The first process reads the mesh, prints what is known before the measurement, starts one launch after the
//! other, and pools their documents. A launch is a process of the same program with the same arguments. The
//! environment tells it which launch it is and how much time it has. It prints nothing but its document, and
//! its progress to standard error as lines.

use std::env;
use std::io::{self, BufRead, BufReader, Read};
use std::num::NonZeroU32;
use std::path::Path;
use std::process::{ChildStderr, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use sixfold_results::numbers::counted;
use sixfold_results::{Finding, MeshReport, Results};
use sixfold_study::{Effort, LAUNCH_VARIABLE, pool_launches};

use crate::failure::Failure;
use crate::mesh_files::shown;
use crate::progress::{INTERRUPTED, LINES, PROGRESS, PROGRESS_MARK};
use crate::text::{print_notice, sanitize};

/// The first process looks this often whether it is interrupted.
const PATIENCE: Duration = Duration::from_millis(200);
/// Time of a launch on a small mesh by default. Fewer, longer launches would have wider intervals, and in shorter
/// launches too much of the time is for building and planning.
const USUAL_S: f64 = 4.0;
/// Minimum time of a launch on a small mesh.
const SHORTEST_S: f64 = 0.5;
/// Maximum number of launches by default. More launches hardly narrow the intervals.
const MOST_BY_DEFAULT: u32 = 20;
/// Minimum number of launches by default, if there are several. With two, intervals are three times as wide.
const FEWEST_BY_DEFAULT: u32 = 3;
/// Approximate time for reading, checking and building a mesh on all structures, for each face.
const SET_UP_S_PER_FACE: f64 = 4e-6;

/// The start of this process.
static START: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Notes the start of the process, for the budget.
pub(crate) fn note_start() {
    LazyLock::force(&START);
}

/// What a process is told that is one of several launches.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Launch {
    /// The number of the launch, from 0.
    number: u32,
    /// The time of the whole process in seconds; `None` if the number of rounds is fixed.
    budget_s: Option<f64>,
    /// The name of the mesh to measure, if the command has several.
    pub(crate) mesh: Option<String>,
}

impl Launch {
    /// Returns the launch that this process is; `None` if the user started it.
    pub(crate) fn current() -> Option<&'static Self> {
        static CURRENT: LazyLock<Option<Launch>> = LazyLock::new(|| {
            let text = env::var(LAUNCH_VARIABLE).ok()?;
            serde_json::from_str(&text).ok()
        });
        CURRENT.as_ref()
    }

    /// Returns how much this launch measures, if a whole command measures `effort`.
    pub(crate) fn effort(&self, effort: Effort) -> Effort {
        match self.budget_s {
            Some(budget_s) => {
                let budget = Duration::try_from_secs_f64(budget_s).unwrap_or_default();
                Effort::Budget(budget.saturating_sub(START.elapsed()))
            }
            None => effort,
        }
    }

    /// Returns the seed of this launch, if that of the command is `seed`: each launch has its own order of entries
    /// and its own samples of elements.
    fn seed(&self, seed: u64) -> u64 {
        seed.wrapping_add(u64::from(self.number))
    }

    /// Sets `stop` when the first process ends or asks for the end, by closing the standard input of this one.
    pub(crate) fn stop_with_parent(&self, stop: &Arc<AtomicBool>) {
        let stop = Arc::clone(stop);
        thread::spawn(move || {
            let _ = io::copy(&mut io::stdin(), &mut io::sink());
            stop.store(true, Ordering::Relaxed);
        });
    }
}

/// Returns the seed of this process, if that of the command is `seed`.
pub(crate) fn seed(seed: u64) -> u64 {
    Launch::current().map_or(seed, |launch| launch.seed(seed))
}

/// Returns the number of launches of a command that measures `effort` on the meshes `paths` with `faces` faces
/// together: `wanted`, or else as many as the budget holds.
///
/// # Errors
///
/// Returns an error if the budget does not hold `wanted` launches, or if a mesh cannot be read again.
pub(crate) fn count<'p>(
    wanted: Option<NonZeroU32>,
    effort: Effort,
    paths: impl IntoIterator<Item = &'p Path>,
    faces: usize,
) -> Result<u32, Failure> {
    if Launch::current().is_some() {
        return Ok(1);
    }
    if let Some(path) = paths.into_iter().find(|path| !path.is_file()) {
        return match wanted.map_or(1, NonZeroU32::get) {
            1 => Ok(1),
            wanted => Err(Failure::usage(format!(
                "{}: is not a file, so it cannot be read {wanted} times: save the mesh to a file, or use --launches 1",
                shown(path)
            ))),
        };
    }
    let Some(budget) = effort.budget() else {
        return Ok(wanted.map_or(1, NonZeroU32::get));
    };
    let budget_s = budget.as_secs_f64();
    let set_up_s = SET_UP_S_PER_FACE * faces as f64;
    let fit = |each_s: f64| (budget_s / each_s) as u32;
    let usual = fit(USUAL_S.max(4.0 * set_up_s)).min(MOST_BY_DEFAULT);
    let Some(wanted) = wanted.map(NonZeroU32::get) else {
        let fewest = FEWEST_BY_DEFAULT;
        let has_room = fit((USUAL_S / 2.0).max(2.0 * set_up_s)) >= fewest;
        return Ok(if has_room { usual.max(fewest) } else { 1 });
    };
    let most = fit(SHORTEST_S.max(2.0 * set_up_s)).max(1);
    if wanted > most {
        return Err(Failure::usage(format!(
            "--launches {wanted} is too many: a budget of {budget_s} s holds at most {} on this mesh; use fewer, or \
             a longer --budget",
            counted(most as usize, "launch", "launches")
        )));
    }
    Ok(wanted)
}

/// Runs `count` launches of this command one after the other within `effort`, and pools their documents. If the
/// command has several meshes, each launch measures the one called `mesh`. A launch that dies is left out with a
/// notice, see [`has_died`]. If the flag `stop` is set, the launch that runs ends early.
///
/// # Errors
///
/// Returns the failure of the first launch if it refuses to measure, or if no launch has a document.
fn run(
    count: u32,
    effort: Effort,
    mesh: Option<&str>,
    stop: &AtomicBool,
    show: &dyn Fn(f64, &str),
) -> Result<Results, Failure> {
    let start = match mesh {
        None => *START,
        Some(_) => Instant::now(),
    };
    let mut documents: Vec<Results> = Vec::new();
    let mut first_death = None;
    for number in 0..count {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let budget_s = effort.budget().map(|budget| {
            let left = budget.saturating_sub(start.elapsed());
            left.as_secs_f64() / f64::from(count - number)
        });
        let launch = Launch {
            number,
            budget_s,
            mesh: mesh.map(str::to_owned),
        };
        let position = format!("launch {} of {count}", number + 1);
        let show = |line: &str| {
            let step = line.split_once(" % ");
            let step = step.and_then(|(percent, what)| Some((percent.parse::<f64>().ok()?, what)));
            if let Some((percent, what)) = step {
                let done = (f64::from(number) + percent / 100.0) / f64::from(count);
                show(done, &format!("{position}: {what}"));
            }
        };
        match run_one(&launch, stop, &show) {
            Ok(document) => documents.push(document),
            // What one launch refuses, all refuse.
            Err(failure) if failure.code != DIED => return Err(failure),
            Err(failure) => {
                print_notice(&format!(
                    "note: {position} is left out: {}",
                    failure.message
                ));
                HAS_DIED.store(true, Ordering::Relaxed);
                first_death.get_or_insert(failure);
            }
        }
    }
    match first_death.filter(|_| documents.is_empty()) {
        Some(first) => Err(Failure::usage(format!(
            "no launch has a result: {}",
            first.message
        ))),
        None => pool_launches(documents).map_err(Failure::usage),
    }
}

/// How a command with one finding measures.
pub(crate) struct Plan<'p> {
    /// The number of launches; with one, this process measures.
    pub(crate) count: u32,
    /// How much the whole command measures.
    pub(crate) effort: Effort,
    /// The name of the mesh to measure, if the command has several.
    pub(crate) mesh: Option<&'p str>,
    /// The flag that ends the measurement.
    pub(crate) stop: &'p AtomicBool,
}

impl Plan<'_> {
    /// Measures in this process, by `here`, or in several launches, see [`run`]. A finding of several launches gets
    /// `meshes`, which this process has read, with their pictures; growth makes its own. `show` is called with the
    /// finished part, from 0 to 1, and the current step.
    ///
    /// # Errors
    ///
    /// Returns the errors of `here` or of [`run`], and an error if the command was interrupted before the first result.
    pub(crate) fn measure<T: TryFrom<Finding>>(
        &self,
        meshes: Option<Vec<MeshReport>>,
        show: &dyn Fn(f64, &str),
        here: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        if self.count == 1 {
            return here();
        }
        let results = run(self.count, self.effort, self.mesh, self.stop, show)?;
        let mut findings = results.findings.into_iter();
        let mut finding = findings.next().ok_or_else(interrupted_early)?;
        finding.run_mut().settings.budget_s = self.effort.run_settings().budget_s;
        if let Some(meshes) = meshes {
            finding.set_meshes(meshes).map_err(Failure::usage)?;
        }
        // An interruption between two launches is in none of them.
        if self.stop.load(Ordering::Relaxed) {
            finding.set_interrupted();
        }
        T::try_from(finding).map_err(|_| interrupted_early())
    }
}

/// Returns the failure of a command that was interrupted before its first launch had a result.
fn interrupted_early() -> Failure {
    Failure::usage("interrupted before the first result")
}

/// Whether a launch died.
static HAS_DIED: AtomicBool = AtomicBool::new(false);
/// The exit code that stands for a launch that died. No command has it.
const DIED: u8 = u8::MAX;

/// Returns whether a launch of this command died, so that the result lacks it.
pub(crate) fn has_died() -> bool {
    HAS_DIED.load(Ordering::Relaxed)
}

/// Runs one launch, and returns its document.
fn run_one(launch: &Launch, stop: &AtomicBool, show: &dyn Fn(&str)) -> Result<Results, Failure> {
    let died = |message: String| Failure {
        code: DIED,
        message,
    };
    let cannot_start = |cause: io::Error| died(format!("cannot start: {cause}"));
    let task = serde_json::to_string(launch).map_err(|cause| cannot_start(cause.into()))?;
    let mut child = Command::new(env::current_exe().map_err(cannot_start)?)
        .args(env::args_os().skip(1))
        .env(LAUNCH_VARIABLE, task)
        .env(PROGRESS, LINES)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(cannot_start)?;
    let (output, errors) = (child.stdout.take(), child.stderr.take());
    let output = thread::spawn(|| output.map(read_all));
    let lines = lines(errors);
    let mut said = Vec::new();
    loop {
        if stop.load(Ordering::Relaxed) {
            drop(child.stdin.take());
        }
        match lines.recv_timeout(PATIENCE) {
            Ok(line) => match line.strip_prefix(PROGRESS_MARK) {
                Some(progress) => show(progress),
                None => said.push(line),
            },
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    // Standard input stays open until here: the launch ends early if it is closed.
    let stdin = child.stdin.take();
    let status = child.wait().map_err(cannot_start)?;
    drop(stdin);
    let text = output.join().ok().flatten();
    document(status, &text.unwrap_or_default(), &said)
}

/// Returns the document of a launch that has ended.
fn document(status: ExitStatus, text: &str, said: &[String]) -> Result<Results, Failure> {
    let error = said.iter().find_map(|line| line.strip_prefix("error: "));
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    match (Results::read_json(text), code) {
        // Different results and interruptions are in the document.
        (Ok(results), Some(0 | 1 | INTERRUPTED)) => Ok(results),
        (_, Some(code)) if error.is_some() => Err(Failure {
            code,
            message: error.map(sanitize).unwrap_or_default(),
        }),
        (Ok(_), _) => Err(Failure {
            code: DIED,
            message: format!("it ended with {status}"),
        }),
        (Err(cause), _) => Err(Failure {
            code: DIED,
            message: format!("it ended with {status}, and its document {cause}"),
        }),
    }
}

fn read_all(mut output: ChildStdout) -> String {
    let mut bytes = Vec::new();
    // A launch that dies has an incomplete document, which cannot be parsed.
    let _ = output.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Returns the lines of `errors`, the standard error of a launch.
fn lines(errors: Option<ChildStderr>) -> Receiver<String> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let lines = errors
            .into_iter()
            .flat_map(|errors| BufReader::new(errors).lines());
        for line in lines.map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(seconds: f64) -> Effort {
        Effort::Budget(Duration::from_secs_f64(seconds))
    }

    const NO_FILES: [&Path; 0] = [];

    fn by_default(budget_s: f64, faces: usize) -> u32 {
        count(None, seconds(budget_s), NO_FILES, faces).expect("no number was given")
    }

    #[test]
    fn the_budget_and_the_mesh_choose_the_number_of_launches() {
        assert_eq!(
            [1.0, 5.9, 6.0, 11.9].map(|s| by_default(s, 1000)),
            [1, 1, 3, 3]
        );
        assert_eq!(
            [20.0, 60.0, 3600.0].map(|s| by_default(s, 1000)),
            [5, 15, 20]
        );
        // A million faces need 4 s to be read and built, and a launch should take four times that.
        assert_eq!(
            [20.0, 24.0, 80.0].map(|s| by_default(s, 1_000_000)),
            [1, 3, 5]
        );
        let rounds = Effort::Rounds(NonZeroU32::new(8).expect("above 0"));
        assert_eq!(count(None, rounds, NO_FILES, 1000).ok(), Some(1));
    }

    #[test]
    fn a_budget_holds_a_limited_number_of_launches() {
        let wanted = |n| count(NonZeroU32::new(n), seconds(2.0), NO_FILES, 1000);
        assert_eq!(wanted(4).ok(), Some(4));
        let refused = wanted(5).expect_err("too many");
        assert_eq!(refused.code, 2);
        let message = refused.message;
        assert!(
            message.contains("a budget of 2 s holds at most 4 launches"),
            "{message}"
        );
        let rounds = Effort::Rounds(NonZeroU32::MIN);
        assert_eq!(
            count(NonZeroU32::new(500), rounds, NO_FILES, 1000).ok(),
            Some(500)
        );
    }
}

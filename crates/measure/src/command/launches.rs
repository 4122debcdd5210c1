//! Several launches of a command: fresh processes that measure the same.
//!
//! The first process reads the mesh, prints what is known before the measurement, starts one launch after the
//! other, and pools their documents. A launch is a process of the same program with the same arguments. The
//! environment tells it which launch it is, how much time it has and which part of the command it measures. It
//! prints its document, and its progress to standard error as lines.

use std::env;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::num::NonZeroU32;
use std::path::Path;
use std::process::{ChildStdout, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::engine::effort::Effort;
use crate::launches::LAUNCH_VARIABLE;
use serde::{Deserialize, Serialize};
use sixfold_results::numbers::{approximate, counted};
use sixfold_results::{Finding, MergeError, MeshReport, Results};

use crate::command::failure::Failure;
use crate::command::mesh_files::shown;
use crate::command::progress::{INTERRUPTED, LINES, PROGRESS, PROGRESS_MARK};
use crate::command::text::{print_notice, sanitize};

/// The first process looks this often whether it is interrupted.
const PATIENCE: Duration = Duration::from_millis(200);
/// Approximate time of a round of one operation on one structure, with its part of the building and planning. A launch
/// has about one round of a whole study: what differs from launch to launch is more than what differs from round to
/// round.
const ENTRY_S: f64 = 0.025;
/// Least and most time of a launch on a small mesh by default. In shorter launches too much of the time is for building
/// and planning; of longer ones there would be fewer, with wider intervals.
const USUAL_S: [f64; 2] = [1.0, 4.0];
/// Minimum time of a launch on a small mesh.
const SHORTEST_S: f64 = 0.5;
/// Maximum number of launches by default.
const MOST_BY_DEFAULT: u32 = 60;
/// Minimum number of launches by default, if there are several. With two, intervals are three times as wide.
const FEWEST_BY_DEFAULT: u32 = 3;
/// Approximate time for reading, checking and building a mesh on all structures, for each face.
const SET_UP_S_PER_FACE: f64 = 4e-6;

/// The start of this process.
static START: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Notes the start of the process, for the budget.
pub fn note_start() {
    LazyLock::force(&START);
}

/// What a process is told that is one of several launches.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Launch {
    /// The number of the launch, from 0.
    number: u32,
    /// The time of the whole process in seconds; `None` if the number of rounds is fixed.
    budget_s: Option<f64>,
    /// The part of the command to measure, if it has several.
    pub part: Option<Part>,
}

/// A part of a command that has launches of its own.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Part {
    /// The study of the mesh with this name.
    Mesh(String),
    /// A lab of the report.
    Lab(String),
}

impl Launch {
    /// Returns the launch that this process is; `None` if the user started it.
    pub fn current() -> Option<&'static Self> {
        static CURRENT: LazyLock<Option<Launch>> = LazyLock::new(|| {
            let text = env::var(LAUNCH_VARIABLE).ok()?;
            serde_json::from_str(&text).ok()
        });
        CURRENT.as_ref()
    }

    /// Sets `stop` when the first process ends or asks for the end, by closing the standard input of this one.
    pub fn stop_with_parent(&self, stop: &Arc<AtomicBool>) {
        let stop = Arc::clone(stop);
        thread::spawn(move || {
            let _ = io::copy(&mut io::stdin(), &mut io::sink());
            stop.store(true, Ordering::Relaxed);
        });
    }
}

/// Returns how much this process measures, if the command measures `effort`: a launch has a part of the time.
pub fn effort(effort: Effort) -> Effort {
    match Launch::current().and_then(|launch| launch.budget_s) {
        Some(budget_s) => {
            let budget = Duration::try_from_secs_f64(budget_s).unwrap_or_default();
            Effort::Budget(budget.saturating_sub(START.elapsed()))
        }
        None => effort,
    }
}

/// Returns the seed of this process, if that of the command is `seed`: each launch has its own order of entries and
/// its own samples of elements.
pub fn seed(seed: u64) -> u64 {
    let number = Launch::current().map_or(0, |launch| launch.number);
    seed.wrapping_add(u64::from(number))
}

/// What each launch does.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// The number of faces of the meshes that are read, and built on all structures.
    pub faces: usize,
    /// The number of times that are taken in a round; `None` if each may take any time.
    pub entries: Option<usize>,
    /// The time in seconds of what is left out if the budget is short.
    pub spare_s: f64,
}

/// Returns the length of a list of chosen names, of which an empty one stands for `all`.
pub fn chosen<T>(list: &[T], all: usize) -> usize {
    match list.len() {
        0 => all,
        given => given,
    }
}

impl Work {
    /// Returns the work to measure this number of `operations` on a mesh with `faces` faces. An empty list of `backends`
    /// stands for all structures.
    pub fn new(faces: usize, operations: usize, backends: &[String]) -> Self {
        let structures = sixfold::structure_infos().len();
        Self {
            faces,
            entries: Some(operations * chosen(backends, structures)),
            spare_s: 0.0,
        }
    }

    /// Returns the work on `count` times as many meshes.
    pub fn times(self, count: usize) -> Self {
        Self {
            faces: count * self.faces,
            entries: self.entries.map(|entries| count * entries),
            ..self
        }
    }

    /// Returns the approximate time to read and build the meshes.
    fn set_up_s(self) -> f64 {
        SET_UP_S_PER_FACE * self.faces as f64
    }

    /// Returns the usual time of a launch.
    fn usual_s(self) -> f64 {
        let [least, most] = USUAL_S;
        let round_s = self
            .entries
            .map_or(most, |entries| ENTRY_S * entries as f64);
        let before_s = self.set_up_s() + self.spare_s;
        round_s.clamp(least, most).max(4.0 * before_s)
    }

    /// Says what is needed, if that is more than the budget.
    fn too_short(self, budget_s: f64) -> Option<String> {
        // Besides building, everything is run once.
        let needed_s = 2.0 * self.set_up_s();
        (needed_s > budget_s).then(|| {
            format!(
                "note: to build and run everything once takes about {} s, longer than the budget of {budget_s} s",
                approximate(needed_s)
            )
        })
    }
}

/// What a command launches.
pub struct Launching<'p> {
    /// The number of launches that the user wants; `None` for as many as the budget holds.
    pub wanted: Option<NonZeroU32>,
    /// The files that each launch reads again.
    pub paths: Vec<&'p Path>,
    /// The part of the command that is measured, if it has several.
    pub part: Option<Part>,
    /// The flag that ends the measurement.
    pub stop: &'p AtomicBool,
    /// Pools the documents of the launches.
    pub pool: Pool,
}

/// Pools documents of the same work, one for each launch, as one document.
pub type Pool = fn(Vec<Results>) -> Result<Results, MergeError>;

impl<'p> Launching<'p> {
    /// Returns the plan to measure `effort`.
    ///
    /// # Errors
    ///
    /// Returns an error if the budget does not hold the wanted number of launches, or if a mesh cannot be read
    /// again. A lab of a report then has as many launches as its budget holds.
    pub fn plan(&self, effort: Effort, work: Work) -> Result<Plan<'p>, Failure> {
        Ok(Plan {
            count: self.count(effort, work)?,
            effort,
            part: self.part.clone(),
            stop: self.stop,
            pool: self.pool,
        })
    }

    /// Returns the number of launches.
    fn count(&self, effort: Effort, work: Work) -> Result<u32, Failure> {
        if Launch::current().is_some() {
            return Ok(1);
        }
        let wanted = self.wanted.map(NonZeroU32::get);
        if let Some(path) = self.paths.iter().find(|path| !path.is_file()) {
            return match wanted.unwrap_or(1) {
                1 => Ok(1),
                wanted => Err(Failure::usage(format!(
                    "{}: is not a file, so it cannot be read {wanted} times: save it to a file, or use --launches 1",
                    shown(path)
                ))),
            };
        }
        let Some(budget) = effort.budget() else {
            return Ok(wanted.unwrap_or(1));
        };
        let budget_s = budget.as_secs_f64();
        let (set_up_s, usual_s) = (work.set_up_s() + work.spare_s, work.usual_s());
        // The time of a lab is a part of that of the command.
        let is_lab = matches!(self.part, Some(Part::Lab(_)));
        if let Some(note) = work.too_short(budget_s).filter(|_| !is_lab) {
            print_notice(&note);
        }
        let fit = |each_s: f64| (budget_s / each_s) as u32;
        let Some(wanted) = wanted else {
            let (fewest, usual) = (FEWEST_BY_DEFAULT, fit(usual_s).min(MOST_BY_DEFAULT));
            let has_room = fit(usual_s / 2.0) >= fewest;
            return Ok(if has_room { usual.max(fewest) } else { 1 });
        };
        let most = fit(SHORTEST_S.max(2.0 * set_up_s)).max(1);
        if wanted <= most {
            return Ok(wanted);
        }
        let held = format!(
            "a budget of {budget_s} s holds at most {}",
            counted(most as usize, "launch", "launches")
        );
        match &self.part {
            Some(Part::Lab(lab)) => {
                print_notice(&format!(
                    "note: {lab} does not have {wanted} launches: {held}"
                ));
                Ok(most)
            }
            _ => Err(Failure::usage(format!(
                "--launches {wanted} is too many: {held} on this mesh; use fewer, or a longer --budget"
            ))),
        }
    }
}

/// How a command, or a part of it, measures.
pub struct Plan<'p> {
    /// The number of launches; with one, this process measures.
    count: u32,
    /// How much all launches measure together.
    effort: Effort,
    part: Option<Part>,
    stop: &'p AtomicBool,
    pool: Pool,
}

impl Plan<'_> {
    /// Returns whether this process measures, and no launch.
    pub const fn is_here(&self) -> bool {
        self.count == 1
    }

    /// Measures one finding in this process, by `here`, or in several launches, see [`launched`](Self::launched).
    ///
    /// # Errors
    ///
    /// Returns the errors of `here` or of the launches.
    pub fn measure<T: TryFrom<Finding>>(
        &self,
        meshes: Option<Vec<MeshReport>>,
        show: &dyn Fn(f64, &str),
        here: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        if self.is_here() {
            return here();
        }
        let results = self.launched(meshes, show)?;
        let mut findings = results.findings.into_iter();
        let finding = findings.next().ok_or_else(interrupted_early)?;
        T::try_from(finding).map_err(|_| interrupted_early())
    }

    /// Measures in several launches. The findings get `meshes`, which this process has read, with their pictures;
    /// growth makes its own. `show` is called with the finished part, from 0 to 1, and the current step.
    ///
    /// # Errors
    ///
    /// Returns the failure of the first launch if it refuses to measure, or if no launch has a document. Returns an
    /// error if the command was interrupted before the first result.
    pub fn launched(
        &self,
        meshes: Option<Vec<MeshReport>>,
        show: &dyn Fn(f64, &str),
    ) -> Result<Results, Failure> {
        let mut results = self.run(show)?;
        let is_stopped = self.stop.load(Ordering::Relaxed);
        if is_stopped && results.findings.is_empty() && !has_ended_early() {
            return Err(interrupted_early());
        }
        for finding in &mut results.findings {
            finding.run_mut().settings.budget_s = self.effort.run_settings().budget_s;
            if let Some(meshes) = &meshes {
                finding.set_meshes(meshes.clone()).map_err(Failure::usage)?;
            }
            // An interruption between two launches is in none of them.
            if is_stopped {
                finding.set_interrupted();
            }
        }
        Ok(results)
    }

    /// Runs the launches one after the other, and pools their documents. A launch that dies is left out with a
    /// notice, see [`has_died`]. A launch that ends early by itself is the last one, see [`has_ended_early`]. If the
    /// flag `stop` is set, the launch that runs ends early.
    fn run(&self, show: &dyn Fn(f64, &str)) -> Result<Results, Failure> {
        let count = self.count;
        let start = match self.part {
            None => *START,
            Some(_) => Instant::now(),
        };
        let mut documents: Vec<Results> = Vec::new();
        let mut first_death = None;
        for number in 0..count {
            if self.stop.load(Ordering::Relaxed) {
                break;
            }
            let budget_s = self.effort.budget().map(|budget| {
                let left = budget.saturating_sub(start.elapsed());
                left.as_secs_f64() / f64::from(count - number)
            });
            let launch = Launch {
                number,
                budget_s,
                part: self.part.clone(),
            };
            let position = format!("launch {} of {count}", number + 1);
            let show = |line: &str| {
                let step = line.split_once(" % ");
                let step =
                    step.and_then(|(percent, what)| Some((percent.parse::<f64>().ok()?, what)));
                if let Some((percent, what)) = step {
                    let done = (f64::from(number) + percent / 100.0) / f64::from(count);
                    show(done, &format!("{position}: {what}"));
                }
            };
            match run_one(&launch, self.stop, &show) {
                Ok((document, ended_early)) => {
                    documents.push(document);
                    // The next launch would not end either.
                    if let Some(why) = ended_early {
                        print_notice(&format!("error: {position} is the last one: {why}"));
                        HAS_ENDED_EARLY.store(true, Ordering::Relaxed);
                        break;
                    }
                }
                // What one launch refuses, all refuse.
                Err(failure) if failure.code != DIED => return Err(failure),
                Err(failure) => {
                    let of = match &self.part {
                        Some(Part::Lab(lab)) => format!(" of {lab}"),
                        Some(Part::Mesh(_)) | None => String::new(),
                    };
                    print_notice(&format!(
                        "note: {position}{of} is left out: {}",
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
            None => (self.pool)(documents).map_err(Failure::usage),
        }
    }
}

/// Returns the failure of a command that was interrupted before its first launch had a result.
fn interrupted_early() -> Failure {
    Failure::usage("interrupted before the first result")
}

/// Whether a launch died.
static HAS_DIED: AtomicBool = AtomicBool::new(false);
/// Whether a launch ended early by itself.
static HAS_ENDED_EARLY: AtomicBool = AtomicBool::new(false);
/// The exit code that stands for a launch that died. No command has it.
const DIED: u8 = u8::MAX;

/// Returns whether a launch of this command died, so that the result lacks it.
pub fn has_died() -> bool {
    HAS_DIED.load(Ordering::Relaxed)
}

/// Returns whether a launch of this command ended early because a program of a user did not end, so that the result
/// lacks what follows.
pub fn has_ended_early() -> bool {
    HAS_ENDED_EARLY.load(Ordering::Relaxed)
}

/// The line before the document of a launch. A program of a user may print other lines before it.
const DOCUMENT_MARK: &[u8] = b"the document of a launch of sixfold:\n";

/// Writes the line before a document, if this process is a launch.
pub fn mark_document(writer: &mut dyn Write) -> io::Result<()> {
    if Launch::current().is_none() {
        return Ok(());
    }
    // The last line of a program may be incomplete.
    writer.write_all(b"\n")?;
    writer.write_all(DOCUMENT_MARK)
}

/// Runs one launch. Returns its document, and the reason if the launch ended early by itself.
fn run_one(
    launch: &Launch,
    stop: &AtomicBool,
    show: &dyn Fn(&str),
) -> Result<(Results, Option<String>), Failure> {
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
    let output = thread::spawn(|| output.map(read_document));
    let lines = lines(errors);
    let mut said = Said::default();
    loop {
        if stop.load(Ordering::Relaxed) {
            drop(child.stdin.take());
        }
        match lines.recv_timeout(PATIENCE) {
            Ok(line) => match line.strip_prefix(PROGRESS_MARK) {
                Some(progress) => show(progress),
                None => said.add(line),
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
    document(status, &text.unwrap_or_default(), said)
}

/// What a launch wrote to standard error besides its progress.
#[derive(Default)]
struct Said {
    /// The first error message.
    error: Option<String>,
    /// The last line, without notes.
    last: String,
}

impl Said {
    fn add(&mut self, line: String) {
        if let (None, Some(message)) = (&self.error, line.strip_prefix("error: ")) {
            self.error = Some(sanitize(message));
        }
        if !line.starts_with("note: ") {
            self.last = line;
        }
    }
}

/// Returns the document of a launch that has ended, and the reason if it ended early by itself.
fn document(
    status: ExitStatus,
    text: &str,
    said: Said,
) -> Result<(Results, Option<String>), Failure> {
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    let died = |what: String| Failure {
        code: DIED,
        message: match sanitize(&said.last) {
            last if last.is_empty() => what,
            last => format!("{what}; its last line was: {last}"),
        },
    };
    match (Results::read_json(text), code, said.error) {
        // A program that did not end.
        (Ok(results), Some(INTERRUPTED), error) => Ok((results, error)),
        // Different results are in the document.
        (Ok(results), Some(0 | 1), _) => Ok((results, None)),
        (_, Some(code), Some(message)) => Err(Failure { code, message }),
        (Ok(_), ..) => Err(died(format!("it ended with {status}"))),
        (Err(_), None, _) if text.is_empty() => Err(died(format!("it ended with {status}"))),
        (Err(_), ..) if text.is_empty() => {
            Err(died(format!("it ended with {status}, without a document")))
        }
        (Err(cause), ..) => Err(died(format!(
            "it ended with {status}, and its document {cause}"
        ))),
    }
}

/// Returns what follows the last [`DOCUMENT_MARK`]; an empty text without one.
fn read_document(output: ChildStdout) -> String {
    let mut document = None;
    for_each_line(output, |line| {
        match &mut document {
            _ if line == DOCUMENT_MARK => document = Some(Vec::new()),
            Some(document) => document.extend_from_slice(line),
            None => {}
        }
        true
    });
    String::from_utf8_lossy(&document.unwrap_or_default()).into_owned()
}

/// Returns the lines of `errors`, the standard error of a launch.
fn lines(errors: Option<impl Read + Send + 'static>) -> Receiver<String> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let Some(errors) = errors else { return };
        for_each_line(errors, |line| {
            let line = String::from_utf8_lossy(line);
            sender.send(line.trim_end().to_owned()).is_ok()
        });
    });
    receiver
}

/// Calls `take` with each line of `input`, until it returns false.
fn for_each_line(input: impl Read, mut take: impl FnMut(&[u8]) -> bool) {
    let mut input = BufReader::new(input);
    let mut line = Vec::new();
    // A launch that dies has an incomplete document, which cannot be parsed.
    while input
        .read_until(b'\n', &mut line)
        .is_ok_and(|count| count > 0)
        && take(&line)
    {
        line.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(seconds: f64) -> Effort {
        Effort::Budget(Duration::from_secs_f64(seconds))
    }

    const STUDY: Work = Work {
        faces: 1000,
        entries: Some(28 * 6),
        spare_s: 0.0,
    };

    fn count(wanted: Option<u32>, effort: Effort, work: Work) -> Result<u32, Failure> {
        let launching = Launching {
            wanted: wanted.and_then(NonZeroU32::new),
            paths: Vec::new(),
            part: None,
            stop: &AtomicBool::new(false),
            pool: |_| Ok(Results::default()),
        };
        launching.count(effort, work)
    }

    fn by_default(budget_s: f64, work: Work) -> u32 {
        count(None, seconds(budget_s), work).expect("no number was given")
    }

    #[test]
    fn the_budget_and_the_work_choose_the_number_of_launches() {
        assert_eq!(
            [1.0, 5.9, 6.0, 11.9].map(|s| by_default(s, STUDY)),
            [1, 1, 3, 3]
        );
        let budgets = [20.0, 60.0, 3600.0];
        assert_eq!(budgets.map(|s| by_default(s, STUDY)), [5, 15, 60]);
        // Two operations need a launch of a second; what programs need is not known.
        let named = Work::new(1000, 2, &[]);
        assert_eq!(budgets.map(|s| by_default(s, named)), [20, 60, 60]);
        let program = Work {
            entries: None,
            ..STUDY
        };
        assert_eq!(budgets.map(|s| by_default(s, program)), [5, 15, 60]);
        let one = Work::new(1000, 2, &["half-edge".into()]);
        assert_eq!((named.entries, one.entries), (Some(12), Some(2)));
        assert_eq!([chosen(&["build"], 28), chosen::<&str>(&[], 28)], [1, 28]);
        let explained = Work {
            spare_s: 2.0,
            ..named
        };
        assert_eq!(budgets.map(|s| by_default(s, explained)), [3, 7, 60]);
        // A million faces need 4 s to be read and built, and a launch should take four times that.
        let large = Work {
            faces: 1_000_000,
            ..STUDY
        };
        assert_eq!([20.0, 24.0, 80.0].map(|s| by_default(s, large)), [1, 3, 5]);
        let rounds = Effort::Rounds(NonZeroU32::new(8).expect("above 0"));
        assert_eq!(count(None, rounds, STUDY).ok(), Some(1));
    }

    #[test]
    fn a_command_says_what_it_needs_if_the_budget_is_too_short() {
        let work = Work {
            faces: 1_250_000,
            ..STUDY
        };
        let note = work.too_short(5.0).expect("too short");
        assert!(
            note.contains("about 10 s, longer than the budget of 5 s"),
            "{note}"
        );
        assert_eq!(work.too_short(20.0), None);
        let spare = Work {
            spare_s: 100.0,
            ..STUDY
        };
        assert_eq!(spare.too_short(1.0), None, "it is left out");
    }

    #[test]
    fn a_budget_holds_a_limited_number_of_launches() {
        let wanted = |n| count(Some(n), seconds(2.0), STUDY);
        assert_eq!(wanted(4).ok(), Some(4));
        let refused = wanted(5).expect_err("too many");
        assert_eq!(refused.code, 2);
        let message = refused.message;
        assert!(
            message.contains("a budget of 2 s holds at most 4 launches"),
            "{message}"
        );
        let rounds = Effort::Rounds(NonZeroU32::MIN);
        assert_eq!(count(Some(500), rounds, STUDY).ok(), Some(500));
    }
}

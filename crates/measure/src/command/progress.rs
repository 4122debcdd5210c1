//! Progress of a measurement, and the handling of Ctrl-C.

use std::cell::{Cell, RefCell};
use std::io::{self, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use sixfold_results::Policy;

use crate::command::launches::Launch;
use crate::command::output::exit_without_drafts;
use crate::command::text::{print_stderr, sanitize};
use crate::pages::HeapGuard;

/// The environment variable that asks for progress as lines, if its value is `lines`.
pub const PROGRESS: &str = "SIXFOLD_PROGRESS";
/// The value of [`PROGRESS`] that asks for lines.
pub const LINES: &str = "lines";
/// The start of a line of progress.
pub const PROGRESS_MARK: &str = "progress: ";
/// Width of the line on a terminal.
const WIDTH: usize = 79;
/// The line on a terminal changes at most this often.
const INTERVAL: Duration = Duration::from_millis(100);

/// Prints a step as a line, if the environment asks for lines.
pub fn print_step(what: &str) {
    if std::env::var_os(PROGRESS).is_some_and(|value| value == LINES) {
        print_stderr(&format!("{PROGRESS_MARK}{}", sanitize(what)));
    }
}

/// The last percentage that a launch told the first process, and what was measured.
#[derive(Debug)]
pub struct Told(RefCell<(u64, String)>);

impl Default for Told {
    fn default() -> Self {
        Self(RefCell::new((u64::MAX, String::new())))
    }
}

impl Told {
    /// Prints the finished part, from 0 to 1, and the current step, which may begin with what is measured, such as
    /// `geodesics: `, if the environment asks for lines.
    pub fn print(&self, done: f64, prefix: &str, what: &str) {
        let percent = (100.0 * done) as u64;
        // The first process wakes up for each line, which would disturb the samples.
        if Launch::current().is_some() {
            let measured = what.split_once(": ").map_or("", |(measured, _)| measured);
            let new = (percent, measured.to_owned());
            if self.0.replace(new.clone()) == new {
                return;
            }
        }
        print_step(&format!("{percent} % {prefix}{what}"));
    }
}

/// A line with the progress on standard error. Without a terminal, it is shown only if the environment asks for lines.
pub struct Line {
    is_terminal: bool,
    told: Told,
    shown: Cell<Option<Instant>>,
}

impl Line {
    /// Makes a line that is not shown yet.
    pub fn new() -> Self {
        Self {
            is_terminal: io::stderr().is_terminal(),
            told: Told::default(),
            shown: Cell::new(None),
        }
    }

    /// Shows the finished part, from 0 to 1, and the current step.
    pub fn set(&self, done: f64, what: &str) {
        if !self.is_terminal {
            return self.told.print(done, "", what);
        }
        if self
            .shown
            .get()
            .is_some_and(|last| last.elapsed() < INTERVAL)
        {
            return;
        }
        self.shown.set(Some(Instant::now()));
        let text = format!("{:>3.0} %  {}", 100.0 * done, sanitize(what));
        let text: String = text.chars().take(WIDTH).collect();
        // Errors of printing progress do not matter.
        let _ = write!(io::stderr().lock(), "\r\x1b[K{text}");
    }

    /// Removes the line.
    pub fn clear(&self) {
        if self.is_terminal && self.shown.take().is_some() {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}

impl Default for Line {
    fn default() -> Self {
        Self::new()
    }
}

/// The exit code of an interrupted command.
pub const INTERRUPTED: u8 = 4;

/// Returns a flag that the first Ctrl-C sets. The second Ctrl-C ends the program.
///
/// The policy `heap` is applied first: the handler starts a thread, and glibc reads the number of
/// heaps when the first thread starts.
pub fn interrupt_flag(heap: Policy) -> Arc<AtomicBool> {
    // No policy is active yet. If one were, the measurement would report the conflict.
    if let Ok(guard) = HeapGuard::acquire(heap) {
        guard.hold_until_exit();
    }
    /// The exit code that shells use for an interrupted program.
    const SIGINT_CODE: i32 = 130;
    let flag = Arc::new(AtomicBool::new(false));
    let handler_flag = Arc::clone(&flag);
    // If the handler cannot be set, Ctrl-C keeps its default effect.
    let _ = ctrlc::set_handler(move || {
        if handler_flag.swap(true, Ordering::Relaxed) {
            exit_without_drafts(SIGINT_CODE);
        }
    });
    flag
}

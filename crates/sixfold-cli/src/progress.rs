//! Progress on a terminal, and what Ctrl-C does.

use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use ::study::{Policy, Progress, pages};
use indicatif::{ProgressBar, ProgressStyle};

use crate::output::exit_without_drafts;
use crate::text::complain;

/// How finely the bar moves.
const STEPS: u64 = 1000;

/// A bar on standard error, if that is a terminal.
pub(crate) struct Bar(Option<ProgressBar>);

impl Bar {
    /// An empty bar.
    pub(crate) fn new() -> Self {
        if !io::stderr().is_terminal() {
            return Self(None);
        }
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(Some(ProgressBar::new(STEPS).with_style(style)))
    }

    /// Shows how much is done, and what is going on.
    pub(crate) fn at(&self, done: f64, what: &str) {
        let Self(Some(bar)) = self else { return };
        bar.set_position((done * STEPS as f64) as u64);
        bar.set_message(what.to_owned());
    }

    /// Shows where the study stands.
    pub(crate) fn show(&self, progress: Progress<'_>) {
        let Progress {
            done,
            stage,
            operation,
            backend,
        } = progress;
        self.at(done, &format!("{stage} {operation} on {backend}"));
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        if let Self(Some(bar)) = self {
            bar.finish_and_clear();
        }
    }
}

/// A bar of faces that have been made, on standard error if that is a terminal.
pub(crate) struct Faces(Option<ProgressBar>);

impl Faces {
    /// A bar for work that makes `faces` in all.
    pub(crate) fn of(faces: usize) -> Self {
        if !io::stderr().is_terminal() {
            return Self(None);
        }
        let style = ProgressStyle::with_template("{bar:30} {human_pos} faces, {per_sec} {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(faces as u64).with_style(style);
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(Some(bar))
    }

    /// Counts `faces` more, made by level `level`.
    pub(crate) fn made(&self, level: u32, faces: usize) {
        let Self(Some(bar)) = self else { return };
        bar.inc(faces as u64);
        bar.set_message(format!("level {level} done"));
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        if let Self(Some(bar)) = self {
            bar.finish_and_clear();
        }
    }
}

/// A bar of steps of any kind, on standard error if that is a terminal.
pub(crate) struct Steps(Option<ProgressBar>);

impl Steps {
    /// A bar for so many steps; `what` says what they are.
    pub(crate) fn of(steps: usize, what: &str) -> Self {
        if !io::stderr().is_terminal() {
            return Self(None);
        }
        let style = ProgressStyle::with_template("{bar:30} {human_pos} of {human_len} {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(steps as u64).with_style(style);
        bar.set_message(what.to_owned());
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(Some(bar))
    }

    /// Shows that so many of them are done.
    pub(crate) fn reached(&self, steps: usize) {
        if let Self(Some(bar)) = self {
            bar.set_position(steps as u64);
        }
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        if let Self(Some(bar)) = self {
            bar.finish_and_clear();
        }
    }
}

/// A line that turns while something takes a while, on standard error if that is a terminal.
pub(crate) struct Waiting(Option<ProgressBar>);

impl Waiting {
    /// Says what is being done.
    pub(crate) fn shown(what: String) -> Self {
        if !io::stderr().is_terminal() {
            return Self(None);
        }
        let line = ProgressBar::new_spinner().with_message(what);
        line.enable_steady_tick(Duration::from_millis(100));
        Self(Some(line))
    }

    /// Takes the line away.
    pub(crate) fn clear(&self) {
        if let Self(Some(line)) = self {
            line.finish_and_clear();
        }
    }
}

/// A line that says what is being done, on standard error if that is a terminal. It stands still: no
/// thread of its own allocates while somebody counts.
pub(crate) struct Stage(Option<ProgressBar>);

impl Stage {
    /// An empty line.
    pub(crate) fn new() -> Self {
        let shown = io::stderr().is_terminal();
        Self(shown.then(ProgressBar::new_spinner))
    }

    /// Says what is next.
    pub(crate) fn show(&self, what: String) {
        if let Self(Some(line)) = self {
            line.set_message(what);
            line.tick();
        }
    }

    /// Takes the line away.
    pub(crate) fn clear(&self) {
        if let Self(Some(line)) = self {
            line.finish_and_clear();
        }
    }
}

/// The exit code of a command that was ended before its time.
pub(crate) const INTERRUPTED: u8 = 4;

/// Ends the program at the first Ctrl-C, for commands with no part worth keeping.
pub(crate) fn end_on_interrupt() {
    // Where there can be no handler, Ctrl-C does what it always did.
    let _ = ctrlc::set_handler(|| {
        complain("interrupted");
        exit_without_drafts(INTERRUPTED.into());
    });
}

/// A flag that the first Ctrl-C sets; the second ends the program at once.
///
/// Puts `heap` in force first: the handler has a thread of its own, and the number of heaps is fixed when
/// the first thread starts.
pub(crate) fn interrupt_flag(heap: Policy) -> Arc<AtomicBool> {
    pages::put_in_force(heap);
    /// What shells expect of a program that was interrupted.
    const AT_ONCE: i32 = 130;
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    // Where there can be no handler, Ctrl-C does what it always did.
    let _ = ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            exit_without_drafts(AT_ONCE);
        }
    });
    flag
}

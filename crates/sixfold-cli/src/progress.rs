//! Progress bars on a terminal, progress as lines, and the handling of Ctrl-C.

use std::cell::RefCell;
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use sixfold_results::Policy;
use sixfold_study::{HeapGuard, Progress};

use crate::launches::Launch;
use crate::output::exit_without_drafts;
use crate::text::{print_stderr, sanitize};

/// Number of steps of a full bar.
const STEPS: u64 = 1000;

/// The environment variable that asks for progress as lines, if its value is `lines`.
pub(crate) const PROGRESS: &str = "SIXFOLD_PROGRESS";
/// The value of [`PROGRESS`] that asks for lines.
pub(crate) const LINES: &str = "lines";
/// The start of a line of progress.
pub(crate) const PROGRESS_MARK: &str = "progress: ";

/// Prints a step as a line, if the environment asks for lines.
fn print_step(what: &str) {
    if std::env::var_os(PROGRESS).is_some_and(|value| value == LINES) {
        print_stderr(&format!("{PROGRESS_MARK}{}", sanitize(what)));
    }
}

/// A progress bar on standard error. Without a terminal, it is shown only if the environment asks for
/// lines.
pub(crate) struct Bar {
    bar: Option<ProgressBar>,
    prefix: String,
    /// The last percentage that a launch told the first process, and what was measured.
    told: RefCell<(u64, String)>,
}

impl Bar {
    pub(crate) fn new() -> Self {
        Self::after("")
    }

    /// Returns a bar whose texts begin with `prefix`, such as `2 of 4: `.
    pub(crate) fn after(prefix: &str) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(
                "{bar:30} {percent:>3} %  {eta:>3} left  {prefix}{msg}",
            );
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(STEPS).with_style(style);
            bar.with_prefix(prefix.to_owned())
        });
        Self {
            bar,
            prefix: prefix.to_owned(),
            told: RefCell::new((u64::MAX, String::new())),
        }
    }

    /// Shows the finished part, from 0 to 1, and the current step, which may begin with what is measured, such as
    /// `geodesics: `.
    pub(crate) fn set(&self, done: f64, what: &str) {
        let Some(bar) = &self.bar else {
            let percent = (100.0 * done) as u64;
            // The first process wakes up for each line, which would disturb the samples.
            if Launch::current().is_some() {
                let measured = what.split_once(": ").map_or("", |(measured, _)| measured);
                let new = (percent, measured.to_owned());
                if self.told.replace(new.clone()) == new {
                    return;
                }
            }
            return print_step(&format!("{percent} % {}{what}", self.prefix));
        };
        bar.set_position((done * STEPS as f64) as u64);
        bar.set_message(what.to_owned());
    }

    pub(crate) fn show(&self, progress: Progress<'_>) {
        self.set(progress.done, &progress.step());
    }

    pub(crate) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A progress bar for new faces. It is shown only on a terminal.
pub(crate) struct FaceBar(Option<ProgressBar>);

impl FaceBar {
    /// Returns a bar for work that makes `faces` faces in total.
    pub(crate) fn new(faces: usize) -> Self {
        if !io::stderr().is_terminal() {
            return Self(None);
        }
        let style = ProgressStyle::with_template("{bar:30} {human_pos} faces, {per_sec} {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(faces as u64).with_style(style);
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(Some(bar))
    }

    pub(crate) fn add_level(&self, level: u32, faces: usize) {
        let Self(Some(bar)) = self else { return };
        bar.inc(faces as u64);
        bar.set_message(format!("level {level} done"));
    }

    pub(crate) fn clear(&self) {
        if let Self(Some(bar)) = self {
            bar.finish_and_clear();
        }
    }
}

/// A progress bar for steps. Without a terminal, it is shown only if the environment asks for lines.
pub(crate) struct StepBar {
    bar: Option<ProgressBar>,
    what: String,
}

impl StepBar {
    /// Returns a bar for `steps` steps. `what` describes the steps.
    pub(crate) fn new(steps: usize, what: &str) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{bar:30} {human_pos} of {human_len} {msg}");
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(steps as u64).with_style(style);
            bar.set_message(what.to_owned());
            bar.enable_steady_tick(Duration::from_millis(100));
            bar
        });
        Self {
            bar,
            what: what.to_owned(),
        }
    }

    pub(crate) fn set_done(&self, steps: usize) {
        match &self.bar {
            Some(bar) => bar.set_position(steps as u64),
            None => print_step(&format!("{steps} {}", self.what)),
        }
    }

    pub(crate) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A line with an animated symbol during long work. It is shown only on a terminal.
pub(crate) struct Spinner(Option<ProgressBar>);

impl Spinner {
    /// Shows a line with the text `what`.
    pub(crate) fn start(what: String) -> Self {
        if !io::stderr().is_terminal() {
            return Self(None);
        }
        let line = ProgressBar::new_spinner().with_message(what);
        line.enable_steady_tick(Duration::from_millis(100));
        Self(Some(line))
    }

    pub(crate) fn clear(&self) {
        if let Self(Some(line)) = self {
            line.finish_and_clear();
        }
    }
}

/// A line that shows the current step. Without a terminal, it is shown only if the environment asks
/// for lines. It starts no thread, because the
/// allocations of a thread would be counted.
pub(crate) struct StatusLine(Option<ProgressBar>);

impl StatusLine {
    pub(crate) fn new() -> Self {
        let shown = io::stderr().is_terminal();
        Self(shown.then(ProgressBar::new_spinner))
    }

    pub(crate) fn show(&self, what: String) {
        match self {
            Self(Some(line)) => {
                line.set_message(what);
                line.tick();
            }
            Self(None) => print_step(&what),
        }
    }

    pub(crate) fn clear(&self) {
        if let Self(Some(line)) = self {
            line.finish_and_clear();
        }
    }
}

/// The exit code of an interrupted command.
pub(crate) const INTERRUPTED: u8 = 4;

/// Ends the program at the first Ctrl-C. Used by commands without partial results.
pub(crate) fn exit_on_interrupt() {
    // If the handler cannot be set, Ctrl-C keeps its default effect.
    let _ = ctrlc::set_handler(|| {
        print_stderr("interrupted");
        exit_without_drafts(INTERRUPTED.into());
    });
}

/// Returns a flag that the first Ctrl-C sets. The second Ctrl-C ends the program.
///
/// The policy `heap` is applied first: the handler starts a thread, and glibc reads the number of
/// heaps when the first thread starts.
pub(crate) fn interrupt_flag(heap: Policy) -> Arc<AtomicBool> {
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

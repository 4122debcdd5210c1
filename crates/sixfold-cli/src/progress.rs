//! Progress bars on a terminal, progress as lines, and the handling of Ctrl-C.

use std::io::{self, IsTerminal};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
pub(crate) use sixfold_measure::command::progress::{INTERRUPTED, interrupt_flag};
use sixfold_measure::command::progress::{Told, print_step};
use sixfold_study::Progress;

use crate::output::exit_without_drafts;
use crate::text::print_stderr;

/// Number of steps of a full bar.
const STEPS: u64 = 1000;

/// A progress bar on standard error. Without a terminal, it is shown only if the environment asks for
/// lines.
pub(crate) struct Bar {
    bar: Option<ProgressBar>,
    prefix: String,
    told: Told,
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
            told: Told::default(),
        }
    }

    /// Shows the finished part, from 0 to 1, and the current step, which may begin with what is measured, such as
    /// `geodesics: `.
    pub(crate) fn set(&self, done: f64, what: &str) {
        let Some(bar) = &self.bar else {
            return self.told.print(done, &self.prefix, what);
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

/// Ends the program at the first Ctrl-C. Used by commands without partial results.
pub(crate) fn exit_on_interrupt() {
    // If the handler cannot be set, Ctrl-C keeps its default effect.
    let _ = ctrlc::set_handler(|| {
        print_stderr("interrupted");
        exit_without_drafts(INTERRUPTED.into());
    });
}

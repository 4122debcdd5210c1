//! Text for users. The text is suppressed if data is written to standard output.

use std::io::{self, IsTerminal, Write};

use crate::failure::Failure;
use crate::output::cannot_write;

pub(crate) use sixfold_study::sanitize;

/// Maximum width of text, in columns.
pub(crate) const WIDTH: usize = 100;
/// Minimum width of text. In a narrower terminal, the terminal breaks lines.
const MIN_WIDTH: usize = 40;

/// Returns the width of text, in columns: the width of the terminal, or [`WIDTH`] if this is less
/// or if standard output is not a terminal.
pub(crate) fn width() -> usize {
    let terminal = terminal_size::terminal_size_of(io::stdout());
    let width = terminal.map_or(WIDTH, |(width, _)| usize::from(width.0));
    width.clamp(MIN_WIDTH, WIDTH)
}

pub(crate) struct TextOutput {
    enabled: bool,
    bold: bool,
    failed: Option<io::Error>,
}

impl TextOutput {
    /// Returns a text output that prints only if `enabled` is set.
    pub(crate) fn new(enabled: bool) -> Self {
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        Self {
            enabled,
            bold: io::stdout().is_terminal() && !no_colour && !dumb,
            failed: None,
        }
    }

    pub(crate) fn bold(&self) -> bool {
        self.bold
    }

    /// Prints `text` as a line. After a failure, nothing more is printed, so that files can still
    /// be written. [`TextOutput::finish`] returns the failure.
    pub(crate) fn print_line(&mut self, text: &str) {
        if self.enabled
            && let Err(cause) = writeln!(io::stdout().lock(), "{text}")
        {
            self.enabled = false;
            self.failed = Some(cause);
        }
    }

    /// Returns an error if some text could not be printed.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let done = self.failed.map_or_else(|| io::stdout().flush(), Err);
        ignore_closed_pipe(done)
    }
}

/// Converts an error of printing. A reader that closes the pipe early is not an error.
pub(crate) fn ignore_closed_pipe(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(cannot_write("standard output", &cause))
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error and ignores errors. Control characters and line breaks are
/// escaped.
pub(crate) fn print_stderr(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", sanitize(line));
}

/// Breaks `text` at spaces into lines of at most `width` columns. A longer word gets its own line.
pub(crate) fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

/// Returns `first` and the lines of `text`. All lines except the first are indented by the width of
/// `first`.
pub(crate) fn hanging_indent(first: &str, text: &str) -> String {
    let indent = first.chars().count();
    let lines = wrap(text, width().saturating_sub(indent));
    let gap = format!("\n{}", " ".repeat(indent));
    format!("{first}{}", lines.join(&gap))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_spaces() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("longerthanthat a", 4), ["longerthanthat", "a"]);
        assert_eq!(hanging_indent("name  ", "reason"), "name  reason");
        let long_name = "n".repeat(2 * WIDTH);
        assert!(hanging_indent(&long_name, "a reason").starts_with(&format!("{long_name}a\n")));
    }
}

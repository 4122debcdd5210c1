//! Text for users: on standard output, or suppressed if data is written there.

use std::io::{self, IsTerminal, Write};

use crate::failure::Failure;
use crate::output::cannot_write;

pub(crate) use sixfold_study::tame;

/// Maximum width of text in columns.
pub(crate) const WIDTH: usize = 100;

/// The text output of a command.
pub(crate) struct Text {
    shown: bool,
    bold: bool,
    failed: Option<io::Error>,
}

impl Text {
    /// Returns the text output, which prints only if `shown`.
    pub(crate) fn shown(shown: bool) -> Self {
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        Self {
            shown,
            bold: io::stdout().is_terminal() && !no_colour && !dumb,
            failed: None,
        }
    }

    /// Returns whether bold text is allowed.
    pub(crate) fn bold(&self) -> bool {
        self.bold
    }

    /// Prints `text` as a line. After a failure it prints nothing more, so that files can still be
    /// written; [`Text::finish`] returns the failure.
    pub(crate) fn say(&mut self, text: &str) {
        if self.shown
            && let Err(cause) = writeln!(io::stdout().lock(), "{text}")
        {
            self.shown = false;
            self.failed = Some(cause);
        }
    }

    /// Returns an error if some text could not be printed.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let done = self.failed.map_or_else(|| io::stdout().flush(), Err);
        all_out(done)
    }
}

/// Converts an error of printing. A reader that closed the pipe early is not an error.
pub(crate) fn all_out(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(cannot_write("standard output", &cause))
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error; ignores errors. Control characters and line breaks in it, such
/// as from file names, are escaped.
pub(crate) fn complain(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", tame(line));
}

/// Breaks `text` at spaces into lines of at most `width` columns; a longer word gets its own line.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
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

/// Returns `first` and the lines of `text`, where all but the first are indented by the width of
/// `first`.
pub(crate) fn hanging(first: &str, text: &str) -> String {
    let indent = first.chars().count();
    let lines = wrapped(text, WIDTH - indent);
    let gap = format!("\n{}", " ".repeat(indent));
    format!("{first}{}", lines.join(&gap))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_spaces() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("longerthanthat a", 4), ["longerthanthat", "a"]);
        assert_eq!(hanging("name  ", "reason"), "name  reason");
    }
}

//! Text for people: on standard output, or nowhere while that carries data.

use std::io::{self, IsTerminal, Write};

use crate::failure::Failure;
use crate::output::cannot_write;

pub(crate) use ::study::tame;

/// How many columns text may take.
pub(crate) const WIDTH: usize = 100;

/// Where the text of a command goes.
pub(crate) struct Text {
    shown: bool,
    bold: bool,
    failed: Option<io::Error>,
}

impl Text {
    /// Text on standard output, unless data goes there.
    pub(crate) fn shown(shown: bool) -> Self {
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        Self {
            shown,
            bold: io::stdout().is_terminal() && !no_colour && !dumb,
            failed: None,
        }
    }

    /// Whether letters may be bold.
    pub(crate) fn bold(&self) -> bool {
        self.bold
    }

    /// Prints `text` and ends the line. After a failure it prints no more: files are still to be
    /// written, and [`Text::finish`] tells.
    pub(crate) fn say(&mut self, text: &str) {
        if self.shown
            && let Err(cause) = writeln!(io::stdout().lock(), "{text}")
        {
            self.shown = false;
            self.failed = Some(cause);
        }
    }

    /// Whether all the text got out.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let done = self.failed.map_or_else(|| io::stdout().flush(), Err);
        all_out(done)
    }
}

/// What came of printing. A reader that has gone away is no error: nobody is there to be told.
pub(crate) fn all_out(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(cannot_write("standard output", &cause))
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error, if anybody is there. It stays one line, whatever file names and
/// files put into it.
pub(crate) fn complain(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", tame(line));
}

/// `text` in lines of at most `width` columns, broken at blanks; a longer word has its own line.
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

/// `first`, then the lines of `text`, all but the first of them set in as far as `first` is wide.
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
    fn lines_break_at_blanks() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("longerthanthat a", 4), ["longerthanthat", "a"]);
        assert_eq!(hanging("name  ", "reason"), "name  reason");
    }
}

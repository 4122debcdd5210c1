//! Text for users. The text is suppressed if data is written to standard output.

use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;

use crate::command::failure::Failure;
use crate::command::output::{Output, cannot_write};
use sixfold_results::numbers::grouped;

pub use sixfold_results::sanitize;

/// Width of text that is not printed on a terminal, in columns.
pub const WIDTH: usize = 80;
/// Maximum width of text, in columns. Longer lines are hard to read.
const MAX_WIDTH: usize = 100;
/// Minimum width of text. In a narrower terminal, the terminal breaks lines.
const MIN_WIDTH: usize = 40;

/// The widths of the terminals of standard output and of standard error, in columns. 0 stands for an unknown width.
static TERMINALS: [AtomicUsize; 2] = [AtomicUsize::new(0), AtomicUsize::new(0)];

/// Sets the widths of the terminals of standard output and of standard error, in columns.
pub fn set_terminals(widths: [Option<usize>; 2]) {
    for (terminal, width) in TERMINALS.iter().zip(widths) {
        terminal.store(width.unwrap_or(0), Ordering::Relaxed);
    }
}

fn terminal(of: usize) -> Option<usize> {
    Some(TERMINALS[of].load(Ordering::Relaxed)).filter(|&width| width > 0)
}

/// Returns the width of text, in columns: the width of the terminal, but at most `MAX_WIDTH`. If
/// standard output is not a terminal, the variable `COLUMNS` has the width; without it, the width is
/// [`WIDTH`].
pub fn width() -> usize {
    let given = || std::env::var("COLUMNS").ok()?.parse().ok();
    let width = terminal(0).or_else(given).unwrap_or(WIDTH);
    width.clamp(MIN_WIDTH, MAX_WIDTH)
}

/// An object as JSON, with the notices of the command.
#[derive(Serialize)]
pub struct WithNotices<D> {
    #[serde(flatten)]
    document: D,
    notices: Vec<String>,
}

impl<D: Serialize> WithNotices<D> {
    /// Adds the notices that no document has yet.
    pub fn new(document: D) -> Self {
        Self {
            document,
            notices: take_notices(),
        }
    }
}

pub struct TextOutput {
    enabled: bool,
    bold: bool,
    failed: Option<io::Error>,
}

impl TextOutput {
    /// Returns a text output that prints only if `enabled` is set.
    pub fn new(enabled: bool) -> Self {
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        Self {
            enabled,
            bold: io::stdout().is_terminal() && !no_colour && !dumb,
            failed: None,
        }
    }

    pub fn bold(&self) -> bool {
        self.bold
    }

    /// Prints `text` as a line. After a failure, nothing more is printed, so that files can still
    /// be written. [`TextOutput::finish`] returns the failure.
    pub fn print_line(&mut self, text: &str) {
        if self.enabled
            && let Err(cause) = writeln!(io::stdout().lock(), "{text}")
        {
            self.enabled = false;
            self.failed = Some(cause);
        }
    }

    /// Prints each of `lines` behind `mark`, broken into lines that are not too wide.
    pub fn print_list<L: AsRef<str>>(&mut self, mark: &str, lines: impl IntoIterator<Item = L>) {
        for line in lines {
            self.print_line(&hanging_indent(mark, line.as_ref()));
        }
    }

    /// Prints the sentences of an answer, then the warnings that say how far to trust it, then an empty
    /// line. Prints nothing if both lists are empty.
    pub fn print_answer(&mut self, sentences: &[String], warnings: &[String]) {
        self.print_list("- ", sentences.iter().map(|text| sanitize(text)));
        self.print_list("! ", warnings.iter().map(|text| sanitize(text)));
        if !(sentences.is_empty() && warnings.is_empty()) {
            self.print_line("");
        }
    }

    /// Prints the remaining text, and writes an object as JSON, with the notices of the command.
    pub fn finish_with_document(
        self,
        json: Option<Output>,
        document: &impl Serialize,
    ) -> Result<ExitCode, Failure> {
        self.finish_with_json(json, &WithNotices::new(document))
    }

    /// Prints the remaining text, so that it is not lost if a file cannot be written. Then writes
    /// `value` as JSON, if there is an output for it.
    pub fn finish_with_json(
        self,
        json: Option<Output>,
        value: &impl Serialize,
    ) -> Result<ExitCode, Failure> {
        let printed = self.finish();
        let written = json.map_or(Ok(()), |json| json.write_json(value));
        printed.and(written).map(|()| ExitCode::SUCCESS)
    }

    /// Returns an error if some text could not be printed.
    pub fn finish(self) -> Result<(), Failure> {
        let done = self.failed.map_or_else(|| io::stdout().flush(), Err);
        ignore_closed_pipe(done)
    }
}

/// Converts an error of printing. A reader that closes the pipe early is not an error.
pub fn ignore_closed_pipe(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(cannot_write("standard output", &cause))
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error and ignores errors. Control characters and line breaks are
/// escaped. If this is a terminal, the line is broken where it is too wide.
pub fn print_stderr(line: &str) {
    let line = sanitize(line);
    let shown = match terminal(1) {
        Some(width) => {
            let width = width.clamp(MIN_WIDTH, MAX_WIDTH);
            wrap(&line, width - 2).join("\n  ")
        }
        None => line,
    };
    let _ = writeln!(io::stderr().lock(), "{shown}");
}

/// The notices that no document has yet.
static NOTICES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Prints a note or a warning on standard error, and keeps it for the document of `--json`.
pub fn print_notice(line: &str) {
    print_stderr(line);
    keep_notice(line);
}

fn keep_notice(line: &str) {
    let mut notices = NOTICES.lock().unwrap_or_else(PoisonError::into_inner);
    notices.push(sanitize(line));
}

/// Maximum number of places that a notice lists.
const SHOWN: usize = 5;

/// Prints a note of one kind that has several places: `heading` with the only place, or the first
/// places below it. The document of `--json` has it as one notice. Prints nothing without places.
pub fn print_places(heading: &str, places: impl ExactSizeIterator<Item = String>) {
    let count = places.len();
    let mut shown: Vec<String> = places.take(SHOWN).collect();
    if count > SHOWN {
        shown.push(format!("and {} more", grouped(count - SHOWN)));
    }
    let notice = format!("note: {heading}: {}", shown.join("; "));
    match count {
        0 => return,
        1 => print_stderr(&notice),
        _ => {
            print_stderr(&format!("note: {heading}:"));
            for place in shown {
                print_stderr(&format!("note:   {place}"));
            }
        }
    }
    keep_notice(&notice);
}

/// Returns the notices since the last call, for a document.
pub fn take_notices() -> Vec<String> {
    let mut notices = NOTICES.lock().unwrap_or_else(PoisonError::into_inner);
    std::mem::take(&mut notices)
}

/// Breaks `text` at spaces into lines of at most `width` columns. A longer word gets its own line. A
/// number and the sign `×` or `%` stay together.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let is_sign = |word: &str| word.starts_with(['×', '%']);
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match words.last_mut() {
            Some(number) if is_sign(word) => *number += &format!(" {word}"),
            _ => words.push(word.to_owned()),
        }
    }
    for word in words {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// Returns `first` and the lines of `text`. All lines except the first are indented by the width of
/// `first`.
pub fn hanging_indent(first: &str, text: &str) -> String {
    let indent = first.chars().count();
    let lines = wrap(text, width().saturating_sub(indent));
    let gap = format!("\n{}", " ".repeat(indent));
    format!("{first}{}", lines.join(&gap))
}

/// Breaks the lines of a help text that are wider than `width`. Lines of a paragraph are joined
/// first. A line with an example breaks before its description, which follows at least two spaces.
pub fn reflow(text: &str, width: usize) -> String {
    let is_wide = |line: &str| line.chars().count() > width;
    let mut lines: Vec<String> = Vec::new();
    let all: Vec<&str> = text.lines().collect();
    for paragraph in all.chunk_by(|a, b| is_prose(a) && is_prose(b)) {
        if is_prose(paragraph[0]) && paragraph.iter().any(|line| is_wide(line)) {
            lines.extend(wrap(&paragraph.join(" "), width));
            continue;
        }
        for line in paragraph {
            match is_wide(line) {
                true => lines.extend(broken(line, width)),
                false => lines.push((*line).to_owned()),
            }
        }
    }
    lines.join("\n")
}

/// Returns whether a line belongs to a paragraph: it is neither empty nor indented.
fn is_prose(line: &str) -> bool {
    !line.is_empty() && !line.starts_with(' ')
}

/// Breaks an indented line. The following lines are indented by four more columns.
fn broken(line: &str, width: usize) -> Vec<String> {
    let text = line.trim_start();
    let indent = " ".repeat(line.len() - text.len());
    let (example, description) = text.split_once("  ").unwrap_or((text, ""));
    let room = width.saturating_sub(indent.len() + 4);
    let mut lines = wrap(example, room);
    if !description.is_empty() {
        lines.extend(wrap(description.trim_start(), room));
    }
    let lines = lines.into_iter().enumerate();
    let indented = lines.map(|(i, line)| match i {
        0 => format!("{indent}{line}"),
        _ => format!("{indent}    {line}"),
    });
    indented.collect()
}

/// Returns a figure with five significant digits, without zeros at its end: `0.25`, `1.0972e-15`.
pub fn figure(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return (value + 0.0).to_string();
    }
    // The exponent after rounding to five digits.
    let scientific = format!("{value:.4e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let short = |digits: &str| match digits.contains('.') {
        true => digits
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned(),
        false => digits.to_owned(),
    };
    match exponent {
        -4..=4 => short(&format!("{value:.0$}", (4 - exponent) as usize)),
        5..=8 => format!("{value:.0}"),
        _ => format!("{}e{exponent}", short(mantissa)),
    }
}

/// Returns a coordinate of a mesh of this size: with five significant digits, or with more if it is far
/// from the origin, so that places in the mesh can be told apart.
pub fn coordinate(value: f64, size: f64) -> String {
    let is_far = size > 0.0 && size.is_finite() && value.abs() > 10.0 * size;
    if !is_far {
        return figure(value);
    }
    let decimals = (4.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    let digits = format!("{value:.decimals$}");
    match digits.contains('.') {
        true => digits
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned(),
        false => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_far_from_the_origin_have_more_digits() {
        let coordinates = [
            (0.123_456_7, 2.0, "0.12346"),
            (5_400_000.125, 2.0, "5400000.125"),
            (-500_000.123_456, 2000.0, "-500000.1"),
            (5_400_000.0, 1e9, "5400000"),
            (5_400_000.0, 30.0, "5400000"),
            (7e7, 0.0, "70000000"),
        ];
        for (value, size, expected) in coordinates {
            assert_eq!(coordinate(value, size), expected);
        }
    }

    #[test]
    fn figures_have_five_digits_and_no_zeros_at_the_end() {
        let figures = [
            (0.0, "0"),
            (-0.0, "0"),
            (2.0, "2"),
            (0.1, "0.1"),
            (-1.0 / 3.0, "-0.33333"),
            (9999.96, "10000"),
            (123_456.7, "123457"),
            (4.5e6, "4500000"),
            (1e-4, "0.0001"),
            (1.097_17e-15, "1.0972e-15"),
            (2e12, "2e12"),
            (99_999.6, "100000"),
        ];
        for (value, expected) in figures {
            assert_eq!(figure(value), expected);
        }
    }

    #[test]
    fn lines_break_at_spaces() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("longerthanthat a", 4), ["longerthanthat", "a"]);
        assert_eq!(wrap("takes 1.31 × that", 8), ["takes", "1.31 ×", "that"]);
        assert_eq!(wrap("of 1.8 %.", 6), ["of", "1.8 %."]);
        assert_eq!(hanging_indent("name  ", "reason"), "name  reason");
        let long_name = "n".repeat(2 * WIDTH);
        assert!(hanging_indent(&long_name, "a reason").starts_with(&format!("{long_name}a\n")));
    }

    #[test]
    fn help_texts_break_at_the_width() {
        let text = "Examples:\n  run a b c        what it does\n\nOne two\nthree four\nfive.";
        assert_eq!(reflow(text, 80), text);
        let expected =
            "Examples:\n  run a b c\n      what it\n      does\n\nOne two\nthree four\nfive.";
        assert_eq!(reflow(text, 16), expected);
        assert_eq!(reflow("One two\nthree four", 9), "One two\nthree\nfour");
    }
}

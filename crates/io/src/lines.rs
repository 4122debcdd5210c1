//! Splits bytes into logical lines.

use std::io::{self, BufRead, Read};

/// A reader of the logical lines of a file. A logical line has no comment, and its continued lines
/// are joined by a blank.
///
/// A line ends in LF, CRLF or a lone CR. `\` at the end of a line continues the line; blanks after
/// the `\` are allowed. A `\` at the end of a comment does not continue the line. Names may be in
/// any encoding, so the reader does not decode the bytes.
pub(crate) struct Lines<R> {
    source: R,
    /// Bytes up to an LF. Contains several lines if some lines end in a lone CR.
    chunk: Vec<u8>,
    /// Start of the next line in `chunk`; `None` if `chunk` has no more lines.
    next: Option<usize>,
    /// Number of physical lines that were read.
    count: u64,
    /// Maximum length of a line in bytes. Adjacent lines that end in a lone CR count as one line.
    max_length: u64,
}

/// How a file starts.
pub(crate) enum Start {
    /// The file starts with text; a UTF-8 byte order mark is skipped.
    Text,
    /// The file starts with a UTF-16 byte order mark.
    Utf16,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(source: R) -> Self {
        Self {
            source,
            chunk: Vec::new(),
            next: None,
            count: 0,
            max_length: u64::MAX,
        }
    }

    /// Sets the maximum length of a line in bytes. If a line is longer, reading fails with
    /// [`io::ErrorKind::FileTooLarge`].
    pub(crate) fn with_max_length(self, max_length: u64) -> Self {
        Self { max_length, ..self }
    }

    /// Reads the first line and checks for a byte order mark.
    pub(crate) fn start(&mut self) -> io::Result<Start> {
        self.next = self.read_chunk()?.then_some(0);
        if self.chunk.starts_with(b"\xEF\xBB\xBF") {
            self.next = Some(3);
        } else if self.chunk.starts_with(b"\xFF\xFE") || self.chunk.starts_with(b"\xFE\xFF") {
            return Ok(Start::Utf16);
        }
        Ok(Start::Text)
    }

    /// Returns the number of physical lines read so far.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Reads the next logical line into `statement` and returns the number of its first physical
    /// line.
    pub(crate) fn read(&mut self, statement: &mut Vec<u8>) -> io::Result<Option<u64>> {
        statement.clear();
        let (first, max_length) = (self.count + 1, self.max_length);
        while let Some(line) = self.physical()? {
            let comment = line.iter().position(|&byte| byte == b'#');
            let text = line[..comment.unwrap_or(line.len())].trim_ascii_end();
            let continued = text.strip_suffix(b"\\").filter(|_| comment.is_none());
            statement.extend_from_slice(continued.unwrap_or(text));
            if statement.len() as u64 > max_length {
                return Err(io::ErrorKind::FileTooLarge.into());
            }
            if continued.is_none() {
                return Ok(Some(first));
            }
            statement.push(b' ');
        }
        // The file may end in a continued line.
        Ok((self.count >= first).then_some(first))
    }

    /// Returns the next physical line, without its line end.
    fn physical(&mut self) -> io::Result<Option<&[u8]>> {
        if self.next.is_none() && self.read_chunk()? {
            self.next = Some(0);
        }
        let Some(start) = self.next else {
            return Ok(None);
        };
        let rest = &self.chunk[start..];
        let (line, next) = match rest.iter().position(|&byte| byte == b'\r') {
            Some(end) => (&rest[..end], Some(start + end + 1)),
            None => (rest, None),
        };
        self.next = next;
        self.count += 1;
        Ok(Some(line))
    }

    /// Reads up to the next LF and removes the line end. Returns whether any byte was read.
    fn read_chunk(&mut self) -> io::Result<bool> {
        self.chunk.clear();
        let limit = self.max_length.saturating_add(1);
        let mut source = self.source.by_ref().take(limit);
        let read = source.read_until(b'\n', &mut self.chunk)?;
        if read as u64 > self.max_length && self.chunk.last() != Some(&b'\n') {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        for end in [b'\n', b'\r'] {
            if self.chunk.last() == Some(&end) {
                self.chunk.pop();
            }
        }
        Ok(read > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<(u64, String)> {
        let mut lines = Lines::new(text.as_bytes());
        assert!(matches!(lines.start(), Ok(Start::Text)));
        let (mut statement, mut all) = (Vec::new(), Vec::new());
        while let Some(line) = lines.read(&mut statement).expect("memory does not fail") {
            let text = String::from_utf8(statement.clone()).expect("valid UTF-8");
            all.push((line, text));
        }
        all
    }

    fn assert_lines(text: &str, expected: &[(u64, &str)]) {
        let expected: Vec<(u64, String)> =
            expected.iter().map(|&(n, s)| (n, s.to_owned())).collect();
        assert_eq!(lines(text), expected, "{text:?}");
    }

    #[test]
    fn every_kind_of_line_end_ends_a_line() {
        for text in ["a\nb\n\nc", "a\r\nb\r\n\r\nc\r\n", "a\rb\r\rc\r"] {
            assert_lines(text, &[(1, "a"), (2, "b"), (3, ""), (4, "c")]);
        }
        assert_lines("a\rb\nc\r\nd", &[(1, "a"), (2, "b"), (3, "c"), (4, "d")]);
        assert_lines("", &[]);
        assert_lines("\r\n", &[(1, "")]);
    }

    #[test]
    fn a_backslash_continues_a_line_but_not_a_comment() {
        assert_lines("a \\\n b\\  \r\nc\nd", &[(1, "a   b c"), (4, "d")]);
        assert_lines("a # b \\\nc", &[(1, "a"), (2, "c")]);
        assert_lines("# C:\\\nc", &[(1, ""), (2, "c")]);
        assert_lines("a \\ # b\nc", &[(1, "a \\"), (2, "c")]);
        assert_lines("a \\\nb # c \\\nd", &[(1, "a  b"), (3, "d")]);
        assert_lines("a\n\\\n\\\n\\", &[(1, "a"), (2, "   ")]);
    }

    #[test]
    fn the_length_of_lines_can_be_limited() {
        for (text, fits) in [
            ("abcd\nabcd\n", true),
            ("abcd\nabcd", true),
            ("abcd\nabcde", false),
            ("ab\\\nab", false),
            ("a\\\na", true),
        ] {
            let mut lines = Lines::new(text.as_bytes()).with_max_length(4);
            let mut statement = Vec::new();
            let mut read = || lines.read(&mut statement);
            let end = std::iter::repeat_with(&mut read).find(|line| !matches!(line, Ok(Some(_))));
            match end.expect("the text ends") {
                Err(error) => {
                    assert!(!fits, "{text:?}");
                    assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
                }
                Ok(_) => assert!(fits, "{text:?}"),
            }
        }
    }

    #[test]
    fn byte_order_marks_are_recognised_only_at_the_start() {
        assert_lines("\u{feff}a\n\u{feff}b", &[(1, "a"), (2, "\u{feff}b")]);
        assert_lines("\u{feff}", &[(1, "")]);
        for utf16 in [&b"\xFF\xFEv\0"[..], b"\xFE\xFF\0v"] {
            assert!(matches!(Lines::new(utf16).start(), Ok(Start::Utf16)));
        }
    }
}

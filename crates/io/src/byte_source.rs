//! A buffered reader for lines and records, which knows its place in the file.

use std::io::{self, BufRead, Read};

/// Bytes that are read at once.
const CHUNK: usize = 1 << 17;

/// Maximum length of a line in bytes: a face with some million corners.
pub(crate) const MAX_LINE_LENGTH: usize = 1 << 26;

/// A buffered reader for lines and records.
///
/// The buffer grows only to hold bytes that were read, so a wrong length in a file cannot make it
/// larger than twice the file.
pub(crate) struct ByteSource<'a> {
    source: &'a mut dyn Read,
    buffer: Vec<u8>,
    /// The bytes `start..end` of the buffer are read and not consumed.
    start: usize,
    end: usize,
    /// Place of `start` in the file.
    offset: u64,
    /// Number of lines returned by `line`.
    lines: u32,
    ended: bool,
    /// Size of the file, if it is known.
    size: Option<u64>,
    /// Whether an LF after a CR belongs to the next line.
    lone_cr: bool,
}

/// A line of text without its line end.
pub(crate) struct TextLine<'a> {
    pub(crate) text: &'a [u8],
    /// Number of the line, counted from 1.
    pub(crate) number: u32,
    /// Whether the line ends in a CR without an LF.
    pub(crate) ends_in_cr: bool,
}

/// Splits `text` at white space.
pub(crate) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let words = text.split(|byte| byte.is_ascii_whitespace() || *byte == b'\x0b');
    words.filter(|word| !word.is_empty())
}

impl<'a> ByteSource<'a> {
    /// Creates a reader of `source`, which has `size` bytes.
    pub(crate) fn new(source: &'a mut dyn Read, size: Option<u64>) -> Self {
        Self {
            source,
            buffer: Vec::new(),
            start: 0,
            end: 0,
            offset: 0,
            lines: 0,
            ended: false,
            size,
            lone_cr: false,
        }
    }

    /// Returns the size of the file, if it is known.
    pub(crate) fn size(&self) -> Option<u64> {
        self.size
    }

    /// Returns the number of bytes that were consumed.
    pub(crate) fn offset(&self) -> u64 {
        self.offset
    }

    /// Returns the number of lines that were read with [`line`](Self::line).
    pub(crate) fn line_count(&self) -> u32 {
        self.lines
    }

    /// Returns how many of `count` records of at least `bytes` each can follow. The bound is the
    /// rest of the file; if the size of the file is not known, it is the part that was read.
    pub(crate) fn plausible(&self, count: u64, bytes: u64) -> usize {
        let buffered = (self.end - self.start) as u64;
        let rest = self
            .size
            .map_or(buffered, |size| size.saturating_sub(self.offset));
        usize::try_from(count.min(rest / bytes.max(1))).unwrap_or(0)
    }

    /// Treats a CR as the end of a line even if an LF follows, as files of old systems need it.
    pub(crate) fn end_lines_in_cr(&mut self) {
        self.lone_cr = true;
    }

    /// Reads until `wanted` bytes are in the buffer, or the file ends. Returns the bytes in the
    /// buffer.
    pub(crate) fn fill(&mut self, wanted: usize) -> io::Result<&[u8]> {
        while self.end - self.start < wanted && !self.ended {
            self.make_room();
            match self.source.read(&mut self.buffer[self.end..]) {
                Ok(0) => self.ended = true,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(&self.buffer[self.start..self.end])
    }

    fn make_room(&mut self) {
        if self.end < self.buffer.len() {
            return;
        }
        if self.start > 0 {
            self.buffer.copy_within(self.start..self.end, 0);
            self.end -= self.start;
            self.start = 0;
        }
        if self.end * 2 > self.buffer.len() || self.buffer.is_empty() {
            let length = (2 * self.buffer.len()).max(CHUNK);
            self.buffer.resize(length, 0);
        }
    }

    /// Removes `count` bytes from the buffer.
    pub(crate) fn advance(&mut self, count: usize) {
        let count = count.min(self.end - self.start);
        self.start += count;
        self.offset += count as u64;
    }

    /// Reads the next line, which ends in LF, CRLF or CR; `None` at the end of the file.
    ///
    /// A line that is longer than [`MAX_LINE_LENGTH`] is an error of kind `FileTooLarge`.
    pub(crate) fn line(&mut self) -> io::Result<Option<TextLine<'_>>> {
        let mut searched = 0;
        let length = loop {
            let rest = &self.buffer[self.start + searched..self.end];
            if let Some(at) = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r') {
                break searched + at;
            }
            searched += rest.len();
            if searched > MAX_LINE_LENGTH {
                return Err(io::ErrorKind::FileTooLarge.into());
            }
            if self.fill(searched + 1)?.len() == searched {
                break searched;
            }
        };
        let at_cr = self.fill(length + 1)?.get(length) == Some(&b'\r');
        let before_lf =
            at_cr && !self.lone_cr && { self.fill(length + 2)?.get(length + 1) == Some(&b'\n') };
        let available = self.end - self.start;
        if available == 0 {
            return Ok(None);
        }
        let end_length = if before_lf { 2 } else { 1 };
        let start = self.start;
        self.advance(length + end_length.min(available - length));
        self.lines = self
            .lines
            .checked_add(1)
            .ok_or(io::ErrorKind::FileTooLarge)?;
        Ok(Some(TextLine {
            text: &self.buffer[start..start + length],
            number: self.lines,
            ends_in_cr: at_cr && !before_lf,
        }))
    }
}

impl Read for ByteSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.advance(count);
        Ok(count)
    }
}

impl BufRead for ByteSource<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.fill(1)
    }

    fn consume(&mut self, count: usize) {
        self.advance(count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A source that gives one byte at a time.
    struct Slow<'a>(&'a [u8]);

    impl Read for Slow<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = buffer.len().min(1);
            self.0.read(&mut buffer[..count])
        }
    }

    fn lines(mut source: impl Read) -> Vec<String> {
        let mut source = ByteSource::new(&mut source, None);
        let mut all = Vec::new();
        while let Some(line) = source.line().expect("memory does not fail") {
            assert_eq!(line.number as usize, all.len() + 1);
            all.push(String::from_utf8(line.text.to_vec()).expect("ASCII"));
        }
        all
    }

    #[test]
    fn every_kind_of_line_end_ends_a_line() {
        for (text, expected) in [
            ("", &[][..]),
            ("a", &["a"]),
            ("a\n", &["a"]),
            ("a\r", &["a"]),
            ("a\r\n", &["a"]),
            (
                "a\n\nb\r\n\r\nc\rd\r\re",
                &["a", "", "b", "", "c", "d", "", "e"],
            ),
            ("\n\r", &["", ""]),
        ] {
            assert_eq!(lines(text.as_bytes()), expected, "{text:?}");
            assert_eq!(lines(Slow(text.as_bytes())), expected, "{text:?}");
        }
    }

    #[test]
    fn bytes_after_a_line_are_kept() {
        let mut slow = Slow(b"ply\r\n\n1234567");
        let mut source = ByteSource::new(&mut slow, None);
        assert_eq!(source.line().expect("memory").expect("a line").text, b"ply");
        assert_eq!(source.offset(), 5);
        assert_eq!(&source.fill(3).expect("memory")[..3], b"\n12");
        source.advance(3);
        assert_eq!(&source.fill(4).expect("memory")[..4], b"3456");
        source.advance(4);
        assert_eq!(source.fill(9).expect("memory"), b"7");
        assert_eq!(source.offset(), 12);
        source.advance(2);
        assert_eq!(source.offset(), 13);
        assert!(source.line().expect("memory").is_none());
    }

    #[test]
    fn long_records_cross_chunks() {
        let bytes: Vec<u8> = (0..3 * CHUNK).map(|i| (i % 251) as u8).collect();
        let mut slice = bytes.as_slice();
        let mut source = ByteSource::new(&mut slice, Some(bytes.len() as u64));
        source.fill(1).expect("memory");
        source.advance(10);
        assert_eq!(
            source.fill(2 * CHUNK).expect("memory")[..2 * CHUNK],
            bytes[10..10 + 2 * CHUNK]
        );
        assert_eq!(source.plausible(u64::MAX, 3), CHUNK - 4);
    }

    #[test]
    fn words_end_at_white_space() {
        assert!(words(b" a\tbc \x0b d\r").eq([&b"a"[..], b"bc", b"d"]));
        assert_eq!(words(b" \t").count(), 0);
    }
}

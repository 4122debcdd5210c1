//! The layout of JSON files: one field per line.

use std::io;

use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::{Formatter, PrettyFormatter};

/// Writes a value as JSON with one field per line. An array takes one line.
///
/// # Errors
///
/// Returns the errors of `writer`.
pub fn write_json(value: &impl Serialize, mut writer: impl io::Write) -> io::Result<()> {
    let mut serializer = Serializer::with_formatter(&mut writer, RowFormatter::default());
    value.serialize(&mut serializer).map_err(io::Error::from)?;
    writeln!(writer)
}

/// A JSON formatter with one field per line. An array takes one line, because arrays of samples
/// have thousands of values.
#[derive(Default)]
struct RowFormatter<'a>(PrettyFormatter<'a>);

impl Formatter for RowFormatter<'_> {
    fn begin_array_value<W: ?Sized + io::Write>(
        &mut self,
        w: &mut W,
        first: bool,
    ) -> io::Result<()> {
        if first { Ok(()) } else { w.write_all(b", ") }
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.begin_object(w)
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.end_object(w)
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        w: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.0.begin_object_key(w, first)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.begin_object_value(w)
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.end_object_value(w)
    }
}

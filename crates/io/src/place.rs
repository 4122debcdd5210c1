//! Places in files: lines, bytes and numbered items.

use std::fmt;

use sixfold_core::{FaceId, FaceList};

/// A place in a file; printed as `line 17`, `byte 134` or `accessor 3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Place {
    /// A line of a text file, counted from 1; for a continued statement, its first line.
    Line(u32),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// An item of a numbered list, counted from 0.
    Item {
        /// What the list holds, in the singular.
        kind: &'static str,
        /// Number of the item, counted from 0.
        number: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Item { kind, number } => write!(f, "{kind} {number}"),
        }
    }
}

/// A place with the name of its file; printed as `bunny.obj:17` or `bunny.stl: byte 134`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Location {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Place in the file.
    pub place: Place,
}

impl Location {
    /// Returns the location of `place` in the file with this name.
    pub(crate) fn new(file: &str, place: Place) -> Self {
        let file = file.to_owned();
        Self { file, place }
    }

    /// Returns the location of a line, counted from 1.
    pub(crate) fn line(file: &str, line: u32) -> Self {
        Self::new(file, Place::Line(line))
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Place::Line(line) => write!(f, "{}:{line}", self.file),
            place => write!(f, "{}: {place}", self.file),
        }
    }
}

/// The place of each face in its file.
///
/// Text files need four bytes per face. In most binary files the place is computed: a record is a
/// fixed number of bytes, plus a fixed number per corner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FacePlaces {
    /// The line of each face.
    Lines(Vec<u32>),
    /// Records of a regular size.
    Records {
        /// Byte of the first face.
        first: u64,
        /// Bytes of a face without its corners.
        per_face: u64,
        /// Bytes of a corner.
        per_corner: u64,
    },
    /// The byte of each face.
    Bytes(Vec<u64>),
    /// Faces without a place of their own: their numbers.
    Numbers,
}

impl FacePlaces {
    /// Returns the place of `face`, which is one of `faces`.
    pub(crate) fn place(&self, face: FaceId, faces: &FaceList) -> Place {
        match self {
            Self::Lines(lines) => Place::Line(lines[face.index()]),
            Self::Bytes(bytes) => Place::Byte(bytes[face.index()]),
            Self::Records { .. } => {
                let corners = faces.range(face).start;
                Place::Byte(self.predicted(face.index(), corners))
            }
            Self::Numbers => Place::Item {
                kind: "face",
                number: face.index(),
            },
        }
    }

    /// Records that face number `face`, with `corners` corners before it, is at `byte`. If the
    /// records are not regular, every byte is stored from now on.
    pub(crate) fn push_byte(&mut self, faces: &FaceList, byte: u64) {
        let (face, corners) = (faces.len(), faces.corners().len());
        if matches!(self, Self::Records { .. }) && self.predicted(face, corners) != byte {
            let before = faces
                .iter()
                .map(|(f, _)| self.predicted(f.index(), faces.range(f).start));
            *self = Self::Bytes(before.collect());
        }
        if let Self::Bytes(bytes) = self {
            bytes.push(byte);
        }
    }

    fn predicted(&self, face: usize, corners: usize) -> u64 {
        match *self {
            Self::Records {
                first,
                per_face,
                per_corner,
            } => first + face as u64 * per_face + corners as u64 * per_corner,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold_core::VertexId;

    #[test]
    fn regular_records_are_computed_and_others_are_stored() {
        let mut faces = FaceList::default();
        let mut places = FacePlaces::Records {
            first: 100,
            per_face: 1,
            per_corner: 4,
        };
        let mut bytes = Vec::new();
        for (byte, degree) in [(100, 3), (113, 4), (130, 3), (150, 3)] {
            places.push_byte(&faces, byte);
            faces.push((0..degree).map(VertexId::new)).expect("few");
            bytes.push(byte);
            let found = faces.iter().map(|(f, _)| places.place(f, &faces));
            assert!(found.eq(bytes.iter().map(|&byte| Place::Byte(byte))));
            assert_eq!(matches!(places, FacePlaces::Bytes(_)), byte == 150);
        }
    }
}

//! Reads PLY.

mod ascii;
mod binary;
mod header;
mod layout;
mod scalar;

pub(crate) use scalar::{ByteOrder, Scalar};

use header::{Element, Header};
use layout::{Role, Step, note_ignored, role};

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::faults::PlyHeaderFault;
use crate::file_mesh::FileMesh;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Place};

/// Reads PLY in any form; O(bytes) expected.
pub(crate) fn read(
    name: &str,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let places = FacePlaces::Lines(Vec::new());
    let mut builder = MeshBuilder::new(name, Format::PlyAscii, options, places);
    let header = Header::read(&mut builder, source)?;
    builder.set_format(header.format);
    let roles = header.roles(&builder)?;
    for (element, role) in header.elements.iter().zip(&roles) {
        note_ignored(&mut builder.notices, element, role);
    }
    for (element, role) in header.elements.iter().zip(roles) {
        let reading = Reading {
            element,
            role,
            steps: element.steps(role),
            builder: &mut builder,
            corners: Vec::new(),
        };
        match header.format {
            Format::Ply => binary::read(reading, source, ByteOrder::Little)?,
            Format::PlyBigEndian => binary::read(reading, source, ByteOrder::Big)?,
            _ => ascii::read(reading, source)?,
        }
    }
    builder.note_trailing(source)?;
    builder.finish()
}

/// One element while its records are read.
struct Reading<'a, 'b> {
    element: &'a Element,
    role: Role,
    /// The parts of a record.
    steps: Vec<Step>,
    builder: &'a mut MeshBuilder<'b>,
    /// The indices of the current face or strip; −1 starts a new strip.
    corners: Vec<i64>,
}

impl Reading<'_, '_> {
    /// Returns the error of a file that ends before record `number`, counted from 0.
    fn truncated(&self, place: Place, number: u64) -> ReadError {
        let Element { name, count, .. } = self.element;
        self.builder.record_missing(place, name, number, *count)
    }

    /// Returns the error of a value that is not a number of corners or of a vertex.
    #[cold]
    fn bad_whole(&self, place: Place, what: &'static str, text: String) -> ReadError {
        let at = self.builder.at(place);
        ReadError::BadWhole { at, what, text }
    }

    /// Adds the face or the strip whose indices are in `corners`.
    fn add_corners(&mut self, place: Place) -> Result<(), ReadError> {
        if self.role == Role::Strips {
            return self.add_strips(place);
        }
        if let [a, b, c] = *self.corners {
            let mut triangle = [0; 3];
            for (row, index) in triangle.iter_mut().zip([a, b, c]) {
                *row = self.builder.vertex_row(index, || place)?;
            }
            return self.builder.push_face(&triangle, place);
        }
        let rows = self.corners.iter();
        let rows = rows.map(|&index| self.builder.vertex_row(index, || place));
        let rows: Vec<u32> = rows.collect::<Result<_, _>>()?;
        self.builder.push_face(&rows, place)
    }

    /// Adds the triangles of strips. Every other triangle is turned, so that all face one side. One or
    /// two indices alone are no strip and are counted.
    fn add_strips(&mut self, place: Place) -> Result<(), ReadError> {
        for strip in self.corners.split(|&index| index == -1) {
            if strip.len() < 3 {
                let kind = IgnoredKind::IncompleteTriangles;
                self.builder
                    .notices
                    .add_many(kind, strip.len() as u64, place);
            }
            for (number, triangle) in strip.windows(3).enumerate() {
                let [a, b, c] = match number % 2 {
                    0 => [0, 1, 2],
                    _ => [1, 0, 2],
                }
                .map(|i| triangle[i]);
                if a == b || b == c || a == c {
                    self.builder.notices.add(IgnoredKind::StripJoints, place);
                    continue;
                }
                let mut rows = [0; 3];
                for (row, index) in rows.iter_mut().zip([a, b, c]) {
                    *row = self.builder.vertex_row(index, || place)?;
                }
                self.builder.push_face(&rows, place)?;
            }
        }
        Ok(())
    }
}

impl Header {
    /// Returns what each element is for, and checks that there are positions.
    fn roles(&self, builder: &MeshBuilder) -> Result<Vec<Role>, ReadError> {
        let fault = |line, fault| ReadError::PlyHeader {
            at: builder.at(Place::Line(line)),
            fault,
        };
        let roles = self.elements.iter().map(role);
        let roles: Vec<Role> = roles
            .collect::<Result<_, _>>()
            .map_err(|(line, f)| fault(line, f))?;
        if !roles.iter().any(|role| matches!(role, Role::Vertices(_))) {
            return Err(fault(self.lines, PlyHeaderFault::NoVertices));
        }
        Ok(roles)
    }
}

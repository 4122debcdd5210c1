//! Triangles, strips and fans of a primitive.

use super::super::accessor::{Elements, elements};
use super::super::document::Primitive;
use super::super::fault;
use super::SceneReader;
use crate::error::ReadError;
use crate::faults::GltfFault;
use crate::notice::IgnoredKind;
use crate::place::Place;

impl SceneReader<'_, '_> {
    /// Adds the triangles of a primitive, whose first vertex has the row `first`.
    pub(super) fn read_triangles(
        &mut self,
        primitive: &Primitive,
        first: usize,
        vertices: u64,
        is_mirrored: bool,
        mesh: usize,
    ) -> Result<(), ReadError> {
        if !self.has_triangles(primitive, mesh)? {
            return Ok(());
        }
        let mut indices = match primitive.indices {
            Some(number) => {
                let by = ("mesh", mesh);
                let indices = elements(self.document, self.buffers, number, 1, by)?;
                Indices::Listed { number, indices }
            }
            None => Indices::InOrder(vertices),
        };
        self.spend(indices.count().saturating_mul(3))?;
        let place = Place::Item {
            kind: "mesh",
            number: mesh,
        };
        let mut last = [0; 3];
        for i in 0..indices.count() {
            let row = self.vertex(&mut indices, i, first, vertices)?;
            last = match (primitive.mode, i) {
                (6, 0) => [row, row, row],
                (6, _) => [last[0], last[2], row],
                _ => [last[1], last[2], row],
            };
            let [a, b, c] = last;
            let is_complete = if primitive.mode == 4 {
                i % 3 == 2
            } else {
                i >= 2
            };
            if !is_complete {
                continue;
            }
            let is_strip = primitive.mode == 5;
            if is_strip && (a == b || b == c || a == c) {
                self.builder.notices.add(IgnoredKind::StripJoints, place);
                continue;
            }
            // Every other triangle of a strip is turned.
            let is_turned = (is_strip && i % 2 == 1) != is_mirrored;
            let triangle = if is_turned { [b, a, c] } else { [a, b, c] };
            self.builder.push_face(&triangle, place)?;
        }
        if primitive.mode == 4 {
            let rest = indices.count() % 3;
            let notices = &mut self.builder.notices;
            notices.add_many(IgnoredKind::IncompleteTriangles, rest, place);
        }
        Ok(())
    }

    /// Returns whether the primitive has triangles, and not points or lines.
    fn has_triangles(&self, primitive: &Primitive, mesh: usize) -> Result<bool, ReadError> {
        if primitive.mode > 6 {
            let mode = primitive.mode;
            return Err(fault(
                self.buffers.name,
                "mesh",
                mesh,
                GltfFault::Mode { mode },
            ));
        }
        Ok(primitive.mode >= 4)
    }

    /// Returns the row of the vertex that index `i` names.
    fn vertex(
        &self,
        indices: &mut Indices,
        i: u64,
        first: usize,
        vertices: u64,
    ) -> Result<u32, ReadError> {
        let (accessor, index) = match indices {
            Indices::InOrder(_) => (0, i),
            Indices::Listed { number, indices } => {
                let index = indices.index(i);
                let failed = |f| fault(self.buffers.name, "accessor", *number, f);
                (*number, index.map_err(failed)?.unsigned_abs())
            }
        };
        if index >= vertices {
            let place = Place::Item {
                kind: "accessor",
                number: accessor,
            };
            return Err(ReadError::IndexOutOfRange {
                at: self.builder.at(place),
                index: i64::try_from(index).unwrap_or(i64::MAX),
                vertices: usize::try_from(vertices).unwrap_or(usize::MAX),
            });
        }
        // Both are numbers of vertices that were added.
        Ok(sixfold_core::row(first + index as usize))
    }
}

/// The indices of a primitive.
enum Indices<'a> {
    /// The vertices in order.
    InOrder(u64),
    Listed {
        number: usize,
        indices: Elements<'a>,
    },
}

impl Indices<'_> {
    fn count(&self) -> u64 {
        match self {
            Self::InOrder(count) => *count,
            Self::Listed { indices, .. } => indices.count,
        }
    }
}

//! The records of the corners of scanned faces.

use sixfold_core::{Column, Editing, Field, HoleSet, Probe, RecordTable};

use crate::scanned::{ScannedFaces, ScannedVertex};

const FACE: Column = Column::searched("face", "the face of the corner");
const VERTICES: &[Column] = &[Column::stored("vertex", "the vertex at the corner"), FACE];
const POSITIONS: &[Column] = &[
    Column::stored("position", "the coordinates of the corner"),
    FACE,
];

/// The description of the tables, for [`Described`](sixfold_core::Described).
impl<V: ScannedVertex, P: Probe, E: Editing> ScannedFaces<V, P, E> {
    /// Returns the table of corners, and the tables of the ranges of corners of the faces.
    pub fn record_tables(&self) -> Vec<RecordTable> {
        let corners = RecordTable {
            name: "corners",
            element: "corner",
            letter: "c",
            rows: self.corners.len(),
            columns: if V::IS_POSITION { POSITIONS } else { VERTICES },
        };
        let mut tables = vec![corners];
        tables.extend(self.spans.record_tables());
        tables
    }

    /// Returns the fields of a row; `None` if there is no such row, or for a deleted face or a blank
    /// corner. `vertex` is the field of a vertex.
    pub fn record(
        &self,
        table: &str,
        row: usize,
        vertex: impl Fn(V) -> Field,
    ) -> Option<Vec<Field>> {
        match table {
            "corners" => {
                let corner = self.corners.rows().get(row)?;
                if V::BLANK.is_at(corner) {
                    return None;
                }
                let face = Field::row("f", self.spans.face_of(row));
                Some(vec![vertex(V::from_corner(*corner)), face])
            }
            "offsets" | "spans" if self.holes.has(row) => None,
            _ => self.spans.record(table, row),
        }
    }
}

//! The records of a face-vertex mesh, as textbooks show them.

mod algorithms;

use sixfold_core::{
    Column, Described, Editing, Element, Field, HoleSet, Line, Probe, RecordTable, Relation,
    RowName,
};

use crate::mesh::{BLANK_CORNER, BLANK_PLACE, FaceVertexMesh, Fan};

const CORNERS: &[Column] = &[
    Column::stored("vertex", "the vertex at the corner"),
    Column::searched("face", "the face of the corner"),
];
const FANS: &[Column] = &[
    Column::stored(
        "first",
        "the place of the first face of the fan in the pool; none without a face",
    ),
    Column::stored("faces", "the number of faces around the vertex"),
];
const POOL: &[Column] = &[Column::stored("face", "a face around a vertex")];

impl<P: Probe, E: Editing> Described for FaceVertexMesh<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        let vertices = self.positions.len();
        let mut tables = vec![
            RecordTable::new("positions", "vertex", "v", vertices, &[Column::POSITION]),
            RecordTable::new("fans", "vertex", "v", vertices, FANS),
            RecordTable::new("pool", "place", "p", self.pool.len(), POOL),
            RecordTable::new("corners", "corner", "c", self.corners.len(), CORNERS),
        ];
        tables.extend(self.spans.record_tables());
        tables
    }

    fn record(&self, table: &str, row: usize, _walks: bool) -> Option<Vec<Field>> {
        match table {
            "positions" | "fans" if self.vertex_holes.has(row) => None,
            "positions" => Some(vec![Field::Point(*self.positions.rows().get(row)?)]),
            "fans" => {
                let &Fan { start, len } = self.fans.rows().get(row)?;
                let first = match len {
                    0 => Field::None,
                    _ => Field::Row(RowName {
                        letter: "p",
                        row: start,
                    }),
                };
                Some(vec![first, Field::Number(len)])
            }
            "pool" => {
                let face = self.pool.rows().get(row)?;
                (*face != BLANK_PLACE).then(|| vec![Field::row("f", *face)])
            }
            "corners" => {
                let vertex = *self.corners.rows().get(row)?;
                if vertex == BLANK_CORNER {
                    return None;
                }
                let face = Field::row("f", self.spans.face_of(row));
                Some(vec![Field::row("v", vertex), face])
            }
            "offsets" | "spans" if self.face_holes.has(row) => None,
            _ => self.spans.record(table, row),
        }
    }

    fn rows_of(&self, element: Element<Self>) -> Vec<RowName> {
        match element {
            Element::Vertex(v) => vec![RowName::new("v", v)],
            Element::Edge(e) => e.ends().map(|v| RowName::new("v", v)).to_vec(),
            Element::Face(f) => vec![RowName::new("f", f)],
        }
    }

    fn algorithm(relation: Relation) -> &'static [Line] {
        algorithms::of(relation)
    }
}

//! The records of a corner table, as textbooks show them.

mod algorithms;

use sixfold_core::{
    BuildError, Column, Described, Editing, Element, Field, HoleSet, Line, Probe, RecordTable,
    Relation, RowName, Word,
};

use crate::mesh::{CornerId, CornerTable};

const CORNER: &[Column] = &[Column::stored(
    "corner",
    "a corner at the vertex; on a boundary, the first one",
)];
const VERTEX: &[Column] = &[
    Column::stored("vertex", "the vertex at the corner"),
    Column::derived("triangle", "the triangle of the corner"),
    Column::derived("next", "the next corner of the triangle"),
    Column::derived("prev", "the previous corner of the triangle"),
];
const OPPOSITE: &[Column] = &[Column::stored(
    "opposite",
    "the corner across the edge that the corner faces; none at a boundary",
)];

impl<P: Probe, E: Editing> Described for CornerTable<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        let (vertices, corners) = (self.positions.len(), self.vertex.len());
        vec![
            RecordTable::new("positions", "vertex", "v", vertices, &[Column::POSITION]),
            RecordTable::new("corner", "vertex", "v", vertices, CORNER),
            RecordTable::new("vertex", "corner", "c", corners, VERTEX),
            RecordTable::new("opposite", "corner", "c", corners, OPPOSITE),
        ]
    }

    fn record(&self, table: &str, row: usize, _walks: bool) -> Option<Vec<Field>> {
        let is_hole = match table {
            "positions" | "corner" => self.vertex_holes.has(row),
            _ => self.face_holes.has(row / 3),
        };
        if is_hole {
            return None;
        }
        Some(match table {
            "positions" => vec![Field::Point(*self.positions.rows().get(row)?)],
            "corner" => vec![Field::optional("c", self.corner.rows().get(row)?.get())],
            "vertex" => {
                let vertex = *self.vertex.rows().get(row)?;
                let c = CornerId::new(row as u32);
                vec![
                    Field::row("v", vertex),
                    Field::row("f", c.triangle()),
                    Field::row("c", c.next()),
                    Field::row("c", c.prev()),
                ]
            }
            "opposite" => vec![Field::optional("c", self.opposite.rows().get(row)?.get())],
            _ => return None,
        })
    }

    fn rows_of(&self, element: Element<Self>) -> Vec<RowName> {
        vec![match element {
            Element::Vertex(v) => RowName::new("v", v),
            Element::Edge(e) => RowName::new("c", e.corner()),
            Element::Face(f) => RowName::new("f", f),
        }]
    }

    const WORDS: &'static [Word] = &[
        Word::new("c", "right", "opposite(next(x))"),
        Word::new("c", "left", "opposite(prev(x))"),
        Word::new("c", "swing", "next(opposite(next(x)))"),
    ];

    fn no_room(refusal: &BuildError) -> Option<String> {
        Some(match refusal {
            BuildError::NotATriangle { face, .. } => format!(
                "triangle t has the corners 3 t, 3 t + 1 and 3 t + 2, so the fourth corner of {face} has no place"
            ),
            BuildError::NonManifoldEdge { faces, .. } => format!(
                "a corner has one opposite, so the corner of {} across the edge has no place",
                faces.get(2)?
            ),
            BuildError::RepeatedSide { second, .. } => format!(
                "opposite corners see the edge in opposite directions, so the corner of {second} across the edge has no place"
            ),
            BuildError::NonManifoldVertex { vertex, second, .. } => format!(
                "a walk from the one corner of {vertex} around the vertex does not come to {second}"
            ),
            _ => return None,
        })
    }

    fn algorithm(relation: Relation) -> &'static [Line] {
        algorithms::of(relation)
    }
}

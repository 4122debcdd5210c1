//! The records of a half-edge mesh, as textbooks show them.

mod algorithms;

use sixfold_core::{
    BuildError, Column, Described, Editing, Element, Field, HoleSet, Line, Probe, RecordTable,
    Relation, RowName, Word,
};

use crate::mesh::{HalfEdgeId, HalfEdgeMesh};

const LEAVING: &[Column] = &[Column::stored(
    "half-edge",
    "a half-edge that leaves the vertex; on a boundary, the one without a face",
)];
const HALVES: &[Column] = &[
    Column::stored("origin", "the vertex where the half-edge starts"),
    Column::stored(
        "next",
        "the next half-edge along the face or the boundary loop",
    ),
    Column::stored("face", "the face on the left; none on a boundary loop"),
    Column::derived("twin", "the half-edge in the opposite direction"),
    Column::searched("prev", "the half-edge before it, which a walk finds"),
    Column::derived("edge", "the edge of the half-edge and its twin"),
];
const FIRST: &[Column] = &[Column::stored(
    "half-edge",
    "a half-edge with the face on its left",
)];

impl<P: Probe, E: Editing> Described for HalfEdgeMesh<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        let vertices = self.positions.len();
        vec![
            RecordTable::new("positions", "vertex", "v", vertices, &[Column::POSITION]),
            RecordTable::new("leaving", "vertex", "v", vertices, LEAVING),
            RecordTable::new("halves", "half-edge", "h", self.halves.len(), HALVES),
            RecordTable::new("first", "face", "f", self.first.len(), FIRST),
        ]
    }

    fn record(&self, table: &str, row: usize, walks: bool) -> Option<Vec<Field>> {
        let is_hole = match table {
            "positions" | "leaving" => self.vertex_holes.has(row),
            "halves" => self.edge_holes.has(row / 2),
            _ => self.face_holes.has(row),
        };
        if is_hole {
            return None;
        }
        Some(match table {
            "positions" => vec![Field::Point(*self.positions.rows().get(row)?)],
            "leaving" => vec![Field::optional("h", self.leaving.rows().get(row)?.get())],
            "halves" => {
                let half = self.halves.rows().get(row)?;
                let h = HalfEdgeId::new(row as u32);
                vec![
                    Field::row("v", half.origin),
                    Field::row("h", half.next),
                    Field::optional("f", half.face.get()),
                    Field::row("h", h.twin()),
                    Field::optional("h", walks.then(|| self.prev(h))),
                    Field::row("e", h.edge()),
                ]
            }
            "first" => vec![Field::row("h", *self.first.rows().get(row)?)],
            _ => return None,
        })
    }

    fn rows_of(&self, element: Element<Self>) -> Vec<RowName> {
        match element {
            Element::Vertex(v) => vec![RowName::new("v", v)],
            Element::Edge(e) => {
                let [one, other] = self.edge_half_edges(e).map(|h| RowName::new("h", h));
                vec![RowName::new("e", e), one, other]
            }
            Element::Face(f) => vec![RowName::new("f", f)],
        }
    }

    const WORDS: &'static [Word] = &[Word::new("h", "target", "origin(twin(x))")];

    fn no_room(refusal: &BuildError) -> Option<String> {
        Some(match refusal {
            BuildError::NonManifoldEdge { faces, .. } => format!(
                "a half-edge has one twin, so the side of {} has no place",
                faces.get(2)?
            ),
            BuildError::RepeatedSide { second, .. } => format!(
                "a half-edge and its twin run in opposite directions, so the side of {second} has no place"
            ),
            BuildError::NonManifoldVertex { vertex, second, .. } => format!(
                "a walk from the one half-edge of {vertex} around the vertex does not come to {second}"
            ),
            _ => return None,
        })
    }

    fn algorithm(relation: Relation) -> &'static [Line] {
        algorithms::of(relation)
    }
}

//! The records of a winged-edge mesh, as textbooks show them.

mod algorithms;

use sixfold_core::{
    BuildError, Column, Described, Editing, Element, Field, HoleSet, Line, Probe, RecordTable,
    Relation, RowName,
};

use crate::mesh::WingedEdgeMesh;

const SPOKES: &[Column] = &[Column::stored("edge", "an edge at the vertex")];
const EDGES: &[Column] = &[
    Column::stored("start", "the vertex where the edge starts"),
    Column::stored("end", "the vertex where the edge ends"),
    Column::stored("left", "the face on the left, seen from start to end"),
    Column::stored("right", "the face on the right"),
    Column::stored("left next", "the wing after the edge along the left face"),
    Column::stored("left prev", "the wing before the edge along the left face"),
    Column::stored("right next", "the wing after the edge along the right face"),
    Column::stored(
        "right prev",
        "the wing before the edge along the right face",
    ),
];
const SIDES: &[Column] = &[Column::stored("edge", "an edge of the face")];

impl<P: Probe, E: Editing> Described for WingedEdgeMesh<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        let vertices = self.positions.len();
        vec![
            RecordTable::new("positions", "vertex", "v", vertices, &[Column::POSITION]),
            RecordTable::new("spokes", "vertex", "v", vertices, SPOKES),
            RecordTable::new("edges", "edge", "e", self.edges.len(), EDGES),
            RecordTable::new("sides", "face", "f", self.sides.len(), SIDES),
        ]
    }

    fn record(&self, table: &str, row: usize, _walks: bool) -> Option<Vec<Field>> {
        let is_hole = match table {
            "positions" | "spokes" => self.vertex_holes.has(row),
            "edges" => self.edge_holes.has(row),
            _ => self.face_holes.has(row),
        };
        if is_hole {
            return None;
        }
        Some(match table {
            "positions" => vec![Field::Point(*self.positions.rows().get(row)?)],
            "spokes" => vec![Field::optional("e", self.spokes.rows().get(row)?.get())],
            "edges" => {
                let edge = self.edges.rows().get(row)?;
                let [start, end] = edge.ends().map(|v| Field::row("v", v));
                let [left, right] = edge.faces().map(|face| Field::optional("f", face));
                let [left_next, right_next] = edge.next().map(|e| Field::row("e", e));
                let [left_prev, right_prev] = edge.prev().map(|e| Field::row("e", e));
                vec![
                    start, end, left, right, left_next, left_prev, right_next, right_prev,
                ]
            }
            "sides" => vec![Field::row("e", *self.sides.rows().get(row)?)],
            _ => return None,
        })
    }

    fn rows_of(&self, element: Element<Self>) -> Vec<RowName> {
        vec![match element {
            Element::Vertex(v) => RowName::new("v", v),
            Element::Edge(e) => RowName::new("e", e),
            Element::Face(f) => RowName::new("f", f),
        }]
    }

    fn no_room(refusal: &BuildError) -> Option<String> {
        Some(match refusal {
            BuildError::NonManifoldEdge { faces, .. } => format!(
                "an edge has one face on its left and one on its right, so {} has no place",
                faces.get(2)?
            ),
            BuildError::RepeatedSide { first, second, .. } => format!(
                "an edge has one face on each side, and {first} and {second} are on the same one, so {second} has no place"
            ),
            BuildError::NonManifoldVertex { vertex, second, .. } => format!(
                "a walk from the one edge of {vertex} around the vertex does not come to {second}"
            ),
            _ => return None,
        })
    }

    fn algorithm(relation: Relation) -> &'static [Line] {
        algorithms::of(relation)
    }
}

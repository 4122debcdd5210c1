//! Edges with the faces along them.

use mesh_core::{Pair, PolygonMesh, VertexId, row};

/// One side of a face.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    /// The edge that the face runs along.
    pub(crate) edge: Pair<VertexId>,
    /// The face.
    pub(crate) face: u32,
    /// Where the side starts and ends, counted in the corners of all faces.
    pub(crate) corners: [u32; 2],
}

/// The sides of all faces, those of one edge beside each other; O(corners · log corners).
pub(crate) struct Edges(Vec<Side>);

impl Edges {
    /// The edges of `mesh`.
    pub(crate) fn of(mesh: &PolygonMesh) -> Self {
        let mut sides = Vec::with_capacity(mesh.corner_count());
        for (f, face) in mesh.faces().iter() {
            let start = mesh.faces().range(f).start;
            let edges = Pair::sides(face.len(), |i| face[i]);
            sides.extend(edges.enumerate().map(|(i, edge)| {
                let next = if i + 1 == face.len() { 0 } else { i + 1 };
                Side {
                    edge,
                    face: row(f.index()),
                    corners: [row(start + i), row(start + next)],
                }
            }));
        }
        sides.sort_unstable();
        Self(sides)
    }

    /// The sides of each edge.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[Side]> {
        self.0.chunk_by(|a, b| a.edge == b.edge)
    }
}

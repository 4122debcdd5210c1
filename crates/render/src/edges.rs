//! The edges of a mesh, each with its faces.

use sixfold_core::{Pair, PolygonMesh, VertexId, row};

/// One side of a face.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    /// The edge of this side.
    pub(crate) edge: Pair<VertexId>,
    /// The face.
    pub(crate) face: u32,
    /// The start and the end of the side, as rows of the corner table of all faces.
    pub(crate) corners: [u32; 2],
}

/// The sides of all faces, sorted by edge; O(corners · log corners).
pub(crate) struct Edges(Vec<Side>);

impl Edges {
    pub(crate) fn new(mesh: &PolygonMesh) -> Self {
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

    /// Iterates over the edges, each as the slice of its sides.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[Side]> {
        self.0.chunk_by(|a, b| a.edge == b.edge)
    }
}

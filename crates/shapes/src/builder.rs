//! A mesh while it is being built.

use sixfold_core::{FaceList, Point, PolygonMesh, VertexId, row};

/// Positions and faces in the order in which they are added.
pub(crate) struct MeshBuilder {
    positions: Vec<Point>,
    faces: FaceList,
}

impl MeshBuilder {
    /// Creates an empty builder with capacity for these numbers of vertices and corners.
    pub(crate) fn with_capacity(vertices: usize, corners: usize) -> Self {
        Self {
            positions: Vec::with_capacity(vertices),
            faces: FaceList::with_capacity(corners),
        }
    }

    /// Adds a vertex and returns its number. The position is rounded to `f32`, and −0 becomes 0.
    pub(crate) fn add_vertex(&mut self, position: [f64; 3]) -> u32 {
        let number = row(self.positions.len());
        let position = position.map(|x| x as f32 + 0.0);
        self.positions.push(Point::from_array(position));
        number
    }

    pub(crate) fn add_face(&mut self, corners: impl IntoIterator<Item = u32>) {
        let corners = corners.into_iter().map(VertexId::new);
        let pushed = self.faces.push(corners);
        pushed.expect("the number of corners is checked before a builder is created");
    }

    pub(crate) fn face_count(&self) -> usize {
        self.faces.len()
    }

    pub(crate) fn build(self) -> PolygonMesh {
        let mesh = PolygonMesh::from_faces(self.positions, self.faces);
        mesh.expect("the faces of a shape use existing vertices, each at most once per face")
    }
}

//! A mesh being written down.

use mesh_core::{FaceList, Point, PolygonMesh, VertexId, row};

/// Positions and faces in the order in which they are added.
pub(crate) struct Draft {
    positions: Vec<Point>,
    faces: FaceList,
}

impl Draft {
    /// An empty draft with room for some vertices and corners.
    pub(crate) fn with_capacity(vertices: usize, corners: usize) -> Self {
        Self {
            positions: Vec::with_capacity(vertices),
            faces: FaceList::with_capacity(corners),
        }
    }

    /// Adds a vertex, rounded to `f32` and with −0 as 0; its number.
    pub(crate) fn vertex(&mut self, position: [f64; 3]) -> u32 {
        let name = row(self.positions.len());
        let position = position.map(|x| x as f32 + 0.0);
        self.positions.push(Point::from_array(position));
        name
    }

    /// Adds a face.
    pub(crate) fn face(&mut self, corners: impl IntoIterator<Item = u32>) {
        let corners = corners.into_iter().map(VertexId::new);
        let pushed = self.faces.push(corners);
        pushed.expect("the size was checked before the draft was begun");
    }

    /// How many faces there are so far.
    pub(crate) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The mesh.
    pub(crate) fn finish(self) -> PolygonMesh {
        let mesh = PolygonMesh::from_faces(self.positions, self.faces);
        mesh.expect("a shape names only vertices it has, each once a face")
    }
}

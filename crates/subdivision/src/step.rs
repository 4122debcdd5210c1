//! The refined mesh of one step.

use sixfold_core::{Creases, FaceList, MeshQuery, Point, PolygonMesh, Split, VertexId};

use crate::SubdivisionError;

/// The result of one step: the refined mesh, and the creases of the refined mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Step {
    /// The refined mesh. With the methods gather and scatter, the new faces that are made from one
    /// old face are consecutive.
    ///
    /// After a face split, the vertices are the old vertices, then the face points, then the points
    /// on edges. Old vertices and face points are in the order of the old structure. Points on
    /// edges have the order of the method: the order of `edges()` (gather, native), or the order in
    /// which the faces list the edges (scatter). After a vertex split (Doo–Sabin), each vertex
    /// comes from one corner of an old face. The faces are sorted by their origin: first the faces
    /// from old faces, then the faces from old edges, then the faces from old vertices.
    pub polygons: PolygonMesh,
    /// The creases of [`polygons`](Self::polygons).
    pub creases: Creases,
}

pub(crate) struct StepBuilder {
    split: Split,
    vertices: usize,
    expected_edges: usize,
    corners: Vec<VertexId>,
    /// Vertex points, then face points, then edge points.
    pub(crate) points: Vec<Point>,
}

impl StepBuilder {
    /// Builds an empty mesh with capacity for the split of `mesh`, whose faces have `corners`
    /// corners in total.
    pub(crate) fn new<M: MeshQuery>(split: Split, mesh: &M, corners: usize) -> Self {
        let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
        // Exact for closed meshes, approximate for meshes with boundaries. The tables can grow.
        let expected_edges = (corners / 2).max(vertices + faces).min(corners);
        let (points, corners) = match split {
            Split::Quads => (vertices + faces + expected_edges, 4 * corners),
            _ => (vertices + expected_edges, 12 * faces),
        };
        Self {
            split,
            vertices,
            expected_edges,
            corners: Vec::with_capacity(corners),
            points: Vec::with_capacity(points),
        }
    }

    /// Returns the number of vertices of the mesh that is split.
    pub(crate) fn vertices(&self) -> usize {
        self.vertices
    }

    pub(crate) fn expected_edges(&self) -> usize {
        self.expected_edges
    }

    pub(crate) fn has_face_points(&self) -> bool {
        self.split == Split::Quads
    }

    /// Splits all faces. `number` returns the number of a vertex. `edge_point` returns the number
    /// of the point of an edge.
    pub(crate) fn split_faces<M: MeshQuery>(
        &mut self,
        mesh: &M,
        number: impl Fn(M::Vertex) -> u32,
        edge_point: impl Fn(M::Edge) -> u32,
    ) -> Result<(), SubdivisionError> {
        let mut face_point = self.vertices as u32;
        let (mut corners, mut middles) = (Vec::new(), Vec::new());
        mesh.faces().for_each(|f| {
            corners.clear();
            middles.clear();
            mesh.face_vertices(f).for_each(|v| corners.push(number(v)));
            mesh.face_edges(f).for_each(|e| middles.push(edge_point(e)));
            self.split_face(&corners, &middles, face_point);
            face_point += 1;
        });
        Ok(())
    }

    /// Splits a face with these corners. `middles` contains the points of the sides, in the order
    /// of the corners.
    #[inline(always)]
    pub(crate) fn split_face(&mut self, corners: &[u32], middles: &[u32], face_point: u32) {
        let mut prev = middles[middles.len() - 1];
        for (&corner, &middle) in corners.iter().zip(middles) {
            let part = match self.split {
                Split::Quads => &[corner, middle, face_point, prev][..],
                _ => &[corner, middle, prev],
            };
            self.corners.extend(part.iter().map(|&v| VertexId::new(v)));
            prev = middle;
        }
        if self.split == Split::Triangles {
            self.corners
                .extend(middles.iter().map(|&v| VertexId::new(v)));
        }
    }

    pub(crate) fn finish(self, creases: Creases) -> Result<Step, SubdivisionError> {
        let degree = match self.split {
            Split::Quads => 4,
            _ => 3,
        };
        let faces = FaceList::uniform(degree, self.corners)?;
        let polygons = PolygonMesh::from_faces(self.points, faces)?;
        Ok(Step { polygons, creases })
    }
}

/// The vertices with a crease.
pub(crate) struct CreaseVertices(Vec<bool>);

impl CreaseVertices {
    pub(crate) fn new(creases: &Creases, vertices: usize) -> Self {
        if creases.edges().is_empty() {
            return Self(Vec::new());
        }
        let mut has_crease = vec![false; vertices];
        for v in creases.edges().iter().flat_map(|(ends, _)| ends.ends()) {
            has_crease[v.index()] = true;
        }
        Self(has_crease)
    }

    pub(crate) fn sharpness(&self, creases: &Creases, ends: [u32; 2], by_topology: bool) -> f32 {
        if by_topology {
            return f32::INFINITY;
        }
        let [a, b] = ends;
        let has_crease = |v: u32| self.0.get(v as usize).is_some_and(|&has_crease| has_crease);
        if has_crease(a) && has_crease(b) {
            creases.edge(VertexId::new(a), VertexId::new(b))
        } else {
            0.0
        }
    }
}

//! The column of tri-mesh: a half-edge structure for triangles, with walkers and 64-bit positions.

use std::error::Error;

use column::{Column, Input};
use three_d_asset::{Indices, Positions, TriMesh as Arrays};
use tri_mesh::{FaceID, HalfEdgeID, Mesh, VertexID, vec3};

struct TriMesh {
    mesh: Mesh,
    vertices: Vec<VertexID>,
}

impl TriMesh {
    /// Returns the edge of a half-edge: the smaller of the two half-edges of the edge.
    fn edge(&self, half: HalfEdgeID) -> HalfEdgeID {
        let twin = self.mesh.walker_from_halfedge(half).twin_id();
        twin.map_or(half, |twin| twin.min(half))
    }
}

impl Column for TriMesh {
    type Vertex = VertexID;
    type Edge = HalfEdgeID;
    type Face = FaceID;

    const LIBRARY: &'static str = "tri-mesh 0.6";

    fn build(input: &Input) -> Result<Self, String> {
        let mesh = Mesh::new(&Arrays {
            positions: Positions::F32(input.positions.iter().map(|&p| p.into()).collect()),
            indices: Indices::U32(input.triangles()?.flatten().collect()),
            ..Default::default()
        });
        let vertices = mesh.vertex_iter().collect();
        Ok(Self { mesh, vertices })
    }

    fn vertices(&self) -> impl Iterator<Item = VertexID> {
        self.mesh.vertex_iter()
    }
    fn edges(&self) -> impl Iterator<Item = HalfEdgeID> {
        self.mesh.edge_iter()
    }
    fn faces(&self) -> impl Iterator<Item = FaceID> {
        self.mesh.face_iter()
    }
    fn vertex_index(&self, v: VertexID) -> usize {
        *v as usize
    }
    fn edge_index(&self, e: HalfEdgeID) -> usize {
        *e as usize
    }
    fn face_index(&self, f: FaceID) -> usize {
        *f as usize
    }
    fn vertex_vertices(&self, v: VertexID, mut sink: impl FnMut(VertexID)) {
        for half in self.mesh.vertex_halfedge_iter(v) {
            let end = self.mesh.walker_from_halfedge(half).vertex_id();
            sink(end.expect("a half-edge has an end"));
        }
    }
    fn vertex_edges(&self, v: VertexID, mut sink: impl FnMut(HalfEdgeID)) {
        for half in self.mesh.vertex_halfedge_iter(v) {
            sink(self.edge(half));
        }
    }
    fn vertex_faces(&self, v: VertexID, mut sink: impl FnMut(FaceID)) {
        for half in self.mesh.vertex_halfedge_iter(v) {
            let face = self.mesh.walker_from_halfedge(half).face_id();
            face.into_iter().for_each(&mut sink);
        }
    }
    fn edge_vertices(&self, e: HalfEdgeID) -> [VertexID; 2] {
        self.mesh.edge_vertices(e).into()
    }
    fn edge_faces(&self, e: HalfEdgeID, sink: impl FnMut(FaceID)) {
        let here = self.mesh.walker_from_halfedge(e);
        let across = self.mesh.walker_from_halfedge(e).into_twin();
        let faces = [here.face_id(), across.face_id()];
        faces.into_iter().flatten().for_each(sink);
    }
    fn face_vertices(&self, f: FaceID, sink: impl FnMut(VertexID)) {
        let corners: [VertexID; 3] = self.mesh.face_vertices(f).into();
        corners.into_iter().for_each(sink);
    }
    fn face_edges(&self, f: FaceID, mut sink: impl FnMut(HalfEdgeID)) {
        for half in self.mesh.face_halfedge_iter(f) {
            sink(self.edge(half));
        }
    }
    fn face_faces(&self, f: FaceID, mut sink: impl FnMut(FaceID)) {
        for half in self.mesh.face_halfedge_iter(f) {
            let across = self.mesh.walker_from_halfedge(half).into_twin();
            across.face_id().into_iter().for_each(&mut sink);
        }
    }
    fn position(&self, v: VertexID) -> [f32; 3] {
        let point = self.mesh.vertex_position(v);
        [point.x as f32, point.y as f32, point.z as f32]
    }
    fn set_positions(&mut self, positions: &[[f32; 3]]) {
        for (&v, &[x, y, z]) in self.vertices.iter().zip(positions) {
            let point = vec3(x.into(), y.into(), z.into());
            self.mesh.set_vertex_position(v, point);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    column::serve::<TriMesh>()
}

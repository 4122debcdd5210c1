//! The column of lox: its half-edge structure for triangles, with positions in a separate map.

use std::error::Error;

use column::{Column, Input};
use lox::core::HalfEdgeMesh;
use lox::core::half_edge::TriConfig;
use lox::lina::Point3;
use lox::map::DenseMap;
use lox::prelude::*;
use lox::{EdgeHandle, FaceHandle, VertexHandle};

struct Lox {
    mesh: HalfEdgeMesh<TriConfig>,
    positions: DenseMap<VertexHandle, Point3<f32>>,
}

impl Column for Lox {
    type Vertex = VertexHandle;
    type Edge = EdgeHandle;
    type Face = FaceHandle;

    const LIBRARY: &'static str = "lox 0.1 HalfEdgeMesh<TriConfig>";

    fn build(input: &Input) -> Result<Self, String> {
        let mut mesh = HalfEdgeMesh::empty();
        let mut positions = DenseMap::with_capacity(input.positions.len() as u32);
        mesh.reserve_for_vertices(input.positions.len() as u32);
        mesh.reserve_for_faces(input.starts.len() as u32);
        for &[x, y, z] in &input.positions {
            let vertex = mesh.add_vertex();
            positions.insert(vertex, Point3::new(x, y, z));
        }
        for triangle in input.triangles()? {
            mesh.add_triangle(triangle.map(VertexHandle::new));
        }
        Ok(Self { mesh, positions })
    }

    fn vertices(&self) -> impl Iterator<Item = VertexHandle> {
        self.mesh.vertex_handles()
    }
    fn edges(&self) -> impl Iterator<Item = EdgeHandle> {
        self.mesh.edge_handles()
    }
    fn faces(&self) -> impl Iterator<Item = FaceHandle> {
        self.mesh.face_handles()
    }
    fn vertex_index(&self, v: VertexHandle) -> usize {
        v.to_usize()
    }
    fn edge_index(&self, e: EdgeHandle) -> usize {
        e.to_usize()
    }
    fn face_index(&self, f: FaceHandle) -> usize {
        f.to_usize()
    }
    fn vertex_vertices(&self, v: VertexHandle, sink: impl FnMut(VertexHandle)) {
        self.mesh.vertices_around_vertex(v).for_each(sink);
    }
    fn vertex_edges(&self, v: VertexHandle, sink: impl FnMut(EdgeHandle)) {
        self.mesh.edges_around_vertex(v).for_each(sink);
    }
    fn vertex_faces(&self, v: VertexHandle, sink: impl FnMut(FaceHandle)) {
        self.mesh.faces_around_vertex(v).for_each(sink);
    }
    fn edge_vertices(&self, e: EdgeHandle) -> [VertexHandle; 2] {
        self.mesh.endpoints_of_edge(e)
    }
    fn edge_faces(&self, e: EdgeHandle, sink: impl FnMut(FaceHandle)) {
        self.mesh.faces_of_edge(e).into_iter().for_each(sink);
    }
    fn face_vertices(&self, f: FaceHandle, sink: impl FnMut(VertexHandle)) {
        self.mesh
            .vertices_around_triangle(f)
            .into_iter()
            .for_each(sink);
    }
    fn face_edges(&self, f: FaceHandle, sink: impl FnMut(EdgeHandle)) {
        self.mesh
            .edges_around_triangle(f)
            .into_iter()
            .for_each(sink);
    }
    fn face_faces(&self, f: FaceHandle, sink: impl FnMut(FaceHandle)) {
        self.mesh
            .faces_around_triangle(f)
            .into_iter()
            .for_each(sink);
    }
    fn position(&self, v: VertexHandle) -> [f32; 3] {
        let point = self.positions[v];
        [point.x, point.y, point.z]
    }
    fn set_positions(&mut self, positions: &[[f32; 3]]) {
        let points = self.positions.values_mut();
        for (point, &[x, y, z]) in points.zip(positions) {
            *point = Point3::new(x, y, z);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    column::serve::<Lox>()
}

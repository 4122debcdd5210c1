//! The column of alum: a half-edge structure similar to OpenMesh, with polygons and 32-bit
//! positions.

use std::error::Error;

use alum::{EH, FH, Handle, HasIterators, HasTopology, PolyMeshF32, VH, Vec3};
use column::{Column, Input};

struct Alum(PolyMeshF32);

impl Column for Alum {
    type Vertex = VH;
    type Edge = EH;
    type Face = FH;

    const LIBRARY: &'static str = "alum 0.7";

    fn build(input: &Input) -> Result<Self, String> {
        let [vertices, corners] = [input.positions.len(), input.corners.len()];
        let mut mesh = PolyMeshF32::with_capacity(vertices, corners / 2, input.starts.len());
        for &[x, y, z] in &input.positions {
            let added = mesh.add_vertex(Vec3(x, y, z));
            added.map_err(|error| format!("{error:?}"))?;
        }
        let mut corners: Vec<VH> = Vec::new();
        for (number, face) in input.faces().enumerate() {
            corners.clear();
            corners.extend(face.iter().map(|&v| VH::from(v)));
            let added = mesh.add_face(&corners);
            added.map_err(|error| format!("face {number}: {error:?}"))?;
        }
        Ok(Self(mesh))
    }

    fn vertices(&self) -> impl Iterator<Item = VH> {
        self.0.vertices()
    }
    fn edges(&self) -> impl Iterator<Item = EH> {
        self.0.edges()
    }
    fn faces(&self) -> impl Iterator<Item = FH> {
        self.0.faces()
    }
    fn vertex_index(&self, v: VH) -> usize {
        v.index() as usize
    }
    fn edge_index(&self, e: EH) -> usize {
        e.index() as usize
    }
    fn face_index(&self, f: FH) -> usize {
        f.index() as usize
    }
    fn vertex_vertices(&self, v: VH, sink: impl FnMut(VH)) {
        self.0.vv_ccw_iter(v).for_each(sink);
    }
    fn vertex_edges(&self, v: VH, sink: impl FnMut(EH)) {
        self.0.ve_ccw_iter(v).for_each(sink);
    }
    fn vertex_faces(&self, v: VH, sink: impl FnMut(FH)) {
        self.0.vf_ccw_iter(v).for_each(sink);
    }
    fn edge_vertices(&self, e: EH) -> [VH; 2] {
        e.vertices(&self.0).into()
    }
    fn edge_faces(&self, e: EH, sink: impl FnMut(FH)) {
        self.0.ef_iter(e).for_each(sink);
    }
    fn face_vertices(&self, f: FH, sink: impl FnMut(VH)) {
        self.0.fv_ccw_iter(f).for_each(sink);
    }
    fn face_edges(&self, f: FH, sink: impl FnMut(EH)) {
        self.0.fe_ccw_iter(f).for_each(sink);
    }
    fn face_faces(&self, f: FH, sink: impl FnMut(FH)) {
        self.0.ff_ccw_iter(f).for_each(sink);
    }
    fn position(&self, v: VH) -> [f32; 3] {
        let Vec3(x, y, z) = self.0.point(v).expect("a vertex of this mesh");
        [x, y, z]
    }
    fn set_positions(&mut self, positions: &[[f32; 3]]) {
        let mut points = self.0.points();
        let mut points = points.try_borrow_mut().expect("no other borrow exists");
        for (number, &[x, y, z]) in positions.iter().enumerate() {
            points[VH::from(number as u32)] = Vec3(x, y, z);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    column::serve::<Alum>()
}

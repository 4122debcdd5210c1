//! The column of parry3d: a triangle mesh with half-edges and a bounding volume hierarchy. parry3d
//! has the half-edge tables but no traversals, so this file implements the traversals.

use std::error::Error;

use column::{Column, Input};
use parry3d::math::Vector;
use parry3d::shape::{TopoHalfEdge, TriMesh, TriMeshFlags};

/// The twin of a half-edge at the boundary.
const NONE: u32 = u32::MAX;

struct Parry {
    mesh: TriMesh,
    edges: Vec<u32>,
}

impl Parry {
    fn half_edges(&self) -> &[TopoHalfEdge] {
        let topology = self.mesh.topology();
        &topology.expect("built with it").half_edges
    }

    /// Returns the previous half-edge. The three half-edges of a triangle have consecutive numbers.
    fn prev(half: u32) -> u32 {
        if half % 3 == 0 { half + 2 } else { half - 1 }
    }

    /// Returns the edge of a half-edge: the smaller of the two half-edges of the edge.
    fn edge(&self, half: u32) -> u32 {
        half.min(self.half_edges()[half as usize].twin)
    }

    /// Returns the three half-edges of a triangle.
    fn sides(&self, f: u32) -> std::ops::Range<u32> {
        let topology = self.mesh.topology().expect("built with it");
        let first = topology.faces[f as usize].half_edge;
        first..first + 3
    }

    fn end(&self, half: u32) -> u32 {
        let half_edges = self.half_edges();
        half_edges[half_edges[half as usize].next as usize].vertex
    }

    /// Calls `sink` with every half-edge that starts at `v`, and `false`. At a boundary, one
    /// half-edge ends at `v` and has no twin; `sink` is then called with this half-edge and `true`.
    fn visit_spokes(&self, v: u32, mut sink: impl FnMut(u32, bool)) {
        let half_edges = self.half_edges();
        let topology = self.mesh.topology().expect("built with it");
        let first = topology.vertices[v as usize].half_edge;
        if first == NONE {
            return;
        }
        let mut half = first;
        loop {
            sink(half, false);
            let incoming = Self::prev(half);
            half = half_edges[incoming as usize].twin;
            if half == first {
                return;
            }
            if half == NONE {
                sink(incoming, true);
                break;
            }
        }
        // Continues in the other direction from the first half-edge to the boundary.
        let mut across = half_edges[first as usize].twin;
        while across != NONE {
            let next = half_edges[across as usize].next;
            sink(next, false);
            across = half_edges[next as usize].twin;
        }
    }
}

impl Column for Parry {
    type Vertex = u32;
    type Edge = u32;
    type Face = u32;

    const LIBRARY: &'static str = "parry3d 0.31 TriMesh";

    fn build(input: &Input) -> Result<Self, String> {
        let points = input.positions.iter().map(|&p| Vector::from(p)).collect();
        let triangles = input.triangles()?.collect();
        let mesh = TriMesh::with_flags(points, triangles, TriMeshFlags::HALF_EDGE_TOPOLOGY);
        let mesh = mesh.map_err(|error| format!("{error:?}"))?;
        let topology = mesh.topology().ok_or("it has not built the topology")?;
        let halves = topology.half_edges.iter().zip(0..);
        let edges = halves.filter_map(|(half, number)| (number < half.twin).then_some(number));
        let edges = edges.collect();
        Ok(Self { mesh, edges })
    }

    fn vertices(&self) -> impl Iterator<Item = u32> {
        0..self.mesh.vertices().len() as u32
    }
    fn edges(&self) -> impl Iterator<Item = u32> {
        self.edges.iter().copied()
    }
    fn faces(&self) -> impl Iterator<Item = u32> {
        0..self.mesh.indices().len() as u32
    }
    fn vertex_index(&self, v: u32) -> usize {
        v as usize
    }
    fn edge_index(&self, e: u32) -> usize {
        e as usize
    }
    fn face_index(&self, f: u32) -> usize {
        f as usize
    }
    fn vertex_vertices(&self, v: u32, mut sink: impl FnMut(u32)) {
        self.visit_spokes(v, |half, last| {
            sink(match last {
                true => self.half_edges()[half as usize].vertex,
                false => self.end(half),
            });
        });
    }
    fn vertex_edges(&self, v: u32, mut sink: impl FnMut(u32)) {
        self.visit_spokes(v, |half, _| sink(self.edge(half)));
    }
    fn vertex_faces(&self, v: u32, mut sink: impl FnMut(u32)) {
        self.visit_spokes(v, |half, last| {
            if !last {
                sink(self.half_edges()[half as usize].face);
            }
        });
    }
    fn edge_vertices(&self, e: u32) -> [u32; 2] {
        [self.half_edges()[e as usize].vertex, self.end(e)]
    }
    fn edge_faces(&self, e: u32, mut sink: impl FnMut(u32)) {
        let half_edges = self.half_edges();
        sink(half_edges[e as usize].face);
        if let Some(twin) = half_edges.get(half_edges[e as usize].twin as usize) {
            sink(twin.face);
        }
    }
    fn face_vertices(&self, f: u32, sink: impl FnMut(u32)) {
        self.mesh.indices()[f as usize].into_iter().for_each(sink);
    }
    fn face_edges(&self, f: u32, mut sink: impl FnMut(u32)) {
        for half in self.sides(f) {
            sink(self.edge(half));
        }
    }
    fn face_faces(&self, f: u32, mut sink: impl FnMut(u32)) {
        let half_edges = self.half_edges();
        for half in self.sides(f) {
            if let Some(twin) = half_edges.get(half_edges[half as usize].twin as usize) {
                sink(twin.face);
            }
        }
    }
    fn position(&self, v: u32) -> [f32; 3] {
        self.mesh.vertices()[v as usize].into()
    }
    fn set_positions(&mut self, positions: &[[f32; 3]]) {
        // parry3d has no other function to move vertices. This function also rebuilds the
        // hierarchy.
        self.mesh.update_vertices(|points| {
            for (point, &position) in points.iter_mut().zip(positions) {
                *point = position.into();
            }
        });
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    column::serve::<Parry>()
}

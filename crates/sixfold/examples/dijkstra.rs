//! Distances along the edges of a mesh, from one vertex to all others (Dijkstra 1959).
//!
//! ```sh
//! cargo run --example dijkstra -- mesh.obj
//! ```

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::error::Error;

use sixfold::prelude::*;

mod common;

/// Returns for every vertex the length of the shortest path from `source` along edges, or infinity
/// if there is no path. Time: O(E log E) for E edges, if a query of `vertex_vertices` does not scan
/// the mesh.
pub fn distances<M: MeshQuery>(mesh: &M, source: M::Vertex) -> VertexMap<M, f64> {
    let mut distances = mesh.vertex_map(f64::INFINITY);
    distances[source] = 0.0;
    // Non-negative floats have the same order as their bits. Bits implement `Ord`.
    let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), source))]);
    while let Some(Reverse((bits, v))) = queue.pop() {
        let distance = f64::from_bits(bits);
        if distance > distances[v] {
            continue; // A shorter path to `v` was found after this entry was queued.
        }
        for w in mesh.vertex_vertices(v) {
            let length = f64::from(mesh.position(v).distance(mesh.position(w)));
            let through_v = distance + length;
            if through_v < distances[w] {
                distances[w] = through_v;
                queue.push(Reverse((through_v.to_bits(), w)));
            }
        }
    }
    distances
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::geodesic(16)?)?;
    let mesh = HalfEdgeMesh::from_polygons(&polygons)?;
    let source = mesh.vertices().next().ok_or("the mesh has no vertices")?;
    let distances = distances(&mesh, source);
    let reached = mesh.vertices().filter(|&v| distances[v].is_finite());
    let farthest = reached.max_by(|&v, &w| distances[v].total_cmp(&distances[w]));
    if let Some(v) = farthest {
        println!("{v:?} is farthest from {source:?}: {:.4}", distances[v]);
    }
    Ok(())
}

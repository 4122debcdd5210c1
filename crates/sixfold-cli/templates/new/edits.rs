//! Measures a program that edits the mesh on every mesh data structure of Sixfold.
//!
//! ```sh
//! cargo run --release -- mesh.obj --budget 20s
//! ```

use std::process::ExitCode;

use sixfold::prelude::*;
use sixfold::remeshing::meets_link_condition;
use sixfold_measure::{EditProgram, Outcome, Suite};

fn main() -> ExitCode {
    sixfold_measure::main(Suite::new().edit_program(ShortEdges))
}

/// Collapses the edges that are shorter than 0.7 of the mean length. Replace it by your own program.
struct ShortEdges;

impl EditProgram for ShortEdges {
    /// Data for a run, such as `VertexMap<M, f32>`: here the length below which an edge is short.
    type Scratch<M: MeshEdit> = f32;

    fn name(&self) -> &str {
        "short-edges"
    }

    /// Makes the scratch data. This work is not timed.
    fn set_up<M: MeshEdit>(&self, mesh: &M) -> Result<f32, String> {
        let lengths: f64 = mesh.edges().map(|e| f64::from(length(mesh, e))).sum();
        Ok((0.7 * lengths / mesh.edge_count().max(1) as f64) as f32)
    }

    /// This work is timed. Each run gets a fresh copy of the mesh.
    fn run<M: MeshEdit>(&self, mesh: &mut M, least: &mut f32) -> Outcome {
        let asked = mesh.edge_count();
        let collapsed = collapse_short(mesh, *least);
        let lengths: f64 = mesh.edges().map(|e| f64::from(length(mesh, e))).sum();
        // The result, which must be the same on every structure, and the amount of work.
        Outcome::new(lengths + collapsed as f64, asked as u64)
    }
}

fn length<M: MeshQuery>(mesh: &M, e: M::Edge) -> f32 {
    let [p, q] = mesh.edge_vertices(e).map(|v| mesh.position(v));
    p.distance(q)
}

/// Collapses edges that are shorter than `least`, the shortest first. Returns the number of collapses.
///
/// The result is the same on every structure: the order comes from the positions and not from handles, an edge has to
/// wait for the next pass if an earlier collapse has changed a face at its ends, and the link condition is asked of
/// every structure. See "Editing while iterating" in the documentation of `MeshEdit`.
fn collapse_short<M: MeshEdit>(mesh: &mut M, least: f32) -> usize {
    let mut done = 0;
    loop {
        let mut short = Vec::new();
        for e in mesh.edges() {
            let ends = mesh.edge_vertices(e);
            let places = ends.map(|v| mesh.position(v));
            let length = places[0].distance(places[1]);
            if length < least {
                let mut places = places.map(|p| p.to_array().map(f32::to_bits));
                places.sort_unstable();
                short.push((length.to_bits(), places, e, ends));
            }
        }
        short.sort_unstable_by_key(|&(length, places, ..)| (length, places));
        let mut changed = mesh.vertex_map(false);
        let before = done;
        for (_, _, e, ends) in short {
            if ends.iter().any(|&v| changed[v]) || !meets_link_condition(mesh, e) {
                continue;
            }
            let [p, q] = ends.map(|v| mesh.position(v));
            let around = ends.map(|v| mesh.vertex_vertices(v).collect::<Vec<_>>());
            if mesh.collapse_edge(e, ends[0], p.midpoint(q)).is_ok() {
                done += 1;
                for v in around.into_iter().flatten() {
                    changed[v] = true;
                }
            }
        }
        if done == before {
            return done;
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use super::*;

    /// Returns the outcome on a torus, whose edges have different lengths.
    fn outcome<M: Representation + MeshEdit>() -> Outcome {
        let torus = shapes::triangle_torus(24, 12).expect("a torus");
        let mut mesh = M::from_polygons(&torus).expect("every structure holds a torus");
        let mut least = ShortEdges.set_up(&mesh).expect("it accepts every mesh");
        ShortEdges.run(&mut mesh, &mut least)
    }

    #[test]
    fn the_result_is_the_same_on_two_structures() {
        let half_edge = outcome::<EditableHalfEdgeMesh>();
        let face_vertex = outcome::<EditableFaceVertexMesh>();
        assert_eq!(half_edge.elements, face_vertex.elements);
        assert!((half_edge.checksum - face_vertex.checksum).abs() < 1e-6 * half_edge.checksum);
    }
}

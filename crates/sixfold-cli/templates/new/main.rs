//! Measures a program on every mesh data structure of Sixfold.
//!
//! ```sh
//! cargo run --release -- mesh.obj --budget 20s
//! ```

use std::process::ExitCode;

use sixfold::operators::face_normals;
use sixfold::prelude::*;
use sixfold_measure::{Outcome, Program};

fn main() -> ExitCode {
    sixfold_measure::main(SharpEdges)
}

/// Counts the edges at which the surface bends by more than 30 degrees, and adds up their lengths.
/// Replace it by your own program.
struct SharpEdges;

impl Program for SharpEdges {
    /// Data that the program keeps between runs, such as `VertexMap<M, f32>`.
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "sharp-edges"
    }

    /// Makes the scratch data. This work is not timed.
    fn set_up<M: MeshQuery>(&self, _mesh: &M) -> Result<(), String> {
        Ok(())
    }

    /// This work is timed.
    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let normals = face_normals(mesh);
        let mut length = 0.0;
        let mut edges = 0;
        for e in mesh.edges() {
            edges += 1;
            let mut faces = mesh.edge_faces(e);
            let (Some(f), Some(g)) = (faces.next(), faces.next()) else {
                continue; // an edge at a boundary
            };
            if normals[f].dot(normals[g]) < 30_f32.to_radians().cos() {
                let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
                length += f64::from(a.distance(b));
            }
        }
        // The result, which must be the same on every structure, and the amount of work.
        Outcome::new(length, edges)
    }
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use super::*;

    fn outcome<M: Representation>() -> Outcome {
        let mesh = M::from_polygons(&shapes::cube()).expect("a cube is held by every structure");
        SharpEdges.run(&mesh, &mut ())
    }

    #[test]
    fn all_edges_of_a_cube_are_sharp() {
        let [half_edge, face_vertex] = [outcome::<HalfEdgeMesh>(), outcome::<FaceVertexMesh>()];
        assert_eq!(half_edge, face_vertex);
        assert_eq!(half_edge.elements, 12);
        let side = shapes::cube().position(VertexId::new(0)).x.abs() * 2.0;
        assert!((half_edge.checksum - 12.0 * f64::from(side)).abs() < 1e-5);
    }
}

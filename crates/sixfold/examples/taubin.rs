//! Smoothing without shrinking (Taubin 1995). Each step first moves every vertex towards the mean
//! of its neighbours. Then the step moves every vertex away from the mean, by a slightly larger
//! factor.
//!
//! ```sh
//! cargo run --example taubin -- mesh.obj > smooth.obj
//! ```

use std::error::Error;

use sixfold::MoveError;
use sixfold::io::{Format, WriteOptions, write_to};
use sixfold::prelude::*;

mod common;

/// The published factors. The second factor is negative: it moves a vertex away from the mean.
const FACTORS: [f32; 2] = [0.33, -0.34];

/// Smooths `mesh` in `steps` steps. Vertices on a boundary do not move.
///
/// # Errors
///
/// Returns [`MoveError`] if the structure identifies vertices by coordinates and two corners of a
/// face would get the same position.
pub fn smooth<M: Representation>(mesh: &mut M, steps: usize) -> Result<(), MoveError> {
    for factor in FACTORS.repeat(steps) {
        let mut moved = mesh.vertex_map(Point::ZERO);
        for v in mesh.vertices() {
            let position = mesh.position(v);
            moved[v] = match mean_of_neighbours(mesh, v) {
                Some(mean) if !mesh.is_boundary_vertex(v) => position.lerp(mean, factor),
                _ => position,
            };
        }
        mesh.set_positions(&moved)?;
    }
    Ok(())
}

fn mean_of_neighbours<M: MeshQuery>(mesh: &M, v: M::Vertex) -> Option<Point> {
    let mut count = 0.0;
    let sum: Point = mesh
        .vertex_vertices(v)
        .inspect(|_| count += 1.0)
        .map(|w| mesh.position(w))
        .sum();
    (count > 0.0).then(|| sum / count)
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::torus(40, 20)?)?;
    let mut mesh = FaceVertexMesh::from_polygons(&polygons)?;
    smooth(&mut mesh, 10)?;
    let out = std::io::stdout().lock();
    write_to(
        &mesh.to_polygons(),
        Format::Obj,
        &WriteOptions::default(),
        out,
    )?;
    Ok(())
}

//! The cotangent Laplacian of a triangle mesh as a sparse matrix of triplets (Pinkall and Polthier
//! 1993).
//!
//! ```sh
//! cargo run --example laplacian -- mesh.obj
//! ```

use std::error::Error;

use sixfold::Numbers;
use sixfold::prelude::*;

mod common;

/// An entry of a sparse matrix: row, column and value. If two entries have the same row and column,
/// their values are added.
pub type Triplet = (u32, u32, f64);

/// A sparse matrix with one row and one column for each vertex.
pub struct Laplacian<M: MeshQuery> {
    /// The row and column of each vertex.
    pub numbers: Numbers<M::Vertex>,
    /// The entries of the matrix.
    pub triplets: Vec<Triplet>,
}

/// Returns the cotangent Laplacian of `mesh`. The entry for vertex i and its neighbour j is
/// (cot α + cot β) / 2. Here α and β are the angles opposite the edge i–j. The entry of vertex i on
/// the diagonal is the negative sum of the other entries in its row.
///
/// # Errors
///
/// Returns the first face that is not a triangle.
pub fn laplacian<M: MeshQuery>(mesh: &M) -> Result<Laplacian<M>, M::Face> {
    let numbers = mesh.vertex_numbers();
    let mut triplets = Vec::with_capacity(12 * mesh.face_count());
    for f in mesh.faces() {
        let corners: Vec<_> = mesh.face_vertices(f).collect();
        let [a, b, c] = corners[..] else {
            return Err(f);
        };
        for [apex, i, j] in [[a, b, c], [b, c, a], [c, a, b]] {
            let weight = cotangent(mesh, apex, i, j) / 2.0;
            let (i, j) = (numbers[i], numbers[j]);
            triplets.extend([
                (i, j, weight),
                (j, i, weight),
                (i, i, -weight),
                (j, j, -weight),
            ]);
        }
    }
    Ok(Laplacian { numbers, triplets })
}

/// Returns the cotangent of the angle at `apex` between the directions to `v` and `w`.
fn cotangent<M: MeshQuery>(mesh: &M, apex: M::Vertex, v: M::Vertex, w: M::Vertex) -> f64 {
    let origin = mesh.position(apex).as_dvec3();
    let [to_v, to_w] = [v, w].map(|end| mesh.position(end).as_dvec3() - origin);
    to_v.dot(to_w) / to_v.cross(to_w).length()
}

/// Returns the product of the matrix and a vector.
pub fn multiply(triplets: &[Triplet], vector: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; vector.len()];
    for &(row, column, value) in triplets {
        product[row as usize] += value * vector[column as usize];
    }
    product
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::geodesic(16)?)?;
    let mesh = HalfEdgeMesh::from_polygons(&polygons)?;
    let Laplacian { numbers, triplets } =
        laplacian(&mesh).map_err(|f| format!("face {f:?} is not a triangle"))?;
    let heights: Vec<f64> = numbers
        .handles()
        .iter()
        .map(|&v| mesh.position(v).z.into())
        .collect();
    let energy: f64 = multiply(&triplets, &heights)
        .iter()
        .zip(&heights)
        .map(|(l, z)| -l * z)
        .sum();
    println!(
        "{} vertices, {} triplets; the Dirichlet energy of z is {:.4}",
        numbers.len(),
        triplets.len(),
        energy / 2.0
    );
    Ok(())
}

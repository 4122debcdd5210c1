//! Regions of nearly equal normals. A region starts at one face. An adjacent face is added if the
//! angle between its normal and the normal of the first face is small.
//!
//! ```sh
//! cargo run --example regions -- mesh.obj
//! ```

use std::error::Error;

use sixfold::operators::face_normals;
use sixfold::prelude::*;

mod common;

/// Returns the region of each face, as a number from 0, and the number of regions. In each region,
/// the angle between the normal of a face and the normal of the first face is at most `degrees`.
pub fn regions<M: MeshQuery>(mesh: &M, degrees: f32) -> (FaceMap<M, Option<usize>>, usize) {
    let normals = face_normals(mesh);
    let least_cosine = degrees.to_radians().cos();
    let mut regions = mesh.face_map(None);
    let mut count = 0;
    for seed in mesh.faces() {
        if regions[seed].is_some() {
            continue;
        }
        regions[seed] = Some(count);
        let mut stack = vec![seed];
        while let Some(face) = stack.pop() {
            for neighbour in mesh.face_faces(face) {
                let is_similar = normals[seed].dot(normals[neighbour]) >= least_cosine;
                if regions[neighbour].is_none() && is_similar {
                    regions[neighbour] = Some(count);
                    stack.push(neighbour);
                }
            }
        }
        count += 1;
    }
    (regions, count)
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::cube())?;
    let mesh = HalfEdgeMesh::from_polygons(&polygons)?;
    let (regions, count) = regions(&mesh, 20.0);
    let mut sizes = vec![0; count];
    for face in mesh.faces() {
        if let Some(region) = regions[face] {
            sizes[region] += 1;
        }
    }
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    println!(
        "{count} regions; the largest have {:?} faces",
        &sizes[..count.min(10)]
    );
    Ok(())
}

//! Catmull–Clark subdivision with creases, one level at a time (Catmull and Clark 1978; DeRose,
//! Kass and Truong 1998).
//!
//! ```sh
//! cargo run --example subdivide_creases > cube.obj
//! ```

use std::error::Error;

use sixfold::io::{Format, WriteOptions, write_to};
use sixfold::prelude::*;
use sixfold::subdivision::{Scheme, Step, Subdivision, renumbered};
use sixfold::{CreaseError, Creases};

mod common;

/// Returns `polygons` after `levels` steps of Catmull–Clark subdivision. Calls `watch` with each
/// level and its creases. The sharpness of a crease decreases by 1 with each level, until the
/// crease is smooth.
///
/// # Errors
///
/// Returns an error if `M` cannot hold the mesh, or if the scheme cannot subdivide the mesh.
pub fn subdivide<M: Representation>(
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
    mut watch: impl FnMut(u32, &Step),
) -> Result<PolygonMesh, Box<dyn Error>> {
    let scheme = Subdivision::new(Scheme::CatmullClark);
    let mut step = Step {
        polygons: polygons.clone(),
        creases: creases.clone(),
    };
    for level in 0..levels {
        let mesh = M::from_polygons(&step.polygons)?;
        let creases = match level {
            0 => scheme.control_creases(&mesh, &step.polygons, &step.creases)?,
            // Structures that identify vertices by coordinates have another order of vertices.
            _ => renumbered(&mesh, &step.polygons, &step.creases),
        };
        step = scheme.gather(&mesh, &creases, level)?;
        watch(level + 1, &step);
    }
    Ok(step.polygons)
}

/// Returns creases of `sharpness` along the edges of face `f`.
///
/// # Errors
///
/// Returns an error if the sharpness is negative or NaN.
pub fn creases_around(
    polygons: &PolygonMesh,
    f: FaceId,
    sharpness: f32,
) -> Result<Creases, CreaseError> {
    let corners: Vec<u32> = polygons.faces().face(f).iter().map(|&v| v.into()).collect();
    let next = corners.iter().cycle().skip(1);
    let edges = corners.iter().zip(next).map(|(&a, &b)| ([a, b], sharpness));
    Creases::new(polygons, edges, [])
}

fn main() -> Result<(), Box<dyn Error>> {
    let polygons = common::mesh_argument(sixfold::shapes::cube())?;
    let creases = creases_around(&polygons, FaceId::new(0), 2.0)?;
    let smooth = subdivide::<HalfEdgeMesh>(&polygons, &creases, 4, |level, step| {
        let faces = step.polygons.face_count();
        let sharp = step.creases.edges().len();
        eprintln!("level {level}: {faces} faces, {sharp} sharp edges");
    })?;
    let out = std::io::stdout().lock();
    write_to(&smooth, Format::Obj, &WriteOptions::default(), out)?;
    Ok(())
}

//! Code that all examples share: reads the mesh to work on.

use std::error::Error;

use sixfold::{PolygonMesh, io};

/// Reads the mesh file that is the first argument of the program, or returns `default`.
pub(crate) fn mesh_argument(default: PolygonMesh) -> Result<PolygonMesh, Box<dyn Error>> {
    let Some(path) = std::env::args().nth(1) else {
        return Ok(default);
    };
    let (polygons, left_out) = io::read(&path)?.into_polygons();
    for face in left_out {
        eprintln!("{path}: {face}");
    }
    Ok(polygons)
}

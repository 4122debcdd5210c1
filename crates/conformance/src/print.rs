//! Formats a mesh as one line, from which the connectivity of the mesh can be rebuilt.

use std::fmt::Write;

use sixfold_core::PolygonMesh;

/// Formats the mesh on one line: `5 vertices, faces [0 1 2] [2 1 3], v4 at v0`.
///
/// Coordinates are left out. Vertices with equal positions are listed.
pub fn one_line(polygons: &PolygonMesh) -> String {
    let mut line = format!("{} vertices, faces", polygons.vertex_count());
    for (_, corners) in polygons.faces().iter() {
        let corners: Vec<String> = corners.iter().map(|v| v.index().to_string()).collect();
        let _ = write!(line, " [{}]", corners.join(" "));
    }
    for v in polygons.vertices() {
        let equal = polygons
            .vertices()
            .find(|&u| polygons.position(u) == polygons.position(v));
        if let Some(equal) = equal.filter(|&equal| equal < v) {
            let _ = write!(line, ", {v} at {equal}");
        }
    }
    line
}

//! Which corners of a mesh become one vertex.

use serde::Serialize;
use sixfold::PolygonMesh;
use sixfold::repair::{Step, Tolerance, Weld, repair};
use sixfold_core::VertexId;

use super::Error;

/// Maximum number of corners that a response lists.
const MOST_CORNERS: usize = 2_000;

/// The corners of a polygon soup, and the vertices that welding makes of them.
#[derive(Serialize)]
pub(super) struct Welded {
    /// The number of corners.
    corners: usize,
    /// The number of vertices that they become.
    vertices: usize,
    /// The number of faces that then have fewer corners, or are lost.
    faces_changed: usize,
    /// The largest distance between a corner and its vertex, in units of the coordinates.
    largest_shift: f64,
    /// The vertex of each of the first corners. Vertices have numbers in the order of their first corners.
    map: Vec<u32>,
}

/// Welds the corners of all faces within a distance, as if each corner were a vertex of its own. O(n log n) for n corners.
pub(super) fn welded(polygons: &PolygonMesh, tolerance: f64) -> Result<Welded, Error> {
    let soup = soup(polygons)?;
    let weld = Weld {
        tolerance: Tolerance::Absolute(tolerance),
        ..Weld::default()
    };
    let repaired = repair(&soup, &[Step::Weld(weld)])?;
    let counts = repaired.steps.first().map(|step| step.counts);
    let counts = counts.unwrap_or_default();
    let shown = soup.vertices().take(MOST_CORNERS);
    let vertex = |corner: VertexId| {
        let vertices = repaired.vertices.new_elements(corner);
        vertices.first().map_or(0, |v| v.index() as u32)
    };
    Ok(Welded {
        corners: soup.vertex_count(),
        vertices: soup.vertex_count() - counts.vertices_merged,
        faces_changed: counts.faces_changed + counts.faces_removed,
        largest_shift: counts.largest_shift,
        map: shown.map(vertex).collect(),
    })
}

/// Returns the mesh with a vertex for each corner.
fn soup(polygons: &PolygonMesh) -> Result<PolygonMesh, Error> {
    let corners = polygons.faces().corners().iter();
    let mut next = 0;
    let faces = polygons.faces().iter().map(|(_, face)| {
        let first = next;
        next += face.len() as u32;
        (first..next).collect::<Vec<u32>>()
    });
    Ok(PolygonMesh::new(
        corners.map(|&corner| polygons.position(corner)),
        faces,
    )?)
}

//! The expected error for a mesh, by brute force.

use std::collections::BTreeMap;

use sixfold_core::{BuildError, Capabilities, FaceId, PolygonMesh, VertexId};

use crate::oracle::sides_of;
use crate::weld::position_key;

/// Computes the expected result of [`Capabilities::check`] for `polygons` with independent code.
///
/// This function does not check whether there are too many elements.
///
/// # Errors
///
/// Returns the first fault, in the order documented at [`BuildError`].
pub fn expected_check(
    capabilities: &Capabilities,
    polygons: &PolygonMesh,
) -> Result<(), BuildError> {
    let fault = None
        .or_else(|| not_a_triangle(polygons).filter(|_| !capabilities.polygons))
        .or_else(|| non_manifold_edge(polygons).filter(|_| !capabilities.non_manifold_edges))
        .or_else(|| repeated_side(polygons).filter(|_| !capabilities.inconsistent_orientation))
        .or_else(|| non_manifold_vertex(polygons).filter(|_| !capabilities.non_manifold_vertices))
        .or_else(|| isolated_vertex(polygons).filter(|_| !capabilities.isolated_vertices))
        .or_else(|| coincident_corners(polygons).filter(|_| !capabilities.coincident_vertices));
    fault.map_or(Ok(()), Err)
}

/// One side of a face: its start, its end, and the face.
type Side = (VertexId, VertexId, FaceId);

/// Returns the sides along each edge, in the order of the faces. The key of an edge is the sorted
/// pair of its ends.
pub(crate) fn sides_by_edge(polygons: &PolygonMesh) -> BTreeMap<[VertexId; 2], Vec<Side>> {
    let mut edges: BTreeMap<[VertexId; 2], Vec<Side>> = BTreeMap::new();
    for (f, corners) in polygons.faces().iter() {
        for (a, b) in sides_of(corners) {
            edges
                .entry([a.min(b), a.max(b)])
                .or_default()
                .push((a, b, f));
        }
    }
    edges
}

fn not_a_triangle(polygons: &PolygonMesh) -> Option<BuildError> {
    let mut faces = polygons.faces().iter();
    let (face, corners) = faces.find(|(_, corners)| corners.len() != 3)?;
    let degree = corners.len();
    Some(BuildError::NotATriangle { face, degree })
}

fn non_manifold_edge(polygons: &PolygonMesh) -> Option<BuildError> {
    let mut edges = sides_by_edge(polygons).into_iter();
    let (vertices, sides) = edges.find(|(_, sides)| sides.len() > 2)?;
    let faces = sides.into_iter().map(|(.., f)| f).collect();
    Some(BuildError::NonManifoldEdge { vertices, faces })
}

fn repeated_side(polygons: &PolygonMesh) -> Option<BuildError> {
    let edges = sides_by_edge(polygons).into_values();
    let mut repeats = edges.flat_map(|sides| {
        let later = (0..sides.len()).find_map(|i| {
            let (from, to, second) = sides[i];
            let earlier = sides[..i].iter().find(|side| side.0 == from)?;
            Some(BuildError::RepeatedSide {
                from,
                to,
                first: earlier.2,
                second,
            })
        });
        later.into_iter()
    });
    repeats.next()
}

fn non_manifold_vertex(polygons: &PolygonMesh) -> Option<BuildError> {
    polygons.vertices().find_map(|vertex| {
        let mut fans = fans_at(polygons, vertex);
        fans.sort();
        let first = *fans.first()?.first()?;
        let second = *fans[1..].iter().flatten().min()?;
        Some(BuildError::NonManifoldVertex {
            vertex,
            first,
            second,
        })
    })
}

pub(crate) fn fans_at(polygons: &PolygonMesh, v: VertexId) -> Vec<Vec<FaceId>> {
    // The faces of each fan, and their corners next to `v`.
    let mut fans: Vec<(Vec<FaceId>, Vec<VertexId>)> = Vec::new();
    for (f, corners) in polygons.faces().iter() {
        let sides = sides_of(corners);
        let spokes = sides.iter().filter(|&&(a, b)| a == v || b == v);
        let ends: Vec<VertexId> = spokes.map(|&(a, b)| if a == v { b } else { a }).collect();
        if ends.is_empty() {
            continue;
        }
        let (mut faces, mut neighbours) = (vec![f], ends);
        fans.retain(|(other_faces, other_ends)| {
            let is_separate = other_ends.iter().all(|end| !neighbours.contains(end));
            if !is_separate {
                faces.extend(other_faces);
                neighbours.extend(other_ends);
            }
            is_separate
        });
        faces.sort();
        fans.push((faces, neighbours));
    }
    fans.into_iter().map(|(faces, _)| faces).collect()
}

fn isolated_vertex(polygons: &PolygonMesh) -> Option<BuildError> {
    let used = polygons.faces().corners();
    let mut isolated = polygons.vertices().filter(|v| !used.contains(v));
    let vertex = isolated.next()?;
    let count = 1 + isolated.count();
    Some(BuildError::IsolatedVertex { vertex, count })
}

fn coincident_corners(polygons: &PolygonMesh) -> Option<BuildError> {
    polygons.faces().iter().find_map(|(face, corners)| {
        let key = |v: &VertexId| position_key(polygons.position(*v));
        (0..corners.len()).find_map(|i| {
            let earlier = corners[..i].iter().find(|v| key(v) == key(&corners[i]));
            let vertices = [*earlier?, corners[i]];
            Some(BuildError::CoincidentCorners { face, vertices })
        })
    })
}

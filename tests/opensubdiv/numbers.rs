//! Maps the vertices and faces of OpenSubdiv to the vertices and faces of Sixfold.

use std::collections::{BTreeMap, BTreeSet};

use sixfold::PolygonMesh;
use sixfold::subdivision::Scheme;

use super::reference::{Level, Origin};

/// For each vertex and face of OpenSubdiv, the number in Sixfold, at one level.
pub(crate) struct NumberMap {
    pub(crate) vertices: Vec<usize>,
    pub(crate) faces: Vec<usize>,
}

impl NumberMap {
    /// Makes the map of the control mesh. Both programs use the same numbers for the control mesh.
    pub(crate) fn identity(polygons: &PolygonMesh) -> Self {
        Self {
            vertices: (0..polygons.vertex_count()).collect(),
            faces: (0..polygons.face_count()).collect(),
        }
    }

    /// Makes the map of the next level from the origins of the vertices. `child` is the mesh of the
    /// next level.
    pub(crate) fn next_level(&self, scheme: Scheme, level: &Level, child: &PolygonMesh) -> Self {
        let (old, faces) = (self.vertices.len(), self.faces.len());
        let first_edge = match scheme {
            Scheme::CatmullClark => old + faces,
            _ => old,
        };
        let edge_points = edge_points(child, old, first_edge);
        let number = |origin: Origin| match origin {
            Origin::Given(v) => panic!("vertex {v} has an origin in the control mesh"),
            Origin::Vertex(v) => self.vertices[v],
            Origin::Edge(ends) => {
                let [a, b] = ends.map(|v| self.vertices[v]);
                edge_points[&sorted_pair([a, b])]
            }
            Origin::Face(f) => old + self.faces[f],
        };
        let vertices = level.vertices.iter().map(|vertex| number(vertex.origin));
        let vertices: Vec<usize> = vertices.collect();
        let distinct: BTreeSet<_> = vertices.iter().collect();
        assert_eq!(distinct.len(), child.vertex_count(), "vertices");
        let mut ours: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        for (f, face) in child.faces().iter() {
            ours.insert(rotate_to_lowest(face.iter().map(|v| v.index())), f.index());
        }
        assert_eq!(ours.len(), level.faces.len(), "faces");
        let faces = level.faces.iter().map(|face| {
            let corners = rotate_to_lowest(face.corners.iter().map(|&v| vertices[v]));
            let found = ours.remove(&corners);
            found.unwrap_or_else(|| panic!("no face {corners:?}"))
        });
        Self {
            faces: faces.collect(),
            vertices,
        }
    }
}

fn rotate_to_lowest(corners: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut corners: Vec<usize> = corners.collect();
    let lowest = (0..corners.len()).min_by_key(|&i| corners[i]);
    corners.rotate_left(lowest.unwrap_or(0));
    corners
}

pub(crate) fn sorted_pair([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the edge points by the two adjacent old vertices. Old vertices have numbers below `old`.
fn edge_points(child: &PolygonMesh, old: usize, first_edge: usize) -> BTreeMap<[usize; 2], usize> {
    let mut ends = vec![Vec::new(); child.vertex_count()];
    for edge in child.edge_uses() {
        let [a, b] = edge.ends.map(|v| v.index());
        if a < old && b >= first_edge {
            ends[b].push(a);
        }
    }
    let points = ends.iter().enumerate().skip(first_edge);
    let by_ends = points.map(|(point, ends)| match ends[..] {
        [a, b] => (sorted_pair([a, b]), point),
        _ => panic!("edge point {point} is adjacent to the old vertices {ends:?}, expected two"),
    });
    by_ends.collect()
}

//! Computes the size of a subdivided mesh in advance.

use sixfold_core::{Counts, PolygonMesh, Split};

use crate::scheme::Scheme;
use crate::subdivision::Subdivision;

/// The size of a mesh: the numbers of its elements, and the other counts that determine the size
/// after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// The numbers of vertices, edges, faces and corners.
    pub counts: Counts,
    /// The number of edges with exactly one face.
    pub boundary_edges: usize,
    /// The number of corners at vertices with boundary edges.
    pub boundary_corners: usize,
    /// The number of vertices without a face.
    pub isolated_vertices: usize,
    /// The number of inner vertices with exactly two faces.
    pub valence_two_vertices: usize,
}

impl Extent {
    /// Returns the size of `polygons`. Takes O(n log n) time for n corners.
    pub fn from_polygons(polygons: &PolygonMesh) -> Self {
        let mut corners = vec![0_usize; polygons.vertex_count()];
        for v in polygons.faces().corners() {
            corners[v.index()] += 1;
        }
        let mut open = vec![false; polygons.vertex_count()];
        let uses = polygons.edge_uses();
        let mut boundary_edges = 0;
        for edge in uses.iter().filter(|edge| edge.is_boundary()) {
            boundary_edges += 1;
            edge.ends.iter().for_each(|v| open[v.index()] = true);
        }
        let vertices = || corners.iter().zip(&open);
        let boundary = vertices().filter(|&(_, &open)| open);
        let valence_two = vertices().filter(|&(&corners, &open)| corners == 2 && !open);
        Self {
            counts: polygons.counts(uses.len()),
            boundary_edges,
            boundary_corners: boundary.map(|(&corners, _)| corners).sum(),
            isolated_vertices: vertices().filter(|&(&corners, _)| corners == 0).count(),
            valence_two_vertices: valence_two.count(),
        }
    }

    /// Returns the extent after a Doo–Sabin step. The formulas are in `doo_sabin.rs`.
    fn vertex_split(&self) -> Self {
        let &Self {
            counts,
            boundary_edges: boundary,
            boundary_corners,
            isolated_vertices: isolated,
            valence_two_vertices: valence_two,
        } = self;
        let inner_edges = counts.edges.saturating_sub(boundary);
        let all_vertices = counts.vertices.saturating_sub(boundary);
        let inner_vertices = all_vertices.saturating_sub(isolated.saturating_add(valence_two));
        let added = |a: usize, b: usize| a.saturating_add(b);
        let corners = added(counts.corners, inner_edges.saturating_mul(4));
        let fans = counts.corners.saturating_sub(boundary_corners);
        Self {
            counts: Counts {
                vertices: counts.corners,
                edges: added(counts.corners, inner_edges.saturating_mul(2))
                    .saturating_sub(valence_two),
                faces: added(added(counts.faces, inner_edges), inner_vertices),
                corners: added(corners, fans.saturating_sub(valence_two.saturating_mul(2))),
                uniform: false,
            },
            boundary_edges: boundary_corners,
            boundary_corners: boundary_corners
                .saturating_mul(3)
                .saturating_sub(boundary.saturating_mul(2)),
            isolated_vertices: 0,
            valence_two_vertices: 0,
        }
    }

    /// Returns the extent after every face is split.
    fn face_split(&self, split: Split) -> Self {
        let boundary = self.boundary_edges;
        // For each boundary edge: its number of parts, and the number of new corners at the
        // boundary.
        let (edges, corners) = match split {
            Split::Quads => (2, 2),
            Split::Triangles => (2, 3),
            Split::Sqrt3 { trisect: false } => (1, 1),
            Split::Sqrt3 { trisect: true } => (3, 5),
        };
        let more = boundary.saturating_mul(corners);
        Self {
            counts: split.refined_counts(&self.counts, boundary),
            boundary_edges: boundary.saturating_mul(edges),
            boundary_corners: self.boundary_corners.saturating_add(more),
            ..*self
        }
    }
}

impl Subdivision {
    /// Returns the size of a mesh after step `level`; `extent` is the size before the step. The
    /// first step has level 0. Takes O(1) time.
    ///
    /// The sizes are exact for manifolds. The sizes include faces that the boundary rule removes
    /// from the result. For Catmull–Clark, Loop, bilinear and midpoint, the numbers of vertices,
    /// edges and faces are also exact if an edge has three or more faces. A size above `usize::MAX`
    /// is reported as `usize::MAX`. After a Doo–Sabin step, the size always states that the degrees
    /// of the faces differ.
    pub fn refined_extent(&self, extent: &Extent, level: u32) -> Extent {
        match self.split(level) {
            Some(split) => extent.face_split(split),
            None => {
                debug_assert_eq!(self.scheme, Scheme::DooSabin, "the only vertex split");
                extent.vertex_split()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sixfold_core::Creases;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::triangle_mesh;
    use crate::{Method, subdivide};

    fn assert_predicted(scheme: Scheme, polygons: &PolygonMesh) {
        let subdivision = Subdivision::new(scheme);
        let mut extent = Extent::from_polygons(polygons);
        for level in 0..2 {
            extent = subdivision.refined_extent(&extent, level);
            let none = Creases::default();
            let levels = level + 1;
            let step =
                subdivide::<IndexedFaceSet>(&subdivision, Method::Gather, polygons, &none, levels);
            let mut got = Extent::from_polygons(&step.expect("a manifold").polygons);
            got.counts.uniform = extent.counts.uniform;
            assert_eq!(got, extent, "{scheme}, level {levels}");
        }
    }

    #[test]
    fn sizes_saturate() {
        let huge = Extent {
            counts: Counts {
                vertices: usize::MAX,
                edges: usize::MAX,
                faces: usize::MAX,
                corners: usize::MAX,
                uniform: true,
            },
            boundary_edges: usize::MAX,
            boundary_corners: usize::MAX,
            isolated_vertices: usize::MAX,
            valence_two_vertices: usize::MAX,
        };
        for scheme in Scheme::ALL {
            let refined = Subdivision::new(scheme).refined_extent(&huge, 1);
            assert_eq!(refined.counts.corners, usize::MAX, "{scheme}");
        }
    }

    proptest! {
        #[test]
        fn polygons_have_the_predicted_extent(mesh in sixfold_conformance::strategy::manifold_mesh()) {
            for scheme in [Scheme::DooSabin, Scheme::CatmullClark] {
                assert_predicted(scheme, &mesh);
            }
        }

        #[test]
        fn triangles_have_the_predicted_extent(mesh in triangle_mesh()) {
            for scheme in [Scheme::Sqrt3, Scheme::Loop, Scheme::Butterfly] {
                assert_predicted(scheme, &mesh);
            }
        }
    }
}

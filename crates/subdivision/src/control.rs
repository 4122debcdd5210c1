//! Creases of the control mesh, and the faces of the control mesh that the boundary rule removes.

use std::cmp::Ordering;

use sixfold_core::{
    Creases, EdgeUse, Pair, PolygonMesh, Representation, SHARPNESS_INFINITE, VertexId,
};

use crate::error::SubdivisionError;
use crate::options::BoundaryRule;
use crate::step::Step;
use crate::subdivision::Subdivision;

impl Subdivision {
    /// Returns the creases of the control mesh `mesh`, which was built from `polygons`. The result
    /// contains `creases`, with the vertex numbers of `mesh.to_polygons()`. In addition, the
    /// following elements get infinite sharpness:
    ///
    /// - Vertices with exactly one face, if the boundary rule is [`BoundaryRule::EdgeAndCorner`].
    /// - Irregular edges: edges with three or more faces, and edges with two faces that run along
    ///   the edge in the same direction. This list does not include boundary edges, because every
    ///   step finds boundary edges itself.
    /// - Vertices whose faces form several fans, and ends of irregular edges. Exception: a vertex
    ///   with exactly two irregular edges, no boundary edge, and more faces than edges moves like a
    ///   vertex on a crease along the two irregular edges.
    ///
    /// Takes O(n log n) expected time for n corners.
    ///
    /// # Errors
    ///
    /// Returns [`SubdivisionError::NoCreases`] if `creases` is not empty and the scheme has no
    /// rules for creases.
    pub fn control_creases<M: Representation>(
        &self,
        mesh: &M,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Result<Creases, SubdivisionError> {
        if !self.scheme.properties().creases {
            return if creases.is_empty() {
                Ok(Creases::default())
            } else {
                Err(SubdivisionError::NoCreases {
                    scheme: self.scheme,
                })
            };
        }
        if M::CAPABILITIES.coincident_vertices {
            return Ok(self.sharpened::<M>(polygons, creases));
        }
        let welded = mesh.to_polygons();
        let creases = renumbered(mesh, polygons, creases);
        Ok(self.sharpened::<M>(&welded, &creases))
    }

    /// Returns the creases of `mesh`, which was built from the result of the steps before `level`: those
    /// of the control mesh before the first step, which has level 0, and the creases of `step` in the
    /// numbers of `mesh` later.
    ///
    /// # Errors
    ///
    /// Fails like [`control_creases`](Self::control_creases).
    pub fn level_creases<M: Representation>(
        &self,
        mesh: &M,
        step: &Step,
        level: u32,
    ) -> Result<Creases, SubdivisionError> {
        match level {
            0 => self.control_creases(mesh, &step.polygons, &step.creases),
            _ => Ok(renumbered(mesh, &step.polygons, &step.creases)),
        }
    }

    /// Returns `creases` with the elements that become sharp because of the topology.
    fn sharpened<M: Representation>(&self, polygons: &PolygonMesh, creases: &Creases) -> Creases {
        let (mut edges, mut corners) = (creases.edges().to_vec(), creases.corners().to_vec());
        let infinite = |v: VertexId| (v, f32::INFINITY);
        let mut around = vec![VertexCounts::default(); polygons.vertex_count()];
        for v in polygons.faces().corners() {
            around[v.index()].faces += 1;
        }
        let capabilities = M::CAPABILITIES;
        if capabilities.non_manifold_vertices
            || capabilities.non_manifold_edges
            || capabilities.inconsistent_orientation
        {
            let uses = polygons.edge_uses();
            for edge in &uses {
                if !edge.is_manifold() {
                    let [a, b] = edge.ends;
                    edges.push((Pair::new(a, b), f32::INFINITY));
                }
                for v in edge.ends {
                    around[v.index()].add(edge);
                }
            }
            let is_on_edge = |v: &VertexId| around[v.index()].non_manifold_edges > 0;
            let several = polygons.vertices_of_several_fans();
            let non_manifold = polygons.vertices().filter(is_on_edge).chain(several);
            let kept = non_manifold.filter(|v| !around[v.index()].is_on_non_manifold_curve());
            corners.extend(kept.map(infinite));
        }
        if self.boundary == BoundaryRule::EdgeAndCorner {
            let alone = polygons.vertices().filter(|v| around[v.index()].faces == 1);
            corners.extend(alone.map(infinite));
        }
        Creases::from_entries(edges, corners)
    }

    /// Returns one value for each face of the control mesh: true if the boundary rule removes the
    /// face from the result. [`BoundaryRule::None`] removes a face if one of its vertices has a
    /// boundary edge that is not infinitely sharp in `creases`. Returns `None` if the boundary rule
    /// is not [`BoundaryRule::None`], or if the scheme has no rules for creases. Takes O(n log n) time
    /// for n corners.
    pub fn left_out(&self, polygons: &PolygonMesh, creases: &Creases) -> Option<Vec<bool>> {
        if self.boundary != BoundaryRule::None || !self.scheme.properties().creases {
            return None;
        }
        let mut open = vec![false; polygons.vertex_count()];
        let uses = polygons.edge_uses();
        for [a, b] in uses
            .iter()
            .filter(|edge| edge.is_boundary())
            .map(|edge| edge.ends)
        {
            if creases.edge(a, b) < SHARPNESS_INFINITE {
                open[a.index()] = true;
                open[b.index()] = true;
            }
        }
        let touches = |face: &[VertexId]| face.iter().any(|v| open[v.index()]);
        Some(
            polygons
                .faces()
                .iter()
                .map(|(_, face)| touches(face))
                .collect(),
        )
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct VertexCounts {
    faces: usize,
    edges: usize,
    boundary_edges: usize,
    /// Edges with three or more faces, or with two faces that run in the same direction.
    non_manifold_edges: usize,
}

impl VertexCounts {
    fn add(&mut self, edge: &EdgeUse) {
        self.edges += 1;
        self.boundary_edges += usize::from(edge.is_boundary());
        self.non_manifold_edges += usize::from(!edge.is_manifold());
    }

    /// Returns whether the faces at this vertex meet along one curve through the vertex.
    fn is_on_non_manifold_curve(&self) -> bool {
        self.non_manifold_edges == 2 && self.boundary_edges == 0 && self.faces > self.edges
    }
}

/// Converts the creases of `polygons` to the numbers of `mesh.to_polygons()`. A structure that
/// identifies a vertex by its coordinates can number the vertices differently from `polygons`. If
/// the structure merges two edges or two vertices, the higher sharpness is used.
pub fn renumbered<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    creases: &Creases,
) -> Creases {
    if M::CAPABILITIES.coincident_vertices || creases.is_empty() {
        return creases.clone();
    }
    let numbers = mesh.vertex_numbers();
    let number = |v: VertexId| VertexId::new(numbers[M::vertex_handle(polygons, v)]);
    let mut edges: Vec<_> = creases.edges().to_vec();
    for (ends, _) in &mut edges {
        let [a, b] = ends.ends().map(number);
        *ends = Pair::new(a, b);
    }
    let mut corners: Vec<_> = creases.corners().to_vec();
    for (v, _) in &mut corners {
        *v = number(*v);
    }
    // `from_entries` uses the last of several entries for one element.
    edges.sort_by(by_sharpness);
    corners.sort_by(by_sharpness);
    Creases::from_entries(edges, corners)
}

/// A function of its own, so that the sort is compiled once for all structures.
fn by_sharpness<E>(a: &(E, f32), b: &(E, f32)) -> Ordering {
    a.1.total_cmp(&b.1)
}

#[cfg(test)]
mod tests {
    use sixfold_core::{FaceId, Point};
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::{Method, Scheme, subdivide};

    /// ```text
    ///   12 ── 13 ── 14 ── 15      nine quads, row by row from below
    ///   │  6  │  7  │  8  │
    ///   8 ─── 9 ─── 10 ── 11
    ///   │  3  │  4  │  5  │
    ///   4 ─── 5 ─── 6 ─── 7
    ///   │  0  │  1  │  2  │
    ///   0 ─── 1 ─── 2 ─── 3
    /// ```
    fn nine_quads() -> PolygonMesh {
        let at = |i: u32| Point::new((i % 4) as f32, (i / 4) as f32, 0.0);
        let quad = |i: u32| [i, i + 1, i + 5, i + 4];
        let points: Vec<Point> = (0..16).map(at).collect();
        let lower = [0, 1, 2, 4, 5, 6, 8, 9, 10];
        PolygonMesh::new(points, lower.map(quad)).expect("nine quads")
    }

    /// Returns the faces that remain with boundary `none`, and the number of faces after a step.
    fn kept_faces(sharp: impl Fn([u32; 2]) -> f32, corner_sharpness: f32) -> (Vec<usize>, usize) {
        let mesh = nine_quads();
        let uses = mesh.edge_uses();
        let boundary = uses.iter().filter(|edge| edge.is_boundary());
        let boundary: Vec<[u32; 2]> = boundary
            .map(|edge| edge.ends.map(|v| v.index() as u32))
            .collect();
        let corners: Vec<_> = boundary
            .iter()
            .map(|&[a, _]| (a, corner_sharpness))
            .collect();
        let edges = boundary.iter().map(|&ends| (ends, sharp(ends)));
        let creases = Creases::new(&mesh, edges, corners).expect("edges of the boundary");
        let scheme = Subdivision {
            boundary: BoundaryRule::None,
            ..Subdivision::new(Scheme::CatmullClark)
        };
        let out = scheme.left_out(&mesh, &creases).expect("boundary none");
        let faces = mesh.faces().iter().map(|(f, _): (FaceId, _)| f.index());
        let kept: Vec<usize> = faces.filter(|&f| !out[f]).collect();
        let step = subdivide::<IndexedFaceSet>(&scheme, Method::Gather, &mesh, &creases, 1);
        (kept, step.expect("quads").polygons.face_count())
    }

    #[test]
    fn faces_at_an_open_boundary_are_left_out() {
        assert_eq!(kept_faces(|_| 0.0, 0.0), (vec![4], 4));
        // Finite sharpness and sharp corners have no effect here.
        assert_eq!(kept_faces(|_| 9.99, f32::INFINITY), (vec![4], 4));
        let all: Vec<usize> = (0..9).collect();
        assert_eq!(kept_faces(|_| 10.0, 0.0), (all, 36));
        // Only the left side is sharp: vertices 4 and 8 have two sharp boundary edges.
        let left = |[a, b]: [u32; 2]| if a % 4 == 0 && b % 4 == 0 { 10.0 } else { 0.0 };
        assert_eq!(kept_faces(left, 0.0), (vec![3, 4], 8));
    }

    #[test]
    fn only_boundary_none_leaves_faces_out() {
        for boundary in [BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly] {
            let scheme = Subdivision {
                boundary,
                ..Subdivision::new(Scheme::CatmullClark)
            };
            assert_eq!(scheme.left_out(&nine_quads(), &Creases::default()), None);
        }
    }

    /// Returns the edges and vertices that are sharp in a mesh without creases.
    fn sharp(
        points: u32,
        faces: &[&[u32]],
        boundary: BoundaryRule,
    ) -> (Vec<[usize; 2]>, Vec<usize>) {
        let points: Vec<Point> = (0..points).map(|i| Point::splat(i as f32)).collect();
        let polygons = PolygonMesh::new(points, faces).expect("faces");
        let mesh = IndexedFaceSet::from_polygons(&polygons).expect("it accepts any mesh");
        let scheme = Subdivision {
            boundary,
            ..Subdivision::new(Scheme::CatmullClark)
        };
        let creases = scheme.control_creases(&mesh, &polygons, &Creases::default());
        let creases = creases.expect("creases");
        let edges = creases.edges().iter();
        let edges = edges.map(|(ends, _)| ends.ends().map(|v| v.index()));
        let corners = creases.corners().iter().map(|(v, _)| v.index());
        (edges.collect(), corners.collect())
    }

    #[test]
    fn vertices_of_one_face_are_corners_with_edge_and_corner_only() {
        let two: [&[u32]; 2] = [&[0, 1, 2], &[2, 1, 3]];
        assert_eq!(
            sharp(4, &two, BoundaryRule::EdgeAndCorner),
            (vec![], vec![0, 3])
        );
        assert_eq!(sharp(4, &two, BoundaryRule::EdgeOnly), (vec![], vec![]));
    }

    #[test]
    fn non_manifold_edges_and_vertices_are_sharp() {
        // Both faces run from 1 to 2.
        let same_way: [&[u32]; 2] = [&[0, 1, 2, 3], &[1, 2, 5, 4]];
        let expected = (vec![[1, 2]], vec![1, 2]);
        assert_eq!(sharp(6, &same_way, BoundaryRule::EdgeOnly), expected);
        // There are two fans at vertex 0.
        let bow_tie: [&[u32]; 2] = [&[0, 1, 2], &[0, 3, 4]];
        assert_eq!(
            sharp(5, &bow_tie, BoundaryRule::EdgeOnly),
            (vec![], vec![0])
        );
        // Three pages meet along vertices 0, 1 and 2. Vertex 1 is not a corner.
        let book: [&[u32]; 6] = [
            &[0, 3, 4, 1],
            &[1, 4, 5, 2],
            &[1, 7, 6, 0],
            &[2, 8, 7, 1],
            &[0, 9, 10, 1],
            &[1, 10, 11, 2],
        ];
        let spine = vec![[0, 1], [1, 2]];
        assert_eq!(
            sharp(12, &book, BoundaryRule::EdgeOnly),
            (spine.clone(), vec![0, 2])
        );
        // Without the last page, vertex 1 has a boundary edge and is a corner. Edge 1–2 has only
        // two faces.
        assert_eq!(
            sharp(12, &book[..5], BoundaryRule::EdgeOnly),
            (vec![[0, 1]], vec![0, 1])
        );
    }
}

//! √3: splits every triangle into three. The scheme is approximating, and the limit surface is C²
//! except at extraordinary vertices.
//!
//! The scheme is that of Kobbelt (2000). A step adds a face point in each triangle, then flips
//! every old inner edge. So a step triples the number of faces. Two steps cut each old edge in
//! three and each triangle in nine.
//!
//! ```text
//!    c ─────── d        c ─────── d        face point     the mean of the corners
//!    │╲   g    │        │╲  ╱──g ╱│
//!    │  ╲      │        │ ╲╱  ╱╱  │        vertex point   1 − α  the vertex
//!    │    ╲    │   →    │ f╱─╱╲   │                       α/n    each of n neighbours
//!    │   f  ╲  │        │╱╱    ╲  │
//!    a ─────── b        a ─────── b        α = (4 − 2 cos(2π/n))/9
//! ```
//!
//! Boundary edges are not flipped. The odd steps (1, 3, …) leave boundary edges and vertices
//! unchanged. The even steps (2, 4, …) cut boundary edges in three, by the mask of a cubic B-spline
//! curve:
//!
//! ```text
//!    p₀ ──── p₁ ──── p₂           p₁ ↦ (4 p₀ + 19 p₁ + 4 p₂)/27
//!        •  •  •  •               before it (10 p₀ + 16 p₁ + p₂)/27, after it (p₀ + 16 p₁ + 10 p₂)/27
//! ```
//!
//! A boundary vertex with more than two boundary edges does not move, and the new points next to
//! this vertex lie at a third of their edges. An isolated vertex does not move.

use std::f64::consts::TAU;

use sixfold_core::{Creases, FaceList, MAX_ROWS, MeshQuery, Point, PolygonError, PolygonMesh};
use sixfold_core::{Refine, Split, VertexId};

use crate::connectivity::Connectivity;
use crate::error::SubdivisionError;
use crate::gather::{corner_sum, neighbour_sum};
use crate::manifold;
use crate::native::compute_rows;
use crate::scheme::Scheme;
use crate::step::Step;

/// Number of valences with precomputed α.
const PRECOMPUTED: usize = 16;

/// The weights of Kobbelt (2000).
struct Sqrt3 {
    alphas: [f32; PRECOMPUTED],
}

/// Returns α, the total weight of all `valence` neighbours.
fn alpha(valence: usize) -> f64 {
    (4.0 - 2.0 * (TAU / valence as f64).cos()) / 9.0
}

impl Sqrt3 {
    fn new() -> Self {
        Self {
            alphas: std::array::from_fn(|n| alpha(n.max(1)) as f32),
        }
    }

    /// Returns the new position of an inner vertex from the sum of its neighbours.
    #[inline(always)]
    fn vertex(&self, at: Point, neighbours: Point, valence: usize) -> Point {
        let alpha = match self.alphas.get(valence) {
            _ if valence == 0 => return at,
            Some(&alpha) => alpha,
            None => alpha(valence) as f32,
        };
        at * (1.0 - alpha) + neighbours * (alpha / valence as f32)
    }
}

/// Returns the face point of a triangle from the sum of its corners.
#[inline(always)]
fn face_point(corners: Point) -> Point {
    corners * (1.0 / 3.0)
}

/// Runs one step with queries for each new point.
pub(crate) fn gather<M: MeshQuery>(mesh: &M, trisect: bool) -> Result<Step, SubdivisionError> {
    let connectivity = Connectivity::gathered(mesh, Scheme::Sqrt3)?;
    let scheme = Sqrt3::new();
    let old: Vec<Point> = mesh.vertices().map(|v| mesh.position(v)).collect();
    let mut points = Vec::with_capacity(old.len() + mesh.face_count());
    points.extend(mesh.vertices().map(|v| {
        let (sum, valence) = neighbour_sum(mesh, v);
        scheme.vertex(mesh.position(v), sum, valence)
    }));
    points.extend(mesh.faces().map(|f| face_point(corner_sum(mesh, f).0)));
    finish(&connectivity, &old, points, trisect)
}

/// Runs one step with one pass over the faces.
pub(crate) fn scatter<M: MeshQuery>(mesh: &M, trisect: bool) -> Result<Step, SubdivisionError> {
    let connectivity = Connectivity::scattered(mesh, Scheme::Sqrt3)?;
    let scheme = Sqrt3::new();
    let old: Vec<Point> = mesh.vertices().map(|v| mesh.position(v)).collect();
    let mut sums = vec![(Point::ZERO, 0); old.len()];
    for edge in connectivity.edges() {
        let [a, b] = connectivity.ends(edge.first).map(|v| v as usize);
        for (v, far) in [(a, b), (b, a)] {
            sums[v].0 += old[far];
            sums[v].1 += 1;
        }
    }
    let mut points = Vec::with_capacity(old.len() + mesh.face_count());
    let vertices = old.iter().zip(sums);
    points.extend(vertices.map(|(&at, (sum, valence))| scheme.vertex(at, sum, valence)));
    let faces = connectivity.corners.as_chunks::<3>().0.iter();
    points.extend(faces.map(|face| face_point(face.iter().map(|&v| old[v as usize]).sum())));
    finish(&connectivity, &old, points, trisect)
}

/// Runs one step in the tables of the structure.
pub(crate) fn native<M: Refine>(
    mesh: &M,
    numbers: &M::EdgeNumbers,
    trisect: bool,
    child: &mut M,
) -> Result<Creases, SubdivisionError> {
    let boundary = BoundaryCurves::new(manifold::boundary_edges(mesh, numbers, Scheme::Sqrt3)?);
    mesh.split_into(Split::Sqrt3 { trisect }, numbers, child)?;
    let scheme = Sqrt3::new();
    let (vertices, points) = child.positions_mut().split_at_mut(mesh.vertex_count());
    let (faces, cuts) = points.split_at_mut(mesh.face_count());
    compute_rows(faces, |f| face_point(corner_sum(mesh, f).0));
    compute_rows(vertices, |v| {
        let (sum, valence) = neighbour_sum(mesh, v);
        scheme.vertex(mesh.position(v), sum, valence)
    });
    boundary.place(trisect, mesh.position_rows(), vertices, cuts);
    Ok(Creases::default())
}

fn finish(
    connectivity: &Connectivity,
    old: &[Point],
    mut points: Vec<Point>,
    trisect: bool,
) -> Result<Step, SubdivisionError> {
    let open = || {
        connectivity
            .edges()
            .iter()
            .filter(|edge| edge.second.is_none())
    };
    let boundary = BoundaryCurves::new(open().map(|edge| connectivity.ends(edge.first)).collect());
    let cut = if trisect { boundary.sides.len() } else { 0 };
    let size = 3 * connectivity.corners.len() + 6 * cut;
    if size > MAX_ROWS {
        let (elements, limit) = ("corners", MAX_ROWS);
        return Err(PolygonError::TooMany { elements, limit }.into());
    }
    let first_cut = points.len() as u32;
    points.resize(points.len() + 2 * cut, Point::ZERO);
    let (vertices, rest) = points.split_at_mut(old.len());
    let (_, cuts) = rest.split_at_mut(connectivity.corners.len() / 3);
    boundary.place(trisect, old, vertices, cuts);
    // For each boundary side: the first of its two points.
    let mut cut_of = vec![
        0;
        if trisect {
            connectivity.corners.len()
        } else {
            0
        }
    ];
    if trisect {
        for (rank, edge) in (0..).zip(open()) {
            cut_of[edge.first as usize] = first_cut + 2 * rank;
        }
    }
    let mut corners = Vec::with_capacity(size);
    for side in 0..connectivity.corners.len() as u32 {
        let face = |side: u32| old.len() as u32 + side / 3;
        let ([a, b], centre) = (connectivity.ends(side), face(side));
        match connectivity.twin(side) {
            Some(other) => corners.extend([a, face(other), centre]),
            None if trisect => {
                let near = cut_of[side as usize];
                let cuts = [[a, near], [near, near + 1], [near + 1, b]];
                corners.extend(cuts.iter().flat_map(|&[from, to]| [from, to, centre]));
            }
            None => corners.extend([a, b, centre]),
        }
    }
    let corners = corners.into_iter().map(VertexId::new).collect();
    let polygons = PolygonMesh::from_faces(points, FaceList::uniform(3, corners)?)?;
    let creases = Creases::default();
    Ok(Step { polygons, creases })
}

/// The boundary curves of a mesh.
struct BoundaryCurves {
    /// The boundary edges, each in the direction of its face.
    sides: Vec<[u32; 2]>,
    /// The boundary edges in both directions, sorted.
    spokes: Vec<[u32; 2]>,
}

impl BoundaryCurves {
    fn new(sides: Vec<[u32; 2]>) -> Self {
        let both = sides.iter().flat_map(|&[a, b]| [[a, b], [b, a]]);
        let mut spokes: Vec<[u32; 2]> = both.collect();
        spokes.sort_unstable();
        Self { sides, spokes }
    }

    /// Places the boundary vertices. If `trisect` is true, also places the two points of each
    /// boundary edge. O(b log b) for b boundary edges.
    fn place(&self, trisect: bool, old: &[Point], vertices: &mut [Point], cuts: &mut [Point]) {
        let at = |v: u32| old[v as usize];
        for around in self.spokes.chunk_by(|a, b| a[0] == b[0]) {
            let v = around[0][0];
            vertices[v as usize] = match around {
                &[[_, one], [_, other]] if trisect => {
                    (at(v) * 19.0 + (at(one) + at(other)) * 4.0) * (1.0 / 27.0)
                }
                _ => at(v),
            };
        }
        for (&[a, b], cuts) in self.sides.iter().zip(cuts.as_chunks_mut().0) {
            *cuts = [self.third_point(a, b, at), self.third_point(b, a, at)];
        }
    }

    /// Returns the point at a third of the edge from `near` to `far`.
    fn third_point(&self, near: u32, far: u32, at: impl Fn(u32) -> Point) -> Point {
        let first = self.spokes.partition_point(|spoke| spoke[0] < near);
        let around = self.spokes[first..].iter();
        let mut others = around
            .take_while(|spoke| spoke[0] == near)
            .map(|spoke| spoke[1])
            .filter(|&other| other != far);
        match (others.next(), others.next()) {
            (Some(before), None) => (at(before) + at(near) * 16.0 + at(far) * 10.0) * (1.0 / 27.0),
            _ => (at(near) * 2.0 + at(far)) * (1.0 / 3.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::{
        all_methods, assert_affine, assert_equivalent, assert_near, assert_same_on_threads, build,
        triangle_mesh,
    };
    use crate::{Method, Subdivision, subdivide};

    fn steps(polygons: &PolygonMesh, levels: u32) -> PolygonMesh {
        let scheme = Subdivision::new(Scheme::Sqrt3);
        let none = Creases::default();
        let done = subdivide::<IndexedFaceSet>(&scheme, Method::Gather, polygons, &none, levels);
        done.expect("triangles").polygons
    }

    #[test]
    fn the_weights_match_the_paper() {
        for (valence, expected) in [(3, 5.0 / 9.0), (4, 4.0 / 9.0), (6, 1.0 / 3.0)] {
            assert!((alpha(valence) - expected).abs() < 1e-15, "{valence}");
        }
        let far = Sqrt3::new().vertex(Point::ZERO, Point::X * 100.0, 100);
        assert!((f64::from(far.x) - alpha(100)).abs() < 1e-6);
    }

    #[test]
    fn a_tetrahedron_matches_the_paper() {
        let tetrahedron = sixfold_shapes::tetrahedron();
        for mesh in all_methods(Scheme::Sqrt3, &tetrahedron, 0).expect("triangles") {
            assert_eq!([mesh.vertex_count(), mesh.face_count()], [8, 12]);
            let centre = tetrahedron.positions().iter().sum::<Point>() * 0.25;
            for (v, &old) in tetrahedron.positions().iter().enumerate() {
                let expected = centre + (old - centre) * (7.0 / 27.0);
                assert_near(mesh.positions()[v], expected);
            }
            for (f, face) in tetrahedron.faces().iter() {
                let sum: Point = face.iter().map(|&v| tetrahedron.position(v)).sum();
                assert_near(mesh.positions()[4 + f.index()], sum / 3.0);
            }
        }
    }

    #[test]
    fn the_boundary_of_a_triangle_is_cut_in_the_second_step() {
        let corners = [Point::ZERO, Point::X * 27.0, Point::Y * 27.0];
        let triangle = PolygonMesh::new(corners, [[0, 1, 2]]).expect("a triangle");
        let first = steps(&triangle, 1);
        assert_eq!(first.positions()[..3], corners);
        assert_eq!([first.vertex_count(), first.face_count()], [4, 3]);
        let second = steps(&triangle, 2);
        assert_eq!([second.vertex_count(), second.face_count()], [13, 15]);
        let at = |x: f32, y: f32| Point::new(x, y, 0.0);
        let vertices = [at(4.0, 4.0), at(19.0, 4.0), at(4.0, 19.0)];
        for (&got, expected) in second.positions().iter().zip(vertices) {
            assert_near(got, expected);
        }
        let cuts = &second.positions()[7..];
        for expected in [at(10.0, 1.0), at(16.0, 1.0), at(16.0, 10.0), at(1.0, 16.0)] {
            assert!(
                cuts.iter().any(|p| p.distance(expected) < 1e-5),
                "{expected}"
            );
        }
        for mesh in all_methods(Scheme::Sqrt3, &triangle, 1).expect("a triangle") {
            assert_eq!(mesh.face_count(), 9);
        }
    }

    #[test]
    fn edges_at_a_crossing_of_boundaries_are_cut_in_thirds() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| Point::new(x, x * x, 0.0));
        let bow_tie = PolygonMesh::new(corners, [[0, 1, 2], [0, 3, 4]]).expect("two triangles");
        let mesh: IndexedFaceSet = build(&bow_tie);
        let step = gather(&mesh, true).expect("edges of one face");
        assert_eq!(step.polygons.positions()[0], corners[0]);
        let third = |p: &Point| p.distance(corners[0].lerp(corners[1], 1.0 / 3.0)) < 1e-6;
        assert!(step.polygons.positions().iter().any(third));
        assert_near(
            step.polygons.positions()[1],
            (corners[1] * 19.0 + (corners[0] + corners[2]) * 4.0) / 27.0,
        );
    }

    #[test]
    fn two_steps_cut_every_edge_in_three() {
        let torus = sixfold_shapes::triangle_torus(4, 5).expect("a small torus");
        let twice = steps(&torus, 2);
        let (vertices, faces) = (torus.vertex_count(), torus.face_count());
        let mut near = BTreeMap::new();
        let mut side = vertices + faces;
        for (_, face) in torus.faces().iter() {
            for (i, a) in face.iter().enumerate() {
                near.insert([a.index(), face[(i + 1) % 3].index()], side);
                side += 1;
            }
        }
        let mut expected = Vec::new();
        for (f, face) in torus.faces().iter() {
            let [a, b, c] = [0, 1, 2].map(|i: usize| face[i].index());
            let m = vertices + f.index();
            let cut = |from: usize, to: usize| [near[&[from, to]], near[&[to, from]]];
            let [[ab1, ab2], [bc1, bc2], [ca1, ca2]] = [cut(a, b), cut(b, c), cut(c, a)];
            expected.extend([[a, ab1, ca2], [b, bc1, ab2], [c, ca1, bc2]]);
            expected.extend([[ab1, ab2, m], [bc1, bc2, m], [ca1, ca2, m]]);
            expected.extend([[ab2, bc1, m], [bc2, ca1, m], [ca2, ab1, m]]);
        }
        let faces = expected.iter().map(|face| face.map(|v| v as u32));
        let expected = PolygonMesh::new(twice.positions().iter().copied(), faces);
        let expected = expected.expect("the vertices of the torus");
        assert_equivalent(&expected, &twice, twice.vertex_count());
    }

    #[test]
    fn non_manifold_edges_return_errors() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat);
        let error_of = |faces: &[[u32; 3]]| {
            let mesh: IndexedFaceSet = build(&PolygonMesh::new(corners, faces).expect("valid"));
            let none = Creases::default();
            let scheme = Subdivision::new(Scheme::Sqrt3);
            let errors = [
                scheme.gather(&mesh, &none, 0).expect_err("no rule"),
                scheme.scatter(&mesh, &none, 0).expect_err("no rule"),
            ];
            assert_eq!(errors[0], errors[1]);
            errors[0].clone()
        };
        let error = |a, b, faces| SubdivisionError::NonManifoldEdge {
            scheme: Scheme::Sqrt3,
            ends: [a, b].map(VertexId::new),
            faces,
        };
        assert_eq!(error_of(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]), error(0, 1, 3));
        assert_eq!(error_of(&[[0, 1, 2], [0, 1, 3]]), error(0, 1, 2));
    }

    #[test]
    fn the_result_does_not_depend_on_threads() {
        assert_same_on_threads(Scheme::Sqrt3, 0);
        assert_same_on_threads(Scheme::Sqrt3, 1);
    }

    proptest! {
        #[test]
        fn all_methods_agree(mesh in triangle_mesh(), level in 0..2_u32) {
            let known = mesh.vertex_count() + mesh.face_count();
            let meshes = all_methods(Scheme::Sqrt3, &mesh, level).expect("a manifold");
            for other in &meshes[1..] {
                assert_equivalent(&meshes[0], other, known);
            }
        }

        #[test]
        fn affine_maps_commute(mesh in triangle_mesh(), level in 0..2_u32) {
            assert_affine(Scheme::Sqrt3, &mesh, level);
        }
    }
}

//! Modified butterfly: splits every triangle into four. The scheme is interpolating (old vertices
//! do not move), and the limit surface is C¹.
//!
//! The scheme is that of Zorin, Schröder & Sweldens (1996). For an edge between two regular
//! vertices, the stencil is that of Dyn, Levin & Gregory (1990) with the parameter w = 0. A vertex
//! is regular if it is an inner vertex with six triangles, or a boundary vertex with three
//! triangles.
//!
//! ```text
//!   both ends regular                    one end extraordinary, valence K: around this end v
//!
//!     −1/16 ── 1/8 ── −1/16                  s₂ ── s₁        v    3/4
//!         ╲    ╱ ╲    ╱                      ╱ ╲  ╱ ╲        sⱼ   (1/4 + cos(2πj/K) + cos(4πj/K)/2)/K
//!          ╲  ╱   ╲  ╱                      s₃ ─ v ─•─ s₀    K=3  5/12, −1/12, −1/12
//!          1/2 ─•─ 1/2                       ╲ ╱  ╲ ╱        K=4  3/8, 0, −1/8, 0
//!          ╱  ╲   ╱  ╲                       s₄ ── s₅
//!         ╱    ╲ ╱    ╲
//!     −1/16 ── 1/8 ── −1/16              both extraordinary: the mean of the two points
//! ```
//!
//! At boundaries:
//!
//! - The point of a boundary edge depends only on four consecutive boundary vertices. The weights
//!   of the four vertices are (−1/16, 9/16, 9/16, −1/16) (Dyn, Gregory & Levin 1987). If two meshes
//!   have the same boundary, their refined meshes also have the same boundary.
//! - If a corner of the regular stencil lies beyond a boundary edge, a *ghost point* replaces the
//!   corner. The ghost point is a + b − c, where a and b are the ends of the boundary edge and c is
//!   the third vertex of the triangle at the boundary edge (Zorin, Schröder & Sweldens 1996):
//!
//! ```text
//!        a ───── b      a boundary edge, c inside:  ghost = a + b − c
//!         ╲     ╱
//!          ╲   ╱
//!            c
//! ```
//!
//! - At an extraordinary boundary vertex (with k ≠ 3 triangles), the masks are those of Zorin &
//!   Schröder (2000); see [`boundary_weights`].
//! - Zorin, Schröder & Sweldens (1996) give no mask for an inner vertex of valence 2. In Sixfold,
//!   the new points on the two edges of an inner vertex of valence 2 are the midpoints of these
//!   edges.

use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

use rustc_hash::FxHashMap;
use sixfold_core::glam::DVec3;
use sixfold_core::{Creases, Handle, MeshQuery, Point, Refine, Split, map_chunks};

use crate::connectivity::vertex_numbers;
use crate::error::SubdivisionError;
use crate::manifold;
use crate::mask::midpoint;
use crate::native::{compute_rows, copy_rows};
use crate::scheme::Scheme;
use crate::step::{Step, StepBuilder};

/// Number of valences with precomputed weights.
const PRECOMPUTED: usize = 16;

/// The largest valence of a vertex whose ring is summed again for each of its edges.
const SUMMED_AGAIN: usize = 64;

struct Butterfly<V> {
    rings: [Vec<f32>; PRECOMPUTED],
    /// The extraordinary vertices with more neighbours than [`SUMMED_AGAIN`].
    hubs: FxHashMap<V, Hub<V>>,
}

/// Runs one step with queries for each new point.
pub(crate) fn gather<M: MeshQuery>(mesh: &M) -> Result<Step, SubdivisionError> {
    manifold::check(mesh, Scheme::Butterfly)?;
    let mut builder = StepBuilder::new(Split::Triangles, mesh, 3 * mesh.face_count());
    let numbers = vertex_numbers(mesh);
    let mut regular = mesh.vertex_map(false);
    mesh.vertices().for_each(|v| {
        regular[v] = is_regular(mesh, v);
        builder.points.push(mesh.position(v));
    });
    let scheme = Butterfly::new(mesh, |v| regular[v]);
    let mut edge_points = mesh.edge_map(0_u32);
    mesh.edges().for_each(|e| {
        edge_points[e] = builder.points.len() as u32;
        let point = scheme.edge(mesh, e, |v| regular[v]);
        builder.points.push(point);
    });
    builder.split_faces(mesh, |v| numbers[v], |e| edge_points[e])?;
    builder.finish(Creases::default())
}

/// Runs one step in the tables of the structure.
pub(crate) fn native<M: Refine>(
    mesh: &M,
    numbers: &M::EdgeNumbers,
    child: &mut M,
) -> Result<Creases, SubdivisionError> {
    if !manifold::is_always_manifold::<M>() {
        manifold::check(mesh, Scheme::Butterfly)?;
    }
    mesh.split_into(Split::Triangles, numbers, child)?;
    let mut regular = vec![false; mesh.vertex_count()];
    compute_rows(&mut regular, |v| is_regular(mesh, v));
    let scheme = Butterfly::new(mesh, |v: M::Vertex| regular[v.index()]);
    let (vertices, points) = child.positions_mut().split_at_mut(mesh.vertex_count());
    copy_rows(vertices, mesh.position_rows());
    map_chunks(points, &mesh.edge_chunks(numbers), |chunk, _, points| {
        let mut points = points.iter_mut();
        mesh.edges_of_chunk(numbers, chunk).for_each(|e| {
            if let Some(point) = points.next() {
                *point = scheme.edge(mesh, e, |v| regular[v.index()]);
            }
        });
    });
    Ok(Creases::default())
}

/// Returns whether a vertex has six triangles around it, or three triangles at a boundary.
fn is_regular<M: MeshQuery>(mesh: &M, v: M::Vertex) -> bool {
    let sizes = (
        mesh.vertex_vertices(v).count(),
        mesh.vertex_faces(v).count(),
    );
    matches!(sizes, (6, 6) | (4, 3))
}

impl<V: Handle> Butterfly<V> {
    /// Collects the weights, and the sums of vertices with many neighbours. O(corners), plus the cost of
    /// the rings.
    fn new<M: MeshQuery<Vertex = V>>(mesh: &M, is_regular: impl Fn(V) -> bool) -> Self {
        let has_many =
            |&v: &V| !is_regular(v) && mesh.vertex_vertices(v).nth(SUMMED_AGAIN).is_some();
        let hubs = mesh.vertices().filter(has_many);
        Self {
            rings: std::array::from_fn(ring_weights),
            hubs: hubs.map(|v| (v, Hub::new(mesh, v))).collect(),
        }
    }

    /// Returns the point of edge `e`.
    fn edge<M: MeshQuery<Vertex = V>>(
        &self,
        mesh: &M,
        e: M::Edge,
        is_regular: impl Fn(V) -> bool,
    ) -> Point {
        let [a, b] = mesh.edge_vertices(e);
        let (mut first, mut second) = (None, None);
        mesh.edge_faces(e)
            .for_each(|f| second = first.replace(f).or(second));
        let (Some(first), Some(second)) = (first, second) else {
            return boundary_point(mesh, [a, b]);
        };
        match [a, b].map(is_regular) {
            [true, true] => regular_point(mesh, e, [first, second]),
            [false, true] => self.extraordinary_point(mesh, a, b),
            [true, false] => self.extraordinary_point(mesh, b, a),
            [false, false] => midpoint([
                self.extraordinary_point(mesh, a, b),
                self.extraordinary_point(mesh, b, a),
            ]),
        }
    }

    /// Returns the point of the inner edge from `v` to `to`, computed from the neighbours of `v`.
    /// O(valence) plus the cost of the ring; O(log valence) for a vertex with many neighbours.
    fn extraordinary_point<M: MeshQuery<Vertex = V>>(&self, mesh: &M, v: V, to: V) -> Point {
        if let Some(point) = self.hubs.get(&v).and_then(|hub| hub.point(to)) {
            return point;
        }
        let ring = ring(mesh, v);
        let start = ring.iter().position(|&w| w == to).unwrap_or(0);
        let at = mesh.position(v);
        let is_open = mesh.vertex_faces(v).count() < ring.len();
        let (weights, start) = match (is_open, self.rings.get(ring.len())) {
            (true, _) => (Cow::Owned(boundary_weights(ring.len() - 1, start)), 0),
            (false, Some(weights)) => (Cow::Borrowed(weights), start),
            (false, None) => (Cow::Owned(ring_weights(ring.len())), start),
        };
        let rotated = ring[start..].iter().chain(&ring[..start]);
        // A sum of differences gives `v` the remaining weight. Equal positions stay exactly equal.
        rotated.zip(&*weights).fold(at, |point, (&w, &weight)| {
            point + (mesh.position(w) - at) * weight
        })
    }
}

/// A vertex with many neighbours: the sums over its ring from which the points of all its edges follow.
///
/// The weight of neighbour `j` in the point of edge `i` is a sum of products of a function of `i` and a
/// function of `j`, because of cos(x − y) = cos x cos y + sin x sin y. The sums of the offsets dⱼ of the
/// neighbours, each multiplied by a function of `j`, are the same for all edges. With θ = 2π/K for K
/// neighbours around `v`, and θ = π/k for k triangles at a boundary:
///
/// ```text
///   around v       Kp = Σ dⱼ/4 + cos iθ Σ dⱼ cos jθ + sin iθ Σ dⱼ sin jθ
///                     + (cos 2iθ Σ dⱼ cos 2jθ + sin 2iθ Σ dⱼ sin 2jθ)/2
///   at a boundary  kp = sin iθ Σ dⱼ sin jθ + (sin 2iθ Σ dⱼ sin 2jθ)/2 + k (d₀ − dₖ) w
/// ```
struct Hub<V> {
    at: Point,
    /// The neighbours, sorted, with their places in the ring.
    places: Vec<(V, usize)>,
    is_open: bool,
    /// Σ dⱼ, Σ dⱼ cos jθ, Σ dⱼ sin jθ, Σ dⱼ cos 2jθ and Σ dⱼ sin 2jθ. At a boundary, without the first
    /// and the last neighbour.
    sums: [DVec3; 5],
    /// At a boundary, d₀ − dₖ.
    across: DVec3,
}

impl<V: Handle> Hub<V> {
    fn new<M: MeshQuery<Vertex = V>>(mesh: &M, v: V) -> Self {
        let mut ring = ring(mesh, v);
        let at = mesh.position(v);
        let is_open = mesh.vertex_faces(v).count() < ring.len();
        if !is_open {
            // Rounding is then the same on every structure.
            let bits = |&i: &usize| {
                (mesh.position(ring[i]) + Point::ZERO)
                    .to_array()
                    .map(f32::to_bits)
            };
            let first = (0..ring.len()).min_by_key(bits).unwrap_or(0);
            ring.rotate_left(first);
        }
        let offset = |w: V| mesh.position(w).as_dvec3() - at.as_dvec3();
        let last = ring.len() - 1;
        let mut sums = [DVec3::ZERO; 5];
        let inner = if is_open { 1..last } else { 0..ring.len() };
        for (j, waves) in inner.map(|j| (j, waves(j, ring.len(), is_open))) {
            let offset = offset(ring[j]);
            for (sum, wave) in sums.iter_mut().zip(waves) {
                *sum += offset * wave;
            }
        }
        let across = offset(ring[0]) - offset(ring[last]);
        let mut places: Vec<(V, usize)> = ring.into_iter().zip(0..).collect();
        places.sort_unstable();
        Self {
            at,
            places,
            is_open,
            sums,
            across,
        }
    }

    /// Returns the point of the inner edge to the neighbour `to`. O(log n) for n neighbours.
    fn point(&self, to: V) -> Option<Point> {
        let place = self.places.binary_search_by_key(&to, |&(w, _)| w).ok()?;
        let i = self.places[place].1;
        let n = self.places.len();
        let own = waves(i, n, self.is_open);
        let factors = match self.is_open {
            false => [0.25, own[1], own[2], 0.5 * own[3], 0.5 * own[4]],
            true => [0.0, 0.0, own[2], 0.0, 0.5 * own[4]],
        };
        let terms = self
            .sums
            .iter()
            .zip(factors)
            .map(|(&sum, factor)| sum * factor);
        let offset = match self.is_open {
            false => terms.sum::<DVec3>() / n as f64,
            true => {
                let end = boundary_end(n - 1, i as f64);
                terms.sum::<DVec3>() / (n - 1) as f64 + self.across * end
            }
        };
        Some((self.at.as_dvec3() + offset).as_vec3())
    }
}

/// Returns 1, cos jθ, sin jθ, cos 2jθ and sin 2jθ of a ring of `n` neighbours.
fn waves(j: usize, n: usize, is_open: bool) -> [f64; 5] {
    let theta = match is_open {
        false => TAU / n as f64,
        true => PI / (n - 1) as f64,
    };
    let (sin, cos) = (j as f64 * theta).sin_cos();
    let (sin2, cos2) = (2.0 * j as f64 * theta).sin_cos();
    [1.0, cos, sin, cos2, sin2]
}

/// Returns the neighbours of a vertex with one fan, in order.
fn ring<M: MeshQuery>(mesh: &M, v: M::Vertex) -> Vec<M::Vertex> {
    let ring = mesh.one_ring(v);
    ring.expect("checked to be one fan").collect()
}

fn regular_point<M: MeshQuery>(mesh: &M, e: M::Edge, faces: [M::Face; 2]) -> Point {
    let ends = mesh.edge_vertices(e).map(|v| mesh.position(v));
    let (mut sides, mut wings) = (Point::ZERO, Point::ZERO);
    for f in faces {
        let corners: Point = mesh.face_vertices(f).map(|v| mesh.position(v)).sum();
        sides += corners - (ends[0] + ends[1]);
        mesh.face_edges(f)
            .filter(|&side| side != e)
            .for_each(|side| {
                let shared = mesh.edge_vertices(side).map(|v| mesh.position(v));
                let shared = shared[0] + shared[1];
                let across = mesh.edge_faces(side).find(|&g| g != f);
                wings += match across {
                    Some(g) => {
                        let corners: Point = mesh.face_vertices(g).map(|v| mesh.position(v)).sum();
                        corners - shared
                    }
                    None => shared - (corners - shared),
                };
            });
    }
    (ends[0] + ends[1]) * 0.5 + sides * 0.125 - wings * 0.0625
}

fn boundary_point<M: MeshQuery>(mesh: &M, [a, b]: [M::Vertex; 2]) -> Point {
    // The ring runs from one boundary edge to the other.
    let beyond = |v, to| match ring(mesh, v)[..] {
        [first, .., last] if last == to => mesh.position(first),
        [.., last] => mesh.position(last),
        [] => mesh.position(v),
    };
    let far = beyond(a, b) + beyond(b, a);
    (mesh.position(a) + mesh.position(b)) * 0.5625 - far * 0.0625
}

/// Returns the weights of the neighbours of an inner vertex. The first neighbour is the other end
/// of the edge. The weight of the vertex is 1 minus the sum of these weights.
fn ring_weights(valence: usize) -> Vec<f32> {
    let n = valence as f64;
    let weight = |j: usize| {
        let angle = TAU * j as f64 / n;
        ((0.25 + angle.cos() + 0.5 * (2.0 * angle).cos()) / n) as f32
    };
    match valence {
        0..=2 => std::iter::once(0.5).chain([0.0]).take(valence).collect(),
        3 => [5.0, -1.0, -1.0].map(|w| w / 12.0).to_vec(),
        4 => vec![0.375, 0.0, -0.125, 0.0],
        _ => (0..valence).map(weight).collect(),
    }
}

/// Returns the weights for the point of the edge from a boundary vertex to its neighbour `i` (Zorin
/// & Schröder 2000). The vertex has k `triangles` and k + 1 neighbours. The neighbours are ordered
/// from one boundary edge to the other boundary edge. The weight of the vertex is 1 minus the sum
/// of these weights. With θ = π/k:
///
/// ```text
///   first, last  ±(cos iθ)/4 ∓ sin 2θ sin 2iθ / (4k (cos θ − cos 2θ))
///   j between    (sin iθ sin jθ + (sin 2iθ sin 2jθ)/2)/k
/// ```
fn boundary_weights(triangles: usize, i: usize) -> Vec<f32> {
    let (k, i) = (triangles as f64, i as f64);
    let theta = PI / k;
    let end = boundary_end(triangles, i);
    let between = |j: usize| {
        let (i, j) = (i * theta, j as f64 * theta);
        (i.sin() * j.sin() + 0.5 * (2.0 * i).sin() * (2.0 * j).sin()) / k
    };
    let inner = (1..triangles).map(between);
    let all = std::iter::once(end).chain(inner).chain([-end]);
    all.map(|weight| weight as f32).collect()
}

/// Returns the weight of the first neighbour in [`boundary_weights`]; the last one has its negative.
fn boundary_end(triangles: usize, i: f64) -> f64 {
    let k = triangles as f64;
    let theta = PI / k;
    0.25 * (i * theta).cos()
        - (2.0 * theta).sin() * (2.0 * i * theta).sin()
            / (4.0 * k * (theta.cos() - (2.0 * theta).cos()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sixfold_core::{PolygonMesh, VertexId};
    use sixfold_face_vertex::FaceVertexMesh;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::{
        all_methods, assert_affine, assert_equivalent, assert_near, assert_same_on_threads, build,
        native, triangle_mesh,
    };

    fn step(polygons: &PolygonMesh) -> PolygonMesh {
        let step = gather(&build::<IndexedFaceSet>(polygons));
        step.expect("a manifold").polygons
    }

    /// Returns the ends and the point of every edge in a step of `polygons`.
    fn edge_points(polygons: &PolygonMesh) -> Vec<([Point; 2], Point)> {
        let mesh: IndexedFaceSet = build(polygons);
        let ends = mesh.edges().map(|e| mesh.edge_vertices(e));
        let ends = ends.map(|ends| ends.map(|v| mesh.position(v)));
        let step = step(polygons);
        let points = step.positions()[polygons.vertex_count()..].iter();
        ends.zip(points.copied()).collect()
    }

    #[test]
    fn weights_have_the_expected_sum_and_keep_a_plane() {
        for valence in 3..=40 {
            let sum: f32 = ring_weights(valence).iter().sum();
            assert!((sum - 0.25).abs() < 1e-6, "valence {valence}: {sum}");
        }
        let weights = |valence| ring_weights(valence)[..2].to_vec();
        assert_eq!(weights(3), [5.0 / 12.0, -1.0 / 12.0]);
        assert_eq!(weights(4), [0.375, 0.0]);
        assert!((ring_weights(5)[0] - 0.35).abs() < 1e-6);
        for triangles in 2..=12 {
            let angle = |i: usize| PI * i as f64 / triangles as f64;
            for i in 1..triangles {
                let weights = boundary_weights(triangles, i);
                let at = weights.iter().enumerate().map(|(j, &w)| {
                    let (sin, cos) = angle(j).sin_cos();
                    Point::new(cos as f32, sin as f32, 0.0) * w
                });
                let (sin, cos) = angle(i).sin_cos();
                let half = Point::new(cos as f32, sin as f32, 0.0) * 0.5;
                assert_near(at.sum(), half);
            }
        }
    }

    /// A cone over a circle that is cut open or not, with radii that differ.
    fn cone(n: u32, is_open: bool) -> PolygonMesh {
        let rim = (0..n).map(|i| {
            let (sin, cos) = (f64::from(i) * TAU / f64::from(n)).sin_cos();
            let size = 1.0 + 0.3 * f64::from(i * i % 7);
            DVec3::new(size * cos, size * sin, 0.1 * f64::from(i % 5)).as_vec3()
        });
        let points: Vec<Point> = rim.chain([Point::new(0.1, 0.2, 1.0)]).collect();
        let count = if is_open { n - 1 } else { n };
        let faces = (0..count).map(|i| [i, (i + 1) % n, n]);
        PolygonMesh::new(points, faces).expect("a cone")
    }

    #[test]
    fn sums_of_a_hub_give_the_points_of_its_weights() {
        for n in [65, 66, 130] {
            for is_open in [false, true] {
                let mesh: FaceVertexMesh = build(&cone(n, is_open));
                let tip = mesh.vertices().last().expect("the tip");
                let with_hubs = Butterfly::new(&mesh, |_| false);
                assert_eq!(with_hubs.hubs.len(), 1);
                let without = Butterfly {
                    rings: std::array::from_fn(ring_weights),
                    hubs: FxHashMap::default(),
                };
                let inner = mesh.vertex_vertices(tip);
                for to in inner.filter(|&to| mesh.vertex_faces(to).count() == 2) {
                    assert_near(
                        with_hubs.extraordinary_point(&mesh, tip, to),
                        without.extraordinary_point(&mesh, tip, to),
                    );
                }
            }
        }
    }

    #[test]
    fn solids_match_values_computed_by_hand() {
        for (solid, weight) in [
            (sixfold_shapes::tetrahedron(), 2.0 / 3.0),
            (sixfold_shapes::octahedron(), 0.625),
        ] {
            let centre = solid.positions().iter().sum::<Point>() / solid.vertex_count() as f32;
            for ([a, b], point) in edge_points(&solid) {
                let expected = centre + (a + b - centre * 2.0) * weight;
                assert_near(point, expected);
            }
        }
    }

    #[test]
    fn regular_grids_keep_cubics() {
        let (m, n) = (7, 6);
        let grid = sixfold_shapes::triangle_grid(m, n).expect("a small grid");
        let height = |x: f32, y: f32| {
            0.5 * x * x * x - x * x * y + 0.25 * x * y * y + y * y * y - 2.0 * x * y + x - 3.0
        };
        let lattice = grid.positions().iter().map(|p| {
            let (x, y) = (p.x * 0.25, p.y * 0.25);
            Point::new(x, y, height(x, y))
        });
        let field = PolygonMesh::from_faces(lattice.collect(), grid.faces().clone());
        let field = field.expect("the faces of the grid");
        let is_inside = |p: &Point| {
            let within = |x: f32, size: usize| x > 0.0 && x < size as f32 * 0.25;
            within(p.x, m) && within(p.y, n)
        };
        let mut kept = 0;
        for (ends, point) in edge_points(&field) {
            if ends.iter().all(is_inside) {
                let Point { x, y, .. } = midpoint(ends);
                assert_near(point, Point::new(x, y, height(x, y)));
                kept += 1;
            }
        }
        let (m, n) = (m - 2, n - 2);
        assert_eq!(kept, 3 * m * n + m + n);
    }

    /// ```text
    ///   3 ── 4 ── 5      tests the boundary edges 1–2 and 0–1, and the edge 1–4, with ghosts
    ///   │ ╲  │ ╲  │      beyond 3–4 and 1–2
    ///   0 ── 1 ── 2
    /// ```
    #[test]
    fn a_boundary_is_a_four_point_curve() {
        let corners = [(0, 0), (1, 2), (3, 1), (0, 5), (2, 6), (4, 4)];
        let corners = corners.map(|(x, y)| Point::new(x as f32, y as f32, (x * y) as f32));
        let faces = [[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4]];
        let mesh = PolygonMesh::new(corners, faces).expect("four triangles");
        let c = corners;
        let between = |a: usize, b: usize| {
            let all = edge_points(&mesh);
            let found = all
                .iter()
                .find(|(ends, _)| ends.contains(&c[a]) && ends.contains(&c[b]));
            found.expect("an edge").1
        };
        assert_near(
            between(1, 2),
            (c[1] + c[2]) * 0.5625 - (c[0] + c[5]) * 0.0625,
        );
        assert_near(
            between(0, 1),
            (c[0] + c[1]) * 0.5625 - (c[3] + c[2]) * 0.0625,
        );
        // Vertices 1 and 4 are regular. Other corners: 0, 5, and ghosts beyond 3–4 and 1–2.
        let ghosts = (c[3] + c[4] - c[1]) + (c[1] + c[2] - c[4]);
        let expected =
            (c[1] + c[4]) * 0.5 + (c[3] + c[2]) * 0.125 - (c[0] + c[5] + ghosts) * 0.0625;
        assert_near(between(1, 4), expected);
        // Vertex 3 has two triangles and the ring 0, 1, 4.
        let weights = boundary_weights(2, 1);
        let expected = weights.iter().zip([c[0], c[1], c[4]]);
        let expected = expected.fold(c[3], |p, (&w, at)| p + (at - c[3]) * w);
        assert_near(between(3, 1), expected);
    }

    #[test]
    fn non_manifold_meshes_return_errors() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat);
        let error_of = |faces: &[[u32; 3]]| {
            let polygons = PolygonMesh::new(corners, faces).expect("valid");
            let mesh: IndexedFaceSet = build(&polygons);
            let error = gather(&mesh).expect_err("no rule");
            let native = native::<FaceVertexMesh>(Scheme::Butterfly, &polygons, 0);
            assert_eq!(native, Err(error.clone()));
            error
        };
        let scheme = Scheme::Butterfly;
        let edge = |faces| SubdivisionError::NonManifoldEdge {
            scheme,
            ends: [0, 1].map(VertexId::new),
            faces,
        };
        assert_eq!(error_of(&[[0, 1, 2], [1, 0, 3], [1, 0, 4]]), edge(3));
        assert_eq!(error_of(&[[0, 1, 2], [0, 1, 3]]), edge(2));
        let vertex = VertexId::new(0);
        let several = SubdivisionError::NonManifoldVertex { scheme, vertex };
        assert_eq!(error_of(&[[0, 1, 2], [0, 3, 4]]), several);
    }

    #[test]
    fn the_result_does_not_depend_on_threads() {
        assert_same_on_threads(Scheme::Butterfly, 0);
    }

    proptest! {
        #[test]
        fn all_methods_agree_and_old_vertices_stay(mesh in triangle_mesh()) {
            let meshes = all_methods(Scheme::Butterfly, &mesh, 0).expect("a manifold");
            let known = mesh.vertex_count();
            for other in &meshes {
                prop_assert_eq!(&other.positions()[..known], mesh.positions());
                assert_equivalent(&meshes[0], other, known);
            }
        }

        #[test]
        fn affine_maps_commute(mesh in triangle_mesh()) {
            assert_affine(Scheme::Butterfly, &mesh, 0);
        }
    }
}

//! Creases: the new points at sharp edges and vertices, and the sharpness at the next level.
//!
//! The rules are those of DeRose, Kass & Truong (1998), with fractional sharpness. A step first
//! places all points as if no edge and no vertex were sharp. The code of this file then computes
//! the points at sharp edges and vertices again. Every scheme with creases uses these rules, with
//! every method.
//!
//! ```text
//!   sharp edges at a vertex       kind         new position
//!   0                             smooth       the vertex point of the scheme
//!   1                             dart         the same
//!   2                             crease       1/8 end + 3/4 vertex + 1/8 end
//!   more, or a sharp vertex       corner       unchanged
//! ```
//!
//! A finite sharpness decreases by one per level, to at least 0. If the kind of a vertex changes at
//! the next level, the new position of the vertex is w · (position of the current kind) + (1 − w) ·
//! (position of the next kind), where w is the mean of the sharpness values that become zero.

use sixfold_core::{Creases, Pair, Point, SHARPNESS_INFINITE, VertexId};

use crate::mask::midpoint;
use crate::options::Creasing;

/// A sharp edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SharpEdge {
    pub(crate) edge: usize,
    pub(crate) ends: [u32; 2],
    pub(crate) sharpness: f32,
    /// Whether the edge is sharp because it is a boundary edge or has three faces or more. The
    /// halves of such an edge need no entry at the next level.
    pub(crate) by_topology: bool,
}

/// The sharp elements of one level.
#[derive(Debug, Default)]
pub(crate) struct SharpLevel {
    pub(crate) edges: Vec<SharpEdge>,
    pub(crate) corners: Vec<(VertexId, f32)>,
}

/// One end of a sharp edge.
#[derive(Clone, Copy, Debug)]
struct Spoke {
    at: u32,
    far: u32,
    sharpness: f32,
    /// The index of the edge in the level, and the index of the end.
    edge: (usize, usize),
    /// The sharpness at the next level of the half at this end.
    child: f32,
}

/// The kind of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    Smooth,
    Crease,
    Corner,
}

impl Rule {
    pub(crate) fn new(own: f32, sharp_edges: usize) -> Self {
        match sharp_edges {
            _ if own > 0.0 => Self::Corner,
            0 | 1 => Self::Smooth,
            2 => Self::Crease,
            _ => Self::Corner,
        }
    }
}

/// Returns the sharpness at the next level, without the influence of other edges.
fn next_sharpness(sharpness: f32) -> f32 {
    if sharpness >= SHARPNESS_INFINITE {
        f32::INFINITY
    } else {
        (sharpness - 1.0).max(0.0)
    }
}

pub(crate) fn is_semi_sharp(sharpness: f32) -> bool {
    sharpness > 0.0 && sharpness < SHARPNESS_INFINITE
}

impl SharpLevel {
    pub(crate) fn is_empty(&self) -> bool {
        self.edges.is_empty() && self.corners.is_empty()
    }

    /// Places the points at sharp elements, and returns the creases of the next level.
    ///
    /// `points` contains the vertex points, and from `first_edge` the edge points, all placed as if
    /// nothing were sharp. `old` has the old position of each vertex. O(s log s) for s sharp
    /// elements.
    pub(crate) fn place(
        &self,
        old: &[Point],
        points: &mut [Point],
        first_edge: usize,
        creasing: Creasing,
    ) -> Creases {
        let mut spokes = self.spokes(creasing);
        let mut children = vec![[0.0_f32; 2]; self.edges.len()];
        for spoke in &spokes {
            children[spoke.edge.0][spoke.edge.1] = spoke.child;
        }
        self.place_edges(&children, old, points, first_edge);
        spokes.sort_unstable_by_key(|spoke| (spoke.at, spoke.edge));
        let corners = self.place_vertices(&spokes, old, points);
        Creases::from_entries(self.halves(&children, first_edge), corners)
    }

    /// Returns the two spokes of every edge.
    fn spokes(&self, creasing: Creasing) -> Vec<Spoke> {
        let edges = self.edges.iter().enumerate();
        let mut spokes: Vec<Spoke> = edges
            .flat_map(|(number, edge)| {
                let [a, b] = edge.ends;
                [(a, b, 0), (b, a, 1)].map(|(at, far, end)| Spoke {
                    at,
                    far,
                    sharpness: edge.sharpness,
                    edge: (number, end),
                    child: next_sharpness(edge.sharpness),
                })
            })
            .collect();
        if creasing == Creasing::Chaikin {
            spokes.sort_unstable_by_key(|spoke| (spoke.at, spoke.edge));
            for around in spokes.chunk_by_mut(|a, b| a.at == b.at) {
                apply_chaikin(around);
            }
        }
        spokes
    }

    fn place_edges(
        &self,
        children: &[[f32; 2]],
        old: &[Point],
        points: &mut [Point],
        first_edge: usize,
    ) {
        for (edge, children) in self.edges.iter().zip(children) {
            let sharp = midpoint(edge.ends.map(|v| old[v as usize]));
            let point = &mut points[first_edge + edge.edge];
            let stays = children.iter().all(|&child| child > 0.0);
            *point = if stays || edge.sharpness >= 1.0 {
                sharp
            } else {
                point.lerp(sharp, edge.sharpness)
            };
        }
    }

    /// Places every sharp vertex and every end of a sharp edge. Returns the sharp vertices of the
    /// next level.
    fn place_vertices(
        &self,
        spokes: &[Spoke],
        old: &[Point],
        points: &mut [Point],
    ) -> Vec<(VertexId, f32)> {
        let mut own = self.corners.iter().copied().peekable();
        let place_isolated = |(v, sharpness): (VertexId, f32), points: &mut [Point]| {
            let v = v.index() as u32;
            points[v as usize] = new_position(v, sharpness, &[], old, points[v as usize]);
        };
        for around in spokes.chunk_by(|a, b| a.at == b.at) {
            let v = around[0].at;
            while let Some(corner) = own.next_if(|(corner, _)| corner.index() < v as usize) {
                place_isolated(corner, points);
            }
            let corner = own.next_if(|(corner, _)| corner.index() == v as usize);
            let sharpness = corner.map_or(0.0, |(_, sharpness)| sharpness);
            points[v as usize] = new_position(v, sharpness, around, old, points[v as usize]);
        }
        for corner in own {
            place_isolated(corner, points);
        }
        let next = self.corners.iter().map(|&(v, s)| (v, next_sharpness(s)));
        next.collect()
    }

    /// Returns the two halves of each edge, with their sharpness.
    fn halves(&self, children: &[[f32; 2]], first_edge: usize) -> Vec<(Pair<VertexId>, f32)> {
        let explicit = self.edges.iter().zip(children);
        explicit
            .filter(|(edge, _)| !edge.by_topology)
            .flat_map(|(edge, children)| {
                // The step has already checked that this number fits.
                let middle = VertexId::new((first_edge + edge.edge) as u32);
                let half = |end: usize| {
                    let ends = Pair::new(VertexId::new(edge.ends[end]), middle);
                    (ends, children[end])
                };
                [half(0), half(1)]
            })
            .collect()
    }
}

/// Applies Chaikin's rule to the sharpness of the halves around one vertex.
fn apply_chaikin(around: &mut [Spoke]) {
    let semi_sharp = |spoke: &&Spoke| is_semi_sharp(spoke.sharpness);
    let (count, sum) = around
        .iter()
        .filter(semi_sharp)
        .fold((0, 0.0), |(count, sum), spoke| {
            (count + 1, sum + spoke.sharpness)
        });
    if count < 2 {
        return;
    }
    for spoke in around
        .iter_mut()
        .filter(|spoke| is_semi_sharp(spoke.sharpness))
    {
        let others = (sum - spoke.sharpness) / (count - 1) as f32;
        spoke.child = (0.75 * spoke.sharpness + 0.25 * others - 1.0).max(0.0);
    }
}

/// Returns the new position of vertex `v` with the sharpness `own` and the sharp edges `around`.
fn new_position(v: u32, own: f32, around: &[Spoke], old: &[Point], smooth: Point) -> Point {
    let still_sharp = || around.iter().filter(|spoke| spoke.child > 0.0);
    let current = Rule::new(own, around.len());
    let next = Rule::new(next_sharpness(own), still_sharp().count());
    let at = |rule: Rule, ends: &mut dyn Iterator<Item = &Spoke>| match rule {
        Rule::Corner => old[v as usize],
        Rule::Crease => {
            let ends: Point = ends.map(|spoke| old[spoke.far as usize]).sum();
            ends * 0.125 + old[v as usize] * 0.75
        }
        Rule::Smooth => smooth,
    };
    let parent = at(current, &mut around.iter());
    if current == next || current == Rule::Smooth {
        return parent;
    }
    at(next, &mut still_sharp()).lerp(parent, blend_weight(own, around))
}

/// Returns the weight of the current kind if the kind of a vertex changes: the mean of the
/// sharpnesses that become zero, at most 1.
fn blend_weight(own: f32, around: &[Spoke]) -> f32 {
    let edges = around.iter().filter(|spoke| spoke.child == 0.0);
    let vertex = (own > 0.0 && next_sharpness(own) == 0.0).then_some(own);
    let ending = edges.map(|spoke| spoke.sharpness).chain(vertex);
    let (count, sum) = ending.fold((0_u32, 0.0), |(count, sum), s| (count + 1, sum + s));
    (sum / count.max(1) as f32).min(1.0)
}

#[cfg(test)]
mod tests {
    use sixfold_core::{PolygonMesh, Representation};
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::{BoundaryRule, Scheme, Step, Subdivision};

    const INF: f32 = f32::INFINITY;

    /// ```text
    ///   6 ── 7 ── 8      the vertex 4 at height 1, all others at 0; z after a Catmull–Clark step:
    ///   │    │    │      vertex 4  smooth   1/2 · 1 + 4 faces/16 of height 1/4 = 9/16
    ///   3 ── 4 ── 5                crease   3/4
    ///   │    │    │                corner   1
    ///   0 ── 1 ── 2      its edges smooth   (1 + 0 + 1/4 + 1/4)/4 = 3/8, sharp 1/2
    /// ```
    fn hill() -> PolygonMesh {
        let at = |i: u32| Point::new((i % 3) as f32, (i / 3) as f32, f32::from(u8::from(i == 4)));
        let quad = |i: u32| [i, i + 1, i + 4, i + 3];
        let points: Vec<Point> = (0..9).map(at).collect();
        PolygonMesh::new(points, [0, 1, 3, 4].map(quad)).expect("four quads")
    }

    /// Runs a step of the hill. `spokes` contains the sharpnesses of the edges from vertex 4 to
    /// vertices 1, 3, 5 and 7. `own` is the sharpness of vertex 4.
    fn step(creasing: Creasing, spokes: &[f32], own: f32) -> Step {
        let hill = hill();
        let mesh = IndexedFaceSet::from_polygons(&hill).expect("quads");
        let edges = [1, 3, 5, 7].into_iter().zip(spokes);
        let edges = edges.map(|(far, &s)| ([4, far], s));
        let creases = Creases::new(&hill, edges, [(4, own)]).expect("edges at 4");
        let subdivision = Subdivision {
            creasing,
            boundary: BoundaryRule::EdgeOnly,
            ..Subdivision::new(Scheme::CatmullClark)
        };
        let creases = subdivision.control_creases(&mesh, &hill, &creases);
        let step = subdivision.gather(&mesh, &creases.expect("creases"), 0);
        step.expect("quads")
    }

    /// Returns the point of the edge from vertex 4 to vertex `far`.
    fn edge_point(step: &Step, far: usize) -> VertexId {
        let middle = midpoint([hill().positions()[4], hill().positions()[far]]);
        let above = |p: Point| p.truncate().distance(middle.truncate()) < 1e-6;
        let mut points = step.polygons.vertices().skip(9 + 4);
        points
            .find(|&v| above(step.polygons.position(v)))
            .expect("a point")
    }

    fn assert_heights(creasing: Creasing, cases: &[(f32, &[f32], f32)]) {
        for &(own, spokes, expected) in cases {
            let z = step(creasing, spokes, own).polygons.positions()[4].z;
            assert!(
                (z - expected).abs() < 1e-6,
                "{own} with {spokes:?}: {z}, expected {expected}"
            );
        }
    }

    #[test]
    fn a_vertex_blends_between_its_current_and_next_kind() {
        assert_heights(
            Creasing::Uniform,
            &[
                (0.0, &[], 0.5625),
                (0.0, &[0.3], 0.5625),
                (0.0, &[INF], 0.5625),
                // Crease to smooth or to dart: 0.3 · 0.75 + 0.7 · 0.5625, or w = mean of 0.3 and
                // 0.7.
                (0.0, &[0.3, 0.3], 0.61875),
                (0.0, &[0.3, 1.5], 0.61875),
                (0.0, &[0.3, INF], 0.61875),
                (0.0, &[0.3, 0.7], 0.65625),
                (0.0, &[1.0, 1.0], 0.75),
                (0.0, &[1.5, 1.5], 0.75),
                // Corner to dart: 0.4 + 0.6 · 0.5625. Corner to crease: 0.3 + 0.7 · 0.75, 0.45 +
                // 0.55 · 0.75.
                (0.0, &[0.3, 0.5, INF], 0.7375),
                (0.0, &[0.3, INF, INF], 0.825),
                (0.0, &[0.3, 0.6, 2.0, 2.0], 0.8625),
                // Corner to corner.
                (0.0, &[0.3, 2.0, 2.0, 2.0], 1.0),
                // A sharp vertex: the mean contains its own sharpness.
                (0.4, &[], 0.7375),
                (0.4, &[0.8], 0.825),
                (0.4, &[3.0], 0.7375),
                (0.4, &[INF, INF], 0.85),
                (0.4, &[0.8, 0.8], 2.0 / 3.0 + 0.5625 / 3.0),
                (2.0, &[0.5, 0.5], 1.0),
            ],
        );
    }

    #[test]
    fn an_edge_point_is_as_sharp_as_its_edge() {
        for (sharpness, expected) in [(0.0, 0.375), (0.3, 0.4125), (1.0, 0.5), (2.5, 0.5)] {
            let step = step(Creasing::Uniform, &[sharpness], 0.0);
            let z = step.polygons.position(edge_point(&step, 1)).z;
            assert!((z - expected).abs() < 1e-6, "{sharpness}: {z}");
        }
    }

    /// Returns the sharpness of the two halves of each spoke: at vertex 4, then at the far end.
    fn halves(creasing: Creasing, spokes: &[f32]) -> Vec<[f32; 2]> {
        let step = step(creasing, spokes, 0.0);
        let spokes = [1, 3, 5, 7].into_iter().zip(spokes);
        let halves = spokes.map(|(far, _)| {
            let middle = edge_point(&step, far);
            let half = |end: usize| step.creases.edge(VertexId::new(end as u32), middle);
            [half(4), half(far)]
        });
        halves.collect()
    }

    fn assert_halves(creasing: Creasing, spokes: &[f32], expected: &[[f32; 2]]) {
        let got = halves(creasing, spokes);
        for (got, expected) in got.iter().flatten().zip(expected.iter().flatten()) {
            let is_near = got == expected || (got - expected).abs() < 1e-6;
            assert!(is_near, "{spokes:?}: {got}, expected {expected}");
        }
        assert_eq!(got.len(), expected.len());
    }

    #[test]
    fn halves_are_less_sharp_by_one() {
        let uniform = |spokes: &[f32], expected: &[[f32; 2]]| {
            assert_halves(Creasing::Uniform, spokes, expected);
        };
        uniform(
            &[INF, 10.0, 9.99, 0.4],
            &[[INF; 2], [INF; 2], [8.99; 2], [0.0; 2]],
        );
        uniform(&[1.0, 1.25], &[[0.0; 2], [0.25; 2]]);
    }

    /// At vertex 4: 3/4 of the edge's own sharpness, plus 1/4 of the mean of the other edges, minus
    /// 1. At the far end, which has no other sharp edge: the sharpness minus 1.
    #[test]
    fn chaikin_averages_sharpness() {
        let chaikin = |spokes: &[f32], expected: &[[f32; 2]]| {
            assert_halves(Creasing::Chaikin, spokes, expected);
        };
        chaikin(&[1.5], &[[0.5, 0.5]]);
        // Infinite sharpness is not part of a mean.
        chaikin(&[1.5, INF], &[[0.5, 0.5], [INF, INF]]);
        chaikin(&[0.5, 2.0], &[[0.0, 0.0], [0.625, 1.0]]);
        chaikin(&[1.2, 0.2, 2.0], &[[0.175, 0.2], [0.0, 0.0], [0.675, 1.0]]);
        chaikin(&[0.8, 4.0], &[[0.6, 0.0], [2.2, 3.0]]);
        assert_heights(
            Creasing::Chaikin,
            &[
                // Both halves at vertex 4 stay sharp.
                (0.0, &[0.8, 4.0], 0.75),
                // The sharpness 1.2 becomes zero: w is the mean of 1.2 and 0.1.
                (0.0, &[1.2, 0.1], 0.65 * 0.75 + 0.35 * 0.5625),
            ],
        );
        // One half of the edge with sharpness 0.8 becomes smooth: w = 0.8.
        let step = step(Creasing::Chaikin, &[0.8, 4.0], 0.0);
        let z = step.polygons.position(edge_point(&step, 1)).z;
        assert!((z - 0.475).abs() < 1e-6, "{z}");
    }
}

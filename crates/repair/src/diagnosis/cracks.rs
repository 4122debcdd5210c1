//! Cracks: boundaries that nearly meet.

use rustc_hash::FxHashMap;
use sixfold_core::{Incidence, Pair, PolygonMesh, VertexId};
use sixfold_spatial::{KdTree, PointQueries, SpatialIndex, VertexPoint};

use crate::step::Step;
use crate::weld::{Tolerance, Weld, representatives};

/// The largest distance between the sides of a crack, as a part of the shortest boundary edge at the
/// vertex.
const NARROW: f64 = 0.1;
/// The largest distance of a crack, as a multiple of the median gap: wider gaps are something else.
const MOST_MEDIANS: f64 = 10.0;

/// Boundaries that nearly meet: the distance at which welding joins them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Crack {
    /// A tolerance of [`Step::Weld`](crate::Step::Weld) that closes the crack, in units of the
    /// coordinates. It is below half of the shortest edge of the mesh, so that no edge collapses.
    pub distance: f64,
    /// The number of boundary edges that are no longer boundary edges after welding.
    pub edges: usize,
}

impl Crack {
    /// Returns the step that closes the crack.
    pub fn weld(&self) -> Step {
        Step::Weld(weld_within(self.distance))
    }
}

fn weld_within(distance: f64) -> Weld {
    Weld {
        tolerance: Tolerance::Absolute(distance),
        ..Weld::default()
    }
}

/// Finds the boundary vertices that have a near neighbour on another boundary edge, and the distance at
/// which most of their edges close. Returns `None` if no edge closes; O(n log n).
pub(super) fn crack(polygons: &PolygonMesh, incidence: &Incidence<'_>) -> Option<Crack> {
    let boundary = Boundary::new(polygons, incidence);
    let mut gaps = boundary.gaps();
    gaps.sort_unstable_by(f64::total_cmp);
    let median = *gaps.get(gaps.len() / 2)?;
    // Welding must not collapse edges.
    let limit = f64::min(
        0.5 * shortest_edge(polygons, incidence),
        MOST_MEDIANS * median,
    );
    let widest = gaps.into_iter().rfind(|&gap| gap < limit)?;
    let mut best: Option<Crack> = None;
    // More than two corners that belong together can be farther apart than nearest neighbours are.
    for factor in [1.0, 1.5, 2.0, 3.0] {
        let distance = rounded_up(factor * widest);
        let edges = match distance < limit {
            true => boundary.closed_edges(distance),
            false => 0,
        };
        if edges > best.map_or(0, |crack| crack.edges) {
            best = Some(Crack { distance, edges });
        }
    }
    best
}

/// Returns `x` rounded up to two significant digits.
fn rounded_up(x: f64) -> f64 {
    let unit = 10_f64.powi(x.log10().floor() as i32 - 1);
    let digits = (x / unit).ceil();
    // As it is printed and read again.
    format!("{:.1e}", digits * unit).parse().unwrap_or(x)
}

/// Returns the length of the shortest edge that has a length.
fn shortest_edge(polygons: &PolygonMesh, incidence: &Incidence<'_>) -> f64 {
    let lengths = incidence.edges().map(|edge| {
        let [a, b] = edge.ends.map(|v| polygons.position(v).as_dvec3());
        a.distance(b)
    });
    lengths
        .filter(|&length| length > 0.0)
        .fold(f64::INFINITY, f64::min)
}

/// The boundary edges and their vertices.
struct Boundary<'a> {
    polygons: &'a PolygonMesh,
    /// The ends of each edge, in the direction of its face.
    edges: Vec<[VertexId; 2]>,
    /// The vertices that have finite positions, with the length of their shortest boundary edge.
    vertices: Vec<(VertexId, f64)>,
    tree: KdTree<VertexPoint<VertexId>>,
}

impl<'a> Boundary<'a> {
    fn new(polygons: &'a PolygonMesh, incidence: &Incidence<'_>) -> Self {
        let mut edges = Vec::new();
        let mut shortest = vec![f64::INFINITY; polygons.vertex_count()];
        for edge in incidence.edges() {
            let Some(side) = edge.single() else { continue };
            let [low, high] = edge.ends;
            edges.push(if side.downward {
                [high, low]
            } else {
                [low, high]
            });
            let [a, b] = edge.ends.map(|v| polygons.position(v).as_dvec3());
            for v in edge.ends {
                let length = &mut shortest[v.index()];
                *length = length.min(a.distance(b));
            }
        }
        let lengths = polygons.vertices().zip(shortest);
        let vertices: Vec<(VertexId, f64)> = lengths
            .filter(|(v, length)| length.is_finite() && polygons.position(*v).is_finite())
            .collect();
        let points = vertices.iter().map(|&(vertex, _)| VertexPoint {
            vertex,
            position: polygons.position(vertex),
        });
        let tree = KdTree::build(points.collect()).expect("finite points, not more than vertices");
        Self {
            polygons,
            edges,
            vertices,
            tree,
        }
    }

    /// Returns the distance from each vertex to its nearest neighbour, where this is narrow but not
    /// zero.
    fn gaps(&self) -> Vec<f64> {
        let gap = |&(v, length): &(VertexId, f64)| {
            let at = self.polygons.position(v);
            let mut nearest = f64::INFINITY;
            self.tree.for_each_within(at, NARROW * length, |near| {
                if self.polygons.position(near.vertex) != at {
                    nearest = nearest.min(near.distance());
                }
            });
            nearest.is_finite().then_some(nearest)
        };
        self.vertices.iter().filter_map(gap).collect()
    }

    /// Returns the number of edges that have a partner if vertices within `distance` are welded.
    fn closed_edges(&self, distance: f64) -> usize {
        let Ok(representatives) = representatives(self.polygons, &weld_within(distance)) else {
            return 0;
        };
        let mut sides: FxHashMap<Pair<VertexId>, [usize; 2]> = FxHashMap::default();
        for edge in &self.edges {
            let [from, to] = edge.map(|v| representatives[v.index()]);
            sides.entry(Pair::new(from, to)).or_default()[usize::from(from > to)] += 1;
        }
        // The order of the pairs does not change a sum.
        sides.into_values().map(|[up, down]| 2 * up.min(down)).sum()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sixfold_core::{Facts, Point};

    use super::*;
    use crate::{diagnose, repair};

    /// Returns the mesh in which each corner has a vertex of its own, moved by `shift`.
    fn separate(mesh: &PolygonMesh, mut shift: impl FnMut() -> Point) -> PolygonMesh {
        let corners = mesh.faces().corners().iter();
        let points = corners.map(|&v| mesh.position(v) + shift());
        let mut next = 0..;
        let faces = mesh
            .faces()
            .iter()
            .map(|(_, face)| next.by_ref().take(face.len()).collect());
        PolygonMesh::new(points.collect::<Vec<_>>(), faces.collect::<Vec<Vec<u32>>>())
            .expect("valid")
    }

    fn boundary_edges(mesh: &PolygonMesh) -> usize {
        Facts::from_polygons(mesh).boundary_edges
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            cases: 32,
            ..ProptestConfig::default()
        })]

        /// Welding at the distance of the diagnosis closes the edges that it counts: all.
        #[test]
        fn facets_that_disagree_are_welded(
            shifts in proptest::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 50),
            size in 1e-6..3e-3_f32,
        ) {
            let sphere = sixfold_shapes::dodecahedron().triangulated().expect("small").polygons;
            let mut shifts = shifts.iter().cycle();
            let mut next = || size * Point::from_array(*shifts.next().expect("a cycle"));
            let cracked = separate(&sphere, &mut next);
            let crack = diagnose(&cracked, 0).crack.expect("all edges are cracks");
            prop_assert_eq!(crack.edges, boundary_edges(&cracked));
            prop_assert!(crack.distance <= 4.0 * f64::from(size), "{:?}", crack);
            let welded = repair(&cracked, &[crack.weld()]).expect("a good tolerance").polygons;
            prop_assert_eq!(welded.face_count(), sphere.face_count());
            prop_assert_eq!(boundary_edges(&welded), 0);
        }
    }

    #[test]
    fn rims_that_nearly_meet_are_a_crack_and_good_boundaries_are_not() {
        let half = |from: f32| {
            // Twelve quads around an axis, two rows of them.
            let points = (0..36_u8).map(|i| {
                let (sin, cos) = (f32::from(i % 12) * std::f32::consts::TAU / 12.0).sin_cos();
                [cos, sin, f32::from(i / 12) + from]
            });
            let quads = (0..24_u32).map(|i| {
                let [row, next] = [i / 12 * 12, (i + 1) % 12];
                [i, row + next, row + next + 12, i + 12]
            });
            PolygonMesh::new(points, quads).expect("valid")
        };
        let tube = half(0.0);
        assert_eq!(diagnose(&tube, 0).crack, None);
        let two = crate::orientation::tests::together(&[tube, half(2.003)]);
        let crack = diagnose(&two, 0).crack.expect("the rims nearly meet");
        assert_eq!(crack.edges, 24);
        assert!((0.003..0.0032).contains(&crack.distance), "{crack:?}");
    }
}

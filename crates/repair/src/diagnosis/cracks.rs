//! Cracks: boundaries that nearly meet.

use rustc_hash::{FxHashMap, FxHashSet};
use sixfold_core::{Incidence, Pair, Point, PolygonMesh, VertexId};
use sixfold_spatial::{KdTree, PointQueries, SpatialIndex, VertexPoint};

use super::fault::FaultKind;
use crate::step::Step;
use crate::weld::{Tolerance, Weld, representatives};

/// The largest distance between the sides of a crack, as a part of the shortest boundary edge at the
/// vertex.
const NARROW: f64 = 0.1;
/// The largest distance of a crack, as a multiple of the median gap: wider gaps are something else.
const MOST_MEDIANS: f64 = 10.0;

/// Boundaries that nearly meet: the distance at which welding joins them, and what it does to the
/// rest of the mesh. The numbers are those of a weld of the whole mesh at this distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Crack {
    /// A tolerance of [`Step::Weld`](crate::Step::Weld) that closes the crack, in units of the
    /// coordinates.
    pub distance: f64,
    /// The number of boundary edges that are no longer boundary edges after welding.
    pub edges: usize,
    /// The number of edges with two faces that run in the same direction after welding, and were two
    /// boundary edges before. [`Step::Orient`](crate::Step::Orient) turns one of the faces.
    pub same_direction: usize,
    /// The number of faces with corners at different positions that would become one vertex, and of
    /// faces that would have the same vertices as another face.
    pub collapsed_faces: usize,
    /// The number of edges that would have three or more faces, and do not have them before.
    pub non_manifold_edges: usize,
}

impl Crack {
    /// Returns the steps that close the crack: a weld, and if it joins edges that run in the same
    /// direction, an orientation of the faces. They do no harm if the crack [is safe](Self::is_safe) to
    /// weld.
    pub fn repairs(&self) -> Vec<Step> {
        let orient = match self.same_direction {
            0 => Vec::new(),
            _ => FaultKind::TurnedFace.repairs(),
        };
        [vec![Step::Weld(weld_within(self.distance))], orient].concat()
    }

    /// Returns whether welding at this distance collapses no face and makes no non-manifold edge. Where
    /// parts of the mesh are thinner or finer than the crack is wide, no distance may be safe.
    pub fn is_safe(&self) -> bool {
        self.collapsed_faces == 0 && self.non_manifold_edges == 0
    }
}

fn weld_within(distance: f64) -> Weld {
    Weld {
        tolerance: Tolerance::Absolute(distance),
        ..Weld::default()
    }
}

/// Finds the boundary vertices that have a near neighbour on another boundary edge, and the distance at
/// which most of their edges close: a safe one, unless it closes less than half of the edges that
/// another distance closes. Returns `None` if no edge closes; O(n log n).
pub(super) fn crack(polygons: &PolygonMesh, incidence: &Incidence<'_>) -> Option<Crack> {
    let boundary = Boundary::new(polygons, incidence);
    let mut gaps = boundary.gaps();
    gaps.sort_unstable_by(f64::total_cmp);
    let median = *gaps.get(gaps.len() / 2)?;
    let cracks: Vec<Crack> = distances(&gaps, median, shortest_edge(polygons, incidence))
        .into_iter()
        .filter_map(|distance| try_weld(polygons, incidence, distance))
        .collect();
    // The smallest distance of several that close the same number.
    let most = |cracks: &mut dyn Iterator<Item = &Crack>| {
        cracks.fold(None, |best: Option<Crack>, &crack| match best {
            Some(best) if best.edges >= crack.edges => Some(best),
            _ => Some(crack),
        })
    };
    let best = most(&mut cracks.iter()).filter(|crack| crack.edges > 0)?;
    let safe = most(&mut cracks.iter().filter(|crack| crack.is_safe()));
    Some(
        safe.filter(|safe| 2 * safe.edges >= best.edges)
            .unwrap_or(best),
    )
}

/// Returns the distances at which welding is tried, from sorted gaps with this median.
fn distances(gaps: &[f64], median: f64, shortest_edge: f64) -> Vec<f64> {
    let widest_below = |limit: f64| gaps.iter().copied().rfind(|&gap| gap < limit);
    let limit = MOST_MEDIANS * median;
    // Below half of the shortest edge, welding is most likely safe.
    let short = limit.min(0.5 * shortest_edge);
    // More than two corners that belong together can be farther apart than nearest neighbours are.
    let multiples = |widest: f64| [1.0, 1.5, 2.0, 3.0].map(|factor| rounded_up(factor * widest));
    let near = widest_below(short).into_iter().flat_map(multiples);
    let near = near.filter(|&distance| distance < short);
    let all = widest_below(limit).into_iter().flat_map(multiples);
    let mut distances: Vec<f64> = near.chain(all).collect();
    distances.sort_unstable_by(f64::total_cmp);
    distances.dedup();
    distances
}

/// Welds vertices within `distance` on trial, and compares the edges and faces. Returns `None` if the
/// distance is not valid. O(n log n), of which all but the weld is for the elements that it changes.
fn try_weld(polygons: &PolygonMesh, incidence: &Incidence<'_>, distance: f64) -> Option<Crack> {
    let representatives = representatives(polygons, &weld_within(distance)).ok()?;
    let of = |v: VertexId| representatives[v.index()];
    let mut is_merged = vec![false; representatives.len()];
    for v in polygons.vertices().filter(|&v| of(v) != v) {
        is_merged[v.index()] = true;
        is_merged[of(v).index()] = true;
    }
    // Only edges and faces with an end that is merged change.
    let [open, non_manifold, same_direction] = edge_changes(incidence, of, &is_merged);
    Some(Crack {
        distance,
        edges: usize::try_from(-open).unwrap_or(0),
        same_direction: usize::try_from(same_direction).unwrap_or(0),
        collapsed_faces: collapsed_faces(polygons, of, &is_merged),
        non_manifold_edges: usize::try_from(non_manifold).unwrap_or(0),
    })
}

/// Returns how many more boundary edges, edges with three or more faces, and edges with two faces that
/// run in the same direction a mesh has if every vertex becomes the one that `of` returns.
fn edge_changes(
    incidence: &Incidence<'_>,
    of: impl Fn(VertexId) -> VertexId,
    is_merged: &[bool],
) -> [isize; 3] {
    let mut change = [0; 3];
    let mut count = |[up, down]: [usize; 2], by: isize| {
        let faces = up + down;
        let is_kind = [faces == 1, faces > 2, faces == 2 && up != down];
        for (change, is_kind) in change.iter_mut().zip(is_kind) {
            *change += if is_kind { by } else { 0 };
        }
    };
    // By pair of vertices: the number of faces that run from the lower vertex to the higher, and of
    // others.
    let mut joined: FxHashMap<Pair<VertexId>, [usize; 2]> = FxHashMap::default();
    for edge in incidence.edges() {
        if edge.ends.iter().any(|v| is_merged[v.index()]) {
            let directions = [edge.len() - edge.downward(), edge.downward()];
            count(directions, -1);
            let [low, high] = edge.ends.map(&of);
            let [up, down] = match low < high {
                true => directions,
                false => [directions[1], directions[0]],
            };
            if low != high {
                let joined = joined.entry(Pair::new(low, high)).or_default();
                *joined = [joined[0] + up, joined[1] + down];
            }
        }
    }
    // The order of the pairs does not change a sum.
    joined
        .into_values()
        .for_each(|directions| count(directions, 1));
    change
}

/// Returns the number of faces that get a repeated corner or the vertices of another face, if every
/// vertex becomes the one that `of` returns. Faces with two corners at one position, and faces that
/// share their vertices before, do not count.
fn collapsed_faces(
    polygons: &PolygonMesh,
    of: impl Fn(VertexId) -> VertexId,
    is_merged: &[bool],
) -> usize {
    let mut collapsed = 0;
    // By the vertices of faces after welding: those of the first such face before.
    let mut first: FxHashMap<Vec<VertexId>, Vec<VertexId>> = FxHashMap::default();
    let sorted = |mut corners: Vec<VertexId>| {
        corners.sort_unstable();
        corners
    };
    for (_, face) in polygons.faces().iter() {
        if !face.iter().any(|v| is_merged[v.index()]) {
            continue;
        }
        let after = sorted(face.iter().map(|&v| of(v)).collect());
        if after.windows(2).any(|pair| pair[0] == pair[1]) {
            let mut places: Vec<[u32; 3]> = face.iter().map(|&v| place(polygons, v)).collect();
            places.sort_unstable();
            let has_coincident = places.windows(2).any(|pair| pair[0] == pair[1]);
            collapsed += usize::from(!has_coincident);
        } else if face.iter().all(|v| is_merged[v.index()]) {
            let before = sorted(face.to_vec());
            let first = first.entry(after).or_insert_with(|| before.clone());
            collapsed += usize::from(*first != before);
        }
    }
    collapsed
}

/// Returns the same bits for vertices at the same position.
fn place(polygons: &PolygonMesh, v: VertexId) -> [u32; 3] {
    // Replaces −0 by 0.
    (polygons.position(v) + Point::ZERO)
        .to_array()
        .map(f32::to_bits)
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

/// The vertices of boundary edges.
struct Boundary<'a> {
    polygons: &'a PolygonMesh,
    /// The vertices that have finite positions, with the length of their shortest boundary edge.
    vertices: Vec<(VertexId, f64)>,
    /// One vertex at each position.
    tree: KdTree<VertexPoint<VertexId>>,
}

impl<'a> Boundary<'a> {
    fn new(polygons: &'a PolygonMesh, incidence: &Incidence<'_>) -> Self {
        let mut shortest = vec![f64::INFINITY; polygons.vertex_count()];
        for edge in incidence.edges().filter(|edge| edge.len() == 1) {
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
        let mut seen = FxHashSet::default();
        let points = vertices.iter().filter_map(|&(vertex, _)| {
            let position = polygons.position(vertex);
            seen.insert(place(polygons, vertex))
                .then_some(VertexPoint { vertex, position })
        });
        let tree = KdTree::build(points.collect()).expect("finite points, not more than vertices");
        Self {
            polygons,
            vertices,
            tree,
        }
    }

    /// Returns the distance from each vertex to its nearest neighbour, where this is narrow but not
    /// zero.
    fn gaps(&self) -> Vec<f64> {
        let gap = |&(v, length): &(VertexId, f64)| {
            let at = self.polygons.position(v);
            let is_other = |near| self.polygons.position(near) != at;
            let nearest = self.tree.nearest_where(at, NARROW * length, is_other);
            nearest.map(|near| near.distance())
        };
        self.vertices.iter().filter_map(gap).collect()
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
            let welded = repair(&cracked, &crack.repairs()).expect("a good tolerance").polygons;
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

    /// Returns a grid of `n` × `n` unit squares from a corner on.
    fn sheet(n: u32, from: [f32; 3]) -> PolygonMesh {
        let points = (0..(n + 1) * (n + 1)).map(|i| {
            let [x, y] = [i % (n + 1), i / (n + 1)].map(|x| x as f32);
            [from[0] + x, from[1] + y, from[2]]
        });
        let quads = (0..n * n).map(|i| {
            let corner = i / n * (n + 1) + i % n;
            [corner, corner + 1, corner + n + 2, corner + n + 1]
        });
        PolygonMesh::new(points, quads).expect("valid")
    }

    /// Returns a closed box with six quads.
    fn solid(size: [f32; 3], from: [f32; 3]) -> PolygonMesh {
        let cube = sixfold_shapes::cube();
        let points = cube.positions().iter().map(|p| {
            let p = 0.5 * (*p + Point::ONE);
            p * Point::from_array(size) + Point::from_array(from)
        });
        PolygonMesh::from_faces(points.collect(), cube.faces().clone()).expect("valid")
    }

    fn assert_no_advice(mesh: &PolygonMesh) -> Crack {
        let diagnosis = diagnose(mesh, 0);
        let crack = diagnosis.crack.expect("edges nearly meet");
        assert!(!crack.is_safe(), "{crack:?}");
        assert_eq!(diagnosis.wide_crack(), None);
        assert_eq!(diagnosis.repairs(crate::FaultKind::BoundaryEdge), []);
        crack
    }

    /// The numbers of a crack are the differences that the weld makes.
    fn assert_true(mesh: &PolygonMesh, crack: Crack) {
        let welded = repair(mesh, &crack.repairs())
            .expect("a good tolerance")
            .polygons;
        let [before, after] = [mesh, &welded].map(Facts::from_polygons);
        let closed = before.boundary_edges - after.boundary_edges;
        assert_eq!(crack.edges, closed, "{crack:?}");
        let more = after.non_manifold_edges - before.non_manifold_edges;
        assert_eq!(crack.non_manifold_edges, more, "{crack:?}");
        assert_eq!(after.inconsistent_edges, 0, "{crack:?}");
    }

    /// Returns a mesh whose faces are on the other side.
    fn reversed(mesh: &PolygonMesh) -> PolygonMesh {
        let faces = mesh.faces().iter().map(|(_, face)| face.iter().rev());
        let faces: Vec<Vec<u32>> = faces
            .map(|face| face.map(|&v| v.into()).collect())
            .collect();
        PolygonMesh::new(mesh.positions().iter().copied(), faces).expect("valid")
    }

    #[test]
    fn parallel_sheets_are_not_welded() {
        let below = reversed(&sheet(20, [0.0, 0.0, -0.01]));
        let sheets = [sheet(20, [0.0; 3]), below];
        let sheets = crate::orientation::tests::together(&sheets);
        let crack = assert_no_advice(&sheets);
        assert_eq!(crack.collapsed_faces, 400);
        // Beside each other, they are welded.
        let sheets = [sheet(20, [0.0; 3]), sheet(20, [20.01, 0.0, 0.0])];
        let sheets = crate::orientation::tests::together(&sheets);
        let crack = diagnose(&sheets, 0).crack.expect("edges nearly meet");
        assert!(crack.is_safe() && crack.edges == 40, "{crack:?}");
        assert_eq!(crack.same_direction, 0);
        assert_true(&sheets, crack);
    }

    /// Two sheets of which one is turned: their rims run in the same direction.
    #[test]
    fn rims_in_the_same_direction_are_a_crack() {
        let right = sheet(20, [20.01, 0.0, 0.0]);
        let turned = right.faces().iter().map(|(_, face)| {
            let turned = face.iter().rev();
            turned.map(|&v| v.into()).collect()
        });
        let turned: Vec<Vec<u32>> = turned.collect();
        let right = PolygonMesh::new(right.positions().iter().copied(), turned).expect("valid");
        let sheets = crate::orientation::tests::together(&[sheet(20, [0.0; 3]), right]);
        let crack = diagnose(&sheets, 0).crack.expect("edges nearly meet");
        assert!(crack.is_safe(), "{crack:?}");
        assert_eq!((crack.edges, crack.same_direction), (40, 20));
        assert_true(&sheets, crack);
    }

    /// Returns pairs of unit squares beside each other, with these gaps.
    fn pairs(gaps: impl Iterator<Item = f32>) -> Vec<PolygonMesh> {
        let pair = |(gap, i): (f32, u8)| {
            let y = 10.0 * f32::from(i);
            [sheet(1, [0.0, y, 0.0]), sheet(1, [1.0 + gap, y, 0.0])]
        };
        gaps.zip(0..).flat_map(pair).collect()
    }

    fn crack_of(parts: &[PolygonMesh]) -> Option<Crack> {
        diagnose(&crate::orientation::tests::together(parts), 0).crack
    }

    #[test]
    fn a_safe_weld_is_preferred_if_it_closes_half_of_the_edges() {
        // The wide gaps close only together with a small cube. The triangle is no reason against a weld: it
        // has two corners at one place, and three edges less after it.
        let corners = [[0.0, 5.0, 0.0], [-0.0, 5.0, 0.0], [1.0, 6.0, 0.0]];
        let triangle = PolygonMesh::new(corners, [[0, 1, 2]]).expect("valid");
        for (narrow, wide, is_safe) in [(1, 1, true), (3, 3, true), (1, 3, false)] {
            let gaps = std::iter::repeat_n(0.0098, narrow);
            let mut parts = pairs(gaps.chain(std::iter::repeat_n(0.049, wide)));
            parts.extend([solid([0.04; 3], [50.0, 0.0, 0.0]), triangle.clone()]);
            let crack = crack_of(&parts).expect("edges nearly meet");
            let (pairs, distances) = match is_safe {
                true => (narrow, 0.0098..0.01),
                false => (narrow + wide, 0.049..0.051),
            };
            assert_eq!((crack.is_safe(), crack.edges), (is_safe, 2 * pairs + 3));
            assert!(distances.contains(&crack.distance), "{crack:?}");
        }
    }

    #[test]
    fn wide_gaps_stay_open() {
        // As a part of the edges.
        let small = crate::orientation::tests::together(&pairs([0.5].into_iter()));
        let points = small.positions().iter().map(|&p| 0.1 * p);
        let small = PolygonMesh::from_faces(points.collect(), small.faces().clone());
        assert_eq!(crack_of(&[small.expect("the same faces")]), None);
        // Against the others.
        let parts = pairs([0.001, 0.001, 0.001, 0.05].into_iter());
        let crack = crack_of(&parts).expect("edges nearly meet");
        assert_eq!((crack.is_safe(), crack.edges), (true, 6), "{crack:?}");
        // All corners of the square in the middle are at gaps.
        let row = [0.0, 1.01, 2.02].map(|x| sheet(1, [x, 0.0, 0.0]));
        let crack = crack_of(&row).expect("edges nearly meet");
        assert_eq!((crack.is_safe(), crack.edges), (true, 4), "{crack:?}");
    }

    #[test]
    fn edges_with_faces_on_different_sides_are_cracks_and_corners_are_not() {
        // The faces are on different sides: one of them must be turned.
        let flipped = |mut pair: Vec<PolygonMesh>, i: usize| {
            pair[i] = reversed(&pair[i]);
            pair
        };
        for i in [0, 1] {
            let mut parts = flipped(pairs([0.01].into_iter()), i);
            let crack = crack_of(&parts).expect("edges nearly meet");
            assert_eq!((crack.edges, crack.same_direction), (2, 1));
            parts.extend([sheet(1, [20.0, 0.0, 0.0]), sheet(1, [21.01, 0.0, 0.0])]);
            let crack = crack_of(&parts).expect("edges nearly meet");
            assert_eq!((crack.edges, crack.same_direction), (4, 1));
        }
        let at_a_corner = [sheet(1, [0.0; 3]), sheet(1, [1.01, 1.01, 0.0])];
        assert_eq!(crack_of(&at_a_corner), None);
    }

    #[test]
    fn a_weld_that_harms_closed_parts_is_not_advised() {
        let sheets = [sheet(1, [0.0; 3]), sheet(1, [1.02, 0.0, 0.0])];
        let far = |distance: f32| [10.0 + distance, 10.0, 0.0];
        let together = |closed: &[PolygonMesh]| {
            crate::orientation::tests::together(&[&sheets[..], closed].concat())
        };
        let is_found = |crack: Crack| (0.02..0.021).contains(&crack.distance) && crack.edges == 2;
        // Two cubes with a narrow gap become one, a thin plate and a tiny cube collapse.
        let cubes = [solid([1.0; 3], far(0.0)), solid([1.0; 3], far(1.01))];
        let open = |mesh: &PolygonMesh| diagnose(mesh, 0);
        for (closed, [collapsed, non_manifold]) in [
            (&cubes[..], [1, 4]),
            (&[solid([1.0, 1.0, 0.01], far(0.0))][..], [5, 1]),
            (&[solid([0.01; 3], far(0.0))][..], [6, 0]),
        ] {
            let mesh = together(closed);
            let crack = open(&mesh).crack.expect("edges nearly meet");
            assert!(is_found(crack) && !crack.is_safe(), "{crack:?}");
            assert_eq!(open(&mesh).wide_crack(), None);
            assert_eq!(
                (crack.collapsed_faces > 0, crack.non_manifold_edges > 0),
                (collapsed > 0, non_manifold > 0),
                "{crack:?}"
            );
        }
        let mesh = together(&[solid([1.0; 3], far(0.0))]);
        let crack = open(&mesh).crack.expect("edges nearly meet");
        assert!(is_found(crack) && crack.is_safe(), "{crack:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Sheets and boxes at random places near each other: if a weld is advised, it makes no
        /// non-manifold edge and removes no face.
        #[test]
        fn advised_welds_do_no_harm(
            places in proptest::collection::vec((any::<bool>(), prop::array::uniform3(0..2_u8), prop::array::uniform3(-3..4_i8)), 2..6),
        ) {
            let parts = places.iter().map(|(is_solid, place, shift)| {
                let from = [0, 1, 2].map(|i| f32::from(place[i]) + 0.01 * f32::from(shift[i]));
                if *is_solid { solid([1.0; 3], from) } else { sheet(1, from) }
            });
            let mesh = crate::orientation::tests::together(&parts.collect::<Vec<_>>());
            if let Some(crack) = diagnose(&mesh, 0).crack.filter(Crack::is_safe) {
                let welded = repair(&mesh, &crack.repairs()).expect("a good tolerance").polygons;
                let facts = Facts::from_polygons(&welded);
                prop_assert_eq!(facts.non_manifold_edges, 0);
                prop_assert_eq!(welded.face_count(), mesh.face_count());
                prop_assert_eq!(facts.duplicate_faces, 0);
                prop_assert!(boundary_edges(&mesh) - facts.boundary_edges >= crack.edges);
            }
        }
    }
}

//! Triangulation: cuts polygons into triangles on the same vertices.

use glam::DVec3;
use sixfold_core::{FaceList, HandleMap, HashHandleMap, Pair, PolygonError, PolygonMesh, VertexId};

use crate::ear_clipping::EarClipping;

sixfold_core::named! {
    /// The method that cuts a polygon into triangles.
    #[derive(Default)]
    pub enum Triangulation: "triangulation method" {
        /// A fan of triangles from the first corner. This method is fast, but correct only for
        /// convex faces.
        Fan = "fan",
        /// Ear clipping (Meisters 1975). This method is correct for every simple polygon.
        #[default]
        EarClipping = "ears",
    }
}

/// Returns the mesh in which each polygon of `n` corners is replaced by `n − 2` triangles.
///
/// ```text
///    d ─────── c           d ─────── c
///     ╲        │            ╲    ╱   │      The fan from a is a b c, a c d, a d e: the second
///      e       │     ⇒       e       │      extends over the hollow at e, and the third is turned
///     ╱        │            ╱    ╲   │      over. Ear clipping avoids both.
///    a ─────── b           a ─────── b
/// ```
///
/// The result has the same vertices. Triangles have the orientation of their polygon. A face with
/// three corners is unchanged. [`EarClipping`](Triangulation::EarClipping) has these additional
/// properties:
///
/// - The triangles of a simple planar polygon do not overlap and are not flat, even if some corners
///   of the polygon are collinear. A polygon that is not planar is projected along the axis nearest
///   to its Newell normal.
/// - A polygon that is not simple also gets `n − 2` triangles, but these triangles may overlap or
///   be flat.
/// - An ear is a triangle at a convex corner whose third side (the diagonal) runs inside the
///   polygon. The ear with the best shape is cut first.
/// - Ear clipping avoids diagonals that are already edges of the mesh, because these edges would
///   then have three or more faces. If the diagonal of every ear of a polygon is already an edge,
///   one of the ears is cut anyway. Structures that hold only manifolds then reject the mesh with
///   an error that names the edge.
///
/// # Errors
///
/// Returns [`PolygonError::TooMany`] if the triangles have more corners than 32-bit indices can
/// number.
///
/// # Complexity
///
/// A fan takes O(corners) time. Ear clipping takes O(n·(r + log n)) time for a face with `n`
/// corners, of which `r` corners are not convex; the worst case is O(n²).
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh};
/// use sixfold_operators::{Triangulation, triangulated};
///
/// // An arrow head, not convex at v3: the only diagonal inside is v1–v3.
/// let points = [[0.0, 0.0], [2.0, -1.0], [0.0, 2.0], [0.5, 0.5]].map(|[x, y]| Point::new(x, y, 0.0));
/// let arrow = PolygonMesh::new(points, [[0, 1, 2, 3]])?;
/// let ears = triangulated(&arrow, Triangulation::EarClipping)?;
/// assert!(ears.faces().iter().all(|(_, face)| {
///     face.iter().any(|v| v.index() == 1) && face.iter().any(|v| v.index() == 3)
/// }));
/// # Ok::<(), sixfold_core::PolygonError>(())
/// ```
pub fn triangulated(
    polygons: &PolygonMesh,
    method: Triangulation,
) -> Result<PolygonMesh, PolygonError> {
    match method {
        Triangulation::Fan => polygons.fan_triangulated(),
        Triangulation::EarClipping => clip_ears(polygons),
    }
}

/// Cuts one polygon of `n` corners into `n − 2` triangles by ear clipping. Each triangle consists
/// of three corner numbers from 0 to `n − 1`, in the orientation of the polygon.
///
/// `is_edge` returns whether a diagonal between two corner numbers is already an edge of the mesh.
/// An ear with such a diagonal is cut only if the polygon has no other ear at that moment.
/// [`triangulated`] describes the result and the time for each kind of polygon.
pub fn clipped_polygon(
    corners: impl IntoIterator<Item = DVec3>,
    is_edge: impl Fn(usize, usize) -> bool,
) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    EarClipping::default().clip(corners.into_iter(), is_edge, |cut| triangles.push(cut));
    triangles
}

fn clip_ears(polygons: &PolygonMesh) -> Result<PolygonMesh, PolygonError> {
    let mut edges = possible_diagonals(polygons.faces(), polygons.vertex_count());
    let mut triangles = FaceList::with_capacity(polygons.corner_count());
    let mut clipping = EarClipping::default();
    let mut cut = Vec::new();
    for (_, face) in polygons.faces().iter() {
        if face.len() == 3 {
            triangles.push(face.iter().copied())?;
            continue;
        }
        let corners = face.iter().map(|&v| polygons.position(v).as_dvec3());
        let is_edge = |i: usize, j: usize| edges[Pair::new(face[i], face[j])];
        cut.clear();
        clipping.clip(corners, is_edge, |triangle| cut.push(triangle));
        for &triangle in &cut {
            let [a, b, c] = triangle.map(|i| face[i]);
            triangles.push([a, b, c])?;
            edges[Pair::new(c, a)] = true;
        }
    }
    PolygonMesh::from_faces(polygons.positions().to_vec(), triangles)
}

/// Returns the edges between two corners of polygons with more than three corners.
fn possible_diagonals(faces: &FaceList, vertices: usize) -> HashHandleMap<Pair<VertexId>, bool> {
    let mut edges = HashHandleMap::filled(0, false);
    let mut on_polygon = vec![false; vertices];
    for (_, face) in faces.iter().filter(|(_, face)| face.len() > 3) {
        face.iter().for_each(|v| on_polygon[v.index()] = true);
    }
    for (_, face) in faces.iter() {
        for side in Pair::sides(face.len(), |i| face[i]) {
            if side.ends().iter().all(|v| on_polygon[v.index()]) {
                edges[side] = true;
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use proptest::prelude::*;
    use sixfold_core::{Capabilities, FaceId, Point};

    use super::*;

    fn polygon(points: &[[f32; 2]]) -> PolygonMesh {
        let points: Vec<Point> = points.iter().map(|&[x, y]| Point::new(x, y, 0.0)).collect();
        one_face(points)
    }

    fn one_face(points: Vec<Point>) -> PolygonMesh {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        PolygonMesh::new(points, [corners]).expect("valid")
    }

    fn ears(polygons: &PolygonMesh) -> PolygonMesh {
        triangulated(polygons, Triangulation::EarClipping).expect("small")
    }

    fn areas(mesh: &PolygonMesh) -> Vec<DVec3> {
        let at = |v: VertexId| mesh.position(v).as_dvec3();
        let area = |face: &[VertexId]| -> DVec3 {
            let fan = face[1..].windows(2);
            fan.map(|pair| (at(pair[0]) - at(face[0])).cross(at(pair[1]) - at(face[0])))
                .sum()
        };
        mesh.faces().iter().map(|(_, face)| area(face)).collect()
    }

    /// Checks that each side occurs once, and each diagonal once in each direction.
    fn assert_partition(mesh: &PolygonMesh, triangles: &PolygonMesh) {
        let sides = |mesh: &PolygonMesh| {
            let mut sides = Vec::new();
            for (_, face) in mesh.faces().iter() {
                let next = face.iter().cycle().skip(1);
                sides.extend(face.iter().zip(next).map(|(&a, &b)| (a, b)));
            }
            sides
        };
        let (whole, mut cut) = (sides(mesh), sides(triangles));
        for side in whole {
            let at = cut
                .iter()
                .position(|&s| s == side)
                .expect("every side of the polygon");
            cut.swap_remove(at);
        }
        while let Some((a, b)) = cut.pop() {
            let back = cut
                .iter()
                .position(|&s| s == (b, a))
                .expect("a diagonal both ways");
            cut.swap_remove(back);
        }
    }

    /// Checks that the triangles cover the polygon without overlap. If `exact`, no triangle may be
    /// flat.
    fn assert_covered(mesh: &PolygonMesh, exact: bool) {
        let triangles = ears(mesh);
        let whole: DVec3 = areas(mesh).into_iter().sum();
        assert_eq!(
            triangles.face_count(),
            mesh.corner_count() - 2 * mesh.face_count()
        );
        assert_partition(mesh, &triangles);
        let parts = areas(&triangles);
        let least = if exact { 0.0 } else { -1e-6 * whole.length() };
        assert!(
            parts.iter().all(|part| part.dot(whole.normalize()) > least),
            "{parts:?}"
        );
        let size: f64 = parts.iter().map(|part| part.length()).sum();
        assert!(
            (size / whole.length() - 1.0).abs() < 1e-5,
            "{size} of {}",
            whole.length()
        );
    }

    /// Bars side by side; most corners are collinear.
    fn histogram() -> impl Strategy<Value = Vec<[f32; 2]>> {
        collection::vec(1..5_u8, 1..9).prop_map(|heights| {
            let width = heights.len();
            let mut points: Vec<[f32; 2]> = (0..=width).map(|x| [x as f32, 0.0]).collect();
            let mut height = 0;
            for (x, &to) in heights.iter().enumerate().rev() {
                while height != to {
                    height = if height < to { height + 1 } else { height - 1 };
                    points.push([x as f32 + 1.0, f32::from(height)]);
                }
                points.push([x as f32, f32::from(height)]);
            }
            for height in (1..height).rev() {
                points.push([0.0, f32::from(height)]);
            }
            points
        })
    }

    fn spiral(corners: usize, turns: f64) -> Vec<[f32; 2]> {
        let arm = |i: usize, width: f64| {
            let t = i as f64 / corners as f64;
            let (sin, cos) = (t * turns * std::f64::consts::TAU).sin_cos();
            let radius = 1.0 + turns * t + width;
            [(radius * cos) as f32, (radius * sin) as f32]
        };
        let out = (0..corners).map(|i| arm(i, 0.4));
        let back = (0..corners).rev().map(|i| arm(i, 0.0));
        out.chain(back).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// With integer coordinates, nothing is rounded.
        #[test]
        fn histograms_in_any_plane_are_covered(
            outline in histogram(),
            axes in prop::array::uniform2(prop::array::uniform3(-4..5_i8)),
            start in 0..40_usize,
        ) {
            let [u, v] = axes.map(|axis| Point::from_array(axis.map(f32::from)));
            prop_assume!(u.cross(v) != Point::ZERO);
            let mut points: Vec<Point> = outline.iter().map(|&[x, y]| x * u + y * v).collect();
            let start = start % points.len();
            points.rotate_left(start);
            assert_covered(&one_face(points), true);
        }

        #[test]
        fn stars_are_covered(
            radii in collection::vec(0.05_f64..1.0, 5..40),
            tilt in prop::array::uniform3(-1.0_f32..1.0),
        ) {
            let tilt = Point::from_array(tilt);
            prop_assume!(tilt.length() > 0.1);
            let (u, v) = tilt.normalize().any_orthonormal_pair();
            let points = radii.iter().enumerate().map(|(i, &radius)| {
                let angle = std::f64::consts::TAU * i as f64 / radii.len() as f64;
                (radius * angle.cos()) as f32 * u + (radius * angle.sin()) as f32 * v
            });
            assert_covered(&one_face(points.collect()), false);
        }

        /// Includes polygons that cross themselves, lie on a line or lie in a point.
        #[test]
        fn any_polygon_is_partitioned(
            points in collection::vec(prop::array::uniform3(-2..3_i8), 4..30),
            flat in any::<[bool; 3]>(),
        ) {
            let point = |p: &[i8; 3]| {
                let axis = |i: usize| if flat[i] { 0.0 } else { f32::from(p[i]) };
                Point::new(axis(0), axis(1), axis(2))
            };
            let mesh = one_face(points.iter().map(point).collect());
            let triangles = ears(&mesh);
            prop_assert_eq!(triangles.face_count(), points.len() - 2);
            assert_partition(&mesh, &triangles);
        }
    }

    #[test]
    fn short_and_long_spirals_are_covered() {
        assert_covered(&polygon(&spiral(60, 3.0)), true);
        assert_covered(&polygon(&spiral(1500, 40.0)), false);
    }

    /// The outline runs twice along the bridge from the square to its hole.
    #[test]
    fn a_polygon_with_a_bridge_to_a_hole_is_covered() {
        let outline = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ];
        for start in 0..outline.len() {
            let mut outline = outline;
            outline.rotate_left(start);
            assert_covered(&polygon(&outline), true);
        }
    }

    #[test]
    fn large_degenerate_polygons_are_partitioned() {
        let line: Vec<[f32; 2]> = (0..1500).map(|i| [(i * 7 % 1500) as f32, 0.0]).collect();
        let zigzag: Vec<[f32; 2]> = (0..1500)
            .map(|i| [(i * 611 % 997) as f32, (i * i % 991) as f32])
            .collect();
        for points in [
            line,
            zigzag,
            vec![[f32::NAN; 2]; 300],
            vec![[f32::INFINITY; 2]; 300],
        ] {
            let mesh = polygon(&points);
            assert_eq!(ears(&mesh).face_count(), points.len() - 2);
        }
    }

    #[test]
    fn the_better_of_two_diagonals_is_cut() {
        let rhombus = polygon(&[[0.0, 0.0], [3.0, -1.0], [6.0, 0.0], [3.0, 1.0]]);
        let triangles = ears(&rhombus);
        for (_, face) in triangles.faces().iter() {
            assert!(
                [1, 3].map(VertexId::new).iter().all(|v| face.contains(v)),
                "{face:?}"
            );
        }
    }

    #[test]
    fn a_diagonal_that_is_an_edge_is_not_cut_again() {
        let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
        let pillow = PolygonMesh::new(square, [[0, 1, 2, 3], [3, 2, 1, 0]]).expect("valid");
        let triangles = ears(&pillow);
        assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
        // For a third square, both diagonals are already edges.
        let three = [[0, 1, 2, 3], [3, 2, 1, 0], [0, 1, 2, 3]];
        let three = PolygonMesh::new(square, three).expect("valid");
        assert_eq!(ears(&three).face_count(), 6);
    }

    #[test]
    fn triangles_stay_and_a_fan_equals_fan_triangulated() {
        let icosahedron = sixfold_shapes::icosahedron();
        assert_eq!(ears(&icosahedron), icosahedron);
        let prism = sixfold_shapes::prism(7).expect("small");
        let fan = triangulated(&prism, Triangulation::Fan);
        assert_eq!(fan, prism.fan_triangulated());
        let triangles = ears(&prism);
        assert_eq!(triangles.face_count(), 2 * 7 + 2 * 5);
        assert_eq!(triangles.faces().face(FaceId::new(0)).len(), 3);
        assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
    }
}

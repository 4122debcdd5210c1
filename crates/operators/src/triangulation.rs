//! Triangulation: polygons into triangles on the same vertices.

use mesh_core::{FaceList, HandleMap, HashHandleMap, Pair, PolygonError, PolygonMesh, VertexId};

use crate::ear_clipping::EarClipping;

/// How polygons are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Triangulation {
    /// In a fan from the first corner: quick, and right for convex faces alone.
    Fan,
    /// By cutting ears (Meisters 1975): right for every simple polygon.
    #[default]
    EarClipping,
}

/// The mesh with every polygon of `n` corners cut into `n − 2` triangles, which take its place.
///
/// ```text
///    d ─────── c           d ─────── c
///     ╲        │            ╲    ╱   │      The fan from a is a b c, a c d, a d e: the second
///      e       │     ⇒       e       │      runs over the hollow at e, and the third is turned
///     ╱        │            ╱    ╲   │      over. Ears never do.
///    a ─────── b           a ─────── b
/// ```
///
/// No vertex is added, triangles run the way of their polygon, and faces that are triangles stay as
/// they are. Of [`EarClipping`](Triangulation::EarClipping) there is more to say:
///
/// - The triangles of a simple polygon in a plane do not overlap and none is flat, wherever its
///   corners lie, on a line too. A bent polygon is seen along the axis nearest to its Newell normal.
/// - A polygon that is not simple gets `n − 2` triangles too, which may overlap or be flat.
/// - Of all ears the best shaped is cut first.
/// - A diagonal that is an edge elsewhere in the mesh would have three faces or more. Ears with such
///   diagonals are cut only where a polygon has no other at that moment; the triangulated mesh then
///   has an edge that structures for manifolds refuse by name. Earlier polygons choose first.
///
/// # Errors
///
/// [`PolygonError::TooMany`] where the triangles have more corners than have names.
///
/// # Complexity
///
/// O(corners) for fans; ears of a face of `n` corners, of which `r` are not convex, take
/// O(n·(r + log n)), and O(n²) at worst.
///
/// # Examples
///
/// ```
/// use mesh_core::{Point, PolygonMesh};
/// use operators::{Triangulation, triangulated};
///
/// // An arrow head, hollow at v3: the only diagonal inside is v1–v3.
/// let points = [[0.0, 0.0], [2.0, -1.0], [0.0, 2.0], [0.5, 0.5]].map(|[x, y]| Point::new(x, y, 0.0));
/// let arrow = PolygonMesh::new(points, [[0, 1, 2, 3]])?;
/// let ears = triangulated(&arrow, Triangulation::EarClipping)?;
/// assert!(ears.faces().iter().all(|(_, face)| {
///     face.iter().any(|v| v.index() == 1) && face.iter().any(|v| v.index() == 3)
/// }));
/// # Ok::<(), mesh_core::PolygonError>(())
/// ```
pub fn triangulated(
    polygons: &PolygonMesh,
    method: Triangulation,
) -> Result<PolygonMesh, PolygonError> {
    match method {
        Triangulation::Fan => polygons.fan_triangulated(),
        Triangulation::EarClipping => ears_cut(polygons),
    }
}

fn ears_cut(polygons: &PolygonMesh) -> Result<PolygonMesh, PolygonError> {
    let mut edges = edges_between_polygons(polygons.faces(), polygons.vertex_count());
    let mut triangles = FaceList::with_capacity(polygons.corner_count());
    let mut clipping = EarClipping::default();
    let mut cut = Vec::new();
    for (_, face) in polygons.faces().iter() {
        if face.len() == 3 {
            triangles.push(face.iter().copied())?;
            continue;
        }
        let corners = face.iter().map(|&v| polygons.position(v).as_dvec3());
        let taken = |i: usize, j: usize| edges[Pair::new(face[i], face[j])];
        cut.clear();
        clipping.clip(corners, taken, |triangle| cut.push(triangle));
        for &triangle in &cut {
            let [a, b, c] = triangle.map(|i| face[i]);
            triangles.push([a, b, c])?;
            edges[Pair::new(c, a)] = true;
        }
    }
    PolygonMesh::from_faces(polygons.positions().to_vec(), triangles)
}

/// The edges that could be diagonals of a polygon: both their ends are corners of polygons.
fn edges_between_polygons(
    faces: &FaceList,
    vertices: usize,
) -> HashHandleMap<Pair<VertexId>, bool> {
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
    use glam::DVec3;
    use mesh_core::{Capabilities, FaceId, Point};
    use proptest::collection;
    use proptest::prelude::*;

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

    /// Twice the area of each face, as vectors.
    fn areas(mesh: &PolygonMesh) -> Vec<DVec3> {
        let at = |v: VertexId| mesh.position(v).as_dvec3();
        let area = |face: &[VertexId]| -> DVec3 {
            let fan = face[1..].windows(2);
            fan.map(|pair| (at(pair[0]) - at(face[0])).cross(at(pair[1]) - at(face[0])))
                .sum()
        };
        mesh.faces().iter().map(|(_, face)| area(face)).collect()
    }

    /// The sides of the triangles are those of the polygon, and diagonals run once each way.
    fn cuts_up(mesh: &PolygonMesh, triangles: &PolygonMesh) {
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

    /// All triangles lie as the polygon does, none is flat, and together they are as large: so they
    /// cover it, and none overlap.
    fn covers(mesh: &PolygonMesh, exact: bool) {
        let triangles = ears(mesh);
        let whole: DVec3 = areas(mesh).into_iter().sum();
        assert_eq!(
            triangles.face_count(),
            mesh.corner_count() - 2 * mesh.face_count()
        );
        cuts_up(mesh, &triangles);
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

    /// Bars side by side, with a corner at every whole number on the way around: most are on lines.
    fn skyline() -> impl Strategy<Value = Vec<[f32; 2]>> {
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

    /// Two arms of `turns` turns around each other and back.
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

        /// Whole coordinates in whole planes: nothing is rounded, and nothing may be flat.
        #[test]
        fn skylines_in_any_plane_are_covered(
            outline in skyline(),
            axes in prop::array::uniform2(prop::array::uniform3(-4..5_i8)),
            start in 0..40_usize,
        ) {
            let [u, v] = axes.map(|axis| Point::from_array(axis.map(f32::from)));
            prop_assume!(u.cross(v) != Point::ZERO);
            let mut points: Vec<Point> = outline.iter().map(|&[x, y]| x * u + y * v).collect();
            let start = start % points.len();
            points.rotate_left(start);
            covers(&one_face(points), true);
        }

        /// Around a centre at rising angles, near and far: simple, and mostly hollow.
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
            covers(&one_face(points.collect()), false);
        }

        /// Whatever the polygon: crossing itself, on one line, in one point.
        #[test]
        fn any_polygon_is_cut_up(
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
            cuts_up(&mesh, &triangles);
        }
    }

    #[test]
    fn spirals_are_covered_however_long() {
        covers(&polygon(&spiral(60, 3.0)), true);
        covers(&polygon(&spiral(1500, 40.0)), false);
    }

    /// A square with a square hole, and a slit between them that the outline runs twice.
    #[test]
    fn a_slit_to_a_hole_is_run_along_both_sides() {
        let slit = [
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
        for start in 0..slit.len() {
            let mut slit = slit;
            slit.rotate_left(start);
            covers(&polygon(&slit), true);
        }
    }

    #[test]
    fn corners_that_are_nowhere_or_on_a_line_are_cut_up_in_time() {
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

    /// Two squares back to back: the second may not take the diagonal of the first.
    #[test]
    fn a_diagonal_that_is_an_edge_is_not_cut_again() {
        let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
        let pillow = PolygonMesh::new(square, [[0, 1, 2, 3], [3, 2, 1, 0]]).expect("valid");
        let triangles = ears(&pillow);
        assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
        // A third square has no diagonal left, and takes one of the two.
        let three = [[0, 1, 2, 3], [3, 2, 1, 0], [0, 1, 2, 3]];
        let three = PolygonMesh::new(square, three).expect("valid");
        assert_eq!(ears(&three).face_count(), 6);
    }

    #[test]
    fn triangles_stay_and_a_fan_is_the_fan() {
        let icosahedron = shapes::icosahedron();
        assert_eq!(ears(&icosahedron), icosahedron);
        let prism = shapes::prism(7).expect("small");
        let fan = triangulated(&prism, Triangulation::Fan);
        assert_eq!(fan, prism.fan_triangulated());
        let lid = ears(&prism);
        assert_eq!(lid.face_count(), 2 * 7 + 2 * 5);
        assert_eq!(lid.faces().face(FaceId::new(0)).len(), 3);
        assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&lid), Ok(()));
    }
}

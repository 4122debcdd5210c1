//! Tests with polygons of known area.

use std::collections::HashMap;

use proptest::collection;
use proptest::prelude::*;
use proptest::sample::Index;
use sixfold_core::glam::DVec3;
use sixfold_core::{Capabilities, FaceId, Point, PolygonCutter, PolygonMesh, VertexId};

fn polygon(points: &[[f32; 2]]) -> PolygonMesh {
    let points: Vec<Point> = points.iter().map(|&[x, y]| Point::new(x, y, 0.0)).collect();
    one_face(points)
}

fn one_face(points: Vec<Point>) -> PolygonMesh {
    let corners: Vec<u32> = (0..points.len() as u32).collect();
    PolygonMesh::new(points, [corners]).expect("valid")
}

fn triangulated(polygons: &PolygonMesh) -> PolygonMesh {
    polygons.triangulated().expect("small").polygons
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
    let triangles = triangulated(mesh);
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
        let triangles = triangulated(&mesh);
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
        assert_eq!(triangulated(&mesh).face_count(), points.len() - 2);
    }
}

#[test]
fn the_better_of_two_diagonals_is_cut() {
    let rhombus = polygon(&[[0.0, 0.0], [3.0, -1.0], [6.0, 0.0], [3.0, 1.0]]);
    let triangles = triangulated(&rhombus);
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
    let triangles = triangulated(&pillow);
    assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
    // For a third square, both diagonals are already edges.
    let three = [[0, 1, 2, 3], [3, 2, 1, 0], [0, 1, 2, 3]];
    let three = PolygonMesh::new(square, three).expect("valid");
    assert_eq!(triangulated(&three).face_count(), 6);
}

#[test]
fn triangles_stay() {
    let icosahedron = sixfold_shapes::icosahedron();
    assert_eq!(triangulated(&icosahedron), icosahedron);
    let prism = sixfold_shapes::prism(7).expect("small");
    let triangles = triangulated(&prism);
    assert_eq!(triangles.face_count(), 2 * 7 + 2 * 5);
    assert_eq!(triangles.faces().face(FaceId::new(0)).len(), 3);
    assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
}

/// Random corners that touch themselves, on a grid, with the area.
///
/// The outline goes around cells of a grid that hang together by their sides. Cells that meet in a
/// point make corners at the same position. Holes are joined to the outline by bridges along the
/// lines of the grid, and spikes run out and back along these lines.
#[derive(Clone, Debug)]
struct Outline {
    corners: Vec<[i32; 2]>,
    area: i32,
}

const SIZE: i32 = 6;

/// The directions of the grid, counter-clockwise.
const STEPS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

fn step([x, y]: [i32; 2], direction: usize) -> [i32; 2] {
    let [dx, dy] = STEPS[direction % 4];
    [x + dx, y + dy]
}

struct Cells(Vec<bool>);

impl Cells {
    fn has(&self, [x, y]: [i32; 2]) -> bool {
        let inside = (0..SIZE).contains(&x) && (0..SIZE).contains(&y);
        inside && self.0[(y * SIZE + x) as usize]
    }

    /// Returns the cell to the left of the side from `at` in a direction.
    fn left([x, y]: [i32; 2], direction: usize) -> [i32; 2] {
        match direction % 4 {
            0 => [x, y],
            1 => [x - 1, y],
            2 => [x - 1, y - 1],
            _ => [x, y - 1],
        }
    }

    /// Returns whether a side of the outline starts at `at` in a direction: it has a cell on its left
    /// and none on its right.
    fn is_side(&self, at: [i32; 2], direction: usize) -> bool {
        let right = Self::left(step(at, direction), direction + 2);
        self.has(Self::left(at, direction)) && !self.has(right)
    }

    /// Keeps only the cells that hang together with `start`.
    fn keep_component(&mut self, start: [i32; 2]) {
        let index = |[x, y]: [i32; 2]| (y * SIZE + x) as usize;
        let mut kept = vec![false; self.0.len()];
        let mut open = vec![start];
        while let Some(cell) = open.pop() {
            if self.has(cell) && !std::mem::replace(&mut kept[index(cell)], true) {
                open.extend((0..4).map(|direction| step(cell, direction)));
            }
        }
        self.0 = kept;
    }

    /// Returns the closed lines around the cells, each as a list of points, one for each unit. Where
    /// two cells meet in a point, a line turns left or right by `turns_left`.
    fn loops(&self, turns_left: bool) -> Vec<Vec<[i32; 2]>> {
        let mut sides = HashMap::new();
        for x in 0..=SIZE {
            for y in 0..=SIZE {
                for direction in 0..4 {
                    if self.is_side([x, y], direction) {
                        sides.insert(([x, y], direction), ());
                    }
                }
            }
        }
        let mut starts: Vec<_> = sides.keys().copied().collect();
        starts.sort_unstable();
        let mut loops = Vec::new();
        for start in starts {
            let (mut at, mut direction) = start;
            let mut points = Vec::new();
            while sides.remove(&(at, direction)).is_some() {
                points.push(at);
                at = step(at, direction);
                let turns = match turns_left {
                    true => [1, 0, 3],
                    false => [3, 0, 1],
                };
                let next = turns.into_iter().map(|turn| (direction + turn) % 4);
                let mut next = next.filter(|&d| sides.contains_key(&(at, d)));
                direction = next.next().unwrap_or(direction);
            }
            if !points.is_empty() {
                loops.push(points);
            }
        }
        loops
    }
}

/// Joins all lines to one: walks in a direction from the farthest point of a hole until another line
/// is met, and inserts the hole there. Returns `None` if the bridge would run along another one.
fn join_loops(mut loops: Vec<Vec<[i32; 2]>>, direction: usize) -> Option<Vec<[i32; 2]>> {
    let key = |&[x, y]: &[i32; 2]| {
        let [dx, dy] = STEPS[direction];
        (dx * x + dy * y, x, y)
    };
    let outer = loops.iter().position(|points| doubled_area(points) > 0)?;
    loops.swap(0, outer);
    loops[1..].sort_by_key(|points| points.iter().map(key).max());
    while loops.len() > 1 {
        let hole = loops.pop()?;
        let from = (0..hole.len()).max_by_key(|&i| key(&hole[i]))?;
        let mut bridge = vec![hole[from]];
        let met = |at| loops.iter().position(|points| points.contains(&at));
        let other = loop {
            let at = *bridge.last()?;
            match met(at) {
                Some(other) => break &mut loops[other],
                None => bridge.push(step(at, direction)),
            }
        };
        let to = corner_towards(other, *bridge.last()?, (direction + 2) % 4)?;
        let back = bridge.iter().rev().copied();
        let around = hole.iter().copied().cycle().skip(from + 1).take(hole.len());
        let out = bridge.iter().copied().skip(1);
        let inserted: Vec<[i32; 2]> = back.chain(around).chain(out).collect();
        other.splice(to..=to, inserted);
    }
    loops.pop()
}

/// Returns the corner at the place `at` from which a line in a direction runs into the polygon.
fn corner_towards(points: &[[i32; 2]], at: [i32; 2], direction: usize) -> Option<usize> {
    let n = points.len();
    let towards = |to| (0..4).find(|&d| step(at, d) == to);
    (0..n).filter(|&i| points[i] == at).find(|&i| {
        let [before, after] = [i + n - 1, i + 1].map(|j| towards(points[j % n]));
        let (Some(before), Some(after)) = (before, after) else {
            return false;
        };
        let inside = match (before + 4 - after) % 4 {
            0 => 4,
            turn => turn,
        };
        (1..inside).contains(&((direction + 4 - after) % 4))
    })
}

fn doubled_area(points: &[[i32; 2]]) -> i32 {
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(&[x, y], &[to_x, to_y])| x * to_y - to_x * y)
        .sum()
}

fn touching_outline() -> impl Strategy<Value = Outline> {
    let cells = collection::vec(prop::bool::weighted(0.75), (SIZE * SIZE) as usize);
    let spikes = collection::vec((any::<Index>(), 0..4_usize, 1..4_usize), 0..4);
    let choices = (any::<bool>(), 0..4_usize, any::<bool>(), any::<Index>());
    (cells, choices, spikes).prop_filter_map("no outline", |(cells, choices, spikes)| {
        let (turns_left, direction, keeps_flat, start) = choices;
        let mut cells = Cells(cells);
        let mut all = (0..SIZE * SIZE).map(|i| [i % SIZE, i / SIZE]);
        let first = all.find(|&cell| cells.has(cell))?;
        cells.keep_component(first);
        let area = cells.0.iter().filter(|&&cell| cell).count() as i32;
        let mut corners = join_loops(cells.loops(turns_left), direction)?;
        for (at, direction, length) in spikes {
            let at = at.index(corners.len());
            add_spike(&mut corners, at, direction, length);
        }
        if !keeps_flat {
            remove_flat(&mut corners);
        }
        let start = start.index(corners.len());
        corners.rotate_left(start);
        Some(Outline { corners, area })
    })
}

/// Adds a spike at a corner that is the only one at its place. The spike ends before the outline.
fn add_spike(corners: &mut Vec<[i32; 2]>, at: usize, direction: usize, length: usize) {
    let from = corners[at];
    if corners.iter().filter(|&&p| p == from).count() > 1 {
        return;
    }
    let mut out = vec![from];
    for _ in 0..length {
        let next = step(out[out.len() - 1], direction);
        if corners.contains(&next) {
            break;
        }
        out.push(next);
    }
    let back: Vec<[i32; 2]> = out.iter().rev().skip(1).copied().collect();
    corners.splice(at..=at, out.into_iter().chain(back));
}

/// Removes corners between their neighbours on the same line.
fn remove_flat(corners: &mut Vec<[i32; 2]>) {
    let n = corners.len();
    let is_flat = |i: usize| {
        let [a, b, c] = [i + n - 1, i, i + 1].map(|j| corners[j % n]);
        [0, 1].map(|k| b[k] - a[k]) == [0, 1].map(|k| c[k] - b[k])
    };
    *corners = (0..n)
        .filter(|&i| !is_flat(i))
        .map(|i| corners[i])
        .collect();
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        cases: 2000,
        ..ProptestConfig::default()
    })]

    /// Coordinates are integers, so areas are exact.
    #[test]
    fn polygons_that_touch_themselves_are_covered(
        outline in touching_outline(),
        axes in prop::array::uniform2(prop::array::uniform3(-4..5_i8)),
    ) {
        let [u, v] = axes.map(|axis| DVec3::from_array(axis.map(f64::from)));
        let normal = u.cross(v);
        prop_assume!(normal != DVec3::ZERO);
        let corners = outline.corners.iter().map(|&[x, y]| f64::from(x) * u + f64::from(y) * v);
        let corners: Vec<DVec3> = corners.collect();
        let mut cutter = PolygonCutter::default();
        let cut = cutter.cut(corners.iter().copied(), |_, _| false);
        prop_assert!(!cut.is_crossing, "{:?}", outline.corners);
        prop_assert_eq!(cut.triangles.len(), corners.len() - 2);
        let areas = cut.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| corners[i]);
            (b - a).cross(c - a).dot(normal) / normal.length_squared() / 2.0
        });
        let areas: Vec<f64> = areas.collect();
        prop_assert!(areas.iter().all(|&area| area >= 0.0), "{:?}", outline.corners);
        let sum: f64 = areas.iter().sum();
        prop_assert!((sum - f64::from(outline.area)).abs() < 1e-9);
    }
}

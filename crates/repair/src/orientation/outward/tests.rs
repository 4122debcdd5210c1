use proptest::collection;
use proptest::prelude::*;
use sixfold_core::glam::{EulerRot, Quat};
use sixfold_core::{FaceList, Point};

use super::*;
use crate::orientation::tests::together;

/// Returns a cube or a sphere of half the width `half`.
fn shell(half: f32, centre: Point, is_sphere: bool) -> PolygonMesh {
    let shape = match is_sphere {
        true => sixfold_shapes::geodesic(3).expect("small"),
        false => sixfold_shapes::cube(),
    };
    let points = shape.positions().iter().map(|&p| half * p + centre);
    PolygonMesh::from_faces(points.collect(), shape.faces().clone()).expect("the same faces")
}

/// What is chosen for a shell: in which of its eight parts there are others, its shape, and whether a
/// second one crosses it.
type Choice = (u8, bool, bool);

/// Adds a shell and others in some of its parts, and so on in these; each with whether another crosses it.
fn nest(
    half: f32,
    centre: Point,
    levels: usize,
    choices: &mut impl Iterator<Item = Choice>,
    shells: &mut Vec<(PolygonMesh, bool)>,
) {
    let Some((parts, is_sphere, is_crossed)) = choices.next() else {
        return;
    };
    shells.push((shell(half, centre, is_sphere), is_crossed));
    if is_crossed {
        let shift = Point::new(0.03, 0.02, 0.01) * half;
        shells.push((shell(half, centre + shift, is_sphere), true));
    }
    for part in (0..8).filter(|part| levels > 1 && parts >> part & 1 == 1) {
        let to = [0, 1, 2].map(|i| if part >> i & 1 == 1 { 0.3 } else { -0.3 });
        let centre = centre + half * Point::from_array(to);
        nest(0.2 * half, centre, levels - 1, choices, shells);
    }
}

/// Returns whether a shell is around a point: its faces cover all directions (Van Oosterom & Strackee
/// 1983).
fn is_around(shell: &PolygonMesh, point: Point) -> bool {
    let shell = shell.triangulated().expect("small").polygons;
    let angles = shell.faces().iter().map(|(_, face)| {
        let [a, b, c] = [0, 1, 2].map(|i| (shell.position(face[i]) - point).as_dvec3().normalize());
        let height = a.dot(b.cross(c));
        2.0 * height.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    });
    angles.sum::<f64>().abs() > std::f64::consts::TAU
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn overlapping_boxes_are_those_that_meet_another(
        boxes in collection::vec((prop::array::uniform3(0..12_u8), prop::array::uniform3(0..4_u8)), 0..30),
    ) {
        let point = |p: [u8; 3]| Point::from_array(p.map(f32::from));
        let bounds = |&(low, size)| Bounds { low: point(low), high: point(low) + point(size) };
        let bounds: Vec<Bounds> = boxes.iter().map(bounds).collect();
        let meets = |i: usize| (0..bounds.len()).any(|j| i != j && bounds[i].meets(&bounds[j]));
        let expected: Vec<bool> = (0..bounds.len()).map(meets).collect();
        let some: Vec<Option<Bounds>> = bounds.iter().copied().map(Some).collect();
        prop_assert_eq!(overlapping(&some), expected);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn each_tetrahedron_that_touches_another_is_in_a_contact(
        tetrahedra in collection::vec(prop::array::uniform4(prop::array::uniform3(0..8_u8)), 2..9),
    ) {
        let tetrahedra: Vec<PolygonMesh> = tetrahedra
            .into_iter()
            .map(|corners| {
                let points = corners.map(|corner| corner.map(f32::from));
                let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
                PolygonMesh::new(points, faces).expect("valid")
            })
            .collect();
        let mesh = together(&tetrahedra);
        let incidence = Incidence::new(mesh.vertex_count(), mesh.faces(), |_| true);
        let agreement = Agreement::of_consistent(mesh.faces(), &incidence);
        let index = index(&mesh, &agreement, &vec![true; tetrahedra.len()]).expect("finite");
        let mut found = vec![false; tetrahedra.len()];
        for (one, other) in contacts(&index, &agreement, |_| true) {
            (found[one], found[other]) = (true, true);
        }
        let of = |triangle: &FaceTriangle<FaceId>| agreement.component(triangle.face);
        let mut expected = vec![false; tetrahedra.len()];
        for one in index.items() {
            let mut others = index.items().iter().filter(|other| of(other) != of(one));
            expected[of(one)] |=
                others.any(|other| triangles_touch(one.corners_f64(), other.corners_f64()));
        }
        prop_assert_eq!(found, expected);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The first hit of each ray says as much as all of its hits: how many shells are around one, or that
    /// one of them crosses another.
    #[test]
    fn depths_are_the_numbers_of_shells_around(
        choices in collection::vec((any::<u8>(), any::<bool>(), prop::bool::weighted(0.2)), 1..24),
        reverse in collection::vec(any::<bool>(), 1..9),
        turn in prop::array::uniform3(0.0_f32..6.0),
    ) {
        let mut shells = Vec::new();
        let mut choices = choices.into_iter();
        for i in 0..2 {
            nest(8.0, 20.0 * i as f32 * Point::X, 3, &mut choices, &mut shells);
        }
        let (shells, crossed): (Vec<PolygonMesh>, Vec<bool>) = shells.into_iter().unzip();
        let all = together(&shells);
        let [x, y, z] = turn;
        let turn = Quat::from_euler(EulerRot::XYZ, x, y, z);
        let points = all.positions().iter().map(|&p| turn * p);
        let mut faces = FaceList::default();
        for (f, face) in all.faces().iter() {
            let pushed = match reverse[f.index() % reverse.len()] {
                true => faces.push(face.iter().rev().copied()),
                false => faces.push(face.iter().copied()),
            };
            pushed.expect("as many as before");
        }
        let mesh = PolygonMesh::from_faces(points.collect(), faces).expect("the same corners");
        let incidence = Incidence::new(mesh.vertex_count(), mesh.faces(), |_| true);
        let agreement = Agreement::new(mesh.faces(), &incidence);
        let volumes = volumes(&mesh, &incidence, &agreement);
        let signs: Vec<f64> = volumes.iter().map(|volume| volume.signed).collect();
        let index = index(&mesh, &agreement, &vec![true; shells.len()]).expect("finite");

        let around = |inner: usize| {
            let point = shells[inner].positions()[0];
            let others = (0..shells.len()).filter(|&outer| outer != inner);
            others.filter(|&outer| is_around(&shells[outer], point)).collect::<Vec<usize>>()
        };
        let mut touching = vec![false; shells.len()];
        for (one, other) in contacts(&index, &agreement, |_| true) {
            (touching[one], touching[other]) = (true, true);
        }
        prop_assert_eq!(&touching, &crossed);
        let triangles = Triangles { index: &index, agreement: &agreement };
        let depths = Solids::new(triangles, &touching, &signs, false).depths;
        for inner in (0..shells.len()).filter(|&inner| !touching[inner]) {
            let around = around(inner);
            match depths[inner].expect("rays avoid edges") {
                Ok(depth) => {
                    prop_assert!(!around.iter().any(|&outer| touching[outer]));
                    prop_assert_eq!(depth, around.len());
                }
                Err(outer) => prop_assert!(touching[outer] && around.contains(&outer)),
            }
        }
    }
}

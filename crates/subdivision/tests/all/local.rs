//! Local refinement: meshes are conforming, angles are bounded, and all structures give the same
//! mesh.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use sixfold_conformance::strategy::manifold_mesh;
use sixfold_core::{BuildError, FaceId, Facts, MeshQuery, Point, PolygonMesh, Representation};
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_indexed_face_set::IndexedFaceSet;
use sixfold_subdivision::{LocalError, LocalMesh, Selection, refine_locally};

fn refined(polygons: &PolygonMesh, selection: &Selection, levels: u32) -> LocalMesh {
    refine_locally::<IndexedFaceSet>(polygons, selection, levels).expect("it can be refined")
}

fn faces(polygons: &PolygonMesh) -> impl Iterator<Item = [Point; 3]> {
    let faces = polygons.faces().iter();
    faces.map(|(_, face)| [0, 1, 2].map(|i| polygons.position(face[i])))
}

fn area(polygons: &PolygonMesh) -> f64 {
    let doubled = |[a, b, c]: [Point; 3]| (b - a).as_dvec3().cross((c - a).as_dvec3()).length();
    faces(polygons).map(doubled).sum::<f64>() / 2.0
}

fn angles([a, b, c]: [Point; 3]) -> [f64; 3] {
    let angle = |at: Point, b: Point, c: Point| {
        let [b, c] = [b, c].map(|p| (p - at).as_dvec3());
        b.cross(c).length().atan2(b.dot(c)).to_degrees()
    };
    [angle(a, b, c), angle(b, c, a), angle(c, a, b)]
}

fn smallest_angle(polygons: &PolygonMesh) -> f64 {
    faces(polygons).flat_map(angles).fold(180.0, f64::min)
}

/// Returns the smallest angle after one side of one face is halved.
fn smallest_of_halves(polygons: &PolygonMesh) -> f64 {
    let halves = faces(polygons).flat_map(|[a, b, c]| {
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .flat_map(|[a, b, c]| {
                let m = a.midpoint(b);
                [[a, m, c], [m, b, c]]
            })
    });
    halves.flat_map(angles).fold(180.0, f64::min)
}

/// Asserts that the topology is unchanged. A corner inside a side would change the topology.
fn assert_conforming(before: &PolygonMesh, after: &PolygonMesh) {
    let [old, new] = [before, after].map(Facts::from_polygons);
    assert_eq!(new.euler_characteristic, old.euler_characteristic);
    assert_eq!(new.components, old.components);
    assert_eq!(new.boundary_loops, old.boundary_loops);
    assert_eq!(new.isolated_vertices, old.isolated_vertices);
    assert_eq!(new.consistently_oriented, old.consistently_oriented);
    assert_eq!(new.degenerate_faces, 0);
    // Equal lengths show that new boundary points lie on the old boundary.
    let length = |mesh: &PolygonMesh| -> f64 {
        let structure = IndexedFaceSet::from_polygons(mesh).expect("it accepts any mesh");
        let boundary = structure
            .edges()
            .filter(|&e| structure.edge_faces(e).count() == 1);
        let ends = boundary.map(|e| structure.edge_vertices(e).map(|v| structure.position(v)));
        ends.map(|[a, b]| f64::from(a.distance(b))).sum()
    };
    assert!((length(before) - length(after)).abs() <= 1e-4 * length(before));
}

fn parts(local: &LocalMesh) -> BTreeMap<FaceId, Vec<FaceId>> {
    let mut parts = BTreeMap::<_, Vec<_>>::new();
    for (part, origin) in (0..).map(FaceId::new).zip(local.origins()) {
        parts.entry(origin).or_default().push(part);
    }
    parts
}

fn ids(faces: &[u32]) -> Vec<FaceId> {
    faces.iter().copied().map(FaceId::new).collect()
}

#[test]
fn one_face_of_an_octahedron() {
    let before = sixfold_shapes::octahedron();
    let local = refined(&before, &Selection::Faces(ids(&[0])), 1);
    let parts = parts(&local);
    let mut sizes: Vec<usize> = parts.values().map(Vec::len).collect();
    sizes.sort_unstable();
    assert_eq!(sizes, [1, 1, 1, 1, 2, 2, 2, 4]);
    for faces in parts.values() {
        assert!(
            faces
                .iter()
                .all(|&f| local.is_green(f) == (faces.len() == 2))
        );
    }
    assert_eq!(local.chosen_parts(), parts[&FaceId::new(0)]);
    assert_eq!(local.polygons().vertex_count(), 6 + 3);
    assert_conforming(&before, local.polygons());
}

#[test]
fn two_split_sides_make_a_face_red() {
    // Two neighbours of the first face are chosen, so the first face also becomes red.
    let before = sixfold_shapes::octahedron();
    let mesh = HalfEdgeMesh::from_polygons(&before).expect("closed");
    let beside: Vec<FaceId> = mesh.face_faces(FaceId::new(0)).take(2).collect();
    let local = refined(&before, &Selection::Faces(beside.clone()), 1);
    let parts = parts(&local);
    for f in beside.iter().chain([&FaceId::new(0)]) {
        assert_eq!(parts[f].len(), 4);
        assert!(!parts[f].iter().any(|&part| local.is_green(part)));
    }
    assert_eq!(local.chosen_parts().len(), 8);
}

#[test]
fn green_faces_are_undone() {
    // One triangle becomes red and the other green. Then a half of the green triangle is chosen.
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let before = PolygonMesh::new(corners.map(Point::from), [[0, 1, 2], [0, 2, 3]]).expect("valid");
    let first = refined(&before, &Selection::Faces(ids(&[0])), 1);
    assert_eq!(first.polygons().face_count(), 6);
    for half in [4, 5] {
        assert!(first.is_green(FaceId::new(half)));
        let mesh = HalfEdgeMesh::from_polygons(first.polygons()).expect("a sheet");
        let second = first.refined(&mesh, &ids(&[half])).expect("small");
        // The result has the eight parts of a uniform step and no extra vertex.
        let uniform = refined(&before, &Selection::Faces(ids(&[0, 1])), 1);
        let shape = |local: &LocalMesh| {
            let mut all: Vec<_> = faces(local.polygons())
                .map(|face| {
                    let mut face = face.map(|p| p.to_array().map(f32::to_bits));
                    face.sort_unstable();
                    face
                })
                .collect();
            all.sort_unstable();
            all
        };
        assert_eq!(shape(&second), shape(&uniform));
        assert_eq!(second.polygons().vertex_count(), 9);
        assert_eq!(second.chosen_parts().len(), 4);
        // The chosen face is next to the green pair. The green pair becomes red.
        let third = first.refined(&mesh, &ids(&[0])).expect("small");
        assert_conforming(&before, third.polygons());
        assert!((area(third.polygons()) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn angles_stay_bounded_at_a_point() {
    let corner = Point::new(0.3, 0.2, 0.0);
    let tiling = sixfold_shapes::triangle_tiling(4, 3).expect("small");
    let sphere = sixfold_shapes::icosahedron();
    let on_sphere = faces(&sphere)
        .next()
        .map(|[a, b, c]| (a * 3.0 + b * 2.0 + c) / 6.0);
    let grid = sixfold_shapes::triangle_grid(3, 3).expect("small");
    for (mesh, at) in [
        (tiling, corner),
        (sphere, on_sphere.expect("faces")),
        (grid, corner),
    ] {
        let near = Point::splat(1e-3);
        let selection = Selection::Box {
            min: at - near,
            max: at + near,
        };
        let (smallest, halves) = (smallest_angle(&mesh), smallest_of_halves(&mesh));
        let mut faces = 0;
        for levels in 1..=8 {
            let local = refined(&mesh, &selection, levels);
            let polygons = local.polygons();
            assert_conforming(&mesh, polygons);
            assert!((area(polygons) - area(&mesh)).abs() < 1e-5 * area(&mesh));
            // Every face has the shape of an old face or of half of an old face.
            let angle = smallest_angle(polygons);
            assert!(angle > halves - 0.1, "level {levels}: {angle} of {halves}");
            if smallest > 59.0 {
                assert!(
                    angle > smallest / 2.0 - 0.1,
                    "level {levels}: {angle} of {smallest}"
                );
            }
            // Each level adds at most a fixed number of faces.
            assert!(polygons.face_count() < mesh.face_count() + 40 * levels as usize);
            assert!(polygons.face_count() > faces);
            faces = polygons.face_count();
        }
    }
}

#[test]
fn an_angle_finds_the_folds() {
    // A strip with a ridge along the middle. With height 0, the strip is flat.
    let strip = |height: f32| {
        let points = (0..9).map(|i| {
            let (x, y) = ((i % 3) as f32, (i / 3) as f32);
            Point::new(x, y, if i / 3 == 1 { height } else { 0.0 })
        });
        let quads = [0_u32, 1, 3, 4];
        let faces = quads
            .into_iter()
            .flat_map(|i| [[i, i + 1, i + 4], [i, i + 4, i + 3]]);
        PolygonMesh::new(points.collect::<Vec<_>>(), faces).expect("valid")
    };
    let chosen = |height, degrees| {
        let polygons = strip(height);
        let mesh = HalfEdgeMesh::from_polygons(&polygons).expect("a sheet");
        Selection::Angle(degrees).faces(&mesh).expect("an angle")
    };
    assert_eq!(chosen(1.0, 89.0), ids(&[1, 3, 4, 6]));
    assert_eq!(chosen(1.0, 91.0), []);
    assert_eq!(chosen(0.0, 0.0), []);
    let local = refined(&strip(1.0), &Selection::Angle(45.0), 4);
    assert_conforming(&strip(1.0), local.polygons());
    // The ridge has 2 · 2⁴ edges with two faces each.
    let mesh = HalfEdgeMesh::from_polygons(local.polygons()).expect("a sheet");
    let folds = Selection::Angle(45.0).faces(&mesh).expect("an angle");
    assert_eq!(folds.len(), 2 * 2 * 16);
}

#[test]
fn faces_that_run_in_the_same_direction_are_not_a_fold() {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let turned = PolygonMesh::new(corners.map(Point::from), [[0, 1, 2], [0, 3, 2]]).expect("valid");
    let mesh = IndexedFaceSet::from_polygons(&turned).expect("it accepts any mesh");
    assert_eq!(Selection::Angle(1.0).faces(&mesh), Ok(vec![]));
}

#[test]
fn all_faces_of_a_non_manifold_edge_are_split() {
    let points = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
    ];
    let book = PolygonMesh::new(points.map(Point::from), [[0, 1, 2], [0, 1, 3], [1, 0, 4]]);
    let book = book.expect("valid");
    let local = refined(&book, &Selection::Faces(ids(&[1])), 3);
    assert_conforming(&book, local.polygons());
    assert_eq!(Facts::from_polygons(local.polygons()).non_manifold_edges, 8);
    let mesh = IndexedFaceSet::from_polygons(&book).expect("it accepts any mesh");
    assert_eq!(Selection::Angle(180.0).faces(&mesh), Ok(ids(&[0, 1, 2])));
}

#[test]
fn each_invalid_input_returns_its_error() {
    let mesh = sixfold_shapes::octahedron();
    let error_of =
        |selection: Selection| refine_locally::<IndexedFaceSet>(&mesh, &selection, 1).unwrap_err();
    let missing = LocalError::MissingFace {
        face: FaceId::new(8),
        faces: 8,
    };
    assert_eq!(error_of(Selection::Faces(ids(&[0, 8]))), missing);
    let local = LocalMesh::new(mesh.clone()).expect("triangles");
    let structure = IndexedFaceSet::from_polygons(&mesh).expect("it accepts any mesh");
    assert_eq!(local.refined(&structure, &ids(&[8])), Err(missing));
    let box_error = |min, max| error_of(Selection::Box { min, max });
    let nan = Point::new(0.0, f32::NAN, 0.0);
    assert!(matches!(
        box_error(nan, Point::ONE),
        LocalError::BadBox { .. }
    ));
    assert!(matches!(
        box_error(Point::ZERO, nan),
        LocalError::BadBox { .. }
    ));
    assert!(matches!(
        box_error(Point::ONE, Point::ZERO),
        LocalError::BadBox { .. }
    ));
    for degrees in [f32::NAN, -1.0, 180.5] {
        assert!(matches!(
            error_of(Selection::Angle(degrees)),
            LocalError::BadAngle { .. }
        ));
    }
    let cube = sixfold_shapes::cube();
    let all = Selection::Faces(vec![]);
    let expected = LocalError::NotATriangle {
        face: FaceId::new(0),
        degree: 4,
    };
    let error = refine_locally::<IndexedFaceSet>(&cube, &all, 1);
    assert_eq!(error, Err(expected.clone()));
    let structure = IndexedFaceSet::from_polygons(&cube).expect("it accepts any mesh");
    assert_eq!(Selection::Angle(1.0).faces(&structure), Err(expected));
    // Refinement ends when the coordinates are too coarse.
    let at = Point::new(1.0, 0.0, 0.0);
    let error =
        refine_locally::<HalfEdgeMesh>(&mesh, &Selection::Box { min: at, max: at }, u32::MAX);
    assert!(
        matches!(error, Err(LocalError::TooShort { .. })),
        "{error:?}"
    );
    let book = PolygonMesh::new(
        [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat),
        [[0, 1, 2], [0, 1, 3], [0, 1, 4]],
    );
    let error = refine_locally::<HalfEdgeMesh>(&book.expect("valid"), &all, 1);
    let refusal = error.map(|_| ()).unwrap_err();
    let LocalError::Build {
        level: 0, refusal, ..
    } = refusal
    else {
        panic!("{refusal:?}")
    };
    assert!(matches!(refusal, BuildError::NonManifoldEdge { .. }));
}

/// Triangulates the faces and removes repeated triangles.
fn triangulated(polygons: &PolygonMesh) -> PolygonMesh {
    let fans = polygons.triangulated().expect("small").polygons;
    let mut known = BTreeSet::new();
    let faces = fans.faces().iter().filter_map(|(_, face)| {
        let face: Vec<u32> = face.iter().map(|v| v.index() as u32).collect();
        let mut sorted = face.clone();
        sorted.sort_unstable();
        known.insert(sorted).then_some(face)
    });
    PolygonMesh::new(fans.positions().iter().copied(), faces).expect("as before")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn chosen_faces_are_red_and_the_mesh_conforms(
        polygons in manifold_mesh(),
        picks in prop::collection::vec(any::<prop::sample::Index>(), 1..4),
        levels in 1..4_u32,
        again in any::<prop::sample::Index>(),
    ) {
        let before = triangulated(&polygons);
        let chosen: Vec<FaceId> = picks
            .iter()
            .map(|pick| FaceId::new(pick.index(before.face_count()) as u32))
            .collect();
        let local = refined(&before, &Selection::Faces(chosen.clone()), levels);
        assert_conforming(&before, local.polygons());
        prop_assert!((area(local.polygons()) - area(&before)).abs() < 1e-4 * area(&before) + 1e-6);
        let parts = parts(&local);
        prop_assert_eq!(parts.len(), before.face_count(), "every face has parts");
        for f in &chosen {
            prop_assert_eq!(parts[f].len(), 4_usize.pow(levels));
            prop_assert!(!parts[f].iter().any(|&part| local.is_green(part)));
        }
        // Old vertices come first and do not move.
        prop_assert_eq!(&local.polygons().positions()[..before.vertex_count()], before.positions());
        let greens: Vec<FaceId> = (0..local.polygons().face_count() as u32)
            .map(FaceId::new)
            .filter(|&f| local.is_green(f))
            .collect();
        for pair in greens.chunks(2) {
            let [f, g] = [pair[0], pair[1]].map(|f| local.polygons().faces().face(f));
            prop_assert_eq!(f.iter().filter(|v| g.contains(v)).count(), 2);
        }
        let mesh = IndexedFaceSet::from_polygons(local.polygons()).expect("it accepts any mesh");
        let any = FaceId::new(again.index(local.polygons().face_count()) as u32);
        let next = local.refined(&mesh, &[any]).expect("small");
        assert_conforming(&before, next.polygons());
        prop_assert!(next.chosen_parts().len() >= 4);
        // The faces of two structures are compared by the positions of their corners.
        if HalfEdgeMesh::from_polygons(&before).is_ok() {
            let other = refine_locally::<HalfEdgeMesh>(&before, &Selection::Faces(chosen), levels);
            let other = other.expect("it can be refined");
            let shape = |local: &LocalMesh| {
                let mut all: Vec<_> = faces(local.polygons())
                    .zip(local.origins())
                    .map(|(face, origin)| {
                        let mut face = face.map(|p| p.to_array().map(f32::to_bits));
                        face.sort_unstable();
                        (origin, face)
                    })
                    .collect();
                all.sort_unstable();
                all
            };
            prop_assert_eq!(shape(&other), shape(&local));
        }
    }
}

//! Checks that operators give the same mesh on every structure. Also checks that half-edge accepts
//! meshes after orientation repair.

use proptest::prelude::*;
use sixfold::operators::{
    DualError, NormalWeights, Smoothing, SmoothingBoundary, Weights, dual, face_normals, smoothed,
    vertex_normals,
};
use sixfold::repair::{Facing, OrientationError, oriented};
use sixfold::{
    Facts, HalfEdgeMesh, MeshQuery, Point, PolygonMesh, Representation, for_each_representation,
};
use sixfold_conformance::strategy::{any_mesh, manifold_mesh};
use sixfold_conformance::{gallery, one_line, welded};

/// Asserts that two vectors are equal, up to 4 ulps of `size`.
fn assert_near(got: Point, expected: Point, size: f32, context: &str) {
    let off = (got - expected).abs().max_element();
    assert!(
        off <= 4.0 * f32::EPSILON * size,
        "{got} against {expected}: {context}"
    );
}

fn size(polygons: &PolygonMesh) -> f32 {
    let largest = |p: &Point| p.abs().max_element();
    polygons.positions().iter().map(largest).fold(0.0, f32::max)
}

/// Returns the results on `M` for the vertices of `polygons`, then for the faces. Returns `None` if
/// `M` refuses the mesh.
fn results<M: Representation>(
    polygons: &PolygonMesh,
    operator: impl Fn(&M) -> Option<Results<M>>,
) -> Option<Vec<Point>> {
    let mesh = M::from_polygons(polygons).ok()?;
    let (by_vertex, by_face) = operator(&mesh)?;
    let vertices = polygons.vertices().map(|v| M::vertex_handle(polygons, v));
    let faces = polygons
        .faces()
        .iter()
        .map(|(f, _)| M::face_handle(polygons, f));
    let faces = faces.map(|f| by_face[f]);
    Some(vertices.map(|v| by_vertex[v]).chain(faces).collect())
}

type Results<M> = (sixfold::VertexMap<M, Point>, sixfold::FaceMap<M, Point>);

/// Compares the results of `operator` on all structures that can hold `polygons`.
macro_rules! compare_structures {
    ($polygons:expr, $size:expr, $operator:expr) => {{
        let polygons: &PolygonMesh = $polygons;
        let mut first = None;
        let mut structures = 0;
        for_each_representation!(M => {
            if let Some(got) = results::<M>(polygons, $operator) {
                structures += 1;
                let (name, expected) = first.get_or_insert_with(|| (M::NAME, got.clone()));
                assert_eq!(got.len(), expected.len());
                for (i, (&got, &expected)) in got.iter().zip(expected.iter()).enumerate() {
                    let context = format!("{i}, {} against {name}, on {}", M::NAME, one_line(polygons));
                    assert_near(got, expected, $size, &context);
                }
            }
        });
        structures
    }};
}

fn smoothing() -> impl Strategy<Value = Smoothing> {
    let weights = prop_oneof![Just(Weights::Uniform), Just(Weights::Cotangent)];
    let boundary = prop_oneof![
        Just(SmoothingBoundary::Fixed),
        Just(SmoothingBoundary::Curve)
    ];
    let steps = prop_oneof![
        Just((0.33, Some(-0.34))),
        (0.1..0.6).prop_map(|step| (step, None))
    ];
    let parts = (weights, boundary, steps, 0..4_usize);
    parts.prop_map(
        |(weights, boundary, (step, step_back), iterations)| Smoothing {
            weights,
            boundary,
            step,
            step_back,
            iterations,
        },
    )
}

/// Checks that all structures that can hold `polygons` give the same dual or the same error.
/// Returns the dual or the error.
///
/// `polygons` must be welded, because a soup numbers vertices in the order of their first use.
fn compare_duals(polygons: &PolygonMesh) -> Option<Result<PolygonMesh, DualError>> {
    let mut first = None;
    for_each_representation!(M => {
        if let Ok(mesh) = M::from_polygons(polygons) {
            let got = dual(&mesh);
            let expected = first.get_or_insert_with(|| got.clone());
            match (&got, &*expected) {
                (Ok(got), Ok(expected)) => {
                    assert_eq!(got.faces(), expected.faces(), "{} on {}", M::NAME, one_line(polygons));
                    for (&got, &expected) in got.positions().iter().zip(expected.positions()) {
                        assert_near(got, expected, size(polygons), M::NAME);
                    }
                }
                _ => assert_eq!(&got, &*expected, "{} on {}", M::NAME, one_line(polygons)),
            }
        }
    });
    first
}

#[test]
fn all_structures_are_compared() {
    let icosahedron = sixfold::shapes::icosahedron();
    let structures = compare_structures!(&icosahedron, size(&icosahedron), |mesh| {
        Some((
            smoothed(mesh, &Smoothing::default()).ok()?,
            face_normals(mesh),
        ))
    });
    assert_eq!(structures, sixfold::structure_infos().len());
    let welded = welded(&icosahedron).expect("distinct positions");
    let dual = compare_duals(&welded)
        .expect("a structure holds it")
        .expect("closed");
    assert_eq!((dual.vertex_count(), dual.face_count()), (20, 12));
}

#[test]
fn duals_of_the_gallery_are_the_same_on_all_structures() {
    let mut duals = 0;
    for entry in gallery() {
        if let Ok(welded) = welded(&entry.polygons) {
            duals += u32::from(matches!(compare_duals(&welded), Some(Ok(_))));
        }
    }
    assert!(duals >= 10, "{duals} meshes have a dual");
}

#[test]
fn half_edge_accepts_lecture_meshes_after_orientation_repair() {
    let misoriented = gallery()
        .into_iter()
        .filter(|entry| entry.name.starts_with("lecture: indexed"));
    let mut repaired = 0;
    for entry in misoriented {
        let name = entry.name;
        HalfEdgeMesh::from_polygons(&entry.polygons).expect_err(name);
        for facing in [Facing::Majority, Facing::Outward] {
            let oriented = oriented(&entry.polygons, facing).expect(name);
            assert!(!oriented.reversed.is_empty());
            let mesh = HalfEdgeMesh::from_polygons(&oriented.polygons).expect(name);
            mesh.validate().expect(name);
            let facts = Facts::from_polygons(&oriented.polygons);
            assert_eq!((facts.genus, facts.closed), (Some(0), true), "{name}");
            if facing == Facing::Outward {
                check_normals_point_outward(&mesh);
            }
        }
        repaired += 1;
    }
    assert_eq!(repaired, 2, "the cube and the tetrahedron");
}

fn check_normals_point_outward<M: MeshQuery>(mesh: &M) {
    let sum: Point = mesh.vertices().map(|v| mesh.position(v)).sum();
    let centre = sum / mesh.vertex_count() as f32;
    let normals = face_normals(mesh);
    for f in mesh.faces() {
        let corner = mesh.face_vertices(f).next().expect("a corner");
        assert!(
            normals[f].dot(mesh.position(corner) - centre) > 0.0,
            "{f:?}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn smoothing_is_the_same_on_all_structures(polygons in manifold_mesh(), smoothing in smoothing()) {
        let triangles = polygons.faces().uniform_degree() == Some(3);
        let refused = smoothing.weights == Weights::Cotangent && !triangles && polygons.face_count() > 0;
        let structures = compare_structures!(&polygons, size(&polygons), |mesh| {
            let smoothed = smoothed(mesh, &smoothing);
            assert_eq!(smoothed.is_err(), refused);
            Some((smoothed.ok()?, mesh.face_map(Point::ZERO)))
        });
        prop_assert!(refused || structures >= 3);
    }

    #[test]
    fn normals_are_the_same_on_all_structures(polygons in manifold_mesh()) {
        for weights in [NormalWeights::Area, NormalWeights::Angle] {
            let structures = compare_structures!(&polygons, 1.0, |mesh| {
                Some((vertex_normals(mesh, weights), face_normals(mesh)))
            });
            prop_assert!(structures >= 3);
        }
    }

    #[test]
    fn duals_are_the_same_on_all_structures(polygons in manifold_mesh()) {
        let polygons = welded(&polygons).expect("distinct positions");
        let facts = Facts::from_polygons(&polygons);
        let dual = compare_duals(&polygons).expect("a structure holds it");
        let has_low_valence = facts.valence.as_ref().is_some_and(|valence| valence.min < 3);
        prop_assert_eq!(dual.is_ok(), facts.closed && !has_low_valence, "{:?}", dual);
        if let Ok(dual) = dual {
            prop_assert_eq!(dual.vertex_count(), facts.faces);
            prop_assert_eq!(dual.face_count(), facts.vertices);
            prop_assert_eq!(dual.corner_count(), polygons.corner_count());
        }
    }

    #[test]
    fn duals_of_any_mesh_are_the_same_on_all_structures(polygons in any_mesh()) {
        if let Ok(welded) = welded(&polygons) {
            compare_duals(&welded);
        }
    }

    /// Half-edge accepts the repaired mesh if the orientation was the only fault.
    #[test]
    fn every_orientable_mesh_is_repaired(polygons in any_mesh()) {
        let before = Facts::from_polygons(&polygons);
        match oriented(&polygons, Facing::Majority) {
            Ok(repaired) => {
                prop_assert_ne!(before.orientable, Some(false));
                let after = Facts::from_polygons(&repaired.polygons);
                prop_assert_eq!(after.inconsistent_edges, 0);
                prop_assert!(2 * repaired.reversed.len() <= polygons.face_count());
                if before.non_manifold_vertices == 0 {
                    prop_assert!(HalfEdgeMesh::from_polygons(&repaired.polygons).is_ok());
                }
            }
            Err(OrientationError::NotOrientable { .. }) => {
                prop_assert_eq!(before.orientable, Some(false));
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}

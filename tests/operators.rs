//! Checks that operators give the same mesh on every structure, and that half-edge accepts meshes
//! after orientation repair.

use proptest::prelude::*;
use sixfold::operators::{
    Boundary, DualError, Facing, NormalWeights, OrientationError, Smoothing, Weights, dual,
    face_normals, oriented, smoothed, vertex_normals,
};
use sixfold::{
    Facts, HalfEdgeMesh, MeshQuery, Point, PolygonMesh, Representation, for_each_representation,
};
use sixfold_conformance::strategy::{any_mesh, manifold_mesh};
use sixfold_conformance::{compact, gallery, welded};

/// Asserts that two structures compute the same position or normal, up to 4 ulps of `size`.
fn same_place(got: Point, expected: Point, size: f32, context: &str) {
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

/// Returns the results on `M`, first by vertices and then by faces of `polygons`; `None` if `M`
/// refuses the mesh.
fn answers<M: Representation>(
    polygons: &PolygonMesh,
    ask: impl Fn(&M) -> Option<Answer<M>>,
) -> Option<Vec<Point>> {
    let mesh = M::from_polygons(polygons).ok()?;
    let (by_vertex, by_face) = ask(&mesh)?;
    let vertices = polygons.vertices().map(|v| M::vertex_name(polygons, v));
    let faces = polygons
        .faces()
        .iter()
        .map(|(f, _)| M::face_name(polygons, f));
    let faces = faces.map(|f| by_face[f]);
    Some(vertices.map(|v| by_vertex[v]).chain(faces).collect())
}

type Answer<M> = (sixfold::VertexMap<M, Point>, sixfold::FaceMap<M, Point>);

/// Compares the result of `ask` on each structure that holds `polygons` with that on the first one.
macro_rules! agree {
    ($polygons:expr, $size:expr, $ask:expr) => {{
        let polygons: &PolygonMesh = $polygons;
        let mut first = None;
        let mut held = 0;
        for_each_representation!(M => {
            if let Some(got) = answers::<M>(polygons, $ask) {
                held += 1;
                let (name, expected) = first.get_or_insert_with(|| (M::NAME, got.clone()));
                assert_eq!(got.len(), expected.len());
                for (i, (&got, &expected)) in got.iter().zip(expected.iter()).enumerate() {
                    let place = format!("{i}, {} against {name}, on {}", M::NAME, compact(polygons));
                    same_place(got, expected, $size, &place);
                }
            }
        });
        held
    }};
}

fn smoothing() -> impl Strategy<Value = Smoothing> {
    let weights = prop_oneof![Just(Weights::Uniform), Just(Weights::Cotangent)];
    let boundary = prop_oneof![Just(Boundary::Fixed), Just(Boundary::Curve)];
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

/// Checks that all structures that hold `polygons` give the same dual, or the same refusal, and
/// returns it.
///
/// `polygons` must be welded, because the soup numbers vertices in the order in which faces first
/// use them.
fn duals_agree(polygons: &PolygonMesh) -> Option<Result<PolygonMesh, DualError>> {
    let mut first = None;
    for_each_representation!(M => {
        if let Ok(mesh) = M::from_polygons(polygons) {
            let got = dual(&mesh);
            let expected = first.get_or_insert_with(|| got.clone());
            match (&got, &*expected) {
                (Ok(got), Ok(expected)) => {
                    assert_eq!(got.faces(), expected.faces(), "{} on {}", M::NAME, compact(polygons));
                    for (&got, &expected) in got.positions().iter().zip(expected.positions()) {
                        same_place(got, expected, size(polygons), M::NAME);
                    }
                }
                _ => assert_eq!(&got, &*expected, "{} on {}", M::NAME, compact(polygons)),
            }
        }
    });
    first
}

/// Without this check, the comparisons could compare a structure only with itself.
#[test]
fn all_structures_are_compared() {
    let icosahedron = sixfold::shapes::icosahedron();
    let held = agree!(&icosahedron, size(&icosahedron), |mesh| {
        Some((
            smoothed(mesh, &Smoothing::default()).ok()?,
            face_normals(mesh),
        ))
    });
    assert_eq!(held, sixfold::roster().len());
    let welded = welded(&icosahedron).expect("distinct positions");
    let dual = duals_agree(&welded).expect("held").expect("closed");
    assert_eq!((dual.vertex_count(), dual.face_count()), (20, 12));
}

#[test]
fn duals_of_the_gallery_agree() {
    let mut duals = 0;
    for specimen in gallery() {
        if let Ok(welded) = welded(&specimen.polygons) {
            duals += u32::from(matches!(duals_agree(&welded), Some(Ok(_))));
        }
    }
    assert!(duals >= 10, "{duals} specimens have a dual");
}

#[test]
fn half_edge_accepts_lecture_meshes_after_orientation_repair() {
    let wrong = gallery()
        .into_iter()
        .filter(|specimen| specimen.name.starts_with("lecture: indexed"));
    let mut mended = 0;
    for specimen in wrong {
        let name = specimen.name;
        HalfEdgeMesh::from_polygons(&specimen.polygons).expect_err(name);
        for facing in [Facing::Majority, Facing::Outward] {
            let oriented = oriented(&specimen.polygons, facing).expect(name);
            assert!(!oriented.turned.is_empty());
            let mesh = HalfEdgeMesh::from_polygons(&oriented.polygons).expect(name);
            mesh.validate().expect(name);
            let facts = Facts::of(&oriented.polygons);
            assert_eq!((facts.genus, facts.closed), (Some(0), true), "{name}");
            if facing == Facing::Outward {
                faces_away_from_the_middle(&mesh);
            }
        }
        mended += 1;
    }
    assert_eq!(mended, 2, "the cube and the tetrahedron");
}

fn faces_away_from_the_middle<M: MeshQuery>(mesh: &M) {
    let sum: Point = mesh.vertices().map(|v| mesh.position(v)).sum();
    let middle = sum / mesh.vertex_count() as f32;
    let normals = face_normals(mesh);
    for f in mesh.faces() {
        let corner = mesh.face_vertices(f).next().expect("a corner");
        assert!(
            normals[f].dot(mesh.position(corner) - middle) > 0.0,
            "{f:?}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn smoothing_is_the_same_on_all(polygons in manifold_mesh(), smoothing in smoothing()) {
        let triangles = polygons.faces().uniform_degree() == Some(3);
        let refused = smoothing.weights == Weights::Cotangent && !triangles && polygons.face_count() > 0;
        let held = agree!(&polygons, size(&polygons), |mesh| {
            let smoothed = smoothed(mesh, &smoothing);
            assert_eq!(smoothed.is_err(), refused);
            Some((smoothed.ok()?, mesh.face_map(Point::ZERO)))
        });
        prop_assert!(refused || held >= 3);
    }

    #[test]
    fn normals_are_the_same_on_all(polygons in manifold_mesh()) {
        for weights in [NormalWeights::Area, NormalWeights::Angle] {
            let held = agree!(&polygons, 1.0, |mesh| {
                Some((vertex_normals(mesh, weights), face_normals(mesh)))
            });
            prop_assert!(held >= 3);
        }
    }

    #[test]
    fn duals_are_the_same_on_all(polygons in manifold_mesh()) {
        let polygons = welded(&polygons).expect("distinct positions");
        let facts = Facts::of(&polygons);
        let dual = duals_agree(&polygons).expect("held");
        let low = facts.valence.as_ref().is_some_and(|valence| valence.min < 3);
        prop_assert_eq!(dual.is_ok(), facts.closed && !low, "{:?}", dual);
        if let Ok(dual) = dual {
            prop_assert_eq!(dual.vertex_count(), facts.faces);
            prop_assert_eq!(dual.face_count(), facts.vertices);
            prop_assert_eq!(dual.corner_count(), polygons.corner_count());
        }
    }

    #[test]
    fn duals_of_any_mesh_agree(polygons in any_mesh()) {
        if let Ok(welded) = welded(&polygons) {
            duals_agree(&welded);
        }
    }

    /// Orientation repair fails only if the mesh is not orientable. If orientation was the only
    /// fault, half-edge accepts the result.
    #[test]
    fn every_orientable_mesh_is_repaired(polygons in any_mesh()) {
        let before = Facts::of(&polygons);
        match oriented(&polygons, Facing::Majority) {
            Ok(mended) => {
                prop_assert_ne!(before.orientable, Some(false));
                let after = Facts::of(&mended.polygons);
                prop_assert_eq!(after.inconsistent_edges, 0);
                prop_assert!(2 * mended.turned.len() <= polygons.face_count());
                if before.non_manifold_vertices == 0 {
                    prop_assert!(HalfEdgeMesh::from_polygons(&mended.polygons).is_ok());
                }
            }
            Err(OrientationError::NotOrientable { .. }) => {
                prop_assert_eq!(before.orientable, Some(false));
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}

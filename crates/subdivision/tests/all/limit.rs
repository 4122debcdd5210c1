//! Compares limit positions and normals with meshes after many steps.

use proptest::prelude::*;
use sixfold_conformance::strategy::manifold_mesh;
use sixfold_core::{Creases, MeshQuery, Point, PolygonMesh, Representation, VertexId};
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_indexed_face_set::IndexedFaceSet;
use sixfold_subdivision::{
    BoundaryRule, ControlGrid, Ends, LimitNormal, LimitPoint, LoopWeights, NoLimit, Scheme, Step,
    Subdivision, SubdivisionError,
};

const SCHEMES: [Scheme; 2] = [Scheme::CatmullClark, Scheme::Loop];

/// Returns the creases before the first step, and all limits in the order of the vertices.
fn limits<M: Representation>(
    scheme: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
) -> (Creases, Vec<LimitPoint>) {
    let mesh = M::from_polygons(polygons).expect("the structure accepts it");
    let control = scheme
        .control_creases(&mesh, polygons, creases)
        .expect("creases");
    let limits = limits_of(scheme, &mesh, &control);
    (control, limits)
}

fn limits_of<M: MeshQuery>(scheme: &Subdivision, mesh: &M, creases: &Creases) -> Vec<LimitPoint> {
    let limits = scheme.limit(mesh, creases).expect("a known limit");
    mesh.vertices().map(|v| limits[v]).collect()
}

fn step(scheme: &Subdivision, polygons: &PolygonMesh, creases: &Creases) -> Step {
    let mesh = IndexedFaceSet::from_polygons(polygons).expect("it accepts any mesh");
    scheme.gather(&mesh, creases, 0).expect("a step")
}

/// Builds vertex 0 with `faces` faces around it, on uneven ground. The faces are triangles for Loop
/// and quads for other schemes. The neighbours of vertex 0 have the next numbers.
fn fan(scheme: Scheme, faces: usize, is_closed: bool, seed: usize) -> PolygonMesh {
    let bump = |i: usize| ((i * 37 + seed * 101) as f32 * 12.9898).sin() * 0.3;
    let spokes = if is_closed { faces } else { faces + 1 };
    let turn = if is_closed {
        std::f32::consts::TAU
    } else {
        3.6
    } / faces as f32;
    let place = |turns: f32, radius: f32, i: usize| {
        let (sin, cos) = (turns * turn).sin_cos();
        Point::new(radius * cos, radius * sin, 0.0)
            + Point::new(bump(i), bump(i + 50), bump(i + 99))
    };
    let mut points = vec![Point::new(bump(7), 0.0, 2.0 * bump(8))];
    points.extend((0..spokes).map(|i| place(i as f32, 1.0, i)));
    if scheme != Scheme::Loop {
        points.extend((0..faces).map(|i| place(i as f32 + 0.5, 1.5, i + 20)));
    }
    let face = |i: usize| {
        let (edge, next) = (1 + i, 1 + (i + 1) % spokes);
        match scheme {
            Scheme::Loop => vec![0, edge as u32, next as u32],
            _ => vec![0, edge as u32, (1 + spokes + i) as u32, next as u32],
        }
    };
    PolygonMesh::new(points, (0..faces).map(face)).expect("a fan")
}

/// Runs a step and returns the faces at vertex 0, the position of vertex 0, and the size of the
/// faces. The returned faces are moved so that vertex 0 is at the origin, and scaled to size 1.
fn ring_after(scheme: &Subdivision, from: &Step) -> (Step, Point, f32) {
    let Step { polygons, creases } = step(scheme, &from.polygons, &from.creases);
    let faces = polygons.faces().iter().map(|(_, face)| face);
    let faces: Vec<&[VertexId]> = faces
        .filter(|face| face.contains(&VertexId::new(0)))
        .collect();
    let mut used: Vec<VertexId> = faces.concat();
    used.sort_unstable();
    used.dedup();
    let name = |v: VertexId| used.binary_search(&v).ok().map(|name| name as u32);
    let origin = polygons.position(used[0]);
    let seen = used.iter().map(|&v| polygons.position(v) - origin);
    let seen: Vec<Point> = seen.collect();
    let size = seen.iter().map(|p| p.length()).fold(0.0, f32::max);
    let points: Vec<Point> = seen.into_iter().map(|p| p / size).collect();
    let faces = faces
        .iter()
        .map(|face| face.iter().filter_map(|&v| name(v)).collect::<Vec<_>>());
    let ring = PolygonMesh::new(points, faces).expect("a ring");
    let edges = creases.edges().iter().filter_map(|&(ends, sharpness)| {
        let [a, b] = ends.ends().map(name);
        Some(([a?, b?], sharpness))
    });
    let corners = creases.corners().iter();
    let corners = corners.filter_map(|&(v, sharpness)| Some((name(v)?, sharpness)));
    // Only edges at vertex 0 have an influence.
    let edges: Vec<_> = edges.filter(|&(ends, _)| ends.contains(&0)).collect();
    let creases = Creases::new(&ring, edges, corners.collect::<Vec<_>>()).expect("of the ring");
    let step = Step {
        polygons: ring,
        creases,
    };
    (step, origin, size)
}

/// Returns the position of vertex 0 after `levels` steps and its normal. The normal is the sum over
/// the faces for which `counts` is true. The argument of `counts` is the first neighbour of the
/// face.
fn vertex_after(
    scheme: &Subdivision,
    from: Step,
    levels: usize,
    counts: impl Fn(usize) -> bool,
) -> (Point, Point) {
    let mut at = from;
    let (mut place, mut scale) = (Point::ZERO, 1.0);
    for _ in 0..levels {
        let (ring, origin, size) = ring_after(scheme, &at);
        place += origin * scale;
        scale *= size;
        at = ring;
    }
    let mesh = IndexedFaceSet::from_polygons(&at.polygons).expect("a ring");
    let ring: Vec<VertexId> = mesh.one_ring(VertexId::new(0)).expect("a fan").collect();
    let faces = mesh.vertex_faces(VertexId::new(0)).count();
    let seen = |i: usize| {
        at.polygons.position(ring[i % ring.len()]) - at.polygons.position(VertexId::new(0))
    };
    let normals = (0..faces)
        .filter(|&i| counts(i))
        .map(|i| seen(i).cross(seen(i + 1)));
    (
        place + at.polygons.positions()[0] * scale,
        normals.sum::<Point>().normalize(),
    )
}

fn defined(limit: LimitPoint) -> (Point, LimitNormal) {
    match limit {
        LimitPoint::Defined { position, normal } => (position, normal),
        LimitPoint::Undefined(reason) => panic!("{reason:?}"),
    }
}

fn normals(limit: LimitPoint) -> Vec<Point> {
    match defined(limit).1 {
        LimitNormal::One(normal) => vec![normal],
        LimitNormal::TwoSides(sides) => sides.to_vec(),
        LimitNormal::Undefined => vec![],
    }
}

fn all_options(scheme: Scheme) -> Vec<Subdivision> {
    let of = |loop_weights| Subdivision {
        loop_weights,
        ..Subdivision::new(scheme)
    };
    match scheme {
        Scheme::Loop => LoopWeights::ALL.map(of).to_vec(),
        _ => vec![Subdivision::new(scheme)],
    }
}

#[test]
fn limits_match_values_computed_by_hand() {
    let cube = sixfold_shapes::cube();
    let scheme = Subdivision::new(Scheme::CatmullClark);
    let (_, at) = limits::<HalfEdgeMesh>(&scheme, &cube, &Creases::default());
    for (v, limit) in cube.positions().iter().zip(at) {
        let (position, normal) = defined(limit);
        assert!(position.distance(*v * 0.5) < 1e-6);
        let LimitNormal::One(normal) = normal else {
            panic!("{normal:?}")
        };
        assert!(normal.distance(v.normalize()) < 1e-5);
    }
    let tetrahedron = sixfold_shapes::tetrahedron();
    let scheme = Subdivision::new(Scheme::Loop);
    let (_, at) = limits::<HalfEdgeMesh>(&scheme, &tetrahedron, &Creases::default());
    for (v, limit) in tetrahedron.positions().iter().zip(at) {
        let (position, normal) = defined(limit);
        assert!(position.distance(*v * 0.2) < 1e-6);
        assert_eq!(
            limit.normal().map(|n| n.distance(v.normalize()) < 1e-5),
            Some(true)
        );
        assert!(matches!(normal, LimitNormal::One(_)));
    }
    let torus = sixfold_shapes::triangle_torus(5, 6).expect("small");
    let mesh = HalfEdgeMesh::from_polygons(&torus).expect("a torus");
    let (_, at) = limits::<HalfEdgeMesh>(&scheme, &torus, &Creases::default());
    for (v, limit) in mesh.vertices().zip(at) {
        let ring: Point = mesh.vertex_vertices(v).map(|w| mesh.position(w)).sum();
        let regular = (mesh.position(v) * 6.0 + ring) / 12.0;
        assert!(defined(limit).0.distance(regular) < 1e-5);
    }
}

#[test]
fn a_smooth_vertex_converges_to_its_limit() {
    for scheme in SCHEMES.into_iter().flat_map(all_options) {
        for (n, seed) in (2..12).flat_map(|n| (0..4).map(move |seed| (n, seed))) {
            let polygons = fan(scheme.scheme, n, true, seed);
            if n == 2 && scheme.scheme == Scheme::Loop {
                continue;
            }
            let (creases, at) = limits::<IndexedFaceSet>(&scheme, &polygons, &Creases::default());
            let (position, normal) = defined(at[0]);
            let start = Step { polygons, creases };
            let (place, seen) = vertex_after(&scheme, start, 24, |_| true);
            assert!(
                place.distance(position) < 1e-5,
                "{scheme:?} {n}: {place} {position}"
            );
            match normal {
                LimitNormal::One(normal) => {
                    assert!(seen.dot(normal) > 0.999, "{scheme:?} {n}: {seen} {normal}");
                }
                _ => assert_eq!((n, normal), (2, LimitNormal::Undefined)),
            }
        }
    }
}

#[test]
fn a_boundary_vertex_converges_to_its_limit() {
    for scheme in SCHEMES.into_iter().flat_map(all_options) {
        let scheme = Subdivision {
            boundary: BoundaryRule::EdgeOnly,
            ..scheme
        };
        for (k, seed) in (1..13).flat_map(|k| (0..4).map(move |seed| (k, seed))) {
            let polygons = fan(scheme.scheme, k, false, seed);
            let (creases, at) = limits::<IndexedFaceSet>(&scheme, &polygons, &Creases::default());
            let (position, normal) = defined(at[0]);
            let start = Step { polygons, creases };
            // A boundary with few faces becomes flat. With many faces, the steps converge slowly.
            let (levels, least) = match k {
                1 | 2 => (14, 0.9995),
                3 => (20, 0.9995),
                _ => (45, 0.99),
            };
            let (place, seen) = vertex_after(&scheme, start, levels, |_| true);
            assert!(
                place.distance(position) < 1e-4,
                "{scheme:?} {k}: {place} {position}"
            );
            let LimitNormal::One(normal) = normal else {
                panic!("{k}: {normal:?}")
            };
            assert!(
                seen.dot(normal) > least,
                "{scheme:?} {k} {seed}: {seen} {normal}"
            );
        }
    }
}

#[test]
fn a_crease_has_a_normal_on_either_side() {
    for scheme in SCHEMES.map(Subdivision::new) {
        for (n, second) in (4..9_u32).flat_map(|n| (2..n - 1).map(move |second| (n, second))) {
            let polygons = fan(scheme.scheme, n as usize, true, 3);
            let crease = [([0, 1], f32::INFINITY), ([0, 1 + second], 10.0)];
            let creases = Creases::new(&polygons, crease, []).expect("edges");
            let (creases, at) = limits::<HalfEdgeMesh>(&scheme, &polygons, &creases);
            let (position, normal) = defined(at[0]);
            let LimitNormal::TwoSides(sides) = normal else {
                panic!("{normal:?}")
            };
            let start = Step { polygons, creases };
            for (side, normal) in sides.into_iter().enumerate() {
                let faces = [second, n - second][side];
                let levels = if faces < 4 { 9 } else { 45 };
                // The ring may start at any neighbour. Tries every start and uses the best normal.
                let best = (0..n).map(|first| {
                    let counts = |i: usize| (i as u32 + n - first) % n < faces;
                    let (place, seen) = vertex_after(&scheme, start.clone(), levels, counts);
                    assert!(place.distance(position) < 1e-4);
                    seen.dot(normal)
                });
                let best = best.fold(-1.0, f32::max);
                assert!(best > 0.99, "{scheme:?} {n} {second}, side {side}: {best}");
            }
        }
    }
}

#[test]
fn a_grid_has_the_limits_of_its_patch() {
    let points: Vec<Point> = (0..35)
        .map(|i| Point::new((i % 7) as f32, (i / 7) as f32, (i * i % 5) as f32 * 0.5))
        .collect();
    let grid = ControlGrid::new(7, points, [Ends::Kept; 2]).expect("7 × 5");
    let polygons = grid.to_polygons().expect("small");
    let scheme = Subdivision::new(Scheme::CatmullClark);
    let (_, at) = limits::<IndexedFaceSet>(&scheme, &polygons, &Creases::default());
    for (number, &limit) in at.iter().enumerate() {
        let (u, v) = ((number % 7) as f64, (number / 7) as f64);
        let patch = |u: f64, v: f64| {
            grid.evaluate(u.clamp(0.0, 6.0), v.clamp(0.0, 4.0))
                .expect("inside")
        };
        let (position, normal) = defined(limit);
        assert!(position.distance(patch(u, v)) < 1e-5);
        let h = 1e-2;
        let along = patch(u + h, v) - patch(u - h, v);
        let up = patch(u, v + h) - patch(u, v - h);
        let LimitNormal::One(normal) = normal else {
            panic!("{normal:?}")
        };
        let expected = along.cross(up).normalize();
        assert!(
            normal.dot(expected) > 0.9995,
            "{u} {v}: {normal} {expected}"
        );
    }
}

#[test]
fn undefined_limits_have_the_expected_reason() {
    let scheme = Subdivision::new(Scheme::CatmullClark);
    let cube = sixfold_shapes::cube();
    let mesh = HalfEdgeMesh::from_polygons(&cube).expect("a cube");
    let neighbours: Vec<u32> = mesh
        .vertex_vertices(VertexId::new(0))
        .map(|w| w.index() as u32)
        .collect();
    let first = |edges: &[f32], own: f32| {
        let edges = edges.iter().zip(&neighbours).map(|(&s, &w)| ([0, w], s));
        let creases = Creases::new(&cube, edges, [(0, own)]).expect("edges of a cube");
        limits::<HalfEdgeMesh>(&scheme, &cube, &creases).1[0]
    };
    let corner = LimitPoint::Defined {
        position: cube.positions()[0],
        normal: LimitNormal::Undefined,
    };
    let infinite = f32::INFINITY;
    let undefined = LimitPoint::Undefined;
    assert_eq!(first(&[9.9], 0.0), undefined(NoLimit::SemiSharp));
    assert_eq!(
        first(&[infinite, 10.0, 0.5], 0.0),
        undefined(NoLimit::SemiSharp)
    );
    assert_eq!(first(&[], 3.0), undefined(NoLimit::SemiSharp));
    assert_eq!(first(&[infinite], 0.0), undefined(NoLimit::Dart));
    assert_eq!(first(&[infinite; 3], 0.5), corner);
    assert_eq!(first(&[0.5], infinite), corner);
    assert!(first(&[infinite; 2], 0.0).position().is_some());
    // Next to pentagons, the limit is defined on a crease. After one step, it is defined
    // everywhere.
    let polygons = sixfold_shapes::dodecahedron();
    let (control, at) = limits::<IndexedFaceSet>(&scheme, &polygons, &Creases::default());
    assert!(
        at.iter()
            .all(|&limit| limit == undefined(NoLimit::NotAllQuads))
    );
    let after = step(&scheme, &polygons, &control);
    let (_, at) = limits::<IndexedFaceSet>(&scheme, &after.polygons, &after.creases);
    assert!(at.iter().all(|limit| limit.normal().is_some()));
    let pentagon = sixfold_shapes::dodecahedron()
        .faces()
        .iter()
        .next()
        .map(|(_, face)| face.to_vec());
    let pentagon: Vec<u32> = pentagon
        .expect("twelve")
        .iter()
        .map(|v| v.index() as u32)
        .collect();
    let single =
        PolygonMesh::new(polygons.positions().iter().copied(), [pentagon.clone()]).expect("a face");
    let (_, at) = limits::<IndexedFaceSet>(&scheme, &single, &Creases::default());
    let corner = at[pentagon[0] as usize];
    assert_eq!(
        corner.position(),
        Some(polygons.positions()[pentagon[0] as usize])
    );
    assert!(corner.normal().is_some());
    let rounded = Subdivision {
        boundary: BoundaryRule::EdgeOnly,
        ..scheme
    };
    let (_, at) = limits::<IndexedFaceSet>(&rounded, &single, &Creases::default());
    let (_, normal) = defined(at[pentagon[0] as usize]);
    assert_eq!(normal, LimitNormal::Undefined);
    // A book with three pages.
    let places = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| Point::new(x, x * x, 1.0));
    let book = PolygonMesh::new(places, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]).expect("a book");
    let scheme = Subdivision::new(Scheme::Loop);
    let (_, at) = limits::<IndexedFaceSet>(&scheme, &book, &Creases::default());
    assert_eq!(at[0].position(), Some(places[0]));
}

#[test]
fn other_schemes_return_no_limit() {
    let mesh = HalfEdgeMesh::from_polygons(&sixfold_shapes::cube()).expect("a cube");
    for scheme in Scheme::ALL {
        let limit = Subdivision::new(scheme).limit(&mesh, &Creases::default());
        match scheme {
            Scheme::CatmullClark => assert!(limit.is_ok()),
            Scheme::Loop => {
                let error = limit.map(|_| ()).unwrap_err();
                assert!(matches!(
                    error,
                    SubdivisionError::NotATriangle { degree: 4, .. }
                ));
            }
            _ => {
                let error = limit.map(|_| ()).unwrap_err();
                assert_eq!(error, SubdivisionError::NoLimit { scheme });
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_step_does_not_change_the_limit(
        polygons in manifold_mesh(),
        picks in prop::collection::vec((any::<prop::sample::Index>(), 0..5_usize), 0..12),
        scheme in prop::sample::select(SCHEMES.to_vec()),
        boundary in prop::sample::select(vec![BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner]),
    ) {
        let scheme = Subdivision { boundary, ..Subdivision::new(scheme) };
        let polygons = match scheme.scheme {
            Scheme::Loop => polygons.triangulated().expect("small").polygons,
            _ => polygons,
        };
        let sharpness = |kind: usize| [0.7, 1.0, 2.5, 10.0, f32::INFINITY][kind];
        let mut edges = Vec::new();
        for (pick, kind) in picks {
            let face = pick.index(polygons.face_count());
            let face = polygons.faces().face(sixfold_core::FaceId::new(face as u32));
            let corner = pick.index(face.len());
            let ends = [face[corner], face[(corner + 1) % face.len()]];
            edges.push((ends.map(|v| v.index() as u32), sharpness(kind)));
        }
        let creases = Creases::new(&polygons, edges, []).expect("edges");
        let (mut creases, mut before) = limits::<IndexedFaceSet>(&scheme, &polygons, &creases);
        if let Ok(mesh) = HalfEdgeMesh::from_polygons(&polygons) {
            for (a, b) in limits_of(&scheme, &mesh, &creases).iter().zip(&before) {
                let near = |a: Option<Point>, b: Option<Point>| match (a, b) {
                    (Some(a), Some(b)) => a.distance(b) < 1e-4,
                    (a, b) => a == b,
                };
                prop_assert!(near(a.position(), b.position()), "{:?} {:?}", a, b);
            }
        }
        let size = polygons.positions().iter().map(|p| p.length()).fold(1.0, f32::max);
        let mut at = polygons;
        for _ in 0..3 {
            let after = step(&scheme, &at, &creases);
            let mesh = IndexedFaceSet::from_polygons(&after.polygons).expect("it accepts any mesh");
            let limits = limits_of(&scheme, &mesh, &after.creases);
            for (v, (a, b)) in before.iter().zip(&limits).enumerate() {
                let (Some(p), Some(q)) = (a.position(), b.position()) else {
                    prop_assert!(a.position().is_none(), "{}: {:?} {:?}", v, a, b);
                    continue;
                };
                prop_assert!(p.distance(q) < 1e-5 * size, "{}: {:?} {:?}", v, a, b);
                // The order of the two sides depends on the vertex numbers.
                let (m, n) = (normals(*a), normals(*b));
                let known = |m: &Point| n.is_empty() || n.iter().any(|n| m.dot(*n) > 0.98);
                prop_assert!(m.iter().all(known), "{}: {:?} {:?}", v, a, b);
            }
            (at, creases, before) = (after.polygons, after.creases, limits);
        }
    }
}

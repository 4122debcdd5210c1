//! Checks laws of every scheme on random manifolds with random creases: element counts, symmetry
//! and other invariants.

#[path = "subdivision_laws/regular.rs"]
mod regular;

use proptest::prelude::*;
use proptest::sample::{Index, select};
use sixfold::subdivision::{
    BoundaryRule, Creasing, Extent, FaceKind, LoopWeights, Method, Scheme, Step, Subdivision,
    subdivide, subdivide_native,
};
use sixfold::{
    Creases, Facts, HalfEdgeMesh, IndexedFaceSet, Point, PolygonMesh, Representation, VertexId,
};
use sixfold_conformance::strategy::manifold_mesh;

use crate::subdivision::{creases_on, sharpness};

/// Maximum distance of two equal points, relative to the size of the mesh.
const TOLERANCE: f32 = 1e-5;

#[derive(Clone, Debug)]
struct Case {
    subdivision: Subdivision,
    polygons: PolygonMesh,
    creases: Creases,
}

impl Case {
    fn subdivided(&self, levels: u32) -> Step {
        subdivided(&self.subdivision, &self.polygons, &self.creases, levels)
    }

    fn scheme(&self) -> Scheme {
        self.subdivision.scheme
    }
}

fn subdivided(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
) -> Step {
    let method = Method::Gather;
    let step = subdivide::<IndexedFaceSet>(subdivision, method, polygons, creases, levels);
    step.expect("the scheme accepts the mesh")
}

fn cases_with(
    schemes: &[Scheme],
    boundaries: &[BoundaryRule],
) -> impl Strategy<Value = Case> + use<> {
    let options = (
        select(schemes.to_vec()),
        select(boundaries.to_vec()),
        select(Creasing::ALL.to_vec()),
        select(LoopWeights::ALL.to_vec()),
    );
    let parts = (options, manifold_mesh(), sharpness());
    parts.prop_filter_map(
        "triangulation can give one edge to two polygons",
        |((scheme, boundary, creasing, loop_weights), polygons, choices)| {
            let polygons = for_scheme(scheme, polygons)?;
            let creases = creases_for(scheme, &polygons, &choices);
            let subdivision = Subdivision {
                scheme,
                boundary,
                creasing,
                loop_weights,
            };
            Some(Case {
                subdivision,
                polygons,
                creases,
            })
        },
    )
}

fn cases() -> impl Strategy<Value = Case> {
    cases_with(&Scheme::ALL, &BoundaryRule::ALL)
}

fn creases_for(scheme: Scheme, polygons: &PolygonMesh, choices: &[(Index, Index, f32)]) -> Creases {
    match scheme.properties().creases {
        true => creases_on(polygons, choices),
        false => Creases::default(),
    }
}

/// Triangulates the mesh if the scheme accepts only triangles. Returns `None` if the result is not
/// a manifold or contains a triangle twice.
fn for_scheme(scheme: Scheme, polygons: PolygonMesh) -> Option<PolygonMesh> {
    if scheme.properties().takes != FaceKind::Triangles {
        return Some(polygons);
    }
    let polygons = polygons.triangulated().ok()?.polygons;
    is_plain_manifold(&polygons).then_some(polygons)
}

fn is_plain_manifold(polygons: &PolygonMesh) -> bool {
    let has_duplicates = Facts::from_polygons(polygons).duplicate_faces > 0;
    !has_duplicates && HalfEdgeMesh::from_polygons(polygons).is_ok()
}

fn map_positions(polygons: &PolygonMesh, place: impl Fn(Point) -> Point) -> PolygonMesh {
    let positions = polygons.positions().iter().copied().map(place).collect();
    PolygonMesh::from_faces(positions, polygons.faces().clone()).expect("the same faces")
}

fn size(polygons: &PolygonMesh) -> f32 {
    let sizes = polygons.positions().iter().map(|p| p.abs().max_element());
    sizes.fold(0.0, f32::max)
}

/// Returns the valence of each vertex, and whether the vertex is on the boundary.
fn valences(polygons: &PolygonMesh) -> Vec<(usize, bool)> {
    let mut valences = vec![(0, false); polygons.vertex_count()];
    for edge in polygons.edge_uses() {
        for v in edge.ends {
            let (valence, is_open) = &mut valences[v.index()];
            *valence += 1;
            *is_open |= edge.is_boundary();
        }
    }
    valences
}

/// Returns the numbers of vertices, edges and faces of a manifold after step `level`.
///
/// ```text
///                        V′             E′             F′             C corners, b boundary edges
///   quads                V + E + F      2E + C         C
///   triangles            V + E          2E + 3F        4F
///   √3, even steps       V + F          E + 3F         3F
///   √3, odd steps        V + F + 2b     E + 3F + 4b    3F + 2b
///   Doo–Sabin            C              C + 2(E − b)   F + (E − b) + inner vertices
/// ```
///
/// Doo–Sabin turns an inner vertex of valence 2 into an edge instead of a face.
fn expected_counts(scheme: Scheme, polygons: &PolygonMesh, level: u32) -> [usize; 3] {
    let facts = Facts::from_polygons(polygons);
    let (v, e, f) = (facts.vertices, facts.edges, facts.faces);
    let (c, b) = (polygons.corner_count(), facts.boundary_edges);
    match scheme {
        Scheme::CatmullClark | Scheme::Bilinear => [v + e + f, 2 * e + c, c],
        Scheme::Loop | Scheme::Butterfly | Scheme::Midpoint => [v + e, 2 * e + 3 * f, 4 * f],
        Scheme::Sqrt3 if level.is_multiple_of(2) => [v + f, e + 3 * f, 3 * f],
        Scheme::Sqrt3 => [v + f + 2 * b, e + 3 * f + 4 * b, 3 * f + 2 * b],
        Scheme::DooSabin => {
            let valences = valences(polygons);
            let inner = valences.iter().filter(|&&(n, is_open)| n > 2 && !is_open);
            let pinched = valences.iter().filter(|&&(n, is_open)| n == 2 && !is_open);
            let (inner, pinched) = (inner.count(), pinched.count());
            [c, c + 2 * (e - b) - pinched, f + (e - b) + inner]
        }
        other => panic!("{other} has no formula here"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 96, ..ProptestConfig::default() })]

    /// `BoundaryRule::None` removes faces, so it is not used here.
    #[test]
    fn topology_is_kept_and_counts_follow_the_formulas(
        start in cases_with(&Scheme::ALL, &[BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly]),
    ) {
        let before = Facts::from_polygons(&start.polygons);
        let (mut parent, mut extent) = (start.polygons.clone(), Extent::from_polygons(&start.polygons));
        for level in 0..2 {
            let child = start.subdivided(level + 1).polygons;
            let facts = Facts::from_polygons(&child);
            let expected = expected_counts(start.scheme(), &parent, level);
            prop_assert_eq!([facts.vertices, facts.edges, facts.faces], expected);
            extent = start.subdivision.refined_extent(&extent, level);
            let Extent { counts, .. } = extent;
            prop_assert_eq!([counts.vertices, counts.edges, counts.faces], expected);
            prop_assert_eq!(counts.corners, child.corner_count());
            prop_assert_eq!(extent.boundary_edges, facts.boundary_edges);
            prop_assert_eq!(facts.euler_characteristic, before.euler_characteristic);
            prop_assert_eq!(facts.components, before.components);
            prop_assert_eq!(facts.boundary_loops, before.boundary_loops);
            prop_assert_eq!(facts.genus, before.genus);
            prop_assert_eq!(facts.consistently_oriented, before.consistently_oriented);
            prop_assert_eq!(facts.non_manifold_vertices, 0);
            let degree = match start.scheme().properties().makes {
                FaceKind::Quads => Some(4),
                FaceKind::Triangles => Some(3),
                FaceKind::Polygons => None,
            };
            for (f, face) in child.faces().iter() {
                prop_assert!(degree.is_none_or(|degree| face.len() == degree), "{}", f);
            }
            parent = child;
        }
    }

    #[test]
    fn valences_are_kept(
        start in cases_with(&Scheme::ALL, &[BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly]),
    ) {
        let (old, new) = (valences(&start.polygons), valences(&start.subdivided(1).polygons));
        let (vertices, faces) = (old.len(), start.polygons.face_count());
        let kept = old.iter().zip(&new);
        let regular = |from: usize, inside: usize, rim: usize| {
            let all = new[from..].iter();
            all.copied().all(|(valence, is_open)| valence == if is_open { rim } else { inside })
        };
        match start.scheme() {
            Scheme::CatmullClark | Scheme::Bilinear => {
                prop_assert!(kept.clone().all(|(old, new)| old == new));
                for (f, face) in start.polygons.faces().iter() {
                    prop_assert_eq!(new[vertices + f.index()], (face.len(), false));
                }
                prop_assert!(regular(vertices + faces, 4, 3));
            }
            Scheme::Loop | Scheme::Butterfly | Scheme::Midpoint => {
                prop_assert!(kept.clone().all(|(old, new)| old == new));
                prop_assert!(regular(vertices, 6, 4));
            }
            // The new edges of a boundary vertex lead to its faces, and two old edges remain.
            Scheme::Sqrt3 => {
                let expected_valence = |&(valence, is_open): &(usize, bool)| (valence + usize::from(is_open), is_open);
                prop_assert!(kept.clone().all(|(old, new)| expected_valence(old) == *new));
                // A face point is adjacent to three corners and to at most three other face points.
                prop_assert!(new[vertices..].iter().all(|&(valence, _)| (3..=6).contains(&valence)));
            }
            Scheme::DooSabin => {
                let pinched = old.iter().any(|&(valence, is_open)| valence == 2 && !is_open);
                let inside = new.iter().filter(|&&(_, is_open)| !is_open);
                let mut inside = inside.map(|&(valence, _)| valence);
                prop_assert!(inside.all(|valence| valence == 4 || pinched && valence == 3));
            }
            other => panic!("{other} has no rule here"),
        }
    }

    #[test]
    fn affine_maps_commute(
        start in cases(),
        matrix in prop::array::uniform3(prop::array::uniform3(-2.0_f32..2.0)),
        shift in prop::array::uniform3(-5.0_f32..5.0),
    ) {
        let [x, y, z] = matrix.map(Point::from);
        let map = |p: Point| Point::new(x.dot(p), y.dot(p), z.dot(p)) + Point::from(shift);
        let first = map_positions(&start.polygons, map);
        let first = subdivided(&start.subdivision, &first, &start.creases, 2);
        let step = start.subdivided(2);
        let last = map_positions(&step.polygons, map);
        prop_assert_eq!(first.polygons.faces(), last.faces());
        prop_assert_eq!(first.creases, step.creases);
        let size = 10.0 + 6.0 * size(&start.polygons);
        for (v, (a, b)) in first.polygons.positions().iter().zip(last.positions()).enumerate() {
            prop_assert!(a.distance(*b) <= TOLERANCE * size, "v{}: {} and {}", v, a, b);
        }
    }

    /// Equal points do not move if the weights of every stencil add up to 1.
    #[test]
    fn weights_are_a_partition_of_unity(start in cases()) {
        let place = Point::new(1.0, -3.0, 0.7);
        let all = map_positions(&start.polygons, |_| place);
        let step = subdivided(&start.subdivision, &all, &start.creases, 2);
        for (v, p) in step.polygons.positions().iter().enumerate() {
            prop_assert!((*p - place).abs().max_element() < 2e-6, "v{}: {}", v, p);
        }
    }

    #[test]
    fn planar_meshes_stay_planar(start in cases()) {
        let flat = map_positions(&start.polygons, |p| Point::new(p.x, p.y, 0.0));
        let step = subdivided(&start.subdivision, &flat, &start.creases, 2);
        prop_assert!(step.polygons.positions().iter().all(|p| p.z == 0.0));
    }

    #[test]
    fn symmetric_meshes_stay_symmetric(start in cases()) {
        let Some((double, mirror)) = mirrored_double(&start) else { return Ok(()) };
        let step = subdivided(&double.subdivision, &double.polygons, &double.creases, 2);
        let points = step.polygons.positions();
        let tolerance = TOLERANCE * size(&double.polygons);
        let other_side = |p: Point| Point::new(-p.x, p.y, p.z);
        if start.scheme() != Scheme::DooSabin {
            for (v, &mirrored) in mirror.iter().enumerate() {
                let distance = other_side(points[v]).distance(points[mirrored]);
                prop_assert!(distance <= tolerance, "v{} at {}, v{} at {}", v, points[v], mirrored, points[mirrored]);
            }
        }
        for &p in points {
            let expected = other_side(p);
            prop_assert!(points.iter().any(|p| p.distance(expected) <= tolerance), "no point at {}", expected);
        }
    }

    #[test]
    fn interpolating_schemes_keep_old_vertices(
        start in cases_with(&[Scheme::Butterfly, Scheme::Midpoint, Scheme::Bilinear], &BoundaryRule::ALL),
        levels in 1..3_u32,
    ) {
        prop_assert!(start.scheme().properties().interpolating);
        let step = start.subdivided(levels);
        let bits = |p: &Point| p.to_array().map(f32::to_bits);
        let (old, new) = (start.polygons.positions(), step.polygons.positions());
        prop_assert!(old.iter().zip(new).all(|(old, new)| bits(old) == bits(new)));
    }

    #[test]
    fn zero_levels_give_the_mesh_itself(
        start in cases_with(&Scheme::ALL, &[BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly]),
    ) {
        let Case { subdivision, polygons, creases } = &start;
        let itself = Step { polygons: polygons.clone(), creases: creases.clone() };
        for method in [Method::Gather, Method::Scatter] {
            let step = subdivide::<IndexedFaceSet>(subdivision, method, polygons, creases, 0);
            prop_assert_eq!(step.as_ref(), Ok(&itself));
        }
        let step = subdivide_native::<HalfEdgeMesh>(subdivision, polygons, creases, 0);
        prop_assert_eq!(step, Ok(itself));
    }
}

/// Joins a mesh and its mirror image along the boundary, which lies in x = 0. Returns the joined
/// mesh, and the mirror vertex of each vertex. Returns `None` if the result is not a manifold.
///
/// ```text
///       boundary
///    a′ ─── o ─── a     a at x > 0, a′ at −x; creases on both sides alike
///    │      │     │
///    b′ ─── p ─── b
/// ```
fn mirrored_double(start: &Case) -> Option<(Case, Vec<usize>)> {
    let half = &start.polygons;
    let is_open: Vec<bool> = valences(half).iter().map(|&(_, is_open)| is_open).collect();
    let mut points: Vec<Point> = Vec::new();
    for (p, &is_open) in half.positions().iter().zip(&is_open) {
        let x = if is_open { 0.0 } else { p.x.abs() + 1.0 };
        points.push(Point::new(x, p.y, p.z));
    }
    let mut mirror: Vec<usize> = (0..points.len()).collect();
    for v in half.vertices().filter(|v| !is_open[v.index()]) {
        let p = points[v.index()];
        mirror[v.index()] = points.len();
        mirror.push(v.index());
        points.push(Point::new(-p.x, p.y, p.z));
    }
    let number = |v: &VertexId| v.index() as u32;
    let mirrored = |v: &VertexId| mirror[v.index()] as u32;
    let faces = half.faces().iter().flat_map(|(_, face)| {
        let original: Vec<u32> = face.iter().map(number).collect();
        let reflected: Vec<u32> = face.iter().rev().map(mirrored).collect();
        [original, reflected]
    });
    let polygons = PolygonMesh::new(points, faces.collect::<Vec<_>>()).ok()?;
    if !is_plain_manifold(&polygons) {
        return None;
    }
    let edges = start.creases.edges().iter().flat_map(|&(pair, s)| {
        let ends = pair.ends();
        [
            (ends.each_ref().map(number), s),
            (ends.each_ref().map(mirrored), s),
        ]
    });
    let corners = start.creases.corners().iter();
    let corners = corners.flat_map(|(v, s)| [(number(v), *s), (mirrored(v), *s)]);
    let creases = Creases::new(&polygons, edges, corners).expect("edges of both halves");
    let subdivision = start.subdivision;
    let double = Case {
        subdivision,
        polygons,
        creases,
    };
    Some((double, mirror))
}

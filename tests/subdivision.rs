//! Checks that all methods and structures give the same mesh for every scheme.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use sixfold::subdivision::{BoundaryRule, Creasing, FaceKind, Method, Scheme, Step, Subdivision};
use sixfold::{
    Creases, Point, PolygonMesh, Refine, Representation, VertexId, for_each_refinable,
    for_each_representation,
};
use sixfold_conformance::strategy::{any_mesh, manifold_mesh};
use sixfold_conformance::{gallery, one_line, welded};

/// Maximum distance of two equal points, relative to the size of the mesh.
const TOLERANCE: f32 = 4e-6;

/// Runs one step by one method on a structure. Returns `None` if the structure cannot hold the
/// mesh, or the scheme does not support the method.
fn step_by_polygons<M: Representation>(
    subdivision: &Subdivision,
    method: Method,
    polygons: &PolygonMesh,
    creases: &Creases,
    level: u32,
) -> Option<Result<Step, String>> {
    let mesh = M::from_polygons(polygons).ok()?;
    let creases = match subdivision.control_creases(&mesh, polygons, creases) {
        Ok(creases) => creases,
        Err(refusal) => return Some(Err(refusal.to_string())),
    };
    let step = match method {
        Method::Gather => subdivision.gather(&mesh, &creases, level),
        Method::Scatter if !subdivision.scheme.properties().scatter => return None,
        _ => subdivision.scatter(&mesh, &creases, level),
    };
    Some(step.map_err(|refusal| refusal.to_string()))
}

/// Runs one native step on one thread and on three threads, and checks that the results are
/// bit-identical.
fn native<M: Refine>(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    level: u32,
) -> Option<Result<Step, String>> {
    let split = subdivision.split(level)?;
    if !M::SPLITS.iter().any(|known| known.name() == split.name()) {
        return None;
    }
    let mesh = M::from_polygons(polygons).ok()?;
    let refined = || {
        let creases = subdivision.control_creases(&mesh, polygons, creases);
        let creases = creases.map_err(|refusal| refusal.to_string())?;
        let (mut numbers, mut child) = (M::EdgeNumbers::default(), M::empty());
        let creases = subdivision
            .refine_into(&mesh, &creases, level, &mut numbers, &mut child)
            .map_err(|refusal| refusal.to_string())?;
        child.validate().expect("a valid child");
        let polygons = child.to_polygons();
        Ok(Step { polygons, creases })
    };
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let [one, three] = [1, 3].map(|threads| pool(threads).expect("threads").install(refined));
    assert_eq!(one, three, "{}: one thread and three", M::NAME);
    Some(one)
}

/// Returns `step` with the vertex numbers of `first`, matched by position. Returns `None` if two
/// vertices of `first` have the same position.
fn renumbered_like(step: &Step, first: &Step) -> Option<Step> {
    let size = extent(&first.polygons);
    let near = |a: Point, b: Point| a.distance(b) <= TOLERANCE * size;
    let places = first.polygons.positions();
    let mut numbers = Vec::new();
    for &point in step.polygons.positions() {
        let mut at = (0_u32..)
            .zip(places)
            .filter(|&(_, &place)| near(point, place));
        let (number, _) = at.next().unwrap_or_else(|| {
            let least = places
                .iter()
                .map(|p| p.distance(point))
                .fold(f32::MAX, f32::min);
            panic!("no match for {point}: the nearest is {least} away, the mesh size is {size}")
        });
        if at.next().is_some() {
            return None;
        }
        numbers.push(number);
    }
    let edges = step.creases.edges().iter();
    let number = |v: VertexId| numbers[v.index()];
    let edges = edges.map(|&(ends, sharpness)| (ends.ends().map(number), sharpness));
    let corners = step.creases.corners().iter();
    let corners = corners.map(|&(v, sharpness)| (number(v), sharpness));
    let polygons = step.polygons.renumbered(&numbers);
    let creases = Creases::new(&polygons, edges, corners).expect("creases of the mesh");
    Some(Step { polygons, creases })
}

fn extent(polygons: &PolygonMesh) -> f32 {
    let sizes = polygons.positions().iter().map(|p| p.abs().max_element());
    sizes.fold(1e-30, f32::max)
}

/// Returns the sorted faces, each starting at its lowest vertex.
fn faces(polygons: &PolygonMesh) -> Vec<Vec<VertexId>> {
    let rotate_to_lowest = |face: &[VertexId]| {
        let lowest = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
        let mut face = face.to_vec();
        face.rotate_left(lowest);
        face
    };
    let all = polygons.faces().iter();
    let mut all: Vec<_> = all.map(|(_, face)| rotate_to_lowest(face)).collect();
    all.sort();
    all
}

fn assert_same_step(step: &Step, first: &Step, what: &str) {
    let sizes = |step: &Step| (step.polygons.vertex_count(), step.polygons.face_count());
    assert_eq!(sizes(step), sizes(first), "{what}");
    let Some(step) = renumbered_like(step, first) else {
        return;
    };
    assert_eq!(
        faces(&step.polygons),
        faces(&first.polygons),
        "faces, {what}"
    );
    let keys = |step: &Step| {
        let edges: Vec<_> = step.creases.edges().iter().map(|&(ends, _)| ends).collect();
        let corners: Vec<_> = step.creases.corners().iter().map(|&(v, _)| v).collect();
        (edges, corners)
    };
    assert_eq!(keys(&step), keys(first), "creases, {what}");
    for (a, b) in step.creases.edges().iter().zip(first.creases.edges()) {
        let difference = (a.1 - b.1).abs();
        assert!(a.1 == b.1 || difference < 1e-5, "{a:?} and {b:?}, {what}");
    }
}

/// Runs `levels` steps by all methods on all structures, and compares the results of each step. The
/// next step starts from the first result. Returns the number of comparisons.
fn compare_methods(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
) -> usize {
    let (mut polygons, mut creases) = (polygons.clone(), creases.clone());
    let mut compared = 0;
    for level in 0..levels {
        // A soup numbers vertices in the order of the faces, and can merge vertices after a step.
        let Ok(mesh) = welded(&polygons) else { break };
        if mesh != polygons && level > 0 {
            break;
        }
        let mut first: Option<(Step, String)> = None;
        let (mut refused, mut made) = (0, 0);
        let mut compare = |name: &str, method: Method, done: Option<Result<Step, String>>| {
            let what = format!(
                "{} by {method} on {name}, level {level}, of {}",
                subdivision.scheme,
                one_line(&polygons)
            );
            match (done, &first) {
                (None, _) => {}
                // Polygons can have two edges with the same ends, but native edge tables cannot.
                (Some(Err(why)), Some(_)) if method == Method::Native => {
                    assert!(why.contains("share two edges"), "{what}: {why}");
                }
                (Some(Err(_)), _) => refused += 1,
                (Some(Ok(step)), None) => first = Some((step, what)),
                (Some(Ok(step)), Some((other, before))) => {
                    assert_same_step(&step, other, &format!("{what}, against {before}"));
                    made += 1;
                }
            }
        };
        for method in [Method::Gather, Method::Scatter] {
            for_each_representation!(M => {
                compare(M::NAME, method, step_by_polygons::<M>(subdivision, method, &polygons, &creases, level));
            });
        }
        for_each_refinable!(M => {
            compare(M::NAME, Method::Native, native::<M>(subdivision, &polygons, &creases, level));
        });
        assert!(
            refused == 0 || first.is_none(),
            "{}: some refuse, others do not",
            one_line(&polygons)
        );
        compared += made;
        let Some((step, _)) = first else { break };
        (polygons, creases) = (step.polygons, step.creases);
    }
    compared
}

pub(crate) fn sharpness() -> impl Strategy<Value = Vec<(Index, Index, f32)>> {
    let value = prop_oneof![
        Just(0.3_f32),
        Just(0.5),
        Just(1.0),
        Just(1.5),
        Just(2.25),
        Just(3.75),
        Just(10.0),
        Just(f32::INFINITY),
        0.01_f32..4.0,
    ];
    vec((any::<Index>(), any::<Index>(), value), 0..8)
}

/// Builds creases on `polygons` from `choices`. Every second crease starts at a vertex of an
/// earlier crease.
pub(crate) fn creases_on(polygons: &PolygonMesh, choices: &[(Index, Index, f32)]) -> Creases {
    let edges = polygons.edge_uses();
    if edges.is_empty() {
        return Creases::default();
    }
    let (mut sharp, mut corners) = (Vec::new(), Vec::new());
    let mut hub = edges[0].ends[0];
    for (i, (edge, vertex, sharpness)) in choices.iter().enumerate() {
        match i % 4 {
            0 => {
                let ends = edge.get(&edges).ends;
                hub = ends[0];
                sharp.push((ends.map(|v| v.index() as u32), *sharpness));
            }
            1 | 2 => {
                let at_hub: Vec<_> = edges.iter().filter(|e| e.ends.contains(&hub)).collect();
                let ends = edge.get(&at_hub).ends;
                sharp.push((ends.map(|v| v.index() as u32), *sharpness));
            }
            _ => {
                let v = vertex.index(polygons.vertex_count()) as u32;
                corners.push((v, *sharpness));
            }
        }
    }
    Creases::new(polygons, sharp, corners).expect("edges and vertices of the mesh")
}

/// Triangulates the mesh if the scheme accepts only triangles, and numbers the vertices like a
/// soup.
fn for_scheme(scheme: Scheme, polygons: &PolygonMesh) -> Option<PolygonMesh> {
    let polygons = match scheme.properties().takes {
        FaceKind::Triangles => polygons.triangulated().ok()?.polygons,
        _ => polygons.clone(),
    };
    welded(&polygons).ok()
}

fn schemes() -> impl Strategy<Value = Subdivision> {
    let scheme = prop::sample::select(Scheme::ALL.to_vec());
    let boundary = prop::sample::select(BoundaryRule::ALL.to_vec());
    let creasing = prop::sample::select(Creasing::ALL.to_vec());
    (scheme, boundary, creasing).prop_map(|(scheme, boundary, creasing)| Subdivision {
        boundary,
        creasing,
        ..Subdivision::new(scheme)
    })
}

#[test]
fn all_methods_agree_on_the_gallery() {
    for scheme in Scheme::ALL {
        let subdivision = Subdivision::new(scheme);
        let mut compared = 0;
        for entry in gallery() {
            if let Some(polygons) = for_scheme(scheme, &entry.polygons) {
                compared += compare_methods(&subdivision, &polygons, &Creases::default(), 2);
            }
        }
        assert!(compared > 50, "{scheme}: only {compared} compared");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn all_methods_agree_on_manifolds(
        subdivision in schemes(),
        polygons in manifold_mesh(),
        choices in sharpness(),
    ) {
        if let Some(polygons) = for_scheme(subdivision.scheme, &polygons) {
            let creases = match subdivision.scheme.properties().creases {
                true => creases_on(&polygons, &choices),
                false => Creases::default(),
            };
            compare_methods(&subdivision, &polygons, &creases, 3);
        }
    }

    #[test]
    fn all_methods_agree_on_any_mesh(
        subdivision in schemes(),
        polygons in any_mesh(),
        choices in sharpness(),
    ) {
        if let Some(polygons) = for_scheme(subdivision.scheme, &polygons) {
            let creases = match subdivision.scheme.properties().creases {
                true => creases_on(&polygons, &choices),
                false => Creases::default(),
            };
            compare_methods(&subdivision, &polygons, &creases, 2);
        }
    }
}

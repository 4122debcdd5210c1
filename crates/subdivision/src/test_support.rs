//! Test helpers that compare meshes with different orders of faces and vertices.

use std::collections::BTreeMap;

use proptest::prelude::*;
use sixfold_core::{Creases, Point, PolygonMesh, Refine, Representation, VertexId};
use sixfold_corner_table::CornerTable;
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_indexed_face_set::IndexedFaceSet;

use crate::{Scheme, Step, Subdivision, SubdivisionError};

/// Generates oriented manifolds of triangles without repeated triangles.
pub(crate) fn triangle_mesh() -> impl Strategy<Value = PolygonMesh> {
    let fans = sixfold_conformance::strategy::manifold_mesh()
        .prop_map(|mesh| mesh.triangulated().expect("few corners").polygons);
    fans.prop_filter("two fans can share a diagonal", |mesh| {
        let mut faces: Vec<Vec<VertexId>> = Vec::new();
        for (_, face) in mesh.faces().iter() {
            let mut face = face.to_vec();
            face.sort();
            faces.push(face);
        }
        faces.sort();
        faces.windows(2).all(|pair| pair[0] != pair[1]) && HalfEdgeMesh::from_polygons(mesh).is_ok()
    })
}

pub(crate) fn build<M: Representation>(polygons: &PolygonMesh) -> M {
    M::from_polygons(polygons).expect("the structure accepts it")
}

/// Runs one step of `polygons` with each method of the scheme, on several structures.
pub(crate) fn all_methods(
    scheme: Scheme,
    polygons: &PolygonMesh,
    level: u32,
) -> Result<Vec<PolygonMesh>, SubdivisionError> {
    let subdivision = Subdivision::new(scheme);
    let none = Creases::default();
    let list: IndexedFaceSet = build(polygons);
    let halves: HalfEdgeMesh = build(polygons);
    let mut steps = vec![
        subdivision.gather(&list, &none, level)?,
        subdivision.gather(&halves, &none, level)?,
    ];
    if scheme.properties().scatter {
        steps.push(subdivision.scatter(&list, &none, level)?);
        steps.push(subdivision.scatter(&halves, &none, level)?);
    }
    let mut meshes: Vec<_> = steps.into_iter().map(|step: Step| step.polygons).collect();
    if scheme.properties().split.is_some() {
        meshes.push(native::<HalfEdgeMesh>(scheme, polygons, level)?);
        meshes.push(native::<CornerTable>(scheme, polygons, level)?);
    }
    Ok(meshes)
}

pub(crate) fn native<M: Refine>(
    scheme: Scheme,
    polygons: &PolygonMesh,
    level: u32,
) -> Result<PolygonMesh, SubdivisionError> {
    let (mesh, mut child): (M, M) = (build(polygons), M::empty());
    let (mut numbers, none) = (Default::default(), Creases::default());
    Subdivision::new(scheme).refine_into(&mesh, &none, level, &mut numbers, &mut child)?;
    Ok(child.to_polygons())
}

pub(crate) fn assert_same_on_threads(scheme: Scheme, level: u32) {
    let specimens = [
        sixfold_shapes::geodesic(24).expect("thousands of triangles"),
        sixfold_shapes::triangle_grid(70, 81).expect("thousands of triangles"),
    ];
    for polygons in &specimens {
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let step = || native::<HalfEdgeMesh>(scheme, polygons, level);
            pool.expect("threads can start")
                .install(step)
                .expect("triangles")
        });
        assert!(
            one == three,
            "{scheme}, level {level}: one thread and three threads differ"
        );
        let list: IndexedFaceSet = build(polygons);
        let gathered = Subdivision::new(scheme).gather(&list, &Creases::default(), level);
        let known = polygons.vertex_count();
        assert_equivalent(
            &gathered.expect("triangles").polygons,
            &one,
            match scheme {
                Scheme::Sqrt3 => known + polygons.face_count(),
                _ => known,
            },
        );
    }
}

/// Asserts that two meshes are equal. The orders of the faces and of the vertices from `known` on
/// may differ.
pub(crate) fn assert_equivalent(one: &PolygonMesh, other: &PolygonMesh, known: usize) {
    assert_eq!(one.vertex_count(), other.vertex_count(), "vertices");
    assert_eq!(one.face_count(), other.face_count(), "faces");
    let by_key: BTreeMap<_, usize> = keys(one, known)
        .into_iter()
        .enumerate()
        .map(|(v, key)| (key, v))
        .collect();
    let matching: Vec<usize> = keys(other, known)
        .into_iter()
        .enumerate()
        .map(|(v, key)| match v < known {
            true => v,
            false => by_key[&key],
        })
        .collect();
    for (v, &w) in matching.iter().enumerate() {
        let [a, b] = [one.positions()[w], other.positions()[v]];
        let near = 1e-5 * (1.0 + a.abs().max_element());
        assert!(a.distance(b) <= near, "v{w} at {a}, and v{v} at {b}");
    }
    let faces = |mesh: &PolygonMesh, number: &dyn Fn(usize) -> usize| {
        let mut faces: Vec<Vec<usize>> = Vec::new();
        for (_, face) in mesh.faces().iter() {
            let mut face: Vec<usize> = face.iter().map(|v| number(v.index())).collect();
            let lowest = (0..face.len()).min_by_key(|&i| face[i]);
            face.rotate_left(lowest.unwrap_or(0));
            faces.push(face);
        }
        faces.sort();
        faces
    };
    assert_eq!(faces(one, &|v| v), faces(other, &|v| matching[v]), "faces");
}

/// Returns a key for each vertex: the known vertices before and after the vertex in its faces.
fn keys(mesh: &PolygonMesh, known: usize) -> Vec<Vec<[Option<usize>; 2]>> {
    let mut keys = vec![Vec::new(); mesh.vertex_count()];
    for (_, face) in mesh.faces().iter() {
        let n = face.len();
        for (i, v) in face.iter().enumerate() {
            let adjacent = [face[(i + n - 1) % n], face[(i + 1) % n]];
            let known_only = adjacent.map(|w| Some(w.index()).filter(|&w| w < known));
            keys[v.index()].push(known_only);
        }
    }
    keys.iter_mut().for_each(|key| key.sort());
    keys
}

/// Asserts that a step commutes with an affine map, so the weights of every point sum to 1.
pub(crate) fn assert_affine(scheme: Scheme, polygons: &PolygonMesh, level: u32) {
    let map = |p: Point| {
        Point::new(
            2.0 * p.x - p.y + 3.0,
            0.5 * p.z + p.x - 7.0,
            p.y + p.z + 0.25 * p.x,
        )
    };
    let moved = |mesh: &PolygonMesh| {
        let positions = mesh.positions().iter().copied().map(map).collect();
        PolygonMesh::from_faces(positions, mesh.faces().clone()).expect("the same faces")
    };
    let step = |mesh: &PolygonMesh| {
        let step = Subdivision::new(scheme).gather(
            &build::<IndexedFaceSet>(mesh),
            &Creases::default(),
            level,
        );
        step.expect("a manifold").polygons
    };
    let (before, after) = (step(&moved(polygons)), moved(&step(polygons)));
    let size = after.positions().iter().map(|p| p.abs().max_element());
    let size = size.fold(1.0, f32::max);
    for (a, b) in before.positions().iter().zip(after.positions()) {
        assert!(a.distance(*b) <= 1e-5 * size, "{a} and {b}");
    }
    assert_eq!(before.faces(), after.faces());
}

pub(crate) fn assert_near(got: Point, expected: Point) {
    assert!(got.distance(expected) < 1e-6, "{got}, expected {expected}");
}

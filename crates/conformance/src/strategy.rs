//! Random meshes that shrink towards a single triangle.
//!
//! Manifolds are made, not filtered: shapes side by side, then surgery that keeps them manifolds
//! (`surgery`), then new names for everything (`draft`).

mod draft;
mod faults;
mod surgery;

use std::ops::RangeInclusive;

use mesh_core::PolygonMesh;
use proptest::prelude::*;
use proptest::{collection, sample};

use crate::gallery::spot;
use draft::Draft;
pub use faults::Fault;

/// A mesh with known faults.
#[derive(Clone, Debug)]
pub struct Faulty {
    /// The mesh.
    pub polygons: PolygonMesh,
    /// What is wrong with it; at least one.
    pub faults: Vec<Fault>,
}

/// Oriented manifolds of random topology: open and closed, with handles, several components, mixed
/// degrees, isolated vertices, and names in no order. Every vertex has a place of its own.
pub fn manifold_mesh() -> impl Strategy<Value = PolygonMesh> {
    let isolated = prop_oneof![4 => Just(0_u32), 1 => 1..4_u32];
    let parts = (seed(), any::<bool>(), isolated, draft(1..=3));
    parts.prop_map(|(seed, mirrored, isolated, mut draft)| {
        draft.isolated = isolated;
        if mirrored {
            draft.mirror();
        }
        draft.finish(seed)
    })
}

/// A manifold into which one to three faults have been put.
pub fn faulty_mesh() -> impl Strategy<Value = Faulty> {
    let faults = sample::subsequence(Fault::ALL.to_vec(), 1..=3);
    let parts = (seed(), faults, 0..1000_usize, draft(1..=2));
    parts.prop_map(|(seed, faults, at, mut draft)| {
        for fault in &faults {
            fault.put_into(&mut draft, at);
        }
        let polygons = draft.finish(seed);
        Faulty { polygons, faults }
    })
}

/// Any faces over a few vertices, most of them a mess; at times vertices share their places.
pub fn any_mesh() -> impl Strategy<Value = PolygonMesh> {
    let size = (3..9_u32, 0..10_usize, any::<[bool; 2]>());
    let faces = size.prop_flat_map(|(vertices, faces, shared)| {
        let all: Vec<u32> = (0..vertices).collect();
        let most = all.len().min(6);
        let face = sample::subsequence(all, 3..=most).prop_shuffle();
        let places = if shared == [true; 2] {
            collection::vec(0..vertices, vertices as usize).boxed()
        } else {
            Just((0..vertices).collect()).boxed()
        };
        (places, collection::vec(face, 0..=faces))
    });
    faces.prop_map(|(places, faces)| made_of(places, faces))
}

/// A mesh whose faces are choices of its vertices, one for each of `places`.
fn made_of(places: Vec<u32>, faces: Vec<Vec<u32>>) -> PolygonMesh {
    let points: Vec<_> = places.into_iter().map(spot).collect();
    PolygonMesh::new(points, faces).expect("a choice names no vertex twice")
}

/// Shapes side by side, after some surgery.
///
/// A quarter are triangulated in the end: some structures hold nothing else.
fn draft(pieces: RangeInclusive<usize>) -> impl Strategy<Value = Draft> {
    let pieces = collection::vec(piece(), pieces);
    let surgeries = collection::vec(surgery::surgery(), 0..12);
    // What comes first shrinks first: pieces go when nothing is done to them any more.
    let parts = (prop::bool::weighted(0.25), surgeries, pieces);
    parts.prop_map(|(triangulated, surgeries, pieces)| {
        let mut draft = Draft::of(&pieces);
        for surgery in surgeries {
            surgery.operate(&mut draft);
        }
        if triangulated {
            surgery::triangulate(&mut draft);
        }
        draft
    })
}

/// One shape, of few faces.
fn piece() -> impl Strategy<Value = PolygonMesh> {
    let polygon = (3..8_u32).prop_map(|n| {
        let all: Vec<u32> = (0..n).collect();
        made_of(all.clone(), vec![all])
    });
    let small = "a shape of this size can be made";
    prop_oneof![
        3 => polygon,
        1 => Just(shapes::tetrahedron()),
        1 => Just(shapes::cube()),
        1 => (3..7_usize).prop_map(move |n| shapes::prism(n).expect(small)),
        1 => (3..6_usize).prop_map(move |n| shapes::antiprism(n).expect(small)),
        1 => (3..5_usize, 3..5_usize).prop_map(move |(m, n)| shapes::uv_sphere(m, n).expect(small)),
        1 => (1..4_usize, 1..5_usize).prop_map(move |(m, n)| shapes::grid(m, n).expect(small)),
        1 => (1..4_usize, 1..4_usize).prop_map(move |(m, n)| shapes::mixed_grid(m, n).expect(small)),
        1 => (3..5_usize, 3..5_usize).prop_map(move |(m, n)| shapes::torus(m, n).expect(small)),
        1 => (3..5_usize, 3..5_usize).prop_map(move |(m, n)| shapes::triangle_torus(m, n).expect(small)),
    ]
}

/// What names are drawn from; zero keeps those there are.
fn seed() -> impl Strategy<Value = u64> {
    prop_oneof![1 => Just(0), 4 => 0..1000_u64]
}

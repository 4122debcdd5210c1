//! Generators of random meshes. If a test fails, the mesh is shrunk towards a single triangle.
//!
//! Random manifolds are constructed in three steps. First, shapes are placed side by side. Then
//! operations change the shapes, and the mesh stays manifold (file `operation.rs`). Finally, all
//! elements are renumbered (file `builder.rs`).

mod builder;
mod faults;
mod operation;
mod touching;

use std::ops::RangeInclusive;

use proptest::prelude::*;
use proptest::{collection, sample};
use sixfold_core::{Capabilities, PolygonMesh};

use crate::gallery::distinct_position;
use builder::MeshBuilder;
pub use faults::Fault;
pub use touching::{TouchingPolygon, touching_polygon};

/// A mesh with known faults.
#[derive(Clone, Debug)]
pub struct Faulty {
    /// The mesh.
    pub polygons: PolygonMesh,
    /// The faults of the mesh. A faulty mesh has at least one fault.
    pub faults: Vec<Fault>,
}

/// Generates oriented manifolds of random topology: open and closed, of any genus, with several
/// components, mixed degrees, isolated vertices, and random numbering. All vertices have different
/// positions.
pub fn manifold_mesh() -> impl Strategy<Value = PolygonMesh> {
    let isolated = prop_oneof![4 => Just(0_u32), 1 => 1..4_u32];
    let parts = (seed(), any::<bool>(), isolated, builder(1..=3));
    parts.prop_map(|(seed, mirrored, isolated, mut builder)| {
        builder.isolated = isolated;
        if mirrored {
            builder.reverse_faces();
        }
        builder.build(seed)
    })
}

/// Generates a manifold with one to three faults.
pub fn faulty_mesh() -> impl Strategy<Value = Faulty> {
    let faults = sample::subsequence(Fault::ALL.to_vec(), 1..=3);
    let parts = (seed(), faults, 0..1000_usize, builder(1..=2));
    parts.prop_map(|(seed, faults, at, mut builder)| {
        for fault in &faults {
            fault.add_to(&mut builder, at);
        }
        let polygons = builder.build(seed);
        Faulty { polygons, faults }
    })
}

/// Generates meshes with random faces on a few vertices. The meshes are rarely manifold. In some
/// meshes, several vertices have the same position.
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
    faces.prop_map(|(places, faces)| build_mesh(places, faces))
}

/// Generates any combination of capabilities. Most combinations belong to no structure.
pub fn any_capabilities() -> impl Strategy<Value = Capabilities> {
    any::<[bool; 6]>().prop_map(|[a, b, c, d, e, f]| Capabilities {
        polygons: a,
        non_manifold_edges: b,
        non_manifold_vertices: c,
        inconsistent_orientation: d,
        isolated_vertices: e,
        coincident_vertices: f,
    })
}

fn build_mesh(places: Vec<u32>, faces: Vec<Vec<u32>>) -> PolygonMesh {
    let points: Vec<_> = places.into_iter().map(distinct_position).collect();
    PolygonMesh::new(points, faces).expect("no face uses a vertex twice")
}

/// Generates shapes side by side, changed by some operations.
///
/// A quarter of the meshes are triangulated at the end, because some structures hold only
/// triangles.
fn builder(pieces: RangeInclusive<usize>) -> impl Strategy<Value = MeshBuilder> {
    let pieces = collection::vec(piece(), pieces);
    let operations = collection::vec(operation::operation(), 0..12);
    // Proptest shrinks the parts in this order: operations before pieces.
    let parts = (prop::bool::weighted(0.25), operations, pieces);
    parts.prop_map(|(triangulated, operations, pieces)| {
        let mut builder = MeshBuilder::from_meshes(&pieces);
        for operation in operations {
            operation.apply(&mut builder);
        }
        if triangulated {
            operation::triangulate(&mut builder);
        }
        builder
    })
}

fn piece() -> impl Strategy<Value = PolygonMesh> {
    let polygon = (3..8_u32).prop_map(|n| {
        let all: Vec<u32> = (0..n).collect();
        build_mesh(all.clone(), vec![all])
    });
    let message = "a shape of this size can be built";
    prop_oneof![
        3 => polygon,
        1 => Just(sixfold_shapes::tetrahedron()),
        1 => Just(sixfold_shapes::cube()),
        1 => (3..7_usize).prop_map(move |n| sixfold_shapes::prism(n).expect(message)),
        1 => (3..6_usize).prop_map(move |n| sixfold_shapes::antiprism(n).expect(message)),
        1 => (3..5_usize, 3..5_usize).prop_map(move |(m, n)| sixfold_shapes::uv_sphere(m, n).expect(message)),
        1 => (1..4_usize, 1..5_usize).prop_map(move |(m, n)| sixfold_shapes::grid(m, n).expect(message)),
        1 => (1..4_usize, 1..4_usize).prop_map(move |(m, n)| sixfold_shapes::mixed_grid(m, n).expect(message)),
        1 => (3..5_usize, 3..5_usize).prop_map(move |(m, n)| sixfold_shapes::torus(m, n).expect(message)),
        1 => (3..5_usize, 3..5_usize).prop_map(move |(m, n)| sixfold_shapes::triangle_torus(m, n).expect(message)),
    ]
}

/// Generates a seed for the renumbering; zero keeps the numbers.
fn seed() -> impl Strategy<Value = u64> {
    prop_oneof![1 => Just(0), 4 => 0..1000_u64]
}

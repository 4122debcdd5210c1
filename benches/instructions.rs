//! How many instructions do the hot loops take? Counted by callgrind, free of the clock's noise.
//!
//! ```text
//! apt-get install valgrind
//! cargo install gungraun-runner --version 0.20.0     # the version of gungraun in Cargo.lock
//! cargo bench -p sixfold-benches --bench instructions
//! ```
//!
//! It builds everywhere and runs where valgrind does. A plain `cargo bench` leaves it out
//! (`bench = false`), for it would not understand criterion's flags.
//!
//! A loop fails that takes 2 % more than in the run before, or more than its ceiling: about 1.3 ×
//! what rustc 1.95 made of it on x86-64. Baselines belong to one compiler and one machine, so none
//! are committed. To judge a change, name the state before it:
//!
//! ```text
//! cargo bench -p sixfold-benches --bench instructions -- --save-baseline=before
//! cargo bench -p sixfold-benches --bench instructions -- --baseline=before
//! ```

#![expect(missing_docs, reason = "gungraun's macros make public items without")]

use std::hint::black_box;

use gungraun::prelude::*;
use gungraun::{Callgrind, EventKind};
use sixfold::{
    CornerTable, FaceId, HalfEdgeMesh, MeshQuery, Point, PolygonMesh, PolygonSoup, Representation,
    TwinPairs, WingedEdgeMesh, shapes,
};

/// Some 5,120 triangles in random order, so that no loop profits from the order of a formula.
fn polygons() -> PolygonMesh {
    let sphere = shapes::geodesic(16).expect("a small frequency");
    shapes::shuffled(&sphere, 1)
}

/// What a loop may take at most, and how much more than in the run before.
fn at_most(instructions: u64) -> LibraryBenchmarkConfig {
    let mut callgrind = Callgrind::default();
    callgrind.soft_limits([(EventKind::Ir, 2.0)]);
    if cfg!(target_arch = "x86_64") {
        callgrind.hard_limits([(EventKind::Ir, instructions)]);
    }
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(callgrind);
    config
}

/// The mesh that a loop goes through; never freed, or that would be counted too.
fn built<M: Representation>() -> &'static M {
    let mesh = M::from_polygons(&polygons()).expect("a closed manifold of triangles");
    Box::leak(Box::new(mesh))
}

/// The sum of all neighbours' positions, over all vertices.
fn sweep_vertex_vertices<M: MeshQuery>(mesh: &M) -> Point {
    let mut sum = Point::ZERO;
    mesh.vertices().for_each(|v| {
        mesh.vertex_vertices(v)
            .for_each(|w| sum += mesh.position(w));
    });
    sum
}

/// The sum of all neighbours' rows, over all faces.
fn sweep_face_faces<M: MeshQuery<Face = FaceId>>(mesh: &M) -> usize {
    let mut sum = 0;
    mesh.faces().for_each(|f| {
        mesh.face_faces(f).for_each(|g| sum += g.index());
    });
    sum
}

/// The normals of all faces, stored, and the sum over all vertices of the normals around each.
fn vertex_normals<M: MeshQuery>(mesh: &M) -> Point {
    let mut by_face = mesh.face_map(Point::ZERO);
    mesh.faces().for_each(|f| {
        let mut corners = mesh.face_vertices(f).map(|v| mesh.position(v));
        let mut next = || corners.next().unwrap_or_default();
        let (a, b, c) = (next(), next(), next());
        by_face[f] = (b - a).cross(c - a);
    });
    let mut total = Point::ZERO;
    mesh.vertices().for_each(|v| {
        let mut sum = Point::ZERO;
        mesh.vertex_faces(v).for_each(|f| sum += by_face[f]);
        total += sum * (1.0 / sum.length());
    });
    total
}

/// The faces around the first vertices: each a scan of all.
fn scan_vertex_faces<M: MeshQuery<Face = FaceId>>(mesh: &M) -> usize {
    let mut sum = 0;
    mesh.vertices().take(16).for_each(|v| {
        mesh.vertex_faces(v).for_each(|f| sum += f.index());
    });
    sum
}

#[library_benchmark(config = at_most(340_000))]
#[bench::sphere(built())]
fn half_edge_vertex_vertices(mesh: &HalfEdgeMesh) -> Point {
    black_box(sweep_vertex_vertices(black_box(mesh)))
}

#[library_benchmark(config = at_most(480_000))]
#[bench::sphere(built())]
fn winged_edge_vertex_vertices(mesh: &WingedEdgeMesh) -> Point {
    black_box(sweep_vertex_vertices(black_box(mesh)))
}

#[library_benchmark(config = at_most(530_000))]
#[bench::sphere(built())]
fn corner_table_vertex_vertices(mesh: &CornerTable) -> Point {
    black_box(sweep_vertex_vertices(black_box(mesh)))
}

#[library_benchmark(config = at_most(550_000))]
#[bench::sphere(built())]
fn half_edge_face_faces(mesh: &HalfEdgeMesh) -> usize {
    black_box(sweep_face_faces(black_box(mesh)))
}

#[library_benchmark(config = at_most(1_060_000))]
#[bench::sphere(built())]
fn half_edge_vertex_normal(mesh: &HalfEdgeMesh) -> Point {
    black_box(vertex_normals(black_box(mesh)))
}

#[library_benchmark(config = at_most(2_600_000))]
#[bench::sphere(built())]
fn polygon_soup_vertex_faces(mesh: &PolygonSoup) -> usize {
    black_box(scan_vertex_faces(black_box(mesh)))
}

#[library_benchmark(config = at_most(1_600_000))]
#[bench::sphere(polygons())]
fn twin_pairs(polygons: PolygonMesh) -> (PolygonMesh, Option<TwinPairs>) {
    let pairs = TwinPairs::of(polygons.vertex_count(), black_box(polygons.faces()));
    black_box((polygons, pairs))
}

library_benchmark_group!(
    name = hot_loops,
    benchmarks = [
        half_edge_vertex_vertices,
        winged_edge_vertex_vertices,
        corner_table_vertex_vertices,
        half_edge_face_faces,
        half_edge_vertex_normal,
        polygon_soup_vertex_faces,
        twin_pairs
    ]
);

main!(library_benchmark_groups = hot_loops);

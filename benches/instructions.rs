//! How many instructions do the hot loops take? Callgrind counts them, without the noise of a
//! clock.
//!
//! ```text
//! apt-get install valgrind
//! cargo install gungraun-runner --version 0.20.0     # the version of gungraun in Cargo.lock
//! cargo bench -p sixfold-benches --bench instructions
//! ```
//!
//! It builds on every platform and runs on those that valgrind supports. A plain `cargo bench`
//! leaves it out (`bench = false`), because it does not understand the options of criterion.
//!
//! A loop fails if it takes 2 % more instructions than in the previous run, or more than its limit.
//! The limit is about 1.3 times the count with rustc 1.95 on x86-64. Baselines depend on the
//! compiler and the machine, so they are not committed. To measure the effect of a change, save a
//! baseline before it:
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
    WingedEdgeMesh, shapes,
};
use sixfold_core::TwinPairs;

/// Builds 5,120 triangles in random order, so that no loop profits from a regular order.
fn polygons() -> PolygonMesh {
    let sphere = shapes::geodesic(16).expect("a small frequency");
    shapes::shuffled(&sphere, 1)
}

/// Sets the limits of a loop: at most `instructions`, and at most 2 % more than in the previous
/// run.
fn limits(instructions: u64) -> LibraryBenchmarkConfig {
    let mut callgrind = Callgrind::default();
    callgrind.soft_limits([(EventKind::Ir, 2.0)]);
    if cfg!(target_arch = "x86_64") {
        callgrind.hard_limits([(EventKind::Ir, instructions)]);
    }
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(callgrind);
    config
}

/// Builds the mesh for a loop. It is never freed, because freeing would be counted too.
fn leaked_mesh<M: Representation>() -> &'static M {
    let mesh = M::from_polygons(&polygons()).expect("a closed manifold of triangles");
    Box::leak(Box::new(mesh))
}

/// Sums the positions of all neighbours, over all vertices.
fn sweep_vertex_vertices<M: MeshQuery>(mesh: &M) -> Point {
    let mut sum = Point::ZERO;
    mesh.vertices().for_each(|v| {
        mesh.vertex_vertices(v)
            .for_each(|w| sum += mesh.position(w));
    });
    sum
}

/// Sums the rows of all adjacent faces, over all faces.
fn sweep_face_faces<M: MeshQuery<Face = FaceId>>(mesh: &M) -> usize {
    let mut sum = 0;
    mesh.faces().for_each(|f| {
        mesh.face_faces(f).for_each(|g| sum += g.index());
    });
    sum
}

/// Stores the normals of all faces, and sums the vertex normals that they give.
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

/// Queries the faces of the first 16 vertices; each query scans all faces.
fn scan_vertex_faces<M: MeshQuery<Face = FaceId>>(mesh: &M) -> usize {
    let mut sum = 0;
    mesh.vertices().take(16).for_each(|v| {
        mesh.vertex_faces(v).for_each(|f| sum += f.index());
    });
    sum
}

#[library_benchmark(config = limits(340_000))]
#[bench::sphere(leaked_mesh())]
fn half_edge_vertex_vertices(mesh: &HalfEdgeMesh) -> Point {
    black_box(sweep_vertex_vertices(black_box(mesh)))
}

#[library_benchmark(config = limits(480_000))]
#[bench::sphere(leaked_mesh())]
fn winged_edge_vertex_vertices(mesh: &WingedEdgeMesh) -> Point {
    black_box(sweep_vertex_vertices(black_box(mesh)))
}

#[library_benchmark(config = limits(530_000))]
#[bench::sphere(leaked_mesh())]
fn corner_table_vertex_vertices(mesh: &CornerTable) -> Point {
    black_box(sweep_vertex_vertices(black_box(mesh)))
}

#[library_benchmark(config = limits(550_000))]
#[bench::sphere(leaked_mesh())]
fn half_edge_face_faces(mesh: &HalfEdgeMesh) -> usize {
    black_box(sweep_face_faces(black_box(mesh)))
}

#[library_benchmark(config = limits(1_060_000))]
#[bench::sphere(leaked_mesh())]
fn half_edge_vertex_normal(mesh: &HalfEdgeMesh) -> Point {
    black_box(vertex_normals(black_box(mesh)))
}

#[library_benchmark(config = limits(2_600_000))]
#[bench::sphere(leaked_mesh())]
fn polygon_soup_vertex_faces(mesh: &PolygonSoup) -> usize {
    black_box(scan_vertex_faces(black_box(mesh)))
}

#[library_benchmark(config = limits(1_600_000))]
#[bench::sphere(polygons())]
fn twin_pairs(polygons: PolygonMesh) -> (PolygonMesh, Option<TwinPairs>) {
    let pairs = TwinPairs::new(polygons.vertex_count(), black_box(polygons.faces()));
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

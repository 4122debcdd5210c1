//! What do values at vertices and faces cost, read in a loop and kept through edits?

use std::collections::HashMap;
use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, BenchmarkId, Criterion, Throughput};
use sixfold::prelude::*;
use sixfold::{FollowEdits, PolygonMesh, SideData};

use crate::input::irregular;

/// Faces of the mesh.
const FACES: usize = 80_000;
/// The number of edges for each edge that is bisected.
const STEP: usize = 12;

type Mesh = EditableHalfEdgeMesh;

pub(crate) fn define(criterion: &mut Criterion) {
    let polygons = irregular(FACES);
    reading::<HalfEdgeMesh>(criterion, &polygons);
    reading::<PolygonSoup>(criterion, &polygons);
    editing(criterion, &polygons);
}

/// Adds up a value of each vertex, face by face.
fn reading<M: Representation>(criterion: &mut Criterion, polygons: &PolygonMesh) {
    let mesh = M::from_polygons(polygons).expect("a manifold of triangles");
    let mut group = criterion.benchmark_group("values/read");
    group.throughput(Throughput::Elements(3 * mesh.face_count() as u64));
    let corners = || mesh.faces().flat_map(|f| mesh.face_vertices(f));
    group.bench_function(BenchmarkId::new(M::NAME, "without"), |bencher| {
        bencher.iter(|| corners().count());
    });
    let map = mesh.vertex_map(1.0_f32);
    group.bench_function(BenchmarkId::new(M::NAME, "vertex_map"), |bencher| {
        bencher.iter(|| corners().map(|v| black_box(&map)[v]).sum::<f32>());
    });
    let hashed: HashMap<M::Vertex, f32> = mesh.vertices().map(|v| (v, 1.0)).collect();
    group.bench_function(BenchmarkId::new(M::NAME, "std HashMap"), |bencher| {
        bencher.iter(|| corners().map(|v| black_box(&hashed)[&v]).sum::<f32>());
    });
    group.finish();
}

/// Bisects every twelfth edge of a copy of the mesh.
fn editing(criterion: &mut Criterion, polygons: &PolygonMesh) {
    let mesh = Mesh::from_polygons(polygons).expect("a manifold of triangles");
    let edges: Vec<EdgeId> = mesh.edges().step_by(STEP).collect();
    let mut group = criterion.benchmark_group("values/edit");
    group.throughput(Throughput::Elements(edges.len() as u64));
    bisect(&mut group, "no values", &mesh, &edges, &());
    let vertices = VertexData::new(&mesh, 1.0_f32);
    bisect(&mut group, "VertexData", &mesh, &edges, &vertices);
    let by_rule = vertices.with_rule(|values, new| {
        let sum: f32 = new.parents.iter().map(|&v| values[v]).sum();
        sum / new.parents.len().max(1) as f32
    });
    bisect(
        &mut group,
        "VertexData with a rule",
        &mesh,
        &edges,
        &by_rule,
    );
    let faces = FaceData::new(&mesh, 1_u32)
        .with_rule(|values, new| new.parents.first().map_or(0, |&f| values[f]));
    bisect(&mut group, "FaceData with a rule", &mesh, &edges, &faces);
    let sides = SideData::new(&mesh, 1_u32);
    bisect(&mut group, "SideData", &mesh, &edges, &sides);
    group.finish();
    let mut log = criterion.benchmark_group("values/log");
    log.throughput(Throughput::Elements(edges.len() as u64));
    log.bench_function("logged edit, own list", |bencher| {
        bencher.iter_batched_ref(
            || (mesh.clone(), vec![1.0_f32; mesh.vertex_count()]),
            |(mesh, values)| {
                let mut record = EditRecord::default();
                for &e in &edges {
                    let [a, b] = mesh.edge_vertices(e);
                    let middle = (mesh.position(a) + mesh.position(b)) / 2.0;
                    record.clear();
                    mesh.bisect_edge_logged(e, middle, &mut record)
                        .expect("triangles");
                    let value = (values[a.index()] + values[b.index()]) / 2.0;
                    values.extend(record.vertices.created.iter().map(|_| value));
                }
            },
            BatchSize::PerIteration,
        );
    });
    log.finish();
}

/// Bisects `edges` of a copy of `mesh` with `data`.
fn bisect<D: FollowEdits<Mesh> + Clone>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    mesh: &Mesh,
    edges: &[EdgeId],
    data: &D,
) {
    group.bench_function(name, |bencher| {
        bencher.iter_batched_ref(
            || MeshWithData::new(mesh.clone(), data.clone()),
            |mesh| {
                for &e in edges {
                    let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
                    mesh.bisect_edge(e, (a + b) / 2.0).expect("triangles");
                }
            },
            BatchSize::PerIteration,
        );
    });
}

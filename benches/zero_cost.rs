//! Does the trait cost anything? Generic code against the same loop by hand over raw tables.

use std::hint::black_box;

use criterion::{Criterion, Throughput};
use sixfold::{
    FaceMap, HalfEdgeMesh, MeshQuery, Point, PolygonMesh, Representation, VertexMap, shapes,
};

/// The mean of each vertex's neighbours, on any structure.
fn means<M: MeshQuery>(mesh: &M, means: &mut VertexMap<M, Point>) {
    mesh.vertices().for_each(|v| {
        let (mut sum, mut valence) = (Point::ZERO, 0_u32);
        mesh.vertex_vertices(v).for_each(|w| {
            sum += mesh.position(w);
            valence += 1;
        });
        means[v] = sum * (1.0 / valence as f32);
    });
}

/// The normals of all faces, and the normalised sums of them around each vertex, on any structure.
fn normals<M: MeshQuery>(
    mesh: &M,
    by_face: &mut FaceMap<M, Point>,
    by_vertex: &mut VertexMap<M, Point>,
) {
    mesh.faces().for_each(|f| {
        let mut corners = mesh.face_vertices(f).map(|v| mesh.position(v));
        let mut next = || corners.next().unwrap_or_default();
        let (a, b, c) = (next(), next(), next());
        by_face[f] = (b - a).cross(c - a);
    });
    mesh.vertices().for_each(|v| {
        let mut sum = Point::ZERO;
        mesh.vertex_faces(v).for_each(|f| sum += by_face[f]);
        by_vertex[v] = sum * (1.0 / sum.length());
    });
}

/// `means` by hand over the tables of a half-edge mesh.
fn means_by_hand(mesh: &HalfEdgeMesh, means: &mut [Point]) {
    let (positions, halves) = (mesh.positions(), mesh.half_rows());
    for (mean, leaving) in means.iter_mut().zip(mesh.leaving_rows()) {
        let Some(first) = leaving.get() else { continue };
        let (mut sum, mut valence, mut h) = (Point::ZERO, 0_u32, first);
        loop {
            let twin = &halves[h.twin().index()];
            sum += positions[twin.origin.index()];
            valence += 1;
            h = twin.next;
            if h == first {
                break;
            }
        }
        *mean = sum * (1.0 / valence as f32);
    }
}

/// `normals` by hand over the tables of a half-edge mesh.
fn normals_by_hand(mesh: &HalfEdgeMesh, by_face: &mut [Point], by_vertex: &mut [Point]) {
    let (positions, halves) = (mesh.positions(), mesh.half_rows());
    for (normal, &first) in by_face.iter_mut().zip(mesh.first_rows()) {
        let a = &halves[first.index()];
        let b = &halves[a.next.index()];
        let c = &halves[b.next.index()];
        let [a, b, c] = [a, b, c].map(|half| positions[half.origin.index()]);
        *normal = (b - a).cross(c - a);
    }
    for (normal, leaving) in by_vertex.iter_mut().zip(mesh.leaving_rows()) {
        let Some(first) = leaving.get() else { continue };
        let (mut sum, mut h) = (Point::ZERO, first);
        loop {
            let twin = &halves[h.twin().index()];
            if let Some(f) = twin.face.get() {
                sum += by_face[f.index()];
            }
            h = twin.next;
            if h == first {
                break;
            }
        }
        *normal = sum * (1.0 / sum.length());
    }
}

fn inputs() -> [(&'static str, PolygonMesh); 2] {
    let ordered = shapes::geodesic(64).expect("a small frequency");
    let shuffled = shapes::shuffled(&ordered, 1);
    [("ordered", ordered), ("shuffled", shuffled)]
}

pub(crate) fn define(criterion: &mut Criterion) {
    for (order, polygons) in inputs() {
        let mesh = HalfEdgeMesh::from_polygons(&polygons).expect("a closed manifold");
        let vertices = polygons.vertex_count();
        let mut by_face = mesh.face_map(Point::ZERO);
        let mut by_vertex = mesh.vertex_map(Point::ZERO);
        let mut raw_face = vec![Point::ZERO; polygons.face_count()];
        let mut raw_vertex = vec![Point::ZERO; vertices];

        let mut group = criterion.benchmark_group(format!("zero_cost/half-edge/vv_smooth/{order}"));
        group.throughput(Throughput::Elements(vertices as u64));
        group.bench_function("generic", |bench| {
            bench.iter(|| means(black_box(&mesh), black_box(&mut by_vertex)));
        });
        group.bench_function("by hand", |bench| {
            bench.iter(|| means_by_hand(black_box(&mesh), black_box(&mut raw_vertex)));
        });
        group.finish();
        assert_eq!(by_vertex.values(), raw_vertex, "both did the same work");

        let mut group =
            criterion.benchmark_group(format!("zero_cost/half-edge/vertex_normal/{order}"));
        group.throughput(Throughput::Elements(vertices as u64));
        group.bench_function("generic", |bench| {
            bench.iter(|| {
                normals(
                    black_box(&mesh),
                    black_box(&mut by_face),
                    black_box(&mut by_vertex),
                )
            });
        });
        group.bench_function("by hand", |bench| {
            bench.iter(|| {
                normals_by_hand(
                    black_box(&mesh),
                    black_box(&mut raw_face),
                    black_box(&mut raw_vertex),
                )
            });
        });
        group.finish();
        assert_eq!(by_vertex.values(), raw_vertex, "both did the same work");
    }
}

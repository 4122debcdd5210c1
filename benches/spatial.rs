//! How much time do building and queries take with each spatial index?

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, BenchmarkId, Criterion, Throughput};
use sixfold::glam::DVec3;
use sixfold::spatial::{
    Bvh, FaceTriangle, Item, KdTree, Octree, PointQueries, Ray, SearchHint, SpatialIndex,
    SurfaceQueries, UniformGrid, VertexPoint, polygon_points, polygon_triangles,
};
use sixfold::{FaceId, PolygonMesh, VertexId};

use crate::input::irregular;

/// Faces of the meshes.
const FACES: [usize; 2] = [5_000, 80_000];

type Point = VertexPoint<VertexId>;
type Triangle = FaceTriangle<FaceId>;

pub(crate) fn define(criterion: &mut Criterion) {
    for faces in FACES {
        let mesh = irregular(faces);
        let points = polygon_points(&mesh).expect("finite");
        let triangles = polygon_triangles(&mesh).expect("finite");
        let queries = queries(&mesh);
        bench_points::<UniformGrid<Point>>(criterion, &points, &queries);
        bench_points::<Octree<Point>>(criterion, &points, &queries);
        bench_points::<KdTree<Point>>(criterion, &points, &queries);
        bench_points::<Bvh<Point>>(criterion, &points, &queries);
        bench_surface::<UniformGrid<Triangle>>(criterion, &triangles, &queries);
        bench_surface::<Octree<Triangle>>(criterion, &triangles, &queries);
        bench_surface::<KdTree<Triangle>>(criterion, &triangles, &queries);
        bench_surface::<Bvh<Triangle>>(criterion, &triangles, &queries);
    }
}

/// Points near the surface, in the order of the vertices: each vertex moved away from the centre or
/// towards it by 2 % of the size of the mesh.
fn queries(mesh: &PolygonMesh) -> Vec<DVec3> {
    let positions = || mesh.positions().iter().map(|p| p.as_dvec3());
    let centre = positions().sum::<DVec3>() / mesh.vertex_count() as f64;
    let size = positions().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let moved = positions().enumerate().map(|(number, position)| {
        let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
        position + (position - centre).normalize_or_zero() * (sign * 0.02 * size)
    });
    moved.collect()
}

fn bench_points<T: SpatialIndex<Point>>(
    criterion: &mut Criterion,
    points: &[Point],
    queries: &[DVec3],
) {
    let size = points.len();
    let mut group = criterion.benchmark_group("spatial/vertices");
    let index = bench_build::<T, _>(&mut group, points);
    let radius = queries[0].distance(points[0].position.as_dvec3());
    group.throughput(Throughput::Elements(queries.len() as u64));
    group.bench_function(
        BenchmarkId::new(format!("nearest/{}", T::NAME), size),
        |bench| {
            bench.iter(|| {
                queries
                    .iter()
                    .map(|&q| index.nearest(q))
                    .for_each(|n| _ = black_box(n))
            });
        },
    );
    group.bench_function(
        BenchmarkId::new(format!("within/{}", T::NAME), size),
        |bench| {
            let mut count = 0_u64;
            bench.iter(|| {
                queries
                    .iter()
                    .for_each(|&q| index.for_each_within(q, radius, |_| count += 1))
            });
            black_box(count);
        },
    );
    group.bench_function(
        BenchmarkId::new(format!("nearest 8/{}", T::NAME), size),
        |bench| {
            let mut found = Vec::new();
            bench.iter(|| {
                queries
                    .iter()
                    .for_each(|&q| index.nearest_k_into(q, 8, &mut found))
            });
        },
    );
    group.finish();
}

fn bench_surface<T: SpatialIndex<Triangle>>(
    criterion: &mut Criterion,
    triangles: &[Triangle],
    queries: &[DVec3],
) {
    let size = triangles.len();
    let mut group = criterion.benchmark_group("spatial/surface");
    let index = bench_build::<T, _>(&mut group, triangles);
    group.throughput(Throughput::Elements(queries.len() as u64));
    group.bench_function(
        BenchmarkId::new(format!("closest/{}", T::NAME), size),
        |bench| {
            let closest = |&query| index.closest_point(query);
            bench.iter(|| {
                queries
                    .iter()
                    .map(closest)
                    .for_each(|point| _ = black_box(point))
            });
        },
    );
    group.bench_function(
        BenchmarkId::new(format!("closest again/{}", T::NAME), size),
        |bench| {
            // The hints of a first round, as if all queries had stayed where they were.
            let mut hints = vec![SearchHint::default(); queries.len()];
            let mut round = || {
                for (query, hint) in queries.iter().zip(&mut hints) {
                    black_box(index.closest_point_from(*query, hint));
                }
            };
            round();
            bench.iter(round);
        },
    );
    let rays: Vec<Ray> = queries
        .iter()
        .zip(queries.iter().rev())
        .filter_map(|(&from, &to)| Ray::new(from, to - from).ok())
        .collect();
    group.throughput(Throughput::Elements(rays.len() as u64));
    group.bench_function(
        BenchmarkId::new(format!("first hit/{}", T::NAME), size),
        |bench| {
            let hit = |ray| index.first_hit(ray, f64::INFINITY);
            bench.iter(|| rays.iter().map(hit).for_each(|hit| _ = black_box(hit)));
        },
    );
    group.finish();
}

fn bench_build<T: SpatialIndex<I>, I: Item>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    items: &[I],
) -> T {
    group.throughput(Throughput::Elements(items.len() as u64));
    group.bench_function(
        BenchmarkId::new(format!("build/{}", T::NAME), items.len()),
        |bench| {
            let build = |items| T::build(items).expect("finite");
            bench.iter_batched(|| items.to_vec(), build, BatchSize::LargeInput);
        },
    );
    T::build(items.to_vec()).expect("finite")
}

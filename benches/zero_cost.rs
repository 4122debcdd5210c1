//! Does the trait cost time? Compares generic code with hand-written loops over the raw tables.
//! Both versions do the same arithmetic on polygons of any degree.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput};
use sixfold::{
    CornerTable, FaceId, FaceMap, HalfEdgeMesh, MeshQuery, Point, PolygonMesh, Representation,
    RowMap, VertexId, VertexMap, WingedEdgeMesh, shapes,
};

/// Computes for each vertex the mean of its neighbours.
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

/// Computes the normals of all faces, and the normalised sum of the face normals for each vertex.
fn normals<M: MeshQuery>(
    mesh: &M,
    by_face: &mut FaceMap<M, Point>,
    by_vertex: &mut VertexMap<M, Point>,
) {
    mesh.faces().for_each(|f| {
        let mut fan = Fan::default();
        mesh.face_vertices(f)
            .for_each(|v| fan.add(mesh.position(v)));
        by_face[f] = fan.normal;
    });
    mesh.vertices().for_each(|v| {
        let mut sum = Point::ZERO;
        mesh.vertex_faces(v).for_each(|f| sum += by_face[f]);
        by_vertex[v] = sum * (1.0 / sum.length());
    });
}

/// A sum of cross products, computed corner by corner.
#[derive(Default)]
struct Fan {
    first: Point,
    spoke: Point,
    normal: Point,
    corners: u32,
}

impl Fan {
    #[inline(always)]
    fn add(&mut self, corner: Point) {
        if self.corners == 0 {
            self.first = corner;
        } else {
            let next = corner - self.first;
            self.normal += self.spoke.cross(next);
            self.spoke = next;
        }
        self.corners += 1;
    }
}

/// The same two operations as hand-written loops without the trait.
trait HandWritten: Representation<Vertex = VertexId, Face = FaceId> {
    /// Does the same as [`means`].
    fn means_by_hand(&self, means: &mut [Point]);
    /// Does the same as [`normals`].
    fn normals_by_hand(&self, by_face: &mut [Point], by_vertex: &mut [Point]);
}

impl HandWritten for HalfEdgeMesh {
    fn means_by_hand(&self, means: &mut [Point]) {
        let (positions, halves) = (self.positions(), self.half_edge_rows());
        for (mean, leaving) in means.iter_mut().zip(self.leaving_rows()) {
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

    fn normals_by_hand(&self, by_face: &mut [Point], by_vertex: &mut [Point]) {
        let (positions, halves) = (self.positions(), self.half_edge_rows());
        for (normal, &first) in by_face.iter_mut().zip(self.first_rows()) {
            let (mut fan, mut h) = (Fan::default(), first);
            loop {
                let half = &halves[h.index()];
                fan.add(positions[half.origin.index()]);
                h = half.next;
                if h == first {
                    break;
                }
            }
            *normal = fan.normal;
        }
        for (normal, leaving) in by_vertex.iter_mut().zip(self.leaving_rows()) {
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
}

impl HandWritten for CornerTable {
    fn means_by_hand(&self, means: &mut [Point]) {
        let (positions, vertex) = (self.positions(), CornerTable::corner_vertices(self));
        let opposite = self.opposite_corners();
        for (mean, corner) in means.iter_mut().zip(self.vertex_corners()) {
            let Some(first) = corner.get().map(|c| c.next()) else {
                continue;
            };
            let (mut sum, mut valence, mut n) = (Point::ZERO, 0_u32, first);
            loop {
                sum += positions[vertex[n.index()].index()];
                valence += 1;
                match opposite[n.index()].get().map(|c| c.prev()) {
                    Some(next) if next != first => n = next,
                    Some(_) => break,
                    None => {
                        // A vertex on the boundary has one more neighbour than faces.
                        sum += positions[vertex[n.next().index()].index()];
                        valence += 1;
                        break;
                    }
                }
            }
            *mean = sum * (1.0 / valence as f32);
        }
    }

    fn normals_by_hand(&self, by_face: &mut [Point], by_vertex: &mut [Point]) {
        let (positions, opposite) = (self.positions(), self.opposite_corners());
        let triangles = CornerTable::corner_vertices(self).as_chunks::<3>().0;
        for (normal, triangle) in by_face.iter_mut().zip(triangles) {
            let mut fan = Fan::default();
            for v in triangle {
                fan.add(positions[v.index()]);
            }
            *normal = fan.normal;
        }
        for (normal, corner) in by_vertex.iter_mut().zip(self.vertex_corners()) {
            let Some(first) = corner.get().map(|c| c.next()) else {
                continue;
            };
            let (mut sum, mut n) = (Point::ZERO, first);
            loop {
                sum += by_face[n.triangle().index()];
                match opposite[n.index()].get().map(|c| c.prev()) {
                    Some(next) if next != first => n = next,
                    _ => break,
                }
            }
            *normal = sum * (1.0 / sum.length());
        }
    }
}

impl HandWritten for WingedEdgeMesh {
    fn means_by_hand(&self, means: &mut [Point]) {
        let (positions, edges) = (self.positions(), self.edge_records());
        for (v, (mean, spoke)) in means.iter_mut().zip(self.spoke_rows()).enumerate() {
            let Some(first) = spoke.get() else { continue };
            let (mut sum, mut valence, mut e) = (Point::ZERO, 0_u32, first);
            loop {
                let edge = &edges[e.index()];
                let [start, end] = edge.ends();
                let at_end = end.index() == v;
                let other = if at_end { start } else { end };
                sum += positions[other.index()];
                valence += 1;
                e = edge.prev()[usize::from(at_end)];
                if e == first {
                    break;
                }
            }
            *mean = sum * (1.0 / valence as f32);
        }
    }

    fn normals_by_hand(&self, by_face: &mut [Point], by_vertex: &mut [Point]) {
        let (positions, edges) = (self.positions(), self.edge_records());
        for (f, (normal, &first)) in by_face.iter_mut().zip(self.side_rows()).enumerate() {
            let (mut fan, mut e) = (Fan::default(), first);
            loop {
                let edge = &edges[e.index()];
                let on_right = edge.faces()[1].is_some_and(|right| right.index() == f);
                fan.add(positions[edge.ends()[usize::from(on_right)].index()]);
                e = edge.next()[usize::from(on_right)];
                if e == first {
                    break;
                }
            }
            *normal = fan.normal;
        }
        for (v, (normal, spoke)) in by_vertex.iter_mut().zip(self.spoke_rows()).enumerate() {
            let Some(first) = spoke.get() else { continue };
            let (mut sum, mut e) = (Point::ZERO, first);
            loop {
                let edge = &edges[e.index()];
                let at_end = edge.ends()[1].index() == v;
                if let Some(f) = edge.faces()[usize::from(at_end)] {
                    sum += by_face[f.index()];
                }
                e = edge.prev()[usize::from(at_end)];
                if e == first {
                    break;
                }
            }
            *normal = sum * (1.0 / sum.length());
        }
    }
}

fn compare<M>(criterion: &mut Criterion, order: &str, polygons: &PolygonMesh)
where
    M: HandWritten + MeshQuery<Vertex = VertexId, Face = FaceId>,
{
    let mesh = M::from_polygons(polygons).expect("a closed manifold of triangles");
    let vertices = polygons.vertex_count();
    let mut by_face: RowMap<FaceId, Point> = mesh.face_map(Point::ZERO);
    let mut by_vertex: RowMap<VertexId, Point> = mesh.vertex_map(Point::ZERO);
    let mut raw_face = vec![Point::ZERO; polygons.face_count()];
    let mut raw_vertex = vec![Point::ZERO; vertices];
    let group = |workload| format!("zero_cost/{}/{workload}/{order}", M::NAME);

    let mut benchmark = criterion.benchmark_group(group("vv_smooth"));
    benchmark.throughput(Throughput::Elements(vertices as u64));
    compare_alternating(
        &mut benchmark,
        || means(black_box(&mesh), black_box(&mut by_vertex)),
        || black_box(&mesh).means_by_hand(black_box(&mut raw_vertex)),
    );
    benchmark.finish();
    let nearly_equal =
        |a: &[Point], b: &[Point]| a.iter().zip(b).all(|(a, b)| a.abs_diff_eq(*b, 1e-6));
    assert!(
        nearly_equal(by_vertex.values(), &raw_vertex),
        "both did the same work"
    );

    let mut benchmark = criterion.benchmark_group(group("vertex_normal"));
    benchmark.throughput(Throughput::Elements(vertices as u64));
    compare_alternating(
        &mut benchmark,
        || {
            normals(
                black_box(&mesh),
                black_box(&mut by_face),
                black_box(&mut by_vertex),
            )
        },
        || black_box(&mesh).normals_by_hand(black_box(&mut raw_face), black_box(&mut raw_vertex)),
    );
    benchmark.finish();
    assert!(
        nearly_equal(by_vertex.values(), &raw_vertex),
        "both did the same work"
    );
}

/// Measures both versions with criterion. Then runs both versions alternately, so that noise has
/// little effect on the ratio of their times.
fn compare_alternating(
    group: &mut BenchmarkGroup<'_, WallTime>,
    mut generic: impl FnMut(),
    mut by_hand: impl FnMut(),
) {
    group.bench_function("generic", |bench| bench.iter(&mut generic));
    group.bench_function("by hand", |bench| bench.iter(&mut by_hand));
    let mut ratios = Vec::new();
    group.bench_function("by turns", |bench| {
        bench.iter_custom(|rounds| {
            let mut total = Duration::ZERO;
            for _ in 0..rounds {
                let start = Instant::now();
                generic();
                let between = Instant::now();
                by_hand();
                let [generic_time, by_hand_time] = [between - start, between.elapsed()];
                ratios.push(generic_time.as_secs_f64() / by_hand_time.as_secs_f64());
                total += generic_time + by_hand_time;
            }
            total
        });
    });
    ratios.sort_unstable_by(f64::total_cmp);
    if let Some(median) = ratios.get(ratios.len() / 2) {
        let rounds = ratios.len();
        println!("generic / by hand: {median:.3}, the median of {rounds} alternating rounds");
    }
}

pub(crate) fn define(criterion: &mut Criterion) {
    let ordered = shapes::geodesic(64).expect("a small frequency");
    let shuffled = shapes::shuffled(&ordered, 1);
    for (order, polygons) in [("ordered", ordered), ("shuffled", shuffled)] {
        compare::<HalfEdgeMesh>(criterion, order, &polygons);
        compare::<CornerTable>(criterion, order, &polygons);
        compare::<WingedEdgeMesh>(criterion, order, &polygons);
    }
}

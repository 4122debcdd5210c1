//! How much time does a subdivision take on each structure, by each method, at each level?
//!
//! Each time is one run of all levels, starting from a built control mesh. The throughput is the
//! number of faces of the last level per second. Native methods run on one thread and on two
//! threads.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput};
use rayon::ThreadPoolBuilder;
use sixfold::subdivision::{Method, Scheme};
use sixfold::{Creases, QueryCost, Relation, shapes};
use sixfold_study::{Backend, SubdivisionJob, Way};

/// Maximum number of levels. The last level has about 300,000 triangles or 250,000 quads.
const LEVELS: u32 = 3;

pub(crate) fn define(criterion: &mut Criterion) {
    let polygons = shapes::geodesic(16).expect("5,120 triangles");
    for scheme in Scheme::ALL {
        let mut group = criterion.benchmark_group(format!("subdivision/{scheme}"));
        for way in Way::ALL {
            for level in 1..=LEVELS {
                for backend in Backend::structures() {
                    if scans_faces(&backend, way) {
                        continue;
                    }
                    let job = SubdivisionJob::new(scheme, way, level);
                    let ready = job.prepare(&backend, &polygons, &Creases::default());
                    let Some(Ok(mut refiner)) = ready else {
                        continue;
                    };
                    for threads in thread_counts(way) {
                        let pool = ThreadPoolBuilder::new().num_threads(*threads).build();
                        let pool = pool.expect("two threads can be started");
                        if pool.install(|| refiner.run()).is_err() {
                            continue;
                        }
                        let (faces, _) = refiner.result();
                        group.throughput(Throughput::Elements(faces as u64));
                        let name = format!("{way}/{}/{threads}", backend.name());
                        group.bench_function(BenchmarkId::new(name, level), |bench| {
                            bench.iter(|| black_box(pool.install(|| refiner.run().is_ok())));
                        });
                    }
                }
            }
        }
        group.finish();
    }
}

/// Returns whether the structure scans all faces for queries of this method. Such a run would take
/// seconds.
fn scans_faces(backend: &Backend, way: Way) -> bool {
    let cost = backend.info.costs[Relation::VertexFaces as usize];
    way == Way::Gather && cost == QueryCost::Scan
}

fn thread_counts(way: Way) -> &'static [usize] {
    match way.method() {
        Method::Native => &[1, 2],
        _ => &[1],
    }
}

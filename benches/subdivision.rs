//! What does a subdivision cost on each structure, by each method, level by level?
//!
//! One figure is one run of all levels, from a control mesh that stands built; its throughput is in
//! faces of the last level. Native runs on one thread and on two.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput};
use rayon::ThreadPoolBuilder;
use sixfold::subdivision::{Method, Scheme};
use sixfold::{Creases, roster, shapes};
use study::{Refining, Way};

/// The most levels: the last has about 300,000 triangles, or 250,000 quads.
const LEVELS: u32 = 3;

pub(crate) fn define(criterion: &mut Criterion) {
    let polygons = shapes::geodesic(16).expect("5,120 triangles");
    for scheme in Scheme::ALL {
        let mut group = criterion.benchmark_group(format!("subdivision/{scheme}"));
        for way in Way::ALL {
            for level in 1..=LEVELS {
                for backend in roster() {
                    if searches(backend.name, way) {
                        continue;
                    }
                    let job = Refining::new(scheme, way, level);
                    let ready = job.on(backend.name, &polygons, &Creases::default());
                    let Some(Ok(mut refiner)) = ready else {
                        continue;
                    };
                    for threads in threads_of(way) {
                        let pool = ThreadPoolBuilder::new().num_threads(*threads).build();
                        let pool = pool.expect("two threads can be had");
                        // What does not fit, or does not run this way, is refused here.
                        if pool.install(|| refiner.run()).is_err() {
                            continue;
                        }
                        let (faces, _) = refiner.result();
                        group.throughput(Throughput::Elements(faces as u64));
                        let name = format!("{way}/{}/{threads}", backend.name);
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

/// Whether the way asks what the structure has to search all faces for: seconds a run, which the
/// report of a study shows on a smaller mesh.
fn searches(backend: &str, way: Way) -> bool {
    way == Way::Gather && matches!(backend, "polygon-soup" | "indexed-face-set")
}

fn threads_of(way: Way) -> &'static [usize] {
    match way.method() {
        Method::Native => &[1, 2],
        _ => &[1],
    }
}

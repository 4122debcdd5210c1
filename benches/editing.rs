//! How do the times of edits and edit workloads on each structure grow with the mesh?
//!
//! A time in `edit/` is the time of one edit: the time of a run at many places, divided by the
//! number of places. A structure that scans all faces is measured at few places, and not on the
//! largest meshes.

use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, Throughput};
use sixfold::{Edit, QueryCost, shapes};
use sixfold_study::{Backend, EditPass, Editor, MachineClock, Series, SingleEdit};

use crate::input::inputs;

/// Side lengths of triangle tori, in cells: about 1,000, 10,000 and 100,000 faces.
const SIDES: [usize; 3] = [23, 71, 224];

/// Maximum number of faces for single edits on a structure that scans all faces.
const MAX_SCANNED_FACES: usize = 20_000;
/// Maximum number of faces for edit workloads on a structure that scans all faces.
const MAX_WORKLOAD_SCANNED_FACES: usize = 2_000;

pub(crate) fn define(criterion: &mut Criterion) {
    edits(criterion);
    workloads(criterion);
}

fn edits(criterion: &mut Criterion) {
    for edit in Edit::ALL {
        let mut group = criterion.benchmark_group(format!("edit/{edit}"));
        for side in SIDES {
            let polygons = shapes::triangle_torus(side, side).expect("a small torus");
            for backend in Backend::structures() {
                let Some(cost) = backend.info.edits[edit as usize] else {
                    continue; // it does not support the edit
                };
                let scans = cost == QueryCost::Scan;
                if scans && polygons.face_count() > MAX_SCANNED_FACES {
                    continue;
                }
                let places = if scans { 8 } else { 256 };
                let job = SingleEdit { edit, places };
                let Some(Ok(mut editor)) = job.prepare(&backend, &polygons) else {
                    continue;
                };
                editor.time(&Series::once(&MachineClock::start()));
                let edits = editor.result().elements.max(1);
                let id = BenchmarkId::new(backend.name(), polygons.face_count());
                bench_editor(&mut group, id, editor.as_mut(), edits);
            }
        }
        group.finish();
    }
}

fn workloads(criterion: &mut Criterion) {
    for pass in EditPass::ALL {
        let mut group = criterion.benchmark_group(format!("editing/{pass}"));
        for input in inputs() {
            for backend in Backend::structures() {
                let collapse = backend.info.edits[Edit::CollapseEdge as usize];
                let max_faces = match collapse {
                    Some(QueryCost::Scan) => MAX_WORKLOAD_SCANNED_FACES,
                    _ => usize::MAX,
                };
                if input.mesh.face_count() > max_faces {
                    continue;
                }
                let Some(Ok(mut editor)) = backend.prepare_pass(pass, &input.mesh) else {
                    continue;
                };
                editor.time(&Series::once(&MachineClock::start()));
                group.throughput(Throughput::Elements(editor.result().elements));
                let id = BenchmarkId::new(backend.name(), &input.name);
                bench_editor(&mut group, id, editor.as_mut(), 1);
            }
        }
        group.finish();
    }
}

/// Measures runs on a copy that is reset before each run. The reported time is the time of a run
/// divided by `parts`.
fn bench_editor(
    group: &mut BenchmarkGroup<'_, WallTime>,
    id: BenchmarkId,
    editor: &mut dyn Editor,
    parts: u64,
) {
    let clock = MachineClock::start();
    group.bench_function(id, |bench| {
        bench.iter_custom(|runs| {
            let runs = u32::try_from(runs).unwrap_or(u32::MAX);
            let time = editor.time(&Series::with_runs(runs, &clock).with_untimed(1));
            Duration::from_nanos((time.wall_ns / parts as f64) as u64)
        });
    });
}

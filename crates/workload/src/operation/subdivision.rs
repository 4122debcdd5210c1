//! One step of Catmull–Clark or Loop subdivision, on one thread.

use std::hint::black_box;
use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};
use sixfold::subdivision::{FaceKind, SubdivisionError};
use sixfold::{Creases, PolygonMesh};

use crate::backend::Backend;
use crate::subdivision_job::SubdivisionJob;
use sixfold_measure::{ElementSample, Outcome, Series, TimedRun, patch};

/// Subdivides all faces, or a patch if there is a sample.
pub(crate) fn run(
    backend: &Backend,
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    sample: Option<ElementSample>,
    series: &Series<'_>,
) -> TimedRun {
    let Some(ElementSample { size, .. }) = sample else {
        return subdivide(backend, job, polygons, series);
    };
    let patch = patch(polygons, size);
    let scale = polygons.face_count() as f64 / patch.face_count() as f64;
    let run = subdivide(backend, job, &patch, series);
    TimedRun {
        time: run.time.scaled(scale),
        ..run
    }
}

/// Returns the pool of the one thread that runs all subdivisions. The processor time of this thread
/// is the time of all the work. All structures share the heap of this thread.
fn one_thread_pool() -> Result<&'static ThreadPool, String> {
    static POOL: OnceLock<Result<ThreadPool, String>> = OnceLock::new();
    let start = || {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        pool.map_err(|error| format!("cannot start a thread: {error}"))
    };
    POOL.get_or_init(start).as_ref().map_err(Clone::clone)
}

/// Sets up `job` on the structure of `backend` and runs it as `series` describes.
///
/// Set-up is not timed. In native subdivisions, the untimed runs make the tables that later runs
/// reuse. The other methods build their structures within the timing.
fn subdivide(
    backend: &Backend,
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    series: &Series<'_>,
) -> TimedRun {
    // Clock, caches and page faults then belong to the thread of the pool.
    let on_thread =
        |pool: &ThreadPool| pool.install(|| set_up_and_run(backend, job, polygons, series));
    one_thread_pool()
        .and_then(on_thread)
        .unwrap_or_else(|refusal| TimedRun::refused(refusal, series))
}

fn set_up_and_run(
    backend: &Backend,
    job: SubdivisionJob,
    polygons: &PolygonMesh,
    series: &Series<'_>,
) -> Result<TimedRun, String> {
    check_degrees(job, polygons).map_err(|error| error.to_string())?;
    let refiner = job.prepare(backend, polygons, &Creases::default());
    let refiner = refiner.ok_or("it has no native method: it cannot split its own tables")?;
    let mut refiner = refiner.map_err(|error| error.to_string())?;
    let mut done = Ok(());
    let time = series.time_together(|| {
        if done.is_ok() {
            done = black_box(&mut refiner).run();
        }
    });
    done.map_err(|error| error.to_string())?;
    let outcome = series.check.then(|| {
        let (faces, checksum) = refiner.result();
        Outcome {
            checksum,
            elements: faces as u64,
            refused: 0,
        }
    });
    Ok(TimedRun::done(time, outcome))
}

/// Checks that the scheme accepts the degrees of the faces. The error is then the same for all
/// structures. O(faces) at most.
fn check_degrees(job: SubdivisionJob, polygons: &PolygonMesh) -> Result<(), SubdivisionError> {
    let scheme = job.subdivision.scheme;
    if scheme.properties().takes != FaceKind::Triangles {
        return Ok(());
    }
    match polygons.first_polygon() {
        Some((face, degree)) => Err(SubdivisionError::NotATriangle {
            scheme,
            face,
            degree,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use sixfold::{HalfEdgeMesh, Representation, shapes};

    use super::*;

    #[test]
    fn a_structure_that_holds_the_mesh_holds_a_patch() {
        let ordered = shapes::geodesic(12).expect("small");
        for mesh in [shapes::shuffled(&ordered, 3), ordered] {
            for size in [1, 7, 100, 900] {
                let patch = patch(&mesh, size);
                assert!((size.div_ceil(20)..=size).contains(&patch.face_count()));
                assert!(HalfEdgeMesh::from_polygons(&patch).is_ok(), "{size}");
            }
            assert_eq!(
                patch(&mesh, usize::MAX),
                mesh,
                "the whole mesh, in its order"
            );
        }
    }
}

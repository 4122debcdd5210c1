//! Builds the structure from a polygon mesh.

use std::hint::black_box;

use sixfold::{PolygonMesh, Representation};

use sixfold_measure::{Outcome, Series, TimedRun, time_making};

/// Builds the structure of `mesh` again.
pub(crate) fn run<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    series: &Series<'_>,
) -> TimedRun {
    let build = || M::from_polygons(black_box(polygons)).ok();
    let (time, built) = time_making(series, mesh.memory().total(), build);
    let outcome = built.flatten().map(|mesh| Outcome {
        checksum: (mesh.vertex_count() + mesh.face_count()) as f64,
        elements: mesh.face_count() as u64,
        refused: 0,
    });
    TimedRun::done(time, outcome)
}

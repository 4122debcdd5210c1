//! Read-only passes over any mesh.

use std::hint::black_box;

use sixfold::MeshQuery;

use crate::job::{Outcome, Run};
use crate::operation::{ElementKind, Operation};
use crate::series::Series;
use crate::sweeps::{All, Outputs, SweepResult};

/// Runs `operation` over all of `mesh` as `series` describes. Returns the time of one run.
pub(crate) fn pass_over<M: MeshQuery>(
    mesh: &M,
    outputs: &mut Outputs<M>,
    operation: Operation,
    series: &Series<'_>,
) -> Run {
    let mut result = SweepResult::default();
    let time = series.time_together(|| {
        result = SweepResult::default();
        for kind in operation.kinds() {
            result.add(operation.sweep(kind, black_box(mesh), &All, outputs));
        }
        black_box(&mut *outputs);
    });
    let outcome = series.check.then(|| {
        let checksum = operation.checksum(mesh, &All, outputs, result);
        let elements = match operation.description().unit.element() {
            Some(ElementKind::Vertex) => mesh.vertex_count() as u64,
            Some(ElementKind::Edge) => mesh.edge_count() as u64,
            Some(ElementKind::Face) => mesh.face_count() as u64,
            None => result.count,
        };
        Outcome {
            checksum,
            elements,
            refused: 0,
        }
    });
    Run::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
}

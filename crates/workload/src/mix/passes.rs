//! Read-only passes over any mesh.

use std::hint::black_box;

use sixfold::MeshQuery;

use crate::job::{Outcome, Run};
use crate::operation::{ElementKind, Operation};
use crate::series::Series;
use crate::sweeps::{All, Outputs, SweepResult, field_sum, sweep_kind};

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
        for &kind in operation.kinds() {
            result.add(sweep_kind(operation, kind, black_box(mesh), &All, outputs));
        }
        black_box(&mut *outputs);
    });
    let outcome = series.check.then(|| {
        let of_vertices = || field_sum(mesh.vertices().map(|v| outputs.vertices[v]));
        let of_faces = || field_sum(mesh.faces().map(|f| outputs.faces[f]));
        let checksum = match operation {
            Operation::FaceBarycenter => of_faces(),
            Operation::VertexNormal | Operation::VvSmooth => of_vertices(),
            Operation::EdgeLength => result.sum,
            _ => result.count as f64,
        };
        let kind = ElementKind::ALL
            .into_iter()
            .find(|kind| kind.name() == operation.unit());
        let elements = match kind {
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

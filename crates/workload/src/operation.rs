//! The loops of the operations that a study times.
//!
//! A loop is one file of this folder. What is said about an operation is in `sixfold-measure`. An operation that
//! visits the elements of the mesh is added by its description there, and by a file with a function `sweep` and its
//! line in [`sweep`] here.

use sixfold::MeshQuery;
use sixfold_measure::{Checksum, ElementKind, Operation};

use crate::sweeps::{Elements, Outputs, SweepResult};

mod all_queries;
mod boundary;
pub(crate) mod build;
mod circulate;
mod edge_length;
pub(crate) mod edit_pass;
mod face_barycenter;
mod ff_bfs;
pub(crate) mod relation;
pub(crate) mod subdivision;
mod vertex_normal;
pub(crate) mod vv_smooth;

/// **Timed**: runs the part of `operation` that visits elements of `kind`.
#[inline]
pub(crate) fn sweep<M: MeshQuery, E: Elements<M>>(
    operation: Operation,
    kind: ElementKind,
    mesh: &M,
    elements: &E,
    outputs: &mut Outputs<M>,
) -> SweepResult {
    match operation {
        Operation::Relation(relation) => elements.query(mesh, relation),
        Operation::Circulate => circulate::sweep(kind, mesh, elements, outputs),
        Operation::FaceBarycenter => face_barycenter::sweep(kind, mesh, elements, outputs),
        Operation::VertexNormal => vertex_normal::sweep(kind, mesh, elements, outputs),
        Operation::VvSmooth => vv_smooth::sweep(kind, mesh, elements, outputs),
        Operation::EdgeLength => edge_length::sweep(kind, mesh, elements, outputs),
        Operation::Boundary => boundary::sweep(kind, mesh, elements, outputs),
        Operation::FfBfs => ff_bfs::sweep(kind, mesh, elements, outputs),
        Operation::AllQueries => all_queries::sweep(kind, mesh, elements, outputs),
        // The functions `run` of their modules run these operations.
        Operation::Build
        | Operation::CatmullClark(_)
        | Operation::Loop(_)
        | Operation::EditPass(_) => SweepResult::default(),
    }
}

/// Returns the checksum of an operation with the result `sum`. `values` returns the sum of the values
/// that the operation stored for the visited elements of a kind.
pub(crate) fn checksum(
    operation: Operation,
    sum: SweepResult,
    values: &dyn Fn(ElementKind) -> f64,
) -> f64 {
    match operation.checksum() {
        Checksum::Count => sum.count as f64,
        Checksum::Lengths | Checksum::Positions => sum.sum,
        Checksum::FaceValues => values(ElementKind::Face),
        Checksum::VertexValues => values(ElementKind::Vertex),
    }
}

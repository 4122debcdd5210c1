//! Counts the edges with one face.

use sixfold::MeshQuery;

use crate::sweeps::{Elements, Outputs, SweepResult};
use sixfold_measure::ElementKind;

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    _: ElementKind,
    mesh: &M,
    elements: &E,
    _: &mut Outputs<M>,
) -> SweepResult {
    boundary_edges(mesh, elements)
}

#[inline(never)]
fn boundary_edges<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    let (edges, boundary) = elements.edges(mesh).fold((0, 0), |(edges, boundary), e| {
        let is_boundary = mesh.edge_faces(e).count() == 1;
        (edges + 1, boundary + u64::from(is_boundary))
    });
    SweepResult {
        elements: edges,
        count: boundary,
        sum: 0.0,
    }
}

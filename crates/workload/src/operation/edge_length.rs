//! Sums the lengths of all edges.

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
    edge_lengths(mesh, elements)
}

#[inline(never)]
fn edge_lengths<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    let (count, sum) = elements.edges(mesh).fold((0, 0.0), |(count, sum), e| {
        let [a, b] = mesh.edge_vertices(e);
        let length = mesh.position(a).distance(mesh.position(b));
        (count + 1, sum + f64::from(length))
    });
    SweepResult {
        elements: count,
        count,
        sum,
    }
}

//! Queries the faces of every vertex and the vertices of every face.

use sixfold::{MeshQuery, Relation};

use crate::sweeps::{Elements, Outputs, SweepResult};
use sixfold_measure::ElementKind;

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    kind: ElementKind,
    mesh: &M,
    elements: &E,
    _: &mut Outputs<M>,
) -> SweepResult {
    let queried = match kind {
        ElementKind::Vertex => Relation::VertexFaces,
        _ => Relation::FaceVertices,
    };
    elements.query(mesh, queried)
}

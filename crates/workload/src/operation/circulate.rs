//! Queries the faces of every vertex and the vertices of every face.

use sixfold::{MeshQuery, Relation};

use super::{Description, ElementKind, Unit};
use crate::sweeps::{Elements, Outputs, SweepResult};

pub(super) const DESCRIPTION: Description = Description {
    name: "circulate",
    about: "vertex_faces, then face_vertices",
    unit: Unit::Visit,
    visits: &[(ElementKind::Vertex, &[Relation::VertexFaces]), (ElementKind::Face, &[Relation::FaceVertices])],
    ..Description::QUERIES
};

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


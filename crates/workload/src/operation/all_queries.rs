//! Queries all nine relations: three at every vertex, three at every edge, three at every face.

use sixfold::MeshQuery;

use crate::sweeps::{Elements, Outputs, SweepResult, query_each};
use sixfold_measure::ElementKind;

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    kind: ElementKind,
    mesh: &M,
    elements: &E,
    _: &mut Outputs<M>,
) -> SweepResult {
    match kind {
        ElementKind::Vertex => query_vertices(mesh, elements),
        ElementKind::Edge => query_edges(mesh, elements),
        ElementKind::Face => query_faces(mesh, elements),
    }
}

#[inline(never)]
fn query_vertices<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    query_each(elements.vertices(mesh), |sink, v| {
        let sink = sink.with(mesh.vertex_vertices(v));
        let sink = sink.with(mesh.vertex_edges(v));
        sink.with(mesh.vertex_faces(v))
    })
}

#[inline(never)]
fn query_edges<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    query_each(elements.edges(mesh), |sink, e| {
        let sink = sink.with(mesh.edge_vertices(e));
        let sink = sink.with(mesh.edge_edges(e));
        sink.with(mesh.edge_faces(e))
    })
}

#[inline(never)]
fn query_faces<M: MeshQuery, E: Elements<M>>(mesh: &M, elements: &E) -> SweepResult {
    query_each(elements.faces(mesh), |sink, f| {
        let sink = sink.with(mesh.face_vertices(f));
        let sink = sink.with(mesh.face_edges(f));
        sink.with(mesh.face_faces(f))
    })
}

//! Queries one relation at every element of one kind.

use sixfold::{MeshQuery, Relation};

use super::{Description, ElementKind, Unit, Visits};
use crate::sweeps::{SweepResult, query_each};

/// The description of each relation, in the order of [`Relation::ALL`].
pub(super) const DESCRIPTIONS: [Description; 9] = [
    describe(
        Relation::VertexVertices,
        "the other ends of the edges at each vertex",
        &[(ElementKind::Vertex, &[Relation::VertexVertices])],
    ),
    describe(
        Relation::VertexEdges,
        "the edges that end at each vertex",
        &[(ElementKind::Vertex, &[Relation::VertexEdges])],
    ),
    describe(
        Relation::VertexFaces,
        "the faces around each vertex",
        &[(ElementKind::Vertex, &[Relation::VertexFaces])],
    ),
    describe(
        Relation::EdgeVertices,
        "the two ends of each edge",
        &[(ElementKind::Edge, &[Relation::EdgeVertices])],
    ),
    describe(
        Relation::EdgeEdges,
        "the edges that share an end with each edge",
        &[(ElementKind::Edge, &[Relation::EdgeEdges])],
    ),
    describe(
        Relation::EdgeFaces,
        "the faces along each edge",
        &[(ElementKind::Edge, &[Relation::EdgeFaces])],
    ),
    describe(
        Relation::FaceVertices,
        "the corners of each face",
        &[(ElementKind::Face, &[Relation::FaceVertices])],
    ),
    describe(
        Relation::FaceEdges,
        "the sides of each face",
        &[(ElementKind::Face, &[Relation::FaceEdges])],
    ),
    describe(
        Relation::FaceFaces,
        "the faces that share an edge with each face",
        &[(ElementKind::Face, &[Relation::FaceFaces])],
    ),
];

const fn describe(relation: Relation, about: &'static str, visits: Visits) -> Description {
    Description {
        name: relation.name(),
        about,
        unit: Unit::Element(ElementKind::queried_by(relation)),
        visits,
        ..Description::QUERIES
    }
}

/// **Timed**: queries `relation` of all elements.
///
/// Each loop is a function of its own, of the shape that programs of users have. In one function with
/// nine loops, the compiler changes the loops: on an Intel Xeon (family 6, model 167), `face_vertices`
/// of a half-edge mesh then took 1.57 ns for a face instead of 1.42. `benches/checks/plain_program.py`
/// compares each loop with a program of a user.
#[inline]
pub(crate) fn query_all<M: MeshQuery>(relation: Relation, mesh: &M) -> SweepResult {
    macro_rules! sweep_relation {
        (edge_vertices $list:ident $from:ident $to:ident) => {{
            // Programs of users take the array of the two ends apart.
            #[inline(never)]
            fn edge_vertices<M: MeshQuery>(mesh: &M) -> SweepResult {
                query_each(mesh.$list(), |sink, element| {
                    let [a, b] = mesh.edge_vertices(element);
                    sink.with_one(a).with_one(b)
                })
            }
            edge_vertices(mesh)
        }};
        ($query:ident $list:ident $from:ident $to:ident) => {{
            #[inline(never)]
            fn $query<M: MeshQuery>(mesh: &M) -> SweepResult {
                query_each(mesh.$list(), |sink, element| {
                    sink.with(mesh.$query(element))
                })
            }
            $query(mesh)
        }};
    }
    sixfold_core::match_relation!(relation, sweep_relation!)
}

//! Applies an edit to a structure. The elements of the edit are identified by their numbers in the
//! model.

use std::collections::BTreeMap;
use std::convert::Infallible;

use sixfold_core::{EditCall, EditOf, EditRecord, EditResult, MeshEdit, Refusal};

use super::action::Action;

/// Applies `action` to a mesh of the structure `name`. `vertices` and `faces` map the elements of
/// the model to handles. Returns the vertex that the action made or moved.
pub(crate) fn apply_action<M: MeshEdit>(
    mesh: &mut M,
    name: &str,
    vertices: &BTreeMap<usize, M::Vertex>,
    faces: &BTreeMap<usize, M::Face>,
    action: &Action,
    log: &mut EditRecord<M>,
) -> Result<Option<M::Vertex>, Refusal<M>> {
    let call = translated(mesh, name, vertices, faces, action);
    let isolated = matches!(call, EditCall::RemoveIsolatedVertices {}).then(|| {
        let is_isolated = |v: &M::Vertex| mesh.vertex_faces(*v).next().is_none();
        mesh.vertices().filter(is_isolated).count()
    });
    let along: Vec<M::Face> = match call {
        EditCall::DissolveEdge { e } => mesh.edge_faces(e).collect(),
        _ => Vec::new(),
    };
    match (call.apply(mesh, log)?, &call) {
        (EditResult::Vertex(v), _) => return Ok(Some(v)),
        (EditResult::Count(removed), _) => assert_eq!(Some(removed), isolated, "{name}"),
        (EditResult::Edge(e), EditCall::SplitFace { ends: [a, b], .. }) => {
            assert_eq!(mesh.edge_between(*a, *b), Some(e), "{name}");
        }
        (EditResult::Edge(e), _) => {
            let [a, b] = mesh.edge_vertices(e);
            assert_eq!(mesh.edge_between(a, b), Some(e), "{name}");
        }
        (EditResult::Face(f), EditCall::DissolveEdge { e }) => {
            assert!(along.contains(&f), "{name}: {f:?} was not a face of {e:?}");
        }
        (EditResult::Face(_) | EditResult::Nothing, _) => {}
    }
    Ok(None)
}

/// Returns `action` with the handles of its elements.
pub(crate) fn translated<M: MeshEdit>(
    mesh: &M,
    name: &str,
    vertices: &BTreeMap<usize, M::Vertex>,
    faces: &BTreeMap<usize, M::Face>,
    action: &Action,
) -> EditOf<M> {
    let vertex = |v: &usize| Ok::<_, Infallible>(vertices[v]);
    let edge = |ends: &[usize; 2]| {
        let [a, b] = ends.map(|v| vertices[&v]);
        let edge = mesh.edge_between(a, b);
        Ok(edge.unwrap_or_else(|| panic!("{name}: no edge between {a:?} and {b:?}")))
    };
    let Ok(call) = action.try_map(vertex, edge, |f| Ok(faces[f]));
    call
}

//! Applies an edit to a structure. The elements of the edit are identified by their numbers in the
//! model.

use std::collections::BTreeMap;

use sixfold_core::{EditRecord, MeshEdit, Refusal};

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
    let edge = |mesh: &M, ends: [usize; 2]| {
        let [a, b] = ends.map(|v| vertices[&v]);
        let edge = mesh.edge_between(a, b);
        edge.unwrap_or_else(|| panic!("{name}: no edge between {a:?} and {b:?}"))
    };
    Ok(match action {
        &Action::SetPosition { v, to } => Some(mesh.set_position_logged(vertices[&v], to, log)?),
        &Action::AddVertex { at } => Some(mesh.add_vertex_logged(at, log)?),
        Action::AddFace { corners } => {
            let corners: Vec<_> = corners.iter().map(|v| vertices[v]).collect();
            mesh.add_face_logged(&corners, log).map(|_| None)?
        }
        Action::RemoveFace { f } => mesh.remove_face_logged(faces[f], log).map(|()| None)?,
        Action::RemoveVertex { v } => mesh.remove_vertex_logged(vertices[v], log).map(|()| None)?,
        Action::RemoveIsolatedVertices => {
            let is_isolated = |v: &M::Vertex| mesh.vertex_faces(*v).next().is_none();
            let isolated = mesh.vertices().filter(is_isolated).count();
            let removed = mesh.remove_isolated_vertices_logged(log);
            assert_eq!(removed, isolated, "{name}");
            None
        }
        &Action::SplitEdge { ends, at } => {
            Some(mesh.split_edge_logged(edge(mesh, ends), at, log)?)
        }
        &Action::BisectEdge { ends, at } => {
            Some(mesh.bisect_edge_logged(edge(mesh, ends), at, log)?)
        }
        &Action::PokeFace { f, at } => Some(mesh.poke_face_logged(faces[&f], at, log)?),
        Action::SplitFace { f, ends } => {
            let e = mesh.split_face_logged(faces[f], ends.map(|v| vertices[&v]), log)?;
            assert_eq!(edge(mesh, *ends), e, "{name}");
            None
        }
        &Action::DissolveEdge { ends } => {
            let e = edge(mesh, ends);
            let along: Vec<_> = mesh.edge_faces(e).collect();
            let f = mesh.dissolve_edge_logged(e, log)?;
            assert!(along.contains(&f), "{name}: {f:?} was not a face of {e:?}");
            None
        }
        &Action::FlipEdge { ends } => {
            let e = mesh.flip_edge_logged(edge(mesh, ends), log)?;
            let [a, b] = mesh.edge_vertices(e);
            assert_eq!(mesh.edge_between(a, b), Some(e), "{name}");
            None
        }
        &Action::CollapseEdge { ends, to } => {
            let (e, keep) = (edge(mesh, ends), vertices[&ends[0]]);
            Some(mesh.collapse_edge_logged(e, keep, to, log)?)
        }
        &Action::SplitVertex { v, left, right, at } => {
            let [left, right] = [left, right].map(|side| side.map(|v| vertices[&v]));
            Some(mesh.split_vertex_logged(vertices[&v], left, right, at, log)?)
        }
        Action::Compact => {
            mesh.compact_logged(log);
            None
        }
    })
}

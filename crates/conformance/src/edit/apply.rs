//! Executes an action on a structure.

use std::collections::BTreeMap;

use sixfold_core::{EditRecord, MeshEdit, Refusal};

use super::action::Action;

/// Applies `action` to a mesh of the structure `name`, with the handles of the elements of the
/// model, and returns the vertex that it made or moved.
pub(super) fn apply_action<M: MeshEdit>(
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
    match action {
        &Action::SetPosition { v, to } => {
            let v = vertices[&v];
            return mesh.set_position_logged(v, to, log).map(Some);
        }
        &Action::AddVertex { at } => return mesh.add_vertex_logged(at, log).map(Some),
        Action::AddFace { corners } => {
            let corners: Vec<_> = corners.iter().map(|&v| vertices[&v]).collect();
            mesh.add_face_logged(&corners, log)?;
        }
        Action::RemoveFace { f } => mesh.remove_face_logged(faces[f], log)?,
        &Action::RemoveVertex { v } => {
            let v = vertices[&v];
            mesh.remove_vertex_logged(v, log)?;
        }
        Action::RemoveIsolatedVertices => {
            let isolated = mesh.vertices();
            let isolated = isolated.filter(|&v| mesh.vertex_faces(v).next().is_none());
            let isolated = isolated.count();
            assert_eq!(
                mesh.remove_isolated_vertices_logged(log),
                isolated,
                "{name}"
            );
        }
        &Action::SplitEdge { ends, at } => {
            let e = edge(mesh, ends);
            return mesh.split_edge_logged(e, at, log).map(Some);
        }
        &Action::BisectEdge { ends, at } => {
            let e = edge(mesh, ends);
            return mesh.bisect_edge_logged(e, at, log).map(Some);
        }
        &Action::PokeFace { f, at } => {
            return mesh.poke_face_logged(faces[&f], at, log).map(Some);
        }
        &Action::SplitFace { f, ends } => {
            let ends = ends.map(|v| vertices[&v]);
            let e = mesh.split_face_logged(faces[&f], ends, log)?;
            assert_eq!(mesh.edge_between(ends[0], ends[1]), Some(e), "{name}");
        }
        &Action::DissolveEdge { ends } => {
            let e = edge(mesh, ends);
            let along: Vec<_> = mesh.edge_faces(e).collect();
            let f = mesh.dissolve_edge_logged(e, log)?;
            assert!(along.contains(&f), "{name}: {f:?} is not a face of {e:?}");
        }
        &Action::FlipEdge { ends } => {
            let e = edge(mesh, ends);
            let e = mesh.flip_edge_logged(e, log)?;
            let ends = mesh.edge_vertices(e);
            assert_eq!(mesh.edge_between(ends[0], ends[1]), Some(e), "{name}");
        }
        &Action::CollapseEdge { ends, to } => {
            let (e, keep) = (edge(mesh, ends), vertices[&ends[0]]);
            return mesh.collapse_edge_logged(e, keep, to, log).map(Some);
        }
        &Action::SplitVertex { v, left, right, at } => {
            let [left, right] = [left, right].map(|side| side.map(|v| vertices[&v]));
            let v = vertices[&v];
            return mesh.split_vertex_logged(v, left, right, at, log).map(Some);
        }
        Action::Compact => mesh.compact_logged(log),
    }
    Ok(None)
}

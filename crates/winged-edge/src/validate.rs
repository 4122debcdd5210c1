//! One check for each invariant.

#[cfg(test)]
mod tests;

use sixfold_core::invariant_checks::{
    check_distinct_edges, check_fans, check_holes, check_walks_along_faces, fails,
};
use sixfold_core::{EdgeId, Editing, HoleSet, InvariantError, MeshQuery, Slot};

use crate::edge::{Edge, NO_EDGE, Run};
use crate::mesh::WingedEdgeMesh;

/// Checks I9, then I1 to I8. Each check relies on the earlier checks.
pub(crate) fn validate<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    check_deleted(mesh)?;
    check_handles(mesh)?;
    check_edge_sides(mesh)?;
    check_ends(mesh)?;
    check_cycle_faces(mesh)?;
    check_inverse_wings(mesh)?;
    check_spokes(mesh)?;
    let origins = runs(mesh).map(|(_, run)| run.origin());
    let walk = |v| mesh.vertex_edges(v).count();
    check_fans("I6", mesh, "edges", origins, walk)?;
    check_faces(mesh)?;
    check_distinct_edges("I8", mesh)
}

fn runs<E: Editing>(mesh: &WingedEdgeMesh<E>) -> impl Iterator<Item = (EdgeId, Run<'_>)> {
    mesh.edges().flat_map(|e| {
        let edge = mesh.edge(e);
        edge.ends().map(|v| (e, Run::from(edge, v)))
    })
}

fn records<E: Editing>(mesh: &WingedEdgeMesh<E>) -> impl Iterator<Item = (EdgeId, &Edge)> {
    mesh.edges().map(|e| (e, mesh.edge(e)))
}

/// Checks the first part of I9: exactly the deleted elements are marked as deleted.
fn check_deleted<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    let [vertices, edges, faces] = [mesh.spokes.len(), mesh.edges.len(), mesh.sides.len()];
    let kinds = [
        (&mesh.vertex_holes, vertices),
        (&mesh.edge_holes, edges),
        (&mesh.face_holes, faces),
    ];
    check_holes("I9", kinds)?;
    let spoke_kept = |&v: &usize| mesh.vertex_holes.has(v) && mesh.spoke_rows()[v] != Slot::NONE;
    if let Some(v) = (0..vertices).find(spoke_kept) {
        return fails("I9", format!("v{v} is deleted, but has a spoke"));
    }
    let edge_differs = |&e: &usize| mesh.edge_holes.has(e) != mesh.edge_records()[e].is_deleted();
    if let Some(e) = (0..edges).find(edge_differs) {
        return fails(
            "I9",
            format!("edge holes and `edges` disagree on whether e{e} was deleted"),
        );
    }
    let face_differs = |&f: &usize| mesh.face_holes.has(f) != (mesh.side_rows()[f] == NO_EDGE);
    match (0..faces).find(face_differs) {
        Some(f) => fails(
            "I9",
            format!("face holes and `sides` disagree on whether f{f} was deleted"),
        ),
        None => Ok(()),
    }
}

/// Checks the second part of I1 and of I9: every handle refers to an existing element. The later
/// checks rely on this check.
fn check_handles<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    let [vertices, edges, faces] = [mesh.positions.len(), mesh.edges.len(), mesh.sides.len()];
    if vertices != mesh.spokes.len() {
        let spokes = mesh.spokes.len();
        return fails("I1", format!("{spokes} spokes for {vertices} vertices"));
    }
    let has_edge = |e: EdgeId| e.index() < edges;
    for (e, edge) in records(mesh) {
        let ends = edge.ends().iter().all(|v| v.index() < vertices);
        let mut wings = edge.next().into_iter().chain(edge.prev());
        let mut sides = edge.faces().into_iter().flatten();
        if !ends || !wings.all(has_edge) || !sides.all(|f| f.index() < faces) {
            return fails("I1", format!("{e} refers to a missing element: {edge:?}"));
        }
        let ends = edge.ends().iter().any(|v| mesh.vertex_holes.has(v.index()));
        let mut wings = edge.next().into_iter().chain(edge.prev());
        let mut sides = edge.faces().into_iter().flatten();
        let face = sides.any(|f| mesh.face_holes.has(f.index()));
        if ends || face || wings.any(|w| mesh.edge_holes.has(w.index())) {
            return fails("I9", format!("{e} refers to a deleted element: {edge:?}"));
        }
    }
    let spokes = mesh.vertices().filter_map(|v| mesh.spoke(v));
    let mut named = spokes.chain(mesh.faces().map(|f| mesh.side(f)));
    match named.find(|&e| !has_edge(e) || mesh.edge_holes.has(e.index())) {
        Some(e) if has_edge(e) => fails("I9", format!("a row refers to {e}, which was deleted")),
        Some(e) => fails("I1", format!("a row refers to {e}, which does not exist")),
        None => Ok(()),
    }
}

/// Checks the first part of I1.
fn check_edge_sides<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    for (e, edge) in records(mesh) {
        let ([start, end], [left, right]) = (edge.ends(), edge.faces());
        if start == end {
            return fails("I1", format!("{e} runs from {start} to itself"));
        }
        if left == right {
            return fails("I1", format!("{e} has {left:?} on both sides"));
        }
    }
    Ok(())
}

fn check_ends<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    for (e, run) in runs(mesh) {
        for (wing, v) in [(run.next(), run.target()), (run.prev(), run.origin())] {
            if !mesh.edge(wing).ends().contains(&v) {
                return fails(
                    "I2",
                    format!("{wing} is a wing of {e} at {v}, but {v} is not its end"),
                );
            }
        }
    }
    Ok(())
}

fn check_cycle_faces<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    for (e, run) in runs(mesh) {
        let next = Run::from(mesh.edge(run.next()), run.target());
        if next.face() != run.face() {
            let (wing, v) = (run.next(), run.target());
            return fails(
                "I3",
                format!("{e} and its next wing {wing} have different faces at {v}"),
            );
        }
    }
    Ok(())
}

fn check_inverse_wings<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    for (e, run) in runs(mesh) {
        // The previous wing arrives at the origin of the run.
        let next = Run::from(mesh.edge(run.next()), run.target());
        let prev = Run::from(mesh.edge(run.prev()), run.origin());
        if next.prev() != e || prev.cw() != e {
            let (next, prev) = (run.next(), run.prev());
            return fails(
                "I4",
                format!("{e} is not between its wings {prev} and {next}"),
            );
        }
    }
    Ok(())
}

fn check_spokes<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    for v in mesh.vertices() {
        if let Some(e) = mesh.spoke(v).filter(|&e| !mesh.edge(e).ends().contains(&v)) {
            return fails("I5", format!("{v} is not an end of its spoke {e}"));
        }
    }
    for (e, run) in runs(mesh) {
        let v = run.origin();
        let Some(spoke) = mesh.spoke(v) else {
            return fails("I5", format!("{v} is an end of {e}, but has no spoke"));
        };
        let first = Run::from(mesh.edge(spoke), v);
        if run.across() == Slot::NONE && first.across() != Slot::NONE {
            let detail = format!(
                "{v} is on a boundary, but its spoke {spoke} does not start at the boundary"
            );
            return fails("I5", detail);
        }
    }
    Ok(())
}

fn check_faces<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    for f in mesh.faces() {
        let e = mesh.side(f);
        if !mesh.edge(e).faces().contains(&Some(f)) {
            return fails("I7", format!("{f} is not a face of its side {e}"));
        }
    }
    let with_face = runs(mesh).filter(|(_, run)| run.face() != Slot::NONE);
    check_walks_along_faces("I7", mesh, with_face.count())
}

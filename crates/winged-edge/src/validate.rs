//! One check for each invariant.

use std::collections::HashSet;

use sixfold_core::{EdgeId, Editing, HoleSet, InvariantError, MeshQuery, Slot};

use crate::edge::{Edge, NO_EDGE, Run};
use crate::mesh::WingedEdgeMesh;

/// Checks I9, then I1 to I8; each check relies on the earlier ones.
pub(crate) fn validate<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    check_holes(mesh)?;
    check_handles(mesh)?;
    check_edge_sides(mesh)?;
    check_ends(mesh)?;
    check_cycle_faces(mesh)?;
    check_inverse_wings(mesh)?;
    check_spokes(mesh)?;
    check_fans(mesh)?;
    check_faces(mesh)?;
    check_distinct_edges(mesh)
}

fn fails(invariant: &'static str, detail: String) -> Result<(), InvariantError> {
    Err(InvariantError::new(invariant, detail))
}

/// Iterates over both runs of every edge that is not deleted.
fn runs<E: Editing>(mesh: &WingedEdgeMesh<E>) -> impl Iterator<Item = (EdgeId, Run<'_>)> {
    mesh.edges().flat_map(|e| {
        let edge = mesh.edge(e);
        edge.ends().map(|v| (e, Run::from(edge, v)))
    })
}

/// Iterates over the edges that are not deleted, with their records.
fn records<E: Editing>(mesh: &WingedEdgeMesh<E>) -> impl Iterator<Item = (EdgeId, &Edge)> {
    mesh.edges().map(|e| (e, mesh.edge(e)))
}

/// Checks the first part of I9: exactly the rows of deleted elements are marked as deleted.
fn check_holes<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    let [vertices, edges, faces] = [mesh.spokes.len(), mesh.edges.len(), mesh.sides.len()];
    for (holes, rows) in [
        (&mesh.vertex_holes, vertices),
        (&mesh.edge_holes, edges),
        (&mesh.face_holes, faces),
    ] {
        if let Err(detail) = holes.check(rows) {
            return fails("I9", detail);
        }
    }
    let spoke_kept = |&v: &usize| mesh.vertex_holes.has(v) && mesh.spoke_rows()[v] != Slot::NONE;
    if let Some(v) = (0..vertices).find(spoke_kept) {
        return fails("I9", format!("v{v} is deleted, but has a spoke"));
    }
    let edge_differs = |&e: &usize| mesh.edge_holes.has(e) != mesh.edge_records()[e].is_deleted();
    if let Some(e) = (0..edges).find(edge_differs) {
        return fails("I9", format!("deletion marks of e{e} disagree"));
    }
    let face_differs = |&f: &usize| mesh.face_holes.has(f) != (mesh.side_rows()[f] == NO_EDGE);
    match (0..faces).find(face_differs) {
        Some(f) => fails("I9", format!("deletion marks of f{f} disagree")),
        None => Ok(()),
    }
}

/// Checks the second part of I1 and of I9: every handle in the tables refers to an element that
/// exists. The other checks walk along these handles, so they rely on this check.
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
        Some(e) if has_edge(e) => fails("I9", format!("{e} is referred to, but deleted")),
        Some(e) => fails("I1", format!("{e} is referred to, but missing")),
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
        // The previous wing arrives at the origin, and `e` is the next edge clockwise from it
        // there.
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
            let detail = format!("{v} is on a boundary, but its spoke {spoke} is not first");
            return fails("I5", detail);
        }
    }
    Ok(())
}

fn check_fans<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    let mut edges = vec![0_usize; mesh.vertex_rows()];
    for (_, run) in runs(mesh) {
        edges[run.origin().index()] += 1;
    }
    for v in mesh.vertices() {
        let (walked, all) = (mesh.vertex_edges(v).count(), edges[v.index()]);
        if walked != all {
            return fails(
                "I6",
                format!("the walk around {v} visits {walked} of {all} edges"),
            );
        }
    }
    Ok(())
}

fn check_faces<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    let mut along = 0;
    for f in mesh.faces() {
        let e = mesh.side(f);
        if !mesh.edge(e).faces().contains(&Some(f)) {
            return fails("I7", format!("{f} is not a face of its side {e}"));
        }
        let corners: Vec<_> = mesh.face_vertices(f).collect();
        let distinct: HashSet<_> = corners.iter().collect();
        if corners.len() < 3 || distinct.len() < corners.len() {
            return fails("I7", format!("{f} has invalid corners: {corners:?}"));
        }
        along += corners.len();
    }
    let with_face = runs(mesh)
        .filter(|(_, run)| run.face() != Slot::NONE)
        .count();
    if along != with_face {
        let detail = format!("{with_face} sides have a face, the walks along faces visit {along}");
        return fails("I7", detail);
    }
    Ok(())
}

fn check_distinct_edges<E: Editing>(mesh: &WingedEdgeMesh<E>) -> Result<(), InvariantError> {
    let mut ends = HashSet::new();
    for e in mesh.edges() {
        let [a, b] = mesh.edge_vertices(e);
        if !ends.insert([a.min(b), a.max(b)]) {
            return fails(
                "I8",
                format!("{e} and another edge have the same ends, {a} and {b}"),
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use sixfold_core::{
        FaceId, MeshEdit, Point, PolygonMesh, Representation, RowId, Table, VertexId,
    };

    use super::*;
    use crate::EditableWingedEdgeMesh;
    use crate::wings::{Side, Wings};

    fn mesh(vertices: u16, faces: &[&[u32]]) -> EditableWingedEdgeMesh {
        let corners: Vec<_> = (0..vertices).map(|i| Point::splat(i.into())).collect();
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        let mesh = EditableWingedEdgeMesh::from_polygons(&polygons).expect("manifold");
        assert_eq!(mesh.validate(), Ok(()));
        mesh
    }

    /// Returns a square of two triangles and an isolated vertex; the diagonal runs from v0 to v2.
    fn sound() -> EditableWingedEdgeMesh {
        mesh(5, &[&[0, 1, 2], &[0, 2, 3]])
    }

    /// Returns the invariant that fails after `break_it`.
    fn broken(break_it: impl Fn(&mut EditableWingedEdgeMesh)) -> &'static str {
        let mut mesh = sound();
        break_it(&mut mesh);
        mesh.validate().expect_err("the mesh is broken").invariant
    }

    fn between(mesh: &EditableWingedEdgeMesh, a: u32, b: u32) -> EdgeId {
        let has = |e, v| mesh.edge(e).ends().contains(&VertexId::new(v));
        let mut edges = mesh.edges();
        edges.find(|&e| has(e, a) && has(e, b)).expect("an edge")
    }

    /// Returns the record of the edge between `a` and `b`.
    fn record(mesh: &mut EditableWingedEdgeMesh, a: u32, b: u32) -> &mut Edge {
        let e = between(mesh, a, b);
        &mut mesh.edges.rows_mut()[e.index()]
    }

    /// Returns the record of the diagonal.
    fn inner(mesh: &mut EditableWingedEdgeMesh) -> &mut Edge {
        record(mesh, 0, 2)
    }

    /// Overwrites the wing on the left (0) or on the right (1).
    fn set_wing(wings: &mut Wings, side: usize, wing: EdgeId) {
        wings.set(Side::right_if(side == 1), wing);
    }

    /// Replaces the vertex `merged` by `kept` in all records, and clears its spoke.
    fn merge(mesh: &mut EditableWingedEdgeMesh, kept: u32, merged: u32) {
        for edge in mesh.edges.rows_mut() {
            let merge = |v: VertexId| VertexId::new(if v.row() == merged { kept } else { v.row() });
            edge.ends = edge.ends.map(merge);
        }
        mesh.spokes.rows_mut()[merged as usize] = Slot::NONE;
    }

    #[test]
    fn references_to_missing_elements_break_i1() {
        let (v, e, f) = (VertexId::new(9), EdgeId::new(9), Slot::some(FaceId::new(9)));
        assert_eq!(broken(|m| inner(m).ends[1] = v), "I1");
        assert_eq!(broken(|m| set_wing(&mut inner(m).next, 0, e)), "I1");
        assert_eq!(broken(|m| set_wing(&mut inner(m).prev, 1, e)), "I1");
        assert_eq!(broken(|m| inner(m).faces[1] = f), "I1");
        assert_eq!(broken(|m| m.spokes.rows_mut()[0] = Slot::some(e)), "I1");
        assert_eq!(broken(|m| m.sides.rows_mut()[0] = e), "I1");
        let shorter = |m: &mut EditableWingedEdgeMesh| {
            m.spokes = Table::new("spokes", "vertex", m.spokes.rows()[..4].to_vec());
        };
        assert_eq!(broken(shorter), "I1");
    }

    #[test]
    fn two_equal_sides_break_i1() {
        let loops = |m: &mut EditableWingedEdgeMesh| inner(m).ends[1] = VertexId::new(0);
        assert_eq!(broken(loops), "I1");
        let folded = |m: &mut EditableWingedEdgeMesh| inner(m).faces[1] = inner(m).faces[0];
        assert_eq!(broken(folded), "I1");
        assert_eq!(broken(|m| record(m, 0, 1).faces = [Slot::NONE; 2]), "I1");
    }

    #[test]
    fn wings_at_another_vertex_break_i2() {
        let far = |m: &mut EditableWingedEdgeMesh, side, a, b| {
            let wing = between(m, a, b);
            set_wing(&mut inner(m).next, side, wing);
        };
        assert_eq!(broken(|m| far(m, 0, 0, 1)), "I2");
        assert_eq!(broken(|m| far(m, 1, 2, 3)), "I2");
        let behind = |m: &mut EditableWingedEdgeMesh| {
            let wing = between(m, 2, 3);
            set_wing(&mut inner(m).prev, 0, wing);
        };
        assert_eq!(broken(behind), "I2");
        assert_eq!(broken(|m| inner(m).ends[1] = VertexId::new(4)), "I2");
        assert_eq!(broken(|m| inner(m).ends.reverse()), "I2");
    }

    #[test]
    fn a_face_that_changes_along_its_sides_breaks_i3() {
        assert_eq!(broken(|m| inner(m).faces.reverse()), "I3");
        assert_eq!(broken(|m| record(m, 0, 1).faces.reverse()), "I3");
    }

    #[test]
    fn wings_that_are_not_inverse_break_i4() {
        // Two triangles with a common vertex, where the boundary of one could continue along the
        // other.
        let mut mesh = mesh(6, &[&[0, 1, 2], &[3, 4, 5]]);
        merge(&mut mesh, 0, 5);
        let v = VertexId::new(0);
        let [one, other] = [between(&mesh, 0, 1), between(&mesh, 0, 3)];
        for (e, to) in [(one, other), (other, one)] {
            let run = Run::from(mesh.edge(e), v);
            assert_eq!(
                [run.face(), run.across()].map(|f| f == Slot::NONE),
                [false, true]
            );
            // The blank side arrives at v; the edge after it there is the one clockwise of `to`.
            let next = Run::from(mesh.edge(to), v).cw();
            let blank = usize::from(mesh.edge(e).ends()[0] == v);
            let mut broken = mesh.clone();
            set_wing(&mut broken.edges.rows_mut()[e.index()].next, blank, next);
            assert_eq!(broken.validate().expect_err("not inverse").invariant, "I4");
        }
    }

    #[test]
    fn spokes_that_are_not_first_break_i5() {
        let spoke = |m: &mut EditableWingedEdgeMesh, v: usize, to: Option<EdgeId>| {
            m.spokes.rows_mut()[v] = Slot::from(to);
        };
        assert_eq!(broken(|m| spoke(m, 1, None)), "I5");
        assert_eq!(broken(|m| spoke(m, 1, Some(between(m, 0, 3)))), "I5");
        assert_eq!(broken(|m| spoke(m, 4, Some(between(m, 0, 1)))), "I5");
        // v0 has edges to v1, v2 and v3, in this order.
        assert_eq!(
            sound().spoke(VertexId::new(0)),
            Some(between(&sound(), 0, 1))
        );
        assert_eq!(broken(|m| spoke(m, 0, Some(between(m, 0, 2)))), "I5");
        assert_eq!(broken(|m| spoke(m, 0, Some(between(m, 0, 3)))), "I5");
    }

    #[test]
    fn a_vertex_with_two_fans_breaks_i6() {
        let mut mesh = mesh(6, &[&[0, 1, 2], &[3, 4, 5]]);
        merge(&mut mesh, 0, 5);
        assert_eq!(mesh.validate().expect_err("two fans").invariant, "I6");
    }

    #[test]
    fn a_face_that_is_not_at_its_side_breaks_i7() {
        let elsewhere = |m: &mut EditableWingedEdgeMesh| {
            let side = between(m, 0, 3);
            m.sides.rows_mut()[0] = side;
        };
        assert_eq!(broken(elsewhere), "I7");
        // A square that is folded so that two of its corners are one vertex.
        let mut folded = mesh(
            9,
            &[
                &[0, 1, 2, 3],
                &[1, 0, 4, 5],
                &[2, 1, 6, 7],
                &[3, 2, 8, 4, 0],
            ],
        );
        merge(&mut folded, 0, 2);
        let repeated = check_faces(&folded).expect_err("a corner twice");
        assert_eq!(repeated.invariant, "I7");
    }

    #[test]
    fn edges_with_the_same_ends_break_i8() {
        let mut mesh = mesh(4, &[&[0, 1, 2], &[1, 0, 3]]);
        merge(&mut mesh, 2, 3);
        let parallel = check_distinct_edges(&mesh).expect_err("parallel edges");
        assert_eq!(parallel.invariant, "I8");
    }

    #[test]
    fn unmarked_holes_and_references_to_holes_break_i9() {
        // f1 and the edges that only it has are deleted.
        let mut edited = sound();
        let gone = FaceId::new(1);
        let side = between(&edited, 0, 3);
        edited.remove_face(gone).expect("a legal removal");
        edited
            .remove_vertex(VertexId::new(3))
            .expect("it is isolated");
        assert_eq!(edited.validate(), Ok(()));
        let broken = |break_it: &dyn Fn(&mut EditableWingedEdgeMesh)| {
            let mut mesh = edited.clone();
            break_it(&mut mesh);
            mesh.validate().expect_err("the mesh is broken").invariant
        };
        let diagonal = between(&edited, 0, 2);
        assert_eq!(
            broken(&|m| m.spokes.rows_mut()[3] = Slot::some(diagonal)),
            "I9"
        );
        assert_eq!(broken(&|m| m.sides.rows_mut()[1] = diagonal), "I9");
        assert_eq!(broken(&|m| m.sides.rows_mut()[0] = NO_EDGE), "I9");
        assert_eq!(
            broken(&|m| m.edges.rows_mut()[diagonal.index()] = Edge::DELETED),
            "I9"
        );
        assert_eq!(broken(&|m| m.edge_holes.insert(diagonal.index())), "I9");
        assert_eq!(broken(&|m| m.face_holes.insert(7)), "I9");
        assert_eq!(broken(&|m| m.sides.rows_mut()[0] = side), "I9");
        assert_eq!(broken(&|m| inner(m).ends[0] = VertexId::new(3)), "I9");
        assert_eq!(broken(&|m| inner(m).faces[1] = Slot::some(gone)), "I9");
        assert_eq!(broken(&|m| set_wing(&mut inner(m).next, 0, side)), "I9");
        assert_eq!(broken(&|m| m.spokes.rows_mut()[0] = Slot::some(side)), "I9");
    }
}

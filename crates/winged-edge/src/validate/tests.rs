use sixfold_core::{FaceId, MeshEdit, Point, PolygonMesh, Representation, RowId, Table, VertexId};

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

/// Two triangles with the diagonal from v0 to v2, and an isolated vertex.
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

fn record(mesh: &mut EditableWingedEdgeMesh, a: u32, b: u32) -> &mut Edge {
    let e = between(mesh, a, b);
    &mut mesh.edges.rows_mut()[e.index()]
}

fn inner(mesh: &mut EditableWingedEdgeMesh) -> &mut Edge {
    record(mesh, 0, 2)
}

/// Overwrites the wing on the left (0) or on the right (1).
fn set_wing(wings: &mut Wings, side: usize, wing: EdgeId) {
    wings.set(Side::right_if(side == 1), wing);
}

/// Replaces the vertex `merged` by `kept` in all records, and clears the spoke of `merged`.
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
    // Two triangles with a common vertex. The boundary of one triangle could continue along the
    // other triangle.
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
        // The blank side arrives at v. The edge after the blank side is clockwise of `to`.
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
    // The edges of v0 lead to v1, v2 and v3, in this order.
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
    // A folded square: two of its corners are one vertex.
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
    let parallel = check_distinct_edges("I8", &mesh).expect_err("parallel edges");
    assert_eq!(parallel.invariant, "I8");
}

#[test]
fn unmarked_holes_and_references_to_holes_break_i9() {
    // f1 and its edges without another face are deleted.
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

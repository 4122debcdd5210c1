//! Compares `next` and `fold` of the iterators that queries return.

use std::fmt::Debug;
use std::iter;

use sixfold_core::{MeshQuery, OrientedWalk};

/// Checks that every iterator of `mesh` yields the same items by `next` and by `fold`. Also checks
/// `fold` after some calls of `next`.
///
/// # Panics
///
/// Panics if the items differ. The message names the query and the element.
pub(crate) fn check_folds<M: MeshQuery>(mesh: &M, name: &str) {
    check_fold(name, "vertices", "the mesh", || mesh.vertices());
    check_fold(name, "edges", "the mesh", || mesh.edges());
    check_fold(name, "faces", "the mesh", || mesh.faces());
    for v in mesh.vertices() {
        check_fold(name, "vertex_vertices", v, || mesh.vertex_vertices(v));
        check_fold(name, "vertex_edges", v, || mesh.vertex_edges(v));
        check_fold(name, "vertex_faces", v, || mesh.vertex_faces(v));
        check_fold(name, "one_ring", v, || {
            mesh.one_ring(v).into_iter().flatten()
        });
    }
    for e in mesh.edges() {
        check_fold(name, "edge_edges", e, || mesh.edge_edges(e));
        check_fold(name, "edge_faces", e, || mesh.edge_faces(e));
    }
    for f in mesh.faces() {
        check_fold(name, "face_vertices", f, || mesh.face_vertices(f));
        check_fold(name, "face_edges", f, || mesh.face_edges(f));
        check_fold(name, "face_faces", f, || mesh.face_faces(f));
    }
}

/// Checks that every walk from side to side yields the same items by `next` and by `fold`, like
/// [`check_folds`].
pub(crate) fn check_walk_folds<M: OrientedWalk>(mesh: &M, name: &str) {
    check_fold(name, "sides", "the mesh", || mesh.sides());
    for v in mesh.vertices() {
        check_fold(name, "outgoing_sides", v, || mesh.outgoing_sides(v));
    }
    for e in mesh.edges() {
        check_fold(name, "edge_sides", e, || mesh.edge_sides(e));
    }
    for f in mesh.faces() {
        check_fold(name, "face_sides", f, || mesh.face_sides(f));
    }
}

/// Checks that the iterators that `items` makes yield the same items by `next` and by `fold`. Also
/// checks `fold` after some calls of `next`. Use it for a walk that is a method of one structure.
///
/// # Panics
///
/// Panics if the items differ. The message contains the name of the structure, the `query` and the
/// element `of`.
pub fn check_fold<I>(name: &str, query: &str, of: impl Debug, items: impl Fn() -> I)
where
    I: Iterator<Item: Debug + PartialEq>,
{
    let mut steps = items();
    let expected: Vec<I::Item> = iter::from_fn(|| steps.next()).collect();
    let step = (expected.len() / 8).max(1);
    for taken in (0..=expected.len()).step_by(step) {
        let mut rest = items();
        for _ in 0..taken {
            rest.next();
        }
        let folded = rest.fold(Vec::new(), |mut items, item| {
            items.push(item);
            items
        });
        assert_eq!(
            folded,
            expected[taken..],
            "{name}: {query} of {of:?} by fold after {taken} times next (left), and by next (right)"
        );
    }
}

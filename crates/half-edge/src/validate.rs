//! One check for each invariant.

use sixfold_core::invariant_checks::{
    check_distinct_edges, check_fans, check_holes, check_walks_along_faces, fails,
};
use sixfold_core::{Editing, FaceId, HoleSet, InvariantError, MeshQuery, VertexId};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh, NO_HALF};

/// Checks the pairs of half-edges, then I9, then I1 to I8. Each check relies on the earlier checks.
pub(crate) fn validate<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    check_pairs(mesh)?;
    check_deleted(mesh)?;
    check_handles(mesh)?;
    check_edge_faces(mesh)?;
    check_permutation(mesh)?;
    check_cycle_faces(mesh)?;
    check_ends(mesh)?;
    check_leaving(mesh)?;
    let origins = halves(mesh).map(|h| mesh.origin(h));
    let walk = |v| mesh.leaving(v).count();
    check_fans("I6", mesh, "half-edges", origins, walk)?;
    check_faces(mesh)?;
    check_distinct_edges("I8", mesh)
}

fn halves<E: Editing>(mesh: &HalfEdgeMesh<E>) -> impl Iterator<Item = HalfEdgeId> {
    mesh.edges().flat_map(|e| mesh.edge_half_edges(e))
}

fn check_pairs<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    match mesh.half_edge_rows().len() {
        rows if rows.is_multiple_of(2) => Ok(()),
        rows => fails("I1", format!("{rows} half-edges, expected an even number")),
    }
}

/// Checks that exactly the deleted elements are marked as deleted.
fn check_deleted<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    let kinds = [
        (&mesh.vertex_holes, mesh.vertex_rows()),
        (&mesh.edge_holes, mesh.edge_rows()),
        (&mesh.face_holes, mesh.face_rows()),
    ];
    check_holes("I9", kinds)?;
    for (v, leaving) in mesh.leaving_rows().iter().enumerate() {
        if mesh.vertex_holes.has(v) && leaving.get().is_some() {
            return fails("I9", format!("v{v} is deleted, but {leaving:?} leaves it"));
        }
    }
    for (e, pair) in mesh.half_edge_rows().as_chunks::<2>().0.iter().enumerate() {
        let marked = pair.map(|half| half == Half::DELETED);
        if marked != [mesh.edge_holes.has(e); 2] {
            return fails(
                "I9",
                format!("edge holes and `halves` disagree on whether e{e} was deleted: {pair:?}"),
            );
        }
    }
    for (f, &first) in mesh.first_rows().iter().enumerate() {
        if (first == NO_HALF) != mesh.face_holes.has(f) {
            return fails(
                "I9",
                format!("face holes and `first` disagree on whether f{f} was deleted"),
            );
        }
    }
    Ok(())
}

/// Checks that every handle in the tables refers to an existing element. The later checks rely on
/// this check.
fn check_handles<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    let is_vertex = |v: VertexId| mesh.contains_vertex(v);
    let is_half = |h: HalfEdgeId| mesh.contains_edge(h.edge());
    let is_face = |f: FaceId| mesh.contains_face(f);
    for h in halves(mesh) {
        let half = mesh.half_edge_rows()[h.index()];
        if !is_half(half.next) || !is_vertex(half.origin) || !half.face.get().is_none_or(is_face) {
            return fails("I2", format!("{h} refers to a missing element: {half:?}"));
        }
    }
    let leaving = mesh.leaving_rows().iter().filter_map(|slot| slot.get());
    let along = mesh.faces().map(|f| mesh.face_half_edge(f));
    match leaving.chain(along).find(|&h| !is_half(h)) {
        Some(h) => fails("I5", format!("a row refers to {h}, which does not exist")),
        None => Ok(()),
    }
}

fn check_edge_faces<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    match halves(mesh).find(|&h| mesh.is_boundary(h) && mesh.is_boundary(h.twin())) {
        Some(h) => fails("I1", format!("{} has no face on either side", h.edge())),
        None => Ok(()),
    }
}

fn check_permutation<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    let mut reached = vec![false; mesh.half_edge_rows().len()];
    for h in halves(mesh) {
        let next = mesh.next(h);
        if std::mem::replace(&mut reached[next.index()], true) {
            return fails("I2", format!("two half-edges have the same next {next}"));
        }
    }
    Ok(())
}

fn check_cycle_faces<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    match halves(mesh).find(|&h| mesh.face(mesh.next(h)) != mesh.face(h)) {
        Some(h) => fails(
            "I3",
            format!("{h} and its next {} have different faces", mesh.next(h)),
        ),
        None => Ok(()),
    }
}

fn check_ends<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    match halves(mesh).find(|&h| mesh.origin(mesh.next(h)) != mesh.target(h)) {
        Some(h) => fails("I4", format!("{h} does not end where its next starts")),
        None => Ok(()),
    }
}

fn check_leaving<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    for h in halves(mesh) {
        let v = mesh.origin(h);
        let Some(leaving) = mesh.vertex_half_edge(v) else {
            return fails(
                "I5",
                format!("{h} starts at {v}, which has no leaving half-edge"),
            );
        };
        if mesh.origin(leaving) != v {
            return fails("I5", format!("{leaving} does not leave {v}"));
        }
        if mesh.is_boundary(h) && !mesh.is_boundary(leaving) {
            return fails(
                "I5",
                format!("{v} is on a boundary, but {leaving} has a face"),
            );
        }
    }
    for v in mesh.vertices() {
        if let Some(h) = mesh.vertex_half_edge(v).filter(|&h| mesh.origin(h) != v) {
            return fails("I5", format!("{h} does not leave {v}"));
        }
    }
    Ok(())
}

fn check_faces<E: Editing>(mesh: &HalfEdgeMesh<E>) -> Result<(), InvariantError> {
    for f in mesh.faces() {
        let h = mesh.face_half_edge(f);
        if mesh.face(h) != Some(f) {
            return fails("I7", format!("{h} does not run along {f}"));
        }
    }
    let with_face = halves(mesh).filter(|&h| !mesh.is_boundary(h)).count();
    check_walks_along_faces("I7", mesh, with_face)
}

#[cfg(test)]
mod tests {
    use sixfold_core::{Point, PolygonMesh, Representation, Slot};

    use super::*;
    use crate::EditableHalfEdgeMesh;

    fn sound() -> EditableHalfEdgeMesh {
        let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y, Point::Z];
        let polygons = PolygonMesh::new(corners, [[0, 1, 2], [0, 2, 3]]).expect("valid");
        EditableHalfEdgeMesh::from_polygons(&polygons).expect("manifold")
    }

    /// Returns the invariant that fails after `break_it`.
    fn broken(break_it: impl Fn(&mut EditableHalfEdgeMesh)) -> &'static str {
        let mut mesh = sound();
        assert_eq!(mesh.validate(), Ok(()));
        break_it(&mut mesh);
        mesh.validate().expect_err("the mesh is broken").invariant
    }

    fn h(row: u32) -> HalfEdgeId {
        HalfEdgeId::new(row)
    }

    #[test]
    fn each_broken_invariant_is_named() {
        let mesh = sound();
        let inner = mesh.face_half_edge(FaceId::new(0));
        let outer = halves(&mesh).find(|&h| mesh.is_boundary(h)).expect("open");
        let (i, o) = (inner.index(), outer.index());
        assert_eq!(broken(|m| m.halves.rows_mut()[i].next = h(99)), "I2");
        assert_eq!(
            broken(|m| m.halves.rows_mut()[i].origin = VertexId::new(99)),
            "I2"
        );
        assert_eq!(
            broken(|m| m.leaving.rows_mut()[0] = Slot::some(h(99))),
            "I5"
        );
        assert_eq!(broken(|m| m.first.rows_mut()[0] = h(99)), "I5");
        assert_eq!(
            broken(|m| m.halves.rows_mut()[o ^ 1].face = Slot::NONE),
            "I1"
        );
        assert_eq!(broken(|m| m.halves.rows_mut()[i].next = inner), "I2");
        assert_eq!(
            broken(|m| m.halves.rows_mut()[i].face = Slot::some(FaceId::new(1))),
            "I3"
        );
        assert_eq!(
            broken(|m| m.halves.rows_mut()[i].origin = VertexId::new(4)),
            "I4"
        );
        assert_eq!(broken(|m| m.leaving.rows_mut()[1] = Slot::NONE), "I5");
        assert_eq!(
            broken(|m| m.leaving.rows_mut()[1] = m.leaving.rows()[2]),
            "I5"
        );
        assert_eq!(
            broken(|m| m.leaving.rows_mut()[4] = m.leaving.rows()[2]),
            "I5"
        );
        let along = |m: &EditableHalfEdgeMesh, f| m.face_half_edge(FaceId::new(f));
        assert_eq!(broken(|m| m.first.rows_mut()[0] = along(m, 1)), "I7");
        assert_eq!(broken(|m| m.vertex_holes.insert(0)), "I9");
        assert_eq!(broken(|m| m.vertex_holes.insert(5)), "I9");
        assert_eq!(broken(|m| m.edge_holes.insert(0)), "I9");
        assert_eq!(broken(|m| m.face_holes.insert(1)), "I9");
        assert_eq!(broken(|m| m.first.rows_mut()[1] = NO_HALF), "I9");
        assert_eq!(broken(|m| m.halves.rows_mut()[o] = Half::DELETED), "I9");
    }

    #[test]
    fn a_reference_to_a_deleted_element_is_found() {
        let mut mesh = sound();
        mesh.vertex_holes.insert(4);
        assert_eq!(mesh.validate(), Ok(()), "an isolated vertex is deleted");
        let i = mesh.face_half_edge(FaceId::new(0)).index();
        for (name, broken) in [
            (
                "I2",
                Half {
                    origin: VertexId::new(4),
                    ..mesh.halves.rows()[i]
                },
            ),
            (
                "I2",
                Half {
                    face: Slot::some(FaceId::new(2)),
                    ..mesh.halves.rows()[i]
                },
            ),
        ] {
            let mut mesh = mesh.clone();
            mesh.halves.rows_mut()[i] = broken;
            assert_eq!(mesh.validate().expect_err("broken").invariant, name);
        }
    }

    #[test]
    fn a_vertex_with_two_fans_is_found() {
        // Two separate triangles; then a vertex of one triangle replaces a vertex of the other.
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(Point::splat);
        let polygons = PolygonMesh::new(corners, [[0, 1, 2], [3, 4, 5]]).expect("valid");
        let mut mesh = EditableHalfEdgeMesh::from_polygons(&polygons).expect("manifold");
        for half in mesh.halves.rows_mut() {
            if half.origin == VertexId::new(5) {
                half.origin = VertexId::new(0);
            }
        }
        mesh.leaving.rows_mut()[5] = Slot::NONE;
        assert_eq!(mesh.validate().expect_err("two fans").invariant, "I6");
    }

    #[test]
    fn edges_with_the_same_ends_are_found() {
        // The third corners of two triangles along one edge become one vertex. The other edges of
        // the triangles then have the same ends.
        let corners = [0.0, 1.0, 2.0, 3.0].map(Point::splat);
        let faces = [[0, 1, 2], [1, 0, 3]];
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        let mut mesh = EditableHalfEdgeMesh::from_polygons(&polygons).expect("manifold");
        for half in mesh.halves.rows_mut() {
            if half.origin == VertexId::new(3) {
                half.origin = VertexId::new(2);
            }
        }
        mesh.leaving.rows_mut()[3] = Slot::NONE;
        let broken = mesh
            .validate()
            .expect_err("v2 has two fans and two edges to each end");
        assert!(["I6", "I8"].contains(&broken.invariant), "{broken}");
        assert_eq!(
            check_distinct_edges("I8", &mesh)
                .expect_err("two pairs of equal edges")
                .invariant,
            "I8"
        );
    }
}

//! One check for each invariant.

use sixfold_core::invariant_checks::{
    check_corners_of_face, check_distinct_edges, check_fans, check_holes, fails,
};
use sixfold_core::{Editing, HoleSet, InvariantError, MeshQuery, Slot, VertexId, row};

use crate::mesh::{CornerId, CornerTable, NO_VERTEX};

/// Checks the lengths of the tables, the holes, and I1 to I7. Later checks rely on earlier checks.
pub(crate) fn validate<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    check_table_lengths(mesh)?;
    check_deleted(mesh)?;
    mesh.faces().try_for_each(|t| {
        check_corners_of_face("I1", t, &mesh.vertices_of(t), |v| mesh.contains_vertex(v))
    })?;
    check_opposites(mesh)?;
    check_sides(mesh)?;
    check_vertex_corners(mesh)?;
    check_first_corners(mesh)?;
    let vertices = corners(mesh).map(|c| mesh.vertex(c));
    let walk = |v| mesh.corners_at(v).count();
    check_fans("I6", mesh, "corners", vertices, walk)?;
    check_distinct_edges("I7", mesh)
}

fn corners<E: Editing>(mesh: &CornerTable<E>) -> impl Iterator<Item = CornerId> {
    mesh.faces().flat_map(|t| mesh.corners_of(t))
}

fn check_table_lengths<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    let (corners, opposites) = (mesh.corner_vertices().len(), mesh.opposite_corners().len());
    if !corners.is_multiple_of(3) || opposites != corners {
        let detail =
            format!("`vertex` has {corners} rows, `opposite` has {opposites} rows: not 3 per face");
        return fails("I1", detail);
    }
    if mesh.vertex_corners().len() != mesh.positions().len() {
        return fails("I1", "`corner` and `positions` differ in length".into());
    }
    Ok(())
}

fn check_deleted<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    let kinds = [
        (&mesh.vertex_holes, mesh.vertex_rows()),
        (&mesh.face_holes, mesh.face_rows()),
    ];
    check_holes("I8", kinds)?;
    for c in (0..row(mesh.corner_vertices().len())).map(CornerId::new) {
        let deleted = mesh.face_holes.has(c.triangle().index());
        let marks = [mesh.vertex(c) == NO_VERTEX, mesh.opposite(c) == Some(c)];
        if marks != [deleted; 2] {
            return fails(
                "I8",
                format!("the rows of {c} and `face_holes` disagree on whether {c} was deleted"),
            );
        }
    }
    for v in (0..row(mesh.positions().len())).map(VertexId::new) {
        if mesh.vertex_holes.has(v.index()) && mesh.vertex_corners()[v.index()] != Slot::NONE {
            return fails("I8", format!("{v} was deleted but has a corner"));
        }
    }
    Ok(())
}

fn check_opposites<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    for c in corners(mesh) {
        if let Some(across) = mesh.opposite(c) {
            if across.index() >= mesh.corner_vertices().len() {
                return fails("I2", format!("{across}, opposite to {c}, does not exist"));
            }
            if mesh.opposite(across) != Some(c) {
                return fails(
                    "I2",
                    format!("{across} is opposite to {c}, but {c} is not opposite to {across}"),
                );
            }
        }
    }
    Ok(())
}

fn check_sides<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    for c in corners(mesh) {
        if let Some(across) = mesh.opposite(c) {
            let here = [c.next(), c.prev()].map(|c| mesh.vertex(c));
            let there = [across.prev(), across.next()].map(|c| mesh.vertex(c));
            if here != there {
                let detail =
                    format!("{c} faces {here:?}, but its opposite {across} faces {there:?}");
                return fails("I3", detail);
            }
        }
    }
    Ok(())
}

fn check_vertex_corners<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    let mut used = vec![false; mesh.positions().len()];
    for c in corners(mesh) {
        used[mesh.vertex(c).index()] = true;
    }
    for v in mesh.vertices() {
        let Some(c) = mesh.corner_at(v) else {
            if used[v.index()] {
                return fails("I4", format!("{v} is in a triangle but has no corner"));
            }
            continue;
        };
        if c.index() >= mesh.corner_vertices().len() || mesh.vertex(c) != v {
            return fails("I4", format!("{c} is not a corner at {v}"));
        }
    }
    Ok(())
}

fn check_first_corners<E: Editing>(mesh: &CornerTable<E>) -> Result<(), InvariantError> {
    for c in corners(mesh).filter(|&c| mesh.unswing(c).is_none()) {
        let v = mesh.vertex(c);
        let entered = mesh.corner_at(v).and_then(|first| mesh.unswing(first));
        if let Some(before) = entered {
            let detail = format!("the fan of {v} starts at {c}, but corner({v}) follows {before}");
            return fails("I5", detail);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use sixfold_core::{Point, PolygonMesh, Representation, Table};

    use super::*;
    use crate::EditableCornerTable;

    fn table<const N: usize>(vertices: u16, triangles: [[u32; 3]; N]) -> EditableCornerTable {
        let positions: Vec<_> = (0..vertices).map(|i| Point::splat(i.into())).collect();
        let polygons = PolygonMesh::new(positions, triangles).expect("valid");
        let mesh = EditableCornerTable::from_polygons(&polygons).expect("manifold");
        assert_eq!(mesh.validate(), Ok(()));
        mesh
    }

    /// Returns the invariant that fails after `break_it`. The mesh has a fan of two triangles
    /// around v0 (corners 0 and 3; corners 1 and 5 are opposite) and an isolated v4.
    fn broken(break_it: impl Fn(&mut EditableCornerTable)) -> &'static str {
        let mut mesh = table(5, [[0, 1, 2], [0, 2, 3]]);
        break_it(&mut mesh);
        mesh.validate().expect_err("the mesh is broken").invariant
    }

    fn c(row: u32) -> Slot<CornerId> {
        Slot::some(CornerId::new(row))
    }

    #[test]
    fn each_broken_invariant_is_named() {
        let v = VertexId::new;
        // A table that is too short, a missing vertex, a repeated vertex.
        let short = |m: &EditableCornerTable| m.corner_vertices()[..4].to_vec();
        assert_eq!(
            broken(|m| m.vertex = Table::new("vertex", "corner", short(m))),
            "I1"
        );
        assert_eq!(
            broken(|m| m.corner = Table::new("corner", "vertex", vec![c(0)])),
            "I1"
        );
        assert_eq!(broken(|m| m.vertex.rows_mut()[1] = v(99)), "I1");
        assert_eq!(broken(|m| m.vertex.rows_mut()[1] = v(2)), "I1");
        // A missing opposite, an opposite without the reverse link, a link to the wrong corner.
        assert_eq!(broken(|m| m.opposite.rows_mut()[1] = c(99)), "I2");
        assert_eq!(broken(|m| m.opposite.rows_mut()[5] = Slot::NONE), "I2");
        assert_eq!(broken(|m| m.opposite.rows_mut()[0] = c(1)), "I2");
        // Two different edges, then one edge in the same direction.
        assert_eq!(broken(|m| m.vertex.rows_mut()[3] = v(1)), "I3");
        assert_eq!(broken(|m| m.vertex.rows_mut().swap(3, 4)), "I3");
        // A missing corner, a corner at another vertex, no corner, a corner of an isolated vertex.
        assert_eq!(broken(|m| m.corner.rows_mut()[0] = c(99)), "I4");
        assert_eq!(broken(|m| m.corner.rows_mut()[0] = c(1)), "I4");
        assert_eq!(broken(|m| m.corner.rows_mut()[0] = Slot::NONE), "I4");
        assert_eq!(broken(|m| m.corner.rows_mut()[4] = c(0)), "I4");
        // corner(v0) is the second corner of its fan.
        assert_eq!(broken(|m| m.corner.rows_mut()[0] = c(3)), "I5");
        // Holes without marks, marks without a hole, a deleted vertex with a corner, a deleted
        // vertex in a face.
        assert_eq!(broken(|m| m.face_holes.insert(0)), "I8");
        assert_eq!(broken(|m| m.face_holes.insert(2)), "I8");
        assert_eq!(broken(|m| m.vertex.rows_mut()[2] = NO_VERTEX), "I8");
        assert_eq!(broken(|m| m.opposite.rows_mut()[2] = c(2)), "I8");
        assert_eq!(broken(|m| m.vertex_holes.insert(1)), "I8");
        let orphan = |m: &mut EditableCornerTable| {
            m.vertex_holes.insert(1);
            m.corner.rows_mut()[1] = Slot::NONE;
        };
        assert_eq!(broken(orphan), "I1");
    }

    #[test]
    fn a_vertex_with_two_fans_is_reported() {
        // Two separate triangles; then a vertex of one triangle replaces a vertex of the other.
        let mut mesh = table(6, [[0, 1, 2], [3, 4, 5]]);
        mesh.vertex.rows_mut()[5] = VertexId::new(0);
        mesh.corner.rows_mut()[5] = Slot::NONE;
        assert_eq!(mesh.validate().expect_err("two fans").invariant, "I6");
    }

    #[test]
    fn edges_with_the_same_ends_are_reported() {
        // A tetrahedron, cut open along two edges without a common end, becomes a band. Two edges
        // of each rim have the same ends.
        let mut mesh = table(4, [[0, 1, 2], [1, 3, 2], [1, 0, 3], [0, 2, 3]]);
        let cut = corners(&mesh).filter(|&c| {
            let ends = [c.next(), c.prev()].map(|c| mesh.vertex(c).index());
            matches!(ends, [0, 1] | [1, 0] | [2, 3] | [3, 2])
        });
        let cut: Vec<CornerId> = cut.collect();
        assert_eq!(cut.len(), 4);
        for c in cut {
            mesh.opposite.rows_mut()[c.index()] = Slot::NONE;
            let start = mesh.vertex(c.next());
            mesh.corner.rows_mut()[start.index()] = Slot::some(c.next());
        }
        assert_eq!(mesh.validate().expect_err("doubled edges").invariant, "I7");
    }
}

//! Edits at a face, for measurements.

use std::convert::Infallible;

use crate::Point;
use crate::edit::edit_call::{EditArguments, EditCall, EditOf};
use crate::edit::edit_kind::Edit;
use crate::edit::mesh_edit::{MeshEdit, Refusal};

/// Returns an edit of the given kind at the face `f`. `corners` are the corners of `f` in order, and a
/// new or moved vertex is at `at`. Prepares the mesh, so that the edit is possible: before `add_face` and
/// `compact`, removes `f`; before `split_face`, dissolves the edge of the first two corners.
///
/// # Errors
///
/// Returns the error of the preparation.
///
/// # Panics
///
/// Panics if the first two of `corners` are not the ends of a side of `f`.
pub fn edit_at_face<M: MeshEdit>(
    mesh: &mut M,
    edit: Edit,
    f: M::Face,
    corners: &[M::Vertex],
    at: Point,
) -> Result<EditOf<M>, Refusal<M>> {
    let mut face = f;
    match edit {
        Edit::AddFace | Edit::Compact => mesh.remove_face(f)?,
        Edit::SplitFace => {
            let e = mesh.edge_between(corners[0], corners[1]);
            face = mesh.dissolve_edge(e.expect("a side of the face"))?;
        }
        _ => {}
    }
    let mut arguments = AtFace {
        mesh,
        face,
        corners,
        at,
        has_left: false,
    };
    let Ok(call) = EditCall::with_arguments(edit, &mut arguments);
    Ok(call)
}

/// The arguments of edits at a face: its first corner, and the edge to the second one.
struct AtFace<'m, M: MeshEdit> {
    mesh: &'m M,
    face: M::Face,
    corners: &'m [M::Vertex],
    at: Point,
    /// True after the left neighbour was asked for.
    has_left: bool,
}

impl<M: MeshEdit> EditArguments for AtFace<'_, M> {
    type Vertex = M::Vertex;
    type Edge = M::Edge;
    type Face = M::Face;
    type Position = Point;
    type Error = Infallible;

    fn vertex(&mut self) -> Result<M::Vertex, Infallible> {
        Ok(self.corners[0])
    }

    /// Returns the second corner, then a neighbour of the first corner that is not a corner.
    fn vertex_if_any(&mut self) -> Result<Option<M::Vertex>, Infallible> {
        if !std::mem::replace(&mut self.has_left, true) {
            return Ok(Some(self.corners[1]));
        }
        let mut around = self.mesh.vertex_vertices(self.corners[0]);
        Ok(around.find(|v| !self.corners.contains(v)))
    }

    fn vertices(&mut self) -> Result<Vec<M::Vertex>, Infallible> {
        Ok(self.corners.to_vec())
    }

    fn corners(&mut self) -> Result<[M::Vertex; 2], Infallible> {
        Ok([self.corners[0], self.corners[1]])
    }

    fn edge(&mut self) -> Result<M::Edge, Infallible> {
        let edge = self.mesh.edge_between(self.corners[0], self.corners[1]);
        Ok(edge.expect("a side of the face"))
    }

    fn face(&mut self) -> Result<M::Face, Infallible> {
        Ok(self.face)
    }

    fn faces(&mut self) -> Result<Vec<M::Face>, Infallible> {
        Ok(vec![self.face])
    }

    fn position(&mut self) -> Result<Point, Infallible> {
        Ok(self.at)
    }

    fn new_position(&mut self) -> Result<Point, Infallible> {
        Ok(self.at)
    }
}

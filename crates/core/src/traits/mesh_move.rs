//! The trait of meshes whose vertices can move.

use crate::Point;
use crate::edit::edit_log::EditLog;
use crate::handles::handle::RowMap;
use crate::handles::row_id::VertexId;
use crate::polygons::error::MoveError;
use crate::tables::probe::Probe;
use crate::tables::table::Table;
use crate::traits::query::{MeshQuery, VertexMap};

/// A mesh whose vertices can move, all at once. Every structure implements this trait, and so does
/// [`MeshWithData`](crate::MeshWithData).
///
/// Connectivity does not change, so compact meshes can move their vertices, too. To move a single
/// vertex, use [`MeshEdit::set_position`](crate::MeshEdit::set_position).
///
/// # Examples
///
/// ```
/// use sixfold_core::{MeshMove, MoveError, Point};
///
/// /// Moves every vertex to the mean of its neighbours. Isolated vertices stay.
/// fn smooth<M: MeshMove>(mesh: &mut M) -> Result<(), MoveError> {
///     let mut moved = mesh.vertex_map(Point::ZERO);
///     for v in mesh.vertices() {
///         let neighbours = mesh.vertex_vertices(v).map(|w| mesh.position(w));
///         let (sum, count) = neighbours.fold((Point::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
///         moved[v] = if count > 0.0 { sum / count } else { mesh.position(v) };
///     }
///     mesh.set_positions(&moved)
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "the vertices of `{Self}` cannot be moved",
    label = "this type does not implement `MeshMove`",
    note = "a function that only gets `M: MeshQuery` reads the mesh: ask for `M: MeshMove`, or for \
            `M: MeshEdit`, which includes it"
)]
pub trait MeshMove: MeshQuery + Sized {
    /// Moves every vertex to its position in `positions`; O(vertices), or O(corners) if vertices
    /// are identified by coordinates.
    ///
    /// If vertices are identified by coordinates, their handles change, and vertices that move to
    /// the same position become one vertex.
    ///
    /// # Errors
    ///
    /// Returns [`MoveError::OtherMesh`] if the number of positions differs from the number of
    /// vertices. A structure that identifies vertices by coordinates returns
    /// [`MoveError::CoincidentCorners`] if two corners of a face would have the same position.
    /// After an error, every vertex has its old position.
    fn set_positions(&mut self, positions: &VertexMap<Self, Point>) -> Result<(), MoveError> {
        self.set_positions_logged(positions, &mut ())
    }

    /// Moves every vertex like [`set_positions`](Self::set_positions), and reports the elements whose
    /// handles change. If handles are row numbers, no handle changes.
    ///
    /// If vertices are identified by coordinates and several vertices or edges become one, the first
    /// of them in the order of [`vertices`](MeshQuery::vertices) or [`edges`](MeshQuery::edges)
    /// remains, and the others are reported as removed. The report takes O(corners) expected time.
    ///
    /// # Errors
    ///
    /// Fails like [`set_positions`](Self::set_positions), and then reports nothing.
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError>;
}

impl<P: Probe> Table<Point, P> {
    /// Moves every vertex to its position in `positions`; O(vertices). The probe does not record
    /// the change. Structures with a table of positions implement
    /// [`MeshMove::set_positions`](crate::MeshMove::set_positions) by this method.
    ///
    /// # Errors
    ///
    /// [`MoveError::OtherMesh`] if the number of positions differs from the number of rows.
    pub fn set_positions(&mut self, positions: &RowMap<VertexId, Point>) -> Result<(), MoveError> {
        let (given, vertices) = (positions.values().len(), self.len());
        if given != vertices {
            return Err(MoveError::OtherMesh { given, vertices });
        }
        self.rows_mut().copy_from_slice(positions.values());
        Ok(())
    }
}

//! Methods that are equal on all structures whose vertices, edges or faces are rows of a table.

/// Implements the listing, the number, the existence check and the number of rows of one kind of
/// element; [`vertex_rows!`](crate::vertex_rows) describes the arguments.
#[doc(hidden)]
#[macro_export]
macro_rules! element_rows {
    (
        $handle:ident $list:ident $count:ident $contains:ident $row_count:ident
        $(#[$inline:meta])? $mesh:ident, $rows:expr, $holes:expr
    ) => {
        #[inline]
        fn $list(&$mesh) -> impl Iterator<Item = $crate::$handle> {
            $crate::HoleSet::handles(&$holes, $mesh.$row_count())
        }

        $(#[$inline])?
        fn $count(&$mesh) -> usize {
            $mesh.$row_count() - $crate::HoleSet::len(&$holes)
        }

        #[inline]
        fn $contains(&$mesh, handle: $crate::$handle) -> bool {
            $crate::HoleSet::contains(&$holes, handle, $mesh.$row_count())
        }

        $(#[$inline])?
        fn $row_count(&$mesh) -> usize {
            $rows
        }
    };
}

/// Implements the methods of [`MeshQuery`](crate::MeshQuery) that need only the rows of vertices and
/// the holes among these rows: `vertices`, `vertex_count`, `contains_vertex` and `vertex_rows`.
///
/// Call it in the `impl` of the trait, with `self`, the number of rows, and the holes:
///
/// ```text
/// sixfold_core::vertex_rows!(self, self.positions.len(), self.vertex_holes);
/// ```
///
/// With `#[inline]` before `self`, the two methods that return numbers are also inlined. The macros
/// [`edge_rows!`](crate::edge_rows) and [`face_rows!`](crate::face_rows) do the same for edges and
/// faces.
#[macro_export]
macro_rules! vertex_rows {
    ($($arguments:tt)+) => {
        $crate::element_rows!(
            VertexId vertices vertex_count contains_vertex vertex_rows $($arguments)+
        );
    };
}

/// Implements the same methods as [`vertex_rows!`](crate::vertex_rows), for edges.
#[macro_export]
macro_rules! edge_rows {
    ($($arguments:tt)+) => {
        $crate::element_rows!(EdgeId edges edge_count contains_edge edge_rows $($arguments)+);
    };
}

/// Implements the same methods as [`vertex_rows!`](crate::vertex_rows), for faces.
#[macro_export]
macro_rules! face_rows {
    ($($arguments:tt)+) => {
        $crate::element_rows!(FaceId faces face_count contains_face face_rows $($arguments)+);
    };
}

/// Implements `vertex_handle` and `face_handle` of [`Representation`](crate::Representation) for a
/// structure whose vertices and faces have the numbers of the polygon mesh. Call it in the `impl`
/// of the trait.
#[macro_export]
macro_rules! row_handles {
    () => {
        fn vertex_handle(_: &$crate::PolygonMesh, v: $crate::VertexId) -> $crate::VertexId {
            v
        }

        fn face_handle(_: &$crate::PolygonMesh, f: $crate::FaceId) -> $crate::FaceId {
            f
        }
    };
}

/// Implements [`MeshMove`](crate::MeshMove) for a structure that has its vertices in a table
/// `positions`.
#[macro_export]
macro_rules! moving_positions {
    ($mesh:ident) => {
        impl<E: $crate::Editing, P: $crate::Probe> $crate::MeshMove for $mesh<E, P> {
            fn set_positions_logged(
                &mut self,
                positions: &$crate::VertexMap<Self, $crate::Point>,
                _: &mut impl $crate::EditLog<Self>,
            ) -> Result<(), $crate::MoveError> {
                self.positions.set_positions(positions)
            }
        }
    };
}

/// Implements `type_path` of [`Representation`](crate::Representation) for a structure with the
/// parameter `E: Editing`. Call it in the `impl` of the trait. The crate exports the compact mesh as
/// `$mesh`, and the editable mesh with `Editable` before this name.
#[doc(hidden)]
#[macro_export]
macro_rules! type_path {
    ($mesh:ident) => {
        fn type_path() -> &'static str {
            match E::CAN_DELETE {
                true => concat!(env!("CARGO_CRATE_NAME"), "::Editable", stringify!($mesh)),
                false => concat!(env!("CARGO_CRATE_NAME"), "::", stringify!($mesh)),
            }
        }
    };
}

//! The edit trait: changing a mesh in place.

use crate::Point;
use crate::edit_error::EditError;
use crate::edit_kind::Edit;
use crate::edit_log::{EditLog, OldToNew};
use crate::query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
use crate::representation::QueryCost;

/// The error of an edit that `M` refused.
pub type Refusal<M> =
    EditError<<M as MeshQuery>::Vertex, <M as MeshQuery>::Edge, <M as MeshQuery>::Face>;

/// Declares the short form and the logged form of each edit.
macro_rules! edits {
    ($(
        $(#[$documentation:meta])*
        fn $edit:ident, $logged:ident($($argument:ident: $kind:ty),+ $(,)?) -> $outcome:ty;
    )+) => {$(
        $(#[$documentation])*
        #[inline]
        fn $edit(&mut self, $($argument: $kind),+) -> $outcome {
            self.$logged($($argument,)+ &mut ())
        }

        #[doc = concat!("Does [`", stringify!($edit), "`](Self::", stringify!($edit), "), and reports")]
        /// all changes to `log`.
        ///
        /// # Errors
        ///
        #[doc = concat!("The same as for [`", stringify!($edit), "`](Self::", stringify!($edit), ").")]
        fn $logged(&mut self, $($argument: $kind,)+ log: &mut impl EditLog<Self>) -> $outcome;
    )+};
}

/// A structure whose mesh can be edited in place.
///
/// # Contract
///
/// - **All or nothing.** A refused edit leaves every table unchanged. An edit with an invalid
///   handle is refused; it does not panic.
/// - **Legality.** An edit is legal if it satisfies its rule below and the structure can hold the
///   resulting mesh ([`Capabilities`](crate::Capabilities)). For example, structures that can hold
///   non-manifold meshes accept edits that make a mesh non-manifold.
/// - **Handles.** Elements that an edit does not touch keep their handles. In some structures, a
///   handle is not a row of its own: it is a pair of ends, coordinates, or the corner opposite an
///   edge. An edit may rename such an element, which means that the handle of the element changes.
///   The edit reports every created, removed or renamed element to the [`EditLog`].
/// - **Holes.** Counts, iterations, relations and conversions do not contain removed elements. The
///   row of a removed element becomes a hole. A query with the handle of a hole panics. No row is
///   reused until [`compact`](Self::compact) closes the holes. If the handle of a removed element
///   is a pair or coordinates, its relations are empty, and a later edit may create an element with
///   the same handle.
/// - **In place.** An edit does not convert or rebuild the mesh. [`EDITS`](Self::EDITS) states how
///   much of the mesh an edit reads.
///
/// # Two forms
///
/// Every edit has a short form, such as [`flip_edge`](Self::flip_edge), and a logged form, such as
/// [`flip_edge_logged`](Self::flip_edge_logged). The logged form reports all created, removed and
/// renamed elements to a log. The short form reports nothing. [`EditLog`] describes when to use
/// which form. In a [`MeshWithData`](crate::MeshWithData), data by vertex, edge or face follows all
/// edits, in both forms.
///
/// ```
/// # use sixfold_core::{MeshEdit, Point, Refusal};
/// /// Puts a vertex into the middle of `e` and returns it.
/// fn bisect<M: MeshEdit>(mesh: &mut M, e: M::Edge) -> Result<M::Vertex, Refusal<M>> {
///     let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
///     mesh.bisect_edge(e, (a + b) / 2.0)
/// }
/// ```
pub trait MeshEdit: MeshQuery + Sized {
    /// How much of the mesh each edit reads, in the order of [`Edit::ALL`]; `None` if the structure
    /// does not support the edit.
    const EDITS: [Option<QueryCost>; Edit::ALL.len()];

    /// The same structure without deleted rows: its type parameter is [`Compact`](crate::Compact).
    /// Its queries need no check for deleted rows.
    type Compact: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Closes all holes and converts to a mesh that cannot have holes; O(mesh) if there are holes.
    /// Handles change as in [`compact`](Self::compact), but the changes are not reported. If you
    /// need the new handles, call [`compact_with_map`](Self::compact_with_map) first.
    fn into_compact(self) -> Self::Compact;

    /// Converts a compact mesh to one that can be edited; O(1). Handles stay the same.
    fn from_compact(compact: Self::Compact) -> Self;

    edits! {
        /// Moves `v` to `to`; returns the handle of the vertex afterwards.
        ///
        /// # Errors
        ///
        /// [`EditError::Occupied`] if vertices are identified by coordinates and another vertex is
        /// at `to`.
        fn set_position, set_position_logged(
            v: Self::Vertex, to: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Adds a vertex without a face.
        ///
        /// # Errors
        ///
        /// [`EditError::Unsupported`] if the structure cannot hold a vertex without a face.
        fn add_vertex, add_vertex_logged(at: Point) -> Result<Self::Vertex, Refusal<Self>>;

        /// Adds a face with these `corners`. The corners must be existing vertices, unless vertices
        /// are identified by coordinates.
        ///
        /// # Errors
        ///
        /// Refuses fewer than three corners, a repeated corner, and a polygon if only triangles are
        /// allowed. If only manifolds are allowed, also refuses these cases: a face already runs
        /// along a side in the same direction; an edge already has two faces; the faces at a corner
        /// would form more than one fan.
        fn add_face, add_face_logged(corners: &[Self::Vertex]) -> Result<Self::Face, Refusal<Self>>;

        /// Removes `f`, and the edges that no other face has. The corners of `f` stay, even if they
        /// become isolated. If vertices are identified by coordinates, corners without a face are
        /// removed.
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the remaining faces at a corner would form more than one
        /// fan.
        fn remove_face, remove_face_logged(f: Self::Face) -> Result<(), Refusal<Self>>;

        /// Removes `v` and all its faces in one edit. The faces are removed as by
        /// [`remove_face`](Self::remove_face).
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the remaining faces at another vertex would form more than
        /// one fan.
        fn remove_vertex, remove_vertex_logged(v: Self::Vertex) -> Result<(), Refusal<Self>>;
    }

    /// Removes all vertices without a face; returns their number.
    #[inline]
    fn remove_isolated_vertices(&mut self) -> usize {
        self.remove_isolated_vertices_logged(&mut ())
    }

    /// Does [`remove_isolated_vertices`](Self::remove_isolated_vertices), and reports all changes to
    /// `log`.
    fn remove_isolated_vertices_logged(&mut self, log: &mut impl EditLog<Self>) -> usize;

    edits! {
        /// Inserts a vertex at `at` into `e`. The degree of each face of `e` grows by one.
        ///
        /// # Errors
        ///
        /// [`EditError::Unsupported`] if only triangles are allowed; [`EditError::Occupied`] if
        /// vertices are identified by coordinates and another vertex is at `at`.
        fn split_edge, split_edge_logged(
            e: Self::Edge, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Inserts a vertex at `at` into `e`, and cuts each triangle of `e` in two at this vertex.
        /// This is the edge split of remeshing and of longest-edge bisection (Rivara 1984).
        ///
        /// ```text
        ///      c            c
        ///     ╱ ╲          ╱│╲
        ///    a───b   →    a─m─b
        ///     ╲ ╱          ╲│╱
        ///      d            d
        /// ```
        ///
        /// # Errors
        ///
        /// [`EditError::NotATriangle`] if a face of `e` is not a triangle; [`EditError::SameApex`]
        /// if only manifold edges are allowed and both triangles have the same third corner;
        /// [`EditError::Occupied`] if vertices are identified by coordinates and another vertex is
        /// at `at`.
        fn bisect_edge, bisect_edge_logged(
            e: Self::Edge, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Cuts `f` into one triangle per side, around a new vertex at `at`; `f` becomes one of the
        /// triangles.
        ///
        /// # Errors
        ///
        /// [`EditError::Occupied`] if vertices are identified by coordinates and another vertex is
        /// at `at`.
        fn poke_face, poke_face_logged(
            f: Self::Face, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Cuts `f` in two by an edge between two of its corners; `f` becomes one of the parts.
        ///
        /// # Errors
        ///
        /// Refuses `ends` that are not corners of `f`, are equal, or are adjacent in `f`.
        /// [`EditError::EdgeExists`] if only manifold edges are allowed and the two vertices
        /// already have an edge; [`EditError::Unsupported`] if only triangles are allowed.
        fn split_face, split_face_logged(
            f: Self::Face, ends: [Self::Vertex; 2],
        ) -> Result<Self::Edge, Refusal<Self>>;

        /// Removes `e` and merges its two faces; returns the face that stays. This is the inverse
        /// of [`split_face`](Self::split_face).
        ///
        /// # Errors
        ///
        /// Refuses an edge that does not have exactly two faces. Also refuses faces that run along
        /// `e` in the same direction, or that share a vertex other than the ends of `e`.
        /// [`EditError::Unsupported`] if only triangles are allowed.
        fn dissolve_edge, dissolve_edge_logged(e: Self::Edge) -> Result<Self::Face, Refusal<Self>>;

        /// Flips `e` within the quad of its two triangles; returns the handle of the edge
        /// afterwards. Each face keeps its handle. Each face also keeps one old end of `e`: the
        /// start of its side along `e`.
        ///
        /// ```text
        ///      c            c
        ///     ╱ ╲          ╱│╲
        ///    a───b   →    a │ b
        ///     ╲ ╱          ╲│╱
        ///      d            d
        /// ```
        ///
        /// # Errors
        ///
        /// Refuses these cases: `e` does not have exactly two faces; the faces run along `e` in the
        /// same direction; a face is not a triangle; the two triangles have the same third corner;
        /// the third corners already have an edge. [`EditError::LowValence`] if an end of `e` has
        /// only three edges and three faces.
        fn flip_edge, flip_edge_logged(e: Self::Edge) -> Result<Self::Edge, Refusal<Self>>;

        /// Merges the two ends of `e` into `keep`, and moves `keep` to `to`. Returns the handle of
        /// this vertex after the edit. Triangles along `e` are removed, and other faces along `e`
        /// lose a corner. The other two edges of a removed triangle become one edge: the edge at
        /// `keep` stays.
        ///
        /// ```text
        ///      c            c
        ///     ╱ ╲           │
        ///    k───g   →      k
        ///     ╲ ╱           │
        ///      d            d
        /// ```
        ///
        /// # Errors
        ///
        /// Refuses these cases: `keep` is not an end of `e`; both ends of `e` are corners of a
        /// face, but are not adjacent in the face; a vertex would lose its last face.
        /// [`EditError::Occupied`] if vertices are identified by coordinates and another vertex is
        /// at `to`.
        ///
        /// If only manifolds are allowed, also refuses violations of the link condition (Dey et al.
        /// 1999):
        ///
        /// - [`EditError::CommonNeighbour`]: a vertex is adjacent to both ends, but is not the
        ///   third corner of a triangle along `e`.
        /// - [`EditError::AcrossBoundary`]: an inner edge joins two boundary vertices.
        /// - [`EditError::Pillow`]: two triangles would have the same corners.
        fn collapse_edge, collapse_edge_logged(
            e: Self::Edge, keep: Self::Vertex, to: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Splits `v` in two, and adds a triangle on each side of the new edge; returns the new
        /// vertex. This is the inverse of [`collapse_edge`](Self::collapse_edge) (Hoppe 1996).
        ///
        /// The new vertex gets the faces counter-clockwise around `v`, from the edge `v`–`right` to
        /// the edge `v`–`left`. If `left` is `None`, the new edge has only the triangle on its
        /// right, and the new vertex gets the faces up to the boundary. If `right` is `None`, the
        /// new vertex gets the faces from the boundary to the edge `v`–`left`.
        ///
        /// ```text
        ///     left             left
        ///    ╲ │ ╱           ╲ ╱ ╲ ╱
        ///    ─ v ─     →     ─v───n─      faces (v, n, left) and (v, right, n) are new
        ///    ╱ │ ╲           ╱ ╲ ╱ ╲
        ///    right            right
        /// ```
        ///
        /// # Errors
        ///
        /// Refuses these cases: the faces at `v` do not form one oriented fan; `left` or `right` is
        /// not adjacent to `v`; `left` and `right` are equal, or both are `None`; one of them is
        /// `None`, but `v` is not on a boundary. [`EditError::Occupied`] if vertices are identified
        /// by coordinates and another vertex is at `at`.
        fn split_vertex, split_vertex_logged(
            v: Self::Vertex, left: Option<Self::Vertex>, right: Option<Self::Vertex>, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;
    }

    /// Closes all holes; O(mesh). The remaining elements keep their order and get rows without
    /// gaps. Every changed handle is reported. A table that is less than half used frees its spare
    /// memory.
    #[inline]
    fn compact(&mut self) {
        self.compact_logged(&mut ());
    }

    /// Does [`compact`](Self::compact), and reports all changes to `log`.
    fn compact_logged(&mut self, log: &mut impl EditLog<Self>);

    /// Returns whether the structure supports `edit`.
    fn supports(edit: Edit) -> bool {
        Self::EDITS[edit as usize].is_some()
    }

    /// Closes all holes and returns the new handle of each element; O(mesh).
    fn compact_with_map(&mut self) -> OldToNew<Self> {
        let mut vertices: VertexMap<Self, Option<Self::Vertex>> = self.vertex_map(None);
        let mut edges: EdgeMap<Self, Option<Self::Edge>> = self.edge_map(None);
        let mut faces: FaceMap<Self, Option<Self::Face>> = self.face_map(None);
        for v in self.vertices() {
            vertices[v] = Some(v);
        }
        for e in self.edges() {
            edges[e] = Some(e);
        }
        for f in self.faces() {
            faces[f] = Some(f);
        }
        let mut map = OldToNew {
            vertices,
            edges,
            faces,
        };
        self.compact_logged(&mut map);
        map
    }
}

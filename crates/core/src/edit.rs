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

/// Declares edits in both forms: the short form, with the given documentation, and the form with a
/// log. Every edit can be refused.
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
/// - **All or nothing.** A refused edit leaves every table unchanged. An invalid handle is refused
///   too; unlike a query, an edit does not panic.
/// - **Legality.** An edit is legal if its own rule below holds and the structure can hold the
///   resulting mesh ([`Capabilities`](crate::Capabilities)). So all structures that hold only
///   manifolds accept and refuse the same edits; the other structures also accept edits that make a
///   mesh non-manifold.
/// - **Handles.** Elements that an edit does not touch keep their handles. If handles are made of
///   other data (a pair of ends, coordinates, the corner opposite an edge), an edit may rename
///   elements: it changes their handles. It reports every element that it created, removed or
///   renamed to the [`EditLog`].
/// - **Holes.** A removed element is in no count, iteration, relation, conversion or file from then
///   on, and querying its handle panics. Its row stays a hole until [`compact`](Self::compact)
///   closes it; until then no row is reused. A handle made of other data (a pair, coordinates) may
///   read as an element without faces instead, and may later name another element.
/// - **In place.** An edit does not convert or rebuild the mesh. [`EDITS`](Self::EDITS) states how
///   much of the mesh an edit reads.
///
/// # Two forms
///
/// Every edit has a short form, such as [`flip_edge`](Self::flip_edge), and a form that reports its
/// changes of handles to a log, such as [`flip_edge_logged`](Self::flip_edge_logged). The log `()`
/// ignores the reports and costs nothing: the short form uses it. [`EditLog`] describes when to use
/// which. Data by vertex, edge or face follows all edits of a
/// [`MeshWithData`](crate::MeshWithData), in both forms.
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
    /// refuses the edit on every mesh.
    const EDITS: [Option<QueryCost>; Edit::ALL.len()];

    /// The same structure without deleted rows, whose queries need no check for them: its type
    /// parameter is [`Compact`](crate::Compact).
    type Compact: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Closes all holes and converts to a mesh that cannot have any; O(mesh) if there are holes.
    /// Handles change as in [`compact`](Self::compact), but are not reported: to keep handles, call
    /// [`compact_with_map`](Self::compact_with_map) first.
    fn into_compact(self) -> Self::Compact;

    /// Converts a compact mesh to one that can be edited; O(1). Handles stay the same.
    fn from_compact(compact: Self::Compact) -> Self;

    edits! {
        /// Moves `v` to `to`; returns the handle of the vertex afterwards.
        ///
        /// # Errors
        ///
        /// [`EditError::Occupied`] if a vertex is its coordinates and another one is at `to`.
        fn set_position, set_position_logged(
            v: Self::Vertex, to: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Adds a vertex without a face.
        ///
        /// # Errors
        ///
        /// [`EditError::Unsupported`] if the structure cannot hold a vertex without a face.
        fn add_vertex, add_vertex_logged(at: Point) -> Result<Self::Vertex, Refusal<Self>>;

        /// Adds a face with these `corners`. They must be vertices already, unless a vertex is its
        /// coordinates.
        ///
        /// # Errors
        ///
        /// Refuses fewer than three corners, a repeated corner, and a polygon if only triangles are
        /// allowed. If only manifolds are allowed, also refuses a side that a face already runs
        /// along in this direction, an edge that has two faces, and a corner whose faces would form
        /// more than one fan.
        fn add_face, add_face_logged(corners: &[Self::Vertex]) -> Result<Self::Face, Refusal<Self>>;

        /// Removes `f`, and the edges that no other face has. Its corners stay, even if they are
        /// isolated then; if a vertex is its coordinates, corners without a face are removed.
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the faces left at a corner would form more than one fan.
        fn remove_face, remove_face_logged(f: Self::Face) -> Result<(), Refusal<Self>>;

        /// Removes `v` and its faces, as [`remove_face`](Self::remove_face) does, in one edit.
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the faces left at another vertex would form more than one
        /// fan.
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
        /// Inserts a vertex at `at` into `e`, and so into each of its faces, whose degrees grow by
        /// one.
        ///
        /// # Errors
        ///
        /// [`EditError::Unsupported`] if only triangles are allowed; [`EditError::Occupied`] if a
        /// vertex is its coordinates and another one is at `at`.
        fn split_edge, split_edge_logged(
            e: Self::Edge, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Inserts a vertex at `at` into `e` and cuts the triangles of `e` in two there: the edge
        /// split of remeshing and of longest-edge bisection (Rivara 1984).
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
        /// [`EditError::Occupied`].
        fn bisect_edge, bisect_edge_logged(
            e: Self::Edge, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Cuts `f` into one triangle per side, around a new vertex at `at`; one of the triangles
        /// is `f`.
        ///
        /// # Errors
        ///
        /// [`EditError::Occupied`].
        fn poke_face, poke_face_logged(
            f: Self::Face, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Cuts `f` in two by an edge between two of its corners; one of the parts is `f`.
        ///
        /// # Errors
        ///
        /// Refuses vertices that are not corners of `f`, or are equal or adjacent in `f`;
        /// [`EditError::EdgeExists`] if only manifold edges are allowed and the two vertices have
        /// an edge already; [`EditError::Unsupported`] if only triangles are allowed.
        fn split_face, split_face_logged(
            f: Self::Face, ends: [Self::Vertex; 2],
        ) -> Result<Self::Edge, Refusal<Self>>;

        /// Removes `e` and merges its two faces; returns the face that stays. Undoes
        /// [`split_face`](Self::split_face).
        ///
        /// # Errors
        ///
        /// Refuses an edge that does not have exactly two faces, or whose faces run along it in the
        /// same direction or share a vertex that is not an end of `e`; [`EditError::Unsupported`]
        /// if only triangles are allowed.
        fn dissolve_edge, dissolve_edge_logged(e: Self::Edge) -> Result<Self::Face, Refusal<Self>>;

        /// Flips `e` within the quad of its two triangles; returns the handle of the edge
        /// afterwards. Each face keeps its handle, and keeps the end of `e` at which its side along
        /// `e` started.
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
        /// Refuses an edge that does not have exactly two faces, or whose faces run along it in the
        /// same direction, a face that is not a triangle, two triangles with the same third corner,
        /// and third corners that have an edge already; [`EditError::LowValence`] if an end has
        /// just three edges and three faces.
        fn flip_edge, flip_edge_logged(e: Self::Edge) -> Result<Self::Edge, Refusal<Self>>;

        /// Merges the two ends of `e` into `keep`, at `to`; returns the handle of that vertex
        /// afterwards. Triangles along `e` are removed, and other faces along `e` lose a corner.
        /// Two edges of a removed triangle become one: the edge at `keep` stays.
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
        /// Refuses a `keep` that is not an end of `e`, a face that has both ends but not as
        /// adjacent corners, and a vertex that would lose its last face; [`EditError::Occupied`].
        /// If only manifolds are allowed, also refuses violations of the link condition (Dey et al.
        /// 1999): [`EditError::CommonNeighbour`], a vertex adjacent to both ends that is not the
        /// third corner of a triangle along `e`; [`EditError::AcrossBoundary`], an inner edge
        /// between two boundary vertices; [`EditError::Pillow`], two triangles that would have the
        /// same corners.
        fn collapse_edge, collapse_edge_logged(
            e: Self::Edge, keep: Self::Vertex, to: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Splits `v` in two, with a triangle on each side of the new edge; returns the new vertex.
        /// The inverse of [`collapse_edge`](Self::collapse_edge) (Hoppe 1996).
        ///
        /// The new vertex gets the faces counter-clockwise around `v` from the edge to `right` to
        /// the edge to `left`. Without `left`, the new edge is on the boundary, with its one
        /// triangle on the right, and the new vertex gets the faces up to the boundary. Without
        /// `right`, it gets those from the boundary to `left`.
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
        /// Refuses a vertex whose faces are not one oriented fan, a `left` or `right` that is not
        /// adjacent to `v`, equal or missing `left` and `right`, and only one of them if `v` is not
        /// on a boundary; [`EditError::Occupied`].
        fn split_vertex, split_vertex_logged(
            v: Self::Vertex, left: Option<Self::Vertex>, right: Option<Self::Vertex>, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;
    }

    /// Closes all holes; O(mesh). The remaining elements keep their order, in rows without gaps,
    /// and every changed handle is reported. A table that is less than half used frees its spare
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

//! The edit trait: changing a mesh in place.

use crate::Point;
use crate::edit::edit_error::EditError;
use crate::edit::edit_kind::Edit;
use crate::edit::edit_log::{EditLog, OldToNew};
use crate::traits::mesh_move::MeshMove;
use crate::traits::query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
use crate::traits::representation::QueryCost;

/// The error type of the edits of the mesh type `M`.
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
        #[doc = concat!(
            "Returns the same errors as [`", stringify!($edit),
            "`](Self::", stringify!($edit), ").",
        )]
        fn $logged(&mut self, $($argument: $kind,)+ log: &mut impl EditLog<Self>) -> $outcome;
    )+};
}

/// A structure whose mesh can be edited in place.
///
/// # Contract
///
/// - **All or nothing.** A refused edit leaves every table unchanged. An edit with an invalid
///   handle is refused and does not panic.
/// - **Legality.** An edit is legal if none of the errors in its documentation applies and the
///   structure can hold the resulting mesh ([`Capabilities`](crate::Capabilities)). For example,
///   structures that can hold non-manifold meshes accept edits that make a mesh non-manifold. An
///   edit that would make more elements than 32-bit handles can number returns
///   [`EditError::TooMany`].
/// - **Handles.** Elements that an edit does not touch keep their handles. In some structures, a
///   handle is a pair of ends, coordinates, or the corner opposite an edge, so an edit can change
///   the handle of an element that stays. Such an element is called renamed. The edit reports every
///   created, removed or renamed element to the [`EditLog`].
/// - **Holes.** Counts, iterations, relations and conversions do not contain removed elements. The
///   row of a removed element becomes a hole, and a query with the handle of this row panics. No
///   row is reused until [`compact`](Self::compact) removes the holes. If the handle of a removed
///   element is a pair of ends or coordinates, the relations of this handle are empty, and a later
///   edit may create an element with the same handle.
/// - **In place.** An edit does not convert or rebuild the mesh. [`EDITS`](Self::EDITS) states how
///   much of the mesh an edit reads.
///
/// # Two forms
///
/// Every edit has a short form, such as [`flip_edge`](Self::flip_edge), and a logged form, such as
/// [`flip_edge_logged`](Self::flip_edge_logged). The logged form reports all created, removed and
/// renamed elements to a log. The short form reports nothing. [`EditLog`] describes when to use the
/// short form and when to use the logged form. In both forms, an edit of a
/// [`MeshWithData`](crate::MeshWithData) also updates the data of the mesh.
///
/// ```
/// # use sixfold_core::{MeshEdit, Point, Refusal};
/// /// Puts a vertex into the middle of `e` and returns it.
/// fn bisect<M: MeshEdit>(mesh: &mut M, e: M::Edge) -> Result<M::Vertex, Refusal<M>> {
///     let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
///     mesh.bisect_edge(e, (a + b) / 2.0)
/// }
/// ```
///
/// # Editing while iterating
///
/// An iterator borrows the mesh, so a loop over a mesh cannot edit it. Collect the handles first, which
/// takes O(elements) time and memory, and ask before each edit whether the element still exists:
/// [`contains_edge`](MeshQuery::contains_edge) takes O(1) time if handles are rows or corners.
///
/// ```
/// # use sixfold_core::{MeshEdit, MeshQuery};
/// /// Flips the edges that are too long. Returns the number of flips.
/// fn flip_long<M: MeshEdit>(mesh: &mut M, is_too_long: impl Fn(&M, M::Edge) -> bool) -> usize {
///     let mut done = 0;
///     for e in mesh.edges().collect::<Vec<_>>() {
///         if mesh.contains_edge(e) && is_too_long(mesh, e) {
///             done += usize::from(mesh.flip_edge(e).is_ok());
///         }
///     }
///     done
/// }
/// ```
///
/// The mesh is valid after this loop, but **the result depends on the structure**: structures list edges in
/// different orders, and an edit can give another handle to an edge nearby, which the loop then skips. (Structures
/// differ in what an edit renames. A later edit may also create an element with the handle of a removed one.)
///
/// A loop has one result on every structure if
///
/// 1. the elements are sorted by what they are, such as their length and positions, and not by handles;
/// 2. an element is edited only if no earlier edit of the pass has changed a face at its vertices: its handle and
///    everything around it are then as they were when it was listed. The others get their turn in the next pass,
///    until a pass changes nothing;
/// 3. the program asks itself whether an edit keeps the mesh a manifold, such as with `meets_link_condition` of
///    `sixfold::remeshing`, because structures that hold more than manifolds refuse less.
///
/// Each pass takes O(n log n) time for n listed elements.
///
/// ```
/// # use sixfold_core::{MeshEdit, MeshQuery};
/// /// Collapses edges that are shorter than `least`, the shortest first. Returns the number of collapses.
/// fn collapse_short<M: MeshEdit>(
///     mesh: &mut M,
///     least: f32,
///     keeps_manifold: impl Fn(&M, M::Edge) -> bool,
/// ) -> usize {
///     let mut done = 0;
///     loop {
///         let mut short = Vec::new();
///         for e in mesh.edges() {
///             let ends = mesh.edge_vertices(e);
///             let [p, q] = ends.map(|v| mesh.position(v));
///             if p.distance(q) < least {
///                 let mut places = [p, q].map(|p| p.to_array().map(f32::to_bits));
///                 places.sort_unstable();
///                 short.push((p.distance(q).to_bits(), places, e, ends));
///             }
///         }
///         short.sort_unstable_by_key(|&(length, places, ..)| (length, places));
///         let mut changed = mesh.vertex_map(false);
///         let before = done;
///         for (_, _, e, ends) in short {
///             if ends.iter().any(|&v| changed[v]) || !keeps_manifold(mesh, e) {
///                 continue;
///             }
///             let [p, q] = ends.map(|v| mesh.position(v));
///             let around = ends.map(|v| mesh.vertex_vertices(v).collect::<Vec<_>>());
///             if mesh.collapse_edge(e, ends[0], p.midpoint(q)).is_ok() {
///                 done += 1;
///                 for v in around.into_iter().flatten() {
///                     changed[v] = true;
///                 }
///             }
///         }
///         if done == before {
///             return done;
///         }
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be edited",
    label = "this mesh is read-only",
    note = "a compact structure becomes editable by `into_editable()`; `from_polygons` of an editable \
            type, such as `EditableHalfEdgeMesh`, builds one"
)]
pub trait MeshEdit: MeshMove {
    /// How much of the mesh each edit reads, in the order of [`Edit::ALL`]; `None` if the structure
    /// does not support the edit.
    const EDITS: [Option<QueryCost>; Edit::ALL.len()];

    /// The type of this structure with the type parameter [`Compact`](crate::Compact). A mesh of
    /// this type has no deleted rows, so its queries need no check for deleted rows.
    type Compact: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Removes the rows of deleted elements (holes), and converts to a mesh that cannot have holes.
    /// O(size of the mesh) if there are holes. Handles change as in [`compact`](Self::compact), but
    /// the changes are not reported. If you need the new handles, call
    /// [`compact_with_map`](Self::compact_with_map) first.
    fn into_compact(self) -> Self::Compact;

    /// Converts a compact mesh to an editable mesh; O(1). All handles stay the same.
    fn from_compact(compact: Self::Compact) -> Self;

    edits! {
        /// Moves `v` to `to`; returns the handle that the vertex has after the move.
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

        /// Adds a face with the given `corners`. The corners must be existing vertices, unless
        /// vertices are identified by coordinates.
        ///
        /// # Errors
        ///
        /// Refuses the edit in these cases: there are fewer than three corners; a corner occurs
        /// twice; the structure holds only triangles, and the face is not a triangle. If the
        /// structure holds only manifolds, also refuses the edit in these cases: another face
        /// already has a side of the new face in the same direction; an edge already has two faces;
        /// the faces at a corner would form more than one fan.
        fn add_face, add_face_logged(corners: &[Self::Vertex]) -> Result<Self::Face, Refusal<Self>>;

        /// Removes `f`, and the edges whose only face is `f`. The vertices of `f` stay, even if
        /// they become isolated. If vertices are identified by coordinates, vertices without a face
        /// are removed.
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the structure holds only manifolds and the remaining faces
        /// at a corner would form more than one fan.
        fn remove_face, remove_face_logged(f: Self::Face) -> Result<(), Refusal<Self>>;

        /// Removes all of `faces`, as [`remove_face`](Self::remove_face) does with one of them. Only
        /// the mesh without all of them must be legal: a strip of faces can be removed whose faces
        /// cannot be removed one by one. A face that occurs twice counts once.
        ///
        /// Takes O(n log n) time for n corners of the faces and of the faces at these corners.
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the structure holds only manifolds and the remaining faces
        /// at a vertex would form more than one fan.
        fn remove_faces, remove_faces_logged(faces: &[Self::Face]) -> Result<(), Refusal<Self>>;

        /// Removes `v` and all its faces in one edit. [`remove_face`](Self::remove_face) describes
        /// the edges and vertices that are removed together with each face.
        ///
        /// # Errors
        ///
        /// [`EditError::SeveralFans`] if the structure holds only manifolds and the remaining faces
        /// at another vertex would form more than one fan.
        fn remove_vertex, remove_vertex_logged(v: Self::Vertex) -> Result<(), Refusal<Self>>;
    }

    /// Removes all faces for which `keep` returns false, by [`remove_faces`](Self::remove_faces).
    /// Returns the number of removed faces.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`remove_faces`](Self::remove_faces).
    ///
    /// # Examples
    ///
    /// ```
    /// # use sixfold_core::{MeshEdit, Refusal};
    /// /// Cuts off everything below the plane z = 0.
    /// fn cut<M: MeshEdit>(mesh: &mut M) -> Result<usize, Refusal<M>> {
    ///     let above: Vec<bool> = mesh
    ///         .faces()
    ///         .map(|f| mesh.face_vertices(f).all(|v| mesh.position(v).z >= 0.0))
    ///         .collect();
    ///     let mut above = above.into_iter();
    ///     mesh.retain_faces(|_| above.next().unwrap_or(true))
    /// }
    /// ```
    fn retain_faces(
        &mut self,
        mut keep: impl FnMut(Self::Face) -> bool,
    ) -> Result<usize, Refusal<Self>> {
        let removed: Vec<Self::Face> = self.faces().filter(|&f| !keep(f)).collect();
        self.remove_faces(&removed)?;
        Ok(removed.len())
    }

    /// Removes all vertices without a face; returns the number of removed vertices.
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
        /// [`EditError::Unsupported`] if the structure holds only triangles;
        /// [`EditError::Occupied`] if vertices are identified by coordinates and another vertex is
        /// at `at`.
        fn split_edge, split_edge_logged(
            e: Self::Edge, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Inserts a vertex at `at` into `e`, and cuts each triangle of `e` in two at this vertex.
        /// Remeshing and longest-edge bisection (Rivara 1984) use this edit.
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
        /// if the structure holds only manifold edges and both triangles have the same third
        /// corner; [`EditError::Occupied`] if vertices are identified by coordinates and another
        /// vertex is at `at`.
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

        /// Cuts `f` into two faces by a new edge between its corners `ends`, and returns this edge.
        /// The handle `f` stays the handle of one of the two faces.
        ///
        /// # Errors
        ///
        /// Refuses the edit if the `ends` are not corners of `f`, are equal, or are adjacent in
        /// `f`. [`EditError::EdgeExists`] if the structure holds only manifold edges and an edge
        /// already joins the two vertices; [`EditError::Unsupported`] if the structure holds only
        /// triangles.
        fn split_face, split_face_logged(
            f: Self::Face, ends: [Self::Vertex; 2],
        ) -> Result<Self::Edge, Refusal<Self>>;

        /// Removes `e` and merges its two faces; returns the face that stays. This edit is the
        /// inverse of [`split_face`](Self::split_face).
        ///
        /// # Errors
        ///
        /// Refuses the edit in these cases: `e` does not have exactly two faces; the two faces run
        /// along `e` in the same direction; the two faces share a vertex other than the ends of
        /// `e`. [`EditError::Unsupported`] if the structure holds only triangles.
        fn dissolve_edge, dissolve_edge_logged(e: Self::Edge) -> Result<Self::Face, Refusal<Self>>;

        /// Replaces `e` by the other diagonal of the quad that its two triangles form; returns the
        /// handle of the flipped edge. Both triangles keep their handles. Each triangle keeps one
        /// old end of `e`: the vertex where the side of the triangle along `e` starts.
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
        /// Refuses the edit in these cases: `e` does not have exactly two faces; the faces run
        /// along `e` in the same direction; a face is not a triangle; the two triangles have the
        /// same third corner; an edge already joins the two third corners.
        /// [`EditError::LowValence`] if an end of `e` has only three edges and three faces.
        fn flip_edge, flip_edge_logged(e: Self::Edge) -> Result<Self::Edge, Refusal<Self>>;

        /// Merges the two ends of `e` into the vertex `keep`, and moves `keep` to the position
        /// `to`. Returns the handle of `keep` after the edit. Triangles along `e` are removed, and
        /// other faces along `e` lose a corner. A removed triangle has two edges besides `e`: the
        /// edge at `keep` stays, and the edge at the removed end is removed.
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
        /// Refuses the edit in these cases: `keep` is not an end of `e`; a face has corners at both
        /// ends of `e`, but these corners are not adjacent in the face; a vertex would lose its
        /// last face. [`EditError::Occupied`] if vertices are identified by coordinates and a
        /// vertex that is not an end of `e` is at `to`.
        ///
        /// If the structure holds only manifolds, refuses violations of the link condition (Dey et
        /// al. 1999):
        ///
        /// - [`EditError::CommonNeighbour`]: a vertex is adjacent to both ends of `e`, but is not
        ///   the third corner of a triangle along `e`.
        /// - [`EditError::SameApex`] or [`EditError::LastFace`]: both faces of `e` are triangles
        ///   with the same third corner.
        /// - [`EditError::AcrossBoundary`]: an inner edge joins two boundary vertices.
        /// - [`EditError::Pillow`]: two triangles would have the same corners.
        fn collapse_edge, collapse_edge_logged(
            e: Self::Edge, keep: Self::Vertex, to: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;

        /// Splits `v` into two vertices, joins them by a new edge, and adds a triangle on each side
        /// of this edge. Returns the new vertex. This edit is the inverse of
        /// [`collapse_edge`](Self::collapse_edge) (Hoppe 1996).
        ///
        /// The new vertex gets the faces that follow counter-clockwise around `v` from the edge
        /// `v`–`right` to the edge `v`–`left`. If `left` is `None`, only the triangle on the right
        /// of the new edge is added, and the new vertex gets the faces from the edge `v`–`right` to
        /// the boundary. If `right` is `None`, the new vertex gets the faces from the boundary to
        /// the edge `v`–`left`.
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
        /// Refuses the edit in these cases: the faces at `v` do not form one oriented fan; `left`
        /// or `right` is not adjacent to `v`; `left` and `right` are equal, or both are `None`;
        /// `left` or `right` is `None`, but `v` is not on a boundary. [`EditError::Occupied`] if
        /// vertices are identified by coordinates and another vertex is at `at`.
        fn split_vertex, split_vertex_logged(
            v: Self::Vertex, left: Option<Self::Vertex>, right: Option<Self::Vertex>, at: Point,
        ) -> Result<Self::Vertex, Refusal<Self>>;
    }

    /// Removes the rows of deleted elements (holes) from all tables; O(size of the mesh). The
    /// remaining elements keep their order and get rows without gaps. A table that uses less than
    /// half of its memory frees the unused part.
    #[inline]
    fn compact(&mut self) {
        self.compact_logged(&mut ());
    }

    /// Does [`compact`](Self::compact), and reports every changed handle to `log`.
    fn compact_logged(&mut self, log: &mut impl EditLog<Self>);

    /// Returns whether the structure supports `edit`.
    fn supports(edit: Edit) -> bool {
        Self::EDITS[edit as usize].is_some()
    }

    /// Does [`compact`](Self::compact), and returns the new handle of each element; O(size of the
    /// mesh).
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

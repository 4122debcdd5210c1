//! Changing a mesh in place: the one editing trait.

use std::fmt;

use serde::Serialize;

use crate::Point;
use crate::edit_error::EditError;
use crate::edit_log::{EditLog, OldToNew};
use crate::query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
use crate::representation::QueryCost;

/// One of the ways to change a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[expect(
    missing_docs,
    reason = "the names are those of the methods of MeshEdit"
)]
pub enum Edit {
    SetPosition,
    AddVertex,
    AddFace,
    RemoveFace,
    RemoveVertex,
    RemoveIsolatedVertices,
    SplitEdge,
    BisectEdge,
    PokeFace,
    SplitFace,
    DissolveEdge,
    FlipEdge,
    CollapseEdge,
    SplitVertex,
    Compact,
}

impl Edit {
    /// All of them, in the order of [`MeshEdit::EDITS`].
    pub const ALL: [Self; 15] = [
        Self::SetPosition,
        Self::AddVertex,
        Self::AddFace,
        Self::RemoveFace,
        Self::RemoveVertex,
        Self::RemoveIsolatedVertices,
        Self::SplitEdge,
        Self::BisectEdge,
        Self::PokeFace,
        Self::SplitFace,
        Self::DissolveEdge,
        Self::FlipEdge,
        Self::CollapseEdge,
        Self::SplitVertex,
        Self::Compact,
    ];

    /// What the edits look at in a structure that knows its neighbours: the faces around, but for a
    /// position or a new vertex, and for passes over the whole mesh.
    pub const LOCAL_COSTS: [Option<QueryCost>; Self::ALL.len()] = {
        let mut costs = [Some(QueryCost::Local); Self::ALL.len()];
        costs[Self::SetPosition as usize] = Some(QueryCost::Constant);
        costs[Self::AddVertex as usize] = Some(QueryCost::Constant);
        costs[Self::RemoveIsolatedVertices as usize] = Some(QueryCost::Scan);
        costs[Self::Compact as usize] = Some(QueryCost::Scan);
        costs
    };

    /// The name of the method: `flip_edge`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SetPosition => "set_position",
            Self::AddVertex => "add_vertex",
            Self::AddFace => "add_face",
            Self::RemoveFace => "remove_face",
            Self::RemoveVertex => "remove_vertex",
            Self::RemoveIsolatedVertices => "remove_isolated_vertices",
            Self::SplitEdge => "split_edge",
            Self::BisectEdge => "bisect_edge",
            Self::PokeFace => "poke_face",
            Self::SplitFace => "split_face",
            Self::DissolveEdge => "dissolve_edge",
            Self::FlipEdge => "flip_edge",
            Self::CollapseEdge => "collapse_edge",
            Self::SplitVertex => "split_vertex",
            Self::Compact => "compact",
        }
    }
}

impl fmt::Display for Edit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Why `M` refused an edit.
pub type Refusal<M> =
    EditError<<M as MeshQuery>::Vertex, <M as MeshQuery>::Edge, <M as MeshQuery>::Face>;

/// A structure whose mesh can be changed in place.
///
/// # Contract
///
/// - **All or nothing.** A refused edit leaves every table as it was. A handle that names nothing is
///   refused, too; unlike a query, an edit does not panic.
/// - **Legal.** An edit is legal where its own rule below holds and the structure can hold the mesh
///   that it makes ([`Capabilities`](crate::Capabilities)). So structures that hold manifolds alone
///   accept and refuse alike, and the others accept what these refuse for being no manifold.
/// - **Names.** Elements that an edit does not touch keep their names. Where a name is made of other
///   things (a pair of ends, coordinates, the corner that faces an edge), an edit may rename
///   elements; what it created, removed and renamed it tells the [`EditLog`], and tells all of it.
/// - **Holes.** What is removed is in no count, iteration, relation, conversion or file from then on,
///   and its name panics when queried. Its row stays a hole, which only [`compact`](Self::compact)
///   closes: until then no row is used again. A name made of other things (a pair, coordinates) may
///   read as an element without faces instead, and may come to name another.
/// - **In place.** No conversion, no rebuilding behind the scenes. [`EDITS`](Self::EDITS) says how
///   much of the mesh an edit looks at.
///
/// Pass `&mut ()` for the log where nobody listens: then telling costs nothing.
pub trait MeshEdit: MeshQuery + Sized {
    /// How much of the mesh each edit looks at, in the order of [`Edit::ALL`]; `None` where the
    /// structure refuses it whatever the mesh.
    const EDITS: [Option<QueryCost>; Edit::ALL.len()];

    /// The same structure without holes, whose queries need not ask for them: [`Whole`](crate::Whole).
    type Whole: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face> + Into<Self>;

    /// Closes all holes, and no more are made; O(mesh) if there are any. Names change as by
    /// [`compact`](Self::compact), and nobody is told: if you keep any, call
    /// [`compact_with_names`](Self::compact_with_names) first. [`Whole`](Self::Whole) turns back into
    /// this by `into()`, in O(1).
    fn into_whole(self) -> Self::Whole;

    /// Moves `v` to `to`; the vertex by the name it has then.
    ///
    /// # Errors
    ///
    /// Where a vertex is its coordinates, [`EditError::Occupied`] if another is at `to`.
    fn set_position(
        &mut self,
        v: Self::Vertex,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Adds a vertex without a face.
    ///
    /// # Errors
    ///
    /// [`EditError::Unsupported`] where there is no vertex without a face.
    fn add_vertex(
        &mut self,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Adds a face over `corners`, which are there already; where a vertex is its coordinates, they
    /// need not be.
    ///
    /// # Errors
    ///
    /// Fewer than three corners, one named twice, not three where only triangles fit; and what makes
    /// a manifold none: a side that a face runs already, an edge with two faces, a corner whose faces
    /// would no longer be one fan.
    fn add_face(
        &mut self,
        corners: &[Self::Vertex],
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Face, Refusal<Self>>;

    /// Removes `f`, and the edges that only it had. Its corners stay, isolated if need be; where a
    /// vertex is its coordinates, those without a face go.
    ///
    /// # Errors
    ///
    /// [`EditError::SeveralFans`] where the faces left at a corner would be no single fan.
    fn remove_face(
        &mut self,
        f: Self::Face,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>>;

    /// Removes `v` and its faces, as [`remove_face`](Self::remove_face) does, all at once.
    ///
    /// # Errors
    ///
    /// [`EditError::SeveralFans`] where the faces left at another vertex would be no single fan.
    fn remove_vertex(
        &mut self,
        v: Self::Vertex,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>>;

    /// Removes all vertices without a face; how many.
    fn remove_isolated_vertices(&mut self, log: &mut impl EditLog<Self>) -> usize;

    /// Puts a vertex at `at` into `e`, and so into each of its faces, whose degrees grow by one.
    ///
    /// # Errors
    ///
    /// [`EditError::Unsupported`] where only triangles fit; where a vertex is its coordinates,
    /// [`EditError::Occupied`].
    fn split_edge(
        &mut self,
        e: Self::Edge,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Puts a vertex at `at` into `e` and cuts its triangles in two there: the edge split of
    /// remeshing and of longest-edge bisection (Rivara 1984).
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
    /// [`EditError::NotATriangle`] if a face of `e` is none. Where edges have two faces,
    /// [`EditError::SameApex`] if both triangles have one third corner. Also [`EditError::Occupied`].
    fn bisect_edge(
        &mut self,
        e: Self::Edge,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Cuts `f` into a triangle for each of its sides, with a new vertex at `at`; one of them is `f`.
    ///
    /// # Errors
    ///
    /// [`EditError::Occupied`].
    fn poke_face(
        &mut self,
        f: Self::Face,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Cuts `f` in two by an edge between two of its corners; one of the parts is `f`.
    ///
    /// # Errors
    ///
    /// The vertices are no corners of `f`, the same, or beside each other there;
    /// [`EditError::EdgeExists`] where edges have two faces; [`EditError::Unsupported`] where only
    /// triangles fit.
    fn split_face(
        &mut self,
        f: Self::Face,
        ends: [Self::Vertex; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Edge, Refusal<Self>>;

    /// Removes `e` and makes one face of its two; the one that stays. Undoes
    /// [`split_face`](Self::split_face).
    ///
    /// # Errors
    ///
    /// `e` has not two faces, or they run it the same way, or they share a vertex that is no end of
    /// `e`; [`EditError::Unsupported`] where only triangles fit.
    fn dissolve_edge(
        &mut self,
        e: Self::Edge,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Face, Refusal<Self>>;

    /// Turns `e` within the quad of its two triangles; the edge by the name it has then. Each face
    /// keeps its name, and of the ends of `e` the one from which it ran `e`.
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
    /// `e` has not two faces, or they run it the same way, or one is no triangle, or both have one
    /// third corner, or the two third corners have an edge already; [`EditError::LowValence`] where
    /// an end has just three edges and three faces.
    fn flip_edge(
        &mut self,
        e: Self::Edge,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Edge, Refusal<Self>>;

    /// Makes one vertex of the two ends of `e`: `keep`, at `to`; the vertex by the name it has then.
    /// Triangles along `e` go, other faces lose a corner. Of the two edges of such a triangle that
    /// come together, the one at `keep` stays.
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
    /// `keep` is no end of `e`; a face has both ends, but not side by side; a vertex would lose its
    /// last face; [`EditError::Occupied`]. Where manifolds alone are held, also what breaks the link
    /// condition (Dey et al. 1999): [`EditError::CommonNeighbour`], a vertex beside both ends that is
    /// no third corner of a triangle along `e`; [`EditError::AcrossBoundary`], an inner edge between
    /// two boundary vertices; [`EditError::Pillow`], two triangles that would have the same corners.
    fn collapse_edge(
        &mut self,
        e: Self::Edge,
        keep: Self::Vertex,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Splits `v` in two, with a triangle on each side of the new edge: the inverse of
    /// [`collapse_edge`](Self::collapse_edge) (Hoppe 1996); the new vertex.
    ///
    /// The new vertex gets the faces that lie counter-clockwise around `v` from the edge to `right`
    /// to the edge to `left`. With no `left` the new edge lies on the boundary, with its one triangle
    /// on the right, and the new vertex gets the faces up to the boundary; with no `right`, those
    /// from the boundary to `left`.
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
    /// The faces at `v` are no single oriented fan; a side that is no neighbour of `v`; the same
    /// twice, or none; one side only where `v` is not on a boundary; [`EditError::Occupied`].
    fn split_vertex(
        &mut self,
        v: Self::Vertex,
        left: Option<Self::Vertex>,
        right: Option<Self::Vertex>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<Self::Vertex, Refusal<Self>>;

    /// Closes all holes: what remains keeps its order, in rows without a gap, and its renaming is
    /// told. O(mesh). Memory goes back where less than half of a table would be used.
    fn compact(&mut self, log: &mut impl EditLog<Self>);

    /// Whether the structure offers `edit` at all.
    fn offers(edit: Edit) -> bool {
        Self::EDITS[edit as usize].is_some()
    }

    /// Closes all holes and says what became of each name; O(mesh).
    fn compact_with_names(&mut self) -> OldToNew<Self> {
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
        let mut names = OldToNew {
            vertices,
            edges,
            faces,
        };
        self.compact(&mut names);
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_edits_are_in_the_order_of_their_numbers() {
        for (i, edit) in Edit::ALL.into_iter().enumerate() {
            assert_eq!(edit as usize, i, "{edit}");
        }
    }
}

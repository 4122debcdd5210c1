//! The walk trait: the sides of the faces, and the steps between them.

use crate::handles::handle::Handle;
use crate::traits::query::MeshQuery;

/// A map that holds a value for each side (edge of one face) of the mesh type `M`.
pub type SideMap<M, T> = <<M as OrientedWalk>::Side as Handle>::Map<T>;

/// Steps from one side of a face to another side. A side is an edge of one particular face; its
/// direction is counter-clockwise around this face.
///
/// ```text
///      ◄── next_side(s) ── ● target
///                         ▲│
///                         ││               around the origin of s, the face of s on its left:
///            face of s  s ││ twin_side(s)  ccw_side(s) is the twin of prev_side(s),
///                         │▼               cw_side(s) is next_side of the twin of s
///      ─── prev_side(s) ─► ● origin
/// ```
///
/// Most relations of [`MeshQuery`] are not ordered. This trait adds ordered steps: [`next_side`]
/// and [`prev_side`] step along a face, and [`ccw_side`] and [`cw_side`] step around a vertex. The
/// half-edge mesh, the winged-edge mesh, the corner table and the face-vertex mesh implement this
/// trait. The indexed face set and the polygon soup do not implement this trait, because every step
/// around a vertex would scan all faces.
///
/// # Contract
///
/// - **Sides.** A face of degree n has n sides. An edge has one side for each of its faces, so a
///   boundary edge has one side.
/// - **Order.** `face_sides(f)` has the order of `face_vertices(f)` and `face_edges(f)`: side `i`
///   starts at corner `i` and runs along edge `i`. The order of `edge_sides` and of
///   `outgoing_sides` is not guaranteed.
/// - **Twin.** Two sides are twins if they are the only sides of their edge and run in opposite
///   directions. So the twin of the twin of a side is the side itself. A side has no twin in three
///   cases: its edge is on a boundary, its edge has three or more faces, or both faces of its edge
///   run along the edge in the same direction.
/// - **No cache.** As in [`MeshQuery`], each result is computed from the stored tables alone.
/// - **Handles.** The handle of a side is valid until the next edit; an [`EditLog`](crate::EditLog)
///   does not report changes of sides. If the handle of a side is out of range or the face of the
///   side was deleted, every method panics or returns an element that does not exist.
///
/// # Complexity
///
/// | method | half-edge | winged-edge | corner table | face-vertex |
/// |---|---|---|---|---|
/// | `next_side`, `side_target` | O(1) | O(1) | O(1) | O(1) |
/// | `prev_side` | O(degree) | O(1) | O(1) | O(1) |
/// | `side_origin`, `side_face`, `side_edge` | O(1) | O(1) | O(1) | O(1) |
/// | `twin_side`, `cw_side` | O(1) | O(1) | O(1) | O(faces at an end · degree) |
/// | `ccw_side` | O(degree) | O(1) | O(1) | O(faces at an end · degree) |
/// | `edge_sides` | O(1) | O(1) | O(1) | O(faces at an end · degree) |
/// | `face_sides`, for each side | O(1) | O(1) | O(1) | O(1) |
/// | `outgoing_sides`, for each side | O(1) | O(1) | O(1) | O(degree) |
///
/// In the column face-vertex, "an end" is the end of the edge that has fewer faces.
///
/// # Panics
///
/// A method that takes a vertex, an edge or a face panics in the same cases as a query of
/// [`MeshQuery`].
///
/// # Examples
///
/// This function returns the faces around a vertex in order, from a side that starts at the vertex.
///
/// ```
/// use sixfold_core::OrientedWalk;
///
/// /// Returns the faces around the origin of `start`, counter-clockwise: all of them, or those up
/// /// to the boundary.
/// fn fan<M: OrientedWalk>(mesh: &M, start: M::Side) -> Vec<M::Face> {
///     let mut faces = vec![mesh.side_face(start)];
///     let mut at = mesh.ccw_side(start);
///     while let Some(s) = at.filter(|&s| s != start) {
///         faces.push(mesh.side_face(s));
///         at = mesh.ccw_side(s);
///     }
///     faces
/// }
/// ```
///
/// [`next_side`]: Self::next_side
/// [`prev_side`]: Self::prev_side
/// [`ccw_side`]: Self::ccw_side
/// [`cw_side`]: Self::cw_side
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no steps from side to side",
    label = "this mesh does not implement `OrientedWalk`",
    note = "half-edge meshes, winged-edge meshes, corner tables and face-vertex meshes implement it"
)]
pub trait OrientedWalk: MeshQuery {
    /// The handle of a side.
    type Side: Handle;

    /// Yields the sides of `f`, counter-clockwise in the order of `face_vertices(f)`.
    fn face_sides(&self, f: Self::Face) -> impl Iterator<Item = Self::Side>;
    /// Yields the sides of `e`, one for each face of `e`.
    fn edge_sides(&self, e: Self::Edge) -> impl Iterator<Item = Self::Side>;
    /// Yields the sides that start at `v`, one for each face at `v`.
    fn outgoing_sides(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Side>;

    /// Returns the side after `s` along the face of `s`. The returned side starts where `s` ends.
    fn next_side(&self, s: Self::Side) -> Self::Side;
    /// Returns the side before `s` along the face of `s`. The returned side ends where `s` starts.
    fn prev_side(&self, s: Self::Side) -> Self::Side;
    /// Returns the twin of `s`, or `None` if `s` has no twin. A side has a twin if its edge has
    /// exactly two sides and these sides run in opposite directions.
    fn twin_side(&self, s: Self::Side) -> Option<Self::Side>;

    /// Returns the vertex where `s` starts.
    fn side_origin(&self, s: Self::Side) -> Self::Vertex;
    /// Returns the vertex where `s` ends.
    fn side_target(&self, s: Self::Side) -> Self::Vertex {
        self.side_origin(self.next_side(s))
    }
    /// Returns the face of `s`, which is on the left of `s`.
    fn side_face(&self, s: Self::Side) -> Self::Face;
    /// Returns the edge of `s`.
    fn side_edge(&self, s: Self::Side) -> Self::Edge;

    /// Returns the next side around the origin of `s`, counter-clockwise: the twin of the side
    /// before `s`. Returns `None` if the side before `s` has no twin, for example at a boundary.
    fn ccw_side(&self, s: Self::Side) -> Option<Self::Side> {
        self.twin_side(self.prev_side(s))
    }
    /// Returns the next side around the origin of `s`, clockwise: the side after the twin of `s`.
    /// Returns `None` if `s` has no twin, for example at a boundary.
    fn cw_side(&self, s: Self::Side) -> Option<Self::Side> {
        self.twin_side(s).map(|twin| self.next_side(twin))
    }

    /// Returns the next side without a twin along a boundary, or `None` if `s` has a twin. The returned
    /// side starts where `s` ends; both have the same hole on their right. So a walk from `s` visits the
    /// sides around a hole and comes back to `s`, unless an edge with three or more faces interrupts the
    /// boundary. Takes one step for each side at the end of `s`.
    ///
    /// # Examples
    ///
    /// ```
    /// use sixfold_core::OrientedWalk;
    ///
    /// /// Returns the number of edges around the hole at the boundary side `start`.
    /// fn hole_size<M: OrientedWalk>(mesh: &M, start: M::Side) -> usize {
    ///     let next = |s: &M::Side| mesh.next_boundary_side(*s).filter(|&s| s != start);
    ///     std::iter::successors(Some(start), next).count()
    /// }
    /// ```
    fn next_boundary_side(&self, s: Self::Side) -> Option<Self::Side> {
        if self.twin_side(s).is_some() {
            return None;
        }
        let mut side = self.next_side(s);
        while let Some(twin) = self.twin_side(side) {
            side = self.next_side(twin);
        }
        Some(side)
    }
    /// Returns the side before `s` along a boundary, the inverse of
    /// [`next_boundary_side`](Self::next_boundary_side); `None` if `s` has a twin.
    fn prev_boundary_side(&self, s: Self::Side) -> Option<Self::Side> {
        if self.twin_side(s).is_some() {
            return None;
        }
        let mut side = self.prev_side(s);
        while let Some(twin) = self.twin_side(side) {
            side = self.prev_side(twin);
        }
        Some(side)
    }

    /// Yields every side once, face by face.
    fn sides(&self) -> impl Iterator<Item = Self::Side> {
        self.faces().flat_map(|f| self.face_sides(f))
    }
    /// Returns the number of sides, which is also the number of corners; O(corners).
    fn side_count(&self) -> usize {
        self.faces().map(|f| self.degree(f)).sum()
    }

    /// Returns a map that holds `value` for every side.
    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T>;
}

//! The tables, their invariants, and the classic operators.

use std::fmt::Debug;

use mesh_core::{
    EDGE_HOLES, EdgeId, Editable, Editing, FACE_HOLES, FaceId, HoleSet, Point, Probe, Slot, Table,
    Untraced, VERTEX_HOLES, VertexId, Whole, row_id,
};

row_id! {
    /// The name of one half-edge, `h7`; the halves of edge `e` are `2e` and `2e + 1`.
    pub struct HalfEdgeId, "h"
}

impl HalfEdgeId {
    /// The half that runs the other way along the same edge.
    #[inline]
    pub const fn twin(self) -> Self {
        Self::new(self.index() as u32 ^ 1)
    }

    /// The edge that this is a half of.
    #[inline]
    pub const fn edge(self) -> EdgeId {
        EdgeId::new(self.index() as u32 >> 1)
    }
}

/// One half of an edge: a row of the table `halves`.
///
/// Kept as one record of 12 bytes rather than three columns: a step around a vertex needs two of
/// the three fields of a row, and on meshes in random order the record saves the second cache miss
/// (when the two were compared, by a quarter of a one-ring sweep over 82,000 shuffled triangles).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Half {
    /// The next half along the face, or along the boundary loop.
    pub next: HalfEdgeId,
    /// The vertex where the half starts.
    pub origin: VertexId,
    /// The face on the left; none on a boundary loop.
    pub face: Slot<FaceId>,
}

impl Half {
    /// What both halves of a deleted edge hold: names that no row has.
    pub(crate) const DELETED: Self = Self {
        next: NO_HALF,
        origin: VertexId::new(u32::MAX),
        face: Slot::NONE,
    };

    /// Whether the half is one of a deleted edge.
    #[inline]
    pub(crate) fn is_deleted(&self) -> bool {
        self.origin == Self::DELETED.origin
    }
}

/// What `first` holds of a deleted face: the name of no half.
pub(crate) const NO_HALF: HalfEdgeId = HalfEdgeId::new(u32::MAX);

/// A mesh of directed edges in twin pairs.
///
/// ```text
///     c ◄───────── b
///     │   next(h)  ▲│
///     │            ││
///     │  face(h)  h││twin(h)
///     ▼            │▼
///     d ─────────► a
/// ```
///
/// # Invariants
///
/// - I1  `twin(h)` is `h ^ 1`; halves `2e` and `2e + 1` are edge `e`, and one of them has a face.
/// - I2  `next` is a permutation of the halves; its cycles are the faces and the boundary loops.
/// - I3  `face(next(h))` is `face(h)`; none on a boundary loop.
/// - I4  `origin(next(h))` is `origin(twin(h))`.
/// - I5  `leaving(v)` has origin `v`, and no face if `v` is on a boundary; none if `v` is isolated.
/// - I6  All halves with origin `v` are one cycle of `h → next(twin(h))`: every vertex is manifold.
/// - I7  `first(f)` has face `f`, and its cycle names at least three vertices, each once.
/// - I8  No two edges have the same ends.
/// - I9  The bits of a deleted vertex, edge or face are set, and no others. `leaving` of a deleted
///   vertex is none; both halves of a deleted edge and `first` of a deleted face hold names that no
///   row has. So a walk finds out by what it reads anyway that it was to start at what is deleted.
///
/// The other invariants are about what is not deleted, which never names what is.
///
/// # Memory
///
/// 12 bytes a vertex for its position and 4 for `leaving`, 24 an edge, 4 a face: 96 bytes, or 24
/// words, per vertex of a large closed triangle mesh. Once something is deleted, a bit for each
/// vertex, edge or face up to it.
#[derive(Debug)]
pub struct AnyHalfEdgeMesh<P: Probe, E: Editing> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) leaving: Table<Slot<HalfEdgeId>, P>,
    pub(crate) halves: Table<Half, P>,
    pub(crate) first: Table<HalfEdgeId, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) edge_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

mesh_core::clone_by_field!(AnyHalfEdgeMesh<P: Probe, E: Editing> { positions, leaving, halves, first, vertex_holes, edge_holes, face_holes });

/// A half-edge mesh of which nothing can be deleted: [`AnyHalfEdgeMesh`] whose rows are all elements.
pub type HalfEdgeMesh<P = Untraced> = AnyHalfEdgeMesh<P, Whole>;

/// A half-edge mesh that can be edited ([`MeshEdit`](mesh_core::MeshEdit)): [`AnyHalfEdgeMesh`] with holes.
pub type EditableHalfEdgeMesh<P = Untraced> = AnyHalfEdgeMesh<P, Editable>;

impl<P: Probe> From<HalfEdgeMesh<P>> for EditableHalfEdgeMesh<P> {
    fn from(mesh: HalfEdgeMesh<P>) -> Self {
        let probe = mesh.positions.probe();
        Self {
            positions: mesh.positions,
            leaving: mesh.leaving,
            halves: mesh.halves,
            first: mesh.first,
            vertex_holes: Editable::no_holes(VERTEX_HOLES, probe.clone()),
            edge_holes: Editable::no_holes(EDGE_HOLES, probe.clone()),
            face_holes: Editable::no_holes(FACE_HOLES, probe),
        }
    }
}

impl<E: Editing> AnyHalfEdgeMesh<Untraced, E> {
    /// A mesh of these tables, without holes.
    pub(crate) fn of_tables(
        positions: Vec<Point>,
        leaving: Vec<Slot<HalfEdgeId>>,
        halves: Vec<Half>,
        first: Vec<HalfEdgeId>,
    ) -> Self {
        Self {
            positions: Table::new("positions", "vertex", positions),
            leaving: Table::new("leaving", "vertex", leaving),
            halves: Table::new("halves", "half-edge", halves),
            first: Table::new("first", "face", first),
            vertex_holes: E::no_holes(VERTEX_HOLES, Untraced),
            edge_holes: E::no_holes(EDGE_HOLES, Untraced),
            face_holes: E::no_holes(FACE_HOLES, Untraced),
        }
    }
}

/// The classic operators. Each panics, and names the half-edge, if the mesh does not have it.
impl<P: Probe, E: Editing> AnyHalfEdgeMesh<P, E> {
    /// The next half along the face or the boundary loop; O(1).
    #[inline]
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.half(h).next
    }

    /// The half before `h`: its `next` is `h`; O(degree), on a boundary loop O(valence).
    pub fn prev(&self, h: HalfEdgeId) -> HalfEdgeId {
        // Along a boundary the loop may be long; around the vertex the way is short.
        let mut at = h;
        if self.is_boundary(h) {
            loop {
                let turned = self.follow(at.twin());
                if turned == h {
                    return at.twin();
                }
                at = turned;
            }
        }
        loop {
            let next = self.follow(at);
            if next == h {
                return at;
            }
            at = next;
        }
    }

    /// The half that runs the other way; O(1), and no table is read.
    #[inline]
    pub fn twin(&self, h: HalfEdgeId) -> HalfEdgeId {
        h.twin()
    }

    /// The vertex where `h` starts; O(1).
    #[inline]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.half(h).origin
    }

    /// The vertex where `h` ends; O(1).
    #[inline]
    pub fn target(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.twin())
    }

    /// The face on the left of `h`; none on a boundary loop; O(1).
    #[inline]
    pub fn face(&self, h: HalfEdgeId) -> Option<FaceId> {
        self.half(h).face.get()
    }

    /// The edge that `h` is a half of; O(1), and no table is read.
    #[inline]
    pub fn edge(&self, h: HalfEdgeId) -> EdgeId {
        h.edge()
    }

    /// The two halves of `e`; O(1), and no table is read.
    #[inline]
    pub fn halves_of(&self, e: EdgeId) -> [HalfEdgeId; 2] {
        let h = HalfEdgeId::new((e.index() as u32) << 1);
        [h, h.twin()]
    }

    /// A half that leaves `v`, the one on the boundary loop if there is one; none if `v` is
    /// isolated; O(1).
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[inline]
    pub fn half_leaving(&self, v: VertexId) -> Option<HalfEdgeId> {
        let leaving = self.leaving.read(v.index()).get();
        // Asked here: a cold function that may return made the VF sweep 6 % slower.
        if leaving.is_none() && self.vertex_holes.has(v.index()) {
            deleted(v);
        }
        leaving
    }

    /// A half that has `f` on its left; O(1).
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn half_along(&self, f: FaceId) -> HalfEdgeId {
        let first = *self.first.read(f.index());
        if E::DELETES && first == NO_HALF {
            deleted(f);
        }
        first
    }

    /// Whether `h` runs along a boundary loop, with no face on its left; O(1).
    #[inline]
    pub fn is_boundary(&self, h: HalfEdgeId) -> bool {
        self.face(h).is_none()
    }

    /// How many half-edges there are: two for each edge.
    #[inline]
    pub fn half_edge_count(&self) -> usize {
        self.halves.len() - 2 * self.edge_holes.len()
    }

    /// How many vertices, edges and faces were deleted since the mesh was last compacted; O(1).
    pub fn hole_count(&self) -> usize {
        self.vertex_holes.len() + self.edge_holes.len() + self.face_holes.len()
    }

    #[inline]
    fn half(&self, h: HalfEdgeId) -> &Half {
        let half = self.halves.read(h.index());
        if E::DELETES && half.is_deleted() {
            deleted(h);
        }
        half
    }

    /// `next(h)` of a half that is known to be there.
    #[inline]
    pub(crate) fn follow(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.halves.read(h.index()).next
    }
}

/// The panic of a query that was asked about a deleted element.
#[cold]
#[inline(never)]
pub(crate) fn deleted(handle: impl Debug) -> ! {
    panic!("{handle:?} was deleted")
}

/// The tables as they lie in memory, for export and for loops of one's own; what the rows of
/// deleted elements hold says I9.
impl<P: Probe, E: Editing> AnyHalfEdgeMesh<P, E> {
    /// Positions by vertex.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// A leaving half by vertex.
    pub fn leaving_rows(&self) -> &[Slot<HalfEdgeId>] {
        self.leaving.rows()
    }

    /// The records by half-edge.
    pub fn half_rows(&self) -> &[Half] {
        self.halves.rows()
    }

    /// A half by face.
    pub fn first_rows(&self) -> &[HalfEdgeId] {
        self.first.rows()
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{MeshQuery, PolygonMesh, Representation};

    use super::*;

    /// The cube of a lecture's half-edge table: faces, and where each half leads.
    fn cube() -> HalfEdgeMesh {
        let corners = [0, 1, 3, 2, 4, 5, 7, 6].map(|bits| {
            let axis = |bit: u32| (bits >> bit & 1) as f32;
            Point::new(axis(0), axis(1), axis(2))
        });
        let faces = [
            [0, 1, 2, 3],
            [1, 5, 6, 2],
            [4, 5, 1, 0],
            [7, 4, 0, 3],
            [2, 6, 7, 3],
            [5, 4, 7, 6],
        ];
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        HalfEdgeMesh::from_polygons(&polygons).expect("consistent")
    }

    #[test]
    fn the_operators_keep_their_laws() {
        let open = PolygonMesh::new(
            [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat),
            [&[0, 1, 2, 3][..], &[1, 0, 4]],
        );
        let open = HalfEdgeMesh::from_polygons(&open.expect("valid")).expect("manifold");
        for mesh in [cube(), open] {
            for h in (0..mesh.half_edge_count() as u32).map(HalfEdgeId::new) {
                assert_eq!(mesh.prev(mesh.next(h)), h);
                assert_eq!(mesh.next(mesh.prev(h)), h);
                assert_eq!(mesh.twin(mesh.twin(h)), h);
                assert_eq!(mesh.target(h), mesh.origin(mesh.next(h)));
                assert_eq!(mesh.face(h).is_none(), mesh.is_boundary(h));
                assert!(mesh.halves_of(mesh.edge(h)).contains(&h));
            }
            for v in mesh.vertices() {
                assert!(mesh.leaving(v).all(|h| mesh.origin(h) == v));
            }
            for f in mesh.faces() {
                assert!(mesh.around_face(f).all(|h| mesh.face(h) == Some(f)));
            }
        }
    }

    #[test]
    fn the_lecture_cube_has_its_table() {
        // (origin, target) of each half-edge of the notes, with the target of its next.
        let mesh = cube();
        let rows = [
            (0, 1, 2),
            (1, 2, 3),
            (2, 3, 0),
            (3, 0, 1),
            (4, 5, 1),
            (5, 1, 0),
            (1, 0, 4),
            (0, 4, 5),
        ];
        for (origin, target, then) in rows {
            let leaving = mesh.leaving(VertexId::new(origin));
            let h = leaving
                .into_iter()
                .find(|&h| mesh.target(h) == VertexId::new(target));
            let h = h.expect("an edge of the cube");
            assert_eq!(
                mesh.target(mesh.next(h)),
                VertexId::new(then),
                "v{origin}→v{target}"
            );
        }
    }

    #[test]
    #[should_panic(expected = "no vertex 8: table `leaving` has 8 rows")]
    fn a_vertex_that_is_not_there_panics_by_name() {
        let _ = cube().vertex_vertices(VertexId::new(8)).count();
    }

    #[test]
    #[should_panic(expected = "no half-edge 24: table `halves` has 24 rows")]
    fn a_half_edge_that_is_not_there_panics_by_name() {
        cube().next(HalfEdgeId::new(24));
    }
}

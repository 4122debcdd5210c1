//! Edits in place.
//!
//! Every edit changes one triangle, the two triangles at an edge, or the fan of a vertex. The
//! drawing names the corners and edges at an edge e:
//!
//! ```text
//!            C
//!           /c\              the edge e, A–B, is faced by c and, unless it is on the boundary, by o
//!          /   \             T  corners c at C, n = next(c) at A, p = prev(c) at B
//!    op   /  T  \   on       R  corners o at D, q = next(o) at B, r = prev(o) at A
//!        /       \
//!        /       \
//!       / n     p \          on is the opposite of n, and so on: on lies across B–C, op across
//!      A─────e─────B         C–A, oq across A–D, or across D–B.
//!       \ r     q /
//!        \       /
//!    oq   \  R  /   or
//!          \   /
//!           \o/
//!            D
//! ```
//!
//! The handle of an edge is the lower of the two corners that face the edge. So an edit that
//! changes one of the corners may change the handle of the edge. New triangles get the highest
//! rows, so no corner of another triangle moves to another row.

mod collapse;
mod compact;
mod faces;
mod flip;
mod split;
#[cfg(test)]
mod tests;

use sixfold_core::{
    Edit, EditError, EditLog, Editable, FaceId, HoleSet, MAX_CORNERS, MAX_ROWS, MeshEdit, Point,
    Probe, QueryCost, Representation, RowId, Slot, VertexId, check_fans_without, check_rows,
    faces_once, row,
};

use crate::EditableCornerTable;
use crate::mesh::{CornerId, CornerTable, EdgeCorner, NO_VERTEX, names_edge};

/// The error of an edit, without the type of the probe.
type Refusal = sixfold_core::Refusal<EditableCornerTable>;

impl<P: Probe> MeshEdit for CornerTable<Editable, P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = {
        let mut costs = Edit::LOCAL_COSTS;
        // These three edits make faces that are not triangles.
        costs[Edit::SplitEdge as usize] = None;
        costs[Edit::SplitFace as usize] = None;
        costs[Edit::DissolveEdge as usize] = None;
        costs
    };

    sixfold_core::compact_conversions!(CornerTable);

    /// O(1); writes one row of `positions`.
    #[inline]
    fn set_position_logged(
        &mut self,
        v: VertexId,
        to: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.check_vertex(v)?;
        *self.positions.write(v.index()) = to;
        Ok(v)
    }

    /// O(1) amortised.
    #[inline]
    fn add_vertex_logged(
        &mut self,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.check_room(1, 0)?;
        let v = self.push_vertex(at, Slot::NONE);
        log.created_vertex(v);
        Ok(v)
    }

    /// O(valence of the corners), amortised.
    fn add_face_logged(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        self.add_triangle(corners, log)
    }

    /// O(1).
    fn remove_face_logged(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        self.remove_triangle(f, log)
    }

    fn remove_faces_logged(
        &mut self,
        faces: &[FaceId],
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        let gone = faces_once(faces, |f| self.check_face(f))?;
        check_fans_without(self, &gone)?;
        self.remove_triangles(&gone, log);
        Ok(())
    }

    /// O(valence).
    fn remove_vertex_logged(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        self.remove_star(v, log)
    }

    /// O(vertices).
    fn remove_isolated_vertices_logged(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let is_isolated = |v| *self.corner.read(v) == Slot::NONE;
        let end = self.corner.len();
        self.vertex_holes
            .insert_unused(end, is_isolated, |v| log.removed_vertex(v))
    }

    /// Always returns an error: the edit makes faces that are not triangles.
    fn split_edge_logged(
        &mut self,
        _: EdgeCorner,
        _: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        Err(unsupported(Edit::SplitEdge))
    }

    /// O(1) amortised.
    fn bisect_edge_logged(
        &mut self,
        e: EdgeCorner,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.bisect(e, at, log)
    }

    /// O(1) amortised.
    #[inline]
    fn poke_face_logged(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.poke(f, at, log)
    }

    /// Always returns an error: the edit makes faces that are not triangles.
    fn split_face_logged(
        &mut self,
        _: FaceId,
        _: [VertexId; 2],
        _: &mut impl EditLog<Self>,
    ) -> Result<EdgeCorner, Refusal> {
        Err(unsupported(Edit::SplitFace))
    }

    /// Always returns an error: the edit makes faces that are not triangles.
    fn dissolve_edge_logged(
        &mut self,
        _: EdgeCorner,
        _: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        Err(unsupported(Edit::DissolveEdge))
    }

    /// O(valence of a third corner).
    #[inline]
    fn flip_edge_logged(
        &mut self,
        e: EdgeCorner,
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeCorner, Refusal> {
        self.flip(e, log)
    }

    /// O(valence of both ends).
    #[inline]
    fn collapse_edge_logged(
        &mut self,
        e: EdgeCorner,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.collapse(e, keep, to, log)
    }

    /// O(valence), amortised.
    fn split_vertex_logged(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.split_fan(v, [left, right], at, log)
    }

    fn compact_logged(&mut self, log: &mut impl EditLog<Self>) {
        self.compact_tables(log);
    }
}

#[cold]
fn unsupported(edit: Edit) -> Refusal {
    EditError::Unsupported {
        structure: EditableCornerTable::NAME,
        edit,
    }
}

/// Checks before an edit writes.
impl<P: Probe> CornerTable<Editable, P> {
    /// Returns the corner at `v` (empty if `v` is isolated), or an error if `v` does not exist.
    #[inline]
    fn check_vertex(&self, v: VertexId) -> Result<Slot<CornerId>, Refusal> {
        if v.index() < self.corner.len() {
            let corner = *self.corner.read(v.index());
            if corner != Slot::NONE || !self.vertex_holes.has(v.index()) {
                return Ok(corner);
            }
        }
        Err(EditError::NoSuchVertex { vertex: v })
    }

    #[inline]
    fn check_edge(&self, e: EdgeCorner) -> Result<Slot<CornerId>, Refusal> {
        if e.index() < self.opposite.len() {
            let across = *self.opposite.read(e.index());
            if names_edge(e.corner(), across) {
                return Ok(across);
            }
        }
        Err(EditError::NoSuchEdge { edge: e })
    }

    #[inline]
    fn check_face(&self, f: FaceId) -> Result<[VertexId; 3], Refusal> {
        let first = 3 * f.index();
        if first < self.vertex.len()
            && let &[a, b, c] = self.vertex.read_range(first..first + 3)
            && a != NO_VERTEX
        {
            return Ok([a, b, c]);
        }
        Err(EditError::NoSuchFace { face: f })
    }

    /// Checks that handles exist for this number of new vertices and triangles.
    #[inline]
    fn check_room(&self, vertices: usize, triangles: usize) -> Result<(), Refusal> {
        check_rows("vertices", self.positions.len() + vertices, MAX_ROWS)?;
        check_rows("corners", self.vertex.len() + 3 * triangles, MAX_CORNERS)
    }

    /// Returns whether `v` is on a boundary (I5). `v` must have a corner.
    #[inline]
    fn is_on_boundary(&self, v: VertexId) -> bool {
        let first = self.corner.read(v.index()).get();
        first.is_some_and(|first| *self.opposite.read(first.prev().index()) == Slot::NONE)
    }
}

/// Steps that several edits share.
impl<P: Probe> CornerTable<Editable, P> {
    #[inline]
    fn push_vertex(&mut self, at: Point, corner: Slot<CornerId>) -> VertexId {
        let v = VertexId::new(row(self.positions.len()));
        self.positions.push(at);
        self.corner.push(corner);
        v
    }

    /// Returns the corners of the `i`-th triangle from now on.
    #[inline]
    fn new_corners(&self, i: u32) -> [CornerId; 3] {
        let first = row(self.vertex.len()) + 3 * i;
        [first, first + 1, first + 2].map(CornerId::new)
    }

    #[inline]
    fn push_triangle(&mut self, vertices: [VertexId; 3], opposites: [Slot<CornerId>; 3]) {
        self.vertex.extend(vertices);
        self.opposite.extend(opposites);
    }

    /// Sets the opposite of `across` to `c`, but not the opposite of `c`.
    #[inline]
    fn set_opposite(&mut self, across: Slot<CornerId>, c: Slot<CornerId>) {
        if let Some(across) = across.get() {
            *self.opposite.write(across.index()) = c;
        }
    }

    #[inline]
    fn replace_corner(&mut self, v: VertexId, old: CornerId, new: CornerId) {
        if *self.corner.read(v.index()) == Slot::some(old) {
            *self.corner.write(v.index()) = Slot::some(new);
        }
    }

    /// Marks `f` as deleted (I8). No other corner may be opposite to a corner of `f`.
    #[inline]
    fn delete_triangle(&mut self, f: FaceId) {
        let first = 3 * f.row();
        for c in [first, first + 1, first + 2].map(CornerId::new) {
            *self.vertex.write(c.index()) = NO_VERTEX;
            *self.opposite.write(c.index()) = Slot::some(c);
        }
        self.face_holes.insert(f.index());
    }

    /// Deletes `v`. No triangle may have a corner at `v`.
    #[inline]
    fn delete_vertex(&mut self, v: VertexId) {
        *self.corner.write(v.index()) = Slot::NONE;
        self.vertex_holes.insert(v.index());
    }
}

/// Returns the edge that `c` faces, if `c` is the lower of the two corners.
#[inline]
fn faced_by(c: CornerId) -> EdgeCorner {
    EdgeCorner::new(c.row())
}

/// Reports a change of an edge handle to the log.
#[inline]
fn report_renamed<P: Probe>(
    log: &mut impl EditLog<CornerTable<Editable, P>>,
    old: EdgeCorner,
    new: EdgeCorner,
) {
    if old != new {
        log.renamed_edge(old, new);
    }
}

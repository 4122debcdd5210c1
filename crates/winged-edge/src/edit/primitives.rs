//! Steps that several edits share: checks of handles, runs, links, new rows and holes.

use sixfold_core::{
    EdgeId, EditError, EditLog, Editable, FaceId, HoleSet, MAX_EDGES, MAX_ROWS, Point, Probe,
    Refusal, Slot, VertexId, check_rows, row,
};

use crate::edge::{Edge, NO_EDGE, Run, RunId};
use crate::mesh::WingedEdgeMesh;
use crate::wings::Side;

/// Checks that elements exist and that there is room for new elements.
impl<P: Probe> WingedEdgeMesh<Editable, P> {
    #[inline(always)]
    pub(super) fn check_vertex(&self, vertex: VertexId) -> Result<(), Refusal<Self>> {
        let v = vertex.index();
        if v >= self.positions.len() || self.vertex_holes.has(v) {
            return Err(EditError::NoSuchVertex { vertex });
        }
        Ok(())
    }

    #[inline(always)]
    pub(super) fn check_edge(&self, edge: EdgeId) -> Result<&Edge, Refusal<Self>> {
        if edge.index() < self.edges.len() {
            let record = self.record(edge);
            if !record.is_deleted() {
                return Ok(record);
            }
        }
        Err(EditError::NoSuchEdge { edge })
    }

    #[inline(always)]
    pub(super) fn check_face(&self, face: FaceId) -> Result<EdgeId, Refusal<Self>> {
        if face.index() < self.sides.len() {
            let side = *self.sides.read(face.index());
            if side != NO_EDGE {
                return Ok(side);
            }
        }
        Err(EditError::NoSuchFace { face })
    }

    /// Checks that this number of vertices, edges and faces can be added.
    #[inline(always)]
    pub(super) fn check_room(&self, more: [usize; 3]) -> Result<(), Refusal<Self>> {
        let [vertices, edges, faces] = more;
        check_rows("vertices", self.positions.len() + vertices, MAX_ROWS)?;
        check_rows("edges", self.edges.len() + edges, MAX_EDGES)?;
        check_rows("faces", self.sides.len() + faces, MAX_ROWS)
    }
}

/// Functions of runs, each O(1) if faces are triangles.
impl<P: Probe> WingedEdgeMesh<Editable, P> {
    #[inline(always)]
    pub(super) fn run(&self, run: RunId) -> Run<'_> {
        Run::new(self.record(run.edge), run.side)
    }

    /// Returns the run of `edge` that leaves `v`.
    #[inline(always)]
    pub(super) fn leaving(&self, edge: EdgeId, v: VertexId) -> RunId {
        RunId::new(edge, Run::from(self.record(edge), v).side())
    }

    /// Returns the run of `edge` that arrives at `v`.
    #[inline(always)]
    pub(super) fn arriving(&self, edge: EdgeId, v: VertexId) -> RunId {
        self.leaving(edge, v).twin()
    }

    /// Returns the run of `edge` with `f` on its left.
    #[inline(always)]
    pub(super) fn along(&self, edge: EdgeId, f: FaceId) -> RunId {
        RunId::new(edge, Run::along(self.record(edge), f).side())
    }

    #[inline(always)]
    pub(super) fn run_after(&self, run: RunId) -> RunId {
        let run = self.run(run);
        self.leaving(run.next(), run.target())
    }

    #[inline(always)]
    pub(super) fn run_before(&self, run: RunId) -> RunId {
        let run = self.run(run);
        self.arriving(run.prev(), run.origin())
    }

    /// Returns the third corner of the triangle on the left of `run`. If the face is not a
    /// triangle, returns the degree as an error.
    pub(super) fn apex(&self, run: RunId) -> Result<VertexId, usize> {
        let [next, prev] = [self.run(run).next(), self.run(run).prev()];
        let after = self.run(self.run_after(run));
        if after.next() == prev {
            return Ok(after.target());
        }
        let mut at = self.leaving(next, self.run(run).target());
        let mut degree = 1;
        while at != run {
            at = self.run_after(at);
            degree += 1;
        }
        Err(degree)
    }
}

/// Writes to single fields.
impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Makes `after` follow `before`.
    #[inline(always)]
    pub(super) fn link(&mut self, before: RunId, after: RunId) {
        let record = self.edges.write(before.edge.index());
        record.next.set(before.side, after.edge);
        let record = self.edges.write(after.edge.index());
        record.prev.set(after.side, before.edge);
    }

    #[inline(always)]
    pub(super) fn set_face(&mut self, run: RunId, face: Slot<FaceId>) {
        self.edges.write(run.edge.index()).faces[run.side.index()] = face;
    }

    #[inline(always)]
    pub(super) fn set_links(&mut self, run: RunId, face: Slot<FaceId>, next: EdgeId, prev: EdgeId) {
        let record = self.edges.write(run.edge.index());
        record.faces[run.side.index()] = face;
        record.next.set(run.side, next);
        record.prev.set(run.side, prev);
    }

    #[inline(always)]
    pub(super) fn set_end(&mut self, edge: EdgeId, old: VertexId, new: VertexId) {
        let ends = &mut self.edges.write(edge.index()).ends;
        ends[usize::from(ends[0] != old)] = new;
    }

    #[inline(always)]
    pub(super) fn set_spoke(&mut self, v: VertexId, spoke: EdgeId) {
        *self.spokes.write(v.index()) = Slot::some(spoke);
    }

    /// Makes `other` the spoke of `v` if the spoke was `gone`.
    #[inline(always)]
    pub(super) fn replace_spoke(&mut self, v: VertexId, gone: EdgeId, other: EdgeId) {
        if *self.spokes.read(v.index()) == Slot::some(gone) {
            self.set_spoke(v, other);
        }
    }

    #[inline(always)]
    pub(super) fn set_side(&mut self, f: FaceId, side: EdgeId) {
        *self.sides.write(f.index()) = side;
    }
}

/// New rows and holes. The caller checks that there is room.
impl<P: Probe> WingedEdgeMesh<Editable, P> {
    #[inline(always)]
    pub(super) fn push_vertex(&mut self, at: Point, log: &mut impl EditLog<Self>) -> VertexId {
        let v = VertexId::new(row(self.positions.len()));
        self.positions.push(at);
        self.spokes.push(Slot::NONE);
        log.created_vertex(v);
        v
    }

    #[inline(always)]
    pub(super) fn push_edge(&mut self, edge: Edge, log: &mut impl EditLog<Self>) -> EdgeId {
        let e = self.next_edge();
        self.edges.push(edge);
        log.created_edge(e);
        e
    }

    #[inline(always)]
    pub(super) fn next_edge(&self) -> EdgeId {
        EdgeId::new(row(self.edges.len()))
    }

    #[inline(always)]
    pub(super) fn push_face(&mut self, side: EdgeId, log: &mut impl EditLog<Self>) -> FaceId {
        let f = FaceId::new(row(self.sides.len()));
        self.sides.push(side);
        log.created_face(f);
        f
    }

    #[inline(always)]
    pub(super) fn delete_vertex(&mut self, v: VertexId, log: &mut impl EditLog<Self>) {
        *self.spokes.write(v.index()) = Slot::NONE;
        self.vertex_holes.insert(v.index());
        log.removed_vertex(v);
    }

    #[inline(always)]
    pub(super) fn delete_edge(&mut self, e: EdgeId, log: &mut impl EditLog<Self>) {
        *self.edges.write(e.index()) = Edge::DELETED;
        self.edge_holes.insert(e.index());
        log.removed_edge(e);
    }

    #[inline(always)]
    pub(super) fn delete_face(&mut self, f: FaceId, log: &mut impl EditLog<Self>) {
        *self.sides.write(f.index()) = NO_EDGE;
        self.face_holes.insert(f.index());
        log.removed_face(f);
    }
}

/// Steps for boundaries and polygons.
impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Returns the run without a face that arrives at `v`, if `v` is on a boundary.
    #[inline(always)]
    pub(super) fn boundary_into(&self, v: VertexId) -> Option<RunId> {
        let spoke = self.spokes.read(v.index()).get()?;
        let run = Run::from(self.record(spoke), v);
        (run.across() == Slot::NONE).then(|| RunId::new(spoke, run.side()).twin())
    }

    #[cold]
    pub(super) fn not_a_triangle(face: Slot<FaceId>, degree: usize) -> Refusal<Self> {
        let face = face.get().expect("a run with a face");
        EditError::NotATriangle { face, degree }
    }
}

/// Builds the record of an edge. `left` and `right` each have a face, the next wing and the
/// previous wing.
#[inline(always)]
pub(super) fn edge_record(
    ends: [VertexId; 2],
    left: (Slot<FaceId>, EdgeId, EdgeId),
    right: (Slot<FaceId>, EdgeId, EdgeId),
) -> Edge {
    use crate::wings::Wings;
    Edge {
        ends,
        faces: [left.0, right.0],
        next: Wings::new([left.1, right.1]),
        prev: Wings::new([left.2, right.2]),
    }
}

/// Returns the left run and the right run of `edge`.
#[inline(always)]
pub(super) fn runs_of(edge: EdgeId) -> [RunId; 2] {
    [RunId::new(edge, Side::LEFT), RunId::new(edge, Side::RIGHT)]
}

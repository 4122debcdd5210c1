//! Steps from side to side: a side is an edge in the direction of its left face or of its right
//! face.

use sixfold_core::{
    EdgeId, Editing, FaceId, HandleMap, IteratorExt, OrientedWalk, Probe, RowId, SideMap, Slot,
    VertexId, row_id,
};

use crate::edge::Run;
use crate::mesh::WingedEdgeMesh;
use crate::wings::Side;

row_id! {
    /// The handle of one side of an edge, printed as `s7`. Edge `e` has the left side `2e` and the
    /// right side `2e + 1`.
    pub struct EdgeSide, "s"
}

impl EdgeSide {
    /// Returns the edge of this side.
    #[inline]
    pub const fn edge(self) -> EdgeId {
        EdgeId::new(self.index() as u32 >> 1)
    }

    /// Returns the other side of the edge.
    #[inline]
    const fn other(self) -> Self {
        Self::new(self.index() as u32 ^ 1)
    }

    #[inline]
    fn from_edge(e: EdgeId, side: Side) -> Self {
        Self::new(e.row() << 1 | u32::from(side.is_right()))
    }

    #[inline]
    fn side(self) -> Side {
        Side::right_if(self.index() & 1 == 1)
    }
}

/// Every step is O(1). A step with `next_side` or `prev_side` reads two edge records, because the
/// side of the next edge must be determined.
impl<P: Probe, E: Editing> OrientedWalk for WingedEdgeMesh<E, P> {
    type Side = EdgeSide;

    #[inline]
    fn face_sides(&self, f: FaceId) -> impl Iterator<Item = EdgeSide> {
        self.runs_along(f)
            .map_inline(|(e, run)| EdgeSide::from_edge(e, run.side()))
    }

    #[inline]
    fn edge_sides(&self, e: EdgeId) -> impl Iterator<Item = EdgeSide> {
        let [left, right] = self.edge(e).faces;
        let sides = [(Side::LEFT, left), (Side::RIGHT, right)].into_iter();
        sides.filter_map(move |(side, face)| face.get().map(|_| EdgeSide::from_edge(e, side)))
    }

    /// Yields the sides that start at `v`, counter-clockwise. At a boundary vertex, the first side
    /// belongs to a face at the boundary.
    #[inline]
    fn outgoing_sides(&self, v: VertexId) -> impl Iterator<Item = EdgeSide> {
        let runs = self.runs_from(v);
        runs.filter_map(|(e, run)| run.face().get().map(|_| EdgeSide::from_edge(e, run.side())))
    }

    #[inline]
    fn next_side(&self, s: EdgeSide) -> EdgeSide {
        let run = self.run_of(s);
        self.side_along(run.next(), run.face())
    }

    #[inline]
    fn prev_side(&self, s: EdgeSide) -> EdgeSide {
        let run = self.run_of(s);
        self.side_along(run.prev(), run.face())
    }

    #[inline]
    fn twin_side(&self, s: EdgeSide) -> Option<EdgeSide> {
        self.run_of(s).across().get().map(|_| s.other())
    }

    #[inline]
    fn side_origin(&self, s: EdgeSide) -> VertexId {
        self.run_of(s).origin()
    }

    #[inline]
    fn side_target(&self, s: EdgeSide) -> VertexId {
        self.run_of(s).target()
    }

    #[inline]
    fn side_face(&self, s: EdgeSide) -> FaceId {
        let face = self.run_of(s).face().get();
        face.unwrap_or_else(|| no_such_side(s))
    }

    #[inline]
    fn side_edge(&self, s: EdgeSide) -> EdgeId {
        if E::CAN_DELETE {
            self.run_of(s);
        }
        s.edge()
    }

    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        HandleMap::filled(2 * self.edges.len(), value)
    }
}

impl<P: Probe, E: Editing> WingedEdgeMesh<E, P> {
    /// Returns the run along `s`. In an editable mesh, panics if the side has no face.
    #[inline]
    fn run_of(&self, s: EdgeSide) -> Run<'_> {
        let run = Run::new(self.record(s.edge()), s.side());
        if E::CAN_DELETE && run.face() == Slot::NONE {
            no_such_side(s);
        }
        run
    }

    /// Returns the side of `e` with this face, or the right side if no side has this face.
    #[inline]
    fn side_along(&self, e: EdgeId, face: Slot<FaceId>) -> EdgeSide {
        let is_right = self.record(e).faces[0] != face;
        EdgeSide::from_edge(e, Side::right_if(is_right))
    }
}

#[cold]
#[inline(never)]
fn no_such_side(s: EdgeSide) -> ! {
    panic!("no side {s}: that side of {} has no face", s.edge())
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshEdit, Representation};

    use super::*;
    use crate::{EditableWingedEdgeMesh, WingedEdgeMesh};

    #[test]
    #[should_panic(expected = "has no face")]
    fn a_side_that_lost_its_face_panics() {
        let polygons = sixfold_shapes::triangle_grid(1, 1).expect("a valid size");
        let mesh = WingedEdgeMesh::from_polygons(&polygons).expect("manifold");
        let mut mesh: EditableWingedEdgeMesh = mesh.into();
        let inner = mesh.sides().find(|&s| mesh.twin_side(s).is_some());
        let s = inner.expect("the diagonal");
        let f = mesh.side_face(s);
        mesh.remove_face(f).expect("a face at the boundary");
        mesh.twin_side(s);
    }
}

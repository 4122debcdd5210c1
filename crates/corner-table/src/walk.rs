//! The walk from side to side: the corner where a side starts names the side.

use sixfold_core::{
    Editing, FaceId, HandleMap, IteratorExt, OrientedWalk, Probe, SideMap, VertexId,
};

use crate::mesh::{CornerId, CornerTable, EdgeCorner, NO_VERTEX};

/// The corner where a side starts is the handle of the side. Side `c` runs from `vertex(c)` to
/// `vertex(next(c))`. The corner `prev(c)` faces side `c`.
///
/// Every method takes O(1) time, or O(1) time for each item. The steps along a face and `side_face`
/// read no table. `ccw_side` is [`swing`](CornerTable::swing), and `cw_side` is
/// [`unswing`](CornerTable::unswing).
impl<P: Probe, E: Editing> OrientedWalk for CornerTable<E, P> {
    type Side = CornerId;

    #[inline]
    fn face_sides(&self, f: FaceId) -> impl Iterator<Item = CornerId> {
        self.corners_of(f).into_iter()
    }

    #[inline]
    fn edge_sides(&self, e: EdgeCorner) -> impl Iterator<Item = CornerId> {
        let facing = [Some(e.corner()), self.across(e).get()];
        facing.into_iter().flatten().map_inline(CornerId::next)
    }

    /// Yields the sides counter-clockwise. At a boundary vertex, the first side runs along a
    /// boundary edge.
    #[inline]
    fn outgoing_sides(&self, v: VertexId) -> impl Iterator<Item = CornerId> {
        self.corners_at(v)
    }

    #[inline]
    fn next_side(&self, s: CornerId) -> CornerId {
        s.next()
    }

    #[inline]
    fn prev_side(&self, s: CornerId) -> CornerId {
        s.prev()
    }

    #[inline]
    fn twin_side(&self, s: CornerId) -> Option<CornerId> {
        self.left(s).map(CornerId::next)
    }

    #[inline]
    fn side_origin(&self, s: CornerId) -> VertexId {
        let origin = self.vertex(s);
        if E::CAN_DELETE && origin == NO_VERTEX {
            no_such_side(s);
        }
        origin
    }

    #[inline]
    fn side_face(&self, s: CornerId) -> FaceId {
        s.triangle()
    }

    #[inline]
    fn side_edge(&self, s: CornerId) -> EdgeCorner {
        self.edge(s.prev())
    }

    #[inline]
    fn ccw_side(&self, s: CornerId) -> Option<CornerId> {
        self.swing(s)
    }

    #[inline]
    fn cw_side(&self, s: CornerId) -> Option<CornerId> {
        self.unswing(s)
    }

    #[inline]
    fn side_count(&self) -> usize {
        self.corner_count()
    }

    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        HandleMap::filled(self.vertex.len(), value)
    }
}

#[cold]
#[inline(never)]
fn no_such_side(s: CornerId) -> ! {
    panic!("no side {s}: the triangle of that corner was deleted")
}

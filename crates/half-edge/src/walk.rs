//! Steps from side to side: a side is a half-edge that has a face.

use sixfold_core::{
    EdgeId, Editing, FaceId, HandleMap, IteratorExt, OrientedWalk, Probe, SideMap, Slot, VertexId,
};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

/// A side is a half-edge with a face on its left.
///
/// A step with `prev_side` or `ccw_side` takes O(degree), because `prev` is not stored. All steps
/// except `prev_side` and `ccw_side` take O(1).
///
/// No method returns a half-edge on a boundary loop, because such a half-edge is not a side. At a
/// boundary edge, `twin_side` returns `None`, but [`twin`](HalfEdgeMesh::twin) returns the
/// half-edge on the boundary loop.
impl<P: Probe, E: Editing> OrientedWalk for HalfEdgeMesh<E, P> {
    type Side = HalfEdgeId;

    #[inline]
    fn face_sides(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> {
        self.around_face(f)
    }

    #[inline]
    fn edge_sides(&self, e: EdgeId) -> impl Iterator<Item = HalfEdgeId> {
        let halves = self.edge_half_edges(e).into_iter().zip(self.pair(e));
        halves.filter_map(|(h, half)| half.face.get().map(|_| h))
    }

    /// Yields the sides that start at `v`, clockwise. At a boundary vertex, the first side belongs
    /// to a face at the boundary.
    #[inline]
    fn outgoing_sides(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> {
        // Each face at v has one half-edge that arrives at v; the next half-edge leaves v.
        let arriving = self.spokes(v).map_inline(|(_, twin)| twin);
        arriving.filter_map(|half| half.face.get().map(|_| half.next))
    }

    #[inline]
    fn next_side(&self, s: HalfEdgeId) -> HalfEdgeId {
        self.side(s).next
    }

    #[inline]
    fn prev_side(&self, s: HalfEdgeId) -> HalfEdgeId {
        self.prev(s)
    }

    #[inline]
    fn twin_side(&self, s: HalfEdgeId) -> Option<HalfEdgeId> {
        self.check_side(s);
        let twin = s.twin();
        self.halves.read(twin.index()).face.get().map(|_| twin)
    }

    #[inline]
    fn side_origin(&self, s: HalfEdgeId) -> VertexId {
        self.side(s).origin
    }

    #[inline]
    fn side_target(&self, s: HalfEdgeId) -> VertexId {
        self.check_side(s);
        self.halves.read(s.twin().index()).origin
    }

    #[inline]
    fn side_face(&self, s: HalfEdgeId) -> FaceId {
        let face = self.halves.read(s.index()).face.get();
        face.unwrap_or_else(|| no_such_side(s))
    }

    #[inline]
    fn side_edge(&self, s: HalfEdgeId) -> EdgeId {
        self.check_side(s);
        s.edge()
    }

    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        HandleMap::filled(self.halves.len(), value)
    }
}

impl<P: Probe, E: Editing> HalfEdgeMesh<E, P> {
    /// Returns the record of `s`. In an editable mesh, panics if `s` has no face.
    #[inline]
    fn side(&self, s: HalfEdgeId) -> &Half {
        let half = self.halves.read(s.index());
        if E::CAN_DELETE && half.face == Slot::NONE {
            no_such_side(s);
        }
        half
    }

    /// Panics in the same case as `side`.
    #[inline]
    fn check_side(&self, s: HalfEdgeId) {
        if E::CAN_DELETE {
            self.side(s);
        }
    }
}

#[cold]
#[inline(never)]
fn no_such_side(s: HalfEdgeId) -> ! {
    panic!("no side {s}: the half-edge has no face")
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshEdit, Representation};

    use super::*;
    use crate::{EditableHalfEdgeMesh, HalfEdgeMesh};

    fn square() -> HalfEdgeMesh {
        let polygons = sixfold_shapes::triangle_grid(1, 1).expect("a valid size");
        HalfEdgeMesh::from_polygons(&polygons).expect("manifold")
    }

    #[test]
    fn half_edges_of_the_boundary_are_not_sides() {
        let mesh = square();
        assert_eq!((mesh.half_edge_count(), mesh.side_count()), (10, 6));
        assert!(OrientedWalk::sides(&mesh).all(|s| !mesh.is_boundary(s)));
        let inner = OrientedWalk::sides(&mesh).filter(|&s| mesh.twin_side(s).is_some());
        assert_eq!(inner.count(), 2);
    }

    #[test]
    #[should_panic(expected = "the half-edge has no face")]
    fn a_half_edge_that_lost_its_face_panics() {
        let mut mesh: EditableHalfEdgeMesh = square().into();
        let inner = OrientedWalk::sides(&mesh).find(|&s| mesh.twin_side(s).is_some());
        let s = inner.expect("the diagonal");
        let f = mesh.side_face(s);
        mesh.remove_face(f).expect("a face at the boundary");
        mesh.twin_side(s);
    }
}

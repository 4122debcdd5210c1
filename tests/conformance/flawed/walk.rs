//! The flaws of steps from side to side.

use sixfold_core::{EdgeId, FaceId, MeshQuery, OrientedWalk, Probe, SideMap, Untraced, VertexId};

use super::items::Items;
use super::{Flaw, FlawKind, Flawed};
use crate::face_and_edge_lists::FaceAndEdgeLists;

type Side = <FaceAndEdgeLists<Untraced> as OrientedWalk>::Side;

impl<F: Flaw, P: Probe> OrientedWalk for Flawed<F, P> {
    type Side = Side;

    fn face_sides(&self, f: FaceId) -> impl Iterator<Item = Side> {
        let mut sides: Vec<_> = self.inner.face_sides(f).collect();
        if self.is(FlawKind::SidesReversed) {
            sides.reverse();
        }
        self.with_duplicate(FlawKind::SideTwiceInItsFace, sides)
    }

    fn edge_sides(&self, e: EdgeId) -> impl Iterator<Item = Side> {
        let sides = self.inner.edge_sides(e).collect();
        self.without_last(FlawKind::SideOfAnEdgeLeftOut, sides)
            .into_iter()
    }

    fn outgoing_sides(&self, v: VertexId) -> impl Iterator<Item = Side> {
        let mut sides: Vec<_> = self.inner.outgoing_sides(v).collect();
        if self.is(FlawKind::IncomingSides) {
            sides = sides.into_iter().map(|s| self.prev_side(s)).collect();
        }
        let sides = self.without_last(FlawKind::OutgoingSideLeftOut, sides);
        Items::<F, _>::new(sides.into_iter())
    }

    fn next_side(&self, s: Side) -> Side {
        let next = self.inner.next_side(s);
        if self.is(FlawKind::NextSideSkipsOne) {
            self.inner.next_side(next)
        } else {
            next
        }
    }

    fn prev_side(&self, s: Side) -> Side {
        if self.is(FlawKind::PrevSideIsNext) {
            self.inner.next_side(s)
        } else {
            self.inner.prev_side(s)
        }
    }

    fn twin_side(&self, s: Side) -> Option<Side> {
        let twin = self.inner.twin_side(s);
        let mut others = self.inner.edge_sides(self.inner.side_edge(s));
        let target = self.inner.side_target(s);
        match F::KIND {
            FlawKind::TwinOfABoundarySide => twin.or(Some(s)),
            FlawKind::TwinAmongSeveral => {
                others.find(|&other| self.inner.side_origin(other) == target)
            }
            FlawKind::TwinOfTheSameDirection => {
                let two = self.inner.edge_sides(self.inner.side_edge(s)).count() == 2;
                others.find(|&other| two && other != s)
            }
            FlawKind::NoTwin => None,
            _ => twin,
        }
    }

    fn side_origin(&self, s: Side) -> VertexId {
        let exists = self.inner.contains_face(self.inner.side_face(s));
        if self.is(FlawKind::MissingSideStartsAtV0) && !exists {
            return VertexId::new(0);
        }
        self.inner.side_origin(s)
    }

    fn side_target(&self, s: Side) -> VertexId {
        if self.is(FlawKind::TargetIsTheOrigin) {
            self.inner.side_origin(s)
        } else {
            self.inner.side_target(s)
        }
    }

    fn side_face(&self, s: Side) -> FaceId {
        if self.is(FlawKind::FaceOfTheTwin) {
            let twin = self.inner.twin_side(s).unwrap_or(s);
            return self.inner.side_face(twin);
        }
        self.inner.side_face(s)
    }

    fn side_edge(&self, s: Side) -> EdgeId {
        if self.is(FlawKind::EdgeOfTheNextSide) {
            return self.inner.side_edge(self.inner.next_side(s));
        }
        self.inner.side_edge(s)
    }

    fn ccw_side(&self, s: Side) -> Option<Side> {
        match F::KIND {
            FlawKind::TurnsReversed => self.inner.cw_side(s),
            _ => self.inner.ccw_side(s),
        }
    }

    fn cw_side(&self, s: Side) -> Option<Side> {
        match F::KIND {
            FlawKind::TurnsReversed => self.inner.ccw_side(s),
            _ => self.inner.cw_side(s),
        }
    }

    fn side_count(&self) -> usize {
        self.inner.side_count() + usize::from(self.is(FlawKind::SideCountOff))
    }

    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        self.inner.side_map(value)
    }
}

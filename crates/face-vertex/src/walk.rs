//! The walk from side to side: a side is a face and the corner where it starts.

use std::fmt;
use std::ops::{Index, IndexMut, Range};

use sixfold_core::{
    Editing, FaceId, Handle, HandleMap, IteratorExt, OrientedWalk, Pair, Probe, RowMap, SideMap,
    VertexId, row, row_id,
};

use crate::mesh::{BLANK_CORNER, FaceVertexMesh, deleted_face};

row_id! {
    /// The row of a corner in the table of corners.
    struct CornerId, "c"
}

/// The handle of one side, printed as `f3c10`: the face 3, and the row 10 of the corner where the
/// side starts. The row is a row of [`corners`](FaceVertexMesh::corners).
///
/// The handle contains the face, to avoid a search for the face of the corner.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceSide {
    face: FaceId,
    corner: CornerId,
}

impl FaceSide {
    /// Returns the side of `face` that starts at the row `corner`.
    #[inline]
    fn new(face: FaceId, corner: usize) -> Self {
        let corner = CornerId::new(row(corner));
        Self { face, corner }
    }

    /// Returns the face that runs along this side.
    #[inline]
    pub const fn face(self) -> FaceId {
        self.face
    }

    /// Returns the row of the corner where this side starts.
    #[inline]
    pub const fn corner(self) -> usize {
        self.corner.index()
    }
}

impl fmt::Debug for FaceSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.face, self.corner)
    }
}

impl Handle for FaceSide {
    type Map<T: Clone> = CornerMap<T>;
}

/// A value for each side, stored by the row of the corner where the side starts.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerMap<T>(RowMap<CornerId, T>);

impl<T: Clone> HandleMap<FaceSide, T> for CornerMap<T> {
    fn filled(rows: usize, value: T) -> Self {
        Self(RowMap::filled(rows, value))
    }

    #[inline]
    fn insert(&mut self, side: FaceSide, value: T) {
        self.0.insert(side.corner, value);
    }

    #[inline]
    fn remove(&mut self, side: FaceSide) {
        self.0.remove(side.corner);
    }
}

impl<T> Index<FaceSide> for CornerMap<T> {
    type Output = T;

    #[inline]
    #[track_caller]
    fn index(&self, side: FaceSide) -> &T {
        &self.0[side.corner]
    }
}

impl<T> IndexMut<FaceSide> for CornerMap<T> {
    #[inline]
    #[track_caller]
    fn index_mut(&mut self, side: FaceSide) -> &mut T {
        &mut self.0[side.corner]
    }
}

/// The steps along a face take O(1) time. Twins are not stored. Therefore `twin_side`, `cw_side`,
/// `ccw_side` and `edge_sides` search the faces at the end of the edge that has fewer faces. Each
/// search takes O(length · degree) time, for an end with `length` faces. `outgoing_sides` takes
/// O(degree) time for each side.
impl<P: Probe, E: Editing> OrientedWalk for FaceVertexMesh<E, P> {
    type Side = FaceSide;

    #[inline]
    fn face_sides(&self, f: FaceId) -> impl Iterator<Item = FaceSide> {
        self.range_of(f)
            .map_inline(move |corner| FaceSide::new(f, corner))
    }

    #[inline]
    fn edge_sides(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceSide> {
        let [a, b] = e.ends();
        self.faces_along(e).map_inline(move |f| {
            let leaving = self.side_from(f, a);
            if self.side_target(leaving) == b {
                leaving
            } else {
                self.prev_side(leaving)
            }
        })
    }

    /// Yields the sides of `v` in the order in which the faces of `v` are stored.
    #[inline]
    fn outgoing_sides(&self, v: VertexId) -> impl Iterator<Item = FaceSide> {
        let fan = self.fan(v).iter();
        fan.map_inline(move |&f| self.side_from(f, v))
    }

    #[inline]
    fn next_side(&self, s: FaceSide) -> FaceSide {
        let range = self.spans.range(s.face);
        let next = s.corner() + 1;
        FaceSide::new(s.face, if next == range.end { range.start } else { next })
    }

    #[inline]
    fn prev_side(&self, s: FaceSide) -> FaceSide {
        let range = self.spans.range(s.face);
        let after = if s.corner() == range.start {
            range.end
        } else {
            s.corner()
        };
        FaceSide::new(s.face, after - 1)
    }

    #[inline]
    fn twin_side(&self, s: FaceSide) -> Option<FaceSide> {
        let [origin, target] = [self.side_origin(s), self.side_target(s)];
        let mut others = self
            .faces_along(Pair::new(origin, target))
            .filter(|&f| f != s.face);
        let (Some(other), None) = (others.next(), others.next()) else {
            return None;
        };
        let twin = self.side_from(other, target);
        (self.side_target(twin) == origin).then_some(twin)
    }

    #[inline]
    fn side_origin(&self, s: FaceSide) -> VertexId {
        let origin = *self.corners.read(s.corner());
        if E::CAN_DELETE && origin == BLANK_CORNER {
            deleted_face(s.face);
        }
        origin
    }

    #[inline]
    fn side_face(&self, s: FaceSide) -> FaceId {
        s.face
    }

    #[inline]
    fn side_edge(&self, s: FaceSide) -> Pair<VertexId> {
        Pair::new(self.side_origin(s), self.side_target(s))
    }

    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        HandleMap::filled(self.corners.len(), value)
    }
}

impl<P: Probe, E: Editing> FaceVertexMesh<E, P> {
    #[inline]
    fn range_of(&self, f: FaceId) -> Range<usize> {
        let range = self.spans.range(f);
        if E::CAN_DELETE && *self.corners.read(range.start) == BLANK_CORNER {
            deleted_face(f);
        }
        range
    }

    /// Returns the side of `f` that starts at `v`. `v` must be a corner of `f`.
    #[inline]
    fn side_from(&self, f: FaceId, v: VertexId) -> FaceSide {
        let range = self.spans.range(f);
        let mut corners = self.corners.read_range(range.clone()).iter();
        let at = corners.position(|&corner| corner == v);
        let at = at.expect("I3: a face in the fan of a vertex contains it");
        FaceSide::new(f, range.start + at)
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};

    use super::*;
    use crate::FaceVertexMesh;

    fn twins(faces: &[[u32; 3]]) -> Vec<Option<FaceSide>> {
        let polygons = PolygonMesh::new([Point::ZERO; 5], faces).expect("valid");
        let mesh = FaceVertexMesh::from_polygons(&polygons).expect("holds every mesh");
        let edge = Pair::new(VertexId::new(0), VertexId::new(1));
        assert_eq!(mesh.edge_sides(edge).count(), mesh.edge_faces(edge).count());
        mesh.edge_sides(edge).map(|s| mesh.twin_side(s)).collect()
    }

    #[test]
    fn only_two_opposite_sides_are_twins() {
        let side = |face, corner| Some(FaceSide::new(FaceId::new(face), corner));
        assert_eq!(twins(&[[0, 1, 2]]), [None]);
        assert_eq!(twins(&[[0, 1, 2], [3, 1, 0]]), [side(1, 4), side(0, 0)]);
        assert_eq!(twins(&[[0, 1, 2], [3, 0, 1]]), [None; 2]);
        assert_eq!(twins(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]), [None; 3]);
    }
}

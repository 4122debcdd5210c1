//! Steps from side to side on the seventh structure, computed from its answers to queries.

use sixfold_core::{
    EdgeId, FaceId, Handle, HandleMap, HashHandleMap, MeshQuery, OrientedWalk, Probe, SideMap,
    VertexId,
};

use crate::face_and_edge_lists::FaceAndEdgeLists;

/// A side: its face, and its place in FE.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct ListSide {
    face: FaceId,
    at: usize,
}

impl Handle for ListSide {
    type Map<T: Clone> = HashHandleMap<Self, T>;
}

impl<P: Probe> OrientedWalk for FaceAndEdgeLists<P> {
    type Side = ListSide;

    fn face_sides(&self, face: FaceId) -> impl Iterator<Item = ListSide> {
        (0..self.degree(face)).map(move |at| ListSide { face, at })
    }

    fn edge_sides(&self, e: EdgeId) -> impl Iterator<Item = ListSide> {
        let sides = self.edge_faces(e).flat_map(|f| self.face_sides(f));
        sides.filter(move |&s| self.side_edge(s) == e)
    }

    fn outgoing_sides(&self, v: VertexId) -> impl Iterator<Item = ListSide> {
        let sides = self.vertex_faces(v).flat_map(|f| self.face_sides(f));
        sides.filter(move |&s| self.side_origin(s) == v)
    }

    fn next_side(&self, s: ListSide) -> ListSide {
        let at = (s.at + 1) % self.degree(s.face);
        ListSide { at, ..s }
    }

    fn prev_side(&self, s: ListSide) -> ListSide {
        let degree = self.degree(s.face);
        let at = (s.at + degree - 1) % degree;
        ListSide { at, ..s }
    }

    fn twin_side(&self, s: ListSide) -> Option<ListSide> {
        let mut others = self
            .edge_sides(self.side_edge(s))
            .filter(|&other| other != s);
        let twin = others.next()?;
        let is_opposite = self.side_origin(twin) == self.side_target(s);
        (is_opposite && others.next().is_none()).then_some(twin)
    }

    fn side_origin(&self, s: ListSide) -> VertexId {
        let mut corners = self.face_vertices(s.face);
        corners.nth(s.at).expect("a side starts at a corner")
    }

    fn side_face(&self, s: ListSide) -> FaceId {
        s.face
    }

    fn side_edge(&self, s: ListSide) -> EdgeId {
        let mut ends = [self.side_origin(s), self.side_target(s)];
        ends.sort_unstable();
        let mut edges = self.edges();
        let edge = edges.find(|&e| self.edge_vertices(e) == ends);
        edge.expect("a side runs along an edge")
    }

    fn side_map<T: Clone>(&self, value: T) -> SideMap<Self, T> {
        HandleMap::filled(0, value)
    }
}

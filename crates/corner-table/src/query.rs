//! The nine relations.

use sixfold_core::{
    Capabilities, Editing, FaceId, HoleSet, IteratorExt, MeshQuery, Point, Probe, VertexId,
};

use crate::circulate::{EdgeEdges, Edges, Neighbours, Spokes};
use crate::mesh::{CornerId, CornerTable, EdgeCorner, edge_between};

impl<P: Probe, E: Editing> MeshQuery for CornerTable<E, P> {
    type Vertex = VertexId;
    type Edge = EdgeCorner;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities {
        polygons: false,
        ..Capabilities::ORIENTED_MANIFOLDS
    };

    sixfold_core::vertex_rows!(self, self.positions.len(), self.vertex_holes);
    sixfold_core::face_rows!(
        #[inline]
        self,
        self.vertex.len() / 3,
        self.face_holes
    );

    /// Lists the handles of all edges. Reads `opposite` once.
    #[inline]
    fn edges(&self) -> impl Iterator<Item = EdgeCorner> {
        Edges::new(self)
    }

    /// Counts the boundary edges to compute the number of edges; O(corners).
    fn edge_count(&self) -> usize {
        let opposite = self.opposite.read_range(0..self.opposite.len());
        let boundary = opposite.iter().filter(|across| across.get().is_none());
        let boundary = boundary.count();
        boundary + (self.corner_count() - boundary) / 2
    }

    #[inline]
    fn position(&self, v: VertexId) -> Point {
        let at = self.positions.read(v.index());
        if self.vertex_holes.has(v.index()) {
            self.no_such_vertex(v);
        }
        *at
    }

    #[inline]
    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        Neighbours::new(self, v)
    }

    #[inline]
    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = EdgeCorner> {
        Spokes::new(self, v)
    }

    #[inline]
    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        self.fan(v).map_inline(|(after, _)| after.triangle())
    }

    #[inline]
    fn edge_vertices(&self, e: EdgeCorner) -> [VertexId; 2] {
        self.ends_of(e)
    }

    #[inline]
    fn edge_edges(&self, e: EdgeCorner) -> impl Iterator<Item = EdgeCorner> {
        EdgeEdges::new(self, e)
    }

    #[inline]
    fn edge_faces(&self, e: EdgeCorner) -> impl Iterator<Item = FaceId> {
        let sides = [Some(e.corner()), self.across(e).get()];
        sides.into_iter().flatten().map_inline(CornerId::triangle)
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.vertices_of(f).into_iter()
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = EdgeCorner> {
        // Side i runs from corner i to the next corner. The corner that is left faces side i.
        let [a, b, c] = self.opposites_of(f);
        [c, a, b]
            .into_iter()
            .map_inline(|(c, across)| edge_between(c, across))
    }

    // Always inlined: a call would return the iterator in memory and double the time.
    #[inline(always)]
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        // Two triangles may share two or three sides.
        let [a, b, c] = self
            .opposites_of(f)
            .map(|(_, across)| across.get().map(CornerId::triangle));
        let b = if b == a { None } else { b };
        let c = if c == a || c == b { None } else { c };
        [a, b, c].into_iter().flatten()
    }

    #[inline]
    fn contains_edge(&self, e: EdgeCorner) -> bool {
        let c = e.corner();
        if c.index() >= self.opposite.len() || self.face_holes.has(c.triangle().index()) {
            return false;
        }
        edge_between(c, *self.opposite.read(c.index())) == e
    }

    fn edge_rows(&self) -> usize {
        self.opposite.len()
    }

    /// Returns `vertex_vertices`, whose order is counter-clockwise from the boundary.
    fn one_ring(&self, v: VertexId) -> Option<impl Iterator<Item = VertexId>> {
        Some(self.vertex_vertices(v))
    }
}

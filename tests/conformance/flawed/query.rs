//! The flaws of queries.

use sixfold_core::{
    BoundaryLoop, Capabilities, EdgeId, EdgeMap, FaceId, MeshQuery, Numbers, Point, Probe, VertexId,
};

use super::items::Items;
use super::{Flaw, FlawKind, Flawed};

impl<F: Flaw, P: Probe> MeshQuery for Flawed<F, P> {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = match F::KIND {
        FlawKind::AcceptsEverything | FlawKind::LimitsIgnored | FlawKind::WrongError => {
            Capabilities::ORIENTED_MANIFOLDS
        }
        _ => Capabilities::ALL,
    };

    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        self.inner.vertices()
    }

    fn edges(&self) -> impl Iterator<Item = EdgeId> {
        self.with_duplicate(FlawKind::EdgeIteratedTwice, self.inner.edges().collect())
    }

    fn faces(&self) -> impl Iterator<Item = FaceId> {
        let mut faces: Vec<_> = self.inner.faces().collect();
        if self.is(FlawKind::FacesOutOfOrder) {
            faces.reverse();
        }
        faces.into_iter()
    }

    fn vertex_count(&self) -> usize {
        self.inner.vertex_count() + usize::from(self.is(FlawKind::VertexCountOff))
    }

    fn face_count(&self) -> usize {
        self.inner.face_count()
    }

    fn position(&self, v: VertexId) -> Point {
        let position = self.inner.position(v);
        if self.is(FlawKind::PositionOff) {
            Point::new(position.z, position.x, position.y)
        } else {
            position
        }
    }

    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        if v.index() >= self.inner.vertex_rows() {
            match F::KIND {
                FlawKind::EmptyForMissingRow => return Items::<F, _>::new(std::iter::empty()),
                FlawKind::MessageWithoutHandle => {
                    panic!("index out of bounds: the index is {}", v.index())
                }
                _ => {}
            }
        }
        let mut ring: Vec<_> = self.inner.vertex_vertices(v).collect();
        if self.is(FlawKind::VertexAdjacentToItself) {
            ring.push(v);
        }
        if self.is_probed {
            ring = self.without_last(FlawKind::DifferentWhenProbed, ring);
        }
        Items::new(self.with_duplicate(FlawKind::NeighbourTwice, ring))
    }

    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = EdgeId> {
        let edges = self.inner.vertex_edges(v).collect();
        self.without_last(FlawKind::EdgeLeftOut, edges).into_iter()
    }

    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        let faces = self.inner.vertex_faces(v).collect();
        self.without_last(FlawKind::FaceLeftOut, faces).into_iter()
    }

    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let [a, b] = self.inner.edge_vertices(e);
        if self.is(FlawKind::EndTwice) && e.index() % 2 == 1 {
            [b, b]
        } else {
            [a, b]
        }
    }

    fn edge_edges(&self, e: EdgeId) -> impl Iterator<Item = EdgeId> {
        let mut edges: Vec<_> = self.inner.edge_edges(e).collect();
        if self.is(FlawKind::EdgeAdjacentToItself) {
            edges.push(e);
        }
        if self.is(FlawKind::HigherEdgesOnly) {
            edges.retain(|&other| other > e);
        }
        edges.into_iter()
    }

    fn edge_faces(&self, e: EdgeId) -> impl Iterator<Item = FaceId> {
        let mut faces: Vec<_> = self.inner.edge_faces(e).collect();
        if self.is(FlawKind::ThirdFaceLeftOut) {
            faces.truncate(2);
        }
        faces.into_iter()
    }

    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        let mut corners: Vec<_> = self.inner.face_vertices(f).collect();
        if self.is(FlawKind::CornersReversed) {
            corners.reverse();
        }
        corners.into_iter()
    }

    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = EdgeId> {
        let mut sides: Vec<_> = self.inner.face_edges(f).collect();
        if self.is(FlawKind::SidesShifted) {
            sides.rotate_left(1);
        }
        sides.into_iter()
    }

    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        let across = |f| {
            self.inner
                .face_edges(f)
                .flat_map(|e| self.inner.edge_faces(e))
        };
        let same = |a, b| {
            let set = |f| {
                self.inner
                    .face_vertices(f)
                    .collect::<std::collections::BTreeSet<_>>()
            };
            set(a) == set(b)
        };
        let faces: Vec<_> = match F::KIND {
            FlawKind::FaceTwiceAcrossTwoEdges => across(f).filter(|&other| other != f).collect(),
            FlawKind::DuplicateFaceLeftOut => self
                .inner
                .face_faces(f)
                .filter(|&other| !same(f, other))
                .collect(),
            _ => self.inner.face_faces(f).collect(),
        };
        faces.into_iter()
    }

    fn valence(&self, v: VertexId) -> usize {
        self.inner.valence(v) + usize::from(self.is(FlawKind::ValenceOff))
    }

    fn degree(&self, f: FaceId) -> usize {
        self.inner.degree(f) + usize::from(self.is(FlawKind::DegreeOff))
    }

    fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.inner.is_boundary_vertex(v) && !self.is(FlawKind::NoBoundaryVertex)
    }

    fn is_boundary_edge(&self, e: EdgeId) -> bool {
        self.inner.is_boundary_edge(e) && !self.is(FlawKind::NoBoundaryEdge)
    }

    fn contains_vertex(&self, v: VertexId) -> bool {
        let rows = self.inner.vertex_rows();
        match F::KIND {
            FlawKind::LastVertexNotContained => v.index() + 1 < rows,
            FlawKind::ContainsMissingVertex => true,
            _ => self.inner.contains_vertex(v),
        }
    }

    fn contains_edge(&self, e: EdgeId) -> bool {
        let rows = self.inner.edge_rows();
        match F::KIND {
            FlawKind::LastEdgeNotContained => e.index() + 1 < rows,
            FlawKind::ContainsMissingEdge => true,
            _ => self.inner.contains_edge(e),
        }
    }

    fn contains_face(&self, f: FaceId) -> bool {
        let rows = self.inner.face_rows();
        match F::KIND {
            FlawKind::LastFaceNotContained => f.index() + 1 < rows,
            FlawKind::ContainsMissingFace => true,
            _ => self.inner.contains_face(f),
        }
    }

    fn edge_between(&self, a: VertexId, b: VertexId) -> Option<EdgeId> {
        let any = || self.inner.vertex_edges(a).next();
        match (self.inner.edge_between(a, b), F::KIND) {
            (None, FlawKind::EdgeBetweenAnyVertices) if a != b => any(),
            (None, FlawKind::EdgeToTheVertexItself) if a == b => any(),
            (correct, _) => correct,
        }
    }

    fn common_face(&self, a: VertexId, b: VertexId) -> Option<FaceId> {
        match (self.inner.common_face(a, b), F::KIND) {
            (_, FlawKind::NoCommonFace) => None,
            (None, FlawKind::CommonFaceOfAnyVertices) => self.inner.vertex_faces(a).next(),
            (correct, _) => correct,
        }
    }

    fn opposite_vertex(&self, f: FaceId, e: EdgeId) -> Option<VertexId> {
        let ends = self.inner.edge_vertices(e);
        match F::KIND {
            FlawKind::OppositeVertexOfAnyFace => {
                self.inner.face_vertices(f).find(|v| !ends.contains(v))
            }
            FlawKind::OppositeVertexOfAnyEdge if self.inner.degree(f) == 3 => {
                self.inner.face_vertices(f).find(|v| !ends.contains(v))
            }
            _ => self.inner.opposite_vertex(f, e),
        }
    }

    fn edge_face_counts(&self) -> EdgeMap<Self, u8> {
        let mut counts = self.inner.edge_face_counts();
        if let Some(e) = self.inner.edges().next()
            && self.is(FlawKind::FaceCountOff)
        {
            counts[e] += 2;
        }
        counts
    }

    fn boundary_edges(&self) -> Vec<EdgeId> {
        let edges = self.inner.boundary_edges();
        self.without_last(FlawKind::BoundaryEdgeLeftOut, edges)
    }

    fn boundary_loops(&self) -> Vec<BoundaryLoop<VertexId, EdgeId>> {
        let mut loops = self.inner.boundary_loops();
        if self.is(FlawKind::LoopReversed) {
            for chain in &mut loops {
                chain.vertices.reverse();
                chain.edges.reverse();
            }
        }
        loops
    }

    fn vertex_numbers(&self) -> Numbers<VertexId> {
        let mut vertices: Vec<_> = self.inner.vertices().collect();
        if self.is(FlawKind::NumbersReversed) {
            vertices.reverse();
        }
        Numbers::new(self.vertex_rows(), vertices.into_iter())
    }

    fn vertex_rows(&self) -> usize {
        self.inner.vertex_rows()
    }

    fn edge_rows(&self) -> usize {
        let rows = self.inner.edge_rows();
        if self.is(FlawKind::TooFewRows) {
            rows.saturating_sub(1)
        } else {
            rows
        }
    }

    fn face_rows(&self) -> usize {
        self.inner.face_rows()
    }

    fn one_ring(&self, v: VertexId) -> Option<impl Iterator<Item = VertexId>> {
        let correct = self.inner.one_ring(v).map(Iterator::collect::<Vec<_>>);
        let ring = match F::KIND {
            FlawKind::RingReversed => correct.map(|ring| ring.into_iter().rev().collect()),
            FlawKind::RingFromTheMiddle => correct.map(|mut ring| {
                let middle = ring.len() / 2;
                ring.rotate_left(middle);
                ring
            }),
            FlawKind::RingOfABowTie => {
                correct.or_else(|| Some(self.inner.vertex_vertices(v).collect()))
            }
            FlawKind::NoRingOfAnIsolatedVertex => correct.filter(|ring| !ring.is_empty()),
            _ => correct,
        };
        ring.map(Vec::into_iter)
    }
}

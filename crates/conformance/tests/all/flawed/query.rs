//! The flaws of queries.

use sixfold_core::{
    BoundaryLoop, Capabilities, EdgeId, EdgeMap, FaceId, MeshQuery, Numbers, Point, Probe, VertexId,
};

use super::items::Items;
use super::{Flaw, Flawed, Kind};

impl<F: Flaw, P: Probe> MeshQuery for Flawed<F, P> {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = match F::KIND {
        Kind::AcceptsEverything | Kind::WrongError => Capabilities::ORIENTED_MANIFOLDS,
        _ => Capabilities::ALL,
    };

    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        self.inner.vertices()
    }

    fn edges(&self) -> impl Iterator<Item = EdgeId> {
        self.with_duplicate(Kind::EdgeIteratedTwice, self.inner.edges().collect())
    }

    fn faces(&self) -> impl Iterator<Item = FaceId> {
        let mut faces: Vec<_> = self.inner.faces().collect();
        if self.is(Kind::FacesOutOfOrder) {
            faces.reverse();
        }
        faces.into_iter()
    }

    fn vertex_count(&self) -> usize {
        self.inner.vertex_count() + usize::from(self.is(Kind::VertexCountOff))
    }

    fn face_count(&self) -> usize {
        self.inner.face_count()
    }

    fn position(&self, v: VertexId) -> Point {
        let position = self.inner.position(v);
        if self.is(Kind::PositionOff) {
            Point::new(position.z, position.x, position.y)
        } else {
            position
        }
    }

    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        if v.index() >= self.inner.vertex_rows() {
            match F::KIND {
                Kind::EmptyForMissingRow => return Items::<F, _>::new(std::iter::empty()),
                Kind::MessageWithoutHandle => {
                    panic!("index out of bounds: the index is {}", v.index())
                }
                _ => {}
            }
        }
        let mut ring: Vec<_> = self.inner.vertex_vertices(v).collect();
        if self.is(Kind::VertexAdjacentToItself) {
            ring.push(v);
        }
        if self.is_probed {
            ring = self.without_last(Kind::DifferentWhenProbed, ring);
        }
        Items::new(self.with_duplicate(Kind::NeighbourTwice, ring))
    }

    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = EdgeId> {
        let edges = self.inner.vertex_edges(v).collect();
        self.without_last(Kind::EdgeLeftOut, edges).into_iter()
    }

    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        let faces = self.inner.vertex_faces(v).collect();
        self.without_last(Kind::FaceLeftOut, faces).into_iter()
    }

    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let [a, b] = self.inner.edge_vertices(e);
        if self.is(Kind::EndTwice) && e.index() % 2 == 1 {
            [b, b]
        } else {
            [a, b]
        }
    }

    fn edge_edges(&self, e: EdgeId) -> impl Iterator<Item = EdgeId> {
        let mut edges: Vec<_> = self.inner.edge_edges(e).collect();
        if self.is(Kind::EdgeAdjacentToItself) {
            edges.push(e);
        }
        if self.is(Kind::HigherEdgesOnly) {
            edges.retain(|&other| other > e);
        }
        edges.into_iter()
    }

    fn edge_faces(&self, e: EdgeId) -> impl Iterator<Item = FaceId> {
        let mut faces: Vec<_> = self.inner.edge_faces(e).collect();
        if self.is(Kind::ThirdFaceLeftOut) {
            faces.truncate(2);
        }
        faces.into_iter()
    }

    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        let mut corners: Vec<_> = self.inner.face_vertices(f).collect();
        if self.is(Kind::CornersReversed) {
            corners.reverse();
        }
        corners.into_iter()
    }

    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = EdgeId> {
        let mut sides: Vec<_> = self.inner.face_edges(f).collect();
        if self.is(Kind::SidesShifted) {
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
            Kind::FaceTwiceAcrossTwoEdges => across(f).filter(|&other| other != f).collect(),
            Kind::DuplicateFaceLeftOut => self
                .inner
                .face_faces(f)
                .filter(|&other| !same(f, other))
                .collect(),
            _ => self.inner.face_faces(f).collect(),
        };
        faces.into_iter()
    }

    fn valence(&self, v: VertexId) -> usize {
        self.inner.valence(v) + usize::from(self.is(Kind::ValenceOff))
    }

    fn degree(&self, f: FaceId) -> usize {
        self.inner.degree(f) + usize::from(self.is(Kind::DegreeOff))
    }

    fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.inner.is_boundary_vertex(v) && !self.is(Kind::NoBoundaryVertex)
    }

    fn is_boundary_edge(&self, e: EdgeId) -> bool {
        self.inner.is_boundary_edge(e) && !self.is(Kind::NoBoundaryEdge)
    }

    fn contains_vertex(&self, v: VertexId) -> bool {
        let rows = self.inner.vertex_rows();
        match F::KIND {
            Kind::LastVertexNotContained => v.index() + 1 < rows,
            Kind::ContainsMissingVertex => true,
            _ => self.inner.contains_vertex(v),
        }
    }

    fn contains_edge(&self, e: EdgeId) -> bool {
        let rows = self.inner.edge_rows();
        match F::KIND {
            Kind::LastEdgeNotContained => e.index() + 1 < rows,
            Kind::ContainsMissingEdge => true,
            _ => self.inner.contains_edge(e),
        }
    }

    fn contains_face(&self, f: FaceId) -> bool {
        let rows = self.inner.face_rows();
        match F::KIND {
            Kind::LastFaceNotContained => f.index() + 1 < rows,
            Kind::ContainsMissingFace => true,
            _ => self.inner.contains_face(f),
        }
    }

    fn common_face(&self, a: VertexId, b: VertexId) -> Option<FaceId> {
        let correct = self.inner.common_face(a, b);
        correct.filter(|_| !self.is(Kind::NoCommonFace))
    }

    fn opposite_vertex(&self, f: FaceId, e: EdgeId) -> Option<VertexId> {
        let ends = self.inner.edge_vertices(e);
        match F::KIND {
            Kind::OppositeVertexOfAnyFace => {
                self.inner.face_vertices(f).find(|v| !ends.contains(v))
            }
            _ => self.inner.opposite_vertex(f, e),
        }
    }

    fn edge_face_counts(&self) -> EdgeMap<Self, u8> {
        let mut counts = self.inner.edge_face_counts();
        if let Some(e) = self.inner.edges().next()
            && self.is(Kind::FaceCountOff)
        {
            counts[e] += 2;
        }
        counts
    }

    fn boundary_edges(&self) -> Vec<EdgeId> {
        let edges = self.inner.boundary_edges();
        self.without_last(Kind::BoundaryEdgeLeftOut, edges)
    }

    fn boundary_loops(&self) -> Vec<BoundaryLoop<VertexId, EdgeId>> {
        let mut loops = self.inner.boundary_loops();
        if self.is(Kind::LoopReversed) {
            for chain in &mut loops {
                chain.vertices.reverse();
                chain.edges.reverse();
            }
        }
        loops
    }

    fn vertex_numbers(&self) -> Numbers<VertexId> {
        let mut vertices: Vec<_> = self.inner.vertices().collect();
        if self.is(Kind::NumbersReversed) {
            vertices.reverse();
        }
        Numbers::new(self.vertex_rows(), vertices.into_iter())
    }

    fn vertex_rows(&self) -> usize {
        self.inner.vertex_rows()
    }

    fn edge_rows(&self) -> usize {
        let rows = self.inner.edge_rows();
        if self.is(Kind::TooFewRows) {
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
            Kind::RingReversed => correct.map(|ring| ring.into_iter().rev().collect()),
            Kind::RingFromTheMiddle => correct.map(|mut ring| {
                let middle = ring.len() / 2;
                ring.rotate_left(middle);
                ring
            }),
            Kind::RingOfABowTie => {
                correct.or_else(|| Some(self.inner.vertex_vertices(v).collect()))
            }
            Kind::NoRingOfAnIsolatedVertex => correct.filter(|ring| !ring.is_empty()),
            _ => correct,
        };
        ring.map(Vec::into_iter)
    }
}

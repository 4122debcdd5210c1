//! A seventh structure in one file: faces and edges as lists, and a scan for most queries.

use sixfold_core::{
    BuildError, Capabilities, Counts, EdgeId, EditLog, FaceId, FaceList, FaceSpans, InvariantError,
    Measured, MemoryFootprint, MeshMove, MeshQuery, MoveError, Point, PolygonMesh, Probe,
    QueryCost, Representation, Table, Untraced, VertexId, VertexMap, row,
};

/// The corners of every face and the ends of every edge.
///
/// I1: every corner is an existing vertex. I2: the two ends of each edge ascend, and the list of
/// edges ascends.
#[derive(Clone, Debug)]
pub(crate) struct FaceAndEdgeLists<P: Probe = Untraced> {
    positions: Table<Point, P>,
    corners: Table<VertexId, P>,
    spans: FaceSpans<P>,
    ends: Table<[VertexId; 2], P>,
}

impl<P: Probe> FaceAndEdgeLists<P> {
    fn corners(&self, f: FaceId) -> Vec<VertexId> {
        self.corners.read_range(self.spans.range(f)).to_vec()
    }

    fn edges_where(&self, predicate: impl Fn([VertexId; 2]) -> bool) -> Vec<EdgeId> {
        self.edges()
            .filter(|e| predicate(*self.ends.read(e.index())))
            .collect()
    }

    fn faces_where(&self, predicate: impl Fn(&[VertexId]) -> bool) -> Vec<FaceId> {
        self.faces()
            .filter(|&f| predicate(&self.corners(f)))
            .collect()
    }
}

fn sides(corners: &[VertexId]) -> impl Iterator<Item = [VertexId; 2]> + Clone {
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next);
    pairs.map(|(&a, &b)| [a.min(b), a.max(b)])
}

impl<P: Probe> MeshQuery for FaceAndEdgeLists<P> {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities::ALL;

    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..row(self.positions.len())).map(VertexId::new)
    }

    fn edges(&self) -> impl Iterator<Item = EdgeId> {
        (0..row(self.ends.len())).map(EdgeId::new)
    }

    fn faces(&self) -> impl Iterator<Item = FaceId> {
        (0..row(self.spans.len())).map(FaceId::new)
    }

    fn face_count(&self) -> usize {
        self.spans.len()
    }

    fn position(&self, v: VertexId) -> Point {
        *self.positions.read(v.index())
    }

    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.position(v);
        let at_v = self.edges_where(|ends| ends.contains(&v)).into_iter();
        at_v.map(move |e| {
            let [a, b] = self.edge_vertices(e);
            if a == v { b } else { a }
        })
    }

    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = EdgeId> {
        self.position(v);
        self.edges_where(|ends| ends.contains(&v)).into_iter()
    }

    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        self.position(v);
        self.faces_where(|corners| corners.contains(&v)).into_iter()
    }

    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        *self.ends.read(e.index())
    }

    fn edge_edges(&self, e: EdgeId) -> impl Iterator<Item = EdgeId> {
        let [a, b] = self.edge_vertices(e);
        let neighbours = self.edges_where(|ends| ends.contains(&a) || ends.contains(&b));
        neighbours.into_iter().filter(move |&other| other != e)
    }

    fn edge_faces(&self, e: EdgeId) -> impl Iterator<Item = FaceId> {
        let ends = self.edge_vertices(e);
        self.faces_where(|corners| sides(corners).any(|side| side == ends))
            .into_iter()
    }

    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.corners(f).into_iter()
    }

    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = EdgeId> {
        let sides: Vec<_> = sides(&self.corners(f)).collect();
        sides
            .into_iter()
            .flat_map(|side| self.edges_where(|ends| ends == side))
    }

    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        let own_sides: Vec<_> = sides(&self.corners(f)).collect();
        let neighbours =
            self.faces_where(|corners| sides(corners).any(|side| own_sides.contains(&side)));
        neighbours.into_iter().filter(move |&other| other != f)
    }

    fn vertex_rows(&self) -> usize {
        self.positions.len()
    }

    fn edge_rows(&self) -> usize {
        self.ends.len()
    }

    fn face_rows(&self) -> usize {
        self.spans.len()
    }
}

impl Representation for FaceAndEdgeLists {
    const NAME: &'static str = "face-and-edge-lists";
    const COSTS: [QueryCost; 9] = {
        use QueryCost::{Constant, Scan};
        [Scan, Scan, Scan, Constant, Scan, Scan, Constant, Scan, Scan]
    };

    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let faces = polygons.faces();
        let mut ends: Vec<_> = faces.iter().flat_map(|(_, face)| sides(face)).collect();
        ends.sort_unstable();
        ends.dedup();
        ends.shrink_to_fit();
        let mesh = Self {
            positions: Table::new("positions", "vertex", polygons.positions().to_vec()),
            corners: Table::new("corners", "corner", faces.corners().to_vec()),
            spans: faces.spans(),
            ends: Table::new("ends", "edge", ends),
        };
        Ok(mesh)
    }

    fn to_polygons(&self) -> PolygonMesh {
        let mut faces = FaceList::default();
        for f in self.faces() {
            faces
                .push(self.corners(f))
                .expect("the number of corners is unchanged");
        }
        PolygonMesh::from_faces(self.positions.rows().to_vec(), faces).expect("I1")
    }

    fn vertex_handle(_: &PolygonMesh, v: VertexId) -> VertexId {
        v
    }

    fn face_handle(_: &PolygonMesh, f: FaceId) -> FaceId {
        f
    }

    fn memory(&self) -> MemoryFootprint {
        let tables = [
            self.positions.bytes(),
            self.corners.bytes(),
            self.ends.bytes(),
        ];
        tables.into_iter().chain(self.spans.bytes()).collect()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        let vertices = self.positions.len();
        if let Some(v) = self.corners.rows().iter().find(|v| v.index() >= vertices) {
            return Err(InvariantError::new("I1", format!("no vertex {v}")));
        }
        let ends = self.ends.rows();
        let ascend = ends.iter().all(|[a, b]| a < b) && ends.windows(2).all(|e| e[0] < e[1]);
        let fault = || InvariantError::new("I2", "edges out of order");
        ascend.then_some(()).ok_or_else(fault)
    }
}

impl MeshMove for FaceAndEdgeLists {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        _: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        self.positions.set_positions(positions)
    }
}

impl Measured for FaceAndEdgeLists {
    type Probed<P: Probe> = FaceAndEdgeLists<P>;

    fn layout_bytes(counts: &Counts) -> usize {
        12 * counts.vertices + 4 * counts.corners + 8 * counts.edges + counts.offset_bytes()
    }

    fn probed<P: Probe>(self, probe: P) -> FaceAndEdgeLists<P> {
        FaceAndEdgeLists {
            positions: self.positions.probed(probe.clone()),
            corners: self.corners.probed(probe.clone()),
            spans: self.spans.probed(probe.clone()),
            ends: self.ends.probed(probe),
        }
    }
}

//! In and out.

use mesh_core::{
    BuildError, Capabilities, Counts, FaceId, FaceList, FaceSpans, InvariantError, MemoryFootprint,
    MeshQuery, MoveError, Point, PolygonMesh, Probe, QueryCost, Representation, Table, VertexId,
    VertexMap,
};

use crate::mesh::IndexedFaceSet;

impl Representation for IndexedFaceSet {
    const NAME: &'static str = "indexed-face-set";

    const CAPABILITIES: Capabilities = Capabilities::ALL;

    const COSTS: [QueryCost; 9] = {
        use QueryCost::{Constant, Scan};
        [
            Scan, Scan, Scan, Constant, Scan, Scan, Constant, Constant, Scan,
        ]
    };

    type Probed<P: Probe> = IndexedFaceSet<P>;

    /// Copies positions and corners; O(corners + vertices).
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let faces = polygons.faces();
        Ok(Self {
            positions: Table::new("positions", "vertex", polygons.positions().to_vec()),
            corners: Table::new("corners", "corner", faces.corners().to_vec()),
            spans: faces.spans(),
        })
    }

    fn to_polygons(&self) -> PolygonMesh {
        let faces = match &self.spans {
            FaceSpans::Uniform { degree, .. } => {
                FaceList::uniform(*degree as usize, self.corners().to_vec())
            }
            FaceSpans::Mixed(_) => {
                let mut faces = FaceList::with_capacity(self.corners.len());
                let pushed = self
                    .faces()
                    .try_for_each(|f| faces.push(self.face_vertices(f)));
                pushed.map(|()| faces)
            }
        };
        let faces = faces.expect("I1: as many corners as came in");
        PolygonMesh::from_faces(self.positions().to_vec(), faces).expect("I1 and I2")
    }

    fn vertex_name(_: &PolygonMesh, v: VertexId) -> VertexId {
        v
    }

    fn face_name(_: &PolygonMesh, f: FaceId) -> FaceId {
        f
    }

    fn set_positions(&mut self, positions: &VertexMap<Self, Point>) -> Result<(), MoveError> {
        self.positions.set_positions(positions)
    }

    fn memory(&self) -> MemoryFootprint {
        let tables = [self.positions.bytes(), self.corners.bytes()];
        tables.into_iter().chain(self.spans.bytes()).collect()
    }

    fn layout_bytes(counts: &Counts) -> usize {
        let by_vertex = size_of::<Point>() * counts.vertices;
        by_vertex + size_of::<VertexId>() * counts.corners + counts.offset_bytes()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        self.check_invariants()
    }

    fn probed<P: Probe>(self, probe: P) -> IndexedFaceSet<P> {
        IndexedFaceSet {
            positions: self.positions.probed(probe.clone()),
            corners: self.corners.probed(probe.clone()),
            spans: self.spans.probed(probe),
        }
    }
}

//! Building from polygons, and conversion to polygons.

use sixfold_core::{
    BuildError, Counts, Editing, FaceList, FaceSpans, HoleSet, InvariantError, Measured,
    MemoryFootprint, NewRows, Point, PolygonMesh, Probe, QueryCost, Representation, Table,
    Untraced, VERTEX_HOLES, VertexId,
};
use sixfold_scanning::ScannedFaces;

use crate::mesh::IndexedFaceSet;

impl<E: Editing> Representation for IndexedFaceSet<E> {
    const NAME: &'static str = "indexed-face-set";

    const COSTS: [QueryCost; 9] = {
        use QueryCost::{Constant, Scan};
        [
            Scan, Scan, Scan, Constant, Scan, Scan, Constant, Constant, Scan,
        ]
    };

    sixfold_core::type_path!(IndexedFaceSet);

    /// Copies positions and corners; O(corners + vertices).
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let faces = polygons.faces();
        Ok(Self {
            positions: Table::new("positions", "vertex", polygons.positions().to_vec()),
            vertex_holes: E::no_holes(VERTEX_HOLES, Untraced),
            faces: ScannedFaces::new(faces.corners().to_vec(), faces.spans()),
        })
    }

    fn to_polygons(&self) -> PolygonMesh {
        let (positions, corners) = (self.positions(), self.corners());
        if let FaceSpans::Uniform { degree, .. } = self.spans()
            && self.vertex_holes.is_empty()
            && self.faces.holes.is_empty()
        {
            let faces = FaceList::uniform(*degree as usize, corners.to_vec()).expect("I1");
            return PolygonMesh::from_faces(positions.to_vec(), faces).expect("I1 and I2");
        }
        let rows = NewRows::from_holes(&self.vertex_holes, positions.len());
        rows.polygons(self, positions, corners.len())
    }

    sixfold_core::row_handles!();

    fn memory(&self) -> MemoryFootprint {
        self.table_bytes()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        self.check_invariants()
    }
}

sixfold_core::moving_positions!(IndexedFaceSet);

impl<E: Editing> Measured for IndexedFaceSet<E> {
    type Probed<P: Probe> = IndexedFaceSet<E, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        let by_vertex = size_of::<Point>() * counts.vertices;
        by_vertex + size_of::<VertexId>() * counts.corners + counts.offset_bytes()
    }

    fn probed<P: Probe>(self, probe: P) -> IndexedFaceSet<E, P> {
        self.with_probe(probe)
    }
}

//! Building from polygons, and conversion to polygons.

use sixfold_core::{
    BuildError, Counts, EditLog, Editing, FaceId, FaceList, FaceSpans, HoleSet, InvariantError,
    Measured, MemoryFootprint, MeshMove, MoveError, NewRows, Point, PolygonMesh, Probe, QueryCost,
    Representation, ScannedFaces, Table, Untraced, VERTEX_HOLES, VertexId, VertexMap,
};

use crate::mesh::IndexedFaceSet;

impl<E: Editing> Representation for IndexedFaceSet<E> {
    const NAME: &'static str = "indexed-face-set";

    const COSTS: [QueryCost; 9] = {
        use QueryCost::{Constant, Scan};
        [
            Scan, Scan, Scan, Constant, Scan, Scan, Constant, Constant, Scan,
        ]
    };

    fn type_path() -> &'static str {
        match E::CAN_DELETE {
            true => "sixfold_indexed_face_set::EditableIndexedFaceSet",
            false => "sixfold_indexed_face_set::IndexedFaceSet",
        }
    }

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

    fn vertex_handle(_: &PolygonMesh, v: VertexId) -> VertexId {
        v
    }

    fn face_handle(_: &PolygonMesh, f: FaceId) -> FaceId {
        f
    }

    fn memory(&self) -> MemoryFootprint {
        let by_vertex = std::iter::once(self.positions.bytes()).chain(self.vertex_holes.bytes());
        by_vertex.chain(self.faces.bytes()).collect()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        self.check_invariants()
    }
}

impl<E: Editing> MeshMove for IndexedFaceSet<E> {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        _: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        self.positions.set_positions(positions)
    }
}

impl<E: Editing> Measured for IndexedFaceSet<E> {
    type Probed<P: Probe> = IndexedFaceSet<E, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        let by_vertex = size_of::<Point>() * counts.vertices;
        by_vertex + size_of::<VertexId>() * counts.corners + counts.offset_bytes()
    }

    fn probed<P: Probe>(self, probe: P) -> IndexedFaceSet<E, P> {
        IndexedFaceSet {
            positions: self.positions.probed(probe.clone()),
            vertex_holes: E::probed_holes(self.vertex_holes, probe.clone()),
            faces: self.faces.probed(probe),
        }
    }
}

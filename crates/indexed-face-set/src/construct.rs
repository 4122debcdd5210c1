//! Building from polygons, and conversion to polygons.

use sixfold_core::{
    BuildError, Counts, Editing, FaceId, FaceList, FaceSpans, HoleSet, InvariantError, Measured,
    MemoryFootprint, MeshQuery, MoveError, Point, PolygonError, PolygonMesh, Probe, QueryCost,
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
        let positions = self.vertices().map(|v| self.positions()[v.index()]);
        let faces = match self.spans() {
            FaceSpans::Uniform { degree, .. }
                if self.vertex_holes.is_empty() && self.faces.holes.is_empty() =>
            {
                FaceList::uniform(*degree as usize, self.corners().to_vec())
            }
            _ => self.faces_without_holes(),
        };
        let faces = faces.expect("I1: no more corners than in the tables");
        PolygonMesh::from_faces(positions.collect(), faces).expect("I1 and I2")
    }

    fn vertex_handle(_: &PolygonMesh, v: VertexId) -> VertexId {
        v
    }

    fn face_handle(_: &PolygonMesh, f: FaceId) -> FaceId {
        f
    }

    fn set_positions(&mut self, positions: &VertexMap<Self, Point>) -> Result<(), MoveError> {
        self.positions.set_positions(positions)
    }

    fn memory(&self) -> MemoryFootprint {
        let by_vertex = std::iter::once(self.positions.bytes()).chain(self.vertex_holes.bytes());
        by_vertex.chain(self.faces.bytes()).collect()
    }

    fn validate(&self) -> Result<(), InvariantError> {
        self.check_invariants()
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

impl<P: Probe, E: Editing> IndexedFaceSet<E, P> {
    /// Returns the faces, with consecutive vertex numbers.
    fn faces_without_holes(&self) -> Result<FaceList, PolygonError> {
        let mut faces = FaceList::with_capacity(self.corners().len());
        let renumbered = !self.vertex_holes.is_empty();
        let new = renumbered.then(|| self.vertex_holes.new_rows(self.positions.len()));
        let number = |v: VertexId| match &new {
            Some(new) => VertexId::new(new[v.index()]),
            None => v,
        };
        for f in self.faces() {
            faces.push(self.face_vertices(f).map(number))?;
        }
        Ok(faces)
    }
}

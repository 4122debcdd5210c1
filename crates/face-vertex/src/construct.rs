//! Building from polygons, and conversion to polygons.

use sixfold_core::{
    BuildError, Counts, Editing, FACE_HOLES, FaceId, FaceList, FaceSpans, HoleSet, InvariantError,
    Measured, MemoryFootprint, NewRows, Point, PolygonMesh, Probe, QueryCost, Representation,
    Table, Untraced, VERTEX_HOLES, VertexId, row,
};

use crate::mesh::{FaceVertexMesh, Fan};

impl<E: Editing> Representation for FaceVertexMesh<E> {
    const NAME: &'static str = "face-vertex";

    const COSTS: [QueryCost; 9] = {
        use QueryCost::{Constant, Local};
        [
            Local, Local, Constant, Constant, Local, Local, Constant, Constant, Local,
        ]
    };

    sixfold_core::type_path!(FaceVertexMesh);

    /// Copies the face list and collects the faces of each vertex; O(corners + vertices).
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        let faces = polygons.faces();
        let (fans, pool) = incident_faces(polygons.vertex_count(), faces);
        Ok(Self {
            positions: Table::new("positions", "vertex", polygons.positions().to_vec()),
            corners: Table::new("corners", "corner", faces.corners().to_vec()),
            spans: E::spans(faces.spans()),
            fans: Table::new("fans", "vertex", fans),
            pool: Table::new("pool", "place", pool),
            vertex_holes: E::no_holes(VERTEX_HOLES, Untraced),
            face_holes: E::no_holes(FACE_HOLES, Untraced),
        })
    }

    fn to_polygons(&self) -> PolygonMesh {
        let (positions, corners) = (self.positions.rows(), self.corners.rows());
        if let FaceSpans::Uniform { degree, .. } = &self.spans
            && self.vertex_holes.is_empty()
            && self.face_holes.is_empty()
        {
            let faces = FaceList::uniform(*degree as usize, corners.to_vec()).expect("I1 holds");
            return PolygonMesh::from_faces(positions.to_vec(), faces).expect("I1 holds");
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

sixfold_core::moving_positions!(FaceVertexMesh);
sixfold_core::local_queries!(crate::FaceVertexMesh, crate::EditableFaceVertexMesh);

impl<E: Editing> Measured for FaceVertexMesh<E> {
    type Probed<P: Probe> = FaceVertexMesh<E, P>;

    fn layout_bytes(counts: &Counts) -> usize {
        let by_vertex = size_of::<Point>() + size_of::<Fan>();
        let by_corner = size_of::<VertexId>() + size_of::<FaceId>();
        by_vertex * counts.vertices + by_corner * counts.corners + counts.offset_bytes()
    }

    fn probed<P: Probe>(self, probe: P) -> FaceVertexMesh<E, P> {
        self.with_probe(probe)
    }
}

/// Returns the faces around every vertex, in the order of the faces.
fn incident_faces(vertices: usize, faces: &FaceList) -> (Vec<Fan>, Vec<FaceId>) {
    let corners = faces.corners();
    let mut fans = vec![Fan::default(); vertices];
    for v in corners {
        fans[v.index()].len += 1;
    }
    let mut total = 0;
    for fan in &mut fans {
        fan.start = total;
        total += fan.len;
        // The loop that fills the pool counts again.
        fan.len = 0;
    }
    let mut pool = vec![FaceId::new(0); corners.len()];
    let mut add = |face: FaceId, v: VertexId| {
        let fan = &mut fans[v.index()];
        pool[(fan.start + fan.len) as usize] = face;
        fan.len += 1;
    };
    match faces.uniform_degree() {
        Some(3) => add_uniform::<3>(corners, add),
        Some(4) => add_uniform::<4>(corners, add),
        _ => {
            for (f, face) in faces.iter() {
                face.iter().for_each(|&v| add(f, v));
            }
        }
    }
    (fans, pool)
}

/// Calls `add` for each corner of each face. The compiler unrolls the loop for a constant degree.
#[inline(always)]
fn add_uniform<const DEGREE: usize>(corners: &[VertexId], mut add: impl FnMut(FaceId, VertexId)) {
    let faces = corners.as_chunks::<DEGREE>().0;
    for (f, face) in (0..row(faces.len())).zip(faces) {
        for &v in face {
            add(FaceId::new(f), v);
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshMove, MeshQuery, MoveError};

    use super::*;
    use crate::FaceVertexMesh;

    fn build(faces: &[&[u32]]) -> FaceVertexMesh {
        let square = [Point::ZERO, Point::X, Point::ONE, Point::Y, Point::Z];
        let polygons = PolygonMesh::new(square, faces).expect("valid");
        let mesh = FaceVertexMesh::from_polygons(&polygons).expect("holds every mesh");
        assert_eq!(mesh.to_polygons(), polygons);
        mesh
    }

    #[test]
    fn fans_are_consecutive_and_in_the_order_of_vertices_and_faces() {
        let all: [&[&[u32]]; 3] = [
            &[&[0, 1, 2], &[2, 3, 0]],
            &[&[0, 1, 2, 3], &[3, 2, 1, 0]],
            &[&[0, 1, 2, 3], &[2, 1, 0]],
        ];
        let fans: [&[&[usize]]; 3] = [
            &[&[0, 1], &[0], &[0, 1], &[1], &[]],
            &[&[0, 1], &[0, 1], &[0, 1], &[0, 1], &[]],
            &[&[0, 1], &[0, 1], &[0, 1], &[0], &[]],
        ];
        for (faces, fans) in all.into_iter().zip(fans) {
            let mesh = build(faces);
            for (v, &fan) in mesh.vertices().zip(fans) {
                let found: Vec<usize> = mesh.fan(v).iter().map(|f| f.index()).collect();
                assert_eq!(found, fan, "VF({v}) of {faces:?}");
            }
            assert!(
                mesh.fans()
                    .windows(2)
                    .all(|pair| pair[0].range().end == pair[1].range().start)
            );
        }
    }

    #[test]
    fn memory_equals_the_layout_formula() {
        let mut counts = Counts {
            vertices: 5,
            edges: 5,
            faces: 2,
            corners: 6,
            uniform: true,
        };
        let triangles = build(&[&[0, 1, 2], &[0, 2, 3]]);
        assert_eq!(triangles.memory().total(), 5 * 12 + 6 * 4 + 5 * 8 + 6 * 4);
        assert_eq!(
            triangles.memory().total(),
            FaceVertexMesh::layout_bytes(&counts)
        );
        let mixed = build(&[&[0, 1, 2, 3], &[0, 2, 3]]);
        (counts.corners, counts.uniform) = (7, false);
        assert_eq!(
            mixed.memory().total(),
            FaceVertexMesh::layout_bytes(&counts)
        );
    }

    #[test]
    fn positions_of_another_mesh_are_refused() {
        let mut mesh = build(&[&[0, 1, 2]]);
        let smaller = FaceVertexMesh::from_polygons(&PolygonMesh::default()).expect("empty");
        let refusal = mesh
            .set_positions(&smaller.vertex_map(Point::ZERO))
            .unwrap_err();
        assert!(matches!(refusal, MoveError::OtherMesh { given: 0, .. }));
    }
}

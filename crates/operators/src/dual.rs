//! The dual of a closed mesh.

use glam::DVec3;
use sixfold_core::{
    Capabilities, FaceId, FaceList, MeshQuery, PolygonMesh, TwinPairs, VertexId, row,
};

use crate::error::DualError;

/// Builds the dual of a closed oriented manifold. The dual has one vertex for each face and one
/// face for each vertex.
///
/// ```text
///     ╲       │       ╱        vertex i of the dual: the mean of the corners of face i
///      ● ─────┼───── ●         face j of the dual: the faces around vertex j, counter-clockwise
///      │ ╲    │    ╱ │           as seen from outside, starting at the lowest
///      │   ╲  │  ╱   │         edges cross: v – e + f becomes f – e + v
///   ───┼───── v ─────┼───
///      │   ╱  │  ╲   │         tetrahedron ↔ itself, cube ↔ octahedron,
///      ● ─────┼───── ●         dodecahedron ↔ icosahedron
/// ```
///
/// The vertices of the dual have the order of `faces()`, and the faces of the dual have the order
/// of `vertices()`. The dual of the dual has the same faces as the mesh, but a face may start at
/// another corner. If two faces share several edges, the dual has several edges with the same two
/// ends, and structures that hold only manifolds reject the dual.
///
/// # Errors
///
/// Returns a [`DualError`] if the mesh has a boundary edge, an isolated vertex or a vertex of
/// valence below 3, or if the mesh is not an oriented manifold.
///
/// # Complexity
///
/// O(corners) time.
///
/// # Examples
///
/// ```
/// use sixfold_half_edge::HalfEdgeMesh;
/// use sixfold_core::Representation;
///
/// let cube = HalfEdgeMesh::from_polygons(&sixfold_shapes::cube())?;
/// let octahedron = sixfold_operators::dual(&cube)?;
/// assert_eq!((octahedron.vertex_count(), octahedron.face_count()), (6, 8));
/// assert_eq!(octahedron.faces().uniform_degree(), Some(3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn dual<M: MeshQuery>(mesh: &M) -> Result<PolygonMesh, DualError> {
    let indexed = IndexedMesh::new(mesh);
    let walk = Walk::new(&indexed)?;
    let faces = walk.dual_faces(&indexed)?;
    Ok(indexed.dual_mesh(faces))
}

/// A mesh as tables, in the order of `vertices()` and `faces()`.
struct IndexedMesh {
    positions: Vec<DVec3>,
    faces: FaceList,
}

impl IndexedMesh {
    fn new<M: MeshQuery>(mesh: &M) -> Self {
        let mut numbers = mesh.vertex_map(VertexId::new(0));
        let mut positions = Vec::new();
        mesh.vertices().for_each(|v| {
            numbers[v] = VertexId::new(row(positions.len()));
            positions.push(mesh.position(v).as_dvec3());
        });
        let mut faces = FaceList::default();
        mesh.faces().for_each(|f| {
            let corners = mesh.face_vertices(f).map(|v| numbers[v]);
            faces.push(corners).expect("no corners are added");
        });
        Self { positions, faces }
    }

    /// Builds the dual with these faces. A vertex of the dual is the mean of the corners of a face.
    fn dual_mesh(&self, faces: FaceList) -> PolygonMesh {
        let centroids = self.faces.iter().map(|(_, corners)| {
            let sum: DVec3 = corners.iter().map(|v| self.positions[v.index()]).sum();
            (sum / corners.len() as f64).as_vec3()
        });
        PolygonMesh::from_faces(centroids.collect(), faces)
            .expect("a manifold vertex has at least three different faces")
    }

    /// Returns the reason why this mesh is not an oriented manifold.
    fn non_manifold_error(&self) -> DualError {
        let positions = self.positions.iter().map(|p| p.as_vec3()).collect();
        let polygons = PolygonMesh::from_faces(positions, self.faces.clone())
            .expect("a face has at least three different vertices");
        Capabilities::ORIENTED_MANIFOLDS
            .build_error(&polygons)
            .into()
    }
}

/// Tables to walk around the vertices of a closed oriented manifold.
struct Walk {
    /// For each vertex, its corner in the lowest face.
    first: Vec<Option<u32>>,
    /// For each vertex, its number of corners.
    valence: Vec<u32>,
    /// For each corner, its face.
    face: Vec<FaceId>,
    /// For each corner, the next corner around its vertex, counter-clockwise.
    next_around: Vec<u32>,
}

impl Walk {
    /// ```text
    ///       ╲  next_around(c)     the side that ends at v starts at prev(c);
    ///        ╲    ╱               its twin leaves v in the next face
    ///   prev(c) ─ v
    ///            ╱ c
    /// ```
    fn new(mesh: &IndexedMesh) -> Result<Self, DualError> {
        let (vertices, faces) = (mesh.positions.len(), &mesh.faces);
        let corners = faces.corners();
        let pairs = TwinPairs::new(vertices, faces).ok_or_else(|| mesh.non_manifold_error())?;
        if 2 * pairs.edge_count != corners.len() {
            return Err(boundary_edge_error(faces, &pairs));
        }
        let mut corner_of_half = vec![0_u32; corners.len()];
        for (corner, &half) in (0_u32..).zip(&pairs.half_of_corner) {
            corner_of_half[half as usize] = corner;
        }
        let mut walk = Self {
            first: vec![None; vertices],
            valence: vec![0; vertices],
            face: Vec::with_capacity(corners.len()),
            next_around: Vec::with_capacity(corners.len()),
        };
        for (f, face) in faces.iter() {
            let range = faces.range(f);
            let mut prev = range.end - 1;
            for (corner, v) in range.zip(face) {
                walk.first[v.index()].get_or_insert(row(corner));
                walk.valence[v.index()] += 1;
                walk.face.push(f);
                let twin = pairs.half_of_corner[prev] ^ 1;
                walk.next_around.push(corner_of_half[twin as usize]);
                prev = corner;
            }
        }
        Ok(walk)
    }

    /// Returns the faces of the dual: one walk around each vertex.
    fn dual_faces(&self, mesh: &IndexedMesh) -> Result<FaceList, DualError> {
        let mut faces = FaceList::with_capacity(self.face.len());
        let mut ring = Vec::new();
        for (vertex, (first, &valence)) in self.first.iter().zip(&self.valence).enumerate() {
            let vertex = VertexId::new(row(vertex));
            let first = first.ok_or(DualError::IsolatedVertex { vertex })?;
            ring.clear();
            self.append_ring(first, &mut ring);
            if ring.len() < valence as usize {
                return Err(mesh.non_manifold_error()); // the vertex has a second fan
            }
            if ring.len() < 3 {
                let valence = ring.len();
                return Err(DualError::LowValence { vertex, valence });
            }
            let face = ring.iter().copied();
            faces.push(face).expect("no corners are added");
        }
        Ok(faces)
    }

    /// Appends the faces around the vertex of corner `first` to `ring`.
    fn append_ring(&self, first: u32, ring: &mut Vec<VertexId>) {
        let mut corner = first;
        loop {
            ring.push(VertexId::new(row(self.face[corner as usize].index())));
            corner = self.next_around[corner as usize];
            if corner == first {
                return;
            }
        }
    }
}

fn boundary_edge_error(faces: &FaceList, pairs: &TwinPairs) -> DualError {
    let mut sides = vec![0_u8; pairs.edge_count];
    for half in &pairs.half_of_corner {
        sides[(half >> 1) as usize] += 1;
    }
    let ends = faces.iter().flat_map(|(f, face)| {
        let next = face.iter().cycle().skip(1);
        let sides = &sides;
        faces
            .range(f)
            .zip(face.iter().zip(next))
            .filter_map(move |(corner, (&a, &b))| {
                let edge = pairs.half_of_corner[corner] >> 1;
                (sides[edge as usize] == 1).then(|| [a.min(b), a.max(b)])
            })
    });
    let ends = ends.min().expect("an edge has only one side");
    DualError::BoundaryEdge { ends }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{BuildError, Point, Representation};
    use sixfold_half_edge::HalfEdgeMesh;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;

    fn dual_of(polygons: &PolygonMesh) -> Result<PolygonMesh, DualError> {
        dual(&IndexedFaceSet::from_polygons(polygons).expect("it accepts any mesh"))
    }

    fn mesh(vertices: u32, faces: &[&[u32]]) -> PolygonMesh {
        let points: Vec<Point> = (0..vertices).map(|i| Point::splat(i as f32)).collect();
        PolygonMesh::new(points, faces).expect("valid")
    }

    /// Returns the corners of a face, starting at the lowest corner.
    fn cycle(face: &[VertexId]) -> Vec<VertexId> {
        let lowest = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
        [&face[lowest..], &face[..lowest]].concat()
    }

    fn cycles(polygons: &PolygonMesh) -> Vec<Vec<VertexId>> {
        polygons
            .faces()
            .iter()
            .map(|(_, face)| cycle(face))
            .collect()
    }

    #[test]
    fn platonic_solids_are_duals_of_each_other() {
        let duals = [
            (sixfold_shapes::tetrahedron(), sixfold_shapes::tetrahedron()),
            (sixfold_shapes::cube(), sixfold_shapes::octahedron()),
            (sixfold_shapes::octahedron(), sixfold_shapes::cube()),
            (
                sixfold_shapes::dodecahedron(),
                sixfold_shapes::icosahedron(),
            ),
            (
                sixfold_shapes::icosahedron(),
                sixfold_shapes::dodecahedron(),
            ),
        ];
        for (solid, expected) in duals {
            let dual = dual_of(&solid).expect("closed");
            assert_eq!(dual.vertex_count(), expected.vertex_count());
            assert_eq!(dual.face_count(), expected.face_count());
            assert_eq!(
                dual.faces().uniform_degree(),
                expected.faces().uniform_degree()
            );
            let built = HalfEdgeMesh::from_polygons(&dual).expect("a manifold");
            // The vertices of the dual are on one sphere.
            let radius = dual.positions()[0].length();
            assert!(
                dual.positions()
                    .iter()
                    .all(|p| (p.length() - radius).abs() < 1e-6)
            );
            let normals = crate::face_normals(&built);
            for (f, corners) in dual.faces().iter() {
                let middle: Point = corners.iter().map(|&v| dual.position(v)).sum();
                assert!(normals[f].distance(middle.normalize()) < 1e-5, "{f}");
            }
        }
        let axes = dual_of(&sixfold_shapes::cube()).expect("closed");
        let expected = [
            Point::NEG_Z,
            Point::NEG_Y,
            Point::X,
            Point::Y,
            Point::NEG_X,
            Point::Z,
        ];
        assert_eq!(axes.positions(), expected);
    }

    #[test]
    fn the_dual_of_the_dual_has_the_faces_of_the_mesh() {
        let tori = [
            sixfold_shapes::torus(5, 4),
            sixfold_shapes::triangle_torus(4, 5),
            sixfold_shapes::antiprism(6),
        ];
        for closed in tori.map(|shape| shape.expect("small")).into_iter().chain([
            sixfold_shapes::cube(),
            sixfold_shapes::dodecahedron(),
            sixfold_shapes::shuffled(&sixfold_shapes::icosahedron(), 3),
            sixfold_shapes::geodesic(3).expect("small"),
        ]) {
            let dual = dual_of(&closed).expect("closed");
            let again = dual_of(&dual).expect("closed");
            assert_eq!(cycles(&again), cycles(&closed));
        }
    }

    #[test]
    fn an_empty_mesh_is_its_own_dual() {
        assert_eq!(dual_of(&PolygonMesh::default()), Ok(PolygonMesh::default()));
    }

    #[test]
    fn each_error_names_the_element() {
        let v = VertexId::new;
        let open = mesh(4, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3]]);
        let ends = [v(0), v(2)];
        assert_eq!(dual_of(&open), Err(DualError::BoundaryEdge { ends }));

        let lone = mesh(5, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]);
        assert_eq!(
            dual_of(&lone),
            Err(DualError::IsolatedVertex { vertex: v(4) })
        );

        let pillow = mesh(3, &[&[0, 1, 2], &[2, 1, 0]]);
        let low = DualError::LowValence {
            vertex: v(0),
            valence: 2,
        };
        assert_eq!(dual_of(&pillow), Err(low));

        let tetrahedra: [&[u32]; 8] = [
            &[0, 2, 1],
            &[0, 1, 3],
            &[1, 2, 3],
            &[2, 0, 3],
            &[0, 5, 4],
            &[0, 4, 6],
            &[4, 5, 6],
            &[5, 0, 6],
        ];
        assert!(matches!(
            dual_of(&mesh(7, &tetrahedra)),
            Err(DualError::NotOrientedManifold(BuildError::NonManifoldVertex { vertex, .. })) if vertex == v(0)
        ));
        let book = mesh(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
        assert!(matches!(
            dual_of(&book),
            Err(DualError::NotOrientedManifold(
                BuildError::NonManifoldEdge { .. }
            ))
        ));
        let reversed = mesh(4, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 2, 3]]);
        assert!(matches!(
            dual_of(&reversed),
            Err(DualError::NotOrientedManifold(
                BuildError::RepeatedSide { .. }
            ))
        ));
    }
}

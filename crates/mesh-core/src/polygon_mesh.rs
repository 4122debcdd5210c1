//! The neutral mesh: what goes into every structure and comes out of it.

use crate::Point;
use crate::distinct::IteratorExt;
use crate::error::PolygonError;
use crate::face_list::FaceList;
use crate::incidence::{EdgeUse, Incidence};
use crate::representation::Counts;
use crate::row_id::{FaceId, MAX_ROWS, VertexId, row};

/// Positions and polygons: the mesh as a list of faces, before any structure.
///
/// # Invariants
///
/// - I1  Every face names at least three vertices, each of them there and each once.
/// - I2  There are at most [`MAX_ROWS`] vertices, faces and corners.
///
/// Nothing else is promised: edges with three faces, faces that disagree about the side, isolated
/// and coincident vertices are all allowed, and each structure says what it can hold.
///
/// # Examples
///
/// ```
/// use mesh_core::{Point, PolygonMesh};
///
/// let corners = [Point::ZERO, Point::X, Point::Y, Point::Z];
/// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let tetrahedron = PolygonMesh::new(corners, faces)?;
/// assert_eq!(tetrahedron.face_count(), 4);
/// assert!(PolygonMesh::new(corners, [[0, 1, 1]]).is_err());
/// # Ok::<(), mesh_core::PolygonError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    positions: Vec<Point>,
    faces: FaceList,
}

impl PolygonMesh {
    /// A mesh of `positions` and `faces`, each a list of vertex numbers from 0; O(corners).
    ///
    /// # Errors
    ///
    /// The first face that breaks I1, or what there is too much of.
    pub fn new<F: AsRef<[u32]>>(
        positions: impl Into<Vec<Point>>,
        faces: impl IntoIterator<Item = F>,
    ) -> Result<Self, PolygonError> {
        let mut list = FaceList::default();
        for face in faces {
            list.push(face.as_ref().iter().copied().map(VertexId::new))?;
        }
        Self::from_faces(positions.into(), list)
    }

    /// A mesh of `positions` and a ready list of faces; O(corners), and nothing is copied.
    ///
    /// # Errors
    ///
    /// The first face that breaks I1, or what there is too much of.
    pub fn from_faces(positions: Vec<Point>, faces: FaceList) -> Result<Self, PolygonError> {
        if positions.len() > MAX_ROWS {
            return Err(PolygonError::TooMany {
                elements: "vertices",
                limit: MAX_ROWS,
            });
        }
        let sound = match faces.uniform_degree() {
            Some(3) => all_sound::<3>(faces.corners(), positions.len()),
            Some(4) => all_sound::<4>(faces.corners(), positions.len()),
            _ => false,
        };
        if !sound {
            for (f, face) in faces.iter() {
                check_face(f, face, positions.len())?;
            }
        }
        Ok(Self { positions, faces })
    }

    /// How many vertices there are, isolated ones included.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// How many faces there are.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// How many corners all faces have together.
    pub fn corner_count(&self) -> usize {
        self.faces.corners().len()
    }

    /// The sizes that decide what a structure weighs, for a mesh known to have so many `edges`; O(1).
    pub fn counts(&self, edges: usize) -> Counts {
        Counts {
            vertices: self.vertex_count(),
            edges,
            faces: self.face_count(),
            corners: self.corner_count(),
            uniform: self.faces.is_empty() || self.faces.uniform_degree().is_some(),
        }
    }

    /// Every vertex.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = VertexId> + Clone {
        let vertices = row(self.positions.len());
        (0..vertices).map(VertexId::new)
    }

    /// Where each vertex is.
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Where `v` is.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    pub fn position(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }

    /// The faces as lists of vertices.
    pub fn faces(&self) -> &FaceList {
        &self.faces
    }

    /// The first face that is no triangle, and its degree; O(faces), O(1) where all have one degree.
    pub fn first_polygon(&self) -> Option<(FaceId, usize)> {
        if self.faces.uniform_degree() == Some(3) {
            return None;
        }
        let mut degrees = self.faces.iter().map(|(f, corners)| (f, corners.len()));
        degrees.find(|&(_, degree)| degree != 3)
    }

    /// The vertices whose faces form more than one fan, in their order; O(corners) expected.
    ///
    /// Faces are of one fan where a chain of faces leads from one to the other, each along an edge
    /// at the vertex. Orientation does not matter.
    pub fn vertices_of_several_fans(&self) -> Vec<VertexId> {
        let incidence = Incidence::of(self.vertex_count(), &self.faces, |_| true);
        let fans = incidence.several_fans(&self.faces).into_iter();
        let mut vertices: Vec<VertexId> = fans.map(|(v, _)| v).collect();
        vertices.sort_unstable();
        vertices
    }

    /// Every edge once, in the order of the ends; O(corners) expected.
    pub fn edge_uses(&self) -> Vec<EdgeUse> {
        let incidence = Incidence::of(self.vertex_count(), &self.faces, |_| true);
        incidence.edges().map(EdgeUse::of).collect()
    }

    /// The mesh with vertex `v` called `names[v]`; the faces stay in their order.
    ///
    /// # Panics
    ///
    /// If `names` is no permutation of the vertices.
    pub fn renamed(&self, names: &[u32]) -> Self {
        assert_eq!(names.len(), self.vertex_count(), "one name for each vertex");
        let mut positions = vec![None; names.len()];
        for (&name, &position) in names.iter().zip(&self.positions) {
            let before = positions[name as usize].replace(position);
            assert!(before.is_none(), "two vertices are called v{name}");
        }
        let positions = positions
            .into_iter()
            .map(|p| p.expect("a permutation"))
            .collect();
        let mut faces = FaceList::with_capacity(self.corner_count());
        for (_, face) in self.faces.iter() {
            let renamed = face.iter().map(|v| VertexId::new(names[v.index()]));
            faces.push(renamed).expect("as many corners as before");
        }
        Self { positions, faces }
    }

    /// The mesh with every polygon cut into triangles that fan out from its first corner; O(corners).
    ///
    /// A fan is right for convex faces; it may overlap itself on others, and may run one edge
    /// through two polygons that share two corners. The vertices stay as they are.
    ///
    /// # Errors
    ///
    /// [`PolygonError::TooMany`] where the triangles have more than [`MAX_ROWS`] corners.
    pub fn fan_triangulated(&self) -> Result<Self, PolygonError> {
        let mut faces = FaceList::with_capacity(self.corner_count());
        for (_, face) in self.faces.iter() {
            for pair in face[1..].windows(2) {
                let triangle = [face[0], pair[0], pair[1]];
                faces.push(triangle)?;
            }
        }
        Ok(Self {
            positions: self.positions.clone(),
            faces,
        })
    }
}

/// I1 for all faces at once, of a degree that the compiler knows; who fails is not told.
fn all_sound<const DEGREE: usize>(corners: &[VertexId], vertices: usize) -> bool {
    corners.as_chunks::<DEGREE>().0.iter().all(|face| {
        // Without a way out in between: there is next to never one to take.
        let mut sound = true;
        for (i, a) in face.iter().enumerate() {
            sound &= a.index() < vertices;
            for b in &face[..i] {
                sound &= a != b;
            }
        }
        sound
    })
}

/// I1 for one face.
fn check_face(face: FaceId, corners: &[VertexId], vertices: usize) -> Result<(), PolygonError> {
    if corners.len() < 3 {
        return Err(PolygonError::TooFewCorners {
            face,
            corners: corners.len(),
        });
    }
    if let Some(&vertex) = corners.iter().find(|v| v.index() >= vertices) {
        return Err(PolygonError::VertexOutOfRange {
            face,
            vertex,
            vertices,
        });
    }
    match repeated(corners) {
        Some(vertex) => Err(PolygonError::RepeatedVertex { face, vertex }),
        None => Ok(()),
    }
}

/// A vertex that `corners` name twice.
pub(crate) fn repeated(corners: &[VertexId]) -> Option<VertexId> {
    if let &[a, b, c] = corners {
        return match (a == b || a == c, b == c) {
            (true, _) => Some(a),
            (_, true) => Some(b),
            _ => None,
        };
    }
    let mut once = corners.iter().copied().distinct();
    corners.iter().copied().find(|&v| once.next() != Some(v))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [Point::ZERO, Point::X, Point::ONE, Point::Y];

    #[test]
    fn each_fault_is_named() {
        let fault = |face: &[u32]| PolygonMesh::new(SQUARE, [&[0, 1, 2][..], face]).unwrap_err();
        let face = FaceId::new(1);
        assert_eq!(
            fault(&[0, 1]),
            PolygonError::TooFewCorners { face, corners: 2 }
        );
        let vertex = VertexId::new(4);
        assert_eq!(
            fault(&[0, 1, 4]),
            PolygonError::VertexOutOfRange {
                face,
                vertex,
                vertices: 4
            }
        );
        for corners in [
            &[3, 0, 3][..],
            &[3, 3, 0],
            &[0, 3, 3],
            &[0, 3, 1, 3],
            &[0, 1, 3, 2, 3],
        ] {
            let vertex = VertexId::new(3);
            assert_eq!(
                fault(corners),
                PolygonError::RepeatedVertex { face, vertex }
            );
        }
    }

    #[test]
    fn a_fan_has_two_triangles_fewer_than_corners() {
        let square = PolygonMesh::new(SQUARE, [[0, 1, 2, 3]]).expect("valid");
        let fan = PolygonMesh::new(SQUARE, [[0, 1, 2], [0, 2, 3]]).expect("valid");
        assert_eq!(square.fan_triangulated(), Ok(fan));
    }

    #[test]
    fn edges_say_how_faces_use_them() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat);
        let mesh = PolygonMesh::new(corners, [[0, 1, 2], [1, 0, 3], [0, 2, 4]]).expect("valid");
        let uses = mesh.edge_uses();
        assert_eq!(uses.len(), 7);
        let of = |a: u32, b: u32| {
            let ends = [a, b].map(VertexId::new);
            let found = uses.iter().find(|edge| edge.ends == ends).expect("an edge");
            (found.faces, found.is_manifold())
        };
        assert_eq!(
            [of(0, 1), of(0, 3), of(0, 2)],
            [(2, true), (1, true), (2, true)]
        );
        let book = PolygonMesh::new(corners, [[0, 1, 2], [1, 0, 3], [0, 1, 4]]).expect("valid");
        let spine = book.edge_uses()[0];
        assert_eq!((spine.faces, spine.is_manifold()), (3, false));
        let turned = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 3]]).expect("valid");
        assert!(!turned.edge_uses()[0].is_manifold());
    }

    #[test]
    fn a_vertex_of_several_fans_is_found_whichever_way_faces_run() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat);
        let mesh = |faces: &[[u32; 3]]| PolygonMesh::new(corners, faces).expect("valid");
        let fans = |faces: &[[u32; 3]]| mesh(faces).vertices_of_several_fans();
        assert_eq!(fans(&[[0, 1, 2], [0, 3, 4]]), [VertexId::new(0)]);
        assert_eq!(fans(&[[0, 1, 2], [0, 1, 3]]), []);
    }

    #[test]
    fn renaming_moves_positions_and_corners_alike() {
        let square = PolygonMesh::new(SQUARE, [[0, 1, 2]]).expect("valid");
        let renamed = square.renamed(&[3, 0, 1, 2]);
        assert_eq!(
            renamed.faces().face(FaceId::new(0)),
            [3, 0, 1].map(VertexId::new)
        );
        assert_eq!(renamed.position(VertexId::new(3)), Point::ZERO);
    }
}

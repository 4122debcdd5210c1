//! The polygon mesh: the input and output of every structure.

use std::fmt;

use crate::Point;
use crate::handles::handle::Handle;
use crate::handles::iterator_ext::IteratorExt;
use crate::handles::row_id::{FaceId, MAX_ROWS, VertexId, row};
use crate::polygons::counts::Counts;
use crate::polygons::error::PolygonError;
use crate::polygons::face_list::FaceList;
use crate::polygons::fans::Fans;
use crate::polygons::incidence::{EdgeUse, Incidence};

/// A mesh as a list of vertex positions and a list of polygons. Every structure is built from a
/// polygon mesh and can be converted to a polygon mesh.
///
/// # Invariants
///
/// - I1  Every face has at least three corners. The corners of a face are existing vertices, and no
///   two corners are the same vertex.
/// - I2  There are at most [`MAX_ROWS`] vertices, faces and corners.
///
/// A polygon mesh can have edges with three faces, inconsistently oriented faces, and isolated or
/// coincident vertices. The capabilities of a structure state which polygon meshes the structure
/// can hold.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh};
///
/// let corners = [Point::ZERO, Point::X, Point::Y, Point::Z];
/// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let tetrahedron = PolygonMesh::new(corners, faces)?;
/// assert_eq!(tetrahedron.to_string(), "4 vertices, 4 faces");
/// assert!(PolygonMesh::new(corners, [[0, 1, 1]]).is_err());
/// # Ok::<(), sixfold_core::PolygonError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    positions: Vec<Point>,
    faces: FaceList,
}

impl PolygonMesh {
    /// Builds a mesh from `positions` and `faces`; O(vertices + corners). Each face is a list of
    /// vertex numbers, counted from 0.
    ///
    /// A position is a [`Point`] or three numbers (`[f32; 3]` or a tuple). With the feature `mint`,
    /// a position can be a point or vector of the crate `mint`. `into()` converts a [`Point`] to
    /// three numbers or to a type of `mint`.
    ///
    /// ```
    /// # use sixfold_core::PolygonMesh;
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = PolygonMesh::new(corners.clone(), [[0, 1, 2]])?;
    /// let back = triangle.positions().iter().map(|&p| p.into());
    /// assert_eq!(back.collect::<Vec<[f32; 3]>>(), corners);
    /// # Ok::<(), sixfold_core::PolygonError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error for the first face that violates I1, or if a number of elements violates
    /// I2.
    pub fn new<P: Into<Point>, F: AsRef<[u32]>>(
        positions: impl IntoIterator<Item = P>,
        faces: impl IntoIterator<Item = F>,
    ) -> Result<Self, PolygonError> {
        let mut list = FaceList::default();
        for face in faces {
            list.push(face.as_ref().iter().copied().map(VertexId::new))?;
        }
        Self::from_faces(positions.into_iter().map(Into::into).collect(), list)
    }

    /// Builds a mesh from `positions` and an existing list of faces; O(corners), without copying.
    ///
    /// # Errors
    ///
    /// Returns an error for the first face that violates I1, or if a number of elements violates
    /// I2.
    pub fn from_faces(positions: Vec<Point>, faces: FaceList) -> Result<Self, PolygonError> {
        if positions.len() > MAX_ROWS {
            return Err(PolygonError::TooMany {
                elements: "vertices",
                limit: MAX_ROWS,
            });
        }
        let valid = match faces.uniform_degree() {
            Some(3) => all_valid::<3>(faces.corners(), positions.len()),
            Some(4) => all_valid::<4>(faces.corners(), positions.len()),
            _ => false,
        };
        if !valid {
            for (f, face) in faces.iter() {
                check_face(f, face, positions.len())?;
            }
        }
        Ok(Self { positions, faces })
    }

    /// Returns the number of vertices, including isolated vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Returns the number of faces.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Returns the number of corners of all faces.
    pub fn corner_count(&self) -> usize {
        self.faces.corners().len()
    }

    /// Returns the sizes that determine the memory of a structure. The polygon mesh does not store
    /// the number of edges, so the caller must pass `edges`. O(1).
    pub fn counts(&self, edges: usize) -> Counts {
        Counts {
            vertices: self.vertex_count(),
            edges,
            faces: self.face_count(),
            corners: self.corner_count(),
            uniform: self.faces.is_empty() || self.faces.uniform_degree().is_some(),
        }
    }

    /// Returns whether a vertex has a face, for each vertex. O(vertices + corners).
    pub fn has_faces(&self) -> Vec<bool> {
        let mut has_faces = vec![false; self.vertex_count()];
        for v in self.faces.corners() {
            has_faces[v.index()] = true;
        }
        has_faces
    }

    /// Returns an iterator over all vertices.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = VertexId> + Clone {
        let vertices = row(self.positions.len());
        (0..vertices).map(VertexId::new)
    }

    /// Returns the positions of all vertices, in order.
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Returns the position of `v`.
    ///
    /// # Panics
    ///
    /// Panics if `v` does not exist.
    pub fn position(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }

    /// Returns the faces as lists of vertices.
    pub fn faces(&self) -> &FaceList {
        &self.faces
    }

    /// Returns the first face that is not a triangle, and its degree; O(faces), or O(1) if all
    /// faces have the same degree.
    pub fn first_polygon(&self) -> Option<(FaceId, usize)> {
        if self.faces.uniform_degree() == Some(3) {
            return None;
        }
        let mut degrees = self.faces.iter().map(|(f, corners)| (f, corners.len()));
        degrees.find(|&(_, degree)| degree != 3)
    }

    /// Returns the vertices whose faces form more than one fan, ascending; O(n log n) for n
    /// corners.
    ///
    /// Two faces at a vertex are in the same fan if they share an edge at this vertex. The
    /// orientation of the faces does not matter.
    pub fn vertices_of_several_fans(&self) -> Vec<VertexId> {
        let incidence = Incidence::new(self.vertex_count(), &self.faces, |_| true);
        let fans = Fans::new(&incidence).several().into_iter();
        let mut vertices: Vec<VertexId> = fans.map(|(v, _)| v).collect();
        vertices.sort_unstable();
        vertices
    }

    /// Returns every edge once, with the number and the directions of its faces; O(n log n) for n
    /// corners. The edges are ordered by their lower end, then by their higher end.
    pub fn edge_uses(&self) -> Vec<EdgeUse> {
        let incidence = Incidence::new(self.vertex_count(), &self.faces, |_| true);
        incidence.edges().map(EdgeUse::from_sides).collect()
    }

    /// Returns the mesh with vertex `v` renumbered as `numbers[v]`; the faces keep their order.
    ///
    /// # Panics
    ///
    /// Panics if `numbers` is not a permutation of the vertices.
    pub fn renumbered(&self, numbers: &[u32]) -> Self {
        assert_eq!(
            numbers.len(),
            self.vertex_count(),
            "`numbers` needs one number for each vertex"
        );
        let mut positions = vec![None; numbers.len()];
        for (&number, &position) in numbers.iter().zip(&self.positions) {
            let before = positions[number as usize].replace(position);
            assert!(before.is_none(), "two vertices get the number {number}");
        }
        let positions = positions
            .into_iter()
            .map(|p| p.expect("a permutation"))
            .collect();
        let mut faces = FaceList::with_capacity(self.corner_count());
        for (_, face) in self.faces.iter() {
            let renumbered = face.iter().map(|v| VertexId::new(numbers[v.index()]));
            faces.push(renumbered).expect("as many corners as before");
        }
        Self { positions, faces }
    }
}

/// Prints the numbers of vertices and faces, for example `8 vertices, 6 faces`.
impl fmt::Display for PolygonMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let vertices = match self.vertex_count() {
            1 => "vertex",
            _ => "vertices",
        };
        let faces = match self.face_count() {
            1 => "face",
            _ => "faces",
        };
        let (v, n) = (self.vertex_count(), self.face_count());
        write!(f, "{v} {vertices}, {n} {faces}")
    }
}

/// Returns whether all faces satisfy I1. All faces have `DEGREE` corners.
fn all_valid<const DEGREE: usize>(corners: &[VertexId], vertices: usize) -> bool {
    corners.as_chunks::<DEGREE>().0.iter().all(|face| {
        // No early exit: it would almost never be taken.
        let mut valid = true;
        for (i, a) in face.iter().enumerate() {
            valid &= a.index() < vertices;
            for b in &face[..i] {
                valid &= a != b;
            }
        }
        valid
    })
}

/// Checks I1 for one face.
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

/// Returns the first corner that repeats an earlier corner.
pub(crate) fn repeated<V: Handle>(corners: &[V]) -> Option<V> {
    if let &[a, b, c] = corners {
        return match (a == b || a == c, b == c) {
            (true, _) => Some(a),
            (_, true) => Some(b),
            _ => None,
        };
    }
    let mut distinct = corners.iter().copied().distinct();
    corners
        .iter()
        .copied()
        .find(|&v| distinct.next() != Some(v))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [Point::ZERO, Point::X, Point::ONE, Point::Y];

    #[test]
    fn each_fault_has_its_error() {
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
    fn edge_uses_count_faces_and_compare_directions() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat);
        let mesh = PolygonMesh::new(corners, [[0, 1, 2], [1, 0, 3], [0, 2, 4]]).expect("valid");
        let uses = mesh.edge_uses();
        assert_eq!(uses.len(), 7);
        let use_of = |a: u32, b: u32| {
            let ends = [a, b].map(VertexId::new);
            let found = uses.iter().find(|edge| edge.ends == ends).expect("an edge");
            (found.faces, found.is_manifold())
        };
        assert_eq!(
            [use_of(0, 1), use_of(0, 3), use_of(0, 2)],
            [(2, true), (1, true), (2, true)]
        );
        let book = PolygonMesh::new(corners, [[0, 1, 2], [1, 0, 3], [0, 1, 4]]).expect("valid");
        let spine = book.edge_uses()[0];
        assert_eq!((spine.faces, spine.is_manifold()), (3, false));
        let inconsistent = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 3]]).expect("valid");
        assert!(!inconsistent.edge_uses()[0].is_manifold());
    }

    #[test]
    fn a_vertex_of_several_fans_is_found_for_any_orientation() {
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0].map(Point::splat);
        let mesh = |faces: &[[u32; 3]]| PolygonMesh::new(corners, faces).expect("valid");
        let fans = |faces: &[[u32; 3]]| mesh(faces).vertices_of_several_fans();
        assert_eq!(fans(&[[0, 1, 2], [0, 3, 4]]), [VertexId::new(0)]);
        assert_eq!(fans(&[[0, 1, 2], [0, 1, 3]]), []);
    }

    #[test]
    fn renumbering_changes_positions_and_corners() {
        let square = PolygonMesh::new(SQUARE, [[0, 1, 2]]).expect("valid");
        let renumbered = square.renumbered(&[3, 0, 1, 2]);
        assert_eq!(
            renumbered.faces().face(FaceId::new(0)),
            [3, 0, 1].map(VertexId::new)
        );
        assert_eq!(renumbered.position(VertexId::new(3)), Point::ZERO);
    }
}

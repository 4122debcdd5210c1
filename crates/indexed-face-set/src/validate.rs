//! One check for each invariant.

use sixfold_core::invariant_checks::{check_corners_of_face, fails};
use sixfold_core::{Editing, HoleSet, InvariantError, MeshQuery, Probe};

use crate::mesh::IndexedFaceSet;

impl<P: Probe, E: Editing> IndexedFaceSet<E, P> {
    /// Checks I1, then I3 and I2, which rely on I1.
    pub(crate) fn check_invariants(&self) -> Result<(), InvariantError> {
        self.check_spans()?;
        self.check_holes()?;
        self.check_faces()
    }

    /// I1: the faces share no corners, and each face has at least three corners.
    fn check_spans(&self) -> Result<(), InvariantError> {
        let checked = self.spans().check(self.corners().len());
        checked.or_else(|detail| fails("I1", detail))
    }

    /// I3: holes are rows, and exactly the corners of no face are blank.
    fn check_holes(&self) -> Result<(), InvariantError> {
        let checked = self.vertex_holes.check(self.positions.len());
        let checked = checked.and_then(|()| self.faces.check_holes());
        checked.or_else(|detail| fails("I3", detail))
    }

    /// I2: the vertices of a face exist and are distinct.
    fn check_faces(&self) -> Result<(), InvariantError> {
        let exists = |v| self.contains_vertex(v);
        let mut faces = self.faces();
        faces.try_for_each(|f| check_corners_of_face("I2", f, self.face(f), exists))
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{
        FaceId, FaceSpans, MeshEdit, Point, PolygonMesh, Representation, Table, VertexId,
    };
    use sixfold_scanning::ScannedVertex;

    use crate::EditableIndexedFaceSet;

    const CORNERS: [Point; 5] = [Point::ZERO, Point::X, Point::ONE, Point::Y, Point::Z];

    /// Returns the invariant that fails after `break_it`.
    fn broken(faces: &[&[u32]], break_it: impl Fn(&mut EditableIndexedFaceSet)) -> &'static str {
        let polygons = PolygonMesh::new(CORNERS, faces).expect("valid");
        let mut mesh = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds every mesh");
        assert_eq!(mesh.validate(), Ok(()));
        break_it(&mut mesh);
        mesh.validate().expect_err("the mesh is broken").invariant
    }

    const TRIANGLES: &[&[u32]] = &[&[0, 1, 2], &[0, 2, 3]];
    const MIXED: &[&[u32]] = &[&[0, 1, 2], &[0, 2, 3, 4], &[0, 4, 1]];

    #[test]
    fn spans_that_do_not_partition_the_corners_break_i1() {
        let uniform = |degree, faces| {
            move |mesh: &mut EditableIndexedFaceSet| {
                mesh.faces.spans = FaceSpans::Uniform { degree, faces };
            }
        };
        for (degree, faces) in [(3, 1), (3, 3), (2, 3), (4, 2), (u32::MAX, u32::MAX)] {
            assert_eq!(broken(TRIANGLES, uniform(degree, faces)), "I1");
        }
        for offsets in [
            &[][..],
            &[0],
            &[1, 4, 7, 10],
            &[0, 3, 5, 10],
            &[0, 7, 3, 10],
            &[0, 3, 7],
            &[0, 3, 7, 11],
        ] {
            let mixed = |mesh: &mut EditableIndexedFaceSet| {
                mesh.faces.spans =
                    FaceSpans::Mixed(Table::new("offsets", "face", offsets.to_vec()));
            };
            assert_eq!(broken(MIXED, mixed), "I1", "{offsets:?}");
        }
    }

    #[test]
    fn missing_or_repeated_vertices_break_i2() {
        for faces in [TRIANGLES, MIXED] {
            let name = |corner: usize, v| {
                move |mesh: &mut EditableIndexedFaceSet| {
                    mesh.faces.corners.rows_mut()[corner] = VertexId::new(v);
                }
            };
            assert_eq!(broken(faces, name(4, 5)), "I2");
            assert_eq!(broken(faces, name(4, 3)), "I2");
            assert_eq!(broken(faces, name(0, 2)), "I2");
        }
    }
    #[test]
    fn used_holes_and_blank_corners_of_faces_break_i3() {
        for faces in [TRIANGLES, MIXED] {
            let blank = |mesh: &mut EditableIndexedFaceSet| {
                mesh.faces.corners.rows_mut()[4] = VertexId::BLANK;
            };
            assert_eq!(broken(faces, blank), "I3");
            let used = |mesh: &mut EditableIndexedFaceSet| mesh.faces.holes.insert(1);
            assert_eq!(broken(faces, used), "I3");
            let beyond = |mesh: &mut EditableIndexedFaceSet| mesh.vertex_holes.insert(5);
            assert_eq!(broken(faces, beyond), "I3");
            let reused = |mesh: &mut EditableIndexedFaceSet| {
                let f = FaceId::new(1);
                mesh.remove_face(f).expect("f1 exists");
                assert_eq!(mesh.validate(), Ok(()));
                mesh.faces.corners.rows_mut()[5] = VertexId::new(0);
            };
            assert_eq!(broken(faces, reused), "I3");
            // A face with a deleted vertex breaks I2.
            let named = |mesh: &mut EditableIndexedFaceSet| mesh.vertex_holes.insert(2);
            assert_eq!(broken(faces, named), "I2");
        }
    }
}

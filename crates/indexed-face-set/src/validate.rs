//! One check for each invariant.

use mesh_core::{FaceSpans, InvariantError, IteratorExt, MeshQuery, Probe};

use crate::mesh::IndexedFaceSet;

impl<P: Probe> IndexedFaceSet<P> {
    /// Checks I1, then I2, which relies on it.
    pub(crate) fn check_invariants(&self) -> Result<(), InvariantError> {
        self.check_spans()?;
        self.check_faces()
    }

    /// I1: the faces divide the corners among them, at least three each.
    fn check_spans(&self) -> Result<(), InvariantError> {
        let fails = |detail: String| Err(InvariantError::new("I1", detail));
        let covered = match &self.spans {
            FaceSpans::Uniform { degree, faces } => {
                if *degree < 3 {
                    return fails(format!("faces have {degree} corners"));
                }
                u64::from(*degree) * u64::from(*faces)
            }
            FaceSpans::Mixed(offsets) => {
                let offsets = offsets.rows();
                for (f, span) in offsets.windows(2).enumerate() {
                    if u64::from(span[0]) + 3 > u64::from(span[1]) {
                        return fails(format!("f{f} has the corners {}..{}", span[0], span[1]));
                    }
                }
                match *offsets {
                    [0, .., end] => u64::from(end),
                    _ => return fails("the offsets do not begin with 0 and end later".to_owned()),
                }
            }
        };
        let corners = self.corners.len();
        if covered != corners as u64 {
            return fails(format!("the faces have {covered} corners of {corners}"));
        }
        Ok(())
    }

    /// I2: a face names vertices that are there, each once.
    fn check_faces(&self) -> Result<(), InvariantError> {
        let fails = |detail: String| Err(InvariantError::new("I2", detail));
        for f in self.faces() {
            let face = self.face(f);
            if let Some(v) = face.iter().find(|v| v.index() >= self.positions.len()) {
                return fails(format!("{f} names {v}, which is not there"));
            }
            let mut once = face.iter().distinct();
            if let Some(v) = face.iter().find(|&v| once.next() != Some(v)) {
                return fails(format!("{f} names {v} twice"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{Point, PolygonMesh, Representation, Table, VertexId};

    use super::*;

    const CORNERS: [Point; 5] = [Point::ZERO, Point::X, Point::ONE, Point::Y, Point::Z];

    /// The invariant that fails once `break_it` has had its way with a mesh of these faces.
    fn broken(faces: &[&[u32]], break_it: impl Fn(&mut IndexedFaceSet)) -> &'static str {
        let polygons = PolygonMesh::new(CORNERS, faces).expect("valid");
        let mut mesh = IndexedFaceSet::from_polygons(&polygons).expect("anything is held");
        assert_eq!(mesh.validate(), Ok(()));
        break_it(&mut mesh);
        mesh.validate().expect_err("the mesh is broken").invariant
    }

    const TRIANGLES: &[&[u32]] = &[&[0, 1, 2], &[0, 2, 3]];
    const MIXED: &[&[u32]] = &[&[0, 1, 2], &[0, 2, 3, 4], &[0, 4, 1]];

    #[test]
    fn spans_that_do_not_divide_the_corners_break_i1() {
        let uniform = |degree, faces| {
            move |mesh: &mut IndexedFaceSet| {
                mesh.spans = FaceSpans::Uniform { degree, faces };
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
            let mixed = |mesh: &mut IndexedFaceSet| {
                mesh.spans = FaceSpans::Mixed(Table::new("offsets", "face", offsets.to_vec()));
            };
            assert_eq!(broken(MIXED, mixed), "I1", "{offsets:?}");
        }
    }

    #[test]
    fn corners_that_name_no_vertex_or_one_twice_break_i2() {
        for faces in [TRIANGLES, MIXED] {
            let name = |corner: usize, v| {
                move |mesh: &mut IndexedFaceSet| {
                    mesh.corners.rows_mut()[corner] = VertexId::new(v);
                }
            };
            assert_eq!(broken(faces, name(4, 5)), "I2");
            assert_eq!(broken(faces, name(4, u32::MAX)), "I2");
            assert_eq!(broken(faces, name(4, 3)), "I2");
            assert_eq!(broken(faces, name(0, 2)), "I2");
        }
    }
}

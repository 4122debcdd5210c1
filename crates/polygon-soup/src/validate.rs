//! One check for each invariant.

use sixfold_core::invariant_checks::fails;
use sixfold_core::{Editing, InvariantError, IteratorExt, MeshQuery, Probe};
use sixfold_scanning::ScannedVertex;

use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

impl<P: Probe, E: Editing> PolygonSoup<E, P> {
    /// Checks I1, then I4, which relies on I1, then I2 and I3.
    pub(crate) fn check_invariants(&self) -> Result<(), InvariantError> {
        self.check_spans()?;
        self.check_holes()?;
        self.check_zeros()?;
        self.check_faces()
    }

    /// I1: the faces share no corners, and each face has at least three corners.
    fn check_spans(&self) -> Result<(), InvariantError> {
        let checked = self.spans().check(self.corners().len());
        checked.or_else(|detail| fails("I1", detail))
    }

    /// I4: holes are faces, and exactly the corners of no face are blank.
    fn check_holes(&self) -> Result<(), InvariantError> {
        let checked = self.faces.check_holes();
        checked.or_else(|detail| fails("I4", detail))
    }

    /// I2: no coordinate is −0, and only blank corners have the x of a blank corner.
    fn check_zeros(&self) -> Result<(), InvariantError> {
        let stored = self.corners().iter().enumerate();
        let mut stored = stored.filter(|(_, p)| !SoupVertex::BLANK.is_at(p));
        match stored.find(|(_, p)| !SoupVertex::at(**p).is_at(p)) {
            Some((corner, point)) => {
                let detail = format!("corner {corner} is at {point}, with a negative zero");
                fails("I2", detail)
            }
            None => Ok(()),
        }
    }

    /// I3: the corners of a face are at different positions.
    fn check_faces(&self) -> Result<(), InvariantError> {
        for f in self.faces() {
            let mut once = self.face_vertices(f).distinct();
            if let Some(v) = self.face_vertices(f).find(|&v| once.next() != Some(v)) {
                let detail = format!("two corners of {f} are at {v}");
                return fails("I3", detail);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{
        Editable, FaceId, FaceSpans, MeshEdit, Point, PolygonMesh, Representation, Table, Untraced,
    };

    use crate::EditablePolygonSoup;

    const SQUARE: [Point; 4] = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];

    fn soup(faces: &[&[u32]]) -> EditablePolygonSoup {
        let polygons = PolygonMesh::new(SQUARE, faces).expect("valid");
        let soup = EditablePolygonSoup::from_polygons(&polygons).expect("a valid soup");
        assert_eq!(soup.validate(), Ok(()));
        soup
    }

    fn fault(soup: &EditablePolygonSoup) -> String {
        soup.validate().expect_err("broken on purpose").to_string()
    }

    fn mixed(offsets: &[u32]) -> FaceSpans<Untraced, Editable> {
        FaceSpans::Mixed(Table::new("offsets", "face", offsets.to_vec()))
    }

    #[test]
    fn i1_corners_of_no_face() {
        let mut broken = soup(&[&[0, 1, 2], &[0, 2, 3]]);
        broken.faces.spans = FaceSpans::Uniform {
            degree: 3,
            faces: 1,
        };
        assert_eq!(fault(&broken), "I1 fails: corners 3..6 belong to no face");
        broken.faces.spans = FaceSpans::Uniform {
            degree: 2,
            faces: 3,
        };
        assert_eq!(fault(&broken), "I1 fails: f0 has the corners 0..2 of 6");
    }

    #[test]
    fn i1_offsets_that_do_not_partition_the_corners() {
        let mut broken = soup(&[&[0, 1, 2, 3], &[0, 1, 2]]);
        broken.faces.spans = mixed(&[0, 4, 6]);
        assert_eq!(fault(&broken), "I1 fails: f1 has the corners 4..6 of 7");
        broken.faces.spans = mixed(&[0, 4, 2]);
        assert_eq!(fault(&broken), "I1 fails: f1 has the corners 4..2 of 7");
        broken.faces.spans = mixed(&[0, 4, 8]);
        assert_eq!(fault(&broken), "I1 fails: f1 has the corners 4..8 of 7");
        broken.faces.spans = mixed(&[1, 4, 7]);
        assert_eq!(fault(&broken), "I1 fails: f0 has the corners 1..4 of 7");
        broken.faces.spans = mixed(&[]);
        assert_eq!(fault(&broken), "I1 fails: the table of offsets is empty");
    }

    #[test]
    fn i2_negative_zero() {
        let mut broken = soup(&[&[0, 1, 2, 3]]);
        broken.faces.corners.rows_mut()[3].z = -0.0;
        let expected = "I2 fails: corner 3 is at [0, 1, -0], with a negative zero";
        assert_eq!(fault(&broken), expected);
    }

    #[test]
    fn i3_two_corners_at_one_position() {
        let mut broken = soup(&[&[0, 1, 2], &[0, 2, 3]]);
        broken.faces.corners.rows_mut()[5] = SQUARE[0];
        assert_eq!(
            fault(&broken),
            "I3 fails: two corners of f1 are at (0, 0, 0)"
        );
    }
    #[test]
    fn i4_blank_corners_of_faces_and_used_corners_of_no_face() {
        let mut broken = soup(&[&[0, 1, 2], &[0, 2, 3]]);
        broken.faces.holes.insert(1);
        let expected = "I4 fails: corner 3 is not blank, but no face has it";
        assert_eq!(fault(&broken), expected);
        let mut broken = soup(&[&[0, 1, 2], &[0, 2, 3]]);
        broken.remove_face(FaceId::new(0)).expect("a face");
        assert_eq!(broken.validate(), Ok(()));
        let blank = broken.corners()[0];
        broken.faces.corners.rows_mut()[4] = blank;
        let expected = "I4 fails: corner 4 is blank, but a face has it";
        assert_eq!(fault(&broken), expected);
    }
}

//! One check for each invariant.

use sixfold_core::invariant_checks::{check_corners_of_face, check_holes, fails};
use sixfold_core::{Editing, FaceId, HoleSet, InvariantError, MeshQuery, Probe, VertexId, row};

use crate::mesh::{BLANK_CORNER, BLANK_PLACE, FaceVertexMesh, Fan};

impl<P: Probe, E: Editing> FaceVertexMesh<E, P> {
    pub(crate) fn check_invariants(&self) -> Result<(), InvariantError> {
        self.check_spans()?;
        self.check_faces()?;
        self.check_pool()?;
        self.check_fans()?;
        self.check_holes()?;
        self.check_blanks()
    }

    /// I1, first part: the faces share no corners, and each face has at least three corners.
    fn check_spans(&self) -> Result<(), InvariantError> {
        let checked = self.spans.check(self.corners.len());
        checked.or_else(|detail| fails("I1", detail))
    }

    /// I1, second part: the vertices of a face exist and are distinct.
    fn check_faces(&self) -> Result<(), InvariantError> {
        let exists = |v| self.vertex_holes.contains(v, self.positions.len());
        let mut faces = self.faces();
        faces.try_for_each(|f| check_corners_of_face("I1", f, self.known_face(f), exists))
    }

    /// I2: every fan is inside the pool, and no two fans overlap.
    fn check_pool(&self) -> Result<(), InvariantError> {
        let fails = |detail: String| fails("I2", detail);
        if self.fans.len() != self.positions.len() {
            let (fans, vertices) = (self.fans.len(), self.positions.len());
            return fails(format!("there are {fans} fans for {vertices} vertices"));
        }
        let mut owner = vec![None; self.pool.len()];
        for v in self.vertices() {
            let fan = self.fans.rows()[v.index()];
            if fan.len == 0 {
                continue;
            }
            let Some(places) = owner.get_mut(fan.range()) else {
                return fails(format!("the fan of {v} reaches beyond the pool"));
            };
            for place in places {
                if let Some(other) = place.replace(v) {
                    return fails(format!("the fans of {other} and {v} overlap"));
                }
            }
        }
        Ok(())
    }

    /// I3: the fan of a vertex contains exactly the faces with a corner there, each once.
    fn check_fans(&self) -> Result<(), InvariantError> {
        let mut expected: Vec<Vec<FaceId>> = vec![Vec::new(); self.fans.len()];
        for f in self.faces() {
            for v in self.known_face(f) {
                expected[v.index()].push(f);
            }
        }
        for v in self.vertices() {
            let expected = &expected[v.index()];
            let mut fan = self.pool.rows()[self.fans.rows()[v.index()].range()].to_vec();
            fan.sort_unstable();
            let fault = if let Some(twice) = fan.windows(2).find(|pair| pair[0] == pair[1]) {
                format!("contains {} twice", twice[0])
            } else if let Some(f) = fan.iter().find(|f| expected.binary_search(f).is_err()) {
                format!("contains {f}, which has no corner there")
            } else if let Some(f) = expected.iter().find(|f| fan.binary_search(f).is_err()) {
                format!("does not contain {f}")
            } else {
                continue;
            };
            return fails("I3", format!("the fan of {v} {fault}"));
        }
        Ok(())
    }

    /// I4, first part: exactly the holes are marked as deleted.
    fn check_holes(&self) -> Result<(), InvariantError> {
        let fails = |detail: String| fails("I4", detail);
        let kinds = [
            (&self.vertex_holes, self.vertex_rows()),
            (&self.face_holes, self.face_rows()),
        ];
        check_holes("I4", kinds)?;
        for (v, fan) in (0..row(self.fans.len())).zip(self.fans.rows()) {
            if (*fan == Fan::DELETED) != self.vertex_holes.has(v as usize) {
                let v = VertexId::new(v);
                return fails(format!(
                    "vertex holes and {fan:?} disagree on whether {v} was deleted"
                ));
            }
        }
        let faces = (0..row(self.spans.len())).map(FaceId::new);
        for f in faces.filter(|f| self.face_holes.has(f.index())) {
            let face = self.known_face(f);
            if let Some(v) = face.iter().find(|&&v| v != BLANK_CORNER) {
                return fails(format!("{f} was deleted but has the corner {v}"));
            }
        }
        Ok(())
    }

    /// I4, second part: all entries outside faces and fans are blank.
    fn check_blanks(&self) -> Result<(), InvariantError> {
        let fails = |detail: String| fails("I4", detail);
        let corners: usize = self.faces().map(|f| self.known_face(f).len()).sum();
        let named = self.corners.rows().iter().filter(|&&v| v != BLANK_CORNER);
        let named = named.count();
        if named != corners {
            return fails(format!(
                "{named} corners are not blank, but the faces have {corners} corners"
            ));
        }
        let fans = self.vertices().map(|v| self.fans.rows()[v.index()]);
        let places: usize = fans.map(|fan| fan.len as usize).sum();
        let named = self.pool.rows().iter().filter(|&&f| f != BLANK_PLACE);
        let named = named.count();
        if named != places {
            return fails(format!(
                "{named} entries of the pool are not blank, but the fans have {places} entries"
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{FaceSpans, Point, PolygonMesh, Representation, Table};

    use super::*;
    use crate::EditableFaceVertexMesh;

    const SQUARE: [Point; 4] = [Point::ZERO, Point::X, Point::ONE, Point::Y];

    fn mesh(faces: &[&[u32]]) -> EditableFaceVertexMesh {
        let polygons = PolygonMesh::new(SQUARE, faces).expect("valid");
        let mesh = EditableFaceVertexMesh::from_polygons(&polygons).expect("holds every mesh");
        assert_eq!(mesh.validate(), Ok(()));
        mesh
    }

    /// Faces 0 1 2 and 0 2 3. The fans of v0, v1, v2 and v3 start at places 0, 2, 3 and 5.
    fn triangles() -> EditableFaceVertexMesh {
        mesh(&[&[0, 1, 2], &[0, 2, 3]])
    }

    fn fault(mesh: &EditableFaceVertexMesh) -> String {
        mesh.validate().expect_err("broken on purpose").to_string()
    }

    #[test]
    fn i1_spans_that_do_not_partition_the_corners() {
        let mut broken = triangles();
        broken.spans = FaceSpans::Uniform {
            degree: 3,
            faces: 1,
        };
        assert_eq!(fault(&broken), "I1 fails: corners 3..6 belong to no face");
        broken.spans = FaceSpans::Uniform {
            degree: 2,
            faces: 3,
        };
        assert_eq!(fault(&broken), "I1 fails: f0 has the corners 0..2 of 6");
        let mut broken = mesh(&[&[0, 1, 2, 3], &[0, 1, 2]]);
        let mut mixed = |offsets: &[u32]| {
            broken.spans = FaceSpans::Mixed(Table::new("offsets", "face", offsets.to_vec()));
            fault(&broken)
        };
        assert_eq!(mixed(&[0, 4, 3]), "I1 fails: f1 has the corners 4..3 of 7");
        assert_eq!(mixed(&[0, 4, 8]), "I1 fails: f1 has the corners 4..8 of 7");
        assert_eq!(mixed(&[0, 5, 7]), "I1 fails: f1 has the corners 5..7 of 7");
        assert_eq!(mixed(&[1, 4, 7]), "I1 fails: f0 has the corners 1..4 of 7");
        assert_eq!(mixed(&[]), "I1 fails: the table of offsets is empty");
    }

    #[test]
    fn i1_faces_with_missing_or_repeated_vertices() {
        let mut broken = triangles();
        broken.corners.rows_mut()[4] = VertexId::new(4);
        assert_eq!(
            fault(&broken),
            "I1 fails: f1 has vertex v4, which does not exist"
        );
        broken.corners.rows_mut()[4] = VertexId::new(3);
        assert_eq!(fault(&broken), "I1 fails: f1 has vertex v3 twice");
    }

    #[test]
    fn i2_fans_that_overlap_or_leave_the_pool() {
        let mut broken = triangles();
        broken.fans.rows_mut()[1].len = 2;
        assert_eq!(fault(&broken), "I2 fails: the fans of v1 and v2 overlap");
        broken.fans.rows_mut()[1] = Fan {
            start: u32::MAX,
            len: u32::MAX,
        };
        assert_eq!(
            fault(&broken),
            "I2 fails: the fan of v1 reaches beyond the pool"
        );
        broken.fans = Table::new("fans", "vertex", Vec::new());
        assert_eq!(fault(&broken), "I2 fails: there are 0 fans for 4 vertices");
    }

    #[test]
    fn i3_fans_that_contradict_the_faces() {
        let mut broken = triangles();
        broken.pool.rows_mut()[1] = FaceId::new(0);
        assert_eq!(fault(&broken), "I3 fails: the fan of v0 contains f0 twice");
        let mut broken = triangles();
        broken.pool.rows_mut()[2] = FaceId::new(1);
        let expected = "I3 fails: the fan of v1 contains f1, which has no corner there";
        assert_eq!(fault(&broken), expected);
        broken.fans.rows_mut()[1].len = 0;
        assert_eq!(
            fault(&broken),
            "I3 fails: the fan of v1 does not contain f0"
        );
    }

    #[test]
    fn i4_deleted_elements_that_are_not_marked() {
        let mut broken = triangles();
        broken.vertex_holes.insert(3);
        assert_eq!(
            fault(&broken),
            "I1 fails: f1 has vertex v3, which does not exist"
        );
        let mut broken = mesh(&[&[0, 1, 2]]);
        broken.vertex_holes.insert(3);
        let expected = "I4 fails: vertex holes and Fan { start: 3, len: 0 } disagree on whether v3 was deleted";
        assert_eq!(fault(&broken), expected);
        let mut broken = triangles();
        broken.face_holes.insert(1);
        for v in [0, 2, 3] {
            broken.fans.rows_mut()[v].len = 1;
        }
        broken.fans.rows_mut()[3].len = 0;
        assert_eq!(
            fault(&broken),
            "I4 fails: f1 was deleted but has the corner v0"
        );
        broken.corners.rows_mut()[3..].fill(BLANK_CORNER);
        assert_eq!(
            fault(&broken),
            "I4 fails: 6 entries of the pool are not blank, but the fans have 3 entries"
        );
        for place in [1, 4, 5] {
            broken.pool.rows_mut()[place] = BLANK_PLACE;
        }
        assert_eq!(broken.validate(), Ok(()));
        let mut broken = triangles();
        broken.pool.push(FaceId::new(0));
        let expected = "I4 fails: 7 entries of the pool are not blank, but the fans have 6 entries";
        assert_eq!(fault(&broken), expected);
    }

    #[test]
    fn a_fan_can_be_anywhere_in_the_pool() {
        let mut edited = triangles();
        let mut pool = edited.pool.rows().to_vec();
        let moved = std::mem::replace(&mut pool[2], BLANK_PLACE);
        pool.push(moved);
        edited.pool = Table::new("pool", "place", pool);
        edited.fans.rows_mut()[1].start = 6;
        assert_eq!(edited.validate(), Ok(()));
        assert!(edited.vertex_faces(VertexId::new(1)).eq([FaceId::new(0)]));
    }
}

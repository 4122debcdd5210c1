//! Faces as lists of vertices, flat.

use std::ops::Range;

use crate::error::PolygonError;
use crate::memory::TableBytes;
use crate::probe::{Probe, Untraced};
use crate::row_id::{FaceId, MAX_ROWS, VertexId, row};
use crate::table::Table;

/// Lists of vertices as a file gives them: any number of corners, any vertex, nothing checked.
///
/// While all faces have one degree, that degree is stored once; the first that differs brings a
/// table of offsets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceList {
    corners: Vec<VertexId>,
    faces: usize,
    /// Where each face starts, and the end of the last; empty while all have one degree.
    offsets: Vec<u32>,
}

impl FaceList {
    /// No faces yet, with room for some.
    pub fn with_capacity(corners: usize) -> Self {
        Self {
            corners: Vec::with_capacity(corners),
            ..Self::default()
        }
    }

    /// Takes flat corners of faces that all have `degree` corners.
    ///
    /// # Errors
    ///
    /// [`PolygonError::TooMany`] beyond [`MAX_ROWS`] corners, and [`PolygonError::TooFewCorners`]
    /// where the last face is incomplete or `degree` is zero.
    pub fn uniform(degree: usize, corners: Vec<VertexId>) -> Result<Self, PolygonError> {
        check_corners(corners.len())?;
        let faces = corners.len().checked_div(degree).unwrap_or(0);
        if faces * degree != corners.len() {
            let face = FaceId::new(u32::try_from(faces).unwrap_or(u32::MAX));
            let corners = corners.len() - faces * degree;
            return Err(PolygonError::TooFewCorners { face, corners });
        }
        Ok(Self {
            corners,
            faces,
            offsets: Vec::new(),
        })
    }

    /// Adds a face.
    ///
    /// # Errors
    ///
    /// [`PolygonError::TooMany`] beyond [`MAX_ROWS`] corners or faces.
    pub fn push(&mut self, face: impl IntoIterator<Item = VertexId>) -> Result<(), PolygonError> {
        let start = self.corners.len();
        self.corners.extend(face);
        let end = self.corners.len();
        if end > MAX_ROWS || self.faces >= MAX_ROWS {
            self.corners.truncate(start);
            let elements = if end > MAX_ROWS { "corners" } else { "faces" };
            return Err(PolygonError::TooMany {
                elements,
                limit: MAX_ROWS,
            });
        }
        if self.offsets.is_empty() && self.faces > 0 && end - start != start / self.faces {
            let degree = start / self.faces;
            self.offsets = (0..=self.faces).map(|face| row(face * degree)).collect();
        }
        self.faces += 1;
        if !self.offsets.is_empty() {
            self.offsets.push(row(end));
        }
        Ok(())
    }

    /// How many faces there are.
    pub fn len(&self) -> usize {
        self.faces
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.faces == 0
    }

    /// The number of corners of every face, if it is one number.
    pub fn uniform_degree(&self) -> Option<usize> {
        (self.offsets.is_empty() && self.faces > 0).then(|| self.corners.len() / self.faces)
    }

    /// All corners, face by face.
    pub fn corners(&self) -> &[VertexId] {
        &self.corners
    }

    /// Which corners are those of `face`.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    pub fn range(&self, face: FaceId) -> Range<usize> {
        let f = face.index();
        assert!(f < self.faces, "no face {face}: there are {}", self.faces);
        match self.uniform_degree() {
            Some(degree) => f * degree..(f + 1) * degree,
            None => self.offsets[f] as usize..self.offsets[f + 1] as usize,
        }
    }

    /// The vertices of `face`, in order.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    pub fn face(&self, face: FaceId) -> &[VertexId] {
        &self.corners[self.range(face)]
    }

    /// Every face with its vertices, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (FaceId, &[VertexId])> + Clone {
        let faces = row(self.faces);
        (0..faces).map(|f| (FaceId::new(f), self.face(FaceId::new(f))))
    }

    /// How the corners fall into faces, as structures store it.
    pub fn spans(&self) -> FaceSpans {
        match self.uniform_degree() {
            Some(degree) => FaceSpans::Uniform {
                degree: row(degree),
                faces: row(self.faces),
            },
            None if self.is_empty() => FaceSpans::Uniform {
                degree: 3,
                faces: 0,
            },
            None => FaceSpans::Mixed(Table::new("offsets", "face", self.offsets.clone())),
        }
    }
}

fn check_corners(corners: usize) -> Result<(), PolygonError> {
    if corners > MAX_ROWS {
        return Err(PolygonError::TooMany {
            elements: "corners",
            limit: MAX_ROWS,
        });
    }
    Ok(())
}

/// How a flat table of corners falls into faces: one degree for all, or a table of offsets.
#[derive(Clone, Debug)]
pub enum FaceSpans<P: Probe = Untraced> {
    /// Every face has `degree` corners.
    Uniform {
        /// The corners of each face.
        degree: u32,
        /// How many faces there are.
        faces: u32,
    },
    /// Face `f` has the corners `offsets[f]..offsets[f + 1]`.
    Mixed(Table<u32, P>),
}

impl<P: Probe> FaceSpans<P> {
    /// How many faces there are.
    #[inline]
    pub fn len(&self) -> usize {
        match self {
            Self::Uniform { faces, .. } => *faces as usize,
            Self::Mixed(offsets) => offsets.len() - 1,
        }
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Which corners are those of `face`; reads two offsets where degrees are mixed.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn range(&self, face: FaceId) -> Range<usize> {
        let f = face.index();
        match self {
            Self::Uniform { degree, faces } => {
                if face.index() >= *faces as usize {
                    no_such_face(face, *faces as usize);
                }
                let degree = *degree as usize;
                f * degree..(f + 1) * degree
            }
            Self::Mixed(offsets) => {
                if f + 1 >= offsets.len() {
                    no_such_face(face, offsets.len() - 1);
                }
                *offsets.read(f) as usize..*offsets.read(f + 1) as usize
            }
        }
    }

    /// The face of a corner: a division, or a binary search where degrees are mixed.
    ///
    /// Of a corner that is not there it says nothing of use.
    ///
    /// # Panics
    ///
    /// If there is no face at all.
    pub fn face_of(&self, corner: usize) -> FaceId {
        let face = match self {
            Self::Uniform { degree, .. } => corner / *degree as usize,
            Self::Mixed(offsets) => {
                let (mut low, mut high) = (0, offsets.len() - 1);
                while high - low > 1 {
                    let middle = low.midpoint(high);
                    if *offsets.read(middle) as usize <= corner {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                low
            }
        };
        FaceId::new(row(face))
    }

    /// The face of a corner, and the corners before, at and after it there.
    ///
    /// # Panics
    ///
    /// If there is no such corner.
    pub fn around(&self, corner: usize) -> (FaceId, [usize; 3]) {
        let face = self.face_of(corner);
        let range = self.range(face);
        let (first, last) = (range.start, range.end - 1);
        let before = if corner == first { last } else { corner - 1 };
        let after = if corner == last { first } else { corner + 1 };
        (face, [before, corner, after])
    }

    /// Whether the spans divide `corners` corners into faces of three or more: what is wrong if not.
    ///
    /// # Errors
    ///
    /// The first face whose corners are not there or too few, or the corners that no face has.
    pub fn check(&self, corners: usize) -> Result<(), String> {
        if let Self::Mixed(offsets) = self
            && offsets.is_empty()
        {
            return Err("the offsets lack even a first".to_owned());
        }
        let mut end = 0;
        for face in (0..row(self.len())).map(FaceId::new) {
            let range = self.range(face);
            if range.start != end || range.end < range.start + 3 || range.end > corners {
                return Err(format!("{face} has the corners {range:?} of {corners}"));
            }
            end = range.end;
        }
        if end != corners {
            return Err(format!("corners {end}..{corners} belong to no face"));
        }
        Ok(())
    }

    /// The same spans watched by `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> FaceSpans<Q> {
        match self {
            Self::Uniform { degree, faces } => FaceSpans::Uniform { degree, faces },
            Self::Mixed(offsets) => FaceSpans::Mixed(offsets.probed(probe)),
        }
    }

    /// The bytes of the offsets, if there are any.
    pub fn bytes(&self) -> Option<TableBytes> {
        match self {
            Self::Uniform { .. } => None,
            Self::Mixed(offsets) => Some(offsets.bytes()),
        }
    }
}

#[cold]
#[inline(never)]
fn no_such_face(face: FaceId, faces: usize) -> ! {
    panic!("no face {face}: there are {faces}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(degrees: &[u32]) -> FaceList {
        let mut faces = FaceList::default();
        for &degree in degrees {
            faces.push((0..degree).map(VertexId::new)).expect("small");
        }
        faces
    }

    #[test]
    fn offsets_come_with_the_first_face_that_differs() {
        assert_eq!(list(&[]).uniform_degree(), None);
        assert_eq!(list(&[3, 3]).uniform_degree(), Some(3));
        for degrees in [&[3_u32, 3, 4, 3][..], &[0, 0, 2], &[5, 0], &[3], &[1, 1]] {
            let faces = list(degrees);
            let got: Vec<u32> = faces.iter().map(|(_, face)| face.len() as u32).collect();
            assert_eq!(got, degrees);
            let spans = faces.spans();
            let spanned: Vec<u32> = faces
                .iter()
                .map(|(f, _)| spans.range(f).len() as u32)
                .collect();
            assert_eq!(spanned, degrees);
        }
    }

    #[test]
    #[should_panic(expected = "no face f2: there are 2")]
    fn a_missing_face_panics_by_name() {
        list(&[3, 3]).spans().range(FaceId::new(2));
    }

    #[test]
    #[should_panic(expected = "no face f2: there are 2")]
    fn a_missing_face_panics_by_name_among_mixed_degrees_too() {
        list(&[3, 4]).spans().range(FaceId::new(2));
    }

    #[test]
    fn a_corner_knows_its_face_and_those_beside_it() {
        for degrees in [&[3, 3, 3][..], &[4, 3, 5], &[3, 3, 4, 3, 6, 3]] {
            let spans = list(degrees).spans();
            let faces = (0..row(degrees.len())).map(FaceId::new);
            for (face, corners) in faces.map(|f| (f, spans.range(f))) {
                let (first, last) = (corners.start, corners.end - 1);
                assert_eq!(spans.around(first), (face, [last, first, first + 1]));
                assert_eq!(spans.around(last), (face, [last - 1, last, first]));
                for corner in first + 1..last {
                    let beside = [corner - 1, corner, corner + 1];
                    assert_eq!(spans.around(corner), (face, beside));
                    assert_eq!(spans.face_of(corner), face);
                }
            }
        }
    }

    #[test]
    fn spans_must_divide_the_corners() {
        assert_eq!(list(&[3, 4]).spans().check(7), Ok(()));
        assert!(list(&[3, 4]).spans().check(8).is_err());
        assert!(list(&[3, 4]).spans().check(6).is_err());
        assert!(list(&[3, 3]).spans().check(5).is_err());
        assert!(list(&[3, 2]).spans().check(5).is_err());
    }

    #[test]
    fn flat_corners_must_fill_their_faces() {
        let corners = vec![VertexId::new(0); 7];
        let error = FaceList::uniform(3, corners.clone()).unwrap_err();
        assert_eq!(
            error,
            PolygonError::TooFewCorners {
                face: FaceId::new(2),
                corners: 1
            }
        );
        assert!(FaceList::uniform(0, corners).is_err());
    }
}

//! Faces as lists of vertices in one flat table.

use std::ops::Range;

use crate::handles::row_id::{FaceId, MAX_ROWS, VertexId, row};
use crate::polygons::error::PolygonError;
use crate::tables::face_spans::FaceSpans;
use crate::tables::table::Table;

/// Faces as lists of vertices. The lists are not checked: a face may have any number of corners and
/// name any vertex.
///
/// If all faces have the same degree, no table of offsets is stored. The first face of a different
/// degree adds the table of offsets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceList {
    corners: Vec<VertexId>,
    faces: usize,
    /// The start of each face, followed by the end of the last face. Empty if all faces have the
    /// same degree.
    offsets: Vec<u32>,
}

impl FaceList {
    /// Builds an empty list with room for `corners` corners.
    pub fn with_capacity(corners: usize) -> Self {
        Self {
            corners: Vec::with_capacity(corners),
            ..Self::default()
        }
    }

    /// Builds a list of faces that all have `degree` corners. `corners` holds the corners of all
    /// faces, face by face.
    ///
    /// # Errors
    ///
    /// [`PolygonError::TooMany`] if there are more than [`MAX_ROWS`] corners;
    /// [`PolygonError::TooFewCorners`] if `degree` is zero, or if the number of corners is not a
    /// multiple of `degree`.
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
    /// [`PolygonError::TooMany`] if there would be more than [`MAX_ROWS`] corners or faces.
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

    /// Returns the number of faces.
    pub fn len(&self) -> usize {
        self.faces
    }

    /// Returns whether there are no faces.
    pub fn is_empty(&self) -> bool {
        self.faces == 0
    }

    /// Returns the degree of all faces, or `None` if there are no faces or their degrees differ.
    pub fn uniform_degree(&self) -> Option<usize> {
        (self.offsets.is_empty() && self.faces > 0).then(|| self.corners.len() / self.faces)
    }

    /// Returns all corners, face by face.
    pub fn corners(&self) -> &[VertexId] {
        &self.corners
    }

    /// Returns the range of the corners of `face`.
    ///
    /// # Panics
    ///
    /// Panics if `face` does not exist.
    pub fn range(&self, face: FaceId) -> Range<usize> {
        let f = face.index();
        assert!(
            f < self.faces,
            "no face {face}: every face has a row below {}",
            self.faces
        );
        match self.uniform_degree() {
            Some(degree) => f * degree..(f + 1) * degree,
            None => self.offsets[f] as usize..self.offsets[f + 1] as usize,
        }
    }

    /// Returns the vertices of `face`, in order.
    ///
    /// # Panics
    ///
    /// Panics if `face` does not exist.
    pub fn face(&self, face: FaceId) -> &[VertexId] {
        &self.corners[self.range(face)]
    }

    /// Yields every face with its vertices, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (FaceId, &[VertexId])> + Clone {
        let faces = row(self.faces);
        (0..faces).map(|f| (FaceId::new(f), self.face(FaceId::new(f))))
    }

    /// Returns the range of corners of each face, in the form that structures store.
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

/// Builds a list of faces of these degrees. In each face, the vertices are numbered from 0.
#[cfg(test)]
pub(crate) fn faces_of_degrees(degrees: &[u32]) -> FaceList {
    let mut faces = FaceList::default();
    for &degree in degrees {
        faces.push((0..degree).map(VertexId::new)).expect("small");
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::faces_of_degrees as list;
    use super::*;

    #[test]
    fn the_first_face_of_another_degree_adds_offsets() {
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
    fn an_incomplete_last_face_is_refused() {
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

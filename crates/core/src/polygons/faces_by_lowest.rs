//! Faces by their lowest vertex, to find faces with the same vertices without hashing.

use crate::handles::row_id::{FaceId, row};
use crate::polygons::face_list::FaceList;

/// The faces of a list, sorted by their lowest vertex; built in O(corners) by a counting sort.
///
/// Faces with the same vertices have the same lowest vertex.
pub struct FacesByLowest {
    faces: Vec<FaceId>,
    /// By vertex: the end of its faces.
    ends: Vec<u32>,
}

impl FacesByLowest {
    /// Sorts the faces that `used` selects.
    ///
    /// # Panics
    ///
    /// Panics if a selected face has no vertices, or if its lowest vertex is not below `vertices`.
    pub fn new(vertices: usize, faces: &FaceList, used: impl Fn(FaceId) -> bool) -> Self {
        let lowest = || {
            let used = faces.iter().filter(|&(f, _)| used(f));
            used.map(|(f, face)| (f, face.iter().min().expect("a face has vertices").index()))
        };
        let mut ends = vec![0_u32; vertices];
        for (_, low) in lowest() {
            ends[low] += 1;
        }
        let mut total = 0;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let mut sorted = vec![FaceId::new(row(0)); total as usize];
        for (f, low) in lowest() {
            let at = &mut ends[low];
            sorted[*at as usize] = f;
            *at += 1;
        }
        Self {
            faces: sorted,
            ends,
        }
    }

    /// Yields a list of faces for each vertex that is the lowest vertex of several faces. Each list
    /// is ascending.
    pub fn several(&self) -> impl Iterator<Item = &[FaceId]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let faces = starts.zip(&self.ends);
        faces
            .filter(|&(start, &end)| end - start > 1)
            .map(|(start, &end)| &self.faces[start as usize..end as usize])
    }
}

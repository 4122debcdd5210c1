//! Closed chains of vertices without repetitions, from the corners of a face that may repeat
//! vertices.

use rustc_hash::FxHashMap;
use sixfold_core::VertexId;

use crate::trace::CornerId;

/// A corner: its vertex, and where it comes from.
type Corner = (VertexId, CornerId);

/// Splits faces that name vertices repeatedly; its tables are reused for the next face.
///
/// ```text
///     b ─── c       d ─── e         The face a b c a d e names a twice: it becomes the
///       ╲   │       │   ╱           triangles a b c and a d e. A chain a b a has no area,
///         ╲ │       │ ╱             so it is left out; a a is one corner.
///           a       a
/// ```
#[derive(Default)]
pub(super) struct SimpleLoops {
    open: Vec<Corner>,
    place: FxHashMap<VertexId, usize>,
    corners: Vec<Corner>,
    ends: Vec<usize>,
}

impl SimpleLoops {
    /// Finds the loops of a face; O(corners) expected.
    pub(super) fn find(&mut self, face: impl Iterator<Item = Corner>) {
        self.open.clear();
        self.place.clear();
        self.corners.clear();
        self.ends.clear();
        for corner in face {
            if let Some(&at) = self.place.get(&corner.0) {
                self.close(at);
            }
            self.place.insert(corner.0, self.open.len());
            self.open.push(corner);
        }
        self.close(0);
    }

    /// Takes the open corners from number `at` on; they are a loop if there are three or more.
    fn close(&mut self, at: usize) {
        for (v, _) in &self.open[at..] {
            self.place.remove(v);
        }
        let part = self.open.drain(at..);
        if part.len() >= 3 {
            self.corners.extend(part);
            self.ends.push(self.corners.len());
        }
    }

    /// Returns the loops that were found.
    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = &[Corner]> + Clone {
        (0..self.ends.len()).map(|i| {
            let start = if i == 0 { 0 } else { self.ends[i - 1] };
            &self.corners[start..self.ends[i]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loops(face: &[u32]) -> Vec<Vec<u32>> {
        let mut loops = SimpleLoops::default();
        let corners = (0..).map(CornerId::new);
        loops.find(face.iter().map(|&v| VertexId::new(v)).zip(corners));
        let vertices = |part: &[Corner]| part.iter().map(|(v, _)| v.index() as u32).collect();
        loops.iter().map(vertices).collect()
    }

    #[test]
    fn repeated_vertices_split_a_face() {
        assert_eq!(loops(&[0, 1, 2]), [[0, 1, 2]]);
        assert_eq!(loops(&[0, 0, 1, 2, 2, 0]), [[0, 1, 2]]);
        assert_eq!(loops(&[0, 1, 0, 1]), Vec::<Vec<u32>>::new());
        assert_eq!(loops(&[5, 5, 5]), Vec::<Vec<u32>>::new());
        assert_eq!(loops(&[0, 1, 2, 0, 3, 4]), [[0, 1, 2], [0, 3, 4]]);
        assert_eq!(loops(&[0, 1, 2, 1, 3]), [[0, 1, 3]]);
        assert_eq!(loops(&[0, 1, 2, 3, 1, 4]), [[1, 2, 3], [0, 1, 4]]);
    }
}

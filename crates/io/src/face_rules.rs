//! Which faces of a file become polygons of the mesh: the rules for faces that name a vertex twice.
//!
//! - A corner that repeats its neighbour is removed, with a notice. The first and the last corner
//!   are neighbours. So `1 2 2 3 4` and `1 2 3 4 1` are the faces `1 2 3 4`.
//! - A face with fewer than three different corners stays as it is in the file, and is left out of
//!   the mesh.
//! - A polygon that names a vertex twice in other corners is cut into triangles that do not, when all
//!   vertices are known, with a notice (`FileMesh::cut_repeats`). If it crosses itself, or has no area,
//!   it stays as it is in the file, and is left out of the mesh: [`repeated_vertex`] is the only place
//!   that decides this.

use sixfold_core::{IteratorExt, VertexId};

/// Returns `face` without the corners that repeat their neighbours; `None` if there are no such
/// corners, or if fewer than three corners would remain. O(corners).
pub(crate) fn without_repeats<T: Copy + PartialEq>(face: &[T]) -> Option<Vec<T>> {
    let has_repeats = face.len() > 3
        && (face.first() == face.last() || face.windows(2).any(|pair| pair[0] == pair[1]));
    if !has_repeats {
        return None;
    }
    let mut kept = face.to_vec();
    kept.dedup();
    if kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    (kept.len() >= 3).then_some(kept)
}

/// Returns the first vertex that occurs twice in `face`, so that the face is left out of the mesh;
/// O(corners) expected.
pub(crate) fn repeated_vertex(face: &[VertexId]) -> Option<VertexId> {
    if let &[a, b, c] = face {
        return match (a == b || a == c, b == c) {
            (true, _) => Some(a),
            (_, true) => Some(b),
            _ => None,
        };
    }
    if let &[a, b, c, d] = face
        && a != b
        && a != c
        && a != d
        && b != c
        && b != d
        && c != d
    {
        return None;
    }
    let mut distinct = face.iter().copied().distinct();
    face.iter().copied().find(|&v| distinct.next() != Some(v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    #[test]
    fn only_repeats_of_neighbours_are_removed() {
        let without = |face: &[u32]| without_repeats(face);
        assert_eq!(without(&[1, 2, 2, 6, 5]), Some(vec![1, 2, 6, 5]));
        assert_eq!(without(&[1, 2, 3, 4, 1]), Some(vec![1, 2, 3, 4]));
        assert_eq!(without(&[1, 1, 2, 2, 2, 3, 1, 1]), Some(vec![1, 2, 3]));
        assert_eq!(without(&[1, 2, 3, 1, 4, 4]), Some(vec![1, 2, 3, 1, 4]));
        // Nothing to remove.
        assert_eq!(without(&[1, 2, 3, 4]), None);
        assert_eq!(without(&[1, 2, 3, 1, 4, 5]), None);
        // Too few corners remain.
        for face in [&[][..], &[1], &[1, 1], &[1, 1, 2], &[1, 2, 2, 1], &[7; 9]] {
            assert_eq!(without(face), None, "{face:?}");
        }
    }

    proptest! {
        #[test]
        fn no_neighbours_are_equal_afterwards(face in vec(0..4_u32, 0..12)) {
            let kept = without_repeats(&face).unwrap_or_else(|| face.clone());
            let has_equal = (0..kept.len()).any(|i| kept[i] == kept[(i + 1) % kept.len()]);
            // The naive rule: drop each corner that equals the one before it, the first one last.
            let mut naive: Vec<u32> = Vec::new();
            for &v in &face {
                if naive.last() != Some(&v) {
                    naive.push(v);
                }
            }
            while naive.len() > 1 && naive.first() == naive.last() {
                naive.pop();
            }
            if naive.len() >= 3 {
                prop_assert!(!has_equal);
                prop_assert_eq!(kept, naive);
            } else {
                prop_assert_eq!(kept, face);
            }
        }
    }
}

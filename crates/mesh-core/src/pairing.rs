//! Twin pairs: the edges of an oriented manifold, found without hashing.

use crate::face_list::FaceList;
use crate::row_id::VertexId;
use crate::sides::Buckets;

/// The most corners that [`TwinPairs`] can number: a corner and a direction share 32 bits.
pub(crate) const MAX_CORNERS: usize = (u32::MAX / 2) as usize;

/// The most edges that [`TwinPairs`] can number: an edge and the directions seen share 32 bits.
pub(crate) const MAX_EDGES: usize = (u32::MAX / 4) as usize;

/// The side of every corner as one half of an edge.
///
/// Edge `e` has the halves `2e`, from its lower to its higher end, and `2e + 1` back. Edges are
/// numbered by their lower end, so that the edges of one vertex lie together in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TwinPairs {
    /// By corner: the half-edge that starts there and runs along the corner's face.
    pub half_of_corner: Vec<u32>,
    /// How many edges there are. Without boundary it is half the number of corners.
    pub edge_count: usize,
}

impl TwinPairs {
    /// Pairs the sides of `faces`; O(corners + vertices).
    ///
    /// Sides are bucketed by their lower end (a counting sort); within a bucket, a scratch row for
    /// each higher end finds the partner. `None` if two sides run along one edge in the same
    /// direction, as they must where an edge has three faces, or if there are more corners or edges
    /// than have names; [`Capabilities::check`](crate::Capabilities::check) says which.
    pub fn of(vertices: usize, faces: &FaceList) -> Option<Self> {
        let corners = faces.corners().len();
        if corners > MAX_CORNERS {
            return None;
        }
        let buckets = Buckets::of(vertices, faces, Bucketed::of);
        // By higher end: the bucket that wrote here last; its edge, and the directions seen of it.
        let mut last = vec![(u32::MAX, 0_u32); vertices];
        let mut half_of_corner = vec![0_u32; corners];
        let (mut edges, mut clash, mut start) = (0_u32, 0, 0);
        for (low, &end) in (0_u32..).zip(&buckets.ends) {
            for side in &buckets.entries[start..end as usize] {
                let row = &mut last[side.high as usize];
                let (corner, direction) = (side.tag >> 1, side.tag & 1);
                let new = row.0 != low;
                // Without a branch, for half of all sides are new, in no order to be foreseen.
                let known = if new { edges << 2 } else { row.1 };
                let seen = 1 << direction;
                clash |= known & seen;
                *row = (low, known | seen);
                edges += u32::from(new);
                half_of_corner[corner as usize] = known >> 2 << 1 | direction;
            }
            start = end as usize;
            if edges as usize > MAX_EDGES {
                return None;
            }
        }
        let edge_count = edges as usize;
        (clash == 0).then_some(Self {
            half_of_corner,
            edge_count,
        })
    }
}

/// A side in the bucket of its lower end.
#[derive(Clone, Copy, Default)]
struct Bucketed {
    /// The higher end.
    high: u32,
    /// Twice the corner where the side starts, plus one if it runs from high to low.
    tag: u32,
}

impl Bucketed {
    #[inline(always)]
    fn of(a: VertexId, b: VertexId, corner: u32) -> Self {
        Self {
            high: a.max(b).index() as u32,
            tag: corner << 1 | u32::from(a > b),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(vertices: usize, faces: &[&[u32]]) -> Option<TwinPairs> {
        let mut list = FaceList::default();
        for face in faces {
            list.push(face.iter().copied().map(VertexId::new))
                .expect("small");
        }
        TwinPairs::of(vertices, &list)
    }

    #[test]
    fn halves_are_numbered_by_the_lower_end() {
        // Edges: e0 = v0–v1 (twice), e1 = v0–v2, e2 = v0–v3; e3 = v1–v2, e4 = v1–v3.
        let two = pairs(4, &[&[0, 1, 2], &[1, 0, 3]]).expect("manifold");
        assert_eq!(two.edge_count, 5);
        assert_eq!(two.half_of_corner[0] ^ 1, two.half_of_corner[3]);
        assert_eq!(two.half_of_corner, [0, 6, 3, 1, 4, 9]);
    }

    #[test]
    fn a_repeated_direction_is_no_pair() {
        assert_eq!(pairs(4, &[&[0, 1, 2], &[0, 1, 3]]), None);
        for order in [[0, 1, 2], [1, 0, 2], [1, 2, 0], [2, 0, 1]] {
            let book: [&[u32]; 3] = [&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]];
            let pages: Vec<&[u32]> = order.iter().map(|&page| book[page]).collect();
            assert_eq!(pairs(5, &pages), None, "pages {order:?}");
        }
    }

    #[test]
    fn mixed_degrees_pair_like_uniform_ones() {
        let mixed = pairs(5, &[&[0, 1, 2, 3], &[1, 0, 4]]).expect("manifold");
        assert_eq!(mixed.edge_count, 6);
        assert_eq!(mixed.half_of_corner[0] ^ 1, mixed.half_of_corner[4]);
        assert_eq!(pairs(0, &[]).expect("empty").edge_count, 0);
    }
}

//! Twin pairs: the two half-edges of each edge of an oriented manifold, found without hashing.

use crate::handles::limits::{self, MAX_CORNERS, MAX_EDGES};
use crate::handles::row_id::{FaceId, RowId, VertexId};
use crate::polygons::face_list::FaceList;
use crate::tables::sides::{Sides, bucket_starts, fill_buckets};

/// The half-edges of a list of faces, numbered in pairs: two half-edges for each edge.
///
/// Half-edge `2e` runs from the lower to the higher end of edge `e`, and half-edge `2e + 1` runs in
/// the other direction. Edges are numbered in the order of their lower ends. The lower end is the
/// end with the lower vertex number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TwinPairs {
    /// For each corner, the half-edge that starts at the corner and runs along the face of the
    /// corner.
    pub half_of_corner: Vec<u32>,
    /// The number of edges.
    pub edge_count: usize,
}

impl TwinPairs {
    /// Pairs the sides of `faces`; O(corners + vertices).
    ///
    /// A counting sort puts the sides into one bucket for each lower end. Within a bucket, a table
    /// indexed by the higher end finds the two sides of an edge.
    ///
    /// Returns `None` if two sides run along one edge in the same direction, or if there are too
    /// many corners or edges. An edge with three faces always has two sides in the same direction.
    /// [`Capabilities::check`](crate::Capabilities::check) returns the reason why this function
    /// returns `None`.
    ///
    /// The temporary memory is 8 bytes per corner and 8 bytes per vertex.
    /// [`with_rows`](Self::with_rows) needs less temporary memory.
    pub fn new(vertices: usize, faces: &FaceList) -> Option<Self> {
        let mut rows = vec![(0_u32, 0_u32); faces.corners().len()];
        Self::with_rows(vertices, faces, &mut rows[..])
    }

    /// Does the same as [`new`](Self::new), but stores the sorted sides in `rows`, which must have
    /// an entry for each corner. `rows` can be an unused table of the caller. Afterwards, the
    /// content of `rows` is arbitrary.
    ///
    /// # Panics
    ///
    /// Panics if `rows` has fewer entries than there are corners.
    #[inline(always)]
    pub fn with_rows<R: SideRows + ?Sized>(
        vertices: usize,
        faces: &FaceList,
        rows: &mut R,
    ) -> Option<Self> {
        let corners = faces.corners().len();
        if corners > limits::current(MAX_CORNERS) {
            return None;
        }
        let (mut ends, _) = bucket_starts(vertices, faces);
        fill_buckets(faces, &mut ends, |at, a, b, corner| {
            rows.write(at, a.max(b), tag(a, b, corner));
        });
        // By vertex: the last edge with this higher end, and two bits for the directions found. 0
        // means no edge.
        let mut last = vec![0_u32; vertices];
        let mut half_of_corner = vec![0_u32; corners];
        let (mut edges, mut conflict, mut start) = (0_u32, 0, 0);
        let max_edges = limits::current(MAX_EDGES);
        for end in ends {
            let end = end as usize;
            let first = (edges << 2).max(1);
            for at in start..end {
                let (high, tag) = rows.read(at);
                let row = &mut last[high.index()];
                let (corner, direction) = (tag >> 1, tag & 1);
                let new = *row < first;
                // No branch: it would be unpredictable.
                let known = if new { edges << 2 } else { *row };
                let seen = 1 << direction;
                conflict |= known & seen;
                *row = known | seen;
                edges += u32::from(new);
                half_of_corner[corner as usize] = known >> 2 << 1 | direction;
            }
            start = end;
            if edges as usize > max_edges {
                return None;
            }
        }
        let edge_count = edges as usize;
        (conflict == 0).then_some(Self {
            half_of_corner,
            edge_count,
        })
    }

    /// Calls [`LinkFaces::link_face`] of `tables` for every face of `faces`, in order.
    ///
    /// If all faces are triangles, or all faces are quads, the loop over the corners is unrolled.
    // Always inlined: otherwise the loop loads the addresses of the tables for every corner.
    #[inline(always)]
    pub fn link_faces(&self, faces: &FaceList, tables: &mut impl LinkFaces) {
        let halves = self.half_of_corner.as_slice();
        match faces.uniform_degree() {
            Some(3) => link_uniform::<3>(faces.corners(), halves, tables),
            Some(4) => link_uniform::<4>(faces.corners(), halves, tables),
            _ => {
                for (f, corners) in faces.iter() {
                    tables.link_face(f, corners, &halves[faces.range(f)]);
                }
            }
        }
    }
}

#[inline]
fn link_uniform<const DEGREE: usize>(
    corners: &[VertexId],
    halves: &[u32],
    tables: &mut impl LinkFaces,
) {
    let corners = corners.as_chunks::<DEGREE>().0;
    let halves = halves.as_chunks::<DEGREE>().0;
    for (f, (corners, halves)) in (0..).zip(corners.iter().zip(halves)) {
        tables.link_face(FaceId::new(f), corners, halves);
    }
}

/// The tables of a structure that is being built from a list of faces.
pub trait LinkFaces {
    /// Stores the half-edges of the face `f` in the tables. The half-edge `halves[i]` runs along
    /// `f` and starts at `corners[i]`.
    fn link_face(&mut self, f: FaceId, corners: &[VertexId], halves: &[u32]);
}

/// Temporary memory for the sorted sides of faces, with one entry per corner.
///
/// A constructor can implement this trait for unused rows of the mesh that it builds. The sorted
/// sides then need no additional memory.
pub trait SideRows {
    /// Writes a side to entry `at`: its higher end, and a tag that encodes the corner and the
    /// direction of the side. The tag is never `u32::MAX`.
    fn write(&mut self, at: usize, high: VertexId, tag: u32);

    /// Returns the higher end and the tag of the side in entry `at`.
    fn read(&self, at: usize) -> (VertexId, u32);
}

impl SideRows for [(u32, u32)] {
    #[inline(always)]
    fn write(&mut self, at: usize, high: VertexId, tag: u32) {
        self[at] = (high.row(), tag);
    }

    #[inline(always)]
    fn read(&self, at: usize) -> (VertexId, u32) {
        let (high, tag) = self[at];
        (VertexId::new(high), tag)
    }
}

/// Finds the two sides of each edge of a triangle mesh, without numbers for the edges; O(corners +
/// vertices).
///
/// A side is identified by the number of its opposite corner. For the first side of each edge, the
/// function calls `pair(first, first)`. For the second side, the function calls
/// `pair(second, first)`. A boundary edge has only a first side.
///
/// `highs` is temporary memory with one row per corner; it can be an unused table of the caller.
/// Returns a vector whose memory (4 bytes per corner) the caller can reuse, and the number of
/// edges. Returns `None` in the same cases as [`TwinPairs::new`].
///
/// # Panics
///
/// Panics if a face is not a triangle, or if `highs` has fewer rows than there are corners.
#[inline(always)]
pub fn pair_triangle_sides(
    vertices: usize,
    faces: &FaceList,
    highs: &mut [VertexId],
    mut pair: impl FnMut(u32, u32),
) -> Option<(Vec<u32>, usize)> {
    let corners = faces.corners();
    if corners.len() > limits::current(MAX_CORNERS) {
        return None;
    }
    assert!(faces.is_empty() || faces.uniform_degree() == Some(3));
    let faces = TriangleSides(corners);
    let (mut ends, sides) = bucket_starts(vertices, &faces);
    let mut tags = vec![0_u32; sides];
    fill_buckets(&faces, &mut ends, |at, a, b, corner| {
        highs[at] = a.max(b);
        tags[at] = tag(a, b, corner);
    });
    // By vertex: 1 + the place of the first side of the last edge with this higher end.
    let mut last = vec![0_u32; vertices];
    let (mut edges, mut conflict, mut start) = (0, false, 0);
    for end in ends {
        for at in start..end {
            let tag = tags[at as usize];
            let row = &mut last[highs[at as usize].index()];
            // No branch: see `TwinPairs::with_rows`.
            let new = *row <= start;
            let first_at = if new { at } else { *row - 1 };
            *row = first_at + 1;
            let first = &mut tags[first_at as usize];
            if *first == PAIRED {
                // A third side along one edge; rare, so a branch is cheap.
                return None;
            }
            conflict |= !new & ((*first ^ tag) & 1 == 0);
            let twin = std::mem::replace(first, if new { tag } else { PAIRED });
            edges += usize::from(new);
            pair(tag >> 1, twin >> 1);
        }
        start = end;
    }
    (!conflict && edges <= limits::current(MAX_EDGES)).then_some((tags, edges))
}

/// The tag of the first side of an edge after its second side was found. All other tags are
/// smaller.
const PAIRED: u32 = u32::MAX;

/// Returns twice the corner of a side, plus one if the side runs from the higher end to the lower.
#[inline(always)]
fn tag(a: VertexId, b: VertexId, corner: u32) -> u32 {
    corner << 1 | u32::from(a > b)
}

/// The sides of triangles, each with its opposite corner.
struct TriangleSides<'a>(&'a [VertexId]);

impl Sides for TriangleSides<'_> {
    #[inline(always)]
    fn for_each_side(&self, mut visit: impl FnMut(VertexId, VertexId, u32)) {
        let mut first = 0;
        for &[a, b, c] in self.0.as_chunks::<3>().0 {
            visit(a, b, first + 2);
            visit(b, c, first);
            visit(c, a, first + 1);
            first += 3;
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
        TwinPairs::new(vertices, &list)
    }

    #[test]
    fn half_edges_are_numbered_by_the_lower_end() {
        // Edges: e0 = v0–v1 (twice), e1 = v0–v2, e2 = v0–v3; e3 = v1–v2, e4 = v1–v3.
        let two = pairs(4, &[&[0, 1, 2], &[1, 0, 3]]).expect("manifold");
        assert_eq!(two.edge_count, 5);
        assert_eq!(two.half_of_corner[0] ^ 1, two.half_of_corner[3]);
        assert_eq!(two.half_of_corner, [0, 6, 3, 1, 4, 9]);
    }

    #[test]
    fn a_repeated_direction_is_refused() {
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
    fn paired(vertices: usize, faces: &[[u32; 3]]) -> Option<Vec<u32>> {
        let corners: Vec<VertexId> = faces.iter().flatten().map(|&v| VertexId::new(v)).collect();
        let list = FaceList::uniform(3, corners).expect("small");
        let mut highs = vec![VertexId::new(0); list.corners().len()];
        let mut partners = vec![u32::MAX; list.corners().len()];
        let done = pair_triangle_sides(vertices, &list, &mut highs, |side, other| {
            partners[side as usize] = other;
            partners[other as usize] = side;
        });
        let (scratch, edges) = done?;
        assert_eq!(scratch.len(), partners.len());
        let pairs = TwinPairs::new(vertices, &list).expect("a manifold for both");
        assert_eq!(edges, pairs.edge_count);
        Some(partners)
    }

    #[test]
    fn sides_of_triangles_are_paired_by_opposite_corners() {
        let two = paired(4, &[[0, 1, 2], [1, 0, 3]]).expect("manifold");
        assert_eq!(two, [0, 1, 5, 3, 4, 2]);
        assert_eq!(paired(4, &[[0, 1, 2], [0, 1, 3]]), None, "one direction");
        for order in [[0, 1, 2], [1, 0, 2], [1, 2, 0], [2, 0, 1]] {
            let book = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
            let pages = order.map(|page: usize| book[page]);
            assert_eq!(paired(5, &pages), None, "three faces: {order:?}");
        }
        assert_eq!(paired(0, &[]), Some(vec![]));
    }
}

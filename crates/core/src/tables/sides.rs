//! The sides of all faces, in buckets by their lower end, to find edges without hashing.

use crate::handles::pair::Pair;
use crate::polygons::face_list::FaceList;
use crate::tables::editing::Editing;
use crate::tables::face_spans::FaceSpans;
use crate::tables::holes::HoleSet;

use crate::handles::row_id::{VertexId, row};
use crate::tables::probe::Probe;
use crate::tables::table::Table;

/// Faces whose sides can be visited repeatedly.
pub(crate) trait Sides {
    /// Calls `visit` with the two ends and the corner of every side.
    fn for_each_side(&self, visit: impl FnMut(VertexId, VertexId, u32));
}

impl Sides for FaceList {
    #[inline(always)]
    fn for_each_side(&self, visit: impl FnMut(VertexId, VertexId, u32)) {
        match self.uniform_degree() {
            Some(3) => sides_of_uniform::<3>(self.corners(), visit),
            Some(4) => sides_of_uniform::<4>(self.corners(), visit),
            _ => sides_of_each(
                self.iter().map(|(f, face)| (self.range(f).start, face)),
                visit,
            ),
        }
    }
}

/// The spans, the corners and the holes of a structure.
type Parts<'a, P, E> = (
    &'a FaceSpans<P, E>,
    &'a Table<VertexId, P>,
    &'a <E as Editing>::Holes<P>,
);

impl<P: Probe, E: Editing> Sides for Parts<'_, P, E> {
    #[inline(always)]
    fn for_each_side(&self, visit: impl FnMut(VertexId, VertexId, u32)) {
        let (spans, corners, holes) = *self;
        let all = || corners.read_range(0..corners.len());
        match spans {
            FaceSpans::Uniform { degree: 3, .. } if holes.is_empty() => {
                sides_of_uniform::<3>(all(), visit);
            }
            FaceSpans::Uniform { degree: 4, .. } if holes.is_empty() => {
                sides_of_uniform::<4>(all(), visit);
            }
            _ => {
                let ranges = holes.handles(spans.len()).map(|f| spans.range(f));
                let faces = ranges.map(|range| (range.start, corners.read_range(range)));
                sides_of_each(faces, visit);
            }
        }
    }
}

/// Visits the sides of all faces. `faces` yields the first corner and the vertices of each face.
/// Side `i` joins corners `i` and `i + 1`.
#[inline(always)]
fn sides_of_each<'a>(
    faces: impl Iterator<Item = (usize, &'a [VertexId])>,
    mut visit: impl FnMut(VertexId, VertexId, u32),
) {
    for (start, face) in faces {
        for (i, (corner, &a)) in (row(start)..).zip(face).enumerate() {
            let b = face[if i + 1 == face.len() { 0 } else { i + 1 }];
            visit(a, b, corner);
        }
    }
}

/// Visits sides like `sides_of_each`, with an unrolled loop over the corners of a face.
#[inline(always)]
fn sides_of_uniform<const DEGREE: usize>(
    corners: &[VertexId],
    mut visit: impl FnMut(VertexId, VertexId, u32),
) {
    let mut corner = 0;
    for face in corners.as_chunks::<DEGREE>().0 {
        for i in 0..DEGREE {
            visit(face[i], face[(i + 1) % DEGREE], corner);
            corner += 1;
        }
    }
}

/// One entry for each side, in buckets by the lower end: a counting sort.
pub(crate) struct Buckets<T> {
    pub(crate) entries: Vec<T>,
    /// By vertex: the end of its bucket.
    pub(crate) ends: Vec<u32>,
}

impl<T: Copy + Default> Buckets<T> {
    /// Builds the buckets in two passes; O(corners + vertices). The first pass counts the sides.
    /// The second pass stores the result of `entry` for each side.
    #[inline(always)]
    pub(crate) fn new(
        vertices: usize,
        faces: &impl Sides,
        entry: impl Fn(VertexId, VertexId, u32) -> T,
    ) -> Self {
        let (mut ends, total) = bucket_starts(vertices, faces);
        let mut entries = vec![T::default(); total];
        fill_buckets(faces, &mut ends, |at, a, b, corner| {
            entries[at] = entry(a, b, corner);
        });
        Self { entries, ends }
    }
}

/// Counts the sides by their lower end; returns the start of the bucket of each vertex, and the
/// number of sides.
#[inline(always)]
pub(crate) fn bucket_starts(vertices: usize, faces: &impl Sides) -> (Vec<u32>, usize) {
    let mut starts = vec![0_u32; vertices];
    faces.for_each_side(|a, b, _| starts[a.min(b).index()] += 1);
    let mut total = 0;
    for start in &mut starts {
        total += std::mem::replace(start, total);
    }
    (starts, total as usize)
}

/// Calls `place` for each side, with the row of the side in its bucket, the two ends and the
/// corner. Changes each start in `starts` to the end of the bucket.
#[inline(always)]
pub(crate) fn fill_buckets(
    faces: &impl Sides,
    starts: &mut [u32],
    mut place: impl FnMut(usize, VertexId, VertexId, u32),
) {
    faces.for_each_side(|a, b, corner| {
        let at = &mut starts[a.min(b).index()];
        place(*at as usize, a, b, corner);
        *at += 1;
    });
}

impl<P: Probe, E: Editing> FaceSpans<P, E> {
    /// Yields every edge of the faces once, ordered by the lower end. Deleted faces are skipped.
    ///
    /// A counting sort puts the higher ends into one bucket for each lower end. In each bucket,
    /// each higher end is yielded at its first occurrence. O(corners + vertices).
    ///
    /// # Panics
    ///
    /// Panics if a corner names a vertex that is not below `vertices`, at the latest during the
    /// iteration.
    pub fn edges(
        &self,
        corners: &Table<VertexId, P>,
        holes: &E::Holes<P>,
        vertices: usize,
    ) -> impl Iterator<Item = Pair<VertexId>> + use<P, E> {
        let higher_end = |a: VertexId, b: VertexId, _| a.max(b).index() as u32;
        let Buckets { entries, ends } = Buckets::new(vertices, &(self, corners, holes), higher_end);
        // By vertex: the lower end of the last edge with this higher end; initially the vertex
        // itself, which means no edge.
        let mut last_low: Vec<u32> = (0..row(vertices)).collect();
        let (mut low, mut at) = (0_u32, 0);
        std::iter::from_fn(move || {
            loop {
                let high = *entries.get(at)?;
                while ends[low as usize] as usize == at {
                    low += 1;
                }
                at += 1;
                if std::mem::replace(&mut last_low[high as usize], low) != low {
                    return Some(Pair::new(VertexId::new(low), VertexId::new(high)));
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::holes::NoHoles;
    use crate::tables::probe::Traced;

    fn edges(vertices: usize, faces: &[&[u32]]) -> (Vec<[usize; 2]>, usize) {
        let mut list = FaceList::default();
        for face in faces {
            list.push(face.iter().copied().map(VertexId::new))
                .expect("small");
        }
        let probe = Traced::default();
        let corners = Table::new("corners", "corner", list.corners().to_vec());
        let (spans, corners) = (
            list.spans().probed(probe.clone()),
            corners.probed(probe.clone()),
        );
        let edges = spans.edges(&corners, &NoHoles, vertices);
        let ends = edges.map(|edge| edge.ends().map(VertexId::index)).collect();
        let log = probe.take();
        (
            ends,
            log.iter().filter(|read| read.table == "corners").count(),
        )
    }

    #[test]
    fn every_edge_is_returned_once_for_all_degrees() {
        let triangles = edges(6, &[&[4, 1, 2], &[2, 1, 4], &[1, 4, 5]]);
        let expected = vec![[1, 2], [1, 4], [1, 5], [2, 4], [4, 5]];
        assert_eq!(sorted(triangles.0), expected, "v0 and v3 are isolated");
        assert_eq!(triangles.1, 2 * 9, "one read to count, one to place");
        let quads = edges(4, &[&[0, 1, 2, 3], &[3, 2, 1, 0]]);
        assert_eq!(sorted(quads.0), [[0, 1], [0, 3], [1, 2], [2, 3]]);
        let mixed = edges(5, &[&[0, 1, 2, 3], &[1, 0, 4]]);
        let expected = [[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [2, 3]];
        assert_eq!(sorted(mixed.0), expected);
        assert_eq!(mixed.1, 2 * 7);
        assert_eq!(edges(2, &[]), (vec![], 0));
    }

    /// Checks that the edges are ordered by lower end, and returns them sorted.
    fn sorted(mut edges: Vec<[usize; 2]>) -> Vec<[usize; 2]> {
        assert!(edges.is_sorted_by_key(|&[low, _]| low), "{edges:?}");
        edges.sort_unstable();
        edges
    }
}

//! Refinement of the connectivity: one step of subdivision in a structure's own tables.

use std::ops::Range;

use crate::Point;
use crate::handles::limits;
use crate::handles::row_id::{FaceId, MAX_ROWS, VertexId, row};
use crate::polygons::counts::Counts;
use crate::polygons::error::RefineError;
use crate::traits::representation::Representation;
use crate::traits::split::Split;

/// A structure that can split all faces in its own tables, without conversion to polygons.
///
/// The refined mesh is called the child; the mesh before the split is called the parent. The
/// structure computes only the connectivity of the child. The subdivision scheme queries the
/// parent, computes the positions of the child, and writes these positions through
/// [`positions_mut`](Self::positions_mut).
///
/// # Contract
///
/// - The child has the faces, the orientation and the order of vertices that [`Split`] defines. The
///   child satisfies every invariant of the structure. Each structure defines the order of the
///   faces and edges of the child; [`parent`](Self::parent) returns the old face from which a face
///   of the child was made.
/// - The tables of the child are overwritten in place if they are large enough. Repeated refinement
///   into the same mesh therefore allocates nothing.
/// - With the feature `rayon`, refinement runs on the threads of the current rayon pool; without
///   this feature, refinement runs on one thread. The child has the same bytes for any number of
///   threads.
/// - The temporary memory has at most a tenth of the bytes of the parent and the child together.
///   Refinement uses no hash table, no [`from_polygons`](Representation::from_polygons) and no
///   intermediate `PolygonMesh`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot split its own tables",
    note = "these structures can split their tables after `mesh.into_compact()`: FaceVertexMesh, \
            WingedEdgeMesh, HalfEdgeMesh, CornerTable"
)]
pub trait Refine: Representation<Vertex = VertexId, Face = FaceId> {
    /// The splits that the structure supports. `Sqrt3` stands for both values of `trisect`.
    const SPLITS: &'static [Split];

    /// The type that stores the numbers of the edges. The numbers are computed once per mesh, and
    /// their memory is reused for the next mesh.
    ///
    /// If edge handles are not rows, this type stores data for each corner.
    type EdgeNumbers: Default + Send + Sync;

    /// Returns a mesh without elements, as a target for refinement.
    fn empty() -> Self;

    /// Numbers the edges in the order of `edges()`; O(corners) or less.
    fn number_edges(&self, numbers: &mut Self::EdgeNumbers);

    /// Divides the numbered edges into chunks of a few thousand edges, so that several threads can
    /// share the work. Returns the first number of each chunk, followed by the number of edges.
    /// Returns `[0]` for a mesh without edges.
    fn edge_chunks(&self, numbers: &Self::EdgeNumbers) -> Vec<usize>;

    /// Returns the edges of one chunk, in the order of their numbers.
    fn edges_of_chunk(
        &self,
        numbers: &Self::EdgeNumbers,
        chunk: usize,
    ) -> impl Iterator<Item = Self::Edge>;

    /// Returns the number of `e`: its index in the sequence `edges()`. O(1), or O(valence) if edge
    /// handles are not rows.
    fn edge_number(&self, numbers: &Self::EdgeNumbers, e: Self::Edge) -> usize;

    /// Overwrites `child` with the refined mesh. Afterwards, the positions of `child` are
    /// arbitrary, so the caller must write all positions.
    ///
    /// `numbers` must be the result of [`number_edges`](Self::number_edges) for this mesh.
    ///
    /// # Errors
    ///
    /// Returns a [`RefineError`] and leaves `child` unchanged in these cases:
    ///
    /// - the split is not in [`SPLITS`](Self::SPLITS);
    /// - a face is not a triangle, but the split requires triangles;
    /// - two triangles share two edges, and the structure allows at most two faces per edge;
    /// - the child would have too many elements for its handles. The number of elements is checked
    ///   before any allocation.
    fn split_into(
        &self,
        split: Split,
        numbers: &Self::EdgeNumbers,
        child: &mut Self,
    ) -> Result<(), RefineError>;

    /// Returns the face of this mesh from which `split` makes the face `child` of the refined mesh.
    /// O(1), or O(log faces) if faces have different degrees or the mesh has a boundary. `numbers`
    /// must be the result of [`number_edges`](Self::number_edges) for this mesh.
    ///
    /// In the √3 split, a triangle of the refined mesh can lie across an inner edge of this mesh.
    /// The parent of a triangle across an inner edge is the face whose side along the edge starts
    /// at the old vertex of the triangle.
    fn parent(&self, numbers: &Self::EdgeNumbers, split: Split, child: FaceId) -> FaceId;

    /// Returns the positions of all vertices, in order, for writing.
    fn positions_mut(&mut self) -> &mut [Point];

    /// Returns the positions of all vertices, in order.
    fn position_rows(&self) -> &[Point];
}

/// Checks that the structure `M` supports `split`, and that `M` can number the vertices, edges and
/// corners of the refined mesh. Returns the sizes of the refined mesh. Every
/// [`Refine::split_into`] calls this function first.
///
/// # Errors
///
/// Returns an error if the split is not supported, or if the refined mesh would have too many
/// elements.
pub fn check_split<M: Refine>(
    split: Split,
    counts: &Counts,
    boundary: usize,
) -> Result<Counts, RefineError> {
    let known = M::SPLITS.iter().any(|known| known.name() == split.name());
    if !known {
        let structure = M::NAME;
        return Err(RefineError::Unsupported { structure, split });
    }
    let refined = split.refined_counts(counts, boundary);
    let [edges, corners] = M::CAPABILITIES.edge_and_corner_limits();
    for (elements, number, limit) in [
        ("vertices", refined.vertices, limits::current(MAX_ROWS)),
        ("edges", refined.edges, edges),
        ("corners", refined.corners, corners),
    ] {
        if number > limit {
            return Err(RefineError::TooMany {
                elements,
                number,
                limit,
            });
        }
    }
    Ok(refined)
}

/// The number of rows in a chunk, which one thread processes at a time. The number is small enough
/// to divide the work evenly between threads, and large enough that the overhead of threads hardly
/// matters.
pub const CHUNK_ROWS: usize = 4096;

/// Returns the first row of each chunk of [`CHUNK_ROWS`] rows, followed by the number of rows.
/// Structures whose edge handles are rows implement [`edge_chunks`](Refine::edge_chunks) by this
/// function.
pub fn chunk_starts(rows: usize) -> Vec<usize> {
    (0..rows).step_by(CHUNK_ROWS).chain([rows]).collect()
}

/// Returns the rows of the chunk with the number `chunk`, for the chunks of [`chunk_starts`].
pub fn rows_of_chunk(rows: usize, chunk: usize) -> Range<u32> {
    let start = (chunk * CHUNK_ROWS).min(rows);
    row(start)..row((start + CHUNK_ROWS).min(rows))
}

/// Calls `work` for every chunk of `rows`, with the number of the first row and the rows of the
/// chunk. Chunks have `len` rows; the last chunk may have fewer rows. With the feature `rayon`, the
/// threads of the current rayon pool share the chunks.
///
/// On one thread, the chunks are processed in a plain loop. If the values that `work` writes depend
/// only on the rows of its chunk, the result is the same on any number of threads.
pub fn for_each_chunk<T: Send>(rows: &mut [T], len: usize, work: impl Fn(usize, &mut [T]) + Sync) {
    #[cfg(feature = "rayon")]
    if rows.len() > len && rayon::current_num_threads() > 1 {
        on_threads(numbered_chunks(rows, len), &|(first, rows)| {
            work(first, rows)
        });
        return;
    }
    for (number, rows) in rows.chunks_mut(len).enumerate() {
        work(number * len, rows);
    }
}

/// Returns the chunks of `rows` with the numbers of their first rows.
#[cfg(feature = "rayon")]
fn numbered_chunks<T>(rows: &mut [T], len: usize) -> Vec<(usize, &mut [T])> {
    let chunks = rows.chunks_mut(len).enumerate();
    chunks.map(|(number, rows)| (number * len, rows)).collect()
}

/// Calls `work` for every chunk on the threads of the current rayon pool, and returns the results in
/// order. `work` is called by its address, so that the code of the threads is not compiled again for
/// every algorithm.
#[cfg(feature = "rayon")]
fn on_threads<C: Send, R: Send>(chunks: Vec<C>, work: &(dyn Fn(C) -> R + Sync)) -> Vec<R> {
    use rayon::prelude::*;
    chunks.into_par_iter().map(work).collect()
}

/// Calls `work` for every chunk of `rows`, and returns the results in the order of the chunks.
/// Chunks may differ in length: chunk `i` has the rows `starts[i]..starts[i + 1]`. The arguments of
/// `work` are the number of the chunk, the range of its rows, and the rows. With the feature
/// `rayon`, the threads of the current rayon pool share the chunks.
///
/// # Panics
///
/// Panics if the values of `starts` do not ascend from 0 to the number of rows.
pub fn map_chunks<T: Send, R: Send>(
    rows: &mut [T],
    starts: &[usize],
    work: impl Fn(usize, Range<usize>, &mut [T]) -> R + Sync,
) -> Vec<R> {
    in_order(split_at_starts(rows, starts), &|(number, range, rows)| {
        work(number, range, rows)
    })
}

/// A chunk with its number and the range of its rows.
type Chunk<'r, T> = (usize, Range<usize>, &'r mut [T]);

fn split_at_starts<'r, T>(rows: &'r mut [T], starts: &[usize]) -> Vec<Chunk<'r, T>> {
    let mut chunks = Vec::with_capacity(starts.len());
    let mut rest = rows;
    for (number, bounds) in starts.windows(2).enumerate() {
        let (chunk, after) = rest.split_at_mut(bounds[1] - bounds[0]);
        chunks.push((number, bounds[0]..bounds[1], chunk));
        rest = after;
    }
    assert!(
        rest.is_empty(),
        "the chunks do not cover the last {} rows",
        rest.len()
    );
    chunks
}

/// Calls `work` for every chunk, on threads if there are several, and returns the results in order.
fn in_order<C: Send, R: Send>(chunks: Vec<C>, work: &(dyn Fn(C) -> R + Sync)) -> Vec<R> {
    #[cfg(feature = "rayon")]
    if chunks.len() > 1 && rayon::current_num_threads() > 1 {
        return on_threads(chunks, work);
    }
    chunks.into_iter().map(work).collect()
}

/// Returns whether `holds` is true for all `rows`. With the feature `rayon`, the threads of the
/// current rayon pool share the rows.
///
/// There is no early exit inside a chunk of [`CHUNK_ROWS`] rows, so that the loop can be
/// vectorised.
pub fn all_rows<T: Sync>(rows: &[T], holds: impl Fn(&T) -> bool + Sync) -> bool {
    let all_hold = |rows: &[T]| rows.iter().fold(true, |all, row| all & holds(row));
    #[cfg(feature = "rayon")]
    if rows.len() > CHUNK_ROWS && rayon::current_num_threads() > 1 {
        let chunks = rows.chunks(CHUNK_ROWS).collect();
        return !on_threads(chunks, &all_hold).contains(&false);
    }
    rows.chunks(CHUNK_ROWS).all(all_hold)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_every_row_once() {
        for rows in [0, 1, CHUNK_ROWS, CHUNK_ROWS + 1, 3 * CHUNK_ROWS] {
            let starts = chunk_starts(rows);
            let covered = (0..starts.len() - 1).flat_map(|chunk| rows_of_chunk(rows, chunk));
            assert!(covered.eq(0..rows as u32));
            assert_eq!(starts.last(), Some(&rows));
        }
        for rows in [0, 1, 7, 8, 9, 100] {
            let mut seen = vec![0_usize; rows];
            for_each_chunk(&mut seen, 8, |first, rows| {
                for (i, row) in rows.iter_mut().enumerate() {
                    *row += first + i + 1;
                }
            });
            assert!(seen.iter().enumerate().all(|(i, &row)| row == i + 1));
        }
        let mut seen = vec![0; 6];
        map_chunks(&mut seen, &[0, 1, 1, 4, 6], |chunk, range, rows| {
            assert_eq!(range.len(), rows.len());
            rows.fill(chunk);
        });
        assert_eq!(seen, [0, 2, 2, 2, 3, 3]);
        map_chunks(&mut [0; 0], &[0], |_, _, _| unreachable!("no chunks"));
    }
}

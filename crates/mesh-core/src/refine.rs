//! Connectivity refinement: what a step of subdivision does to a structure's own tables.

use std::fmt;
use std::ops::Range;

use serde::Serialize;

use crate::Point;
use crate::error::RefineError;
use crate::representation::{Counts, Representation};
use crate::row_id::{FaceId, MAX_ROWS, VertexId, row};

/// A way to split every face of a mesh at once; positions are another matter.
///
/// ```text
///   Quads                    Triangles                Sqrt3
///   d────m────c              c                        c───────d       c───────d
///   │    │    │              │╲                       │╲   f2╱        │╲     ╱│
///   m────f────m              m──m                     │  ╲ ╱          │ f1──f2│
///   │    │    │              │╲ │╲                    │f1 ╱╲          │╱     ╲│
///   a────m────b              a──m──b                  a───────b       a───────b
/// ```
///
/// The vertices of the refined mesh come in a fixed order: the old vertices in their order, then a
/// face point for each face in the order of `faces()` (not for [`Triangles`](Self::Triangles)), then
/// the points of edges in the order of `edges()`: one for each edge, but for the split of
/// [`Sqrt3`](Self::Sqrt3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// Every face of degree n into n quads, by a face point and edge points (Catmull & Clark 1978).
    Quads,
    /// Every triangle into four, by edge points (Loop 1987).
    Triangles,
    /// Every triangle into three, by a face point; then every old inner edge is flipped
    /// (Kobbelt 2000). Boundary edges are left alone, or cut in three where `trisect` is set: then
    /// the two points of each boundary edge come last, in the order of `edges()`, the one nearer to
    /// the origin of the face's side first.
    Sqrt3 {
        /// Whether boundary edges are cut in three.
        trisect: bool,
    },
}

impl Split {
    /// What users call it: `quads`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quads => "quads",
            Self::Triangles => "triangles",
            Self::Sqrt3 { .. } => "sqrt3",
        }
    }

    /// Whether it splits triangles alone.
    pub const fn needs_triangles(self) -> bool {
        !matches!(self, Self::Quads)
    }

    /// The sizes of the refined mesh, in closed form; `boundary` is the number of edges with one
    /// face, which only the √3 split with `trisect` looks at. Saturates where they leave `usize`.
    ///
    /// Edges with three or more faces are counted right for quads and triangles.
    pub const fn grown(self, counts: &Counts, boundary: usize) -> Counts {
        let &Counts {
            vertices: v,
            edges: e,
            faces: f,
            corners,
            uniform: _,
        } = counts;
        let (vertices, edges, faces, degree) = match self {
            Self::Quads => (
                v.saturating_add(f).saturating_add(e),
                e.saturating_mul(2).saturating_add(corners),
                corners,
                4,
            ),
            Self::Triangles => (
                v.saturating_add(e),
                e.saturating_mul(2).saturating_add(f.saturating_mul(3)),
                f.saturating_mul(4),
                3,
            ),
            Self::Sqrt3 { trisect } => {
                let cut = if trisect { boundary } else { 0 };
                let more = cut.saturating_mul(2);
                (
                    v.saturating_add(f).saturating_add(more),
                    e.saturating_add(f.saturating_mul(3))
                        .saturating_add(more.saturating_mul(2)),
                    f.saturating_mul(3).saturating_add(more),
                    3,
                )
            }
        };
        Counts {
            vertices,
            edges,
            faces,
            corners: faces.saturating_mul(degree),
            uniform: true,
        }
    }
}

impl fmt::Display for Split {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A structure that can refine its own tables: every face split, in closed form, without rebuilding.
///
/// Connectivity alone is the structure's; where the new vertices go is for the scheme to say, which
/// asks the parent mesh its nine relations and writes the child's [`positions_mut`](Self::positions_mut).
///
/// # Contract
///
/// - The child is the mesh that [`Split`] draws: same faces, same orientation, vertices in the order
///   fixed there. It satisfies every invariant of the structure. The order of its faces and edges is
///   the structure's own; [`parent`](Self::parent) tells whose child a face is.
/// - The tables of the child are overwritten in place where they are large enough: refining again
///   and again into one mesh allocates nothing.
/// - The work runs on the threads of the current rayon pool, and gives the same bytes on any number.
/// - Beyond the two meshes it holds at most a tenth of their bytes. No hash table, no
///   [`from_polygons`](Representation::from_polygons), no `PolygonMesh` in between.
pub trait Refine: Representation<Vertex = VertexId, Face = FaceId> {
    /// The splits that the structure can do. `Sqrt3` stands for both of its kinds.
    const SPLITS: &'static [Split];

    /// The numbers of the edges, worked out once per mesh and used again for the next: a table by
    /// corner, or, where an edge is a row, no more than `split_into` and `parent` have to look up.
    type EdgeNumbers: Default + Send + Sync;

    /// A mesh without any element, to be refined into.
    fn empty() -> Self;

    /// Numbers the edges in the order of `edges()`; O(corners) or less.
    fn number_edges(&self, numbers: &mut Self::EdgeNumbers);

    /// How the numbered edges fall into parts of a few thousand, for passes that share the work: the
    /// first number of each part, and at the end the number of edges. `[0]` of a mesh without edges.
    fn edge_parts(&self, numbers: &Self::EdgeNumbers) -> Vec<usize>;

    /// The edges of one part, in the order of their numbers.
    fn edges_of_part(
        &self,
        numbers: &Self::EdgeNumbers,
        part: usize,
    ) -> impl Iterator<Item = Self::Edge>;

    /// The number of `e`: its place in `edges()`. O(1), or O(valence) where an edge is no row.
    fn edge_number(&self, numbers: &Self::EdgeNumbers, e: Self::Edge) -> usize;

    /// Overwrites `child` with the mesh split; the positions of the child are left for the caller.
    ///
    /// `numbers` are those of this mesh.
    ///
    /// # Errors
    ///
    /// [`RefineError`], and `child` is as it was: the split is none of [`SPLITS`](Self::SPLITS), a
    /// face is no triangle where only triangles can be split, two triangles share two edges where no
    /// edge may have more than two faces, or the child would have too many elements for its handles,
    /// which is found out before anything is allocated.
    fn split_into(
        &self,
        split: Split,
        numbers: &Self::EdgeNumbers,
        child: &mut Self,
    ) -> Result<(), RefineError>;

    /// The face that `child`, a face of the mesh after `split`, is a part of; O(1), or O(log faces)
    /// where degrees are mixed or there is a boundary. A triangle of the √3 split across an old inner
    /// edge belongs to the face whose side its first old vertex starts. `numbers` are those of this
    /// mesh.
    fn parent(&self, numbers: &Self::EdgeNumbers, split: Split, child: FaceId) -> FaceId;

    /// All positions by vertex, to be overwritten.
    fn positions_mut(&mut self) -> &mut [Point];

    /// All positions by vertex.
    fn position_rows(&self) -> &[Point];
}

/// Checks what every [`Refine::split_into`] checks first: the split, and the size of the child.
///
/// # Errors
///
/// As `split_into`, but for faces that are no triangles.
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
    let grown = split.grown(counts, boundary);
    // Twice the edges and all corners must have names too: half-edges and corners are rows.
    for (elements, number) in [
        ("vertices", grown.vertices),
        ("half-edges", grown.edges.saturating_mul(2)),
        ("corners", grown.corners),
    ] {
        if number > MAX_ROWS {
            return Err(RefineError::TooMany {
                elements,
                number,
                limit: MAX_ROWS,
            });
        }
    }
    Ok(grown)
}

/// How many rows a thread takes at a time: few enough to share evenly, many enough to be worth it.
pub const PART: usize = 4096;

/// Where parts of [`PART`] rows start, and at the end how many rows there are: the
/// [`edge_parts`](Refine::edge_parts) of structures whose edges are rows.
pub fn row_parts(rows: usize) -> Vec<usize> {
    (0..rows).step_by(PART).chain([rows]).collect()
}

/// The rows of such a part.
pub fn rows_of_part(rows: usize, part: usize) -> Range<u32> {
    let start = (part * PART).min(rows);
    row(start)..row((start + PART).min(rows))
}

/// Calls `work` with every part of `rows`, `part` rows long but for the last, and the number of its
/// first row; the parts are shared by the threads of the current rayon pool.
///
/// On one thread it is a plain loop. What is written must depend on the rows alone, not on the part
/// they are in, for the result to be the same on any number of threads.
pub fn in_parts<T: Send>(rows: &mut [T], part: usize, work: impl Fn(usize, &mut [T]) + Sync) {
    use rayon::prelude::*;
    if rows.len() <= part || rayon::current_num_threads() == 1 {
        for (number, rows) in rows.chunks_mut(part).enumerate() {
            work(number * part, rows);
        }
    } else {
        let parts = rows.par_chunks_mut(part).enumerate();
        parts.for_each(|(number, rows)| work(number * part, rows));
    }
}

/// The same for rows that fall into parts of different lengths: part `i` has the rows
/// `starts[i]..starts[i + 1]`; `work` gets the number of the part, and what it yields for each part
/// comes back in their order.
///
/// # Panics
///
/// If `starts` do not rise from 0 to the number of rows.
pub fn in_given_parts<T: Send, R: Send>(
    rows: &mut [T],
    starts: &[usize],
    work: impl Fn(usize, Range<usize>, &mut [T]) -> R + Sync,
) -> Vec<R> {
    use rayon::prelude::*;
    let mut parts = Vec::with_capacity(starts.len());
    let mut rest = rows;
    for (number, bounds) in starts.windows(2).enumerate() {
        let (part, after) = rest.split_at_mut(bounds[1] - bounds[0]);
        parts.push((number, bounds[0]..bounds[1], part));
        rest = after;
    }
    assert!(rest.is_empty(), "the parts leave {} rows over", rest.len());
    let work = |(number, range, rows)| work(number, range, rows);
    if parts.len() == 1 || rayon::current_num_threads() == 1 {
        parts.into_iter().map(work).collect()
    } else {
        parts.into_par_iter().map(work).collect()
    }
}

/// Whether `is` holds for all `rows`, which the threads of the current rayon pool share.
///
/// There is no early way out inside a part of [`PART`] rows, so that it can be vectorised.
pub fn all_rows<T: Sync>(rows: &[T], is: impl Fn(&T) -> bool + Sync) -> bool {
    use rayon::prelude::*;
    let whole = |rows: &[T]| rows.iter().fold(true, |all, row| all & is(row));
    if rows.len() <= PART || rayon::current_num_threads() == 1 {
        rows.chunks(PART).all(whole)
    } else {
        rows.par_chunks(PART).all(whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube: 8 vertices, 12 edges, 6 faces.
    const CUBE: Counts = Counts {
        vertices: 8,
        edges: 12,
        faces: 6,
        corners: 24,
        uniform: true,
    };

    /// One triangle.
    const TRIANGLE: Counts = Counts {
        vertices: 3,
        edges: 3,
        faces: 1,
        corners: 3,
        uniform: true,
    };

    #[test]
    fn counts_grow_in_closed_form() {
        let sizes = |c: Counts| [c.vertices, c.edges, c.faces, c.corners];
        assert_eq!(sizes(Split::Quads.grown(&CUBE, 0)), [26, 48, 24, 96]);
        assert_eq!(sizes(Split::Triangles.grown(&TRIANGLE, 3)), [6, 9, 4, 12]);
        let sqrt3 = |trisect| sizes(Split::Sqrt3 { trisect }.grown(&TRIANGLE, 3));
        assert_eq!(sqrt3(false), [4, 6, 3, 9]);
        assert_eq!(sqrt3(true), [10, 18, 9, 27]);
        let huge = Counts {
            faces: usize::MAX / 2,
            ..TRIANGLE
        };
        assert_eq!(Split::Triangles.grown(&huge, 0).faces, usize::MAX);
    }

    #[test]
    fn parts_cover_every_row_once() {
        for rows in [0, 1, PART, PART + 1, 3 * PART] {
            let starts = row_parts(rows);
            let parts = (0..starts.len() - 1).flat_map(|part| rows_of_part(rows, part));
            assert!(parts.eq(0..rows as u32));
            assert_eq!(starts.last(), Some(&rows));
        }
        for rows in [0, 1, 7, 8, 9, 100] {
            let mut seen = vec![0_usize; rows];
            in_parts(&mut seen, 8, |first, rows| {
                for (i, row) in rows.iter_mut().enumerate() {
                    *row += first + i + 1;
                }
            });
            assert!(seen.iter().enumerate().all(|(i, &row)| row == i + 1));
        }
        let mut seen = vec![0; 6];
        in_given_parts(&mut seen, &[0, 1, 1, 4, 6], |part, range, rows| {
            assert_eq!(range.len(), rows.len());
            rows.fill(part);
        });
        assert_eq!(seen, [0, 2, 2, 2, 3, 3]);
        in_given_parts(&mut [0; 0], &[0], |_, _, _| unreachable!("no parts"));
    }
}

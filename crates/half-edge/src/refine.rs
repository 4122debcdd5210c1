//! Refinement: splits every face in the structure's own tables. Every new row is computed by a
//! formula.

mod midpoints;
mod sqrt3;
#[cfg(test)]
mod tests;

use std::ops::Range;

use sixfold_core::{
    CHUNK_ROWS, Counts, EdgeId, FaceId, MeshQuery, Point, Ranks, Refine, RefineError, Slot, Split,
    VertexId, all_rows, check_split, chunk_starts, for_each_chunk, row, rows_of_chunk,
};

use crate::HalfEdgeMesh;
use crate::mesh::{Half, HalfEdgeId};

/// Every half-edge row of the refined mesh (the child) is computed by a formula from rows of this
/// mesh (the parent).
///
/// A half-edge with a face stands for the corner where the half-edge starts. `#h` is the number of
/// the corner of `h`; corners are numbered in the order of the half-edges. On a closed mesh, `#h`
/// equals `h`. On an open mesh, [`Ranks`] computes `#h`, because boundary half-edges have no
/// corner. A boundary half-edge of the parent is split into half-edges of the child.
///
/// # Complexity
///
/// Numbering the edges and splitting take O(half-edges). `parent` is O(1), or O(log half-edges) on
/// an open mesh.
impl Refine for HalfEdgeMesh {
    const SPLITS: &'static [Split] = &[
        Split::Quads,
        Split::Triangles,
        Split::Sqrt3 { trisect: false },
    ];

    /// The numbers of the corners. The number of an edge needs no table, because the number is the
    /// row of the edge.
    type EdgeNumbers = Ranks;

    fn empty() -> Self {
        Self::from_tables(Vec::new(), Vec::new(), Vec::new(), Vec::new())
    }

    fn number_edges(&self, numbers: &mut Ranks) {
        numbers.fill(self.half_edge_rows(), |half| [half.face != Slot::NONE]);
    }

    fn edge_chunks(&self, _: &Ranks) -> Vec<usize> {
        chunk_starts(self.edge_count())
    }

    fn edges_of_chunk(&self, _: &Ranks, chunk: usize) -> impl Iterator<Item = EdgeId> {
        rows_of_chunk(self.edge_count(), chunk).map(EdgeId::new)
    }

    fn edge_number(&self, _: &Ranks, e: EdgeId) -> usize {
        e.index()
    }

    fn split_into(
        &self,
        split: Split,
        numbers: &Ranks,
        child: &mut Self,
    ) -> Result<(), RefineError> {
        let halves = self.half_edge_count();
        assert_eq!(
            numbers.items(),
            halves,
            "the edge numbers belong to another mesh"
        );
        let (corners, boundary) = (numbers.members(), numbers.missing());
        let counts = Counts {
            vertices: self.vertex_count(),
            edges: self.edge_count(),
            faces: self.face_count(),
            corners,
            uniform: corners == 3 * self.face_count(),
        };
        let grown = check_split::<Self>(split, &counts, boundary)?;
        if split.needs_triangles() && !counts.uniform {
            return Err(self.first_non_triangle());
        }
        if split.needs_triangles() && !all_rows(self.leaving_rows(), |&h| !self.is_double_edge(h)) {
            return Err(self.first_double_edge());
        }
        child.positions.resize(grown.vertices, Point::ZERO);
        child.leaving.resize(grown.vertices, Slot::NONE);
        child.halves.resize(2 * grown.edges, BLANK);
        child.first.resize(grown.faces, HalfEdgeId::new(0));
        // A closed mesh needs no lookup of ranks.
        if boundary == 0 {
            self.split_checked(split, &Corners::<true>(numbers), child);
        } else {
            self.split_checked(split, &Corners::<false>(numbers), child);
        }
        Ok(())
    }

    fn parent(&self, numbers: &Ranks, split: Split, child: FaceId) -> FaceId {
        let (child, corners) = (child.index(), numbers.members());
        let corner = match split {
            _ if child < corners => numbers.select(child),
            // The two additional triangles of a boundary edge.
            Split::Sqrt3 { .. } => numbers.select_missing((child - corners) / 2) ^ 1,
            // The middle triangle of a face.
            _ => return FaceId::new(row(child - corners)),
        };
        let face = self.half_edge_rows()[corner].face.get();
        face.expect("a corner has a face")
    }

    fn positions_mut(&mut self) -> &mut [Point] {
        self.positions.rows_mut()
    }

    fn position_rows(&self) -> &[Point] {
        self.positions.rows()
    }
}

const BLANK: Half = Half {
    next: HalfEdgeId::new(0),
    origin: VertexId::new(0),
    face: Slot::NONE,
};

impl HalfEdgeMesh {
    fn split_checked<const CLOSED: bool>(
        &self,
        split: Split,
        corners: &Corners<CLOSED>,
        child: &mut Self,
    ) {
        match split {
            Split::Quads => midpoints::quads(self, corners, child),
            Split::Triangles => midpoints::triangles(self, corners, child),
            Split::Sqrt3 { trisect: false } => sqrt3::sqrt3::<CLOSED, false>(self, corners, child),
            Split::Sqrt3 { trisect: true } => sqrt3::sqrt3::<CLOSED, true>(self, corners, child),
        }
    }

    fn first_non_triangle(&self) -> RefineError {
        let degrees = self
            .faces()
            .map(|face| (face, self.around_face(face).count()));
        let odd = degrees.into_iter().find(|&(_, degree)| degree != 3);
        let (face, degree) = odd.expect("a face that is not a triangle");
        RefineError::NotATriangle { face, degree }
    }

    /// Returns whether the origin of `h` is an inner vertex with two edges. Two faces then share
    /// both edges.
    fn is_double_edge(&self, h: Slot<HalfEdgeId>) -> bool {
        let after = |h: HalfEdgeId| self.half_edge_rows()[h.twin().index()].next;
        h.get()
            .is_some_and(|h| after(after(h)) == h && !self.is_boundary(h))
    }

    fn first_double_edge(&self) -> RefineError {
        let mut doubled = self
            .leaving_rows()
            .iter()
            .filter(|&&h| self.is_double_edge(h));
        let h = doubled.next().and_then(|h| h.get()).expect("one exists");
        let [first, second] = [h, h.twin()].map(|h| self.face(h).expect("both faces exist"));
        RefineError::DoubleEdge { first, second }
    }
}

/// The numbers of the corners.
#[derive(Clone, Copy)]
struct Corners<'a, const CLOSED: bool>(&'a Ranks);

impl<const CLOSED: bool> Corners<'_, CLOSED> {
    /// Returns `#h`. `h` must have a face.
    #[inline(always)]
    fn number(&self, h: u32) -> u32 {
        if CLOSED {
            h
        } else {
            self.0.rank(h as usize) as u32
        }
    }

    /// Returns the face of the child at the corner of `h`.
    #[inline(always)]
    fn face(&self, h: u32) -> Slot<FaceId> {
        Slot::some(FaceId::new(self.number(h)))
    }

    #[inline(always)]
    fn has_face(&self, h: u32) -> bool {
        CLOSED || self.0.contains(h as usize)
    }
}

#[inline(always)]
fn half(next: u32, origin: u32, face: Slot<FaceId>) -> Half {
    Half {
        next: HalfEdgeId::new(next),
        origin: VertexId::new(origin),
        face,
    }
}

/// The rows of the child for some edges of the parent and the corners at these edges.
struct Chunk<'a> {
    /// The edges of the parent.
    edges: Range<u32>,
    /// The half-edges along each edge, always the same number.
    along: &'a mut [Half],
    /// For each corner, the two half-edges of one inner edge.
    inner: &'a mut [Half],
    /// `first` of the face at each corner.
    first: &'a mut [HalfEdgeId],
}

/// Calls `work` with consecutive chunks of the child's tables, on the threads of the current rayon
/// pool. Each edge has `along_each` half-edges.
fn for_each_edge_chunk<const CLOSED: bool>(
    edges: usize,
    corners: &Corners<CLOSED>,
    along_each: usize,
    child: &mut HalfEdgeMesh,
    work: impl Fn(&mut Chunk) + Sync,
) {
    let (mut along, mut inner) = child.halves.rows_mut().split_at_mut(along_each * edges);
    let mut first = child.first.rows_mut();
    let mut chunks = Vec::with_capacity(edges.div_ceil(CHUNK_ROWS));
    for start in (0..edges).step_by(CHUNK_ROWS) {
        let end = (start + CHUNK_ROWS).min(edges);
        let number = |edge: usize| corners.0.rank(2 * edge);
        let corners = number(end) - number(start);
        chunks.push(Chunk {
            edges: row(start)..row(end),
            along: take(&mut along, along_each * (end - start)),
            inner: take(&mut inner, 2 * corners),
            first: take(&mut first, corners),
        });
    }
    for_each_chunk(&mut chunks, 1, |_, chunks| {
        chunks.iter_mut().for_each(&work)
    });
}

fn take<'a, T>(rows: &mut &'a mut [T], len: usize) -> &'a mut [T] {
    rows.split_off_mut(..len).expect("the child has these rows")
}

/// Computes each row from its number, on several threads.
fn fill<T: Send>(rows: &mut [T], value: impl Fn(usize) -> T + Sync) {
    for_each_chunk(rows, CHUNK_ROWS, |first, rows| {
        for (i, row) in (first..).zip(rows) {
            *row = value(i);
        }
    });
}

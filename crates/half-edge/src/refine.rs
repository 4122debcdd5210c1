//! Every face split, in the structure's own tables.

mod midpoints;
mod sqrt3;
#[cfg(test)]
mod tests;

use std::ops::Range;

use mesh_core::{
    Counts, EdgeId, FaceId, MeshQuery, PART, Point, Ranks, Refine, RefineError, Slot, Split,
    VertexId, all_rows, check_split, in_parts, row, row_parts, rows_of_part,
};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

/// Each split is a closed form: the name of every half of the child follows from the parent's.
///
/// A half with a face is a corner, and starts at it. The corners are numbered in the order of their
/// halves, `#h`: on a closed mesh `#h` is `h`, on an open one [`Ranks`] count. Boundary halves have
/// children like all others, but no corner.
///
/// # Complexity
///
/// O(halves) to number the edges and to split. Each row of the child is written once, and for a
/// corner up to four halves of its face are read; `parent` is O(1), or O(log halves) on an open mesh.
impl Refine for HalfEdgeMesh {
    const SPLITS: &'static [Split] = &[
        Split::Quads,
        Split::Triangles,
        Split::Sqrt3 { trisect: false },
    ];

    /// Edges are rows; these are the numbers of the corners.
    type EdgeNumbers = Ranks;

    fn empty() -> Self {
        Self::of_tables(Vec::new(), Vec::new(), Vec::new(), Vec::new())
    }

    fn number_edges(&self, numbers: &mut Ranks) {
        numbers.fill(self.half_rows(), |half| [half.face != Slot::NONE]);
    }

    fn edge_parts(&self, _: &Ranks) -> Vec<usize> {
        row_parts(self.edge_count())
    }

    fn edges_of_part(&self, _: &Ranks, part: usize) -> impl Iterator<Item = EdgeId> {
        rows_of_part(self.edge_count(), part).map(EdgeId::new)
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
        assert_eq!(numbers.items(), halves, "the numbers are of another mesh");
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
            return Err(self.first_that_is_no_triangle());
        }
        if split.needs_triangles() && !all_rows(self.leaving_rows(), |&h| !self.is_pinched(h)) {
            return Err(self.first_double_edge());
        }
        child.positions.resize(grown.vertices, Point::ZERO);
        child.leaving.resize(grown.vertices, Slot::NONE);
        child.halves.resize(2 * grown.edges, BLANK);
        child.first.resize(grown.faces, HalfEdgeId::new(0));
        // Compiled once for closed meshes, where nothing has to be looked up.
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
            // The two more triangles of each boundary edge.
            Split::Sqrt3 { .. } => numbers.select_missing((child - corners) / 2) ^ 1,
            // The middle of each triangle.
            _ => return FaceId::new(row(child - corners)),
        };
        let face = self.half_rows()[corner].face.get();
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

    fn first_that_is_no_triangle(&self) -> RefineError {
        let degrees = self
            .faces()
            .map(|face| (face, self.around_face(face).count()));
        let odd = degrees.into_iter().find(|&(_, degree)| degree != 3);
        let (face, degree) = odd.expect("more corners than those of triangles");
        RefineError::NotATriangle { face, degree }
    }

    /// Whether the vertex that `h` leaves has two edges, and both its faces have both of them.
    fn is_pinched(&self, h: Slot<HalfEdgeId>) -> bool {
        let after = |h: HalfEdgeId| self.half_rows()[h.twin().index()].next;
        h.get()
            .is_some_and(|h| after(after(h)) == h && !self.is_boundary(h))
    }

    fn first_double_edge(&self) -> RefineError {
        let mut pinched = self.leaving_rows().iter().filter(|&&h| self.is_pinched(h));
        let h = pinched.next().and_then(|h| h.get()).expect("one is there");
        let [first, second] = [h, h.twin()].map(|h| self.face(h).expect("no boundary half"));
        RefineError::DoubleEdge { first, second }
    }
}

/// The numbers of the corners; of a closed mesh each is that of its half.
#[derive(Clone, Copy)]
struct Corners<'a, const CLOSED: bool>(&'a Ranks);

impl<const CLOSED: bool> Corners<'_, CLOSED> {
    /// `#h`, for a half that has a face.
    #[inline(always)]
    fn number(&self, h: u32) -> u32 {
        if CLOSED {
            h
        } else {
            self.0.rank(h as usize) as u32
        }
    }

    /// The same as the name of a face, of the child that is at the corner.
    #[inline(always)]
    fn face(&self, h: u32) -> Slot<FaceId> {
        Slot::some(FaceId::new(self.number(h)))
    }

    /// Whether `h` has a face.
    #[inline(always)]
    fn is_one(&self, h: u32) -> bool {
        CLOSED || self.0.contains(h as usize)
    }
}

/// A row of the child.
#[inline(always)]
fn half(next: u32, origin: u32, face: Slot<FaceId>) -> Half {
    Half {
        next: HalfEdgeId::new(next),
        origin: VertexId::new(origin),
        face,
    }
}

/// What some edges of the parent, and the corners of their halves, become.
struct Part<'a> {
    /// The edges.
    edges: Range<u32>,
    /// `N` halves of each edge.
    along: &'a mut [Half],
    /// Two halves, one inner edge, for each corner.
    inner: &'a mut [Half],
    /// The face at each corner.
    first: &'a mut [HalfEdgeId],
}

/// Calls `work` with parts of the child's tables that lie in order and cover what edges and corners
/// become, on the threads of the current rayon pool; `along_each` halves belong to each edge.
fn for_parts<const CLOSED: bool>(
    edges: usize,
    corners: &Corners<CLOSED>,
    along_each: usize,
    child: &mut HalfEdgeMesh,
    work: impl Fn(&mut Part) + Sync,
) {
    let (mut along, mut inner) = child.halves.rows_mut().split_at_mut(along_each * edges);
    let mut first = child.first.rows_mut();
    let mut parts = Vec::with_capacity(edges.div_ceil(PART));
    for start in (0..edges).step_by(PART) {
        let end = (start + PART).min(edges);
        let number = |edge: usize| corners.0.rank(2 * edge);
        let corners = number(end) - number(start);
        parts.push(Part {
            edges: row(start)..row(end),
            along: take(&mut along, along_each * (end - start)),
            inner: take(&mut inner, 2 * corners),
            first: take(&mut first, corners),
        });
    }
    in_parts(&mut parts, 1, |_, parts| parts.iter_mut().for_each(&work));
}

/// The first `len` rows of `rows`, which keeps the others.
fn take<'a, T>(rows: &mut &'a mut [T], len: usize) -> &'a mut [T] {
    rows.split_off_mut(..len).expect("the child has these rows")
}

/// Fills `rows` from the number of each, in parts that threads share.
fn fill<T: Send>(rows: &mut [T], value: impl Fn(usize) -> T + Sync) {
    in_parts(rows, PART, |first, rows| {
        for (i, row) in (first..).zip(rows) {
            *row = value(i);
        }
    });
}

//! Refinement: splits every face in the structure's own tables. Every new row is computed by a
//! formula.
//!
//! A *run* is an edge along one of its sides. The runs with a face have the ranks 0, 1, 2 …, edge
//! by edge, left before right. A run with a face stands for the corner where the run starts; the
//! rank determines the rows of this corner in the refined mesh (the child). Below, `o` is the
//! origin of a run, h₀ and h₁ are the halves of the run, and `r` is the edge that the run adds
//! inside its face.
//!
//! ```text
//!              Quads                               Triangles
//!      │           ╎           │                       ·
//!     m₋ ── r₋ ──► p ◄── r₊ ── m₊                     ╱ ╲          ₋  of the run before
//!      │           ▲           │                     ╱ t₋╲         ₊  of the run after
//!      │     q     │     q₊    │                   m₋ ─r₋► m₊
//!      │           r           │                   ╱ ◄  M  ╱╲      In both, r begins at m; here
//!      │           │           │                  ╱   r   r₊ ╲     it ends at m₋, with t on its
//!      o ── h₀ ──► m ── h₁ ──► ·                 ╱  t  ╲ ◄ t₊ ╲    left and M on its right.
//!                                               o ─h₀─► m ─h₁─► ·
//! ```
//!
//! Edge `e` becomes two edges: 2e from its start to its middle, and 2e + 1 from its middle to its
//! end. The run on side s (0 left, 1 right) has h₀ = 2e + s and h₁ = 2e + 1 − s. In the table, the
//! mesh before the split (the parent) has E edges and C corners. f is the number of the face, k the
//! rank of the run, k₋ the rank of the run before, and k₊ the rank of the run after:
//!
//! | | face | next | prev |
//! |---|---|---|---|
//! | h₀ along its face | k | r | h₁ of the run before |
//! | h₁, quads | k₊ | h₀ of the run after | r |
//! | h₁, triangles | k₊ | h₀ of the run after | r₊ |
//! | r = 2E + k, quads: left, m to p | k | 2E + k₋ | h₀ |
//! | and right, p to m | k₊ | h₁ | 2E + k₊ |
//! | r = 2E + k, triangles: left, m to m₋ | k | h₁ of the run before | h₀ |
//! | and right, m₋ to m | C + f | 2E + k₊ | 2E + k₋ |
//!
//! On a side without a face, h₁ is the next edge after h₀.

use std::ops::Range;

use sixfold_core::{
    CHUNK_ROWS, Counts, EdgeId, FaceId, MeshQuery, NoHoles, Point, Ranks, Refine, RefineError,
    RowId, Slot, Split, Table, VertexId, all_rows, check_split, chunk_starts, for_each_chunk, row,
    rows_of_chunk,
};

use crate::WingedEdgeMesh;
use crate::edge::Edge;
use crate::wings::{Side, Wings};

impl Refine for WingedEdgeMesh {
    const SPLITS: &'static [Split] = &[Split::Quads, Split::Triangles];

    /// The ranks of the runs with a face. The number of an edge needs no table, because the number
    /// is the row of the edge.
    type EdgeNumbers = Ranks;

    fn empty() -> Self {
        Self {
            positions: Table::new("positions", "vertex", Vec::new()),
            spokes: Table::new("spokes", "vertex", Vec::new()),
            edges: Table::new("edges", "edge", Vec::new()),
            sides: Table::new("sides", "face", Vec::new()),
            vertex_holes: NoHoles,
            edge_holes: NoHoles,
            face_holes: NoHoles,
        }
    }

    /// O(edges).
    fn number_edges(&self, numbers: &mut Ranks) {
        numbers.fill(self.edge_records(), |edge| {
            edge.faces.map(|face| face != Slot::NONE)
        });
    }

    fn edge_chunks(&self, _: &Ranks) -> Vec<usize> {
        chunk_starts(self.edges.len())
    }

    #[inline]
    fn edges_of_chunk(&self, _: &Ranks, chunk: usize) -> impl Iterator<Item = EdgeId> {
        rows_of_chunk(self.edges.len(), chunk).map(EdgeId::new)
    }

    /// Returns the row of `e`; O(1).
    #[inline]
    fn edge_number(&self, _: &Ranks, e: EdgeId) -> usize {
        e.index()
    }

    /// O(edges + vertices).
    fn split_into(
        &self,
        split: Split,
        numbers: &Ranks,
        child: &mut Self,
    ) -> Result<(), RefineError> {
        let runs = 2 * self.edges.len();
        assert_eq!(
            numbers.items(),
            runs,
            "the edge numbers belong to another mesh"
        );
        let counts = Counts {
            vertices: self.positions.len(),
            edges: self.edges.len(),
            faces: self.sides.len(),
            corners: numbers.members(),
            uniform: false,
        };
        let grown = check_split::<Self>(split, &counts, numbers.missing())?;
        if split.needs_triangles() {
            self.check_triangles(&counts)?;
            self.check_double_edges()?;
        }
        child.positions.resize(grown.vertices, Point::ZERO);
        child.spokes.resize(grown.vertices, Slot::NONE);
        let blank = Edge {
            ends: [VertexId::new(0); 2],
            faces: [Slot::NONE; 2],
            next: Wings::BLANK,
            prev: Wings::BLANK,
        };
        child.edges.resize(grown.edges, blank);
        child.sides.resize(grown.faces, EdgeId::new(0));
        // Closed meshes have their own compiled version, because their ranks need no lookup.
        match (split, numbers.missing() == 0) {
            (Split::Quads, true) => self.splitting::<true, true>(numbers).fill(child),
            (Split::Quads, false) => self.splitting::<true, false>(numbers).fill(child),
            (_, true) => self.splitting::<false, true>(numbers).fill(child),
            (_, false) => self.splitting::<false, false>(numbers).fill(child),
        }
        Ok(())
    }

    /// O(1) on a closed mesh, otherwise O(log edges).
    fn parent(&self, numbers: &Ranks, split: Split, child: FaceId) -> FaceId {
        if let (Split::Triangles, Some(middle)) =
            (split, child.index().checked_sub(numbers.members()))
        {
            return FaceId::new(row(middle));
        }
        let run = numbers.select(child.index());
        let face = self.edge(EdgeId::new(row(run / 2))).faces()[run % 2];
        face.expect("a run with a rank has a face")
    }

    fn positions_mut(&mut self) -> &mut [Point] {
        self.positions.rows_mut()
    }

    fn position_rows(&self) -> &[Point] {
        self.positions.rows()
    }
}

impl WingedEdgeMesh {
    /// Refuses faces that are not triangles.
    fn check_triangles(&self, counts: &Counts) -> Result<(), RefineError> {
        if counts.corners == 3 * counts.faces {
            return Ok(());
        }
        let degrees = self.faces().map(|face| self.face_edges(face).count());
        match { self.faces().zip(degrees) }.find(|&(_, degree)| degree != 3) {
            Some((face, degree)) => Err(RefineError::NotATriangle { face, degree }),
            None => Ok(()),
        }
    }

    /// Refuses two triangles that share two edges.
    fn check_double_edges(&self) -> Result<(), RefineError> {
        let is_double = |edge: &Edge| {
            let alone = edge.next.on(Side::LEFT) == edge.prev.on(Side::RIGHT);
            alone && !edge.faces.contains(&Slot::NONE)
        };
        if all_rows(self.edge_records(), |edge| !is_double(edge)) {
            return Ok(());
        }
        let mut doubled = self.edge_records().iter().filter(|edge| is_double(edge));
        match doubled.next().map(Edge::faces) {
            Some([Some(first), Some(second)]) => Err(RefineError::DoubleEdge { first, second }),
            _ => Ok(()),
        }
    }

    fn splitting<'a, const QUADS: bool, const CLOSED: bool>(
        &'a self,
        ranks: &'a Ranks,
    ) -> Splitting<'a, QUADS, CLOSED> {
        let vertices = self.positions.len();
        Splitting {
            spokes: self.spoke_rows(),
            edges: self.edge_records(),
            sides: self.side_rows(),
            ranks,
            middle: row(vertices + if QUADS { self.sides.len() } else { 0 }),
            inner: row(2 * self.edges.len()),
        }
    }
}

/// Number of edges whose wings are read together.
const BLOCK: usize = 64;

/// A mesh during a split.
#[derive(Clone, Copy)]
struct Splitting<'a, const QUADS: bool, const CLOSED: bool> {
    spokes: &'a [Slot<EdgeId>],
    edges: &'a [Edge],
    sides: &'a [EdgeId],
    ranks: &'a Ranks,
    /// The vertex in the middle of edge 0.
    middle: u32,
    /// The edge that the corner of rank 0 adds.
    inner: u32,
}

/// The rows of the child for consecutive edges of the parent.
struct Chunk<'a> {
    halves: &'a mut [Edge],
    inner: &'a mut [Edge],
}

/// A run and the child edges along the run. Without a face, the ranks have no meaning.
struct SplitRun {
    face: Slot<FaceId>,
    has_face: bool,
    /// h₀ and h₁.
    halves: [EdgeId; 2],
    /// h₁ of the run before.
    half_before: EdgeId,
    /// h₀ of the run after.
    half_after: EdgeId,
    /// The ranks of the run before, the run itself and the run after.
    ranks: [u32; 3],
    /// The middle of the run before.
    middle_before: VertexId,
}

impl<const QUADS: bool, const CLOSED: bool> Splitting<'_, QUADS, CLOSED> {
    /// Overwrites the tables of `child`, which already have their final lengths.
    fn fill(self, child: &mut WingedEdgeMesh) {
        self.fill_edges(child.edges.rows_mut());
        self.fill_sides(child.sides.rows_mut());
        self.fill_spokes(child.spokes.rows_mut());
    }

    fn fill_edges(self, child: &mut [Edge]) {
        let (mut halves, mut inner) = child.split_at_mut(2 * self.edges.len());
        let chunk_at = |start| start..self.edges.len().min(start + CHUNK_ROWS);
        let mut chunks = Vec::with_capacity(self.edges.len().div_ceil(CHUNK_ROWS));
        for start in (0..self.edges.len()).step_by(CHUNK_ROWS) {
            let edges = chunk_at(start);
            let corners = self.ranks.rank(2 * edges.end) - self.ranks.rank(2 * edges.start);
            let (here, beyond) = halves.split_at_mut(2 * edges.len());
            let (inside, after) = inner.split_at_mut(corners);
            chunks.push(Chunk {
                halves: here,
                inner: inside,
            });
            (halves, inner) = (beyond, after);
        }
        for_each_chunk(&mut chunks, 1, |number, chunks| {
            for chunk in chunks {
                self.fill_chunk(chunk_at(number * CHUNK_ROWS), chunk);
            }
        });
    }

    /// Fills the rows block by block. A short loop first reads the wings of a block, so that the
    /// processor runs many of these reads at once.
    fn fill_chunk(self, edges: Range<usize>, chunk: &mut Chunk<'_>) {
        let mut rank = self.ranks.rank(2 * edges.start) as u32;
        let mut inner = chunk.inner.iter_mut();
        let mut e = edges.start as u32;
        let mut wings = [[[Side::LEFT; 2]; 2]; BLOCK];
        let halves = chunk.halves.as_chunks_mut::<2>().0;
        for (edges, halves) in self.edges[edges]
            .chunks(BLOCK)
            .zip(halves.chunks_mut(BLOCK))
        {
            for (wings, edge) in wings.iter_mut().zip(edges) {
                let left = self.sides_of_wings(edge, Side::LEFT);
                *wings = [left, self.sides_of_wings(edge, Side::RIGHT)];
            }
            for ((edge, wings), halves) in edges.iter().zip(&wings).zip(halves) {
                let left = self.run(EdgeId::new(e), edge, Side::LEFT, wings[0], rank);
                rank += u32::from(left.has_face);
                let right = self.run(EdgeId::new(e), edge, Side::RIGHT, wings[1], rank);
                rank += u32::from(right.has_face);
                for run in [&left, &right] {
                    if run.has_face {
                        let inner = inner.next().expect("one row per rank");
                        *inner = self.inner_edge(EdgeId::new(e), run);
                    }
                }
                *halves = self.halves(EdgeId::new(e), edge, &left, &right);
                e += 1;
            }
        }
    }

    /// Returns the sides of the wings before and after `edge` along `side`.
    #[inline(always)]
    fn sides_of_wings(self, edge: &Edge, side: Side) -> [Side; 2] {
        let [before, after] = [edge.prev.on(side), edge.next.on(side)];
        let [origin, target] = [edge.ends[side.index()], edge.ends[side.other().index()]];
        [
            Side::right_if(self.edges[before.index()].ends[0] == origin),
            Side::right_if(self.edges[after.index()].ends[0] != target),
        ]
    }

    #[inline(always)]
    fn run(self, e: EdgeId, edge: &Edge, side: Side, wings: [Side; 2], rank: u32) -> SplitRun {
        let [before, after] = [edge.prev.on(side), edge.next.on(side)];
        let [before_on, after_on] = wings;
        let face = edge.faces[side.index()];
        SplitRun {
            face,
            has_face: CLOSED || face != Slot::NONE,
            halves: [half(e, side), half(e, side.other())],
            half_before: half(before, before_on.other()),
            half_after: half(after, after_on),
            ranks: [
                self.rank(before, before_on),
                rank,
                self.rank(after, after_on),
            ],
            middle_before: self.middle(before),
        }
    }

    #[inline(always)]
    fn rank(self, e: EdgeId, side: Side) -> u32 {
        let run = half(e, side);
        if CLOSED {
            run.row()
        } else {
            self.ranks.rank(run.index()) as u32
        }
    }

    #[inline(always)]
    fn middle(self, e: EdgeId) -> VertexId {
        VertexId::new(self.middle + e.row())
    }

    #[inline(always)]
    fn inner(self, rank: u32) -> EdgeId {
        EdgeId::new(self.inner + rank)
    }

    #[inline(always)]
    fn halves(self, e: EdgeId, edge: &Edge, left: &SplitRun, right: &SplitRun) -> [Edge; 2] {
        let ([start, end], m) = (edge.ends, self.middle(e));
        let ([left_first, left_second], [right_first, right_second]) =
            (self.links(left), self.links(right));
        [
            edge_record([start, m], left_first, right_second),
            edge_record([m, end], left_second, right_first),
        ]
    }

    /// Returns the face and the wings of h₀ and of h₁.
    #[inline(always)]
    fn links(self, run: &SplitRun) -> [Links; 2] {
        let [first, second] = run.halves;
        let [_, own, after] = run.ranks;
        let (faces, next, prev) = if !run.has_face {
            ([Slot::NONE; 2], second, first)
        } else {
            let prev = if QUADS { own } else { after };
            let faces = [own, after].map(|corner| Slot::some(FaceId::new(corner)));
            (faces, self.inner(own), self.inner(prev))
        };
        [
            Links {
                face: faces[0],
                next,
                prev: run.half_before,
            },
            Links {
                face: faces[1],
                next: run.half_after,
                prev,
            },
        ]
    }

    /// Returns the edge that `run` adds inside its face. This edge starts at the middle of `e`.
    #[inline(always)]
    fn inner_edge(self, e: EdgeId, run: &SplitRun) -> Edge {
        let face = run.face.get().expect("a run with a face");
        let [first, second] = run.halves;
        let [before, own, after] = run.ranks;
        let (end, left_next, right) = if QUADS {
            let right = Links {
                face: Slot::some(FaceId::new(after)),
                next: second,
                prev: self.inner(after),
            };
            (self.face_point(face), self.inner(before), right)
        } else {
            let right = Links {
                face: Slot::some(self.middle_face(face)),
                next: self.inner(after),
                prev: self.inner(before),
            };
            (run.middle_before, run.half_before, right)
        };
        let left = Links {
            face: Slot::some(FaceId::new(own)),
            next: left_next,
            prev: first,
        };
        edge_record([self.middle(e), end], left, right)
    }

    #[inline(always)]
    fn face_point(self, face: FaceId) -> VertexId {
        VertexId::new(self.spokes.len() as u32 + face.row())
    }

    #[inline(always)]
    fn middle_face(self, face: FaceId) -> FaceId {
        FaceId::new(self.ranks.members() as u32 + face.row())
    }

    fn fill_sides(self, child: &mut [EdgeId]) {
        let (of_corners, of_middles) = child.split_at_mut(self.ranks.members());
        for_each_chunk(of_corners, CHUNK_ROWS, |first, sides| {
            for (rank, side) in (first as u32..).zip(sides) {
                *side = self.inner(rank);
            }
        });
        for_each_chunk(of_middles, CHUNK_ROWS, |first, sides| {
            for ((face, &parent), side) in (first..).zip(&self.sides[first..]).zip(sides) {
                *side = self.edge_inside(FaceId::new(face as u32), parent);
            }
        });
    }

    /// Returns an edge that a corner of `face` adds. `e` is a side of `face`.
    #[inline(always)]
    fn edge_inside(self, face: FaceId, e: EdgeId) -> EdgeId {
        let on = Side::right_if(self.edges[e.index()].faces[0] != Slot::some(face));
        self.inner(self.rank(e, on))
    }

    /// Sets the spokes. A spoke on a boundary must run so that its right side has no face.
    fn fill_spokes(self, child: &mut [Slot<EdgeId>]) {
        let (old, new) = child.split_at_mut(self.spokes.len());
        let (of_faces, of_edges) = new.split_at_mut(if QUADS { self.sides.len() } else { 0 });
        for_each_chunk(old, CHUNK_ROWS, |first, spokes| {
            for ((v, parent), spoke) in (first as u32..).zip(&self.spokes[first..]).zip(spokes) {
                *spoke = Slot::from(parent.get().map(|e| {
                    let [start, _] = self.edges[e.index()].ends;
                    half(e, Side::right_if(start != VertexId::new(v)))
                }));
            }
        });
        for_each_chunk(of_faces, CHUNK_ROWS, |first, spokes| {
            for ((face, &e), spoke) in (first as u32..).zip(&self.sides[first..]).zip(spokes) {
                *spoke = Slot::some(self.edge_inside(FaceId::new(face), e));
            }
        });
        for_each_chunk(of_edges, CHUNK_ROWS, |first, spokes| {
            if CLOSED {
                for (e, spoke) in (first as u32..).zip(spokes) {
                    *spoke = Slot::some(half(EdgeId::new(e), Side::LEFT));
                }
                return;
            }
            for ((e, edge), spoke) in (first as u32..).zip(&self.edges[first..]).zip(spokes) {
                // The run from the middle to the start of the edge has the right face of the edge
                // on its left.
                let on = Side::right_if(edge.faces[1] == Slot::NONE);
                *spoke = Slot::some(half(EdgeId::new(e), on));
            }
        });
    }
}

/// The face and the two wings on one side of an edge.
#[derive(Clone, Copy)]
struct Links {
    face: Slot<FaceId>,
    next: EdgeId,
    prev: EdgeId,
}

#[inline(always)]
fn edge_record(ends: [VertexId; 2], left: Links, right: Links) -> Edge {
    Edge {
        ends,
        faces: [left.face, right.face],
        next: Wings::new([left.next, right.next]),
        prev: Wings::new([left.prev, right.prev]),
    }
}

/// Returns the first half of the run. The row of this half is also the number of the run.
#[inline(always)]
fn half(e: EdgeId, side: Side) -> EdgeId {
    EdgeId::new(2 * e.row() + side.index() as u32)
}

#[cfg(test)]
mod tests;

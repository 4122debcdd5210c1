//! Filling of the child's tables. [`refine`](crate::refine) draws the layout.

use std::ops::Range;

use sixfold_core::{CHUNK_ROWS, FaceId, VertexId, for_each_chunk, map_chunks, row};

use crate::FaceVertexMesh;
use crate::edge_numbers::{EdgeChunk, EdgeNumbers};
use crate::mesh::Fan;

/// Maximum number of sides in one batch. Each end of a loop costs a branch misprediction, so a
/// large batch is faster.
const BATCH: usize = 512;

/// A mesh during its split. `DEGREE` is the degree of all its faces, or 0 if degrees differ.
#[derive(Clone, Copy)]
pub(crate) struct Splitting<'a, const DEGREE: usize, const QUADS: bool> {
    mesh: &'a FaceVertexMesh,
    by_corner: &'a [u32],
    chunks: &'a [EdgeChunk],
    /// The vertex row of the middle of the first edge.
    middle: u32,
}

impl FaceVertexMesh {
    /// Returns this mesh prepared for its split. `DEGREE` is the degree of all its faces, or 0 if
    /// degrees differ.
    pub(crate) fn splitting<'a, const DEGREE: usize, const QUADS: bool>(
        &'a self,
        numbers: &'a EdgeNumbers,
    ) -> Splitting<'a, DEGREE, QUADS> {
        let (vertices, faces) = (self.fans.len(), self.spans.len());
        Splitting {
            mesh: self,
            by_corner: &numbers.by_corner,
            chunks: &numbers.chunks,
            middle: row(vertices + if QUADS { faces } else { 0 }),
        }
    }
}

/// The child rows for a range of vertices, and for the edges with lower ends in this range.
struct Chunk<'a> {
    vertices: Range<usize>,
    /// The number of the first edge.
    first: usize,
    /// The place in the whole pool where `pool` starts.
    start: usize,
    /// The parts of faces around the vertices.
    around: &'a mut [FaceId],
    /// The fans of the middles.
    fans: &'a mut [Fan],
    /// The places of the fans of the middles.
    pool: &'a mut [FaceId],
}

/// A side along an edge, with the parts of its face at both ends of the side.
#[derive(Clone, Copy, Default)]
struct Side {
    edge: u32,
    parts: [u32; 2],
}

impl<const DEGREE: usize, const QUADS: bool> Splitting<'_, DEGREE, QUADS> {
    /// Number of parts of a face at the middle of a side.
    const PARTS_AT_MIDDLE: usize = if QUADS { 2 } else { 3 };

    /// Overwrites the tables of `child`, which already have their final lengths.
    pub(crate) fn fill(self, child: &mut FaceVertexMesh) {
        self.fill_corners(child.corners.rows_mut());
        let (old, fans) = child.fans.rows_mut().split_at_mut(self.mesh.fans.len());
        let (around, pool) = child.pool.rows_mut().split_at_mut(self.by_corner.len());
        let mut start = 0;
        for (new, old) in old.iter_mut().zip(self.mesh.fans.rows()) {
            let len = old.len;
            *new = Fan { start, len };
            start += len;
        }
        let points = if QUADS { self.mesh.spans.len() } else { 0 };
        let (face_fans, edge_fans) = fans.split_at_mut(points);
        let (face_pool, edge_pool) = pool.split_at_mut(if QUADS { around.len() } else { 0 });
        self.fill_face_points(face_fans, face_pool);
        self.fill_fans(old, around, edge_fans, edge_pool);
    }

    /// Returns the part at a corner of face `f`.
    #[inline(always)]
    fn part(self, f: FaceId, corner: u32) -> u32 {
        if QUADS {
            corner
        } else {
            corner + f.index() as u32
        }
    }

    fn fill_corners(self, child: &mut [VertexId]) {
        let faces = self.mesh.spans.len();
        let first = |f: usize| match f {
            _ if f == faces => self.by_corner.len(),
            _ => self.mesh.corners_of::<DEGREE>(FaceId::new(row(f))).start,
        };
        let bounds = (0..faces).step_by(CHUNK_ROWS).chain([faces]);
        // Four rows per corner: a quad, or a triangle and a third of the inner triangle.
        let starts: Vec<usize> = bounds.map(|f| 4 * first(f)).collect();
        map_chunks(child, &starts, |chunk, _, child| {
            let faces = chunk * CHUNK_ROWS..faces.min((chunk + 1) * CHUNK_ROWS);
            self.fill_corners_of(faces, child);
        });
    }

    /// Fills the corners of the parts of a range of faces.
    fn fill_corners_of(self, faces: Range<usize>, child: &mut [VertexId]) {
        let corners = self.mesh.corners.rows();
        let mut at = 0;
        for f in faces {
            let range = self.mesh.corners_of::<DEGREE>(FaceId::new(f as u32));
            let child = &mut child[at..at + 4 * range.len()];
            at += child.len();
            let middle = |&number: &u32| VertexId::new(self.middle + number);
            let numbers = &self.by_corner[range.clone()];
            let mut before = middle(&numbers[numbers.len() - 1]);
            let sides = corners[range].iter().zip(numbers.iter().map(middle));
            if QUADS {
                let face_point = VertexId::new((self.mesh.fans.len() + f) as u32);
                for ((&corner, middle), quad) in sides.zip(child.as_chunks_mut::<4>().0) {
                    *quad = [corner, middle, face_point, before];
                    before = middle;
                }
            } else {
                let [parts @ .., inner] = child.as_chunks_mut::<3>().0 else {
                    unreachable!("four triangles a face")
                };
                for (((&corner, middle), part), inner) in sides.zip(parts).zip(inner) {
                    *part = [corner, middle, before];
                    *inner = middle;
                    before = middle;
                }
            }
        }
    }

    /// Fills the fans of the face points. A face point has the parts of its face, in order.
    fn fill_face_points(self, fans: &mut [Fan], pool: &mut [FaceId]) {
        // The fans of the old vertices come first, with one place for each corner.
        let start = self.by_corner.len();
        for_each_chunk(fans, CHUNK_ROWS, |first, fans| {
            for (f, fan) in (first..).zip(fans) {
                let range = self.mesh.corners_of::<DEGREE>(FaceId::new(f as u32));
                *fan = Fan {
                    start: (start + range.start) as u32,
                    len: range.len() as u32,
                };
            }
        });
        for_each_chunk(pool, CHUNK_ROWS, |first, pool| {
            for (part, place) in (first as u32..).zip(pool) {
                *place = FaceId::new(part);
            }
        });
    }

    fn fill_fans(
        self,
        old: &[Fan],
        mut around: &mut [FaceId],
        mut fans: &mut [Fan],
        mut pool: &mut [FaceId],
    ) {
        let places = if QUADS { 2 } else { 1 } * around.len();
        let ends_at = around.len();
        let place = |v: usize| old.get(v).map_or(ends_at, |fan| fan.start as usize);
        let mut chunks = Vec::with_capacity(self.chunks.len());
        for bounds in self.chunks.windows(2) {
            let [from, to] = [bounds[0], bounds[1]];
            let (here, middles, along);
            (here, around) = around.split_at_mut(place(to.vertex) - place(from.vertex));
            (middles, fans) = fans.split_at_mut(to.edge - from.edge);
            (along, pool) = pool.split_at_mut(Self::PARTS_AT_MIDDLE * (to.side - from.side));
            chunks.push(Chunk {
                vertices: from.vertex..to.vertex,
                first: from.edge,
                start: places + Self::PARTS_AT_MIDDLE * from.side,
                around: here,
                fans: middles,
                pool: along,
            });
        }
        for_each_chunk(&mut chunks, 1, |_, chunks| {
            for chunk in chunks {
                self.fill_chunk(chunk);
            }
        });
    }

    /// Finds the sides of the edges of a range of vertices, counts the sides of each edge, and adds
    /// the sides to the fans.
    fn fill_chunk(self, chunk: &mut Chunk<'_>) {
        let mut sides = [Side::default(); BATCH];
        let mut around = std::mem::take(&mut chunk.around);
        let (mut v, mut known, mut end) = (chunk.vertices.start, chunk.first, chunk.start);
        chunk.fans.fill(Fan::default());
        while v < chunk.vertices.end {
            let (first, mut found) = (known, 0);
            while v < chunk.vertices.end {
                let vertex = VertexId::new(v as u32);
                let fan = self.mesh.fan(vertex);
                let Some(room) = sides.get_mut(found..found + 2 * fan.len()) else {
                    break;
                };
                let (here, after) = std::mem::take(&mut around).split_at_mut(fan.len());
                around = after;
                let batch = self.find_sides(vertex, fan, known, here, room);
                found += batch.found;
                known = batch.known;
                v += 1;
            }
            if known == first && found == 0 && v < chunk.vertices.end {
                // If the fan does not fit into `sides`, two loops process its pieces: the first
                // loop counts the sides, the second loop adds the sides.
                let vertex = VertexId::new(v as u32);
                let fan = self.mesh.fan(vertex);
                let (here, after) = std::mem::take(&mut around).split_at_mut(fan.len());
                around = after;
                for (faces, here) in fan.chunks(BATCH / 2).zip(here.chunks_mut(BATCH / 2)) {
                    let batch = self.find_sides(vertex, faces, first, here, &mut sides);
                    chunk.count(&sides[..batch.found], Self::PARTS_AT_MIDDLE);
                    known = known.max(batch.known);
                }
                end = chunk.place_fans(first..known, end);
                for (faces, here) in fan.chunks(BATCH / 2).zip(here.chunks_mut(BATCH / 2)) {
                    let batch = self.find_sides(vertex, faces, first, here, &mut sides);
                    self.append_to_fans(&sides[..batch.found], chunk);
                }
                v += 1;
                continue;
            }
            chunk.count(&sides[..found], Self::PARTS_AT_MIDDLE);
            end = chunk.place_fans(first..known, end);
            self.append_to_fans(&sides[..found], chunk);
        }
    }

    /// Finds the sides of `v` in these faces of the fan of `v`, if the number of their edge is at
    /// least `known`. Writes the sides into `sides`, and the part of each face at `v` into
    /// `around`.
    #[inline(always)]
    fn find_sides(
        self,
        v: VertexId,
        faces: &[FaceId],
        known: usize,
        around: &mut [FaceId],
        sides: &mut [Side],
    ) -> FoundSides {
        let (mut found, mut end) = (0, known as u32);
        for (&f, place) in faces.iter().zip(around) {
            let corners = self.mesh.corners_around::<DEGREE>(f, v);
            let [before, at, after] = corners.map(|corner| self.part(f, corner));
            *place = FaceId::new(at);
            for (corner, parts) in [(corners[0], [before, at]), (corners[1], [at, after])] {
                let edge = self.by_corner[corner as usize];
                sides[found] = Side { edge, parts };
                // No branch, because the result is unpredictable.
                found += usize::from(edge as usize >= known);
                end = end.max(edge + 1);
            }
        }
        FoundSides {
            found,
            known: end as usize,
        }
    }

    /// Adds the parts along these sides to the fans of the middles.
    #[inline(always)]
    fn append_to_fans(self, sides: &[Side], chunk: &mut Chunk<'_>) {
        for side in sides {
            let fan = &mut chunk.fans[side.edge as usize - chunk.first];
            let places = fan.range().end - chunk.start;
            let [first, second] = side.parts;
            let pool = &mut chunk.pool[places..places + Self::PARTS_AT_MIDDLE];
            // Sorted by face, as in all fans that no edit has changed.
            pool[0] = FaceId::new(first.min(second));
            pool[1] = FaceId::new(first.max(second));
            if !QUADS {
                // The middle part of a triangle.
                pool[2] = FaceId::new(first | 3);
            }
            fan.len += Self::PARTS_AT_MIDDLE as u32;
        }
    }
}

/// The result of [`Splitting::find_sides`].
struct FoundSides {
    found: usize,
    /// One more than the highest edge number found.
    known: usize,
}

impl Chunk<'_> {
    /// Adds `parts` to the length of the fan of each side's edge.
    #[inline(always)]
    fn count(&mut self, sides: &[Side], parts: usize) {
        for side in sides {
            self.fans[side.edge as usize - self.first].len += parts as u32;
        }
    }

    /// Places the empty fans of these edges one after another, from place `start` of the pool.
    /// Returns the place where the next fan starts.
    #[inline(always)]
    fn place_fans(&mut self, edges: Range<usize>, start: usize) -> usize {
        let mut start = start as u32;
        for fan in &mut self.fans[edges.start - self.first..edges.end - self.first] {
            fan.start = start;
            start += std::mem::take(&mut fan.len);
        }
        start as usize
    }
}

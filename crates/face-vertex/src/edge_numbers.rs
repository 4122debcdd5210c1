//! Numbers for edges, which are pairs of vertices, stored by side.

use std::hint::select_unpredictable;
use std::ops::Range;

use sixfold_core::{CHUNK_ROWS, FaceId, FaceSpans, Pair, VertexId, row};

use crate::FaceVertexMesh;

/// The number of each edge. The numbers are stored by corner: the entry of a corner is the number
/// of the edge from this corner to the next corner. The number of an edge is its position in
/// `edges()`.
///
/// ```text
///    c ──3── b     corners   a b c │ a d b      edges  0 ab, 1 ac, 2 ad  by the lower end, then
///    │ f0  / │     numbers   0 3 1 │ 2 4 0             3 bc, 4 bd        in order of their sides
///    1   0   4
///    │ /  f1 │
///    a ──2── d
/// ```
///
/// The numbers use four bytes per corner and four bytes per vertex.
#[derive(Clone, Debug, Default)]
pub struct EdgeNumbers {
    pub(crate) by_corner: Vec<u32>,
    /// The starts of the chunks, and the end of the last chunk.
    pub(crate) chunks: Vec<EdgeChunk>,
    /// For each vertex, 1 + the highest number of the edges with this vertex as higher end. Used
    /// only while edges are numbered.
    bounds: Vec<u32>,
}

/// The start of a chunk. A chunk has all edges whose lower ends are in a range of vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct EdgeChunk {
    /// The first vertex of the range.
    pub(crate) vertex: usize,
    /// The number of the first edge.
    pub(crate) edge: usize,
    /// Number of sides along earlier edges.
    pub(crate) side: usize,
}

/// Number of faces that are read before their sides are processed.
const FEW: usize = 64;

impl EdgeNumbers {
    /// Numbers the edges of `mesh`, fan after fan. A side to a higher vertex gets a new number if
    /// its edge is new in this fan. O(corners · degree + vertices).
    pub(crate) fn fill(&mut self, mesh: &FaceVertexMesh) {
        match mesh.spans {
            FaceSpans::Uniform { degree: 3, .. } => self.fill_from::<3>(mesh),
            FaceSpans::Uniform { degree: 4, .. } => self.fill_from::<4>(mesh),
            _ => self.fill_from::<0>(mesh),
        }
    }

    fn fill_from<const DEGREE: usize>(&mut self, mesh: &FaceVertexMesh) {
        self.by_corner.resize(mesh.corners.len(), 0);
        self.bounds.clear();
        self.bounds.resize(mesh.fans.len(), 0);
        self.chunks.clear();
        self.chunks.push(EdgeChunk::default());
        let (mut edges, mut sides, mut last) = (0_u32, 0, 0);
        let mut upward = [[0; 2]; 2 * FEW];
        let mut in_order = Vec::new();
        for v in (0..row(mesh.fans.len())).map(VertexId::new) {
            if edges as usize - last >= CHUNK_ROWS {
                last = edges as usize;
                self.chunks.push(EdgeChunk {
                    vertex: v.index(),
                    edge: last,
                    side: sides,
                });
            }
            let mut fan = mesh.fan(v);
            if !fan.is_sorted() {
                // I3 does not fix an order of the fan, but `edges()` uses the order of the faces.
                in_order.clear();
                in_order.extend_from_slice(fan);
                in_order.sort_unstable();
                fan = &in_order;
            }
            // If this fan already has an edge to a higher end, the bound of the higher end is above
            // `known`.
            let known = edges;
            for faces in fan.chunks(FEW) {
                let found = mesh.sides_upward::<DEGREE>(v, faces, &mut upward);
                for &[corner, high] in &upward[..found] {
                    let bound = &mut self.bounds[high as usize];
                    let is_new = *bound <= known;
                    edges += u32::from(is_new);
                    *bound = select_unpredictable(is_new, edges, *bound);
                    self.by_corner[corner as usize] = *bound - 1;
                }
                sides += found;
            }
        }
        if last == edges as usize {
            self.chunks.pop();
        }
        self.chunks.push(EdgeChunk {
            vertex: mesh.fans.len(),
            edge: edges as usize,
            side: sides,
        });
    }

    pub(crate) fn edges(&self) -> usize {
        self.chunks.last().map_or(0, |end| end.edge)
    }
}

impl FaceVertexMesh {
    /// Returns the corners of `f`. `DEGREE` is the degree of all faces, or 0 if degrees differ.
    #[inline(always)]
    pub(crate) fn corners_of<const DEGREE: usize>(&self, f: FaceId) -> Range<usize> {
        if DEGREE == 0 {
            return self.spans.range(f);
        }
        DEGREE * f.index()..DEGREE * (f.index() + 1)
    }

    /// Returns the corners before, at and after `v` in `f`, which contains `v`.
    #[inline(always)]
    pub(crate) fn corners_around<const DEGREE: usize>(&self, f: FaceId, v: VertexId) -> [u32; 3] {
        let range = self.corners_of::<DEGREE>(f);
        let face = &self.corners.rows()[range.clone()];
        let i = if DEGREE == 0 {
            let i = face.iter().position(|&corner| corner == v);
            i.expect("I3: a face in the fan of a vertex contains it")
        } else {
            // No branch, because the place of `v` is unpredictable.
            (1..DEGREE).map(|i| i * usize::from(face[i] == v)).sum()
        };
        let last = face.len() - 1;
        let before = select_unpredictable(i == 0, last, i.wrapping_sub(1));
        let after = select_unpredictable(i == last, 0, i + 1);
        [before, i, after].map(|i| (range.start + i) as u32)
    }

    /// Writes the sides between `v` and higher vertices into `sides`: the corner where the side
    /// starts, and the higher vertex. Returns the number of sides.
    #[inline(always)]
    fn sides_upward<const DEGREE: usize>(
        &self,
        v: VertexId,
        faces: &[FaceId],
        sides: &mut [[u32; 2]; 2 * FEW],
    ) -> usize {
        let corners = self.corners.rows();
        let mut found = 0;
        for &f in faces {
            let [before, at, after] = self.corners_around::<DEGREE>(f, v);
            let to = corners[after as usize].index() as u32;
            let from = corners[before as usize].index() as u32;
            // Sorted by the corners where the sides start.
            let turned = at < before;
            let highs = [
                select_unpredictable(turned, to, from),
                select_unpredictable(turned, from, to),
            ];
            let starts = [before.min(at), before.max(at)];
            for (corner, high) in starts.into_iter().zip(highs) {
                sides[found] = [corner, high];
                found += usize::from(high > v.index() as u32);
            }
        }
        found
    }

    pub(crate) fn edges_in_chunk(
        &self,
        numbers: &EdgeNumbers,
        chunk: usize,
    ) -> Vec<Pair<VertexId>> {
        match self.spans {
            FaceSpans::Uniform { degree: 3, .. } => self.edges_from::<3>(numbers, chunk),
            FaceSpans::Uniform { degree: 4, .. } => self.edges_from::<4>(numbers, chunk),
            _ => self.edges_from::<0>(numbers, chunk),
        }
    }

    fn edges_from<const DEGREE: usize>(
        &self,
        numbers: &EdgeNumbers,
        chunk: usize,
    ) -> Vec<Pair<VertexId>> {
        let [from, to] = [chunk, chunk + 1].map(|chunk| numbers.chunks[chunk]);
        let blank = Pair::new(VertexId::new(0), VertexId::new(0));
        let mut edges = vec![blank; to.edge - from.edge];
        let mut sides = [[0; 2]; 2 * FEW];
        for v in (row(from.vertex)..row(to.vertex)).map(VertexId::new) {
            for faces in self.fan(v).chunks(FEW) {
                let found = self.sides_upward::<DEGREE>(v, faces, &mut sides);
                for &[corner, high] in &sides[..found] {
                    let number = numbers.by_corner[corner as usize] as usize;
                    edges[number - from.edge] = Pair::new(v, VertexId::new(high));
                }
            }
        }
        edges
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};

    use super::*;

    /// Numbers the edges, and checks that the numbers are positions in `edges()`.
    fn numbered(mesh: &FaceVertexMesh) -> EdgeNumbers {
        let mut numbers = EdgeNumbers::default();
        // The first mesh checks that the memory can be reused.
        numbers.fill(&build(3, &[[0, 2, 1]]));
        numbers.fill(mesh);
        let edges: Vec<Pair<VertexId>> = mesh.edges().collect();
        assert_eq!(numbers.edges(), edges.len());
        let sides = mesh.faces().flat_map(|f| mesh.sides(f));
        for (&number, side) in numbers.by_corner.iter().zip(sides) {
            assert_eq!(edges[number as usize], side);
        }
        numbers
    }

    fn build(
        vertices: usize,
        faces: impl IntoIterator<Item: AsRef<[u32]>> + Clone,
    ) -> FaceVertexMesh {
        let polygons = PolygonMesh::new(vec![Point::ZERO; vertices], faces).expect("valid");
        FaceVertexMesh::from_polygons(&polygons).expect("holds every mesh")
    }

    #[test]
    fn numbers_are_positions_in_edges_for_any_order_of_fans() {
        let mut square = build(4, &[[0, 1, 2], [0, 3, 1]]);
        assert_eq!(numbered(&square).by_corner, [0, 3, 1, 2, 4, 0], "as drawn");
        square.pool.rows_mut()[..2].reverse();
        assert_eq!(
            numbered(&square).by_corner,
            [0, 3, 1, 2, 4, 0],
            "fans turned"
        );
        let end = |vertex| EdgeChunk {
            vertex,
            ..EdgeChunk::default()
        };
        assert_eq!(numbered(&build(2, &[[0; 3]; 0])).chunks, [end(2)]);
    }

    #[test]
    fn chunks_start_at_vertices() {
        // v0 is the lower end of half of the edges, v1 of the other half.
        let n = 2 * CHUNK_ROWS;
        let mesh = build(n + 5, (0..row(n)).map(|i| [0, 1, i + 2]));
        let chunk = |vertex, edge, side| EdgeChunk { vertex, edge, side };
        let expected = [
            chunk(0, 0, 0),
            chunk(1, n + 1, 2 * n),
            chunk(n + 5, 2 * n + 1, 3 * n),
        ];
        let numbers = numbered(&mesh);
        assert_eq!(numbers.chunks, expected);
        let both = [0, 1].map(|chunk| mesh.edges_in_chunk(&numbers, chunk));
        assert!(mesh.edges().eq(both.concat()));
    }
}

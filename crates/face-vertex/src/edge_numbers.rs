//! Numbers for edges, which are pairs, by the sides along them.

use std::hint::select_unpredictable;
use std::ops::Range;

use mesh_core::{FaceId, FaceSpans, PART, Pair, VertexId, row};

use crate::mesh::FaceVertexMesh;

/// By corner, the number of the edge along the side that starts there: its place in `edges()`.
///
/// ```text
///    c ──3── b     corners   a b c │ a d b      edges  0 ab, 1 ac, 2 ad  by the lower end, and
///    │ f0  / │     numbers   0 3 1 │ 2 4 0             3 bc, 4 bd        as their sides come
///    1   0   4
///    │ /  f1 │
///    a ──2── d
/// ```
///
/// Four bytes a corner, and four a vertex that are kept for the next mesh.
#[derive(Clone, Debug, Default)]
pub struct EdgeNumbers {
    pub(crate) by_corner: Vec<u32>,
    /// Where the parts begin, and the end of the last.
    pub(crate) parts: Vec<EdgePart>,
    /// By vertex: one more than the last number of an edge of which it is the higher end. Of use
    /// while edges are numbered.
    met: Vec<u32>,
}

/// Where some thousand edges begin: all those of some vertices in a row, which are their lower ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct EdgePart {
    /// The first of the vertices.
    pub(crate) vertex: usize,
    /// The number of the first edge.
    pub(crate) edge: usize,
    /// How many sides run along earlier edges.
    pub(crate) side: usize,
}

/// How many faces of a fan are looked at before their sides are gone through.
const FEW: usize = 64;

impl EdgeNumbers {
    /// Numbers the edges of `mesh`: fan after fan, every side to a higher vertex, unless its edge has
    /// been met in the fan; O(corners · degree + vertices).
    pub(crate) fn fill(&mut self, mesh: &FaceVertexMesh) {
        match mesh.spans {
            FaceSpans::Uniform { degree: 3, .. } => self.fill_from::<3>(mesh),
            FaceSpans::Uniform { degree: 4, .. } => self.fill_from::<4>(mesh),
            _ => self.fill_from::<0>(mesh),
        }
    }

    fn fill_from<const DEGREE: usize>(&mut self, mesh: &FaceVertexMesh) {
        self.by_corner.resize(mesh.corners.len(), 0);
        self.met.clear();
        self.met.resize(mesh.fans.len(), 0);
        self.parts.clear();
        self.parts.push(EdgePart::default());
        let (mut edges, mut sides, mut last) = (0_u32, 0, 0);
        let mut upward = [[0; 2]; 2 * FEW];
        let mut in_order = Vec::new();
        for v in (0..row(mesh.fans.len())).map(VertexId::new) {
            if edges as usize - last >= PART {
                last = edges as usize;
                self.parts.push(EdgePart {
                    vertex: v.index(),
                    edge: last,
                    side: sides,
                });
            }
            let mut fan = mesh.fan(v);
            if !fan.is_sorted() {
                // I3 promises no order, but `edges()` goes by that of the faces.
                in_order.clear();
                in_order.extend_from_slice(fan);
                in_order.sort_unstable();
                fan = &in_order;
            }
            // Numbers rise, so a higher end met here has a higher one than any met before.
            let known = edges;
            for faces in fan.chunks(FEW) {
                let found = mesh.sides_upward::<DEGREE>(v, faces, &mut upward);
                for &[corner, high] in &upward[..found] {
                    let met = &mut self.met[high as usize];
                    let is_new = *met <= known;
                    edges += u32::from(is_new);
                    *met = select_unpredictable(is_new, edges, *met);
                    self.by_corner[corner as usize] = *met - 1;
                }
                sides += found;
            }
        }
        if last == edges as usize {
            self.parts.pop();
        }
        self.parts.push(EdgePart {
            vertex: mesh.fans.len(),
            edge: edges as usize,
            side: sides,
        });
    }

    /// How many edges there are.
    pub(crate) fn edges(&self) -> usize {
        self.parts.last().map_or(0, |end| end.edge)
    }
}

impl FaceVertexMesh {
    /// The corners of `f`; `DEGREE` is that of all faces, or 0 where it is not known.
    #[inline(always)]
    pub(crate) fn corners_of<const DEGREE: usize>(&self, f: FaceId) -> Range<usize> {
        if DEGREE == 0 {
            return self.spans.range(f);
        }
        DEGREE * f.index()..DEGREE * (f.index() + 1)
    }

    /// The corner of `v` in `f`, which names it, between the ones before and after it.
    #[inline(always)]
    pub(crate) fn around<const DEGREE: usize>(&self, f: FaceId, v: VertexId) -> [u32; 3] {
        let range = self.corners_of::<DEGREE>(f);
        let face = &self.corners.rows()[range.clone()];
        let i = if DEGREE == 0 {
            let i = face.iter().position(|&corner| corner == v);
            i.expect("I3: a face in the fan of a vertex names it")
        } else {
            // No branch: where `v` stands is not to be foreseen.
            (1..DEGREE).map(|i| i * usize::from(face[i] == v)).sum()
        };
        let last = face.len() - 1;
        let before = select_unpredictable(i == 0, last, i.wrapping_sub(1));
        let after = select_unpredictable(i == last, 0, i + 1);
        [before, i, after].map(|i| (range.start + i) as u32)
    }

    /// Puts the sides between `v` and a higher vertex in these faces of its fan into `sides`, each as
    /// the corner where it starts and the higher vertex; how many there are.
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
            let [before, at, after] = self.around::<DEGREE>(f, v);
            let to = corners[after as usize].index() as u32;
            let from = corners[before as usize].index() as u32;
            // In the order of the corners where they start.
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

    /// The edges of a part, in the order of their numbers.
    pub(crate) fn edges_between(&self, numbers: &EdgeNumbers, part: usize) -> Vec<Pair<VertexId>> {
        match self.spans {
            FaceSpans::Uniform { degree: 3, .. } => self.edges_from::<3>(numbers, part),
            FaceSpans::Uniform { degree: 4, .. } => self.edges_from::<4>(numbers, part),
            _ => self.edges_from::<0>(numbers, part),
        }
    }

    fn edges_from<const DEGREE: usize>(
        &self,
        numbers: &EdgeNumbers,
        part: usize,
    ) -> Vec<Pair<VertexId>> {
        let [from, to] = [part, part + 1].map(|part| numbers.parts[part]);
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
    use mesh_core::{MeshQuery, Point, PolygonMesh, Representation};

    use super::*;

    /// The numbers of the edges, having seen that they are places in `edges()`.
    fn numbered(mesh: &FaceVertexMesh) -> EdgeNumbers {
        let mut numbers = EdgeNumbers::default();
        // Filled with something else before.
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
        FaceVertexMesh::from_polygons(&polygons).expect("holds everything")
    }

    #[test]
    fn numbers_are_places_in_edges_in_whichever_order_fans_are() {
        let mut square = build(4, &[[0, 1, 2], [0, 3, 1]]);
        assert_eq!(numbered(&square).by_corner, [0, 3, 1, 2, 4, 0], "as drawn");
        square.pool.rows_mut()[..2].reverse();
        assert_eq!(
            numbered(&square).by_corner,
            [0, 3, 1, 2, 4, 0],
            "fans turned"
        );
        let end = |vertex| EdgePart {
            vertex,
            ..EdgePart::default()
        };
        assert_eq!(numbered(&build(2, &[[0; 3]; 0])).parts, [end(2)]);
    }

    #[test]
    fn parts_are_cut_between_vertices() {
        // A book of many pages: v0 is the lower end of half of the edges, v1 of the others.
        let n = 2 * PART;
        let mesh = build(n + 5, (0..row(n)).map(|page| [0, 1, page + 2]));
        let part = |vertex, edge, side| EdgePart { vertex, edge, side };
        let cut = [
            part(0, 0, 0),
            part(1, n + 1, 2 * n),
            part(n + 5, 2 * n + 1, 3 * n),
        ];
        let numbers = numbered(&mesh);
        assert_eq!(numbers.parts, cut);
        let both = [0, 1].map(|part| mesh.edges_between(&numbers, part));
        assert!(mesh.edges().eq(both.concat()));
    }
}

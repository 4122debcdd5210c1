//! Splits of every face in the structure's own tables; every new row has a closed formula.
//!
//! ```text
//!           Quads                          Triangles
//!    d────── m₂ ──────c                        c           The part at corner k, the i-th of face f:
//!    │   3   │   2    │                       ╱2╲          quads        k
//!    │       │        │                     m₂───m₁        triangles    4f + i, the middle 4f + 3
//!   m₃ ───── f ────── m₁                    ╱ ╲3╱ ╲
//!    │       │        │                    ╱ 0 ╳ 1 ╲       Its corners: the old vertex, m of its
//!    │   0   │   1    │                   a────m₀───b      side, (f,) and m of the side before.
//!    a────── m₀ ──────b
//! ```
//!
//! The [number](EdgeNumbers) of an edge gives the vertex in its middle. The pool stores the fans of
//! the child in the order of its vertices, without gaps:
//!
//! - The fan of an old vertex has one part (child face) of each old face at the vertex: the part at
//!   the vertex.
//! - The fan of a face point has the parts of the face, in order.
//! - The fan of an edge point has the parts at both ends of each side along the edge. For
//!   triangles, the fan also has the middle part.
//!
//! All edges with the same lower end have consecutive numbers. So a range of vertices fills a range
//! of rows.

use sixfold_core::{
    Counts, FaceId, FaceSpans, MeshQuery, NoHoles, Pair, Point, Refine, RefineError, Split, Table,
    VertexId, check_split, row,
};

use crate::FaceVertexMesh;
use crate::edge_numbers::EdgeNumbers;
use crate::mesh::Fan;

impl Refine for FaceVertexMesh {
    const SPLITS: &'static [Split] = &[Split::Quads, Split::Triangles];

    type EdgeNumbers = EdgeNumbers;

    fn empty() -> Self {
        Self {
            positions: Table::new("positions", "vertex", Vec::new()),
            corners: Table::new("corners", "corner", Vec::new()),
            spans: FaceSpans::Uniform {
                degree: 3,
                faces: 0,
            },
            fans: Table::new("fans", "vertex", Vec::new()),
            pool: Table::new("pool", "place", Vec::new()),
            vertex_holes: NoHoles,
            face_holes: NoHoles,
        }
    }

    /// Takes O(corners · degree + vertices) time.
    fn number_edges(&self, numbers: &mut EdgeNumbers) {
        numbers.fill(self);
    }

    fn edge_chunks(&self, numbers: &EdgeNumbers) -> Vec<usize> {
        numbers.chunks.iter().map(|chunk| chunk.edge).collect()
    }

    /// Searches the fans of the lower ends of the edges.
    fn edges_of_chunk(
        &self,
        numbers: &EdgeNumbers,
        chunk: usize,
    ) -> impl Iterator<Item = Pair<VertexId>> {
        self.edges_in_chunk(numbers, chunk).into_iter()
    }

    /// Searches the shorter fan of the two ends; O(length · degree).
    fn edge_number(&self, numbers: &EdgeNumbers, e: Pair<VertexId>) -> usize {
        let (v, fan, other) = self.shorter_fan(e);
        let corners = self.corners.rows();
        let side = fan.iter().find_map(|&f| {
            let [before, at, after] = self.corners_around::<0>(f, v);
            if corners[after as usize] == other {
                Some(at)
            } else {
                (corners[before as usize] == other).then_some(before)
            }
        });
        let Some(side) = side else {
            panic!("no edge {e:?}: its ends are not adjacent in any face")
        };
        numbers.by_corner[side as usize] as usize
    }

    /// Takes O(corners · degree + vertices) time.
    fn split_into(
        &self,
        split: Split,
        numbers: &EdgeNumbers,
        child: &mut Self,
    ) -> Result<(), RefineError> {
        let counts = Counts {
            vertices: self.fans.len(),
            edges: numbers.edges(),
            faces: self.spans.len(),
            corners: self.corners.len(),
            uniform: matches!(self.spans, FaceSpans::Uniform { .. }),
        };
        let grown = check_split::<Self>(split, &counts, 0)?;
        if split.needs_triangles() {
            self.check_triangles()?;
        }
        child.positions.resize(grown.vertices, Point::ZERO);
        child.corners.resize(grown.corners, VertexId::new(0));
        child.fans.resize(grown.vertices, Fan::default());
        child.pool.resize(grown.corners, FaceId::new(0));
        let degree = grown.corners.checked_div(grown.faces);
        child.spans = FaceSpans::Uniform {
            degree: row(degree.unwrap_or(3)),
            faces: row(grown.faces),
        };
        match (split, &self.spans) {
            (Split::Quads, FaceSpans::Uniform { degree: 3, .. }) => {
                self.splitting::<3, true>(numbers).fill(child);
            }
            (Split::Quads, FaceSpans::Uniform { degree: 4, .. }) => {
                self.splitting::<4, true>(numbers).fill(child);
            }
            (Split::Quads, _) => self.splitting::<0, true>(numbers).fill(child),
            _ => self.splitting::<3, false>(numbers).fill(child),
        }
        Ok(())
    }

    /// Takes O(1) time, or O(log faces) for faces with different degrees.
    fn parent(&self, _: &EdgeNumbers, split: Split, child: FaceId) -> FaceId {
        match split {
            Split::Quads => self.spans.face_of(child.index()),
            _ => FaceId::new(row(child.index() / 4)),
        }
    }

    fn positions_mut(&mut self) -> &mut [Point] {
        self.positions.rows_mut()
    }

    fn position_rows(&self) -> &[Point] {
        self.positions.rows()
    }
}

impl FaceVertexMesh {
    fn check_triangles(&self) -> Result<(), RefineError> {
        if let FaceSpans::Uniform { degree: 3, .. } = self.spans {
            return Ok(());
        }
        let mut degrees = self
            .faces()
            .map(|face| (face, self.spans.range(face).len()));
        match degrees.find(|&(_, degree)| degree != 3) {
            Some((face, degree)) => Err(RefineError::NotATriangle { face, degree }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{PolygonMesh, Representation};

    use super::*;

    /// Splits two triangles with a common side from v0 to v1.
    fn split(split: Split) -> FaceVertexMesh {
        let polygons = PolygonMesh::new([Point::ZERO; 4], [[0, 1, 2], [0, 3, 1]]).expect("valid");
        let mesh = FaceVertexMesh::from_polygons(&polygons).expect("holds every mesh");
        let mut numbers = EdgeNumbers::default();
        mesh.number_edges(&mut numbers);
        let mut child = FaceVertexMesh::empty();
        let done = mesh.split_into(split, &numbers, &mut child);
        assert_eq!(done, Ok(()));
        assert_eq!(child.validate(), Ok(()));
        child
    }

    fn faces(mesh: &FaceVertexMesh) -> Vec<Vec<usize>> {
        let face = |f| mesh.face(f).iter().map(|v| v.index()).collect();
        mesh.faces().map(face).collect()
    }

    fn fans(mesh: &FaceVertexMesh) -> Vec<Vec<usize>> {
        let fan = |v| mesh.fan(v).iter().map(|f| f.index()).collect();
        mesh.vertices().map(fan).collect()
    }

    #[test]
    fn a_split_into_quads_gives_the_expected_tables() {
        let child = split(Split::Quads);
        // Face points 4 and 5; the middles of edges 01, 02, 03, 12 and 13 are vertices 6 to 10.
        let parts = [
            [0, 6, 4, 7],
            [1, 9, 4, 6],
            [2, 7, 4, 9],
            [0, 8, 5, 6],
            [3, 10, 5, 8],
            [1, 6, 5, 10],
        ];
        assert_eq!(faces(&child), parts);
        let around: [&[usize]; 11] = [
            &[0, 3],
            &[1, 5],
            &[2],
            &[4],
            &[0, 1, 2],
            &[3, 4, 5],
            &[0, 1, 3, 5],
            &[0, 2],
            &[3, 4],
            &[1, 2],
            &[4, 5],
        ];
        assert_eq!(fans(&child), around);
    }

    #[test]
    fn a_split_into_triangles_gives_the_expected_tables() {
        let child = split(Split::Triangles);
        // The middles of edges 01, 02, 03, 12 and 13 are vertices 4 to 8.
        let parts = [
            [0, 4, 5],
            [1, 7, 4],
            [2, 5, 7],
            [4, 7, 5],
            [0, 6, 4],
            [3, 8, 6],
            [1, 4, 8],
            [6, 8, 4],
        ];
        assert_eq!(faces(&child), parts);
        let around: [&[usize]; 9] = [
            &[0, 4],
            &[1, 6],
            &[2],
            &[5],
            &[0, 1, 3, 4, 6, 7],
            &[0, 2, 3],
            &[4, 5, 7],
            &[1, 2, 3],
            &[5, 6, 7],
        ];
        assert_eq!(fans(&child), around);
    }

    #[test]
    fn a_fan_longer_than_the_buffer_is_split_correctly() {
        let triangles = (0..1500).map(|i| [0, 1, i + 2]);
        let polygons = PolygonMesh::new(vec![Point::ZERO; 1502], triangles).expect("valid");
        let mesh = FaceVertexMesh::from_polygons(&polygons).expect("holds every mesh");
        let mut numbers = EdgeNumbers::default();
        mesh.number_edges(&mut numbers);
        for &split in FaceVertexMesh::SPLITS {
            let mut child = FaceVertexMesh::empty();
            assert_eq!(mesh.split_into(split, &numbers, &mut child), Ok(()));
            assert_eq!(child.validate(), Ok(()), "{split}");
        }
    }
}

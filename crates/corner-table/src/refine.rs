//! Splits of every triangle in the structure's own tables; every new row has a closed formula.

mod midpoints;
mod sqrt3;
#[cfg(test)]
mod tests;

use sixfold_core::{
    CHUNK_ROWS, Counts, FaceId, MeshQuery, NoHoles, Point, Ranks, Refine, RefineError, RowId, Slot,
    Split, Table, VertexId, all_rows, check_split, row,
};

use self::sqrt3::Sqrt3;
use crate::CornerTable;
use crate::mesh::{CornerId, EdgeCorner, edge_between, named_edge, names_edge};

/// Number of corners in one chunk of whole triangles.
const CHUNK_CORNERS: usize = 3 * CHUNK_ROWS;

/// A number for each edge, from 0.
///
/// The corners that are edge handles are numbered in ascending order.
#[derive(Clone, Debug, Default)]
pub struct EdgeNumbers {
    /// The corners that name an edge.
    names: Ranks,
    /// The corners that have an opposite.
    inner: Ranks,
}

impl EdgeNumbers {
    /// Returns the number of the edge that `c` faces. `across` is opposite to `c`.
    #[inline(always)]
    fn number(&self, c: CornerId, across: Slot<CornerId>) -> u32 {
        self.names.rank(edge_between(c, across).index()) as u32
    }

    /// Returns the number of a boundary edge among the boundary edges. `c` faces the edge.
    #[inline]
    fn boundary_number(&self, c: CornerId) -> u32 {
        c.row() - self.inner.rank(c.index()) as u32
    }
}

impl Refine for CornerTable {
    const SPLITS: &'static [Split] = &[Split::Triangles, Split::Sqrt3 { trisect: true }];

    type EdgeNumbers = EdgeNumbers;

    fn empty() -> Self {
        Self {
            positions: Table::new("positions", "vertex", Vec::new()),
            corner: Table::new("corner", "vertex", Vec::new()),
            vertex: Table::new("vertex", "corner", Vec::new()),
            opposite: Table::new("opposite", "corner", Vec::new()),
            vertex_holes: NoHoles,
            face_holes: NoHoles,
        }
    }

    /// O(corners).
    fn number_edges(&self, numbers: &mut EdgeNumbers) {
        let opposite = self.opposite_corners();
        numbers.names.fill_by_row(opposite, |c, &across| {
            [names_edge(CornerId::new(c as u32), across)]
        });
        let inner = |across: &Slot<CornerId>| [*across != Slot::NONE];
        numbers.inner.fill(opposite, inner);
    }

    fn edge_chunks(&self, numbers: &EdgeNumbers) -> Vec<usize> {
        let starts = (0..self.corner_count()).step_by(CHUNK_CORNERS);
        let starts = starts.map(|corner| numbers.names.rank(corner));
        starts.chain([numbers.names.members()]).collect()
    }

    #[inline]
    fn edges_of_chunk(&self, _: &EdgeNumbers, chunk: usize) -> impl Iterator<Item = EdgeCorner> {
        let end = self.corner_count().min((chunk + 1) * CHUNK_CORNERS);
        let corners = (row(chunk * CHUNK_CORNERS)..row(end)).map(CornerId::new);
        corners.filter_map(|c| named_edge(c, *self.opposite.read(c.index())))
    }

    /// Returns the rank of the corner that names the edge; O(1).
    #[inline]
    fn edge_number(&self, numbers: &EdgeNumbers, e: EdgeCorner) -> usize {
        numbers.names.rank(e.index())
    }

    /// O(corners + vertices).
    fn split_into(
        &self,
        split: Split,
        numbers: &EdgeNumbers,
        child: &mut Self,
    ) -> Result<(), RefineError> {
        let corners = self.corner_count();
        assert_eq!(
            numbers.names.items(),
            corners,
            "the edge numbers belong to another mesh"
        );
        let counts = Counts {
            vertices: self.positions.len(),
            edges: numbers.names.members(),
            faces: self.face_count(),
            corners: self.corner_count(),
            uniform: true,
        };
        let grown = check_split::<Self>(split, &counts, numbers.inner.missing())?;
        self.check_double_edges()?;
        child.positions.resize(grown.vertices, Point::ZERO);
        child.corner.resize(grown.vertices, Slot::NONE);
        child.vertex.resize(grown.corners, VertexId::new(0));
        child.opposite.resize(grown.corners, Slot::NONE);
        match split {
            Split::Sqrt3 { trisect } => Sqrt3 {
                mesh: self,
                numbers,
                trisect,
            }
            .fill(child),
            _ => self.split_in_four(numbers, child),
        }
        Ok(())
    }

    /// O(1). For the triangles of √3 at boundary edges, O(log corners).
    fn parent(&self, numbers: &EdgeNumbers, split: Split, child: FaceId) -> FaceId {
        match (split, child.index().checked_sub(self.corner_count())) {
            (Split::Sqrt3 { .. }, Some(cut)) => {
                let c = numbers.inner.select_missing(cut / 2);
                FaceId::new(row(c / 3))
            }
            (Split::Sqrt3 { .. }, None) => FaceId::new(child.row() / 3),
            _ => FaceId::new(child.row() / 4),
        }
    }

    fn positions_mut(&mut self) -> &mut [Point] {
        self.positions.rows_mut()
    }

    fn position_rows(&self) -> &[Point] {
        self.positions.rows()
    }
}

impl CornerTable {
    /// Returns an error if two triangles have the same edges. Triangles that share two edges also
    /// share the third edge. So the check looks across only two sides of each triangle.
    fn check_double_edges(&self) -> Result<(), RefineError> {
        let across = |o: Slot<CornerId>| o.get().map(CornerId::triangle);
        let has_double_edge =
            |&[a, b, _]: &[Slot<CornerId>; 3]| a != Slot::NONE && across(a) == across(b);
        let opposites = self.opposite_corners().as_chunks().0;
        if all_rows(opposites, |triangle| !has_double_edge(triangle)) {
            return Ok(());
        }
        let mut doubled = self
            .faces()
            .zip(opposites)
            .filter(|(_, t)| has_double_edge(t));
        match doubled.find_map(|(first, t)| Some((first, across(t[0])?))) {
            Some((first, second)) => Err(RefineError::DoubleEdge { first, second }),
            None => Ok(()),
        }
    }
}

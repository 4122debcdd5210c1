//! The new rows of elements after the rows of deleted elements are removed.

use crate::Point;
use crate::handles::pair::Pair;
use crate::handles::row_id::{RowId, VertexId};
use crate::polygons::face_list::FaceList;
use crate::polygons::polygon_mesh::PolygonMesh;
use crate::tables::holes::HoleSet;
use crate::tables::probe::Probe;
use crate::traits::query::MeshQuery;

/// The new row of each element after the holes (rows of deleted elements) of a table are removed.
/// The new row of an element is the number of earlier rows that are not holes.
///
/// ```text
/// old row   0 1 2 3 4 5 6 7
/// hole          •     • •
/// new row   0 1   2 3     4
/// ```
#[derive(Clone, Debug)]
pub struct NewRows {
    /// By old row: the new row. Empty if there are no holes.
    rows: Vec<u32>,
}

impl NewRows {
    /// Computes the new row of each element whose row is below `end`; O(end), or O(1) if there are
    /// no holes.
    pub fn from_holes<P: Probe>(holes: &impl HoleSet<P>, end: usize) -> Self {
        let rows = if holes.is_empty() {
            Vec::new()
        } else {
            holes.new_rows(end)
        };
        Self { rows }
    }

    /// Returns true if there are no holes, so that every element keeps its row.
    #[inline]
    pub fn is_unchanged(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns the new handle of `old`, which must not be a hole.
    #[inline]
    pub fn new_handle<H: RowId>(&self, old: H) -> H {
        // If there are no holes, the list is empty, and `get` returns `None`.
        let new = self.rows.get(old.row() as usize);
        new.map_or(old, |&new| H::from_row(new))
    }

    /// Calls `report` with the old and the new handle of each element whose row changes.
    pub fn for_each_renamed<H: RowId>(
        &self,
        elements: impl Iterator<Item = H>,
        report: impl FnMut(H, H),
    ) {
        if !self.is_unchanged() {
            for_each_changed(elements, |old| self.new_handle(old), report);
        }
    }

    /// Does the same as [`for_each_renamed`](Self::for_each_renamed), for edges whose handles are
    /// pairs of vertices.
    pub fn for_each_renamed_pair<H: RowId>(
        &self,
        elements: impl Iterator<Item = Pair<H>>,
        report: impl FnMut(Pair<H>, Pair<H>),
    ) {
        if !self.is_unchanged() {
            let new_pair = |old: Pair<H>| {
                let [a, b] = old.ends().map(|end| self.new_handle(end));
                Pair::new(a, b)
            };
            for_each_changed(elements, new_pair, report);
        }
    }

    /// Returns the polygons of `mesh`, with vertices numbered by their new rows. `positions` has
    /// one position for each old row. `corners` is an estimate of the number of corners, which is
    /// used to reserve memory.
    ///
    /// # Panics
    ///
    /// Panics if a face of `mesh` is not a valid polygon. In a mesh that satisfies its invariants,
    /// all faces are valid polygons.
    pub fn polygons<M: MeshQuery<Vertex = VertexId>>(
        &self,
        mesh: &M,
        positions: &[Point],
        corners: usize,
    ) -> PolygonMesh {
        const EXPECTED: &str = "the faces of a structure are valid polygons";
        let mut faces = FaceList::with_capacity(corners);
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f);
            let pushed = if self.is_unchanged() {
                faces.push(corners)
            } else {
                faces.push(corners.map(|v| self.new_handle(v)))
            };
            pushed.expect(EXPECTED);
        }
        let positions = if self.is_unchanged() {
            positions.to_vec()
        } else {
            mesh.vertices().map(|v| positions[v.index()]).collect()
        };
        PolygonMesh::from_faces(positions, faces).expect(EXPECTED)
    }
}

fn for_each_changed<H: PartialEq + Copy>(
    elements: impl Iterator<Item = H>,
    new_handle: impl Fn(H) -> H,
    mut report: impl FnMut(H, H),
) {
    for old in elements {
        let new = new_handle(old);
        if new != old {
            report(old, new);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handles::row_id::FaceId;
    use crate::tables::holes::Holes;

    #[test]
    fn rows_after_holes_get_lower_numbers() {
        let mut holes = Holes::new("holes");
        let unchanged = NewRows::from_holes(&holes, 5);
        assert!(unchanged.is_unchanged());
        assert_eq!(unchanged.new_handle(FaceId::new(4)), FaceId::new(4));
        [1, 3].into_iter().for_each(|row| holes.insert(row));
        let rows = NewRows::from_holes(&holes, 5);
        let mut renamed = Vec::new();
        rows.for_each_renamed(holes.handles(5), |old: FaceId, new| {
            renamed.push([old, new].map(|f| f.row()));
        });
        assert_eq!(renamed, [[2, 1], [4, 2]]);
        let pair = |a, b| Pair::new(FaceId::new(a), FaceId::new(b));
        let mut renamed = Vec::new();
        let pairs = [pair(0, 2), pair(4, 2)].into_iter();
        rows.for_each_renamed_pair(pairs, |_, new| renamed.push(new));
        assert_eq!(renamed, [pair(0, 1), pair(1, 2)]);
    }
}

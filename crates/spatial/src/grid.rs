//! The uniform grid.

mod cells;
mod near;
mod ray;

use glam::DVec3;

use crate::bounds::Bounds;
use crate::error::SpatialError;
use crate::index::{SpatialIndex, can_search};
use crate::item::{Item, check_items};
use crate::ray::Ray;
use cells::{CellRange, Cells};
use sixfold_core::row;

/// The cells of a grid for each item, at most.
const CELLS_PER_ITEM: usize = 2;

/// The entries of all cells for each item, at most. A grid with more becomes coarser.
const ENTRIES_PER_ITEM: usize = 8;

/// A grid of equal cubes over the box of all items (Bentley & Friedman 1979).
///
/// ```text
///   ┌──┬──┬──┬──┐        Each cell lists the items whose boxes touch it. A search around the query ×
///   │2 │2 │2 │2 │        visits its cell, then the ring of cells around, and so on, until
///   ├──┼──┼──┼──┤        a ring is farther than the best item so far.
///   │1 │1 │1 │2 │
///   ├──┼──┼──┼──┤        A ray visits the cells that it passes, layer by layer.
///   │1 │ ×│1 │2 │
///   └──┴──┴──┴──┘
/// ```
///
/// An item in several cells is visited only in the first of them. There are at most 2 cells per
/// item, and at most 8 entries per item in all cells; if large triangles would need more, the cells
/// are doubled until they fit.
///
/// # Memory
///
/// At most 8 bytes per item for cells and 32 for entries, and the items; about 24 bytes per vertex
/// and 55 per triangle.
///
/// # Complexity
///
/// O(n) to build. A query takes O(1) expected if the items fill their box evenly. The vertices of a
/// surface do not: most cells are empty, and the others hold n^⅓ items. In the worst case (one item
/// far away from all others, or a query in a large empty part) a query takes O(n).
#[derive(Clone, Debug)]
pub struct UniformGrid<I> {
    items: Vec<I>,
    cells: Cells,
    /// Where the entries of each cell start, followed by the end of the last cell.
    starts: Vec<u32>,
    /// The slots of the items that touch each cell.
    entries: Vec<u32>,
}

impl<I: Item> UniformGrid<I> {
    /// Returns the number of cells along each axis.
    pub fn cell_counts(&self) -> [usize; 3] {
        self.cells.counts
    }

    /// Returns the slots of the items that touch a cell.
    #[inline]
    fn entries_of(&self, cell: usize) -> &[u32] {
        &self.entries[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Returns the cells that item `slot` touches.
    #[inline]
    fn range_of(&self, slot: usize) -> CellRange {
        self.cells.range(&self.items[slot].bounds())
    }
}

impl<I: Item> SpatialIndex<I> for UniformGrid<I> {
    const NAME: &'static str = "uniform grid";

    fn build(items: Vec<I>) -> Result<Self, SpatialError> {
        check_items(&items)?;
        let bounds = items
            .iter()
            .fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds()));
        let most_entries = items
            .len()
            .saturating_mul(ENTRIES_PER_ITEM)
            .min(u32::MAX as usize);
        let mut most_cells = items.len().saturating_mul(CELLS_PER_ITEM).min(most_entries);
        let cells = loop {
            let cells = Cells::new(&bounds, most_cells);
            let entries = items.iter().map(|item| cells.range(&item.bounds()).len());
            // One cell always fits: it has as many entries as there are items.
            if cells.len() == 1 || fits(entries, most_entries) {
                break cells;
            }
            most_cells /= 8;
        };
        let (starts, entries) = entries_by_cell(&items, &cells);
        Ok(Self {
            items,
            cells,
            starts,
            entries,
        })
    }

    #[inline]
    fn items(&self) -> &[I] {
        &self.items
    }

    #[inline]
    fn visit_near(&self, query: DVec3, limit: f64, visit: impl FnMut(usize) -> f64) {
        if can_search(query) && !self.items.is_empty() {
            self.visit_rings(query, limit, visit);
        }
    }

    #[inline]
    fn visit_along(&self, ray: &Ray, limit: f64, visit: impl FnMut(usize) -> f64) {
        if !self.items.is_empty() {
            self.visit_layers(ray, limit, visit);
        }
    }

    fn memory_bytes(&self) -> usize {
        size_of_val(self.items.as_slice())
            + size_of_val(self.starts.as_slice())
            + size_of_val(self.entries.as_slice())
    }
}

/// Returns whether the sum of `counts` is at most `most`.
fn fits(mut counts: impl Iterator<Item = usize>, most: usize) -> bool {
    let sum = counts.try_fold(0_usize, |sum, count| {
        sum.checked_add(count).filter(|&sum| sum <= most)
    });
    sum.is_some()
}

/// Lists the items of each cell by a counting sort.
fn entries_by_cell<I: Item>(items: &[I], cells: &Cells) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; cells.len() + 1];
    for item in items {
        cells
            .range(&item.bounds())
            .for_each(|cell| starts[cells.index(cell) + 1] += 1);
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut entries = vec![0; sum as usize];
    let mut next = starts.clone();
    for (slot, item) in items.iter().enumerate() {
        cells.range(&item.bounds()).for_each(|cell| {
            let at = &mut next[cells.index(cell)];
            entries[*at as usize] = row(slot);
            *at += 1;
        });
    }
    (starts, entries)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::item::{FaceTriangle, VertexPoint};

    #[test]
    fn large_triangles_make_the_cells_larger() {
        let corner = |x: f32, y: f32| Vec3::new(x, y, x + y);
        let triangles = |size: f32| {
            (0..1000_u32).map(move |face| {
                let (x, y) = ((face % 32) as f32, (face / 32) as f32);
                let corners = [corner(x, y), corner(x + size, y), corner(x, y + size)];
                FaceTriangle { face, corners }
            })
        };
        for size in [0.5, 20.0, 1000.0] {
            let grid = UniformGrid::build(triangles(size).collect()).expect("finite");
            assert!(
                grid.entries.len() <= 8 * 1000,
                "{size}: {}",
                grid.entries.len()
            );
            assert!(grid.starts.len() <= 2 * 1000 + 1, "{size}");
        }
        let small = UniformGrid::build(triangles(0.5).collect()).expect("finite");
        assert!(small.cells.len() > 200, "{:?}", small.cell_counts());
    }

    #[test]
    fn a_flat_set_has_one_layer_of_cells() {
        let points = (0..400_u32).map(|vertex| VertexPoint {
            vertex,
            position: Vec3::new((vertex % 20) as f32, 7.0, (vertex / 20) as f32),
        });
        let grid = UniformGrid::build(points.collect()).expect("finite");
        let [x, y, z] = grid.cell_counts();
        assert_eq!(y, 1);
        assert!((20..=40).contains(&x) && (20..=40).contains(&z), "{x} {z}");
    }
}

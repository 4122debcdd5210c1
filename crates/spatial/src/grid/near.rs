//! The search around a point, ring by ring.

use glam::DVec3;

use super::UniformGrid;
use super::cells::Cells;
use crate::item::Item;

impl<I: Item> UniformGrid<I> {
    /// Visits the items of the cells around `query`. Ring `r` has the cells at `r` steps, counted
    /// along the axis with the most.
    pub(super) fn visit_rings(
        &self,
        query: DVec3,
        mut limit: f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let centre = [0, 1, 2].map(|axis| self.cells.along(axis, query[axis]));
        let widest = (0..3).fold(0, |widest, axis| {
            widest
                .max(centre[axis])
                .max(self.cells.counts[axis] - 1 - centre[axis])
        });
        for ring in 0..=widest {
            if ring_distance(&self.cells, query, centre, ring) > limit {
                return;
            }
            for_each_of_ring(&self.cells, centre, ring, |cell| {
                if cell_distance(&self.cells, query, cell) > limit {
                    return;
                }
                for &slot in self.entries_of(self.cells.index(cell)) {
                    let slot = slot as usize;
                    // Of all cells of an item, the nearest to the centre is visited first.
                    if self.range_of(slot).nearest(centre) == cell {
                        limit = visit(slot);
                    }
                }
            });
        }
    }
}

/// Calls `visit` with the cells of the grid on the surface of the cube of cells around `centre`.
fn for_each_of_ring(
    cells: &Cells,
    centre: [usize; 3],
    ring: usize,
    mut visit: impl FnMut([usize; 3]),
) {
    let low = centre.map(|at| at.saturating_sub(ring));
    let high = [0, 1, 2].map(|axis| (centre[axis] + ring).min(cells.counts[axis] - 1));
    for z in low[2]..=high[2] {
        for y in low[1]..=high[1] {
            if z.abs_diff(centre[2]) == ring || y.abs_diff(centre[1]) == ring {
                (low[0]..=high[0]).for_each(|x| visit([x, y, z]));
                continue;
            }
            // Inside the cube only the two ends of a row are in the ring.
            if centre[0] >= ring {
                visit([centre[0] - ring, y, z]);
            }
            if ring > 0 && centre[0] + ring < cells.counts[0] {
                visit([centre[0] + ring, y, z]);
            }
        }
    }
}

/// Returns a lower bound of the squared distance from `query` to all cells from `ring` on.
fn ring_distance(cells: &Cells, query: DVec3, centre: [usize; 3], ring: usize) -> f64 {
    if ring == 0 {
        return 0.0;
    }
    let mut nearest = f64::INFINITY;
    for axis in 0..3 {
        if centre[axis] >= ring {
            let plane = cells.plane(axis, centre[axis] - ring + 1);
            nearest = nearest.min(query[axis] - plane);
        }
        if centre[axis] + ring < cells.counts[axis] {
            let plane = cells.plane(axis, centre[axis] + ring);
            nearest = nearest.min(plane - query[axis]);
        }
    }
    squared_less_margin(cells, nearest)
}

/// Returns a lower bound of the squared distance from `query` to the items of a cell.
fn cell_distance(cells: &Cells, query: DVec3, cell: [usize; 3]) -> f64 {
    (0..3).fold(0.0, |sum, axis| {
        let low = cells.plane(axis, cell[axis]) - query[axis];
        let high = query[axis] - cells.plane(axis, cell[axis] + 1);
        sum + squared_less_margin(cells, low.max(high))
    })
}

/// Returns the square of `distance`, which is reduced first by more than all rounding errors.
fn squared_less_margin(cells: &Cells, distance: f64) -> f64 {
    let distance = (distance - 2.0 * cells.margin()) * (1.0 - 1e-12);
    let distance = distance.max(0.0);
    distance * distance
}

//! The search along a ray, layer by layer.

use glam::DVec3;

use super::UniformGrid;
use super::cells::{CellRange, Cells};
use crate::item::Item;
use crate::ray::Ray;

/// Relative width by which the part of a ray in a layer is extended. It is more than the width by
/// which the intervals of boxes are extended, so that a box that the ray hits is never missed.
const PADDING: f64 = 4e-6;

impl<I: Item> UniformGrid<I> {
    /// Visits the items of the cells that `ray` passes.
    ///
    /// ```text
    ///   ┌──┬──┬──┬──┐      The ray passes the layers across its main axis one after the other. In
    ///   │  │  │░░│░░│      each layer it stays inside a small rectangle of cells, at most two
    ///   ├──┼──┼──┼──┤      by two but for the margin.
    ///   │░░│░░│░░│  │
    ///   └──┴──┴──┴──┘      (Amanatides & Woo 1987 step from cell to cell, and a step that rounds to
    ///                      the wrong side would lose a hit.)
    /// ```
    pub(super) fn visit_layers(
        &self,
        ray: &Ray,
        mut limit: f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let path = Path::new(&self.cells, ray);
        let Some((first, last)) = path.layers(&self.cells, limit) else {
            return;
        };
        let layers = first.abs_diff(last) + 1;
        let mut before: Option<CellRange> = None;
        for step in 0..layers {
            let layer = if path.descends {
                first - step
            } else {
                first + step
            };
            let (enters, rectangle) = path.rectangle(&self.cells, layer);
            if enters > limit {
                return;
            }
            let Some(rectangle) = rectangle else {
                before = None; // beside the grid
                continue;
            };
            rectangle.for_each(|cell| {
                for &slot in self.entries_of(self.cells.index(cell)) {
                    let range = self.range_of(slot as usize);
                    let is_first = before.is_none_or(|before| !meet(&range, &before));
                    if is_first && common_corner(&range, &rectangle) == cell {
                        limit = visit(slot as usize);
                    }
                }
            });
            before = Some(rectangle);
        }
    }
}

/// A ray through the cells of a grid.
struct Path {
    origin: DVec3,
    direction: DVec3,
    main: usize,
    descends: bool,
    /// A length by which the ray may pass an item that it hits: the margin of the cells, and the
    /// rounding of the origin to single precision.
    reach: f64,
}

impl Path {
    fn new(cells: &Cells, ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin(), ray.scaled_direction());
        let main = ray.main_axis();
        Self {
            origin,
            direction,
            main,
            descends: direction[main] < 0.0,
            reach: 2.0 * cells.margin() + PADDING * origin.abs().max_element(),
        }
    }

    /// Returns the first and the last layer that the ray passes up to the parameter `limit`.
    fn layers(&self, cells: &Cells, limit: f64) -> Option<(usize, usize)> {
        let planes = [0, cells.counts[self.main]].map(|cell| cells.plane(self.main, cell));
        let (enters, leaves) = self.between(planes);
        let end = leaves.min(limit * (1.0 + PADDING) + self.reach);
        let layer = |t: f64| {
            let at = self.origin[self.main] + t * self.direction[self.main];
            cells.along(self.main, at)
        };
        (enters <= end).then(|| (layer(enters), layer(end)))
    }

    /// Returns the parameters between which the ray may hit items between two planes across the main
    /// axis.
    fn between(&self, planes: [f64; 2]) -> (f64, f64) {
        let distances = planes.map(|plane| plane - self.origin[self.main]);
        let [a, b] = distances.map(|distance| distance * self.direction[self.main]);
        let (first, last) = (a.min(b) - self.reach, a.max(b) + self.reach);
        // Not below 0, so that the parameters of later layers are larger.
        (first.max(0.0) * (1.0 - PADDING), last * (1.0 + PADDING))
    }

    /// Returns the parameter at which the ray enters a layer, and the cells of the layer in which it
    /// may hit items, unless it passes beside the grid.
    fn rectangle(&self, cells: &Cells, layer: usize) -> (f64, Option<CellRange>) {
        let planes = [layer, layer + 1].map(|cell| cells.plane(self.main, cell));
        let (enters, leaves) = self.between(planes);
        let mut range = CellRange {
            low: [layer; 3],
            high: [layer; 3],
        };
        for axis in (0..3).filter(|&axis| axis != self.main) {
            let at = |t: f64| self.origin[axis] + t.max(0.0) * self.direction[axis];
            let first = at(enters).min(at(leaves)) - self.reach;
            let last = at(enters).max(at(leaves)) + self.reach;
            if last < cells.low[axis] || first > cells.plane(axis, cells.counts[axis]) {
                return (enters, None);
            }
            range.low[axis] = cells.along(axis, first);
            range.high[axis] = cells.along(axis, last);
        }
        (enters, Some(range))
    }
}

/// Returns whether two ranges have a cell in common.
fn meet(range: &CellRange, other: &CellRange) -> bool {
    (0..3).all(|axis| range.low[axis] <= other.high[axis] && other.low[axis] <= range.high[axis])
}

/// Returns the lowest cell that two ranges have in common.
fn common_corner(range: &CellRange, other: &CellRange) -> [usize; 3] {
    [0, 1, 2].map(|axis| range.low[axis].max(other.low[axis]))
}

//! A hashed grid.

use glam::DVec3;
use rustc_hash::FxHashMap;
use sixfold_core::row;

use super::Nearby;

/// The cell of a point: its coordinates divided by the length of a cell and rounded down, as bits.
///
/// Doubles, not integers: coordinates up to 3.4e38 may be divided by a length of 1e-38. Where the
/// numbers of cells are too large to be exact, single-precision coordinates within the radius of
/// each other are equal, and so are their cells.
type Cell = [u64; 3];

/// Points by cell. A cell is a little longer than the radius of the search.
pub(super) struct Grid<'a> {
    points: &'a [DVec3],
    length: f64,
    /// By cell: the last point there.
    last: FxHashMap<Cell, u32>,
    /// By point: the point before it in the same cell; itself if it is the first.
    before: Vec<u32>,
}

impl<'a> Grid<'a> {
    /// Sorts the points into cells for searches with this radius; O(n) expected. `radius` is above
    /// zero.
    pub(super) fn new(points: &'a [DVec3], radius: f64) -> Self {
        // The margin covers the rounding of the quotient. Different single-precision coordinates are
        // at least 1.4e-45 apart, so shorter cells are not needed; their numbers could overflow.
        let length = (radius * 1.001).max(1e-45);
        let mut grid = Self {
            points,
            length,
            last: FxHashMap::default(),
            before: (0..row(points.len())).collect(),
        };
        for (i, point) in (0..).zip(points) {
            // Points that are not finite are within the radius of no other point.
            if point.is_finite() {
                let cell = grid.cell_numbers(*point).map(f64::to_bits);
                if let Some(before) = grid.last.insert(cell, i) {
                    grid.before[i as usize] = before;
                }
            }
        }
        grid
    }

    fn cell_numbers(&self, point: DVec3) -> [f64; 3] {
        // Adding 0 changes −0 to 0.
        ((point / self.length).floor() + 0.0).to_array()
    }

    fn for_each_in_cell(&self, cell: Cell, mut visit: impl FnMut(u32)) {
        let Some(&(mut at)) = self.last.get(&cell) else {
            return;
        };
        loop {
            visit(at);
            let before = self.before[at as usize];
            if before == at {
                return;
            }
            at = before;
        }
    }
}

impl Nearby for Grid<'_> {
    fn for_each_candidate(&self, at: u32, mut visit: impl FnMut(u32)) {
        let point = self.points[at as usize];
        if !point.is_finite() {
            return;
        }
        let numbers = self.cell_numbers(point).map(near_numbers);
        for x in numbers[0].into_iter().flatten() {
            for y in numbers[1].into_iter().flatten() {
                for z in numbers[2].into_iter().flatten() {
                    self.for_each_in_cell([x, y, z].map(f64::to_bits), &mut visit);
                }
            }
        }
    }
}

/// Returns a number of cells and its two neighbours, if they differ from it.
fn near_numbers(number: f64) -> [Option<f64>; 3] {
    let other = |step: f64| Some(number + step + 0.0).filter(|&near| near != number);
    [other(-1.0), Some(number), other(1.0)]
}

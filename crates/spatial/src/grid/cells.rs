//! The cells of a grid, by coordinates and by number.

use glam::DVec3;

use crate::bounds::Bounds;

/// Share of a cell by which the cells of an item reach beyond its box, so that rounding never puts
/// an item into a neighbouring cell.
const MARGIN: f64 = 1e-6;

/// Equal cubes that cover a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    pub(super) low: DVec3,
    /// The length of a side. At least 1 if the box has no extent.
    pub(super) size: f64,
    /// 1 / `size`.
    inverse: f64,
    pub(super) counts: [usize; 3],
}

/// The cells from `low` to `high` along each axis, both included.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellRange {
    pub(super) low: [usize; 3],
    pub(super) high: [usize; 3],
}

impl Cells {
    /// Covers `bounds` with at most `most` cells, or one.
    pub(super) fn new(bounds: &Bounds, most: usize) -> Self {
        let extent = bounds.extent().max(DVec3::ZERO);
        let longest = extent.max_element();
        if longest <= 0.0 || most <= 1 {
            let size = if longest > 0.0 { 2.0 * longest } else { 1.0 };
            return Self::with_size(bounds, size);
        }
        let product = |counts: [usize; 3]| {
            counts
                .iter()
                .try_fold(1_usize, |all, &count| all.checked_mul(count))
        };
        // The size for which the sides of the box would give `most` cells, found by halving.
        let (mut small, mut large) = (longest / most as f64, 2.0 * longest);
        for _ in 0..40 {
            let size = 0.5 * (small + large);
            match product(counts(extent, size)) {
                Some(cells) if cells <= most => large = size,
                _ => small = size,
            }
        }
        Self::with_size(bounds, large)
    }

    fn with_size(bounds: &Bounds, size: f64) -> Self {
        Self {
            low: bounds.low.as_dvec3(),
            size,
            inverse: 1.0 / size,
            counts: counts(bounds.extent().max(DVec3::ZERO), size),
        }
    }

    /// Returns the number of cells.
    pub(super) fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Returns the number of a cell.
    #[inline]
    pub(super) fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// Returns the cell with coordinate `at` along `axis`, or the nearest one.
    #[inline]
    pub(super) fn along(&self, axis: usize, at: f64) -> usize {
        // Negative values and NaN become 0.
        (((at - self.low[axis]) * self.inverse) as usize).min(self.counts[axis] - 1)
    }

    /// Returns the plane before cell `cell` along `axis`.
    #[inline]
    pub(super) fn plane(&self, axis: usize, cell: usize) -> f64 {
        self.low[axis] + cell as f64 * self.size
    }

    /// Returns a length by which an item may lie beside its cells.
    #[inline]
    pub(super) fn margin(&self) -> f64 {
        MARGIN * self.size
    }

    /// Returns the cells that `bounds` touch.
    #[inline]
    pub(super) fn range(&self, bounds: &Bounds) -> CellRange {
        let axes = [0, 1, 2];
        CellRange {
            low: axes.map(|axis| self.along(axis, f64::from(bounds.low[axis]) - self.margin())),
            high: axes.map(|axis| self.along(axis, f64::from(bounds.high[axis]) + self.margin())),
        }
    }
}

/// Returns the number of cells of `size` along each axis of a box.
fn counts(extent: DVec3, size: f64) -> [usize; 3] {
    extent.to_array().map(|length| (length / size) as usize + 1)
}

impl CellRange {
    /// Returns the number of cells, or `usize::MAX` if it is larger.
    pub(super) fn len(&self) -> usize {
        (0..3).fold(1_usize, |cells, axis| {
            cells.saturating_mul(self.high[axis] - self.low[axis] + 1)
        })
    }

    /// Calls `visit` with each cell.
    #[inline]
    pub(super) fn for_each(&self, mut visit: impl FnMut([usize; 3])) {
        for z in self.low[2]..=self.high[2] {
            for y in self.low[1]..=self.high[1] {
                for x in self.low[0]..=self.high[0] {
                    visit([x, y, z]);
                }
            }
        }
    }

    /// Returns the cell of the range that is nearest to `cell`.
    #[inline]
    pub(super) fn nearest(&self, cell: [usize; 3]) -> [usize; 3] {
        [0, 1, 2].map(|axis| cell[axis].clamp(self.low[axis], self.high[axis]))
    }
}

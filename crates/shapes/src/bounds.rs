//! Bounding boxes of solids, and lattices of cubes that cover a box.

use crate::error::ShapeError;
use crate::marching::{Lattice, MARGIN};

/// Maximum number of cubes of a lattice.
const MAX_CUBES: f64 = (1_u64 << 29) as f64;

/// Maximum number of lattice points in one layer.
const MAX_LAYER: f64 = (1_u64 << 22) as f64;

/// A box with sides along the axes, from its low corner to its high corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    /// Builds the box from `centre` − `half` to `centre` + `half`, or `None` if a side is negative.
    pub(crate) fn from_centre(centre: [f64; 3], half: [f64; 3]) -> Option<Self> {
        half.iter().all(|&side| side >= 0.0).then(|| Self {
            low: std::array::from_fn(|axis| centre[axis] - half[axis]),
            high: std::array::from_fn(|axis| centre[axis] + half[axis]),
        })
    }

    pub(crate) fn union(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(Self {
                low: std::array::from_fn(|axis| a.low[axis].min(b.low[axis])),
                high: std::array::from_fn(|axis| a.high[axis].max(b.high[axis])),
            }),
            (a, b) => a.or(b),
        }
    }

    pub(crate) fn intersection(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        let (a, b) = (a?, b?);
        let low: [f64; 3] = std::array::from_fn(|axis| a.low[axis].max(b.low[axis]));
        let high: [f64; 3] = std::array::from_fn(|axis| a.high[axis].min(b.high[axis]));
        (0..3)
            .all(|axis| low[axis] <= high[axis])
            .then_some(Self { low, high })
    }

    #[cfg(test)]
    pub(crate) fn contains(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| (self.low[axis]..=self.high[axis]).contains(&point[axis]))
    }

    pub(crate) fn longest_side(&self) -> f64 {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| self.high[axis] - self.low[axis]);
        x.max(y).max(z)
    }

    /// Divides the box into sixteen blocks along each axis. Returns the smallest box of the blocks
    /// that are not `empty`, or `None` if all blocks are empty.
    ///
    /// `empty(centre, radius)` may be true only if the ball contains no part of the solid.
    pub(crate) fn tightened(&self, empty: impl Fn([f64; 3], f64) -> bool) -> Option<Self> {
        const SLICES: usize = 16;
        let step: [f64; 3] =
            std::array::from_fn(|axis| (self.high[axis] - self.low[axis]) / SLICES as f64);
        let [x, y, z] = step;
        let radius = (x * x + y * y + z * z).sqrt() / 2.0;
        let mut remaining = None;
        for block in 0..SLICES.pow(3) {
            let index = [
                block % SLICES,
                block / SLICES % SLICES,
                block / (SLICES * SLICES),
            ];
            let centre = std::array::from_fn(|axis| {
                self.low[axis] + (index[axis] as f64 + 0.5) * step[axis]
            });
            if !empty(centre, radius) {
                remaining = Self::union(
                    remaining,
                    Self::from_centre(centre, step.map(|side| side / 2.0)),
                );
            }
        }
        remaining
    }

    /// Builds a lattice of cubes of side `spacing`. On every side, the lattice extends one or two
    /// cubes beyond the box. `shift` moves the lattice towards the low side, by 0 to 1 cubes along
    /// each axis.
    pub(crate) fn lattice(&self, spacing: f64, shift: [f64; 3]) -> Result<Lattice, ShapeError> {
        let cells: [f64; 3] =
            std::array::from_fn(|axis| ((self.high[axis] - self.low[axis]) / spacing).ceil() + 3.0);
        let cubes = cells[0] * cells[1] * cells[2];
        let layer = (cells[0] + 1.0) * (cells[1] + 1.0);
        if !(cubes <= MAX_CUBES && layer <= MAX_LAYER) {
            return Err(ShapeError::TooFine { spacing });
        }
        let origin: [f64; 3] =
            std::array::from_fn(|axis| self.low[axis] - (1.0 + shift[axis]) * spacing);
        // Two vertices differ by at least MARGIN · spacing along some axis; f32 must represent
        // this.
        let extent = (0..3).fold(0.0_f64, |extent, axis| {
            let end = origin[axis] + cells[axis] * spacing;
            extent.max(origin[axis].abs()).max(end.abs())
        });
        if MARGIN * spacing < 2.0 * extent * f64::from(f32::EPSILON) {
            return Err(ShapeError::TooFine { spacing });
        }
        Ok(Lattice {
            origin,
            spacing,
            cells: cells.map(|count| count as usize),
        })
    }
}

//! Which parts of the depth buffer hide everything behind a depth (Greene, Kass and Miller 1993, with
//! one level).

use std::ops::Range;

use glam::DVec2;

use crate::error::RenderError;
use crate::samples::allocate;

/// Columns and rows of a tile.
const SIDE: usize = 32;

/// The depth buffer in squares of samples.
pub(crate) struct Tiles {
    columns: usize,
    rows: usize,
    /// By tile, row by row: a depth that is not nearer than any sample of the tile. −∞ hides nothing.
    farthest: Vec<f32>,
    /// By tile: whether samples were drawn after `farthest` was found.
    is_old: Vec<bool>,
}

impl Tiles {
    /// Returns the tiles of an empty depth buffer with these columns and rows of samples. They hide nothing.
    pub(crate) fn new(columns: usize, rows: usize) -> Result<Self, RenderError> {
        let count = columns.div_ceil(SIDE) * rows.div_ceil(SIDE);
        Ok(Self {
            columns,
            rows,
            farthest: allocate(count, f32::NEG_INFINITY)?,
            is_old: allocate(count, true)?,
        })
    }

    /// Returns the numbers of the tiles that meet a box.
    fn around(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = usize> + use<> {
        // The cast turns negative values into 0.
        let tiles = |low: f64, high: f64, count: usize| {
            let last = (high as usize).min(count - 1);
            (low as usize).min(last) / SIDE..last / SIDE + 1
        };
        let columns = tiles(low.x, high.x, self.columns);
        let width = self.columns.div_ceil(SIDE);
        tiles(low.y, high.y, self.rows)
            .flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Finds the depths of the tiles that meet a box, in `depths`. Returns whether anything of depth
    /// `nearest` can be seen in them.
    pub(crate) fn update(&mut self, low: DVec2, high: DVec2, nearest: f32, depths: &[f32]) -> bool {
        let mut is_seen = false;
        for tile in self.around(low, high) {
            if std::mem::take(&mut self.is_old[tile]) {
                let width = self.columns.div_ceil(SIDE);
                let [row, column] = [tile / width * SIDE, tile % width * SIDE];
                let end = (column + SIDE).min(self.columns);
                let mut farthest = [f32::INFINITY; SIDE];
                for row in row..(row + SIDE).min(self.rows) {
                    let samples = &depths[row * self.columns..][column..end];
                    for (farthest, &depth) in farthest.iter_mut().zip(samples) {
                        *farthest = if depth < *farthest { depth } else { *farthest };
                    }
                }
                self.farthest[tile] = farthest.into_iter().fold(f32::INFINITY, f32::min);
            }
            is_seen |= nearest >= self.farthest[tile];
        }
        is_seen
    }

    /// Cuts columns between tiles.
    pub(crate) fn parts(columns: Range<usize>) -> impl Iterator<Item = Range<usize>> {
        let tiles = columns.start / SIDE..columns.end.div_ceil(SIDE);
        tiles.map(move |tile| columns.start.max(tile * SIDE)..columns.end.min((tile + 1) * SIDE))
    }

    /// Returns whether the tile of a sample hides everything at depths up to `nearest`.
    pub(crate) fn hides(&self, [row, column]: [usize; 2], nearest: impl FnOnce() -> f32) -> bool {
        let farthest = self.farthest[self.tile([row, column])];
        farthest > f32::NEG_INFINITY && nearest() < farthest
    }

    /// Marks the tile of a sample as drawn, so that the next `update` finds its depth again.
    pub(crate) fn mark_drawn(&mut self, sample: [usize; 2]) {
        let tile = self.tile(sample);
        self.is_old[tile] = true;
    }

    fn tile(&self, [row, column]: [usize; 2]) -> usize {
        row / SIDE * self.columns.div_ceil(SIDE) + column / SIDE
    }
}

//! What rounding to 32 bits does to coordinates.

use std::collections::HashSet;
use std::fmt;

use sixfold_core::{Point, row};

use crate::number::Coordinate;
use crate::welder::{Welder, for_each_equal};

/// What rounding to 32 bits did to the coordinates of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Narrowing {
    /// Number of different positions in the file minus the number of different positions after
    /// rounding.
    pub merged_vertices: usize,
    /// Largest change of a coordinate, in the unit of the file.
    pub largest_shift: f64,
}

/// Prints `rounding to 32 bits merged 2 positions with different ones, and moved coordinates by up
/// to 1.2e-2`.
impl fmt::Display for Narrowing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("rounding to 32 bits ")?;
        match self.merged_vertices {
            0 => {}
            1 => f.write_str("merged 1 position with a different one, and ")?,
            n => write!(f, "merged {n} positions with different ones, and ")?,
        }
        write!(f, "moved coordinates by up to {:.2e}", self.largest_shift)
    }
}

/// The positions of a file while it is read.
#[derive(Default)]
pub(crate) struct Positions {
    narrow: Vec<Point>,
    /// Positions before rounding, if they are needed to move the mesh.
    wide: Option<Vec<[f64; 3]>>,
    /// Merges equal positions, and holds the distinct ones instead of `narrow`.
    welder: Option<Welder>,
    /// Number of positions that were merged into an earlier one.
    welded: usize,
    /// A hash of each position before rounding. Empty as long as rounding changed nothing.
    hashes: Vec<u64>,
    /// Welded positions whose hash before rounding differs from that of the first.
    other_hashes: HashSet<(u32, u64)>,
    largest_shift: f64,
}

impl Positions {
    /// Creates an empty list. If `recentre`, the positions are kept in 64 bits.
    pub(crate) fn new(recentre: bool) -> Self {
        let wide = recentre.then(Vec::new);
        Self {
            wide,
            ..Self::default()
        }
    }

    /// Merges equal positions from now on; there must be none yet. `positions` is the expected
    /// number of different ones. Does nothing if positions are kept in 64 bits.
    pub(crate) fn weld(&mut self, positions: usize) {
        if self.wide.is_none() {
            self.welder = Some(Welder::with_capacity(positions));
        }
    }

    pub(crate) fn len(&self) -> usize {
        let narrow = self
            .welder
            .as_ref()
            .map_or(self.narrow.len(), |welder| welder.points().len());
        self.wide.as_ref().map_or(narrow, Vec::len)
    }

    /// Returns the number of positions that were merged into an earlier one.
    pub(crate) fn welded(&self) -> usize {
        self.welded
    }

    /// Reserves memory for `count` further positions, of which the caller is sure.
    pub(crate) fn reserve(&mut self, count: usize) {
        match &mut self.wide {
            Some(wide) => wide.reserve_exact(count),
            None => self.narrow.reserve_exact(count),
        }
    }

    /// Adds a position.
    #[inline]
    pub(crate) fn push(&mut self, coordinates: [Coordinate; 3]) {
        match &mut self.wide {
            Some(wide) => wide.push(coordinates.map(|c| c.wide)),
            None => self.push_narrow(coordinates),
        }
    }

    /// Adds positions that may be equal to others, and appends their numbers to `numbers`.
    pub(crate) fn push_all(&mut self, positions: &[[Coordinate; 3]], numbers: &mut Vec<u32>) {
        let known = self.len();
        let Some(mut welder) = self.welder.take() else {
            numbers.extend((0..positions.len()).map(|i| row(known + i)));
            positions.iter().for_each(|&position| self.push(position));
            return;
        };
        let narrow: Vec<Point> = positions.iter().map(|&position| point(position)).collect();
        let before = numbers.len();
        welder.number_all(&narrow, numbers);
        let mut next = known;
        for (&position, &number) in positions.iter().zip(&numbers[before..]) {
            let is_new = number as usize == next;
            let shift = largest_shift(position);
            if shift > 0.0 || !self.hashes.is_empty() {
                if self.hashes.is_empty() {
                    self.hashes = exact_hashes(&welder.points()[..next]);
                }
                self.largest_shift = self.largest_shift.max(shift);
                let hash = hash(position.map(|c| c.wide));
                if is_new {
                    self.hashes.push(hash);
                } else if self.hashes[number as usize] != hash {
                    self.other_hashes.insert((number, hash));
                }
            }
            next += usize::from(is_new);
        }
        self.welded += positions.len() - (next - known);
        self.welder = Some(welder);
    }

    #[inline]
    fn push_narrow(&mut self, position: [Coordinate; 3]) {
        let shift = largest_shift(position);
        if shift > 0.0 || !self.hashes.is_empty() {
            if self.hashes.is_empty() {
                self.hashes = exact_hashes(&self.narrow);
            }
            self.hashes.push(hash(position.map(|c| c.wide)));
            self.largest_shift = self.largest_shift.max(shift);
        }
        self.narrow.push(point(position));
    }

    /// Returns the positions, the place of their origin in the file, and what rounding did.
    pub(crate) fn finish(mut self) -> (Vec<Point>, [f64; 3], Narrowing) {
        let mut origin = [0.0; 3];
        if let Some(wide) = self.wide.take() {
            origin = centre(&wide);
            self.narrow.reserve_exact(wide.len());
            for position in &wide {
                let moved = [0, 1, 2].map(|i| Coordinate::from(position[i] - origin[i]));
                self.push_narrow(moved);
            }
        }
        let (points, merged_vertices) = match self.welder {
            Some(welder) => (welder.into_points(), self.other_hashes.len()),
            None => {
                let merged = merged(&self.narrow, &self.hashes);
                (self.narrow, merged)
            }
        };
        let narrowing = Narrowing {
            merged_vertices,
            largest_shift: self.largest_shift,
        };
        (points, origin, narrowing)
    }
}

#[inline]
fn point(position: [Coordinate; 3]) -> Point {
    Point::from_array(position.map(|c| c.narrow))
}

#[inline]
fn largest_shift(position: [Coordinate; 3]) -> f64 {
    let shifts = position.map(|c| (c.wide - f64::from(c.narrow)).abs());
    shifts[0].max(shifts[1]).max(shifts[2])
}

/// Returns the hashes of positions that rounding did not change.
#[cold]
#[inline(never)]
fn exact_hashes(points: &[Point]) -> Vec<u64> {
    points
        .iter()
        .map(|p| hash(p.to_array().map(f64::from)))
        .collect()
}

/// Returns the number of different hashes minus the number of different positions.
fn merged(narrow: &[Point], hashes: &[u64]) -> usize {
    let mut others = HashSet::new();
    if !hashes.is_empty() {
        for_each_equal(narrow, |first, later| {
            if hashes[first] != hashes[later] {
                others.insert((first, hashes[later]));
            }
        });
    }
    others.len()
}

/// Returns a hash of a position; −0 and 0 are equal.
fn hash(position: [f64; 3]) -> u64 {
    position.into_iter().fold(0, |hash: u64, x| {
        let mixed =
            (hash.rotate_left(23) ^ (x + 0.0).to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        mixed ^ (mixed >> 29)
    })
}

/// Returns the centre of the bounding box; the origin if there is no position.
fn centre(positions: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let values = positions.iter().map(|position| position[i]);
        let extremes = values.fold(None, |extremes: Option<(f64, f64)>, x| {
            Some(extremes.map_or((x, x), |(low, high)| (low.min(x), high.max(x))))
        });
        extremes.map_or(0.0, |(low, high)| low + (high - low) / 2.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(values: &[f64], recentre: bool) -> (Vec<Point>, [f64; 3], Narrowing) {
        let mut positions = Positions::new(recentre);
        for &x in values {
            positions.push([x, 0.0, 0.5].map(Coordinate::from));
        }
        assert_eq!(positions.len(), values.len());
        positions.finish()
    }

    #[test]
    fn merged_vertices_and_the_largest_shift_are_counted() {
        // At 500 km, 32-bit coordinates have steps of 1/32 m.
        let values = [
            1.0,
            500_000.0,
            500_000.01,
            500_000.0,
            500_000.01,
            500_000.012,
            500_001.0,
        ];
        let (points, _, narrowing) = read(&values, false);
        assert_eq!(narrowing.merged_vertices, 2);
        assert!(
            (narrowing.largest_shift - 0.012).abs() < 1e-9,
            "{narrowing:?}"
        );
        assert_eq!(points[2], points[1]);
    }

    #[test]
    fn welded_positions_are_counted_in_the_same_way() {
        let values = [
            1.0,
            500_000.0,
            500_000.01,
            500_000.0,
            500_000.01,
            500_000.012,
            1.0,
        ];
        let mut positions = Positions::new(false);
        positions.weld(0);
        let mut numbers = Vec::new();
        for part in values.chunks(2) {
            let part: Vec<_> = part
                .iter()
                .map(|&x| [x, 0.0, 0.5].map(Coordinate::from))
                .collect();
            positions.push_all(&part, &mut numbers);
        }
        assert_eq!(numbers, [0, 1, 1, 1, 1, 1, 0]);
        assert_eq!((positions.len(), positions.welded()), (2, 5));
        let (points, _, narrowing) = positions.finish();
        assert_eq!((points.len(), narrowing.merged_vertices), (2, 2));
        let (_, _, unwelded) = read(&values, false);
        assert_eq!(unwelded, narrowing);
    }

    #[test]
    fn moving_the_mesh_keeps_vertices_apart() {
        let (points, origin, narrowing) = read(&[500_000.0, 500_000.01, 500_001.0], true);
        assert_eq!(origin, [500_000.5, 0.0, 0.5]);
        assert_eq!(points[0], Point::new(-0.5, 0.0, 0.0));
        assert_eq!(narrowing.merged_vertices, 0);
        assert!(narrowing.largest_shift < 1e-7, "{narrowing:?}");
    }

    #[test]
    fn exact_coordinates_are_not_counted() {
        let (_, _, narrowing) = read(&[1.5, 1.5, -0.0, 0.0], false);
        assert_eq!(narrowing, Narrowing::default());
        let (_, _, narrowing) = read(&[0.0, -0.0, 0.1, 0.1], false);
        assert_eq!(narrowing.merged_vertices, 0);
        assert!(narrowing.largest_shift > 0.0);
    }
}

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

/// Prints `rounding to 32 bits merged 2 positions with different ones and moved coordinates by up to
/// 1.20e-2`.
impl fmt::Display for Narrowing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("rounding to 32 bits ")?;
        match self.merged_vertices {
            0 => f.write_str("merged no positions and ")?,
            1 => f.write_str("merged 1 position with a different one and ")?,
            n => write!(f, "merged {n} positions with different ones and ")?,
        }
        write!(f, "moved coordinates by up to {:.2e}", self.largest_shift)
    }
}

/// The positions of a file while it is read.
pub(crate) struct Positions {
    stored: Stored,
    /// Number of positions that were merged into an earlier one.
    welded: usize,
    /// A hash of each position before rounding. Empty as long as rounding changed nothing.
    hashes: Vec<u64>,
    /// Welded positions whose hash before rounding differs from that of the first.
    other_hashes: HashSet<(u32, u64)>,
    largest_shift: f64,
}

/// Positions after or before rounding. Those before rounding are needed to move the mesh.
enum Stored {
    Narrow(Vec<Point>),
    /// Equal positions are merged.
    NarrowWelded(Welder<Point>),
    Wide(Vec<[f64; 3]>),
    /// Positions that are equal in 64 bits are merged.
    WideWelded(Welder<[f64; 3]>),
}

/// The origin of a mesh that is moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Origin {
    /// The mesh is not moved.
    #[default]
    Stored,
    /// The centre of the bounding box.
    Centre,
    /// This point.
    At([f64; 3]),
}

/// All positions after rounding.
pub(crate) struct Finished {
    pub(crate) points: Vec<Point>,
    /// Place of their origin in the file.
    pub(crate) origin: [f64; 3],
    pub(crate) narrowing: Narrowing,
}

impl Positions {
    /// Creates an empty list. If `is_moved`, the positions are kept in 64 bits.
    pub(crate) fn new(is_moved: bool) -> Self {
        Self {
            stored: match is_moved {
                true => Stored::Wide(Vec::new()),
                false => Stored::Narrow(Vec::new()),
            },
            welded: 0,
            hashes: Vec::new(),
            other_hashes: HashSet::new(),
            largest_shift: 0.0,
        }
    }

    /// Merges equal positions from now on; there must be none yet. `positions` is the expected
    /// number of different ones.
    pub(crate) fn weld(&mut self, positions: usize) {
        self.stored = match self.stored {
            Stored::Narrow(_) | Stored::NarrowWelded(_) => {
                Stored::NarrowWelded(Welder::with_capacity(positions))
            }
            Stored::Wide(_) | Stored::WideWelded(_) => {
                Stored::WideWelded(Welder::with_capacity(positions))
            }
        };
    }

    pub(crate) fn len(&self) -> usize {
        match &self.stored {
            Stored::Narrow(points) => points.len(),
            Stored::NarrowWelded(welder) => welder.points().len(),
            Stored::Wide(positions) => positions.len(),
            Stored::WideWelded(welder) => welder.points().len(),
        }
    }

    /// Returns the number of positions that were merged into an earlier one.
    pub(crate) fn welded(&self) -> usize {
        self.welded
    }

    /// Reserves memory for `count` further positions, of which the caller is sure.
    pub(crate) fn reserve(&mut self, count: usize) {
        match &mut self.stored {
            Stored::Narrow(points) => points.reserve_exact(count),
            Stored::Wide(positions) => positions.reserve_exact(count),
            // Room was made when welding began.
            Stored::NarrowWelded(_) | Stored::WideWelded(_) => {}
        }
    }

    /// Adds a position. Positions that are welded are added with [`push_all`](Self::push_all).
    #[inline]
    pub(crate) fn push(&mut self, coordinates: [Coordinate; 3]) {
        match &mut self.stored {
            Stored::Narrow(points) => {
                note_shift(
                    coordinates,
                    points,
                    &mut self.hashes,
                    &mut self.largest_shift,
                );
                points.push(point(coordinates));
            }
            Stored::Wide(positions) => positions.push(coordinates.map(|c| c.wide)),
            Stored::NarrowWelded(_) | Stored::WideWelded(_) => {
                self.push_all(&[coordinates], &mut Vec::new());
            }
        }
    }

    /// Adds positions that may be equal to others, and appends their numbers to `numbers`.
    pub(crate) fn push_all(&mut self, positions: &[[Coordinate; 3]], numbers: &mut Vec<u32>) {
        let known = self.len();
        let before = numbers.len();
        match &mut self.stored {
            Stored::Narrow(_) | Stored::Wide(_) => {
                numbers.extend((0..positions.len()).map(|i| row(known + i)));
                positions.iter().for_each(|&position| self.push(position));
            }
            Stored::WideWelded(welder) => {
                let wide: Vec<[f64; 3]> = positions.iter().map(|p| p.map(|c| c.wide)).collect();
                welder.number_all(&wide, numbers);
                self.welded += positions.len() - (welder.points().len() - known);
            }
            Stored::NarrowWelded(welder) => {
                let narrow: Vec<Point> = positions.iter().map(|&p| point(p)).collect();
                welder.number_all(&narrow, numbers);
                self.welded += positions.len() - (welder.points().len() - known);
                self.note_welded(positions, &numbers[before..], known);
            }
        }
    }

    /// Records what rounding did to welded positions, of which `known` were there before.
    fn note_welded(&mut self, positions: &[[Coordinate; 3]], numbers: &[u32], known: usize) {
        let Stored::NarrowWelded(welder) = &self.stored else {
            return;
        };
        let mut next = known;
        for (&position, &number) in positions.iter().zip(numbers) {
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
    }

    /// Rounds the positions, and moves them to `origin` if they were kept in 64 bits.
    pub(crate) fn finish(self, origin: Origin) -> Finished {
        let wide = match self.stored {
            Stored::Narrow(points) => {
                let merged = merged(&points, &self.hashes);
                return Finished::new(points, [0.0; 3], merged, self.largest_shift);
            }
            Stored::NarrowWelded(welder) => {
                let merged = self.other_hashes.len();
                return Finished::new(welder.into_points(), [0.0; 3], merged, self.largest_shift);
            }
            Stored::Wide(positions) => positions,
            Stored::WideWelded(welder) => welder.into_points(),
        };
        let origin = match origin {
            Origin::Stored => [0.0; 3],
            Origin::Centre => centre(&wide),
            Origin::At(origin) => origin,
        };
        let moved = |position: [f64; 3]| [0, 1, 2].map(|i| position[i] - origin[i]);
        let (points, narrowing) = rounded(wide.into_iter().map(moved));
        Finished {
            points,
            origin,
            narrowing,
        }
    }
}

/// Rounds positions to 32 bits, and returns what this did.
pub(crate) fn rounded(
    positions: impl ExactSizeIterator<Item = [f64; 3]>,
) -> (Vec<Point>, Narrowing) {
    let (mut points, mut hashes, mut largest_shift) = (Vec::new(), Vec::new(), 0.0);
    points.reserve_exact(positions.len());
    // The iterator is dropped before more memory is needed.
    positions.for_each(|position| {
        let position = position.map(Coordinate::from);
        note_shift(position, &points, &mut hashes, &mut largest_shift);
        points.push(point(position));
    });
    let narrowing = Narrowing {
        merged_vertices: merged(&points, &hashes),
        largest_shift,
    };
    (points, narrowing)
}

impl Finished {
    fn new(
        points: Vec<Point>,
        origin: [f64; 3],
        merged_vertices: usize,
        largest_shift: f64,
    ) -> Self {
        let narrowing = Narrowing {
            merged_vertices,
            largest_shift,
        };
        Self {
            points,
            origin,
            narrowing,
        }
    }
}

/// Records what rounding does to `position`, which follows `points`.
#[inline]
fn note_shift(
    position: [Coordinate; 3],
    points: &[Point],
    hashes: &mut Vec<u64>,
    largest: &mut f64,
) {
    let shift = largest_shift(position);
    if shift > 0.0 || !hashes.is_empty() {
        if hashes.is_empty() {
            *hashes = exact_hashes(points);
        }
        hashes.push(hash(position.map(|c| c.wide)));
        *largest = largest.max(shift);
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
        finish(positions)
    }

    fn finish(positions: Positions) -> (Vec<Point>, [f64; 3], Narrowing) {
        let finished = positions.finish(Origin::Centre);
        (finished.points, finished.origin, finished.narrowing)
    }

    #[test]
    fn positions_of_64_bits_are_welded() {
        let values = [500_000.0, 500_000.01, 500_000.0, 500_000.01, 500_001.0];
        let mut positions = Positions::new(true);
        positions.weld(0);
        let mut numbers = Vec::new();
        let all = values.map(|x| [x, 0.0, 0.5].map(Coordinate::from));
        positions.push_all(&all[..2], &mut numbers);
        positions.push_all(&all[2..], &mut numbers);
        assert_eq!(numbers, [0, 1, 0, 1, 2]);
        assert_eq!((positions.len(), positions.welded()), (3, 2));
        let (points, origin, narrowing) = finish(positions);
        assert_eq!((points.len(), origin), (3, [500_000.5, 0.0, 0.5]));
        assert_eq!(narrowing.merged_vertices, 0);
    }

    #[test]
    fn a_given_origin_is_used() {
        let mut positions = Positions::new(true);
        positions.push([500_000.0, 1.0, 2.0].map(Coordinate::from));
        let finished = positions.finish(Origin::At([499_999.0, 0.0, 0.0]));
        assert_eq!(finished.points, [Point::ONE.with_z(2.0)]);
        assert_eq!(finished.origin, [499_999.0, 0.0, 0.0]);
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
        let (points, _, narrowing) = finish(positions);
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

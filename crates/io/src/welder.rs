//! Finds vertices with equal positions.

use std::hash::{BuildHasher, RandomState};

use sixfold_core::{Point, row};

/// Number of points that are looked up together.
const BATCH: usize = 256;

/// A position that can be numbered: in 32 bits or in 64 bits. −0 equals 0.
pub(crate) trait Key: Copy + PartialEq {
    /// Returns a hash, which is equal for equal positions. It depends on the random `seeds`, so that
    /// a file cannot be made whose positions all have one hash.
    fn hash(self, seeds: [u64; 2]) -> u64;
}

impl Key for Point {
    #[inline]
    fn hash(self, seeds: [u64; 2]) -> u64 {
        // −0 + 0 is 0.
        let [x, y, z] = self.to_array().map(|x| u64::from((x + 0.0).to_bits()));
        mixed(((x << 32) | y) ^ seeds[0], ((z << 32) | z) ^ seeds[1])
    }
}

impl Key for [f64; 3] {
    #[inline]
    fn hash(self, seeds: [u64; 2]) -> u64 {
        let [x, y, z] = self.map(|x| (x + 0.0).to_bits());
        let xy = mixed(x ^ seeds[0], y ^ seeds[1]);
        mixed(xy ^ seeds[1], z ^ seeds[0])
    }
}

/// Mixes two numbers: the two halves of their product.
#[inline]
fn mixed(first: u64, second: u64) -> u64 {
    let product = u128::from(first) * u128::from(second | 1);
    (product as u64) ^ (product >> 64) as u64
}

/// Numbers points so that equal points have one number; −0 and 0 are equal.
///
/// Points are numbered by first use. The table is an open hash table of numbers, at most half
/// full: eight to sixteen bytes per distinct point.
pub(crate) struct Welder<P> {
    points: Vec<P>,
    slots: Slots,
}

impl<P: Key> Welder<P> {
    /// Creates an empty table with room for `points` distinct points.
    pub(crate) fn with_capacity(points: usize) -> Self {
        Self {
            points: Vec::with_capacity(points),
            slots: Slots::new((2 * points).max(2 * BATCH)),
        }
    }

    /// Appends the number of each of `points` to `numbers`; O(points) expected.
    ///
    /// # Panics
    ///
    /// Panics if there are more distinct points than row numbers.
    pub(crate) fn number_all(&mut self, points: &[P], numbers: &mut Vec<u32>) {
        for batch in points.chunks(BATCH) {
            while 2 * (self.points.len() + batch.len()) > self.slots.len() {
                self.slots.grow(&self.points);
            }
            // The slots are read first, so that the processor can wait for many of them at once.
            let mut first = [(0, 0); BATCH];
            for (entry, &point) in first.iter_mut().zip(batch) {
                let slot = self.slots.slot(point);
                *entry = (slot, self.slots.stored[slot]);
            }
            for (&(slot, before), &point) in first.iter().zip(batch) {
                let stored = before.wrapping_sub(1) as usize;
                let number = match self.points.get(stored) {
                    Some(&other) if other == point => before - 1,
                    _ => self.number(point, slot),
                };
                numbers.push(number);
            }
        }
    }

    /// Returns the number of `point`, or adds it; its slot is `slot` or a later one.
    fn number(&mut self, point: P, slot: usize) -> u32 {
        let next = row(self.points.len());
        let number = self.slots.find_or_insert(&self.points, point, slot, next);
        if number == next {
            self.points.push(point);
        }
        number
    }

    /// Returns the distinct points in the order of their numbers.
    pub(crate) fn points(&self) -> &[P] {
        &self.points
    }

    /// Returns the distinct points in the order of their numbers.
    pub(crate) fn into_points(self) -> Vec<P> {
        self.points
    }
}

/// Calls `visit(first, later)` for each of `points` that equals an earlier one, with the number of
/// the first of them; O(points) expected, with four to six bytes per point.
pub(crate) fn for_each_equal(points: &[Point], mut visit: impl FnMut(usize, usize)) {
    let mut slots = Slots::new(points.len() + points.len() / 2);
    for (start, batch) in points.chunks(BATCH).enumerate() {
        let mut first = [0; BATCH];
        for (slot, &point) in first.iter_mut().zip(batch) {
            *slot = slots.slot(point);
        }
        for (i, (&slot, &point)) in first.iter().zip(batch).enumerate() {
            let number = row(start * BATCH + i);
            let found = slots.find_or_insert(points, point, slot, number);
            if found != number {
                visit(found as usize, number as usize);
            }
        }
    }
}

/// An open hash table of numbers of points. It must not be full.
struct Slots {
    /// Number + 1 of a point; 0 if the slot is empty. The length is a power of two.
    stored: Vec<u32>,
    /// Random, so that a file cannot be made whose points all have one slot. The numbers do not
    /// depend on them.
    seeds: [u64; 2],
}

impl Slots {
    /// Creates an empty table with at least `slots` slots.
    fn new(slots: usize) -> Self {
        let random = RandomState::new();
        Self {
            stored: vec![0; slots.next_power_of_two().max(2)],
            seeds: [random.hash_one(0), random.hash_one(1)],
        }
    }

    fn len(&self) -> usize {
        self.stored.len()
    }

    /// Returns the number of the stored point that equals `point`. If no stored point equals it,
    /// stores and returns `number`. The search begins at `slot`.
    fn find_or_insert<P: Key>(
        &mut self,
        points: &[P],
        point: P,
        mut slot: usize,
        number: u32,
    ) -> u32 {
        loop {
            match self.stored[slot] {
                0 => {
                    self.stored[slot] = number + 1;
                    return number;
                }
                stored if points[stored as usize - 1] == point => return stored - 1,
                _ => slot = (slot + 1) & (self.stored.len() - 1),
            }
        }
    }

    /// Returns the first slot in which `point` may be.
    fn slot(&self, point: impl Key) -> usize {
        let mixed = point.hash(self.seeds).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed >> (64 - self.stored.len().trailing_zeros())) as usize
    }

    /// Doubles the table, which has all of `points`.
    fn grow(&mut self, points: &[impl Key]) {
        let slots = 2 * self.stored.len();
        self.stored = Vec::new(); // freed before the new table is allocated
        self.stored = vec![0; slots];
        for (number, &point) in points.iter().enumerate() {
            let mut slot = self.slot(point);
            while self.stored[slot] != 0 {
                slot = (slot + 1) & (slots - 1);
            }
            self.stored[slot] = row(number) + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn equal_points_get_one_number_in_order_of_first_use() {
        let mut welder = Welder::with_capacity(0);
        let point = |i: usize| Point::new((i * 7919 % 3001) as f32, (i % 3) as f32, -0.0);
        let points: Vec<Point> = (0..40_000).map(point).collect();
        let mut numbers = Vec::new();
        for part in points.chunks(1234) {
            welder.number_all(part, &mut numbers);
        }
        let mut expected = HashMap::new();
        for (&number, point) in numbers.iter().zip(&points) {
            let next = expected.len() as u32;
            let bits = (point.x.to_bits(), point.y.to_bits());
            assert_eq!(*expected.entry(bits).or_insert(next), number);
        }
        assert_eq!(welder.into_points().len(), expected.len());
    }

    #[test]
    fn points_of_64_bits_are_kept_apart() {
        let mut welder = Welder::with_capacity(0);
        let mut numbers = Vec::new();
        let far = |i: u32| [5e5 + f64::from(i % 500) * 1e-3, 0.0, f64::from(i % 2)];
        let points: Vec<[f64; 3]> = (0..2000).map(far).collect();
        welder.number_all(&points, &mut numbers);
        assert!(numbers.iter().copied().eq((0..2000).map(|i| i % 500)));
        welder.number_all(&[[-0.0, 0.0, 1.0], [0.0, -0.0, 1.0]], &mut numbers);
        assert_eq!(numbers[2000..], [500, 500]);
    }

    #[test]
    fn minus_zero_equals_zero() {
        let mut welder = Welder::with_capacity(1);
        let mut numbers = Vec::new();
        let points = [Point::ZERO, Point::new(-0.0, 0.0, -0.0), Point::X];
        welder.number_all(&points, &mut numbers);
        assert_eq!(numbers, [0, 0, 1]);
    }

    #[test]
    fn equal_points_are_visited_with_the_first_of_them() {
        let points: Vec<Point> = (0..1000).map(|i| Point::splat((i % 300) as f32)).collect();
        let mut found = Vec::new();
        for_each_equal(&points, |first, later| found.push((first, later)));
        let expected = (300..1000).map(|i| (i % 300, i));
        assert!(found.into_iter().eq(expected));
        for_each_equal(&[], |_, _| panic!("there are no points"));
    }
}

//! A queue of edges to collapse, sorted by rounded costs.

use std::cmp::Reverse;

/// An edge, given by the numbers of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    pub(crate) ends: [u32; 2],
    /// The sum of the versions of both ends when the entry was made. A different sum means that an
    /// end has changed since then.
    pub(crate) version: u32,
}

impl Entry {
    /// Returns the ends and the version as one number, which is compared without a branch.
    #[inline]
    fn order(&self) -> u128 {
        let [a, b] = self.ends.map(u128::from);
        a << 64 | b << 32 | u128::from(self.version)
    }
}

/// Number of low bits that are ignored in a cost. A cost is a non-negative f32. Three bits of the
/// fraction remain, so costs in one bucket differ by at most an eighth.
const ROUNDED: u32 = 20;

/// Number of buckets.
const BUCKETS: usize = 1 << (31 - ROUNDED);

/// A queue that returns edges in rounds. A round contains all edges of the cheapest bucket, sorted
/// by their ends.
///
/// ```text
/// costs     1 ── 1⅛ ── 1¼ ── …      a round: one bucket, sorted by the ends
/// buckets  [ab cf] [ ] [bc] …       new entries wait for the next round
/// ```
///
/// A heap of exact costs would return edges that are far apart in memory, which is slow. A round
/// returns edges in the order of their vertices in memory. A collapse makes the other entries at
/// its ends outdated. Therefore a round never collapses two adjacent edges.
#[derive(Debug)]
pub(crate) struct Queue {
    buckets: Vec<Vec<Entry>>,
    /// A lower bound of the first bucket with entries.
    lowest: usize,
    /// The remaining entries of this round. The next entry is at the end.
    round: Vec<Entry>,
}

impl Queue {
    pub(crate) fn new() -> Self {
        Self {
            buckets: vec![Vec::new(); BUCKETS],
            lowest: BUCKETS,
            round: Vec::new(),
        }
    }

    /// Adds an edge; O(1) amortised. NaN counts as the highest cost.
    #[inline]
    pub(crate) fn push(&mut self, cost: f32, entry: Entry) {
        let bucket = (cost.abs().to_bits() >> ROUNDED) as usize;
        self.buckets[bucket].push(entry);
        self.lowest = self.lowest.min(bucket);
    }

    /// Removes and returns the next edge; O(log entries) amortised.
    #[inline]
    pub(crate) fn pop(&mut self) -> Option<Entry> {
        if self.round.is_empty() {
            self.next_round();
        }
        self.round.pop()
    }

    fn next_round(&mut self) {
        let buckets = self.buckets.iter().skip(self.lowest);
        self.lowest += buckets.take_while(|bucket| bucket.is_empty()).count();
        if let Some(bucket) = self.buckets.get_mut(self.lowest) {
            std::mem::swap(&mut self.round, bucket);
            self.round
                .sort_unstable_by_key(|entry| Reverse(entry.order()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(a: u32, b: u32) -> Entry {
        Entry {
            ends: [a, b],
            version: 0,
        }
    }

    #[test]
    fn rounds_go_up_and_start_again() {
        let mut queue = Queue::new();
        for (cost, a) in [(1.1, 7), (4.0, 1), (1.0, 9), (0.0, 8), (f32::INFINITY, 0)] {
            queue.push(cost, entry(a, a + 1));
        }
        let next = |queue: &mut Queue| queue.pop().map(|entry| entry.ends[0]);
        assert_eq!(next(&mut queue), Some(8), "the cheapest");
        assert_eq!(next(&mut queue), Some(7), "1 and 1.1 are equal, rounded");
        queue.push(0.5, entry(5, 6));
        queue.push(1.0, entry(4, 6));
        assert_eq!(next(&mut queue), Some(9), "this round first");
        assert_eq!(next(&mut queue), Some(5));
        assert_eq!(next(&mut queue), Some(4));
        assert_eq!(next(&mut queue), Some(1));
        queue.push(f32::NAN, entry(3, 6));
        assert_eq!(next(&mut queue), Some(0));
        assert_eq!(next(&mut queue), Some(3), "NaN comes last");
        assert_eq!(next(&mut queue), None);
        queue.push(-0.0, entry(2, 6));
        assert_eq!(next(&mut queue), Some(2));
        assert_eq!(next(&mut queue), None);
    }

    #[test]
    fn a_round_is_in_the_order_of_the_ends_and_versions() {
        let values = [0, 1, 2, u32::MAX];
        let mut expected = Vec::new();
        for a in values {
            for b in values {
                expected.extend(values.map(|version| Entry {
                    ends: [a, b],
                    version,
                }));
            }
        }
        let mut queue = Queue::new();
        for i in 0..expected.len() {
            queue.push(1.0, expected[i * 27 % expected.len()]);
        }
        assert!(std::iter::from_fn(|| queue.pop()).eq(expected));
    }
}

//! How fast this machine reads memory: in order, and one line after the other.
//!
//! Both are measured in buffers of growing size, so that a mesh can be held to what the caches give
//! that it fits, and the largest buffer tells of the memory itself. One thread reads, as one thread
//! asks a mesh. In order: the sum over all words of the buffer, pass after pass. One after the other:
//! each line holds the place of the next, in one cycle through all of them in random order, so that no
//! read can begin before the one before it has come. Every figure is the least disturbed of several
//! series, after one that nobody times. What finding the page costs is in both, as it is for a mesh.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::{Deserialize, Serialize};

use crate::clock::{Clock, timed};
use crate::ledger::LINE_BYTES;

/// Bytes of the buffers: half of a small inner cache, and then four times as much each time. The last
/// is far beyond the outermost cache of most machines.
const SIZES: [usize; 8] = [
    1 << 14,
    1 << 16,
    1 << 18,
    1 << 20,
    1 << 22,
    1 << 24,
    1 << 26,
    1 << 28,
];
/// Timed series of each kind.
const SERIES: usize = 7;
/// Bytes that a series reads in order, at the least.
const STREAMED: usize = 1 << 24;
/// Reads that a series makes one after the other.
const CHASED: usize = 1 << 16;

/// Words of a cache line; the first may be the place of another line.
const WORDS: usize = LINE_BYTES / size_of::<u64>();

/// How fast a buffer of one size is read.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Rung {
    /// The size of the buffer.
    pub bytes: usize,
    /// Bytes a nanosecond, that is, GB/s, read in order.
    pub gb_per_s: f64,
    /// Nanoseconds until a line has come that no other read could foresee.
    pub latency_ns: f64,
}

/// How fast this machine reads buffers of growing size.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct MemorySpeed {
    /// By size, the smallest first; there is one at least.
    rungs: Vec<Rung>,
}

impl MemorySpeed {
    /// Measures it, in a second or two and 256 MiB; `None` if told to stop.
    pub fn measure(clock: &dyn Clock, stop: &AtomicBool) -> Option<Self> {
        Self::of_sizes(&SIZES, clock, stop)
    }

    fn of_sizes(sizes: &[usize], clock: &dyn Clock, stop: &AtomicBool) -> Option<Self> {
        let mut rungs = Vec::new();
        for &bytes in sizes {
            let words = cycle(bytes / LINE_BYTES);
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            rungs.push(Rung {
                bytes,
                gb_per_s: bandwidth(&words, clock),
                latency_ns: latency(&words, clock),
            });
        }
        Some(Self { rungs })
    }

    /// By size, the smallest first.
    pub fn rungs(&self) -> &[Rung] {
        &self.rungs
    }

    /// How fast what takes `bytes` is read: the largest buffer that is no larger, so as not to make
    /// the machine slower than it is; the smallest of all for less.
    pub fn at(&self, bytes: usize) -> Rung {
        let larger = self.rungs.partition_point(|rung| rung.bytes <= bytes);
        self.rungs[larger.saturating_sub(1)]
    }

    /// How fast the largest buffer is read: the memory itself.
    pub fn memory(&self) -> Rung {
        self.at(usize::MAX)
    }
}

/// Lines whose first words each name the next, one cycle through them all in random order.
fn cycle(lines: usize) -> Vec<u64> {
    let mut order: Vec<u32> = (0..).take(lines).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(1));
    let mut words = vec![0; WORDS * lines];
    let next = order.iter().cycle().skip(1);
    for (&at, &next) in order.iter().zip(next) {
        words[WORDS * at as usize] = next.into();
    }
    words
}

/// Bytes a nanosecond.
fn bandwidth(words: &[u64], clock: &dyn Clock) -> f64 {
    let bytes = size_of_val(words);
    let passes = (STREAMED / bytes).max(1);
    let ns = least(clock, || {
        for _ in 0..passes {
            black_box(sum(black_box(words)));
        }
    });
    (passes * bytes) as f64 / ns
}

/// All words added up: over a plain slice, so that it becomes vectors, and several of them at once.
fn sum(words: &[u64]) -> u64 {
    words
        .iter()
        .fold(0, |sum: u64, &word| sum.wrapping_add(word))
}

/// Nanoseconds a read, when each waits for the one before.
fn latency(words: &[u64], clock: &dyn Clock) -> f64 {
    let mut at = 0;
    let ns = least(clock, || {
        for _ in 0..CHASED {
            at = words[WORDS * at] as usize;
        }
        at = black_box(at);
    });
    ns / CHASED as f64
}

/// The shortest of several series, after one that is not timed.
fn least(clock: &dyn Clock, mut series: impl FnMut()) -> f64 {
    series();
    let times = (0..SERIES).map(|_| timed(clock, &mut series).ns());
    // A clock may be too coarse to see it.
    times.fold(f64::INFINITY, f64::min).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::Time;

    #[test]
    fn the_cycle_goes_through_every_line_once() {
        for lines in [1, 2, 257, 1024] {
            let words = cycle(lines);
            let mut seen = vec![false; lines];
            let mut at = 0;
            for _ in 0..lines {
                assert!(!std::mem::replace(&mut seen[at], true), "{at} of {lines}");
                at = words[WORDS * at] as usize;
            }
            assert_eq!(at, 0, "and comes back");
        }
    }

    #[test]
    fn the_sum_is_over_all_words() {
        assert_eq!(sum(&(1..=1001).collect::<Vec<u64>>()), 501_501);
    }

    #[test]
    fn a_size_is_held_to_the_buffer_below_it() {
        let rung = |bytes, latency_ns| Rung {
            bytes,
            gb_per_s: 1.0,
            latency_ns,
        };
        let speed = MemorySpeed {
            rungs: vec![rung(100, 1.0), rung(400, 4.0), rung(1600, 16.0)],
        };
        let latencies = [0, 99, 100, 399, 400, 1600, usize::MAX].map(|at| speed.at(at).latency_ns);
        assert_eq!(latencies, [1.0, 1.0, 1.0, 1.0, 4.0, 16.0, 16.0]);
        assert_eq!(speed.memory(), speed.rungs()[2]);
    }

    /// Tells a nanosecond more each time it is asked.
    struct Ticking(std::sync::atomic::AtomicU64);

    impl Clock for Ticking {
        fn now(&self) -> Time {
            Time::of_wall(self.0.fetch_add(1, Ordering::Relaxed) as f64)
        }
    }

    #[test]
    fn figures_are_bytes_and_reads_by_the_clock() {
        let clock = Ticking(0.into());
        let go = AtomicBool::new(false);
        let speed = MemorySpeed::of_sizes(&[1 << 14], &clock, &go).expect("nobody stops it");
        let Rung {
            gb_per_s,
            latency_ns,
            ..
        } = speed.memory();
        assert_eq!(gb_per_s, STREAMED as f64, "all of it in a nanosecond");
        assert_eq!(latency_ns, 1.0 / CHASED as f64);
        go.store(true, Ordering::Relaxed);
        assert_eq!(MemorySpeed::of_sizes(&[1 << 14], &clock, &go), None);
    }
}

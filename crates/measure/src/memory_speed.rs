//! Measures how fast this machine reads memory: the bandwidth of sequential reads, and the latency
//! of dependent reads.
//!
//! The bandwidth and the latency are measured in buffers of growing size. Small buffers give the
//! speed of the caches, and the largest buffer gives the speed of the main memory. The buffers are
//! read by one thread, because one thread queries a mesh.
//!
//! The bandwidth test adds all words of the buffer. In the latency test, each cache line holds the
//! index of the next cache line. The cache lines form one cycle in random order, so each read must
//! wait for the previous read. Each test runs several times, and the shortest time counts. The
//! bandwidth and the latency include the time of address translation (TLB misses).

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::caches::LINE_BYTES;
use crate::clock::{Clock, timed};
use sixfold_results::BufferSpeed;

/// Sizes of the buffers in bytes. The first buffer is half of a small first-level cache. The last
/// buffer is larger than the last-level cache of most machines.
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
/// Number of timed series for each value.
const SERIES: usize = 7;
/// Minimum number of bytes that a sequential series reads.
const MIN_STREAMED_BYTES: usize = 1 << 24;
/// Number of dependent reads in a series.
const DEPENDENT_READS: usize = 1 << 16;

/// Number of words in a cache line.
const WORDS: usize = LINE_BYTES / size_of::<u64>();

/// The speeds at which this machine reads buffers of different sizes.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct MemorySpeed {
    /// The speed of each buffer, ordered by the size of the buffer. The list is never empty.
    #[serde(rename = "rungs")]
    speeds: Vec<BufferSpeed>,
    /// The size of the smallest buffer that was left out because there was too little time; `None`
    /// if all buffers were measured.
    left_out_from: Option<usize>,
}

impl MemorySpeed {
    /// Measures the speed of memory. The measurement of all buffers takes one or two seconds and
    /// 256 MiB of memory. A buffer that would take the measurement beyond `limit`, and all larger
    /// buffers, are left out; the smallest buffer is always measured. Returns `None` if `stop`
    /// becomes true during the measurement.
    pub fn measure(limit: Duration, clock: &dyn Clock, stop: &AtomicBool) -> Option<Self> {
        Self::measure_sizes(&SIZES, limit, clock, stop)
    }

    fn measure_sizes(
        sizes: &[usize],
        limit: Duration,
        clock: &dyn Clock,
        stop: &AtomicBool,
    ) -> Option<Self> {
        let start = clock.now().wall_ns;
        let elapsed = || Duration::from_nanos((clock.now().wall_ns - start).max(0.0) as u64);
        let mut speeds = Vec::new();
        let mut left_out_from = None;
        let mut expected = Duration::ZERO;
        for &bytes in sizes {
            let before = elapsed();
            if !speeds.is_empty() && before.saturating_add(expected) > limit {
                left_out_from = Some(bytes);
                break;
            }
            let words = cycle(bytes / LINE_BYTES);
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            speeds.push(BufferSpeed {
                bytes,
                gb_per_s: bandwidth(&words, clock),
                latency_ns: latency(&words, clock),
            });
            // The next buffer is four times as large.
            expected = elapsed().saturating_sub(before).saturating_mul(4);
        }
        Some(Self {
            speeds,
            left_out_from,
        })
    }

    /// Returns the speeds of memory from those of buffers, such as medians over several measurements. The speeds are
    /// ordered by the size of the buffer; `None` without any.
    pub fn from_speeds(speeds: Vec<BufferSpeed>) -> Option<Self> {
        let largest = speeds.last()?.bytes;
        Some(Self {
            left_out_from: SIZES.into_iter().find(|&bytes| bytes > largest),
            speeds,
        })
    }

    /// Returns the size in bytes of the smallest buffer that was left out because there was too
    /// little time; `None` if all buffers were measured.
    pub const fn left_out_from(&self) -> Option<usize> {
        self.left_out_from
    }

    /// Returns the speed of each buffer, starting with the smallest buffer.
    pub fn speeds(&self) -> &[BufferSpeed] {
        &self.speeds
    }

    /// Returns the speed of the largest buffer of at most `bytes` bytes. If all buffers are larger,
    /// returns the speed of the smallest buffer.
    pub fn at(&self, bytes: usize) -> BufferSpeed {
        let larger = self.speeds.partition_point(|speed| speed.bytes <= bytes);
        self.speeds[larger.saturating_sub(1)]
    }

    /// Returns the speed of the main memory, which is the speed of the largest buffer.
    pub fn memory(&self) -> BufferSpeed {
        self.at(usize::MAX)
    }
}

/// Returns lines that form one cycle in random order. The first word of a line is the index of the
/// next line.
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

/// Returns the bandwidth of sequential reads, in bytes per nanosecond.
fn bandwidth(words: &[u64], clock: &dyn Clock) -> f64 {
    let bytes = size_of_val(words);
    let passes = (MIN_STREAMED_BYTES / bytes).max(1);
    let ns = shortest_ns(clock, || {
        for _ in 0..passes {
            black_box(sum(black_box(words)));
        }
    });
    (passes * bytes) as f64 / ns
}

/// Adds all words. The compiler can vectorize this plain loop.
fn sum(words: &[u64]) -> u64 {
    words
        .iter()
        .fold(0, |sum: u64, &word| sum.wrapping_add(word))
}

/// Returns the time of one dependent read, in nanoseconds.
fn latency(words: &[u64], clock: &dyn Clock) -> f64 {
    let mut at = 0;
    let ns = shortest_ns(clock, || {
        for _ in 0..DEPENDENT_READS {
            at = words[WORDS * at] as usize;
        }
        at = black_box(at);
    });
    ns / DEPENDENT_READS as f64
}

/// Returns the shortest time of several series, in nanoseconds. The first series is not timed.
fn shortest_ns(clock: &dyn Clock, mut series: impl FnMut()) -> f64 {
    series();
    let times = (0..SERIES).map(|_| timed(clock, &mut series).ns());
    times.fold(f64::INFINITY, f64::min).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold_results::Time;

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
            assert_eq!(at, 0, "the cycle is closed");
        }
    }

    #[test]
    fn the_sum_is_over_all_words() {
        assert_eq!(sum(&(1..=1001).collect::<Vec<u64>>()), 501_501);
    }

    #[test]
    fn a_size_gets_the_speed_of_the_next_smaller_buffer() {
        let buffer = |bytes, latency_ns| BufferSpeed {
            bytes,
            gb_per_s: 1.0,
            latency_ns,
        };
        let speed = MemorySpeed {
            speeds: vec![buffer(100, 1.0), buffer(400, 4.0), buffer(1600, 16.0)],
            left_out_from: None,
        };
        let latencies = [0, 99, 100, 399, 400, 1600, usize::MAX].map(|at| speed.at(at).latency_ns);
        assert_eq!(latencies, [1.0, 1.0, 1.0, 1.0, 4.0, 16.0, 16.0]);
        assert_eq!(speed.memory(), speed.speeds()[2]);
    }

    struct TickingClock(std::sync::atomic::AtomicU64);

    impl Clock for TickingClock {
        fn now(&self) -> Time {
            Time::from_wall_ns(self.0.fetch_add(1, Ordering::Relaxed) as f64)
        }
    }

    #[test]
    fn speeds_are_bytes_and_reads_divided_by_time() {
        let clock = TickingClock(0.into());
        let stop = AtomicBool::new(false);
        let limit = Duration::MAX;
        let speed = MemorySpeed::measure_sizes(&[1 << 14], limit, &clock, &stop);
        let speed = speed.expect("not stopped");
        assert_eq!(speed.left_out_from(), None);
        let BufferSpeed {
            gb_per_s,
            latency_ns,
            ..
        } = speed.memory();
        assert_eq!(
            gb_per_s, MIN_STREAMED_BYTES as f64,
            "all bytes in one nanosecond"
        );
        assert_eq!(latency_ns, 1.0 / DEPENDENT_READS as f64);
        stop.store(true, Ordering::Relaxed);
        assert_eq!(
            MemorySpeed::measure_sizes(&[1 << 14], limit, &clock, &stop),
            None
        );
    }

    #[test]
    fn buffers_beyond_the_time_limit_are_left_out() {
        let clock = TickingClock(0.into());
        let stop = AtomicBool::new(false);
        let sizes = [1 << 14, 1 << 16, 1 << 18];
        let speed = MemorySpeed::measure_sizes(&sizes, Duration::ZERO, &clock, &stop);
        let speed = speed.expect("not stopped");
        assert_eq!(speed.speeds().len(), 1, "the smallest buffer");
        assert_eq!(speed.left_out_from(), Some(1 << 16));
    }
}

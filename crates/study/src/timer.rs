//! What the clock and the engine themselves cost: nothing is measured that is not much longer.

use std::hint::black_box;

use serde::{Deserialize, Serialize};
use workload::Clock;

use crate::measure::Entry;

/// How often the clock is read.
const TRIALS: usize = 1001;

/// The clock and the engine, timed by themselves at the start of a study.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timer {
    /// The smallest step that the clock was seen to make, in nanoseconds.
    pub resolution_ns: f64,
    /// What reading the clock takes in use, in nanoseconds; subtracted from every stretch between two
    /// readings.
    pub overhead_ns: f64,
    /// By how much that may be wrong: the difference to what reading takes in a loop of its own, or how much
    /// longer it takes there in one of twenty cases, whichever is more.
    #[serde(default)]
    pub left_ns: f64,
    /// The part of that in the shortest stretch between two readings; `None` where nothing was measured.
    pub largest_share: Option<f64>,
    /// That stretch, in nanoseconds.
    #[serde(default)]
    pub shortest_ns: Option<f64>,
}

impl Timer {
    /// Reads `clock` again and again, with nothing between the readings.
    pub(crate) fn of(clock: &dyn Clock) -> Self {
        let runs = black_box(1_u32);
        let empty = || {
            let start = clock.now();
            for run in 0..runs {
                black_box(run);
            }
            (clock.now() - start).ns()
        };
        let mut times: Vec<f64> = (0..TRIALS).map(|_| empty()).collect();
        times.sort_by(f64::total_cmp);
        let (usual, longest) = (times[TRIALS / 2], times[TRIALS * 95 / 100]);
        let overhead_ns = clock.overhead().ns();
        // Either the clock takes as long as in this loop, which does nothing else, or longer than usual.
        let left_ns = (overhead_ns - usual).abs().max(longest - usual);
        let steps = times.iter().copied().filter(|&ns| ns > 0.0);
        Self {
            resolution_ns: steps.min_by(f64::total_cmp).unwrap_or(0.0),
            overhead_ns,
            left_ns,
            largest_share: None,
            shortest_ns: None,
        }
    }

    /// The same, with its part in the shortest of the samples that were taken.
    pub(crate) fn beside(self, entries: &[Entry]) -> Self {
        let shortest = entries.iter().filter_map(Entry::shortest_sample_ns);
        self.with_shortest(shortest.min_by(f64::total_cmp))
    }

    /// The same, with the shortest stretch between two readings.
    pub(crate) fn with_shortest(self, shortest_ns: Option<f64>) -> Self {
        Self {
            largest_share: shortest_ns.map(|ns| self.left_ns / ns),
            shortest_ns,
            ..self
        }
    }
}

//! The costs of reading the clock, to check that every measured time is much longer.

use std::hint::black_box;

use serde::{Deserialize, Serialize};
use sixfold_workload::Clock;

use crate::measure::Entry;

/// The number of readings.
const TRIALS: usize = 1001;

/// The resolution and the overhead of the clock, measured at the start of a study.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timer {
    /// The smallest observed step of the clock, in nanoseconds.
    pub resolution_ns: f64,
    /// The time for reading the clock during measurement, in nanoseconds. It is subtracted from
    /// every stretch between two readings.
    pub overhead_ns: f64,
    /// The uncertainty of `overhead_ns`, in nanoseconds. It is the larger of two values from an
    /// empty loop of readings: the difference between `overhead_ns` and the median time of a
    /// reading, and the difference between the 95 % quantile and the median.
    #[serde(default, rename = "left_ns")]
    pub uncertainty_ns: f64,
    /// `uncertainty_ns` divided by `shortest_ns`; `None` if nothing was measured.
    pub largest_share: Option<f64>,
    /// The shortest stretch between two readings, in nanoseconds.
    #[serde(default)]
    pub shortest_ns: Option<f64>,
}

impl Timer {
    /// Reads `clock` repeatedly, with nothing between the readings.
    pub(crate) fn measure(clock: &dyn Clock) -> Self {
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
        // The overhead may be as in this empty loop, or reading may take longer than usual.
        let uncertainty_ns = (overhead_ns - usual).abs().max(longest - usual);
        let steps = times.iter().copied().filter(|&ns| ns > 0.0);
        Self {
            resolution_ns: steps.min_by(f64::total_cmp).unwrap_or(0.0),
            overhead_ns,
            uncertainty_ns,
            largest_share: None,
            shortest_ns: None,
        }
    }

    /// Adds the shortest of the samples that were taken.
    pub(crate) fn with_entries(self, entries: &[Entry]) -> Self {
        let shortest = entries.iter().filter_map(Entry::shortest_sample_ns);
        self.with_shortest(shortest.min_by(f64::total_cmp))
    }

    /// Adds the shortest stretch between two readings.
    pub(crate) fn with_shortest(self, shortest_ns: Option<f64>) -> Self {
        Self {
            largest_share: shortest_ns.map(|ns| self.uncertainty_ns / ns),
            shortest_ns,
            ..self
        }
    }
}

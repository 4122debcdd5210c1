//! The cost of reading the clock.

use std::hint::black_box;

use serde::{Deserialize, Serialize};
use sixfold_workload::Clock;

use crate::measure::Entry;

/// Number of readings.
const TRIALS: usize = 1001;

/// The resolution and the overhead of the clock, measured at the start of a study.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timer {
    /// The smallest observed step of the clock, in nanoseconds.
    pub resolution_ns: f64,
    /// The time for reading the clock, in nanoseconds. This time is subtracted from every measured
    /// time.
    pub overhead_ns: f64,
    /// The uncertainty of `overhead_ns`, in nanoseconds. The time between two readings without work
    /// is measured many times. The uncertainty is the larger of two differences: between
    /// `overhead_ns` and the median of the measured times, and between the 95 % quantile and the
    /// median of the measured times.
    #[serde(default, rename = "left_ns")]
    pub uncertainty_ns: f64,
    /// `uncertainty_ns` divided by `shortest_ns`; `None` if nothing was measured.
    pub largest_share: Option<f64>,
    /// The shortest measured time of a sample, in nanoseconds; `None` if nothing was measured.
    #[serde(default)]
    pub shortest_ns: Option<f64>,
}

impl Timer {
    /// Reads `clock` repeatedly, without work between the readings.
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
        // The overhead may be as in this empty loop, or a reading may take longer.
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

    pub(crate) fn with_entries(self, entries: &[Entry]) -> Self {
        let shortest = entries.iter().filter_map(Entry::shortest_sample_ns);
        self.with_shortest(shortest.min_by(f64::total_cmp))
    }

    pub(crate) fn with_shortest(self, shortest_ns: Option<f64>) -> Self {
        Self {
            largest_share: shortest_ns.map(|ns| self.uncertainty_ns / ns),
            shortest_ns,
            ..self
        }
    }
}

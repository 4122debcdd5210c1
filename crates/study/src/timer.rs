//! What the clock and the engine themselves cost: nothing is measured that is not much longer.

use std::hint::black_box;

use serde::{Deserialize, Serialize};
use workload::{Clock, timed};

use crate::measure::Entry;
use crate::statistics::Median;

/// How often an empty operation is timed.
const TRIALS: usize = 1001;

/// The clock and the engine, timed by themselves at the start of a study.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timer {
    /// The smallest step that the clock was seen to make, in nanoseconds.
    pub resolution_ns: f64,
    /// What a sample of an empty operation takes, in nanoseconds: what is in every sample besides what
    /// it is of.
    pub overhead_ns: f64,
    /// The part of it in the shortest sample of the study; `None` where nothing was measured.
    pub largest_share: Option<f64>,
}

impl Timer {
    /// Times an empty operation on `clock`, as a sample of one run.
    pub(crate) fn of(clock: &dyn Clock) -> Self {
        let runs = black_box(1_u32);
        let empty = || {
            let time = timed(clock, || {
                for run in 0..runs {
                    black_box(run);
                }
            });
            time.ns()
        };
        let times: Vec<f64> = (0..TRIALS).map(|_| empty()).collect();
        let steps = times.iter().copied().filter(|&ns| ns > 0.0);
        Self {
            resolution_ns: steps.min_by(f64::total_cmp).unwrap_or(0.0),
            overhead_ns: Median::of(times.iter().copied()).map_or(0.0, |m| m.value),
            largest_share: None,
        }
    }

    /// The same, with its part in the shortest of the samples that were taken.
    pub(crate) fn beside(self, entries: &[Entry]) -> Self {
        let shortest = entries.iter().filter_map(Entry::shortest_sample_ns);
        let shortest = shortest.min_by(f64::total_cmp);
        Self {
            largest_share: shortest.map(|ns| self.overhead_ns / ns),
            ..self
        }
    }
}

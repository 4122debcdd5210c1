//! The cost of reading the clock.

use serde::{Deserialize, Serialize};

/// The resolution and the overhead of the clock, measured at the start of a study.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timer {
    /// The smallest observed step of the clock, in nanoseconds.
    pub resolution_ns: f64,
    /// The time for reading the clock, in nanoseconds. This time is subtracted from every measured
    /// time.
    pub overhead_ns: f64,
    /// The uncertainty of `overhead_ns`, in nanoseconds. The time between two readings without work
    /// is measured many times. The uncertainty is the largest of three differences:
    /// between `overhead_ns` and the median of the measured times, between the 95 % quantile and the
    /// median, and between `resolution_ns` and the median, which is large if most readings see no
    /// step.
    pub uncertainty_ns: f64,
    /// `uncertainty_ns` divided by `shortest_ns`; `None` if nothing was measured.
    pub largest_share: Option<f64>,
    /// The shortest measured time of a sample, in nanoseconds; `None` if nothing was measured.
    pub shortest_ns: Option<f64>,
}

impl Timer {
    /// Adds the shortest measured time of a sample.
    pub fn with_shortest(self, shortest_ns: Option<f64>) -> Self {
        Self {
            largest_share: shortest_ns.map(|ns| self.uncertainty_ns / ns),
            shortest_ns,
            ..self
        }
    }
}

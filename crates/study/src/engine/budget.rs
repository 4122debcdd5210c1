//! A time limit for a whole measurement, including the preparation.

use std::time::{Duration, Instant};

/// A time limit for all work of a measurement: building, timing and checking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    start: Instant,
    total: Duration,
}

impl Budget {
    /// Creates a time limit that starts now and ends after `total`.
    pub fn start(total: Duration) -> Self {
        Self {
            start: Instant::now(),
            total,
        }
    }

    /// Returns the whole time from the start to the end.
    pub const fn total(&self) -> Duration {
        self.total
    }

    /// Returns the remaining time; zero if the time limit has passed.
    pub fn left(&self) -> Duration {
        self.total.saturating_sub(self.start.elapsed())
    }

    /// Returns the time for one of several steps: `weight / rest` of the remaining time. `weight`
    /// is the weight of the step. `rest` is the sum of the weights of all unfinished steps,
    /// including this step.
    pub fn share(&self, weight: f64, rest: f64) -> Duration {
        let share = weight / rest;
        match share.is_finite() {
            true => self.left().mul_f64(share.clamp(0.0, 1.0)),
            false => self.left(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_divide_the_remaining_time() {
        let budget = Budget::start(Duration::from_secs(1000));
        let half = budget.share(1.0, 2.0).as_secs_f64();
        assert!((499.0..=500.0).contains(&half), "{half}");
        assert!(budget.share(0.0, 0.0) > Duration::from_secs(999));
        assert_eq!(
            Budget::start(Duration::ZERO).share(1.0, 3.0),
            Duration::ZERO
        );
    }
}

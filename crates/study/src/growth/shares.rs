//! Distribution of the budget of a sweep over its sizes.

use std::time::{Duration, Instant};

/// The share of the budget of each size, proportional to the square root of its faces: the time of
/// a run grows with the faces, but small sizes need more runs.
pub(super) struct Shares {
    weights: Vec<f64>,
    start: Instant,
    budget: Duration,
}

impl Shares {
    pub(super) fn of(sizes: &[usize], budget: Duration) -> Self {
        Self {
            weights: sizes.iter().map(|&faces| (faces as f64).sqrt()).collect(),
            start: Instant::now(),
            budget,
        }
    }

    /// Returns the start and the end of this size's share within the whole, from 0 to 1.
    pub(super) fn range(&self, step: usize) -> [f64; 2] {
        let all: f64 = self.weights.iter().sum();
        [step, step + 1].map(|end| self.weights[..end].iter().sum::<f64>() / all)
    }

    /// Returns the time left of the budget.
    pub(super) fn left(&self) -> Duration {
        self.budget.saturating_sub(self.start.elapsed())
    }

    /// Returns the share of this size in the time left.
    pub(super) fn share(&self, step: usize) -> Duration {
        let rest: f64 = self.weights[step..].iter().sum();
        self.left().mul_f64((self.weights[step] / rest).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_use_the_whole_budget_and_grow_with_the_size() {
        let shares = Shares::of(&[100, 10_000, 1_000_000], Duration::from_secs(1000));
        let [first, second, last] = [0, 1, 2].map(|step| shares.range(step));
        assert_eq!((first[0], first[1], second[1]), (0.0, second[0], last[0]));
        assert!((last[1] - 1.0).abs() < 1e-12);
        // Square roots of 10, 100 and 1000.
        assert!((first[1] - 10.0 / 1110.0).abs() < 1e-12, "{first:?}");
        let second = shares.share(0).as_secs_f64();
        assert!((8.0..9.1).contains(&second), "{second}");
        // The last size has all the time left.
        assert!(shares.share(2) > Duration::from_secs(990));
        let spent = Shares::of(&[100, 200], Duration::ZERO);
        assert_eq!(spent.share(1), Duration::ZERO);
    }
}

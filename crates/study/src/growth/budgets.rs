//! Divides a time budget among the sizes of one shape.

use std::time::Duration;

use crate::budget::Budget;

/// The part of the budget for each size. It is proportional to the square root of the number of
/// faces, because small sizes need more runs.
pub(super) struct SizeBudgets {
    weights: Vec<f64>,
    budget: Budget,
}

impl SizeBudgets {
    pub(super) fn new(sizes: &[usize], budget: Duration) -> Self {
        Self {
            weights: sizes.iter().map(|&faces| (faces as f64).sqrt()).collect(),
            budget: Budget::start(budget),
        }
    }

    /// Returns the start and the end of the part for one size, from 0 to 1.
    pub(super) fn range(&self, step: usize) -> [f64; 2] {
        let all: f64 = self.weights.iter().sum();
        [step, step + 1].map(|end| self.weights[..end].iter().sum::<f64>() / all)
    }

    pub(super) fn left(&self) -> Duration {
        self.budget.left()
    }

    /// Returns the time for one size, as a part of the time left.
    pub(super) fn budget(&self, step: usize) -> Duration {
        let rest: f64 = self.weights[step..].iter().sum();
        self.budget.share(self.weights[step], rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_use_the_whole_budget_and_grow_with_the_size() {
        let budgets = SizeBudgets::new(&[100, 10_000, 1_000_000], Duration::from_secs(1000));
        let [first, second, last] = [0, 1, 2].map(|step| budgets.range(step));
        assert_eq!((first[0], first[1], second[1]), (0.0, second[0], last[0]));
        assert!((last[1] - 1.0).abs() < 1e-12);
        // The weights are the square roots of the sizes: 10, 100 and 1000.
        assert!((first[1] - 10.0 / 1110.0).abs() < 1e-12, "{first:?}");
        let second = budgets.budget(0).as_secs_f64();
        assert!((8.0..9.1).contains(&second), "{second}");
        assert!(budgets.budget(2) > Duration::from_secs(990));
        let spent = SizeBudgets::new(&[100, 200], Duration::ZERO);
        assert_eq!(spent.budget(1), Duration::ZERO);
    }
}

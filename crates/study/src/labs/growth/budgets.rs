//! Divides a time budget among the sizes of one shape.

use sixfold_measure::Clock;

use crate::engine::effort::{Budget, Effort};

/// The part of the budget for each size. It is proportional to the square root of the number of
/// faces, because small sizes need more runs.
pub(super) struct SizeBudgets<'c> {
    weights: Vec<f64>,
    budget: Budget<'c>,
}

impl<'c> SizeBudgets<'c> {
    pub(super) fn new(sizes: &[usize], effort: Effort, clock: &'c dyn Clock) -> Self {
        Self {
            weights: sizes.iter().map(|&faces| (faces as f64).sqrt()).collect(),
            budget: Budget::start(effort, clock),
        }
    }

    /// Returns the start and the end of the part for one size, from 0 to 1.
    pub(super) fn range(&self, step: usize) -> [f64; 2] {
        let all: f64 = self.weights.iter().sum();
        [step, step + 1].map(|end| self.weights[..end].iter().sum::<f64>() / all)
    }

    pub(super) fn left(&self) -> Effort {
        self.budget.left()
    }

    /// Returns the effort for one size: a part of the time left, or all rounds.
    pub(super) fn effort(&self, step: usize) -> Effort {
        let rest: f64 = self.weights[step..].iter().sum();
        self.budget.share(self.weights[step], rest)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::engine::simulated_machine::SimulatedMachine;

    #[test]
    fn parts_use_the_whole_budget_and_grow_with_the_size() {
        let machine = SimulatedMachine::steady();
        let effort = Effort::Budget(Duration::from_secs(1110));
        let budgets = SizeBudgets::new(&[100, 10_000, 1_000_000], effort, &machine);
        let [first, second, last] = [0, 1, 2].map(|step| budgets.range(step));
        assert_eq!((first[0], first[1], second[1]), (0.0, second[0], last[0]));
        assert!((last[1] - 1.0).abs() < 1e-12);
        // The weights are the square roots of the sizes: 10, 100 and 1000.
        assert!((first[1] - 10.0 / 1110.0).abs() < 1e-12, "{first:?}");
        let seconds = |step: usize| budgets.effort(step).limit_ns() / 1e9;
        assert!((seconds(0) - 10.0).abs() < 1e-6);
        assert!((seconds(2) - 1110.0).abs() < 1e-6);
        machine.work(1109e9);
        assert!((seconds(1) - 100.0 / 1100.0).abs() < 1e-6);
        machine.work(2e9);
        assert_eq!(seconds(1), 0.0);
    }
}

//! How much is measured: as much as fits into a time limit, or a fixed number of rounds.

use std::num::NonZeroU32;
use std::time::Duration;

use crate::Clock;
use sixfold_results::RunSettings;

/// How much a measurement does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// As many rounds as fit into this time, which includes building and checking. What takes too
    /// long is sampled, estimated or left out.
    Budget(Duration),
    /// This number of rounds of everything that was asked for, without a time limit. The number of
    /// runs in a sample, and whether a scan is sampled, follow from the number of elements, not from
    /// the clock. Two machines therefore plan the same samples. Three things still depend on the
    /// machine: a sample with page faults is taken again, short edits run on as many copies of the
    /// mesh as the clock and the cache need, and a pick makes relation tables from a structure that
    /// makes them fast.
    Rounds(NonZeroU32),
}

impl Effort {
    /// Returns the time limit; `None` if there is no time limit.
    pub const fn budget(self) -> Option<Duration> {
        match self {
            Self::Budget(budget) => Some(budget),
            Self::Rounds(_) => None,
        }
    }

    /// Returns the number of rounds; `None` if the time decides.
    pub const fn rounds(self) -> Option<NonZeroU32> {
        match self {
            Self::Budget(_) => None,
            Self::Rounds(rounds) => Some(rounds),
        }
    }

    /// Returns the settings of a run with this effort. All other settings have their defaults.
    pub fn run_settings(self) -> RunSettings {
        RunSettings {
            budget_s: self.budget().map(|budget| budget.as_secs_f64()),
            rounds: self.rounds(),
            ..RunSettings::default()
        }
    }

    /// Returns the effort for a part of the work: `part` of the time, from 0 to 1, or the same
    /// number of rounds.
    pub fn part(self, part: f64) -> Self {
        match self {
            Self::Budget(budget) => Self::Budget(budget.mul_f64(part.clamp(0.0, 1.0))),
            rounds => rounds,
        }
    }

    /// Returns the time limit in nanoseconds; infinity if there is no time limit.
    pub fn limit_ns(self) -> f64 {
        self.budget()
            .map_or(f64::INFINITY, |budget| budget.as_nanos() as f64)
    }
}

#[cfg(any(test, feature = "simulated"))]
impl Effort {
    /// Returns the effort of `n` rounds.
    pub fn of_rounds(n: u32) -> Self {
        Self::Rounds(NonZeroU32::new(n).expect("above 0"))
    }

    /// Returns the effort of a time limit.
    pub fn of_ms(milliseconds: u64) -> Self {
        Self::Budget(Duration::from_millis(milliseconds))
    }
}

impl From<Duration> for Effort {
    fn from(budget: Duration) -> Self {
        Self::Budget(budget)
    }
}

/// The effort for all work of a measurement (building, timing and checking), and the clock on which
/// its time passes.
#[derive(Clone, Copy)]
pub struct Budget<'c> {
    clock: &'c dyn Clock,
    start_ns: f64,
    effort: Effort,
}

impl<'c> Budget<'c> {
    /// Starts the time of `effort` on `clock`.
    pub fn start(effort: Effort, clock: &'c dyn Clock) -> Self {
        Self {
            clock,
            start_ns: clock.now().wall_ns,
            effort,
        }
    }

    /// Returns the effort that is left: the remaining time, or all rounds.
    pub fn left(&self) -> Effort {
        match self.effort {
            Effort::Budget(budget) => {
                let elapsed_ns = self.clock.now().wall_ns - self.start_ns;
                let elapsed = Duration::from_nanos(elapsed_ns.max(0.0) as u64);
                Effort::Budget(budget.saturating_sub(elapsed))
            }
            rounds => rounds,
        }
    }

    /// Returns the effort for one of several steps: `weight / rest` of the remaining time. `weight`
    /// is the weight of the step. `rest` is the sum of the weights of all unfinished steps,
    /// including this step.
    pub fn share(&self, weight: f64, rest: f64) -> Effort {
        let share = weight / rest;
        match share.is_finite() {
            true => self.left().part(share),
            false => self.left(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simulated_machine::SimulatedMachine;

    #[test]
    fn shares_divide_the_remaining_time() {
        let machine = SimulatedMachine::steady();
        let seconds = |s: u64| Effort::Budget(Duration::from_secs(s));
        let budget = Budget::start(seconds(1000), &machine);
        assert_eq!(budget.share(1.0, 2.0), seconds(500));
        assert_eq!(budget.share(0.0, 0.0), seconds(1000));
        machine.work(400e9);
        assert_eq!(budget.left(), seconds(600));
        assert_eq!(budget.share(1.0, 3.0), seconds(200));
        machine.work(601e9);
        assert_eq!(budget.share(1.0, 3.0), seconds(0));
    }

    #[test]
    fn rounds_are_not_divided() {
        let machine = SimulatedMachine::steady();
        let rounds = Effort::Rounds(NonZeroU32::MIN);
        let budget = Budget::start(rounds, &machine);
        machine.work(1e15);
        assert_eq!(budget.left(), rounds);
        assert_eq!(budget.share(1.0, 3.0), rounds);
        assert_eq!(rounds.part(0.1), rounds);
        assert_eq!((rounds.limit_ns(), rounds.budget()), (f64::INFINITY, None));
    }
}

//! What the backends of a pick run.

use sixfold_results::{Excluded, PartCost, RUN, Time};

use crate::engine::measure::Entry;
use crate::job::Task;
use crate::pick::break_even::MeasuredMix;
use crate::pick::measurement::Candidate;

/// What the backends of a pick run, and how the time of one operation follows from it.
pub trait TaskPlan {
    /// Returns the entries to measure: for each task, one for each candidate that has it.
    fn entries(&self, candidates: &[Candidate]) -> Vec<Entry>;

    /// Returns the time of one operation on a candidate, rebuilding included, by round; the exclusion
    /// if the candidate refuses a task. `entries` are those of the candidate.
    fn mix_times(
        &self,
        candidate: &Candidate,
        entries: &[&Entry],
    ) -> Result<Vec<(u32, Time)>, Excluded>;

    /// Returns the cost of each part of an operation, timed alone.
    fn parts(&self, measured: &MeasuredMix<'_>) -> Vec<PartCost>;

    /// Returns the number of operations in one use of the mesh.
    fn operations(&self) -> f64;
}

/// Returns the entry for a run of a program. A program that changes the mesh runs on copies, which are
/// made outside the timing.
pub fn program_entry(column: usize, changes_mesh: bool) -> Entry {
    Entry {
        pauses_clock: changes_mesh,
        ..Entry::of_task(column, Task::Program, RUN)
    }
}

/// Adds the time of the program's own work to each sample.
pub fn with_own_time(samples: Vec<(u32, Time)>, own_ns: f64) -> Vec<(u32, Time)> {
    if own_ns == 0.0 {
        return samples;
    }
    let samples = samples.into_iter();
    samples
        .map(|(round, time)| (round, time.plus_ns(own_ns)))
        .collect()
}

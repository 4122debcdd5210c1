//! The tasks that each backend runs for a workload, and the time of the whole mix, computed from
//! the times of these tasks.

use sixfold::PolygonMesh;
use sixfold::subdivision::{Method, Scheme};
use sixfold_core::Counts;
use sixfold_results::{MIX, PartCost, RUN, Time};
use sixfold_workload::{Action, Operation, Schedule, Task, Workload};

use crate::engine::measure::Entry;
use crate::labs::pick::backend::Candidate;
use crate::labs::pick::break_even::MeasuredMix;
use sixfold_results::statistics::Median;

/// Parts that a mix contains are also timed alone, to explain the result: in every n-th round.
const PARTS_EVERY: u32 = 3;

/// What the backends of a pick run, and how the time of one operation follows from it.
pub(crate) trait TaskPlan {
    /// Returns the entries to measure: for each task, one for each candidate that has it.
    fn entries(&self, candidates: &[Candidate]) -> Vec<Entry>;

    /// Returns the time of one operation on a candidate, rebuilding included, by round; the reason
    /// if the candidate refuses a task. `entries` are those of the candidate.
    fn mix_times(
        &self,
        candidate: &Candidate,
        entries: &[&Entry],
    ) -> Result<Vec<(u32, Time)>, String>;

    /// Returns the cost of each part of an operation, timed alone.
    fn parts(&self, measured: &MeasuredMix<'_>) -> Vec<PartCost>;

    /// Returns the number of operations in one use of the mesh.
    fn operations(&self) -> f64;
}

/// The schedule of a workload on a mesh, with what is needed to weigh its parts.
pub(crate) struct Tasks<'t> {
    pub(crate) schedule: &'t Schedule,
    /// The part of a building that belongs to one operation.
    pub(crate) rebuilds: f64,
    /// The scheme of `subdivide` on this mesh.
    scheme: Scheme,
    /// The number of operations in one use of the mesh.
    operations: f64,
    /// The time of the program's own work for each operation.
    own_ns: f64,
}

impl<'t> Tasks<'t> {
    pub(crate) fn new(
        workload: &Workload,
        schedule: &'t Schedule,
        polygons: &PolygonMesh,
        counts: &Counts,
    ) -> Self {
        Self {
            schedule,
            rebuilds: workload.rebuilds_per_operation(counts),
            operations: workload.operations_on(counts),
            own_ns: workload.own_ns,
            scheme: match polygons.first_polygon() {
                None => Scheme::Loop,
                Some(_) => Scheme::CatmullClark,
            },
        }
    }

    fn part_entry(&self, column: usize, candidate: &Candidate, part: usize) -> Entry {
        let action = self.schedule.parts[part].action;
        match self.task(candidate, part) {
            Task::Operation(operation) => Entry::new(column, operation),
            task => Entry {
                scans: candidate.scans[part],
                pauses_clock: matches!(action, Action::Edit(_)),
                least_every: match candidate.scans() {
                    true => 1,
                    false => PARTS_EVERY,
                },
                ..Entry::of_task(column, task, action.name())
            },
        }
    }

    /// Returns what a candidate runs for a part: subdivision by its best method.
    pub(crate) fn task(&self, candidate: &Candidate, part: usize) -> Task {
        match self.schedule.parts[part].action {
            Action::Pass(operation) => Task::Operation(operation),
            Action::Subdivide => {
                let method = candidate.method(self.scheme);
                Task::Operation(match self.scheme {
                    Scheme::Loop => Operation::Loop(method),
                    _ => Operation::CatmullClark(method),
                })
            }
            _ => Task::Part(part),
        }
    }
}

impl TaskPlan for Tasks<'_> {
    fn entries(&self, candidates: &[Candidate]) -> Vec<Entry> {
        let mut entries = Vec::new();
        let columns = || candidates.iter().enumerate();
        if self.schedule.on_elements > 0.0 {
            let mixing = columns().filter(|(_, candidate)| !candidate.scans());
            entries.extend(mixing.map(|(column, _)| mix_entry(column, self.schedule)));
        }
        for part in 0..self.schedule.parts.len() {
            entries.extend(columns().map(|(i, candidate)| self.part_entry(i, candidate, part)));
        }
        let rebuilding = u32::from(self.rebuilds == 0.0) * PARTS_EVERY;
        let builds = || {
            entries
                .iter()
                .any(|e| e.operation() == Some(Operation::Build))
        };
        if !builds() {
            entries.extend(columns().map(|(column, _)| Entry {
                least_every: rebuilding.max(1),
                ..Entry::new(column, Operation::Build)
            }));
        }
        entries
    }

    fn mix_times(
        &self,
        candidate: &Candidate,
        entries: &[&Entry],
    ) -> Result<Vec<(u32, Time)>, String> {
        let find = |task: Task| entries.iter().find(|entry| entry.job.task == task);
        let mut terms = Vec::new();
        let mut add = |task: Task, weight: f64| {
            let Some(entry) = find(task).filter(|_| weight > 0.0) else {
                return Ok(());
            };
            match (&entry.refusal, entry.estimate) {
                (Some(refusal), _) => return Err(refusal.clone()),
                (None, Some(estimate)) => terms.push((weight, vec![(0, estimate)])),
                (None, None) => terms.push((weight, entry.times())),
            }
            Ok(())
        };
        let mixes = find(Task::Mix).is_some();
        if let Some(operations) = find(Task::Mix).and_then(|entry| entry.outcome) {
            let each = self.schedule.on_elements / operations.elements.max(1) as f64;
            add(Task::Mix, each)?;
        }
        for (part, &share) in self.schedule.shares.iter().enumerate() {
            let task = self.task(candidate, part);
            if !mixes || task.operation().is_some() {
                add(task, share)?;
            }
        }
        add(Task::Operation(Operation::Build), self.rebuilds)?;
        Ok(with_own_time(sum_by_round(&terms), self.own_ns))
    }

    fn parts(&self, measured: &MeasuredMix<'_>) -> Vec<PartCost> {
        let schedule = self.schedule;
        let cost = |part: usize| {
            let entry = measured.entry(self.task(measured.candidate, part));
            PartCost {
                estimated: entry.is_some_and(|entry| entry.estimate.is_some()),
                operation: schedule.parts[part].action.to_string(),
                share: schedule.shares[part],
                launch_ns: Vec::new(),
                ns: entry.and_then(|entry| {
                    let times = entry.times();
                    let median = Median::from_samples(times.iter().map(|(_, time)| time.ns()));
                    median.map(|m| m.value).or(entry.estimate.map(Time::ns))
                }),
            }
        };
        (0..schedule.parts.len()).map(cost).collect()
    }

    fn operations(&self) -> f64 {
        self.operations
    }
}

/// Returns the entry for turns of a mix.
pub(crate) fn mix_entry(column: usize, schedule: &Schedule) -> Entry {
    Entry {
        pauses_clock: schedule.edits().next().is_some(),
        ..Entry::of_task(column, Task::Mix, MIX)
    }
}

/// Returns the entry for a run of a program. A program that changes the mesh runs on copies, which are
/// made outside the timing.
pub(crate) fn program_entry(column: usize, changes_mesh: bool) -> Entry {
    Entry {
        pauses_clock: changes_mesh,
        ..Entry::of_task(column, Task::Program, RUN)
    }
}

/// Adds the time of the program's own work to each sample.
pub(crate) fn with_own_time(samples: Vec<(u32, Time)>, own_ns: f64) -> Vec<(u32, Time)> {
    if own_ns == 0.0 {
        return samples;
    }
    let samples = samples.into_iter();
    samples
        .map(|(round, time)| (round, time.plus_ns(own_ns)))
        .collect()
}

/// Returns the weighted sum of several series of samples, in the rounds of the longest one. A
/// series without a sample in a round takes part with its last sample before that round, or with
/// its first. Empty if a series is empty.
fn sum_by_round(terms: &[(f64, Vec<(u32, Time)>)]) -> Vec<(u32, Time)> {
    let longest = terms.iter().max_by_key(|(_, samples)| samples.len());
    let rounds = longest.iter().flat_map(|(_, samples)| samples);
    let sum = |round: u32| {
        terms
            .iter()
            .try_fold(None, |sum: Option<Time>, (weight, samples)| {
                let before = samples.iter().rev().find(|(r, _)| *r <= round);
                let (_, time) = before.or(samples.first())?;
                let weighted = time.scaled(*weight);
                Some(Some(sum.map_or(weighted, |sum| sum.plus(weighted))))
            })
    };
    rounds
        .filter_map(|(round, _)| Some((*round, sum(*round)??)))
        .collect()
}

impl Candidate {
    /// Returns the method of subdivision that this candidate uses; relation tables do not subdivide.
    fn method(&self, scheme: Scheme) -> Method {
        let support = self.structure.map(|s| s.info.support(scheme));
        let best = support.and_then(|support| support.default_method());
        best.unwrap_or(Method::Scatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(times: &[(u32, f64)]) -> Vec<(u32, Time)> {
        let time = |&(round, ns): &(u32, f64)| (round, Time::from_wall_ns(ns));
        times.iter().map(time).collect()
    }

    #[test]
    fn a_term_without_a_sample_in_a_round_keeps_its_last_one() {
        let every_round = samples(&[(0, 1.0), (1, 2.0), (2, 3.0), (3, 4.0)]);
        let rare = samples(&[(1, 100.0), (3, 200.0)]);
        let sums = sum_by_round(&[(10.0, every_round.clone()), (0.5, rare)]);
        let expected = [(0, 60.0), (1, 70.0), (2, 80.0), (3, 140.0)];
        assert_eq!(sums, samples(&expected));
        assert_eq!(sum_by_round(&[(1.0, every_round), (1.0, Vec::new())]), []);
        assert_eq!(sum_by_round(&[]), []);
    }
}

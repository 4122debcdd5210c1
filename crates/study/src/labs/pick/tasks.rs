//! The tasks that each backend runs for a workload, and the time of the whole mix, computed from
//! the times of these tasks.

use sixfold::PolygonMesh;
use sixfold::subdivision::{Method, Scheme};
use sixfold_core::Counts;
use sixfold_measure::{Operation, Task};
use sixfold_results::{Excluded, MIX, PartCost, Time};
use sixfold_workload::{Action, Schedule, Workload};

use crate::engine::measure::Entry;
use sixfold_measure::pick::{Candidate, MeasuredMix, TaskPlan, with_own_time};
use sixfold_results::statistics::Median;

/// Parts that a mix contains are also timed alone, to explain the result: in every n-th round.
const PARTS_EVERY: u32 = 3;

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
                let method = method(candidate, self.scheme);
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
    ) -> Result<Vec<(u32, Time)>, Excluded> {
        let find = |task: Task| entries.iter().find(|entry| entry.job.task == task);
        let mut terms = Vec::new();
        let mut add = |task: Task, weight: f64| {
            let Some(entry) = find(task).filter(|_| weight > 0.0) else {
                return Ok(());
            };
            match (&entry.refusal, entry.estimate) {
                (Some(refusal), _) => {
                    return Err(Excluded::new(&candidate.name, refusal.clone()));
                }
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

/// Returns the method of subdivision that `candidate` uses; relation tables do not subdivide.
fn method(candidate: &Candidate, scheme: Scheme) -> Method {
    let support = candidate.info.map(|info| info.support(scheme));
    let best = support.and_then(|support| support.default_method());
    best.unwrap_or(Method::Scatter)
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;
    use sixfold_measure::pick::measurement::Evaluation;
    use sixfold_results::ranking::NO_DIFFERENCE;
    use sixfold_results::{Confidence, Ranked};
    use sixfold_workload::built_in;

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

    /// A mix of 9 ns of which the time is only estimated, and mixes of 10 and 20 ns.
    #[test]
    fn estimates_are_compared_with_the_fastest_measured_time_and_come_last() {
        let polygons = shapes::octahedron();
        let counts = polygons.counts(12);
        let workload = built_in("geodesic-dijkstra").expect("a built-in workload");
        let schedule = Schedule::new(&workload, &counts);
        let plan = Tasks::new(&workload, &schedule, &polygons, &counts);
        let times = |ns: f64| {
            (0..5)
                .map(|round| (round, Time::from_wall_ns(ns)))
                .collect()
        };
        let candidate = |name: &str| Candidate {
            name: name.into(),
            info: None,
            made_from: None,
            type_paths: Vec::new(),
            tabulated: Vec::new(),
            scans: vec![false; schedule.parts.len()],
            bytes: 1,
        };
        let [soup, fast, slow] = ["polygon-soup", "half-edge", "face-vertex"].map(candidate);
        let build = Entry {
            samples: times(1000.0),
            ..Entry::new(0, Operation::Build)
        };
        let estimate = Entry {
            estimate: Some(Time::from_wall_ns(9.0)),
            ..Entry::of_task(0, Task::Mix, "mix")
        };
        let mix = |candidate, ns, estimated: bool| MeasuredMix {
            candidate,
            entries: [&build, &estimate][..1 + usize::from(estimated)].to_vec(),
            samples: times(ns),
        };
        let ranking = |measured: &[MeasuredMix<'_>]| {
            let evaluation = Evaluation {
                plan: &plan,
                counts: &counts,
                measured,
                confidence: Confidence::default(),
            };
            evaluation.ranking(NO_DIFFERENCE)
        };
        let rows = ranking(&[
            mix(&soup, 9.0, true),
            mix(&slow, 20.0, false),
            mix(&fast, 10.0, false),
        ]);
        let row = |r: &Ranked| {
            (
                r.backend.clone(),
                (1e6 * r.ratio_to_best).round() / 1e6,
                r.tied_with_best,
                r.estimated,
            )
        };
        let expected = [
            ("half-edge".to_owned(), 1.0, true, false),
            ("face-vertex".to_owned(), 2.0, false, false),
            ("polygon-soup".to_owned(), 0.9, false, true),
        ];
        assert_eq!(rows.iter().map(row).collect::<Vec<_>>(), expected);
        let only = ranking(&[mix(&soup, 9.0, true)]);
        assert!(only[0].estimated && only[0].ratio_to_best == 1.0);
    }
}

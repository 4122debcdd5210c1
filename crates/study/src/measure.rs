//! The measuring loop: rounds until the budget is gone, after the warm-up that plans them.
//!
//! In every round each operation runs on every structure, one right after the other, in an order
//! drawn anew: whatever drifts (frequency, heat, neighbours on the machine) hits all alike, and the
//! ratios formed within a round are nearly free of it. A sample repeats a short operation until the
//! clock can resolve it, after one run that nobody times, so that caches hold what this structure
//! would have there.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use crate::candidate::{Job, Outcome, Run, Subject};
use crate::clock::{Clock, Time};
use crate::operation::Operation;

/// No interval gets much better by more rounds than these.
const MOST_ROUNDS: u32 = 200;
/// Runs longer than this fill the caches by themselves.
pub(crate) const LONG_RUN_NS: f64 = 10_000_000.0;

/// One operation on one structure: how it is measured, and what came out.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Which of the subjects.
    pub(crate) subject: usize,
    /// What is run.
    pub(crate) job: Job,
    /// How often in a row, for one sample.
    pub(crate) runs: u32,
    /// It takes part in every so-manieth round; in none if 0.
    pub(crate) every: u32,
    /// What one sample is thought to take, in nanoseconds of wall time.
    pub(crate) cost_ns: f64,
    /// The warm-up run; `None` until it is over.
    pub(crate) warm_up: Option<Time>,
    /// What the operation found.
    pub(crate) outcome: Option<Outcome>,
    /// Why it is not measured: it would take so long.
    pub(crate) estimate: Option<Time>,
    /// By round: the time of one run.
    pub(crate) samples: Vec<(u32, Time)>,
}

impl Entry {
    pub(crate) fn new(subject: usize, operation: Operation) -> Self {
        let job = Job {
            operation,
            sample: None,
        };
        Self {
            subject,
            job,
            runs: 1,
            every: 1,
            cost_ns: 0.0,
            warm_up: None,
            outcome: None,
            estimate: None,
            samples: Vec::new(),
        }
    }

    /// The samples, or the warm-up run where there was time for nothing else.
    pub(crate) fn times(&self) -> Vec<(u32, Time)> {
        match (&self.samples[..], self.warm_up) {
            ([], Some(time)) if self.estimate.is_none() => vec![(0, time)],
            (samples, _) => samples.to_vec(),
        }
    }
}

/// Where a study stands: shown on a terminal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// The part that is done, from 0 to 1.
    pub done: f64,
    /// What is going on.
    pub stage: &'a str,
    /// What is measured now.
    pub operation: Operation,
    /// On which backend.
    pub backend: &'a str,
}

/// The bench: subjects, clock and budget.
pub(crate) struct Bench<'b, 's> {
    pub(crate) subjects: &'b mut [Box<dyn Subject + 's>],
    /// By kind: how many elements the mesh has.
    pub(crate) population: [usize; 3],
    /// Some valence or degree is so large that walking around it is as bad as a scan.
    pub(crate) skewed: bool,
    pub(crate) clock: &'b dyn Clock,
    pub(crate) budget: Duration,
    pub(crate) random: ChaCha8Rng,
    /// Set by whoever wants the study to end now.
    pub(crate) stop: &'b AtomicBool,
    pub(crate) progress: &'b mut dyn FnMut(Progress<'_>),
}

impl Bench<'_, '_> {
    /// Measures `operations` on all subjects; ends early, with what is finished, when told to stop.
    pub(crate) fn measure(&mut self, operations: &[Operation]) -> Vec<Entry> {
        let start = self.clock.now().wall_ns;
        let deadline = start + self.budget.as_nanos() as f64;
        let subjects = 0..self.subjects.len();
        let mut entries: Vec<Entry> = operations
            .iter()
            .flat_map(|&operation| subjects.clone().map(move |s| Entry::new(s, operation)))
            .collect();
        self.warm_up(&mut entries, deadline);
        self.rounds(&mut entries, start, deadline);
        entries
    }

    /// Whether the study was told to stop.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    pub(crate) fn run(&mut self, subject: usize, job: &Job, runs: u32, check: bool) -> Run {
        self.subjects[subject].run(job, runs, self.clock, check)
    }

    /// Rounds until the next would not end in time; the first leaves out what would not.
    fn rounds(&mut self, entries: &mut [Entry], start: f64, deadline: f64) {
        let mut groups = groups(entries);
        for round in 0..MOST_ROUNDS {
            let costs = entries.iter().filter(|e| takes_part(e, round));
            let cost: f64 = costs.map(|e| e.cost_ns).sum();
            let now = self.clock.now().wall_ns;
            if now >= deadline || (round > 0 && now + cost > deadline) {
                return;
            }
            groups.shuffle(&mut self.random);
            for group in &mut groups {
                group.shuffle(&mut self.random);
                for &entry in &*group {
                    let entry = &mut entries[entry];
                    if !takes_part(entry, round) {
                        continue;
                    }
                    if self.stopped() {
                        return;
                    }
                    let now = self.clock.now().wall_ns;
                    if now + entry.cost_ns > deadline {
                        continue; // a shorter one may still fit
                    }
                    let by_time = (now - start) / (deadline - start);
                    let by_count = f64::from(round) / f64::from(MOST_ROUNDS);
                    self.report(by_time.max(by_count).clamp(0.1, 1.0), "measuring", entry);
                    self.sample(entry, round);
                }
            }
        }
    }

    fn sample(&mut self, entry: &mut Entry, round: u32) {
        let long = entry.warm_up.is_some_and(|time| time.ns() > LONG_RUN_NS);
        if entry.job.sample.is_none() && !long {
            self.run(entry.subject, &entry.job, 1, false);
            if self.stopped() {
                return;
            }
        }
        let run = self.run(entry.subject, &entry.job, entry.runs, false);
        entry.samples.push((round, run.time));
    }

    pub(crate) fn report(&mut self, done: f64, stage: &str, entry: &Entry) {
        (self.progress)(Progress {
            done,
            stage,
            operation: entry.job.operation,
            backend: self.subjects[entry.subject].name(),
        });
    }
}

fn takes_part(entry: &Entry, round: u32) -> bool {
    let wanted = entry.every > 0 && round.is_multiple_of(entry.every);
    wanted && entry.warm_up.is_some() && entry.estimate.is_none()
}

/// The numbers of the entries, those of one operation together.
fn groups(entries: &[Entry]) -> Vec<Vec<usize>> {
    let numbers: Vec<usize> = (0..entries.len()).collect();
    let same = |&a: &usize, &b: &usize| entries[a].job.operation == entries[b].job.operation;
    numbers.chunk_by(same).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::rc::Rc;

    use rand_chacha::rand_core::SeedableRng;
    use sixfold::{QueryCost, Relation};

    use super::*;
    use crate::plan::FEWEST_ELEMENTS;
    use crate::statistics::Median;

    /// A machine that slows down by half, jumps, and stutters; time passes only while it works.
    #[derive(Clone, Default)]
    struct Machine {
        ns: Rc<Cell<f64>>,
        work: Rc<Cell<u64>>,
    }

    impl Machine {
        fn work(&self, ns: f64) {
            let steps = self.work.get() + 1;
            self.work.set(steps);
            let drift = 1.0 + 0.5 * (steps as f64 / 900.0).sin();
            let stutter = if steps.is_multiple_of(17) { 1.6 } else { 1.0 };
            let jump = if (steps / 400).is_multiple_of(2) {
                1.0
            } else {
                1.8
            };
            self.ns.set(self.ns.get() + ns * drift * stutter * jump);
        }
    }

    impl Clock for Machine {
        fn now(&self) -> Time {
            Time {
                cpu_ns: None,
                wall_ns: self.ns.get(),
            }
        }
    }

    /// A structure whose every element costs the same, known, time.
    struct Synthetic {
        machine: Machine,
        ns_per_element: f64,
        elements: usize,
        costs: [QueryCost; 9],
        asked: Rc<Cell<usize>>,
    }

    impl Subject for Synthetic {
        fn name(&self) -> &'static str {
            "synthetic"
        }
        fn costs(&self) -> [QueryCost; 9] {
            self.costs
        }
        fn merged_vertices(&self) -> usize {
            0
        }
        fn bytes(&self) -> usize {
            1
        }
        fn run(&mut self, job: &Job, runs: u32, clock: &dyn Clock, _: bool) -> Run {
            let size = job
                .sample
                .map_or(self.elements, |s| s.size.min(self.elements));
            self.asked.set(self.asked.get().max(size));
            let start = clock.now();
            for _ in 0..runs {
                self.machine.work(self.ns_per_element * size as f64);
            }
            let scale = self.elements as f64 / size as f64 / f64::from(runs);
            Run {
                time: (clock.now() - start).scaled(scale),
                outcome: None,
            }
        }
    }

    const VV: Operation = Operation::Relation(Relation::VertexVertices);

    fn measured(costs_ns: &[f64], scanning: bool, budget: Duration, stop: bool) -> Vec<Entry> {
        bench(costs_ns, scanning, budget, stop, false).0
    }

    /// What was measured, and how long that took.
    fn bench(
        costs_ns: &[f64],
        scanning: bool,
        budget: Duration,
        stop: bool,
        skewed: bool,
    ) -> (Vec<Entry>, Duration) {
        let machine = Machine::default();
        let cost = if scanning {
            QueryCost::Scan
        } else {
            QueryCost::Local
        };
        let subject = |&ns_per_element: &f64| {
            Box::new(Synthetic {
                machine: machine.clone(),
                ns_per_element,
                elements: 10_000,
                costs: [cost; 9],
                asked: Rc::default(),
            }) as Box<dyn Subject>
        };
        let mut subjects: Vec<_> = costs_ns.iter().map(subject).collect();
        let stop = AtomicBool::new(stop);
        let mut bench = Bench {
            subjects: &mut subjects,
            population: [10_000; 3],
            skewed,
            clock: &machine,
            budget,
            random: ChaCha8Rng::seed_from_u64(3),
            stop: &stop,
            progress: &mut |_| (),
        };
        let entries = bench.measure(&[VV, Operation::Circulate, Operation::FfBfs]);
        (entries, Duration::from_nanos(machine.ns.get() as u64))
    }

    fn ratio(entries: &[Entry], a: usize, b: usize) -> Median {
        let pairs = entries[a].samples.iter().zip(&entries[b].samples);
        Median::of(pairs.map(|((_, a), (_, b))| a.ns() / b.ns())).expect("samples")
    }

    #[test]
    fn ratios_within_rounds_survive_a_drifting_machine() {
        let entries = measured(&[7.0, 10.0, 7.1], false, Duration::from_secs(2), false);
        assert!(entries.iter().all(|e| e.samples.len() >= 20), "20 rounds");
        for first in [0, 3, 6] {
            let slower = ratio(&entries, first + 1, first).value;
            assert!((slower / (10.0 / 7.0) - 1.0).abs() < 0.04, "{slower}");
            let alike = ratio(&entries, first + 2, first).value;
            assert!((alike - 1.0).abs() < 0.05, "{alike}");
        }
        // The drift is no straw man: single samples of one entry differ by more than those two costs.
        let own = Median::of(entries[0].samples.iter().map(|(_, t)| t.ns())).expect("samples");
        let most = entries[0]
            .samples
            .iter()
            .map(|(_, t)| t.ns())
            .fold(0.0, f64::max);
        assert!(most / own.least > 10.0 / 7.0, "{most} / {}", own.least);
    }

    #[test]
    fn scans_are_sampled_or_estimated_to_fit_the_budget() {
        // 10,000 elements of 200 µs: 2 s a run, and three operations in a budget of 2 s.
        let entries = measured(&[200_000.0], true, Duration::from_secs(2), false);
        for entry in &entries[..2] {
            let sample = entry.job.sample.expect("a sample");
            assert!(
                (FEWEST_ELEMENTS..2_000).contains(&sample.size),
                "{sample:?}"
            );
            assert!(entry.samples.len() >= 5, "{} rounds", entry.samples.len());
            let ns = Median::of(entry.samples.iter().map(|(_, t)| t.ns())).expect("samples");
            assert!((1e9..1e10).contains(&ns.value), "{ns:?}");
        }
        let estimate = entries[2]
            .estimate
            .expect("a search that scans takes too long");
        assert!((1e9..1e10).contains(&estimate.ns()), "{estimate:?}");
        assert!(entries[2].samples.is_empty() && entries[2].times().is_empty());
        // With time enough nothing is sampled and nothing left out.
        let entries = measured(&[40_000.0], true, Duration::from_secs(200), false);
        assert!(
            entries
                .iter()
                .all(|e| e.job.sample.is_none() && e.samples.len() >= 5)
        );
    }

    #[test]
    fn a_skewed_mesh_is_sampled_on_whatever_structure() {
        // 2 s a run on each of three structures that do not scan: six operations walk around.
        let costs = [200_000.0; 3];
        let budget = Duration::from_secs(2);
        let (entries, took) = bench(&costs, false, budget, false, true);
        assert!(took < budget * 3 / 2, "{took:?}");
        for entry in &entries[..6] {
            assert!(entry.job.sample.is_some() && !entry.times().is_empty());
        }
        assert!(entries[6..].iter().all(|e| e.estimate.is_some()));
        // What is cheap is run in full there too.
        let (entries, _) = bench(&[7.0], false, budget, false, true);
        assert!(entries.iter().all(|e| e.job.sample.is_none()));
        assert!(entries.iter().all(|e| e.samples.len() >= 5));
        // Nothing was gained where the mesh is not skewed: this is what the samples save.
        let (_, took) = bench(&costs, false, budget, false, false);
        assert!(took > budget * 5, "{took:?}");
    }

    #[test]
    fn a_search_that_fits_the_budget_once_is_run_once() {
        // 1 s a run: too long for rounds within 5 s, and yet no reason to leave it out.
        let (entries, took) = bench(&[100_000.0], true, Duration::from_secs(6), false, false);
        let search = &entries[2];
        assert!(search.estimate.is_none() && search.samples.is_empty());
        assert_eq!(search.times().len(), 1);
        assert!(took < Duration::from_secs(8), "{took:?}");
        assert!(
            entries[0].samples.len() >= 5,
            "the others keep their rounds"
        );
    }

    #[test]
    fn a_stopped_study_ends_at_once_and_a_spent_budget_keeps_the_warm_up() {
        let entries = measured(&[7.0, 9.0], false, Duration::from_secs(1), true);
        assert!(entries.iter().all(|e| e.times().is_empty()));
        let entries = measured(&[7.0, 9.0], false, Duration::from_nanos(1), false);
        assert!(entries.iter().all(|e| e.times().len() == 1));
    }
}

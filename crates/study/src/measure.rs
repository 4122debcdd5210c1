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

use workload::Operation;
use workload::{Clock, Time};
use workload::{Job, Outcome, Run, Subject};

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
    /// It is only estimated because nobody asked for it by name: there would be time for it.
    pub(crate) by_name_only: bool,
    /// Why it cannot be done on this structure or mesh.
    pub(crate) refusal: Option<String>,
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
            by_name_only: false,
            refusal: None,
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

    /// How long the shortest sample took between two looks at the clock, all its runs together.
    pub(crate) fn shortest_sample_ns(&self) -> Option<f64> {
        // A sample of the elements is scaled up to stand for all: how long it took is not kept.
        let whole = self.samples.iter().filter(|_| self.job.sample.is_none());
        let runs = f64::from(self.runs);
        let times = whole.map(|(_, time)| time.ns() * runs);
        times.min_by(f64::total_cmp)
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
    /// Which of the subjects is another a second time, and makes no meshes: for the control.
    pub(crate) control: Option<usize>,
    /// By kind: how many elements the mesh has.
    pub(crate) population: [usize; 3],
    /// Some valence or degree is so large that walking around it is as bad as a scan.
    pub(crate) skewed: bool,
    pub(crate) clock: &'b dyn Clock,
    pub(crate) budget: Duration,
    /// The operations were asked for by name.
    pub(crate) named: bool,
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
        let mut entries = Vec::new();
        for &operation in operations {
            let takes_part = |s: &usize| self.control != Some(*s) || !operation.makes_a_mesh();
            let subjects = (0..self.subjects.len()).filter(takes_part);
            entries.extend(subjects.map(|s| Entry::new(s, operation)));
        }
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
        if entry.job.sample.is_none() && !long && !entry.job.operation.readies_itself() {
            self.run(entry.subject, &entry.job, 1, false);
            if self.stopped() {
                return;
            }
        }
        let run = self.run(entry.subject, &entry.job, entry.runs, false);
        // A program of somebody else may fail at any time.
        match run.refusal {
            None => entry.samples.push((round, run.time)),
            refusal => entry.refusal = refusal,
        }
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
    let can = entry.warm_up.is_some() && entry.refusal.is_none();
    wanted && can && entry.estimate.is_none()
}

/// The numbers of the entries, those of one operation together.
fn groups(entries: &[Entry]) -> Vec<Vec<usize>> {
    let numbers: Vec<usize> = (0..entries.len()).collect();
    let same = |&a: &usize, &b: &usize| entries[a].job.operation == entries[b].job.operation;
    numbers.chunk_by(same).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests;

//! The measuring loop: rounds until the budget is gone, after the warm-up that plans them.
//!
//! In every round each operation runs on every structure, one right after the other, in an order
//! drawn anew: whatever drifts (frequency, heat, neighbours on the machine) hits all alike, and the
//! ratios formed within a round are nearly free of it. A sample repeats a short operation until the
//! clock can resolve it, after about as much work that is not timed, so that caches hold what this
//! structure would have there. Between rounds, as far as time allows, all structures are built again
//! elsewhere in memory, so that the places of their tables differ. What allocates is measured a second
//! time at the end, on fresh pages.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use crate::gauge::{Gauge, Verdict, undisturbed};
use crate::heap::Memory;
use crate::statistics::Median;
use workload::Operation;
use workload::pages;
use workload::{Clock, Time};
use workload::{Job, LONG_ENOUGH_NS, Outcome, Run, Series, Start, Subject};

/// No interval gets much better by more rounds than these.
const MOST_ROUNDS: u32 = 200;
/// What samples on fresh pages may take of the budget.
const FIRST_TIMES: f64 = 0.1;
/// No figure gets much better by more samples on fresh pages than these.
const MOST_FIRST_TIMES: u32 = 9;
/// What building the structures again and again may take of the time.
const REBUILDING: f64 = 0.04;
/// A structure is built behind a gap of up to this many bytes.
const LARGEST_GAP: usize = 64 << 10;
/// More runs than these make no sample better.
pub(crate) const MOST_RUNS: f64 = 1e7;
/// Runs longer than this fill the caches by themselves.
pub(crate) const LONG_RUN_NS: f64 = 10_000_000.0;

/// One operation on one structure: how it is measured, and what came out.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Which of the subjects.
    pub(crate) subject: usize,
    /// What is run.
    pub(crate) job: Job,
    /// How often it is run before the clock starts.
    pub(crate) untimed: u32,
    /// How often in a row, for one sample.
    pub(crate) runs: u32,
    /// It takes part in every n-th round; in none if 0.
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
    /// By sample: the larger slowdown of the [`Gauge`] before and after it.
    pub(crate) slowdowns: Vec<f64>,
    /// Its last sample was disturbed: it takes part in the next round, too.
    pub(crate) owed: bool,
    /// How many samples were taken again because pages faulted in them, or the machine was disturbed.
    pub(crate) retaken: u32,
    /// The times of one run each, on fresh pages and tables, and of one as in a sample right after.
    pub(crate) first_times: Vec<[Time; 2]>,
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
            untimed: 1,
            runs: 1,
            every: 1,
            cost_ns: 0.0,
            warm_up: None,
            outcome: None,
            estimate: None,
            by_name_only: false,
            refusal: None,
            samples: Vec::new(),
            slowdowns: Vec::new(),
            owed: false,
            retaken: 0,
            first_times: Vec::new(),
        }
    }

    /// The time of the first run: the median, times the median of how much longer the first run takes.
    pub(crate) fn first_ns(&self) -> Option<f64> {
        let median = Median::of(self.times().iter().map(|(_, time)| time.ns()))?;
        let ratio = |[first, later]: &[Time; 2]| first.ns() / later.ns().max(1.0);
        Some(median.value * Median::of(self.first_times.iter().map(ratio))?.value)
    }

    /// What measuring one first time is expected to take: three runs with what is set up for them.
    fn first_time_cost_ns(&self) -> f64 {
        3.0 * self.cost_ns / f64::from(self.runs + self.untimed)
    }

    /// Whether what it allocates is new to the process the first time.
    fn has_a_first_time(&self) -> bool {
        let measured = !self.samples.is_empty() && self.job.sample.is_none();
        measured && self.job.operation.allocates()
    }

    /// The samples that count, or the warm-up run where there was time for nothing else.
    pub(crate) fn times(&self) -> Vec<(u32, Time)> {
        match (&self.samples[..], self.warm_up) {
            ([], Some(time)) if self.estimate.is_none() => vec![(0, time)],
            (samples, _) => undisturbed(samples, &self.slowdowns),
        }
    }

    /// How long the shortest stretch between two readings of the clock took: a sample, or a part of it
    /// where the clock stops between runs.
    pub(crate) fn shortest_sample_ns(&self) -> Option<f64> {
        // A sample of the elements is scaled up to stand for all: how long it took is not kept.
        let whole = self.samples.iter().filter(|_| self.job.sample.is_none());
        let shortest = whole.map(|(_, time)| time.ns()).min_by(f64::total_cmp)?;
        let sample = shortest * f64::from(self.runs);
        Some(match self.job.operation.stops_the_clock() {
            true => shortest.max(sample.min(LONG_ENOUGH_NS)),
            false => sample,
        })
    }
}

/// How often `operation`, of which a run takes `ns`, is run before the clock starts: at least once, and for
/// up to `most_ns`, so that caches and branch predictors are as in a program that does nothing else, and
/// tables have their size; not at all where a run does all that by itself, and no tables grow.
pub(crate) fn untimed_runs(operation: Operation, ns: f64, most_ns: f64) -> u32 {
    match ns > LONG_RUN_NS {
        true => u32::from(operation.grows_tables()),
        false => (most_ns / ns.max(0.1)).clamp(1.0, MOST_RUNS) as u32,
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
    /// Which of the subjects is another a second time, for the control.
    pub(crate) control: Option<usize>,
    /// By kind: how many elements the mesh has.
    pub(crate) population: [usize; 3],
    /// Some valence or degree is so large that walking around it is as bad as a scan.
    pub(crate) skewed: bool,
    pub(crate) clock: &'b dyn Clock,
    /// The heap and the caches.
    pub(crate) memory: &'b mut Memory,
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
            entries.extend((0..self.subjects.len()).map(|s| Entry::new(s, operation)));
        }
        // What is built in the warm-up may be all that there is time for.
        let largest = self.subjects.iter().map(|subject| subject.bytes()).max();
        self.memory.reserve_for(2 * largest.unwrap_or(0) as u64);
        self.warm_up(&mut entries, deadline);
        self.memory.reserve();
        let allocates = operations.iter().any(|operation| operation.allocates());
        let fresh_pages = pages::can_give_back() && !self.memory.is_cold();
        let for_first_times = match allocates && fresh_pages {
            true => FIRST_TIMES * self.budget.as_nanos() as f64,
            false => 0.0,
        };
        self.rounds(&mut entries, start, deadline - for_first_times);
        // Last, for the pages that it gives back are those that samples would find.
        if for_first_times > 0.0 {
            self.first_times(&mut entries, deadline);
        }
        entries
    }

    /// Whether the study was told to stop.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Runs `job` with caches as the settings ask for: `untimed` runs, then `runs` timed ones.
    pub(crate) fn run(
        &mut self,
        subject: usize,
        job: &Job,
        [untimed, runs]: [u32; 2],
        check: bool,
    ) -> Run {
        let series = Series {
            untimed,
            runs,
            start: self.memory.start_of_runs(),
            check,
            clock: self.clock,
        };
        self.subjects[subject].run(job, &series)
    }

    /// Rounds until the next would not end in time; the first leaves out what would not.
    fn rounds(&mut self, entries: &mut [Entry], start: f64, deadline: f64) {
        let mut groups = groups(entries);
        let mut gauge = Gauge::new(self.budget.as_nanos() as f64);
        // Until one is timed: a structure is built and touched at about one byte in a nanosecond.
        let mut rebuild_ns: f64 = self.subjects.iter().map(|s| s.bytes() as f64).sum();
        let mut rebuilding_ns = 0.0;
        for round in 0..MOST_ROUNDS {
            self.memory.watch();
            let costs = entries.iter().filter(|e| takes_part(e, round));
            let cost: f64 = costs.map(|e| e.cost_ns).sum();
            let now = self.clock.now().wall_ns;
            let over = now >= deadline || (round > 0 && now + cost > deadline);
            if over || self.stopped() || !entries.iter().any(can_take_part) {
                return;
            }
            let in_time = now + rebuild_ns + cost <= deadline;
            let affordable = rebuilding_ns + rebuild_ns <= REBUILDING * (now - start);
            if round > 0 && in_time && affordable && self.has_room_to_rebuild() {
                self.rebuild();
                rebuild_ns = self.clock.now().wall_ns - now;
                rebuilding_ns += rebuild_ns;
            }
            groups.shuffle(&mut self.random);
            for group in &mut groups {
                group.shuffle(&mut self.random);
                // All of an operation together: ratios are formed within rounds.
                let owed = group.iter().any(|&entry| entries[entry].owed);
                for &entry in &*group {
                    let entry = &mut entries[entry];
                    let wanted = takes_part(entry, round) || (owed && can_take_part(entry));
                    if !wanted {
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
                    self.sample(&mut gauge, entry, round);
                }
            }
        }
    }

    /// Whether another copy of the largest structure, with its outputs, fits into the free memory.
    fn has_room_to_rebuild(&self) -> bool {
        let largest = self.subjects.iter().map(|subject| subject.bytes()).max();
        self.memory.has_room_for(2 * largest.unwrap_or(0) as u64)
    }

    /// Builds all structures again, each elsewhere in memory, where pages are kept on pages that the kernel
    /// chooses anew. Tables stay where they are between two such moments, and with them whatever their places
    /// cost or save.
    fn rebuild(&mut self) {
        let mut order: Vec<usize> = (0..self.subjects.len()).collect();
        order.shuffle(&mut self.random);
        for subject in order {
            if self.stopped() {
                return;
            }
            self.memory.give_back();
            let gap: Vec<u8> = Vec::with_capacity(self.random.random_range(0..LARGEST_GAP));
            self.subjects[subject].rebuild();
            drop(black_box(gap));
        }
        self.memory.reserve();
    }

    /// Takes a sample. An external program may refuse at any time.
    fn sample(&mut self, gauge: &mut Gauge, entry: &mut Entry, round: u32) {
        let (stop, kept) = (self.stop, self.memory.keeps_pages());
        let runs = [entry.untimed, entry.runs];
        let taken = gauge.take(
            self.clock,
            || self.run(entry.subject, &entry.job, runs, false),
            |run| match run.refusal.is_some() || stop.load(Ordering::Relaxed) {
                true => Verdict::Final,
                false => Verdict::on_faults(run.time, kept),
            },
        );
        entry.retaken += taken.retaken;
        match taken.value.refusal {
            None => {
                entry.samples.push((round, taken.value.time));
                entry.slowdowns.push(taken.slowdown);
                entry.owed = taken.disturbed;
            }
            refusal => {
                entry.refusal = refusal;
                entry.owed = false;
            }
        }
    }

    /// Measures what allocates on fresh pages, one run a sample, in rounds, while there is time. Right after
    /// each comes a run as in any sample: the ratio of the two does not depend on how fast the machine is
    /// at that time.
    fn first_times(&mut self, entries: &mut [Entry], deadline: f64) {
        let control = self.control;
        let mut entries: Vec<&mut Entry> = entries
            .iter_mut()
            .filter(|entry| entry.has_a_first_time() && Some(entry.subject) != control)
            .filter(|entry| !self.subjects[entry.subject].is_external())
            .collect();
        for _ in 0..MOST_FIRST_TIMES {
            entries.shuffle(&mut self.random);
            for entry in &mut entries {
                let now = self.clock.now().wall_ns;
                if self.stopped() {
                    return;
                }
                if now + entry.first_time_cost_ns() > deadline {
                    continue; // a shorter one may still fit
                }
                self.report(1.0, "first times", entry);
                let series = Series {
                    start: Start::FreshPages,
                    ..Series::once(self.clock)
                };
                let first = self.subjects[entry.subject].run(&entry.job, &series);
                let later = self.run(entry.subject, &entry.job, [1, 1], false);
                if first.refusal.is_none() && later.refusal.is_none() {
                    entry.first_times.push([first.time, later.time]);
                }
            }
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
    can_take_part(entry) && round.is_multiple_of(entry.every)
}

/// Whether it is run in rounds at all.
fn can_take_part(entry: &Entry) -> bool {
    let can = entry.warm_up.is_some() && entry.refusal.is_none();
    can && entry.every > 0 && entry.estimate.is_none()
}

/// The numbers of the entries, those of one operation together.
fn groups(entries: &[Entry]) -> Vec<Vec<usize>> {
    let numbers: Vec<usize> = (0..entries.len()).collect();
    let same = |&a: &usize, &b: &usize| entries[a].job.operation == entries[b].job.operation;
    numbers.chunk_by(same).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests;

//! The measuring loop: a warm-up that plans the samples, then rounds until the budget is spent, or
//! until a fixed number of rounds is done.
//!
//! In each round, operations run on every structure, in random order. Slow operations take part
//! only in some rounds. Slow changes of the machine (frequency, heat, other programs) then affect
//! all structures alike. These changes hardly affect the ratios of times within a round.
//!
//! A sample repeats a short operation until the clock can resolve the time. Before the sample,
//! untimed runs bring the data of the structure into the caches.
//!
//! If there is time, all structures are built again between rounds, at other addresses. After the
//! last round, operations that are too long for the rounds run once, if there is time. At the end,
//! operations that allocate are also measured on fresh memory pages.

use std::hint::black_box;
use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, Ordering};

use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;

use crate::Operation;
use crate::engine::disturbance::{DisturbanceDetector, Verdict};
use crate::engine::effort::Effort;
use crate::engine::heap::Memory;
use crate::engine::machine::Machine;
use crate::{
    Clock, Job, MIN_TIMED_NS, Outcome, Series, Start, Task, TimedBackend, TimedRun,
    exceeds_second_level,
};
use sixfold_core::Counts;
use sixfold_results::ranking::FEWEST_OF_A_WINNER;
use sixfold_results::statistics::{Median, undisturbed};
use sixfold_results::{RefusalKind, Samples, Time};

/// Maximum number of rounds.
const MAX_ROUNDS: u32 = 200;
/// The first rounds, in which also slow entries take part, may cost this part of the time left.
const FULL_ROUNDS_SHARE: f64 = 0.75;
/// Part of the budget for the samples on fresh pages.
const FIRST_TIMES_SHARE: f64 = 0.1;
/// Part of the budget for runs that are too long for the rounds, if there are such runs. They come after the rounds, in
/// which the fastest backends are decided. An operation that was requested by name gets more time.
const ESTIMATED_SHARE: f64 = 0.2;
pub const ESTIMATED_NAMED_SHARE: f64 = 0.4;
/// Maximum number of samples on fresh pages.
const MAX_FIRST_TIMES: u32 = 9;
/// Part of the elapsed time for building the structures again.
const REBUILDING_SHARE: f64 = 0.04;
/// The structures are built again before every n-th round, if the number of rounds is fixed.
const REBUILD_EVERY: u32 = 5;
/// Maximum size of the gap allocated before a structure is built again, in bytes.
const LARGEST_GAP: usize = 64 << 10;
/// Maximum number of runs in one sample.
pub const MAX_RUNS: f64 = 1e7;
/// Minimum time of a run that fills the caches without untimed runs, in nanoseconds.
pub const LONG_RUN_NS: f64 = 10_000_000.0;
/// Limits of the additional untimed runs for a structure larger than the second-level cache.
const LARGE_WARM_UP_RUNS: u32 = 4;
const LARGE_WARM_UP_NS: f64 = 20_000_000.0;

/// One task on one backend: the plan of its measurement, and the results.
#[derive(Clone, Debug)]
pub struct Entry {
    pub subject: usize,
    pub job: Job,
    /// The name of the task.
    pub name: &'static str,
    /// The kind of the elements that the task visits.
    pub per: &'static str,
    /// The case in which the backend is measured, such as an order of the mesh; empty without cases.
    pub case: &'static str,
    /// Whether a run of a task of a mix scans all faces. Operations are planned by the costs of
    /// their relations instead.
    pub scans: bool,
    /// Cost of one element of a run, in visits of an element. Only a task that neither scans nor makes
    /// elements is planned by it.
    pub visits: f64,
    /// Number of queries of a run, if a run may answer a part of them; otherwise 0.
    pub queries: usize,
    /// Whether the clock stops between runs of the task.
    pub pauses_clock: bool,
    /// The entry takes part in every n-th round at most.
    pub least_every: u32,
    /// Number of runs before the clock starts.
    pub untimed: u32,
    /// Number of timed runs in one sample.
    pub runs: u32,
    /// The entry takes part in every n-th round; never if `every` is 0.
    pub every: u32,
    /// Expected wall time of one sample, in nanoseconds.
    pub cost_ns: f64,
    /// Time of the warm-up run; `None` before the warm-up.
    pub warm_up: Option<Time>,
    pub outcome: Option<Outcome>,
    /// Estimated time of an operation that takes too long to be measured.
    pub estimate: Option<Time>,
    /// Whether the time is an estimate because the user did not name the operation.
    pub by_name_only: bool,
    /// Why the operation has no result on this structure and mesh.
    pub refusal: Option<String>,
    /// The kind of `refusal`. It has no meaning without a refusal.
    pub refusal_kind: RefusalKind,
    /// For each sample, its round and the time of one run.
    pub samples: Vec<(u32, Time)>,
    /// For each sample, the larger of the slowdowns before and after the sample, as measured by
    /// [`DisturbanceDetector`].
    pub slowdowns: Vec<f64>,
    /// Whether the last sample was disturbed. If so, the entry takes part in the next round.
    pub repeat_next: bool,
    /// Number of samples taken again because of page faults or disturbance.
    pub retaken: u32,
    /// Pairs of times: a run on fresh pages, and a normal run directly after it.
    pub first_times: Vec<[Time; 2]>,
}

impl Entry {
    /// Returns the samples for the results; `None` if the entry was not sampled. `control` tells whether
    /// the samples belong to the second copy of the control.
    pub fn to_samples(&self, backend: &str, control: bool) -> Option<Samples> {
        if self.samples.is_empty() {
            return None;
        }
        let times = || self.samples.iter().map(|(_, time)| time);
        Some(Samples {
            case: self.case.to_owned(),
            backend: backend.to_owned(),
            operation: self.name.to_owned(),
            control,
            launches: Vec::new(),
            rounds: self.samples.iter().map(|(round, _)| *round).collect(),
            cpu_ns: times().map(|time| time.cpu_ns).collect(),
            wall_ns: times().map(|time| time.wall_ns).collect(),
            faults: times().map(|time| time.faults).collect(),
            slowdowns: self.slowdowns.clone(),
            first_ns: self
                .first_times
                .iter()
                .map(|[first, _]| first.ns())
                .collect(),
        })
    }

    /// Creates an entry for an operation that is not planned yet.
    pub fn new(subject: usize, operation: Operation) -> Self {
        Self {
            pauses_clock: operation.pauses_clock(),
            per: operation.unit(),
            ..Self::of_task(subject, Task::Operation(operation), operation.name())
        }
    }

    /// Creates an entry for a task that is not planned yet.
    pub fn of_task(subject: usize, task: Task, name: &'static str) -> Self {
        Self {
            subject,
            job: Job::new(task),
            name,
            per: "",
            case: "",
            scans: false,
            visits: 1.0,
            queries: 0,
            pauses_clock: false,
            least_every: 1,
            untimed: 1,
            runs: 1,
            every: 1,
            cost_ns: 0.0,
            warm_up: None,
            outcome: None,
            estimate: None,
            by_name_only: false,
            refusal: None,
            refusal_kind: RefusalKind::Impossible,
            samples: Vec::new(),
            slowdowns: Vec::new(),
            repeat_next: false,
            retaken: 0,
            first_times: Vec::new(),
        }
    }

    /// Returns the operation; `None` for a task of a mix.
    pub fn operation(&self) -> Option<Operation> {
        self.job.task.operation()
    }

    /// Returns the time of a first run: the median time multiplied by the median ratio of first
    /// runs to the runs right after them.
    pub fn first_ns(&self) -> Option<f64> {
        let median = Median::from_samples(self.times().iter().map(|(_, time)| time.ns()))?;
        let ratio = |[first, later]: &[Time; 2]| first.ns() / later.ns().max(1.0);
        Some(median.value * Median::from_samples(self.first_times.iter().map(ratio))?.value)
    }

    fn first_time_cost_ns(&self) -> f64 {
        3.0 * self.cost_ns / f64::from(self.runs + self.untimed)
    }

    /// Returns whether first runs can be measured. The operation must allocate and must not be
    /// sampled.
    fn has_first_time(&self) -> bool {
        let measured = !self.samples.is_empty() && self.job.sample.is_none();
        measured && self.job.task.allocates()
    }

    /// Returns whether the time was measured or estimated. Otherwise the task was refused, or the
    /// measurement was stopped before.
    pub fn has_time(&self) -> bool {
        self.estimate.is_some() || !self.times().is_empty()
    }

    /// Returns whether the only time is that of the warm-up run.
    pub fn is_warm_up_only(&self) -> bool {
        self.samples.is_empty() && self.warm_up.is_some()
    }

    /// Returns the samples that count. If there are no samples, returns the warm-up run.
    pub fn times(&self) -> Vec<(u32, Time)> {
        match (&self.samples[..], self.warm_up) {
            ([], Some(time)) if self.estimate.is_none() => vec![(0, time)],
            (samples, _) => undisturbed(samples, &self.slowdowns),
        }
    }

    /// Returns the shortest time between two readings of the clock, in nanoseconds.
    pub fn shortest_sample_ns(&self) -> Option<f64> {
        // Times of sampled elements are scaled to the whole mesh. The original time is not kept.
        let whole = self.samples.iter().filter(|_| self.job.sample.is_none());
        let shortest = whole.map(|(_, time)| time.ns()).min_by(f64::total_cmp)?;
        let sample = shortest * f64::from(self.runs);
        Some(match self.pauses_clock {
            true => shortest.max(sample.min(MIN_TIMED_NS)),
            false => sample,
        })
    }
}

/// Returns the number of untimed runs of `task` before a sample, if one run takes `ns`. There
/// is at least one, and together they take up to `most_ns`. They fill caches, branch predictors and
/// tables as in a program that does nothing else. A run longer than 10 ms does this by itself. It
/// gets one untimed run if tables grow, else none.
///
/// If the structure is `large`, that is, larger than the second-level cache, there may be up to
/// four runs even if they take longer than `most_ns`. The third-level cache keeps data only after
/// it was read several times.
pub fn untimed_runs(task: Task, ns: f64, most_ns: f64, large: bool) -> u32 {
    if ns > LONG_RUN_NS {
        return u32::from(task.grows_tables());
    }
    let fit = |time_ns: f64| (time_ns / ns.max(0.1)).clamp(1.0, MAX_RUNS) as u32;
    let least = match large {
        true => fit(LARGE_WARM_UP_NS).min(LARGE_WARM_UP_RUNS),
        false => 1,
    };
    fit(most_ns).max(least)
}

/// The progress of a measurement, for display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// The finished part of the measurement, from 0 to 1.
    pub done: f64,
    /// The name of the current stage, such as `warming up`.
    pub stage: &'a str,
    /// The name of the operation that is measured now.
    pub task: &'a str,
    /// The name of the backend that is measured now.
    pub backend: &'a str,
}

impl Progress<'_> {
    /// Returns the current step as text.
    pub fn step(&self) -> String {
        let Self {
            stage,
            task,
            backend,
            ..
        } = self;
        format!("{stage} {task} on {backend}")
    }
}

/// A trial that is measured now, on its bench.
pub struct Measurement<'m, 's> {
    pub machine: &'m dyn Machine,
    pub memory: &'m mut Memory,
    pub stop: &'m AtomicBool,
    pub progress: &'m mut dyn FnMut(Progress<'_>),
    pub counts: Counts,
    pub skewed: bool,
    pub effort: Effort,
    pub named: bool,
    pub forced: bool,
    pub untimed: Option<u32>,
    pub random: ChaCha8Rng,
    pub subjects: &'m mut [Box<dyn TimedBackend + 's>],
    /// Index of the second copy of the backend that is measured twice.
    pub control: Option<usize>,
}

impl<'m> Measurement<'m, '_> {
    /// Measures `entries`; those of the same task must be adjacent. Returns early, with the
    /// finished part, if `stop` is set.
    pub fn measure(&mut self, mut entries: Vec<Entry>) -> Vec<Entry> {
        let start = self.clock().now().wall_ns;
        let limit_ns = self.effort.limit_ns();
        let deadline = start + limit_ns;
        // Reserve for the warm-up: its runs may be the only ones that fit the budget.
        let largest = self.subjects.iter().map(|subject| subject.bytes()).max();
        self.memory.reserve_for(2 * largest.unwrap_or(0) as u64);
        match self.effort {
            Effort::Budget(_) => self.warm_up(&mut entries, deadline),
            Effort::Rounds(_) => self.plan_by_count(&mut entries),
        }
        if let Some(untimed) = self.untimed {
            for entry in &mut entries {
                let run_ns = entry.cost_ns / f64::from(entry.untimed + entry.runs);
                entry.cost_ns = run_ns * f64::from(untimed + entry.runs);
                entry.untimed = untimed;
            }
        }
        self.memory.reserve();
        let allocates = entries.iter().any(|entry| entry.job.task.allocates());
        let memory = &self.memory;
        let fresh_pages = memory.can_release_pages() && !memory.is_cold();
        let first_times = allocates && fresh_pages;
        let for_runs = match first_times {
            true => (1.0 - FIRST_TIMES_SHARE) * limit_ns,
            false => limit_ns,
        };
        let estimated = entries.iter().any(|entry| entry.estimate.is_some());
        let for_estimated = match (estimated, self.named) {
            (false, _) => 0.0,
            (true, false) => ESTIMATED_SHARE,
            (true, true) => ESTIMATED_NAMED_SHARE,
        };
        self.rounds(
            &mut entries,
            start,
            start + (1.0 - for_estimated) * for_runs,
        );
        self.run_estimated(&mut entries, start + for_runs);
        // First runs come last, because they return pages to the kernel. Other samples would reuse
        // these pages.
        if first_times {
            self.first_times(&mut entries, deadline);
        }
        entries
    }

    /// Returns the clock of all times.
    pub fn clock(&self) -> &'m dyn Clock {
        self.machine.clock()
    }

    /// Returns the numbers of vertices, edges and faces.
    pub fn population(&self) -> [usize; 3] {
        let Counts {
            vertices,
            edges,
            faces,
            ..
        } = self.counts;
        [vertices, edges, faces]
    }

    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Runs `job` `untimed` times without the clock, then `runs` times with the clock.
    pub fn run(
        &mut self,
        subject: usize,
        job: &Job,
        [untimed, runs]: [u32; 2],
        check: bool,
    ) -> TimedRun {
        let series = Series {
            untimed,
            runs,
            start: self.memory.start_of_runs(),
            check,
            clock: self.clock(),
        };
        self.subjects[subject].run(job, &series)
    }

    /// Runs rounds until the next round would exceed the time. The first round always starts, but
    /// leaves out entries that would exceed the time. If the number of rounds is fixed, runs all of
    /// them, and takes a sample again only because of page faults.
    fn rounds(&mut self, entries: &mut [Entry], start: f64, deadline: f64) {
        let mut groups = groups(entries);
        let fixed = self.effort.rounds();
        let rounds = fixed.map_or(MAX_ROUNDS, NonZeroU32::get);
        let work = self.machine.reference_work();
        let mut detector = match fixed {
            None => DisturbanceDetector::new(self.effort.limit_ns(), work),
            Some(_) => DisturbanceDetector::without_waiting(work),
        };
        // First estimate: building and touching a structure takes 1 ns per byte.
        let mut rebuild_ns: f64 = self.subjects.iter().map(|s| s.bytes() as f64).sum();
        let mut rebuilding_ns = 0.0;
        let full_rounds = full_rounds(entries, deadline - self.clock().now().wall_ns);
        for round in 0..rounds {
            self.memory.check_free_memory();
            let takes_part = |entry: &Entry| takes_part(entry, round, full_rounds);
            let costs = entries.iter().filter(|e| takes_part(e));
            let cost: f64 = costs.map(|e| e.cost_ns).sum();
            let now = self.clock().now().wall_ns;
            let over = now >= deadline || (round > 0 && now + cost > deadline);
            if over || self.stopped() || !entries.iter().any(can_take_part) {
                return;
            }
            let in_time = now + rebuild_ns + cost <= deadline;
            let affordable = match fixed {
                None => rebuilding_ns + rebuild_ns <= REBUILDING_SHARE * (now - start),
                Some(_) => round.is_multiple_of(REBUILD_EVERY),
            };
            if round > 0 && in_time && affordable && self.has_room_to_rebuild() {
                self.rebuild();
                rebuild_ns = self.clock().now().wall_ns - now;
                rebuilding_ns += rebuild_ns;
            }
            groups.shuffle(&mut self.random);
            for group in &mut groups {
                group.shuffle(&mut self.random);
                // Repeat all entries of an operation together, because ratios are formed within
                // rounds.
                let repeat_next = group.iter().any(|&entry| entries[entry].repeat_next);
                for &entry in &*group {
                    let entry = &mut entries[entry];
                    let wanted = takes_part(entry) || (repeat_next && can_take_part(entry));
                    if !wanted {
                        continue;
                    }
                    if self.stopped() {
                        return;
                    }
                    let now = self.clock().now().wall_ns;
                    if now + entry.cost_ns > deadline {
                        continue; // a shorter one may still fit
                    }
                    let by_time = (now - start) / (deadline - start);
                    let by_count = f64::from(round) / f64::from(rounds);
                    self.report(by_time.max(by_count).clamp(0.1, 1.0), "measuring", entry);
                    self.sample(&mut detector, entry, round);
                }
            }
        }
    }

    fn has_room_to_rebuild(&self) -> bool {
        let largest = self.subjects.iter().map(|subject| subject.bytes()).max();
        self.memory.has_room_for(2 * largest.unwrap_or(0) as u64)
    }

    /// Builds all structures again, at other addresses. If pages are kept, returns them to the
    /// kernel first, so that the kernel chooses new pages. Addresses and pages affect the times.
    fn rebuild(&mut self) {
        let mut order: Vec<usize> = (0..self.subjects.len()).collect();
        order.shuffle(&mut self.random);
        for subject in order {
            if self.stopped() {
                return;
            }
            self.memory.release_pages();
            let bytes = self.subjects[subject].bytes();
            if exceeds_second_level(bytes) {
                self.memory.reserve_in_random_order(2 * bytes as u64);
            }
            let gap: Vec<u8> = Vec::with_capacity(self.random.random_range(0..LARGEST_GAP));
            self.subjects[subject].rebuild();
            drop(black_box(gap));
        }
        self.memory.reserve();
    }

    /// Takes and records a sample, or records a refusal. An external program can refuse at any
    /// time.
    fn sample(&mut self, detector: &mut DisturbanceDetector<'_>, entry: &mut Entry, round: u32) {
        let (stop, kept) = (self.stop, self.memory.keeps_pages());
        let runs = [entry.untimed, entry.runs];
        // Each round continues a mix where the last round ended.
        let job = Job {
            first: u64::from(round) * runs.iter().map(|&n| u64::from(n)).sum::<u64>(),
            ..entry.job
        };
        let taken = detector.take_sample(
            self.clock(),
            || self.run(entry.subject, &job, runs, false),
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
                entry.repeat_next = taken.disturbed;
            }
            refusal => {
                entry.refusal = refusal;
                entry.repeat_next = false;
            }
        }
    }

    /// Measures the allocating operations on fresh pages: one run per sample, in rounds, while
    /// there is time. If the number of rounds is fixed, there are at most as many of these rounds. A
    /// normal run follows each of these runs. The ratio of the two does not depend on the current
    /// speed of the machine.
    fn first_times(&mut self, entries: &mut [Entry], deadline: f64) {
        let control = self.control;
        let mut entries: Vec<&mut Entry> = entries
            .iter_mut()
            .filter(|entry| entry.has_first_time() && Some(entry.subject) != control)
            .filter(|entry| !self.subjects[entry.subject].is_external())
            .collect();
        let fixed = self.effort.rounds();
        for _ in 0..fixed.map_or(MAX_FIRST_TIMES, |rounds| rounds.get().min(MAX_FIRST_TIMES)) {
            entries.shuffle(&mut self.random);
            for entry in &mut entries {
                let now = self.clock().now().wall_ns;
                if self.stopped() {
                    return;
                }
                if now + entry.first_time_cost_ns() > deadline {
                    continue; // a shorter one may still fit
                }
                self.report(1.0, "first times", entry);
                let series = Series {
                    start: Start::FreshPages,
                    ..Series::once(self.clock())
                };
                let first = self.subjects[entry.subject].run(&entry.job, &series);
                let later = self.run(entry.subject, &entry.job, [1, 1], false);
                if first.refusal.is_none() && later.refusal.is_none() {
                    entry.first_times.push([first.time, later.time]);
                }
            }
        }
    }

    pub fn report(&mut self, done: f64, stage: &str, entry: &Entry) {
        (self.progress)(Progress {
            done,
            stage,
            task: entry.name,
            backend: self.subjects[entry.subject].name(),
        });
    }
}

/// Returns whether an entry takes part in a round. In the first `full_rounds`, also slow entries do.
fn takes_part(entry: &Entry, round: u32, full_rounds: u32) -> bool {
    let every = match round < full_rounds {
        true => entry.least_every,
        false => entry.every.max(entry.least_every),
    };
    can_take_part(entry) && round.is_multiple_of(every)
}

/// Returns the number of rounds in which all entries take part: as many as a backend needs to be the
/// fastest, if there is time.
fn full_rounds(entries: &[Entry], left_ns: f64) -> u32 {
    let costs = entries.iter().filter(|entry| can_take_part(entry));
    let cost: f64 = costs.map(|entry| entry.cost_ns).sum();
    let rounds = FEWEST_OF_A_WINNER as u32;
    match cost * f64::from(rounds) <= FULL_ROUNDS_SHARE * left_ns {
        true => rounds,
        false => 0,
    }
}

fn can_take_part(entry: &Entry) -> bool {
    let can = entry.warm_up.is_some() && entry.refusal.is_none();
    can && entry.every > 0 && entry.estimate.is_none()
}

fn groups(entries: &[Entry]) -> Vec<Vec<usize>> {
    let numbers: Vec<usize> = (0..entries.len()).collect();
    let same = |&a: &usize, &b: &usize| entries[a].job.task == entries[b].job.task;
    numbers.chunk_by(same).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests;

//! Runs every operation once, and plans samples that fit the budget.

use crate::engine::measure::{ESTIMATED_NAMED_SHARE, Entry, MAX_RUNS, Measurement, untimed_runs};
use crate::{ElementKind, Operation};
use crate::{ElementSample, Job, Task, TimedRun, exceeds_second_level};
use sixfold_results::{RefusalKind, Time};

/// Planned number of rounds.
const ROUNDS: u32 = 20;
/// Minimum time of a sample. The clock cannot resolve shorter samples well.
pub const SHORTEST_SAMPLE_NS: f64 = 200_000.0;
/// Maximum time of a sample of several runs. Many short samples are better than a few long ones.
const LONGEST_SAMPLE_NS: f64 = 2_000_000.0;
/// The longest sample of a mix on the slowest backend.
const LONGEST_MIX_NS: f64 = 20_000_000.0;
/// An entry whose sample costs up to this many slots takes part in every third round. A slot is the
/// time of one entry in one round, if all entries get equal time.
const MEDIUM_COST_SLOTS: f64 = 6.0;
const MEDIUM_COST_EVERY: u32 = 3;
/// Interval of rounds for entries that cost more than [`MEDIUM_COST_SLOTS`].
const HIGH_COST_EVERY: u32 = 6;
/// Maximum time of a run in the rounds, as a part of the time left.
const LONGEST_IN_ROUNDS: f64 = 0.1;
/// Part of the time left for backends that scan. Their intervals may be wide, because they are
/// hundreds of times slower than backends that do not scan.
const SCANS_PART: f64 = 0.25;
/// Minimum number of elements in a sample.
pub const MIN_ELEMENTS: usize = 16;
/// Minimum number of queries in a sample. They differ in their cost, so a few do not show the mean.
const MIN_QUERIES: usize = 256;
/// Maximum time of a single run outside the rounds of an operation that was requested by name, as a part of the
/// budget.
const LONGEST_ONCE: f64 = ESTIMATED_NAMED_SHARE;
/// Maximum time of a single run of an unnamed operation that makes a mesh, as a part of the budget.
const LONGEST_UNNAMED: f64 = 0.02;
/// Why an operation that was not requested by name has no result.
const BUDGET_ENDED: &str = "not run, because the budget ended: use a longer --budget";
/// Number of faces of the first patch on which an operation is timed.
const FIRST_PATCH: usize = 1024;

impl Measurement<'_, '_> {
    /// Runs everything once and plans samples that fit the budget. Operations that do not scan come
    /// first, then operations that scan. When the budget ends, the remaining operations are refused,
    /// unless they are forced, or were requested by name and do not scan.
    pub fn warm_up(&mut self, entries: &mut [Entry], deadline: f64) {
        let scans: Vec<[bool; 3]> = entries.iter().map(|entry| self.scans(entry)).collect();
        let count = entries.len() as f64;
        let mut done = 0.0;
        let mut last_task = None;
        let mut over = false;
        for scanning in [false, true] {
            let in_this_pass = |scans: &[bool; 3]| scans.contains(&true) == scanning;
            let others = scans.iter().filter(|s| in_this_pass(s)).count().max(1) as f64;
            for (entry, scans) in entries.iter_mut().zip(&scans) {
                if !in_this_pass(scans) {
                    continue;
                }
                if self.stopped() {
                    return;
                }
                self.report(done / count * 0.1, "warming up", entry);
                done += 1.0;
                let part = match (others < count, scanning) {
                    (false, _) => 1.0,
                    (true, true) => SCANS_PART,
                    (true, false) => 1.0 - SCANS_PART,
                };
                let left = (deadline - self.clock().now().wall_ns).max(0.0) * part;
                // All backends of a task are run, or none, so that they can be compared.
                let is_asked_for = self.forced || (self.named && !scanning);
                if last_task.is_some_and(|task| task != entry.job.task) && !is_asked_for {
                    // The first pass leaves a part of the time to the second pass.
                    let reserved = match scanning {
                        true => 0.0,
                        false => (1.0 - part) * self.effort.limit_ns(),
                    };
                    over = self.clock().now().wall_ns + reserved >= deadline;
                }
                last_task = Some(entry.job.task);
                if over {
                    entry.refusal = Some(BUDGET_ENDED.into());
                    entry.refusal_kind = RefusalKind::BudgetEnded;
                    continue;
                }
                let slot_ns = left / (f64::from(ROUNDS) * others);
                let external = self.subjects[entry.subject].is_external();
                match entry.operation() {
                    Some(operation) if operation.creates_mesh() && !external => {
                        self.plan_mesh_operation(entry, *scans, slot_ns, left);
                    }
                    Some(operation) if scanning => {
                        self.plan_scan(entry, operation, *scans, slot_ns, left);
                    }
                    _ => self.plan_whole(entry, slot_ns),
                }
            }
        }
        equalise_mixes(entries);
    }

    /// Runs once each operation that was only estimated, if the run fits into the time left, or if it
    /// is forced. The shortest operation comes first.
    pub fn run_estimated(&mut self, entries: &mut [Entry], deadline: f64) {
        let budget = self.effort.limit_ns();
        let mut estimated: Vec<(f64, &mut Entry)> = entries
            .iter_mut()
            .filter_map(|entry| Some((entry.estimate?.wall_ns, entry)))
            .collect();
        estimated.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for (wall_ns, entry) in estimated {
            let left = deadline - self.clock().now().wall_ns;
            if self.stopped() {
                return;
            }
            let unnamed = entry.job.task.creates_mesh() && !self.named;
            let most = match unnamed {
                true => left.min(LONGEST_UNNAMED * budget),
                false => left,
            };
            if wall_ns > most && !self.forced {
                entry.by_name_only = unnamed && wall_ns <= LONGEST_ONCE * budget;
                continue;
            }
            self.report(1.0, "running once", entry);
            let run = self.run(entry.subject, &entry.job, [0, 1], true);
            entry.estimate = None;
            entry.every = 0;
            record_warm_up(entry, run);
        }
    }

    /// Returns the kinds of elements whose queries may scan: no kind if the backend cannot run on a sample of
    /// the elements.
    pub fn scans(&self, entry: &Entry) -> [bool; 3] {
        if !self.subjects[entry.subject].can_sample() {
            return [false; 3];
        }
        let Some(operation) = entry.operation() else {
            return [entry.scans; 3];
        };
        let scanned = operation.scans(&self.subjects[entry.subject].costs());
        let walked = operation.grows_with_valence();
        ElementKind::ALL.map(|kind| {
            let k = kind.index();
            scanned[k] || (self.skewed && walked[k])
        })
    }

    /// Plans runs on all elements, or on a part of the queries if all of them take too long.
    fn plan_whole(&mut self, entry: &mut Entry, slot_ns: f64) {
        if entry.queries > MIN_QUERIES {
            entry.job.sample = self.affordable_queries(entry, slot_ns);
        }
        if entry.job.sample.is_some() {
            return self.plan_sample(entry, slot_ns);
        }
        let (run, mut overhead_ns) = self.run_with_overhead(entry, [0, 1], true);
        let mut ns = run.time.ns().max(1.0);
        record_warm_up(entry, run);
        if self.stopped() || entry.refusal.is_some() {
            return;
        }
        if ns < SHORTEST_SAMPLE_NS {
            // The first run includes cold caches and page faults. A second series is more accurate.
            let runs = (SHORTEST_SAMPLE_NS / 4.0 / ns).clamp(1.0, MAX_RUNS);
            let (run, overhead) = self.run_with_overhead(entry, [1, runs as u32], false);
            (ns, overhead_ns) = (run.time.ns().max(0.1), overhead);
        }
        // A quarter of the slot is for the sample, and a quarter for the untimed runs. The rest is
        // for waiting and for work between runs.
        let target = (slot_ns / 4.0).clamp(SHORTEST_SAMPLE_NS, LONGEST_SAMPLE_NS);
        entry.runs = match self.memory.is_cold() {
            true => 1,
            false => (target / ns).ceil().clamp(1.0, MAX_RUNS) as u32,
        };
        // An operation that makes or changes a mesh has many branches: it needs a longer warm-up.
        let before = match entry.job.task.creates_mesh() {
            true => LONGEST_SAMPLE_NS,
            false => target,
        };
        let large = exceeds_second_level(self.subjects[entry.subject].bytes());
        entry.untimed = untimed_runs(entry.job.task, ns, before, large);
        let cost = ns * f64::from(entry.runs + entry.untimed) + overhead_ns;
        self.plan_rounds(entry, cost, slot_ns);
    }

    /// Returns the queries that fit into the longest sample that takes part in every third round. `None` if
    /// all of them fit.
    fn affordable_queries(&mut self, entry: &Entry, slot_ns: f64) -> Option<ElementSample> {
        let (all, scanned) = (entry.queries, [true, false, false]);
        let most = MEDIUM_COST_SLOTS * slot_ns;
        let whole = self
            .probe(entry, entry.job.task, scanned, all, most)
            .whole
            .ns();
        let fitting = (all as f64 * most / whole) as usize;
        (fitting < all).then(|| ElementSample {
            scanned,
            size: fitting.max(MIN_QUERIES),
        })
    }

    /// Returns the run, and the wall time that passed outside the timed part, in nanoseconds.
    fn run_with_overhead(&mut self, entry: &Entry, runs: [u32; 2], check: bool) -> (TimedRun, f64) {
        let start = self.clock().now().wall_ns;
        let run = self.run(entry.subject, &entry.job, runs, check);
        let [untimed, runs] = runs;
        let inside = run.time.wall_ns * f64::from(untimed + runs);
        let outside = self.clock().now().wall_ns - start - inside;
        (run, outside.max(0.0))
    }

    fn plan_rounds(&self, entry: &mut Entry, cost_ns: f64, slot_ns: f64) {
        entry.cost_ns = cost_ns;
        // Operations that make a mesh are long. If they were not named, they take part in fewer
        // rounds.
        let unnamed = entry.job.task.creates_mesh() && !self.named;
        let most = if unnamed { 1.0 } else { 4.0 };
        let scans_all = entry.job.sample.is_none() && self.scans(entry).contains(&true);
        entry.every = match cost_ns / slot_ns {
            slots if slots <= most => 1,
            slots if slots <= MEDIUM_COST_SLOTS => MEDIUM_COST_EVERY,
            // Such a scan is far from the fastest, so its first run is enough.
            _ if scans_all && !self.named => 0,
            _ => HIGH_COST_EVERY,
        };
    }

    /// Times more and more elements until the cost of the whole operation is known. Then plans
    /// whether to run the operation in full, on a sample, or not at all.
    fn plan_scan(
        &mut self,
        entry: &mut Entry,
        operation: Operation,
        scanned: [bool; 3],
        slot_ns: f64,
        left: f64,
    ) {
        // An operation that cannot be sampled is estimated by the relation that it queries.
        let probed = match operation.relations(ElementKind::Face) {
            &[relation] if !operation.can_be_sampled() => Operation::Relation(relation),
            _ => operation,
        };
        let all = self.max_elements(scanned);
        let probed = Task::Operation(probed);
        let Probe { whole, cost, size } = self.probe(entry, probed, scanned, all, slot_ns);
        let fits = match operation.can_be_sampled() {
            true => whole.ns() <= slot_ns || all <= MIN_ELEMENTS,
            // A run as short as one sample is always allowed.
            false => whole.ns() <= (LONGEST_IN_ROUNDS * left).max(LONGEST_SAMPLE_NS),
        };
        if self.stopped() {
            return;
        }
        if fits {
            return self.plan_whole(entry, slot_ns);
        }
        if !operation.can_be_sampled() {
            entry.estimate = Some(whole);
            return;
        }
        // `cost` includes kinds that are not sampled, so the size tends to be too small.
        let each = cost / size.min(all).max(1) as f64;
        let size = ((slot_ns / each) as usize).clamp(MIN_ELEMENTS, all.max(MIN_ELEMENTS));
        entry.job.sample = Some(ElementSample { scanned, size });
        self.plan_sample(entry, slot_ns);
    }

    /// Plans one run on the sample of `entry`, without a warm-up: the sample is long.
    fn plan_sample(&mut self, entry: &mut Entry, slot_ns: f64) {
        entry.untimed = 0;
        let start = self.clock().now().wall_ns;
        let run = self.run(entry.subject, &entry.job, [0, 1], true);
        record_warm_up(entry, run);
        let cost = self.clock().now().wall_ns - start;
        self.plan_rounds(entry, cost, slot_ns);
    }

    pub fn max_elements(&self, scanned: [bool; 3]) -> usize {
        let counts = (0..3).filter(|&k| scanned[k]);
        counts.map(|k| self.population()[k]).max().unwrap_or(0)
    }

    /// Times increasing numbers of the `all` elements until one run takes as long as a sample. Runs `task` on
    /// the backend of `entry`.
    fn probe(
        &mut self,
        entry: &Entry,
        task: Task,
        scanned: [bool; 3],
        all: usize,
        slot_ns: f64,
    ) -> Probe {
        let mut size = 4;
        loop {
            let job = Job {
                sample: Some(ElementSample { scanned, size }),
                ..Job::new(task)
            };
            let start = self.clock().now().wall_ns;
            let whole = self.run(entry.subject, &job, [0, 1], false).time;
            let cost = self.clock().now().wall_ns - start;
            if cost > slot_ns.min(LONGEST_SAMPLE_NS) || size >= all || self.stopped() {
                return Probe { whole, cost, size };
            }
            size *= 4;
        }
    }

    /// Plans an operation that makes or edits a mesh. Its time is first estimated from patches and
    /// searches. The operation is then run in rounds, once, or not at all.
    fn plan_mesh_operation(
        &mut self,
        entry: &mut Entry,
        scanned: [bool; 3],
        slot_ns: f64,
        left: f64,
    ) {
        // One face is enough to find out whether the operation is refused.
        let run = self.run(entry.subject, &patch_job(entry, 1), [0, 1], false);
        entry.refusal = run.refusal;
        if self.stopped() || entry.refusal.is_some() {
            return;
        }
        let searches = scanned.contains(&true);
        let mut estimate = self.time_by_patches(entry, slot_ns);
        if searches {
            // A patch does not show the cost of searching the whole mesh.
            let search = self.search_time(entry, scanned, slot_ns);
            let patch = estimate.filter(|patch| patch.ns() > search.ns());
            estimate = Some(patch.unwrap_or(search));
        }
        if self.stopped() || entry.refusal.is_some() {
            return;
        }
        let most = match (searches, self.named) {
            (true, _) => slot_ns,
            (false, false) => LONGEST_UNNAMED * left,
            (false, true) => LONGEST_IN_ROUNDS * left,
        };
        let fits = |whole: &Time| whole.ns() <= most.max(LONGEST_SAMPLE_NS);
        match estimate.filter(|whole| !fits(whole)) {
            None => self.plan_whole(entry, slot_ns),
            too_long => entry.estimate = too_long,
        }
    }

    /// Runs the operation on a patch of `size` faces.
    fn run_patch(&mut self, entry: &Entry, size: usize) -> TimedRun {
        let untimed = u32::from(entry.job.task.grows_tables());
        self.run(entry.subject, &patch_job(entry, size), [untimed, 1], false)
    }

    fn search_time(&mut self, entry: &Entry, scanned: [bool; 3], slot_ns: f64) -> Time {
        let mut total = Time::zero_like(self.clock().now());
        for kind in ElementKind::ALL
            .into_iter()
            .filter(|kind| scanned[kind.index()])
        {
            let only = ElementKind::ALL.map(|other| other == kind);
            let relations = entry.operation().map_or(&[][..], |o| o.relations(kind));
            for &relation in relations {
                let query = Task::Operation(Operation::Relation(relation));
                let all = self.max_elements(only);
                let probe = self.probe(entry, query, only, all, slot_ns);
                total = total.plus(probe.whole);
            }
        }
        total
    }

    /// Runs the operation on growing patches, and returns the time scaled to the whole mesh.
    /// Returns `None` if the next patch would be the whole mesh. A patch fits the cache, so the
    /// estimate tends to be too low.
    fn time_by_patches(&mut self, entry: &mut Entry, slot_ns: f64) -> Option<Time> {
        let all = self.counts.faces;
        let mut size = FIRST_PATCH;
        while size < all {
            let start = self.clock().now().wall_ns;
            let run = self.run_patch(entry, size);
            entry.refusal = run.refusal;
            let cost = self.clock().now().wall_ns - start;
            if cost > slot_ns || size.saturating_mul(4) >= all || self.stopped() {
                return Some(run.time);
            }
            if entry.refusal.is_some() {
                return None;
            }
            size *= 4;
        }
        None
    }
}

struct Probe {
    /// The time for all elements, scaled from the sample.
    whole: Time,
    /// The wall time of the probe, in nanoseconds.
    cost: f64,
    /// The number of timed elements.
    size: usize,
}

/// Gives all entries of a mix the same number of runs, so that they do the same work in each round:
/// as many as the fastest backend needs for a sample, unless that takes too long on the slowest.
fn equalise_mixes(entries: &mut [Entry]) {
    for group in entries.chunk_by_mut(|a, b| a.job.task == b.job.task) {
        if group[0].job.task != Task::Mix {
            continue;
        }
        let run_ns = |entry: &Entry| entry.cost_ns / f64::from(entry.runs + entry.untimed);
        let slowest = group.iter().map(run_ns).fold(1.0, f64::max);
        let most = (LONGEST_MIX_NS / slowest).max(1.0) as u32;
        let runs = group
            .iter()
            .map(|entry| entry.runs)
            .max()
            .unwrap_or(1)
            .min(most);
        for entry in group {
            entry.cost_ns = run_ns(entry) * 2.0 * f64::from(runs);
            (entry.untimed, entry.runs) = (runs, runs);
        }
    }
}

/// Returns the operation of `entry` on a patch of `size` faces.
fn patch_job(entry: &Entry, size: usize) -> Job {
    let scanned = [false; 3];
    Job {
        sample: Some(ElementSample { scanned, size }),
        ..entry.job
    }
}

/// Records the run as the warm-up. A refused run has no time.
pub fn record_warm_up(entry: &mut Entry, run: TimedRun) {
    entry.warm_up = run.refusal.is_none().then_some(run.time);
    entry.outcome = run.outcome;
    entry.refusal = run.refusal;
}

//! The warm-up: everything once, and from that a plan of samples that fit the budget.

use crate::candidate::{Job, Sample};
use crate::measure::{Bench, Entry, LONG_RUN_NS};
use crate::operation::{Kind, Operation};

/// How many rounds the plan aims at.
const ROUNDS: u32 = 20;
/// A sample lasts at least this long, or the clock shows in it.
const SHORTEST_SAMPLE_NS: f64 = 200_000.0;
/// Longer samples are no better; more of them are.
const LONGEST_SAMPLE_NS: f64 = 2_000_000.0;
/// A run this slow takes part in every fourth round only.
const SELDOM: u32 = 4;
/// A sample stands on at least so many elements, whatever the budget says.
pub(crate) const FEWEST_ELEMENTS: usize = 16;
/// What an operation that cannot be sampled may take of the time left, to be run just once.
const ONCE: f64 = 0.5;
/// Structures that one sample may build or copy, in bytes.
const MOST_BYTES: usize = 64 << 20;

impl Bench<'_, '_> {
    /// Runs everything once and plans samples that fit the budget: first what does not scan, then,
    /// in what is left, what does, or might on a skewed mesh. What was put off at first is run once
    /// at the end if there is time.
    pub(crate) fn warm_up(&mut self, entries: &mut [Entry], deadline: f64) {
        let scans: Vec<[bool; 3]> = entries.iter().map(|entry| self.scans(entry)).collect();
        let count = entries.len() as f64;
        let mut done = 0.0;
        for scanning in [false, true] {
            let of_this_sort = |scans: &[bool; 3]| scans.contains(&true) == scanning;
            let others = scans.iter().filter(|s| of_this_sort(s)).count().max(1) as f64;
            for (entry, scans) in entries.iter_mut().zip(&scans) {
                if !of_this_sort(scans) {
                    continue;
                }
                if self.stopped() {
                    return;
                }
                self.report(done / count * 0.1, "warming up", entry);
                done += 1.0;
                // Half of what is left goes to those that scan and half to the rest.
                let part = if others < count { 2.0 } else { 1.0 };
                let left = (deadline - self.clock.now().wall_ns).max(0.0) / part;
                let share = left / (f64::from(ROUNDS) * others);
                if scanning {
                    self.plan_scan(entry, *scans, share, left);
                } else {
                    self.plan_whole(entry, share);
                }
            }
        }
        self.catch_up(entries, deadline);
    }

    /// Runs once, the shortest first, what was only estimated and yet fits into the time left.
    fn catch_up(&mut self, entries: &mut [Entry], deadline: f64) {
        let mut put_off: Vec<(f64, &mut Entry)> = entries
            .iter_mut()
            .filter_map(|entry| Some((entry.estimate?.wall_ns, entry)))
            .collect();
        put_off.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for (wall_ns, entry) in put_off {
            let left = deadline - self.clock.now().wall_ns;
            if self.stopped() || wall_ns > ONCE * left {
                return;
            }
            self.report(0.1, "warming up", entry);
            let run = self.run(entry.subject, &entry.job, 1, true);
            entry.warm_up = Some(run.time);
            entry.outcome = run.outcome;
            entry.estimate = None;
            entry.every = 0;
        }
    }

    /// By kind: whether a query may cost far more than what it yields.
    fn scans(&self, entry: &Entry) -> [bool; 3] {
        let operation = entry.job.operation;
        let scanned = operation.scans(&self.subjects[entry.subject].costs());
        let walked = operation.walks_around();
        Kind::ALL.map(|kind| {
            let k = kind.index();
            scanned[k] || (self.skewed && walked[k])
        })
    }

    fn plan_whole(&mut self, entry: &mut Entry, share: f64) {
        let subject = entry.subject;
        let run = self.run(subject, &entry.job, 1, true);
        entry.warm_up = Some(run.time);
        entry.outcome = run.outcome;
        let mut ns = run.time.ns().max(1.0);
        if self.stopped() {
            return;
        }
        if ns < SHORTEST_SAMPLE_NS {
            // The first run paid for cold caches and page faults; a second series says more.
            let runs = (SHORTEST_SAMPLE_NS / 4.0 / ns).clamp(1.0, self.most_runs(entry));
            ns = self.run(subject, &entry.job, runs as u32, false).time.ns();
            ns = ns.max(0.1);
        }
        let target = (share / 2.0).clamp(SHORTEST_SAMPLE_NS, LONGEST_SAMPLE_NS);
        entry.runs = (target / ns).ceil().clamp(1.0, self.most_runs(entry)) as u32;
        let untimed = if ns > LONG_RUN_NS { 0 } else { 1 };
        self.plan_rounds(entry, ns * f64::from(entry.runs + untimed), share);
    }

    /// More runs than this in a row would hold too many structures at once.
    fn most_runs(&self, entry: &Entry) -> f64 {
        match entry.job.operation {
            Operation::Build | Operation::VvSmooth => {
                let bytes = self.subjects[entry.subject].bytes().max(64);
                (MOST_BYTES / bytes).clamp(1, 100_000) as f64
            }
            _ => 1e7,
        }
    }

    fn plan_rounds(&self, entry: &mut Entry, cost_ns: f64, share: f64) {
        entry.cost_ns = cost_ns;
        entry.every = if cost_ns > 4.0 * share { SELDOM } else { 1 };
    }

    /// Asks for few elements, then more, until the cost of the whole is known; then decides.
    fn plan_scan(&mut self, entry: &mut Entry, scanned: [bool; 3], share: f64, left: f64) {
        let operation = entry.job.operation;
        // What cannot be sampled itself is estimated by the relation that it walks.
        let probed = match operation.relations(Kind::Face) {
            &[relation] if !operation.can_be_sampled() => Operation::Relation(relation),
            _ => operation,
        };
        let asked = (0..3).filter(|&k| scanned[k]);
        let all = asked.map(|k| self.population[k]).max().unwrap_or(0);
        let (mut size, mut whole, mut cost);
        size = 4;
        loop {
            let job = Job {
                operation: probed,
                sample: Some(Sample { scanned, size }),
            };
            let start = self.clock.now().wall_ns;
            whole = self.run(entry.subject, &job, 1, false).time;
            cost = self.clock.now().wall_ns - start;
            if cost > share.min(LONGEST_SAMPLE_NS) || size >= all || self.stopped() {
                break;
            }
            size *= 4;
        }
        let seldom = left * f64::from(SELDOM) / f64::from(ROUNDS) / 2.0;
        let fits = match operation.can_be_sampled() {
            true => whole.ns() <= share || all <= FEWEST_ELEMENTS,
            // What takes no longer than one sample is run whatever is left.
            false => whole.ns() <= seldom.max(LONGEST_SAMPLE_NS),
        };
        if self.stopped() {
            return;
        }
        if fits {
            return self.plan_whole(entry, share);
        }
        if !operation.can_be_sampled() {
            entry.estimate = Some(whole);
            return;
        }
        // The cost of the kinds that are not sampled is in there too: the size errs on the small side.
        let each = cost / size.min(all).max(1) as f64;
        let size = ((share / each) as usize).clamp(FEWEST_ELEMENTS, all.max(FEWEST_ELEMENTS));
        entry.job.sample = Some(Sample { scanned, size });
        let start = self.clock.now().wall_ns;
        let run = self.run(entry.subject, &entry.job, 1, true);
        entry.warm_up = Some(run.time);
        entry.outcome = run.outcome;
        let cost = self.clock.now().wall_ns - start;
        self.plan_rounds(entry, cost, share);
    }
}

//! The number of operations after which building a structure has paid off.

use crate::{Operation, Task};
use sixfold_results::{BreakEven, Confidence, Ranked, Time};

use crate::engine::measure::Entry;
use crate::pick::measurement::Candidate;
use sixfold_results::launches::difference_over_launches;
use sixfold_results::statistics::difference;

/// A candidate with its measured tasks.
pub struct MeasuredMix<'m> {
    pub candidate: &'m Candidate,
    pub entries: Vec<&'m Entry>,
    /// By round: the time of one operation of the mix, rebuilding included.
    pub samples: Vec<(u32, Time)>,
}

impl MeasuredMix<'_> {
    /// Returns the entry of `task`; `None` if the candidate does not run it.
    pub fn entry(&self, task: Task) -> Option<&Entry> {
        let mut entries = self.entries.iter().copied();
        entries.find(|entry| entry.job.task == task)
    }

    /// Returns whether `samples` contain a single run with cold caches.
    pub fn is_warm_up_only(&self) -> bool {
        match self.entry(Task::Mix).or_else(|| self.entry(Task::Program)) {
            Some(whole) => whole.is_warm_up_only(),
            None => {
                let parts = self.entries.iter();
                let mut parts = parts.filter(|e| e.operation() != Some(Operation::Build));
                parts.any(|entry| entry.is_warm_up_only())
            }
        }
    }

    /// Returns whether `samples` contain an estimate, and so are a lower bound.
    pub fn is_bound(&self) -> bool {
        self.entries.iter().any(|entry| entry.estimate.is_some())
    }

    /// Returns the largest number of page faults in a sample; `None` if they were not counted.
    pub fn most_faults(&self) -> Option<u64> {
        let samples = self.entries.iter().flat_map(|entry| &entry.samples);
        samples.filter_map(|(_, time)| time.faults).max()
    }
}

/// The structure that a program has from the start: positions and index lists.
const BASE: &str = "indexed-face-set";

/// Returns the break-even of each backend, compared with an existing indexed face set. The
/// break-even is at n = build / (t_base − t) operations, when the saved time equals the building
/// time. Time differences are formed within rounds. The interval of n follows from the interval of
/// the median difference. `operations` is the number of operations in one use. A lower bound of a time
/// has no break-even.
pub fn break_even(
    measured: &[MeasuredMix<'_>],
    ranking: &[Ranked],
    operations: f64,
    confidence: Confidence,
) -> Vec<BreakEven> {
    let find = |name: &str| {
        let mut measured = measured.iter().filter(|m| !m.is_bound());
        measured.find(|m| m.candidate.name == name)
    };
    let Some(base) = find(BASE) else {
        return Vec::new();
    };
    let saved = |ranked: &Ranked| {
        let pairs = find(&ranked.backend)?
            .samples
            .iter()
            .filter_map(|(round, time)| {
                let base = base.samples.iter().find(|(r, _)| r == round)?;
                Some([base.1.ns(), time.ns()])
            });
        difference(&pairs.collect::<Vec<_>>(), confidence)
    };
    rows(ranking, operations, saved)
}

/// Returns the break-even of each backend from the times of several launches. Time differences are formed within
/// launches.
pub fn break_even_over_launches(
    ranking: &[Ranked],
    operations: f64,
    confidence: Confidence,
) -> Vec<BreakEven> {
    let measured = |ranked: &&Ranked| !ranked.estimated;
    let base = ranking.iter().find(|ranked| ranked.backend == BASE);
    let Some(base) = base.filter(measured) else {
        return Vec::new();
    };
    rows(ranking, operations, |ranked| {
        let times = [base.ns_per_operation, ranked.ns_per_operation];
        let launches = [&*base.launch_ns, &*ranked.launch_ns];
        difference_over_launches(times, launches, confidence).filter(|_| !ranked.estimated)
    })
}

/// Returns a row for each backend but the base. `saved` returns the time that it saves per operation, and its
/// interval.
fn rows(
    ranking: &[Ranked],
    operations: f64,
    saved: impl Fn(&Ranked) -> Option<(f64, Option<[f64; 2]>)>,
) -> Vec<BreakEven> {
    let row = |ranked: &Ranked| {
        let (saved, interval) = saved(ranked)?;
        let build = ranked.first_build_ns();
        let after = |ns: f64| (ns > 0.0).then(|| build / ns);
        let pays = after(saved);
        Some(BreakEven {
            backend: ranked.backend.clone(),
            build_ns: build,
            saves_ns_per_operation: saved,
            operations: pays,
            ci_low: interval.and_then(|[_, high]| after(high)),
            ci_high: interval.and_then(|[low, _]| after(low)),
            uses: pays.map(|pays| pays / operations),
        })
    };
    let others = ranking.iter().filter(|ranked| ranked.backend != BASE);
    others.filter_map(row).collect()
}

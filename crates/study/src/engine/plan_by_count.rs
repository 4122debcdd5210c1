//! Plans samples by the number of elements, for a fixed number of rounds.
//!
//! No time decides anything here, so two machines of different speed plan the same samples.

use crate::engine::measure::{Entry, MAX_RUNS, Measurement};
use crate::engine::plan::{MIN_ELEMENTS, record_warm_up};
use sixfold_workload::ElementSample;

/// Minimum number of elements that the runs of a sample visit. At 1 ns for each element, these runs
/// take 100 µs.
const ELEMENTS_PER_SAMPLE: f64 = 100_000.0;
/// The number of visits that take as long as a run has in addition, such as a call and its result.
const VISITS_PER_RUN: f64 = 20.0;
/// The number of visits that take as long as making, moving or removing one element.
const VISITS_PER_MADE_ELEMENT: f64 = 50.0;
/// Maximum number of faces that a sample of a scanning operation visits.
const MAX_SCANNED: usize = 1_000_000;

impl Measurement<'_, '_, '_> {
    /// Runs everything once, and plans a sample of every entry for every round. An operation is
    /// never estimated or left out.
    pub(crate) fn plan_by_count(&mut self, entries: &mut [Entry]) {
        let count = entries.len() as f64;
        for (i, entry) in entries.iter_mut().enumerate() {
            if self.stopped() {
                return;
            }
            self.report(i as f64 / count * 0.1, "warming up", entry);
            let scanned = self.scans(entry);
            let scans = scanned.contains(&true);
            let can_be_sampled = entry.operation().is_some_and(|o| o.can_be_sampled());
            if scans && can_be_sampled {
                let size = MIN_ELEMENTS.max(MAX_SCANNED / self.trial.counts.faces.max(1));
                let is_part = size < self.max_elements(scanned);
                entry.job.sample = is_part.then_some(ElementSample { scanned, size });
            }
            let run = self.run(entry.subject, &entry.job, [0, 1], true);
            record_warm_up(entry, run);
            entry.least_every = 1;
            entry.runs = match entry.job.sample.is_some() || self.trial.memory.is_cold() {
                true => 1,
                false => runs_per_sample(entry, scans, self.trial.counts.faces),
            };
            // A sample of a scan, and a run that visits so much, warm the caches by themselves.
            entry.untimed = match entry.runs {
                1 => u32::from(entry.job.task.grows_tables()),
                runs => runs,
            };
        }
    }
}

/// Returns the number of runs of an entry that was run once on all elements. The mesh has `faces`
/// faces.
fn runs_per_sample(entry: &Entry, scans: bool, faces: usize) -> u32 {
    let elements = entry.outcome.map_or(1, |outcome| outcome.elements).max(1) as f64;
    let makes = entry.job.task.creates_mesh() || entry.job.task.allocates() || entry.pauses_clock;
    let each = match (makes, scans) {
        (_, true) => faces.max(1) as f64,
        (true, false) => VISITS_PER_MADE_ELEMENT,
        (false, false) => 1.0,
    };
    (ELEMENTS_PER_SAMPLE / (elements * each + VISITS_PER_RUN))
        .ceil()
        .clamp(1.0, MAX_RUNS) as u32
}

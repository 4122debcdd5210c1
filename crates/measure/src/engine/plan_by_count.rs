//! Plans samples by the number of elements, for a fixed number of rounds.
//!
//! No time decides anything here, so two machines of different speed plan the same samples.

use crate::ElementSample;
use crate::engine::measure::{Entry, MAX_RUNS, Measurement};
use crate::engine::plan::{MIN_ELEMENTS, record_warm_up};

/// Minimum cost of the runs of a sample, in visits of an element. At 1 ns for each visit, these runs
/// take 100 µs.
const VISITS_PER_SAMPLE: f64 = 100_000.0;
/// Cost of a run that visits nothing, in visits of an element. Without it, a sample of a mesh with a
/// few elements would consist of tens of thousands of runs.
const VISITS_PER_RUN: f64 = 20.0;
/// The number of visits that take as long as making, moving or removing one element.
const VISITS_PER_MADE_ELEMENT: f64 = 50.0;
/// Maximum number of faces that a sample of a scanning operation visits.
const MAX_SCANNED: usize = 1_000_000;

impl Measurement<'_, '_> {
    /// Runs everything once, and plans a sample of every entry for every round. An operation is
    /// never estimated or left out.
    pub fn plan_by_count(&mut self, entries: &mut [Entry]) {
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
                let size = MIN_ELEMENTS.max(MAX_SCANNED / self.counts.faces.max(1));
                let is_part = size < self.max_elements(scanned);
                entry.job.sample = is_part.then_some(ElementSample { scanned, size });
            }
            let run = self.run(entry.subject, &entry.job, [0, 1], true);
            record_warm_up(entry, run);
            entry.least_every = 1;
            entry.runs = match entry.job.sample.is_some() || self.memory.is_cold() {
                true => 1,
                false => runs_per_sample(entry, scans, self.counts.faces),
            };
            // A sample of a scan, and a run that visits so much, warm the caches by themselves.
            entry.untimed = match entry.runs {
                1 => u32::from(entry.job.task.grows_tables()),
                runs => runs,
            };
        }
    }
}

/// Returns the number of runs in a sample of an entry that was run once on all elements. The mesh has
/// `faces` faces.
fn runs_per_sample(entry: &Entry, scans: bool, faces: usize) -> u32 {
    let elements = entry.outcome.map_or(1, |outcome| outcome.elements).max(1) as f64;
    let makes = entry.job.task.creates_mesh() || entry.job.task.allocates() || entry.pauses_clock;
    let each = match (makes, scans) {
        (_, true) => faces.max(1) as f64,
        (true, false) => VISITS_PER_MADE_ELEMENT,
        (false, false) => entry.visits,
    };
    (VISITS_PER_SAMPLE / (elements * each + VISITS_PER_RUN))
        .ceil()
        .clamp(1.0, MAX_RUNS) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Operation, Outcome, Task};
    use sixfold::Relation;

    #[test]
    fn runs_of_a_sample_follow_from_the_elements() {
        let runs = |elements: u64, scans: bool, pauses_clock: bool| {
            let mut entry = Entry::new(0, Operation::Relation(Relation::VertexVertices));
            entry.outcome = Some(Outcome::new(1.0, elements));
            entry.pauses_clock = pauses_clock;
            runs_per_sample(&entry, scans, 10)
        };
        assert_eq!(runs(99_980, false, false), 1);
        assert_eq!(runs(99_979, false, false), 2);
        assert_eq!(runs(1_000_000, false, false), 1);
        assert_eq!(runs(4, false, false), 4_167, "24 visits for each run");
        assert_eq!(runs(4, true, false), 1_667, "each element visits 10 faces");
        assert_eq!(runs(4, false, true), 455, "making an element counts 50");
        assert_eq!(runs(4, true, true), 1_667);
        let mut search = Entry::of_task(0, Task::Part(0), "nearest_vertex");
        search.outcome = Some(Outcome::new(1.0, 4));
        search.visits = 20.0;
        assert_eq!(runs_per_sample(&search, false, 10), 1_000);
        let of = |name: &str| {
            let mut entry = Entry::new(0, name.parse().expect("an operation"));
            entry.outcome = Some(Outcome::new(1.0, 4));
            runs_per_sample(&entry, false, 10)
        };
        // A build allocates, a refinement makes a mesh, and an edit changes one.
        let runs = ["build", "loop_gather", "flip_all", "edge_length"].map(of);
        assert_eq!(runs, [455, 455, 455, 4_167]);
    }
}

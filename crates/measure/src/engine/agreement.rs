//! Compares checksums to prove that all backends did the same work.

use std::sync::atomic::{AtomicBool, Ordering};

use sixfold::PolygonMesh;

use crate::Clock;
use crate::Operation;
use crate::engine::measure::Entry;
use crate::{Job, Outcome, Series, Task, TimedBackend};
use sixfold_results::Agreement;

/// Maximum relative difference of two `f32` sums of the same terms in different orders.
const TOLERANCE: f64 = 1e-4;

/// Compares the checksum of every entry with a reference. The reference is a backend of Sixfold
/// without merged vertices.
///
/// If the jobs of the two entries differ, the smaller job is also run on the other backend, without
/// timing. A sampled operation is never run in full. After `stop` is set, no more jobs are run.
pub fn compare_checksums(
    entries: &[Entry],
    subjects: &mut [Box<dyn TimedBackend + '_>],
    polygons: &PolygonMesh,
    clock: &dyn Clock,
    stop: &AtomicBool,
) -> Vec<Agreement> {
    let keeps_vertices =
        |subjects: &[Box<dyn TimedBackend + '_>], s: usize| subjects[s].merged_vertices() == 0;
    let is_reference = |subjects: &[Box<dyn TimedBackend + '_>], s: usize| {
        keeps_vertices(subjects, s) && !subjects[s].is_external()
    };
    let agreement = |entry: &Entry| {
        let Some(outcome) = entry.outcome else {
            return Agreement::Unchecked;
        };
        let others = entries.iter().filter(|other| {
            same_work(other.job.task, entry.job.task)
                && same_input(other, entry)
                && other.subject != entry.subject
                && other.outcome.is_some()
                && can_be_compared(entry, other, subjects)
                && is_reference(subjects, other.subject)
        });
        // Prefer a full run as the reference: its backend can also run the sample in little time.
        let mut others: Vec<&Entry> = others.collect();
        // Prefer a backend that refuses the same edits, because it does the same work.
        let refuses_others =
            |other: &Entry| other.outcome.is_some_and(|o| o.refused != outcome.refused);
        others.sort_by_key(|other| {
            let task_differs = other.job.task != entry.job.task;
            (
                refuses_others(other),
                task_differs,
                other.job.sample.is_some(),
            )
        });
        let Some(other) = others.first() else {
            return Agreement::Unchecked;
        };
        let pair = if (other.job.sample, other.job.first) == (entry.job.sample, entry.job.first) {
            Some(outcome).zip(other.outcome)
        } else if stop.load(Ordering::Relaxed) {
            None
        } else if size(&entry.job) <= size(&other.job) {
            let reference = rerun(&mut subjects[other.subject], &entry.job, clock);
            Some(outcome).zip(reference)
        } else {
            rerun(&mut subjects[entry.subject], &other.job, clock).zip(other.outcome)
        };
        let Some((outcome, reference)) = pair else {
            return Agreement::Unchecked;
        };
        if outcome.refused != reference.refused && outcome.checksum != reference.checksum {
            return Agreement::OtherEdits;
        }
        let same = match entry.operation() {
            Some(operation) => agree(operation, outcome.checksum, reference.checksum, polygons),
            None if entry.job.task == Task::Program => is_same_result(&outcome, &reference),
            None => outcome.checksum == reference.checksum,
        };
        if same {
            // Merged vertices can give the same checksum from fewer elements.
            match outcome.elements == reference.elements {
                true => Agreement::Same,
                false if subjects[entry.subject].is_external() => Agreement::Mismatch,
                false if keeps_vertices(subjects, entry.subject) => Agreement::Same,
                false => Agreement::Merged,
            }
        } else if !keeps_vertices(subjects, entry.subject) {
            Agreement::Merged
        } else if !(outcome.checksum.is_finite() && reference.checksum.is_finite()) {
            Agreement::Unchecked
        } else {
            Agreement::Mismatch
        }
    };
    entries.iter().map(agreement).collect()
}

/// Returns whether the backend of the larger of two jobs can also run the smaller one.
fn can_be_compared(one: &Entry, other: &Entry, subjects: &[Box<dyn TimedBackend + '_>]) -> bool {
    let larger = match size(&one.job) <= size(&other.job) {
        true => other,
        false => one,
    };
    one.job.sample == other.job.sample || subjects[larger.subject].can_sample()
}

/// Returns whether two tasks have the same result. All methods of a subdivision scheme make the same
/// surface.
fn same_work(a: Task, b: Task) -> bool {
    let scheme = |task: Task| task.operation().and_then(Operation::scheme);
    a == b || (scheme(a).is_some() && scheme(a) == scheme(b))
}

/// Returns whether two entries with the same task have the same input. The result of some operations
/// depends on the case: the order of the elements.
fn same_input(a: &Entry, b: &Entry) -> bool {
    a.case == b.case || !a.operation().is_some_and(Operation::depends_on_order)
}

/// Returns the sample size of `job`. A full run has the size `usize::MAX`.
fn size(job: &Job) -> usize {
    job.sample.map_or(usize::MAX, |sample| sample.size)
}

fn rerun(
    subject: &mut Box<dyn TimedBackend + '_>,
    job: &Job,
    clock: &dyn Clock,
) -> Option<Outcome> {
    subject.run(job, &Series::once(clock).with_result()).outcome
}

/// Returns whether two checksums can come from the same work.
pub fn agree(operation: Operation, a: f64, b: f64, polygons: &PolygonMesh) -> bool {
    if operation.has_exact_checksum() {
        return a == b;
    }
    // If the terms of a sum cancel, their rounding errors remain.
    is_close(a, b) || (a - b).abs() <= operation.noise(polygons) + TOLERANCE * a.abs().max(b.abs())
}

/// Returns whether a program has the same result: the same number of elements, and the same checksum up to rounding.
pub fn is_same_result(a: &Outcome, b: &Outcome) -> bool {
    a.elements == b.elements && is_close(a.checksum, b.checksum)
}

/// Returns whether two numbers differ only by rounding.
pub fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE * a.abs().max(b.abs())
}

#[cfg(test)]
mod tests {
    use sixfold::{Point, QueryCost};

    use super::*;
    use crate::MachineClock;
    use crate::{ElementSample, TimedRun};

    fn pillow() -> PolygonMesh {
        let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
        PolygonMesh::new(corners, [[0, 1, 2, 3], [3, 2, 1, 0]]).expect("valid")
    }

    #[test]
    fn counts_agree_exactly_and_sums_approximately() {
        let mesh = pillow();
        assert!(!agree(Operation::Boundary, 1e9, 1e9 + 1.0, &mesh));
        assert!(agree(Operation::EdgeLength, 1e9, 1e9 + 1e4, &mesh));
        assert!(!agree(Operation::EdgeLength, 1e9, 1.001e9, &mesh));
    }

    struct Fixed {
        checksum: f64,
        merged: usize,
        refused: u64,
        /// Whether a full run causes a panic.
        samples_only: bool,
        /// Whether all runs are full runs.
        whole_only: bool,
    }

    impl TimedBackend for Fixed {
        fn name(&self) -> &str {
            "fixed"
        }
        fn can_sample(&self) -> bool {
            !self.whole_only
        }
        fn costs(&self) -> [QueryCost; 9] {
            [QueryCost::Local; 9]
        }
        fn merged_vertices(&self) -> usize {
            self.merged
        }
        fn bytes(&self) -> usize {
            1
        }
        fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
            // A sample has half the checksum of a full run.
            assert!(!self.samples_only || job.sample.is_some(), "run in full");
            let is_sample = job.sample.is_some() && !self.whole_only;
            let part = if is_sample { 0.5 } else { 1.0 };
            let outcome = Outcome {
                checksum: self.checksum * part,
                elements: 10 - self.merged as u64,
                refused: self.refused,
            };
            TimedRun::done(series.clock.now(), Some(outcome))
        }
    }

    fn agreements(subjects: &[(f64, usize, bool)]) -> Vec<Agreement> {
        let subjects: Vec<_> = subjects.iter().map(|&(c, m, s)| (c, m, s, 0)).collect();
        agreements_with_refusals(&subjects)
    }

    fn agreements_with_refusals(subjects: &[(f64, usize, bool, u64)]) -> Vec<Agreement> {
        let subjects = subjects.iter();
        let subjects = subjects.map(|&(checksum, merged, samples_only, refused)| Fixed {
            checksum,
            merged,
            refused,
            samples_only,
            whole_only: false,
        });
        agreements_of(subjects.collect())
    }

    /// Runs each subject in full, or on a sample if that is all that it may do.
    fn agreements_of(subjects: Vec<Fixed>) -> Vec<Agreement> {
        let clock = MachineClock::start();
        let (mut boxed, mut entries): (Vec<Box<dyn TimedBackend>>, Vec<Entry>) = Default::default();
        for (i, mut subject) in subjects.into_iter().enumerate() {
            let mut entry = Entry::new(i, Operation::Boundary);
            entry.job.sample = subject.samples_only.then_some(ElementSample {
                scanned: [true; 3],
                size: 4,
            });
            entry.outcome = subject
                .run(&entry.job, &Series::once(&clock).with_result())
                .outcome;
            boxed.push(Box::new(subject));
            entries.push(entry);
        }
        let stop = AtomicBool::new(false);
        compare_checksums(&entries, &mut boxed, &pillow(), &clock, &stop)
    }

    #[test]
    fn backends_that_refuse_the_same_edits_must_agree() {
        use Agreement::{Mismatch, OtherEdits, Same};
        let three = |checksum: f64, refused: u64| {
            let one = (8.0, 0, false, 0);
            agreements_with_refusals(&[one, one, (checksum, 0, false, refused)])
        };
        assert_eq!(three(9.0, 2), [Same, Same, OtherEdits]);
        assert_eq!(three(8.0, 2), [Same; 3]);
        assert_eq!(three(9.0, 0), [Same, Same, Mismatch]);
        let [some, all] = [(8.0, 0, false, 0), (9.0, 0, false, 2)];
        assert_eq!(agreements_with_refusals(&[some, some, all, all]), [Same; 4]);
    }

    #[test]
    fn each_kind_of_difference_has_its_agreement() {
        use Agreement::{Merged, Mismatch, Same, Unchecked};
        assert_eq!(
            agreements(&[(8.0, 0, false), (8.0, 0, false)]),
            [Same, Same]
        );
        assert_eq!(
            agreements(&[(8.0, 0, false), (9.0, 0, false)]),
            [Mismatch; 2]
        );
        // A sample is compared with the same sample, not with a full run.
        assert_eq!(agreements(&[(8.0, 0, true), (8.0, 0, false)]), [Same, Same]);
        assert_eq!(
            agreements(&[(9.0, 0, true), (8.0, 0, false)]),
            [Mismatch; 2]
        );
        // Merged vertices explain a difference. A merged mesh is never the reference.
        assert_eq!(
            agreements(&[(7.0, 2, false), (8.0, 0, false)]),
            [Merged, Unchecked]
        );
        assert_eq!(agreements(&[(8.0, 0, false)]), [Unchecked]);
        // The checksum is the same, but it comes from fewer elements.
        assert_eq!(
            agreements(&[(8.0, 2, false), (8.0, 0, false), (8.0, 0, false)]),
            [Merged, Same, Same]
        );
    }

    /// Relation tables run in full, and other backends of a mesh with very large faces on samples.
    #[test]
    fn backends_that_always_run_in_full_are_not_compared_with_samples() {
        use Agreement::{Mismatch, Same, Unchecked};
        let backend = |checksum, samples_only, whole_only| Fixed {
            checksum,
            merged: 0,
            refused: 0,
            samples_only,
            whole_only,
        };
        let whole = || backend(8.0, false, true);
        let sampled = |checksum| backend(checksum, true, false);
        assert_eq!(agreements_of(vec![whole(), sampled(8.0)]), [Unchecked; 2]);
        let all = vec![whole(), sampled(8.0), sampled(8.0)];
        assert_eq!(agreements_of(all), [Unchecked, Same, Same]);
        let all = vec![whole(), backend(9.0, false, false)];
        assert_eq!(agreements_of(all), [Mismatch; 2]);
    }

    #[test]
    fn cancelled_normals_allow_a_larger_difference() {
        assert_eq!(Operation::VertexNormal.noise(&pillow()), 48.0);
        assert!(agree(Operation::VertexNormal, 0.0, 3.0, &pillow()));
        assert!(!agree(Operation::VertexNormal, 0.0, 60.0, &pillow()));
    }
}

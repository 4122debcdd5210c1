//! Whether all backends did the same work.

use std::sync::atomic::{AtomicBool, Ordering};

use sixfold::{Point, PolygonMesh};

use crate::measure::Entry;
use crate::report::Agreement;
use workload::Clock;
use workload::Operation;
use workload::field_sum;
use workload::{Job, Outcome, Series, Subject};

/// How far sums of `f32` may differ by the order of adding, relative to their size.
const TOLERANCE: f64 = 1e-4;

/// Compares the checksum of every entry with that of a backend of ours which keeps the mesh as it is.
///
/// Where one of the two has a sample, the other runs the same, untimed: the smaller of two samples,
/// and never the whole of what is sampled for its cost. Nothing more is run after `stop`.
pub(crate) fn judge(
    entries: &[Entry],
    subjects: &mut [Box<dyn Subject + '_>],
    polygons: &PolygonMesh,
    clock: &dyn Clock,
    stop: &AtomicBool,
) -> Vec<Agreement> {
    let faithful =
        |subjects: &[Box<dyn Subject + '_>], s: usize| subjects[s].merged_vertices() == 0;
    let judges = |subjects: &[Box<dyn Subject + '_>], s: usize| {
        faithful(subjects, s) && !subjects[s].is_external()
    };
    let verdict = |entry: &Entry| {
        let Some(outcome) = entry.outcome else {
            return Agreement::Unchecked;
        };
        let others = entries.iter().filter(|other| {
            other.job.operation == entry.job.operation
                && other.subject != entry.subject
                && other.outcome.is_some()
                && judges(subjects, other.subject)
        });
        // Whoever went through all of it comes first, for a sample costs it little.
        let mut others: Vec<&Entry> = others.collect();
        others.sort_by_key(|other| other.job.sample.is_some());
        let Some(other) = others.first() else {
            return Agreement::Unchecked;
        };
        let pair = if other.job == entry.job {
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
        let operation = entry.job.operation;
        if agree(operation, outcome.checksum, reference.checksum, polygons) {
            // As many corners in all, maybe, but handed out by fewer vertices.
            match outcome.elements == reference.elements {
                true => Agreement::Same,
                false if subjects[entry.subject].is_external() => Agreement::Mismatch,
                false if faithful(subjects, entry.subject) => Agreement::Same,
                false => Agreement::Merged,
            }
        } else if !faithful(subjects, entry.subject) {
            Agreement::Merged
        } else if !(outcome.checksum.is_finite() && reference.checksum.is_finite()) {
            Agreement::Unchecked
        } else {
            Agreement::Mismatch
        }
    };
    entries.iter().map(verdict).collect()
}

/// How much of the mesh `job` goes through.
fn size(job: &Job) -> usize {
    job.sample.map_or(usize::MAX, |sample| sample.size)
}

fn rerun(subject: &mut Box<dyn Subject + '_>, job: &Job, clock: &dyn Clock) -> Option<Outcome> {
    subject.run(job, &Series::once(clock).checked()).outcome
}

/// Whether two checksums tell of the same work.
pub(crate) fn agree(operation: Operation, a: f64, b: f64, polygons: &PolygonMesh) -> bool {
    if operation.counts() {
        return a == b;
    }
    let far = (a - b).abs();
    let size = a.abs().max(b.abs());
    if far <= TOLERANCE * size {
        return true;
    }
    // Sums that cancel leave the noise of their terms, in whichever order they were added.
    far <= noise(operation, polygons) + TOLERANCE * size
}

/// How far the checksum may be off where terms cancel; O(corners).
fn noise(operation: Operation, polygons: &PolygonMesh) -> f64 {
    match operation {
        Operation::VertexNormal => 12.0 * cancelled_normals(polygons) as f64,
        Operation::FaceBarycenter
        | Operation::VvSmooth
        | Operation::CatmullClark(_)
        | Operation::Loop(_) => {
            let corners = polygons.faces().corners().iter();
            1e-6 * field_sum(corners.map(|&v| polygons.position(v)))
        }
        _ => 0.0,
    }
}

/// Vertices whose face normals cancel, so that the direction of their sum is noise.
fn cancelled_normals(polygons: &PolygonMesh) -> usize {
    let mut sums = vec![(Point::ZERO, 0.0_f32); polygons.vertex_count()];
    for (_, face) in polygons.faces().iter() {
        let at = |corner: usize| polygons.position(face[corner]);
        let spokes = (1..face.len() - 1).map(|i| (at(i) - at(0)).cross(at(i + 1) - at(0)));
        let (mut normal, mut size) = (Point::ZERO, 0.0);
        for cross in spokes {
            normal += cross;
            size += cross.length();
        }
        for &v in face {
            let (sum, total) = &mut sums[v.index()];
            *sum += normal;
            *total += size;
        }
    }
    let cancels = |(sum, total): &&(Point, f32)| *total > 0.0 && sum.length() < 1e-3 * total;
    sums.iter().filter(cancels).count()
}

#[cfg(test)]
mod tests {
    use sixfold::QueryCost;

    use super::*;
    use workload::MachineClock;
    use workload::{Run, Sample};

    fn pillow() -> PolygonMesh {
        let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
        PolygonMesh::new(corners, [[0, 1, 2, 3], [3, 2, 1, 0]]).expect("valid")
    }

    #[test]
    fn counts_agree_to_the_last_digit_and_sums_nearly() {
        let mesh = pillow();
        assert!(!agree(Operation::Boundary, 1e9, 1e9 + 1.0, &mesh));
        assert!(agree(Operation::EdgeLength, 1e9, 1e9 + 1e4, &mesh));
        assert!(!agree(Operation::EdgeLength, 1e9, 1.001e9, &mesh));
    }

    /// A backend that always finds the same, for the judge to compare.
    struct Fixed {
        checksum: f64,
        merged: usize,
        /// It would not end.
        no_whole: bool,
    }

    impl Subject for Fixed {
        fn name(&self) -> &str {
            "fixed"
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
        fn run(&mut self, job: &Job, series: &Series<'_>) -> Run {
            // A sample finds half as much as the whole.
            assert!(!self.no_whole || job.sample.is_some(), "run in full");
            let part = if job.sample.is_some() { 0.5 } else { 1.0 };
            let outcome = Outcome {
                checksum: self.checksum * part,
                elements: 10 - self.merged as u64,
            };
            Run::done(series.clock.now(), Some(outcome))
        }
    }

    fn judged(subjects: &[(f64, usize, bool)]) -> Vec<Agreement> {
        let clock = MachineClock::start();
        let (mut boxed, mut entries): (Vec<Box<dyn Subject>>, Vec<Entry>) = Default::default();
        for (i, &(checksum, merged, sampled)) in subjects.iter().enumerate() {
            let mut entry = Entry::new(i, Operation::Boundary);
            entry.job.sample = sampled.then_some(Sample {
                scanned: [true; 3],
                size: 4,
            });
            let no_whole = sampled;
            let mut subject = Fixed {
                checksum,
                merged,
                no_whole,
            };
            entry.outcome = subject
                .run(&entry.job, &Series::once(&clock).checked())
                .outcome;
            boxed.push(Box::new(subject));
            entries.push(entry);
        }
        let stop = AtomicBool::new(false);
        judge(&entries, &mut boxed, &pillow(), &clock, &stop)
    }

    #[test]
    fn whoever_found_something_else_is_told_apart() {
        use Agreement::{Merged, Mismatch, Same, Unchecked};
        assert_eq!(judged(&[(8.0, 0, false), (8.0, 0, false)]), [Same, Same]);
        assert_eq!(judged(&[(8.0, 0, false), (9.0, 0, false)]), [Mismatch; 2]);
        // A sample is held against the same sample, not against the whole.
        assert_eq!(judged(&[(8.0, 0, true), (8.0, 0, false)]), [Same, Same]);
        assert_eq!(judged(&[(9.0, 0, true), (8.0, 0, false)]), [Mismatch; 2]);
        // Merging explains a difference, and nothing is judged by a mesh that was merged.
        assert_eq!(
            judged(&[(7.0, 2, false), (8.0, 0, false)]),
            [Merged, Unchecked]
        );
        assert_eq!(judged(&[(8.0, 0, false)]), [Unchecked]);
        // As much found in all, but of fewer elements.
        assert_eq!(
            judged(&[(8.0, 2, false), (8.0, 0, false), (8.0, 0, false)]),
            [Merged, Same, Same]
        );
    }

    #[test]
    fn normals_that_cancel_may_point_anywhere() {
        assert_eq!(cancelled_normals(&pillow()), 4);
        assert!(agree(Operation::VertexNormal, 0.0, 3.0, &pillow()));
        assert!(!agree(Operation::VertexNormal, 0.0, 60.0, &pillow()));
    }
}

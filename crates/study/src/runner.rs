//! Runs one backend alone, for programs that compare Sixfold with other libraries.

use std::hint::black_box;

use sixfold::{Facts, PolygonMesh};

use crate::engine::disturbance::{DisturbanceDetector, Verdict, reference_work};
use crate::engine::measure::{MAX_RUNS, untimed_runs};
use crate::engine::plan::SHORTEST_SAMPLE_NS;
use crate::labs::study::{StudyError, prepare};
use crate::refusal::BuildInput;
use sixfold_measure::pages::{self, HeapGuard};
use sixfold_measure::{Clock, Operation, Series, Task, TimedBackend, exceeds_second_level};
use sixfold_results::{Policy, Time};
use sixfold_workload::{Backend, Draw};

/// A built backend that can be timed alone, with the same code as in a study.
///
/// Freed memory pages stay with the process if the allocator supports this. The policy applies to
/// the whole process, and ends when the last runner or other measurement in this process ends; see
/// [`pages`](crate::pages#effect-on-the-process).
pub struct BackendRunner<'a> {
    subject: Box<dyn TimedBackend + 'a>,
    /// The last operation, and the numbers of its untimed and timed runs per sample.
    last: Option<(Operation, [u32; 2])>,
    detector: DisturbanceDetector<'static>,
    /// The policy that keeps freed pages.
    heap: HeapGuard,
    /// The number of samples taken.
    samples: usize,
}

/// Time of the untimed runs before each sample, in nanoseconds.
const UNTIMED_NS: f64 = 2_000_000.0;

/// Number of different gaps in front of a rebuilt structure.
const GAPS: usize = 16;
/// Difference between two successive gaps, in bytes.
const GAP_STEP: usize = 4160;

/// Minimum time of a sample of a structure larger than the second-level cache, in nanoseconds.
const SHORTEST_LARGE_SAMPLE_NS: f64 = 1_000_000.0;

/// Budget in nanoseconds. The detector may use a part of it for waiting.
const BUDGET_NS: f64 = 10e9;

/// The result of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackendRun {
    /// The time of the run.
    pub time: Time,
    /// A checksum of all results; NaN if the backend cannot do the operation on this mesh.
    pub checksum: f64,
    /// The number of elements that the run visits.
    pub elements: u64,
}

impl<'a> BackendRunner<'a> {
    /// Builds `backend` from `polygons`.
    ///
    /// # Errors
    ///
    /// Returns [`StudyError::NoneHolds`] if the structure cannot hold the mesh, and
    /// [`StudyError::HeapPolicy`] if another heap policy is active in this process.
    pub fn new(backend: &Backend, polygons: &'a PolygonMesh) -> Result<Self, StudyError> {
        let heap = HeapGuard::acquire(Policy::Kept)?;
        let draw: Option<&Draw> = None;
        let facts = Facts::from_polygons(polygons);
        let input = BuildInput::with_facts(polygons, &facts);
        let (report, subject) = prepare(backend, &input, draw);
        let subject = subject.ok_or_else(|| StudyError::none_holds([report]))?;
        Ok(Self {
            subject,
            last: None,
            detector: DisturbanceDetector::new(BUDGET_NS, reference_work()),
            heap,
            samples: 0,
        })
    }

    /// Returns the size of the structure in bytes.
    pub fn bytes(&self) -> usize {
        self.subject.bytes()
    }

    /// Runs `operation` on the whole mesh and returns the time of one run. A short operation is
    /// repeated until 200 µs have passed, or until 1 ms has passed if the structure is larger than
    /// the second-level cache. Before the timed runs, the operation is run without timing. If other
    /// programs disturb the measurement, the measurement is repeated.
    ///
    /// A structure larger than the second-level cache is first built again in other memory pages,
    /// because the choice of pages changes the times by up to 20 %.
    pub fn run(&mut self, operation: Operation, clock: &dyn Clock) -> BackendRun {
        if exceeds_second_level(self.subject.bytes()) {
            self.rebuild();
        }
        let runs = match self.last {
            Some((last, runs)) if last == operation => runs,
            _ => self.plan_runs(operation, clock),
        };
        self.last = Some((operation, runs));
        let Self {
            subject, detector, ..
        } = self;
        let sample = || run_times(subject.as_mut(), operation, runs, clock);
        let kept = self.heap.keeps_pages();
        let verdict = |run: &BackendRun| Verdict::on_faults(run.time, kept);
        detector.take_sample(clock, sample, verdict).value
    }

    fn rebuild(&mut self) {
        if self.heap.keeps_pages() {
            pages::release_pages();
            pages::reserve_in_random_order(2 * self.subject.bytes());
        }
        self.samples += 1;
        let gap: Vec<u8> = Vec::with_capacity(self.samples % GAPS * GAP_STEP);
        self.subject.rebuild();
        drop(black_box(gap));
        if self.heap.keeps_pages() {
            pages::reserve(self.subject.bytes());
        }
    }

    /// Returns the numbers of untimed and timed runs in a sample.
    fn plan_runs(&mut self, operation: Operation, clock: &dyn Clock) -> [u32; 2] {
        let large = exceeds_second_level(self.subject.bytes());
        let shortest_ns = match large {
            true => SHORTEST_LARGE_SAMPLE_NS,
            false => SHORTEST_SAMPLE_NS,
        };
        let mut runs = 1;
        loop {
            let each = self.run_times(operation, runs, clock).time.ns();
            let ns = each * f64::from(runs);
            if ns >= shortest_ns || f64::from(runs) >= MAX_RUNS {
                return [
                    untimed_runs(Task::Operation(operation), each, UNTIMED_NS, large),
                    runs,
                ];
            }
            let wanted = f64::from(runs) * shortest_ns / ns.max(1.0);
            runs = (wanted * 1.1).ceil().min(f64::from(runs) * 16.0) as u32;
        }
    }

    /// Runs `operation` once without timing, then `runs` times with timing. Returns the mean time
    /// of one timed run.
    pub fn run_times(&mut self, operation: Operation, runs: u32, clock: &dyn Clock) -> BackendRun {
        run_times(self.subject.as_mut(), operation, [1, runs], clock)
    }
}

fn run_times(
    subject: &mut dyn TimedBackend,
    operation: Operation,
    [untimed, runs]: [u32; 2],
    clock: &dyn Clock,
) -> BackendRun {
    let run = subject.run(
        &operation.into(),
        &Series::with_runs(runs, clock)
            .with_untimed(untimed)
            .with_result(),
    );
    BackendRun {
        time: run.time,
        checksum: run.outcome.map_or(f64::NAN, |outcome| outcome.checksum),
        elements: run.outcome.map_or(0, |outcome| outcome.elements),
    }
}

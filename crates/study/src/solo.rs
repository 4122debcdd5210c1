//! One backend by itself, run by run: for programs that compare it with others of their kind.

use sixfold::{Facts, PolygonMesh};

use crate::gauge::{Gauge, Verdict};
use crate::measure::{MOST_RUNS, untimed_runs};
use crate::plan::SHORTEST_SAMPLE_NS;
use crate::study::{StudyError, put_on_the_bench};
use workload::Backend;
use workload::Draw;
use workload::Operation;
use workload::pages::{self, Policy};
use workload::{Clock, Time};
use workload::{Job, Series, Subject};

/// One backend, built and ready: the same code that a study runs, without its rounds.
///
/// Freed pages stay with the process, as in a study, where the allocator can be told so.
pub struct Solo<'a> {
    subject: Box<dyn Subject + 'a>,
    /// The operation of the last run, and how many untimed and timed runs make a sample of it.
    last: Option<(Operation, [u32; 2])>,
    gauge: Gauge,
    /// Whether freed pages stay: samples should have no page faults then.
    kept: bool,
}

/// How long an operation is run before each sample, with the clock stopped.
const UNTIMED_NS: f64 = 2_000_000.0;

/// The budget that the patience of the gauge is a part of, in nanoseconds.
const BUDGET_NS: f64 = 10e9;

/// What one run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoloRun {
    /// How long it took.
    pub time: Time,
    /// A number that depends on all results, and not on the order of neighbours; not a number where
    /// the backend does not do the operation on this mesh.
    pub checksum: f64,
    /// How many elements it visited.
    pub elements: u64,
}

impl<'a> Solo<'a> {
    /// Builds `backend` from `polygons`.
    ///
    /// # Errors
    ///
    /// A name that no backend has, and a mesh that this one cannot hold.
    pub fn new(backend: &str, polygons: &'a PolygonMesh) -> Result<Self, StudyError> {
        let kept = pages::put_in_force(Policy::Kept).policy == Policy::Kept;
        let name = backend.to_owned();
        let found = Backend::roster()
            .into_iter()
            .find(|found| found.name() == backend);
        let found = found.ok_or(StudyError::UnknownBackend { name })?;
        let draw: Option<&Draw> = None;
        let counts = polygons.counts(Facts::of(polygons).edges);
        let (report, subject) = put_on_the_bench(&found, polygons, draw, &counts);
        let refusals = || vec![(report.name, report.reason.unwrap_or_default())];
        let subject = subject.ok_or_else(|| StudyError::NoneHolds {
            refusals: refusals(),
        })?;
        Ok(Self {
            subject,
            last: None,
            gauge: Gauge::new(BUDGET_NS),
            kept,
        })
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.subject.bytes()
    }

    /// Runs `operation` on the whole mesh: repeatedly until 200 µs have passed if it is short, after
    /// untimed runs as in a study, and again if other work disturbs the machine. The time is that
    /// of one run.
    pub fn run(&mut self, operation: Operation, clock: &dyn Clock) -> SoloRun {
        let runs = match self.last {
            Some((last, runs)) if last == operation => runs,
            _ => self.runs_of(operation, clock),
        };
        self.last = Some((operation, runs));
        let Self { subject, gauge, .. } = self;
        let sample = || run_times(subject.as_mut(), operation, runs, clock);
        let kept = self.kept;
        let verdict = |run: &SoloRun| Verdict::on_faults(run.time, kept);
        gauge.take(clock, sample, verdict).value
    }

    /// How many runs take long enough together, and how many go before them.
    fn runs_of(&mut self, operation: Operation, clock: &dyn Clock) -> [u32; 2] {
        let mut runs = 1;
        loop {
            let each = self.run_times(operation, runs, clock).time.ns();
            let ns = each * f64::from(runs);
            if ns >= SHORTEST_SAMPLE_NS || f64::from(runs) >= MOST_RUNS {
                return [untimed_runs(operation, each, UNTIMED_NS), runs];
            }
            let wanted = f64::from(runs) * SHORTEST_SAMPLE_NS / ns.max(1.0);
            runs = (wanted * 1.1).ceil().min(f64::from(runs) * 16.0) as u32;
        }
    }

    /// Runs `operation` `runs` times, after an untimed run. The time is that of one run.
    pub fn run_times(&mut self, operation: Operation, runs: u32, clock: &dyn Clock) -> SoloRun {
        run_times(self.subject.as_mut(), operation, [1, runs], clock)
    }
}

fn run_times(
    subject: &mut dyn Subject,
    operation: Operation,
    [untimed, runs]: [u32; 2],
    clock: &dyn Clock,
) -> SoloRun {
    let job = Job {
        operation,
        sample: None,
    };
    let run = subject.run(&job, &Series::of_runs(runs, clock).after(untimed).checked());
    SoloRun {
        time: run.time,
        checksum: run.outcome.map_or(f64::NAN, |outcome| outcome.checksum),
        elements: run.outcome.map_or(0, |outcome| outcome.elements),
    }
}

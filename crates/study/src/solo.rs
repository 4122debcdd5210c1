//! One backend by itself, run by run: for programs that compare it with others of their kind.

use sixfold::{Facts, PolygonMesh};

use crate::study::{StudyError, put_on_the_bench};
use workload::Backend;
use workload::Draw;
use workload::Operation;
use workload::{Clock, Time};
use workload::{Job, Subject};

/// One backend, built and ready: the same code that a study runs, without its rounds.
pub struct Solo<'a> {
    subject: Box<dyn Subject + 'a>,
}

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
        Ok(Self { subject })
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.subject.bytes()
    }

    /// Runs `operation` once on the whole mesh.
    pub fn run(&mut self, operation: Operation, clock: &dyn Clock) -> SoloRun {
        let job = Job {
            operation,
            sample: None,
        };
        let run = self.subject.run(&job, 1, clock, true);
        SoloRun {
            time: run.time,
            checksum: run.outcome.map_or(f64::NAN, |outcome| outcome.checksum),
            elements: run.outcome.map_or(0, |outcome| outcome.elements),
        }
    }
}

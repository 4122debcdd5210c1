//! A program on one structure, as a backend of a trial.

use std::hint::black_box;
use std::sync::Arc;

use sixfold::{BuildError, MeshEdit, MeshQuery, PolygonMesh, QueryCost, Representation};

use super::forms::Form;
use super::panics::catch;
use super::recorded::{Asked, Recorded};
use super::tape::TapedRun;
use crate::engine::agreement::is_same_result;
use crate::job::{Job, Outcome, Task, TimedBackend, TimedRun};
use crate::operation::Operation;
use crate::series::{ReusedCopies, Series, time_making};
use crate::trace::{EditReplay, PlainReplay, Trace};
use sixfold_results::Time;

/// The reason why a program does not run on a structure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ProgramRefusal {
    /// The structure cannot hold the mesh.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The program refuses the mesh, or it is left out because a run would take too long.
    #[error("{0}")]
    Refused(String),
    /// The result of the program cannot be compared: it is not a number, or the program did nothing.
    #[error("{0}")]
    NoResult(String),
    /// The program panicked: the message and the place.
    #[error("the program panicked: {0}")]
    Panicked(String),
}

/// A program on one structure, with the scratch data.
pub(super) struct Subject<'p, F: Form> {
    program: Arc<F::Program>,
    polygons: &'p PolygonMesh,
    mesh: F::Mesh,
    scratch: F::Scratch,
    /// The copies on which a program runs that changes the mesh.
    copies: ReusedCopies<WorkingCopy<F>>,
    first: FirstResult,
}

/// A copy of the mesh that a run changes.
struct WorkingCopy<F: Form> {
    mesh: F::Mesh,
    scratch: Result<F::Scratch, String>,
    outcome: Option<Outcome>,
}

impl<'p, F: Form> Subject<'p, F> {
    /// Builds the structure and the scratch data.
    pub(super) fn new(
        program: Arc<F::Program>,
        polygons: &'p PolygonMesh,
    ) -> Result<Self, ProgramRefusal> {
        let mesh = F::Mesh::from_polygons(polygons)?;
        let scratch = set_up::<F>(&program, &mesh, polygons)?;
        Ok(Self {
            program,
            polygons,
            mesh,
            scratch,
            copies: ReusedCopies::default(),
            first: FirstResult::default(),
        })
    }

    /// Runs the program as `series` describes. Returns the time of all runs, and the result of the
    /// program if `series` requests it.
    fn run_program(&mut self, series: &Series<'_>) -> Result<(Time, Option<Outcome>), String> {
        if F::changes_mesh(&self.scratch) {
            return self.run_on_copies(series);
        }
        let Self {
            program,
            mesh,
            scratch,
            first,
            ..
        } = self;
        let mut last = None;
        let time = series.time_together(|| {
            last = black_box(Some(F::run(program, black_box(mesh), scratch)));
        });
        let outcome = last.map(|last| first.checked(last)).transpose()?;
        Ok((time, outcome.filter(|_| series.check)))
    }

    /// Runs the program on fresh copies of the mesh and of the scratch data.
    fn run_on_copies(&mut self, series: &Series<'_>) -> Result<(Time, Option<Outcome>), String> {
        let (program, mesh, polygons) = (&*self.program, &self.mesh, self.polygons);
        let time = self.copies.time(
            series,
            mesh.memory().total(),
            || WorkingCopy {
                mesh: mesh.clone(),
                scratch: F::set_up(program, mesh, polygons),
                outcome: None,
            },
            |copy| {
                copy.mesh.clone_from(mesh);
                copy.scratch = F::set_up(program, &copy.mesh, polygons);
            },
            |copy| {
                if let Ok(scratch) = &mut copy.scratch {
                    copy.outcome = Some(F::run(program, &mut copy.mesh, scratch));
                }
            },
        );
        let Some(copy) = self.copies.used_copy() else {
            return Ok((time, None));
        };
        if let Err(reason) = &copy.scratch {
            return Err(reason.clone());
        }
        let outcome = copy.outcome.map(|last| self.first.checked(last));
        Ok((time, outcome.transpose()?.filter(|_| series.check)))
    }

    /// Builds the structure as `series` describes.
    fn build(&self, series: &Series<'_>) -> (Time, Option<Outcome>) {
        let bytes = self.mesh.memory().total();
        let (time, built) = time_making(series, bytes, || F::Mesh::from_polygons(self.polygons));
        let faces = built.and_then(Result::ok).map(|mesh| mesh.face_count());
        let outcome = faces.filter(|_| series.check);
        (time, outcome.map(|n| Outcome::new(n as f64, n as u64)))
    }
}

impl<F: Form> TimedBackend for Subject<'_, F> {
    fn name(&self) -> &str {
        F::Mesh::NAME
    }

    fn costs(&self) -> [QueryCost; 9] {
        F::Mesh::COSTS
    }

    fn merged_vertices(&self) -> usize {
        let used = self.polygons.vertex_count();
        used.saturating_sub(self.mesh.vertex_count())
    }

    fn bytes(&self) -> usize {
        self.mesh.memory().total()
    }

    fn rebuild(&mut self) {
        if let Ok(again) = Self::new(Arc::clone(&self.program), self.polygons) {
            *self = again;
        }
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        match job.task {
            Task::Operation(Operation::Build) => run_program(series, || Ok(self.build(series))),
            Task::Program => run_program(series, || self.run_program(series)),
            _ => TimedRun::refused(ONLY_WHOLE.into(), series),
        }
    }
}

/// Why a part of a program is refused.
pub(super) const ONLY_WHOLE: &str = "a program runs only as a whole";

/// Runs `work`, which returns the time of all runs of `series` and the result. Refuses a program that
/// panics.
pub(super) fn run_program(
    series: &Series<'_>,
    work: impl FnOnce() -> Result<(Time, Option<Outcome>), String>,
) -> TimedRun {
    let done = catch(work).map_err(|panic| ProgramRefusal::Panicked(panic).to_string());
    match done.and_then(|done| done) {
        Ok((time, outcome)) => TimedRun::done(time.scaled(1.0 / f64::from(series.runs)), outcome),
        Err(reason) => TimedRun::refused(reason, series),
    }
}

/// The result of the first run of a program on a structure.
#[derive(Default)]
pub(super) struct FirstResult(Option<Outcome>);

impl FirstResult {
    /// Returns `later`, the result of a later run; the reason if it cannot be compared or is not that of the first run.
    pub(super) fn checked(&mut self, later: Outcome) -> Result<Outcome, String> {
        check(&later)?;
        let first = *self.0.get_or_insert(later);
        if is_same_result(&first, &later) {
            return Ok(later);
        }
        Err(format!(
            "the result of the program changes from run to run: {} of {} elements, then {} of {}; a run must reset what it \
             keeps in the scratch data, and draw the same random numbers",
            first.checksum, first.elements, later.checksum, later.elements
        ))
    }
}

/// Checks that a result can be compared with others; the reason if not.
fn check(outcome: &Outcome) -> Result<(), String> {
    match outcome {
        Outcome { checksum, .. } if !checksum.is_finite() => Err(format!(
            "the checksum of the program is {checksum}, so the results cannot be compared"
        )),
        Outcome { elements: 0, .. } => {
            Err("the program counted no work, so there is nothing to measure".into())
        }
        _ => Ok(()),
    }
}

fn set_up<F: Form>(
    program: &F::Program,
    mesh: &F::Mesh,
    polygons: &PolygonMesh,
) -> Result<F::Scratch, ProgramRefusal> {
    let scratch = catch(|| F::set_up(program, mesh, polygons));
    let scratch = scratch.map_err(ProgramRefusal::Panicked)?;
    scratch.map_err(ProgramRefusal::Refused)
}

/// Runs the program once on a structure that counts what the program asks, and keeps the calls if
/// `traced`.
pub(super) fn record<F, M>(
    program: &F::Program,
    name: &str,
    polygons: &PolygonMesh,
    traced: bool,
) -> Result<RecordedRun, ProgramRefusal>
where
    F: Form<Mesh = Recorded<M>>,
    M: Representation,
{
    let mut mesh = F::Mesh::from_polygons(polygons)?;
    let mut scratch = set_up::<F>(program, &mesh, polygons)?;
    let at_set_up = mesh.take();
    if traced {
        mesh.start_trace(polygons);
    }
    match catch(|| F::run(program, &mut mesh, &mut scratch)) {
        Ok(_) if traced => {
            let taped = mesh.take_tape(name);
            let asked = taped.as_ref().map_or_else(|| mesh.take(), |run| run.asked);
            Ok(RecordedRun {
                asked,
                at_set_up,
                taped,
            })
        }
        Ok(_) => Ok(RecordedRun {
            asked: mesh.take(),
            at_set_up,
            taped: None,
        }),
        Err(panic) => Err(ProgramRefusal::Panicked(panic)),
    }
}

/// Runs the program once on a structure whose lists and results are in one order, see
/// [`start_canonical_order`](Recorded::start_canonical_order), or in its own order.
pub(super) fn run_once<F, M>(
    program: &F::Program,
    polygons: &PolygonMesh,
    canonical: bool,
) -> Result<Outcome, ProgramRefusal>
where
    F: Form<Mesh = Recorded<M>>,
    M: Representation,
{
    let mut mesh = F::Mesh::from_polygons(polygons)?;
    if canonical {
        mesh.start_canonical_order(polygons);
    }
    let mut scratch = set_up::<F>(program, &mesh, polygons)?;
    let outcome = catch(|| F::run(program, &mut mesh, &mut scratch));
    let outcome = outcome.map_err(ProgramRefusal::Panicked)?;
    check(&outcome).map_err(ProgramRefusal::NoResult)?;
    Ok(outcome)
}

/// Runs `trace` once on a structure that counts what it asks.
///
/// # Errors
///
/// Returns the reason if the structure cannot hold the mesh, or if the trace does not run on it.
pub fn record_trace<M: Representation>(
    trace: &Trace,
    polygons: &PolygonMesh,
) -> Result<Option<TapedRun>, ProgramRefusal> {
    let name = &trace.program;
    let run = record::<PlainReplay<Recorded<M>>, M>(trace, name, polygons, true)?;
    Ok(run.taped)
}

/// Does what [`record_trace`] does, for a trace with edits.
///
/// # Errors
///
/// Returns the same errors as [`record_trace`].
pub fn record_edit_trace<M: Representation + MeshEdit>(
    trace: &Trace,
    polygons: &PolygonMesh,
) -> Result<Option<TapedRun>, ProgramRefusal> {
    let name = &trace.program;
    let run = record::<EditReplay<Recorded<M>>, M>(trace, name, polygons, true)?;
    Ok(run.taped)
}

/// What one run of a program asks.
pub(super) struct RecordedRun {
    pub(super) asked: Asked,
    /// What the set-up asks, which is not part of the run.
    pub(super) at_set_up: Asked,
    /// `None` if the run was not traced, or has too many calls.
    pub(super) taped: Option<TapedRun>,
}

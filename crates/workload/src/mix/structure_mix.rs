//! Runs a mix on one structure.

use std::hint::black_box;
use std::marker::PhantomData;
use std::ops::Range;

use sixfold::{
    BuildError, Edit, FaceId, MeshEdit, Point, PolygonMesh, QueryCost, Relation, Representation,
};
use sixfold_core::EditOf;

use crate::backend::Backend;
use crate::draw::Draw;
use crate::edit_place::prepare_edit;
use crate::mix::own_data::OwnMemory;
use crate::mix::places::{EditPlaceError, EditPlaces};
use crate::mix::route::Route;
use crate::mix::route_handles::{from_route, run_action, vertices_of};
use crate::mix::runs::{Counts, run_turns, time_part, time_turns};
use crate::mix::schedule::Schedule;
use crate::mix::{MixBackend, NO_PROGRAM};
use crate::timed_structure::TimedStructure;
use crate::workload::{Action, Part};
use sixfold_measure::{
    HandleLists, Job, Outcome, ReusedCopies, Series, Task, TimedBackend, TimedRun,
};

/// The largest number of turns on one copy of a mesh that is edited.
const MAX_TURNS_PER_COPY: u64 = 16;

/// A structure that is ready to run a mix, or the reason why the structure cannot run the mix.
pub type PreparedMix<'a> = Result<Box<dyn MixBackend + 'a>, MixRefusal>;

/// The reason why a structure cannot run a mix.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MixRefusal {
    /// The structure cannot hold the mesh.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The structure does not support any edit.
    #[error("it cannot be edited")]
    NotEditable,
    /// The structure does not support one edit of the mix.
    #[error("the structure does not support {0}")]
    UnsupportedEdit(Edit),
    /// The mesh is not suited for the edits of the mix.
    #[error(transparent)]
    EditPlaceError(#[from] EditPlaceError),
}

pub(crate) struct MixInput<'a> {
    pub(crate) backend: Backend,
    pub(crate) polygons: &'a PolygonMesh,
    pub(crate) draw: &'a Draw,
    pub(crate) schedule: &'a Schedule,
    pub(crate) route: &'a Route,
}

/// Builds the structure of `backend` from `polygons` and prepares it to run the mix of `schedule`.
/// The mix visits the elements in the order of `route`.
///
/// # Errors
///
/// Returns the reason if the structure cannot hold `polygons`, if the structure does not support an
/// edit of the mix, or if the mesh is not suited for the edits.
pub fn prepare_mix<'a>(
    backend: &Backend,
    polygons: &'a PolygonMesh,
    draw: &'a Draw,
    schedule: &'a Schedule,
    route: &'a Route,
) -> PreparedMix<'a> {
    let input = MixInput {
        backend: *backend,
        polygons,
        draw,
        schedule,
        route,
    };
    if !schedule.editable {
        return (backend.queries.prepare_mix)(&input);
    }
    let edits = backend.edits.ok_or(MixRefusal::NotEditable)?;
    let mut needed = schedule.parts.iter().filter_map(|part| match part.action {
        Action::Edit(edit) => Some(edit),
        _ => None,
    });
    match needed.find(|&edit| backend.info.edits[edit as usize].is_none()) {
        Some(edit) => Err(MixRefusal::UnsupportedEdit(edit)),
        None => (edits.prepare_mix)(&input),
    }
}

pub(crate) fn prepare_query_mix<'a, M: Representation + 'static>(
    input: &MixInput<'a>,
) -> PreparedMix<'a> {
    let mix: StructureMix<'a, M, ReadOnly> = StructureMix::new(input)?;
    Ok(Box::new(mix))
}

pub(crate) fn prepare_edit_mix<'a, M: Representation + MeshEdit + 'static>(
    input: &MixInput<'a>,
) -> PreparedMix<'a> {
    let mix: StructureMix<'a, M, ReadWrite> = StructureMix::new(input)?;
    Ok(Box::new(mix))
}

trait WriteAccess<M: Representation> {
    fn set_position(mesh: &mut M, v: M::Vertex, to: Point);
    /// Prepares the mesh for an edit at a face; `None` if this is not possible.
    fn prepare_edit(
        mesh: &mut M,
        polygons: &PolygonMesh,
        edit: Edit,
        f: FaceId,
    ) -> Option<EditOf<M>>;
    fn apply_edit(mesh: &mut M, call: &EditOf<M>) -> bool;
    /// Returns whether an edit visits all faces of the mesh.
    fn scans(edit: Edit) -> bool;
}

/// The access of schedules without writes. Its methods are never called.
struct ReadOnly;

impl<M: Representation> WriteAccess<M> for ReadOnly {
    fn set_position(_: &mut M, _: M::Vertex, _: Point) {}
    fn prepare_edit(_: &mut M, _: &PolygonMesh, _: Edit, _: FaceId) -> Option<EditOf<M>> {
        None
    }
    fn apply_edit(_: &mut M, _: &EditOf<M>) -> bool {
        false
    }
    fn scans(_: Edit) -> bool {
        false
    }
}

struct ReadWrite;

impl<M: Representation + MeshEdit> WriteAccess<M> for ReadWrite {
    #[inline(always)]
    fn set_position(mesh: &mut M, v: M::Vertex, to: Point) {
        // Write the current position: no structure refuses it, and the mesh does not change.
        let _ = black_box(mesh.set_position(v, to).is_ok());
    }
    fn prepare_edit(
        mesh: &mut M,
        polygons: &PolygonMesh,
        edit: Edit,
        f: FaceId,
    ) -> Option<EditOf<M>> {
        prepare_edit(mesh, polygons, edit, f).ok()
    }
    #[inline(always)]
    fn apply_edit(mesh: &mut M, call: &EditOf<M>) -> bool {
        call.apply(mesh, &mut ()).is_ok()
    }
    fn scans(edit: Edit) -> bool {
        M::EDITS[edit as usize] == Some(QueryCost::Scan)
    }
}

/// The work of a mix: the schedule, the handles of the route, and the places of the edits.
struct Work<'a, M: Representation, W> {
    schedule: &'a Schedule,
    handles: HandleLists<M>,
    own_memory: OwnMemory,
    faces: EditPlaces,
    /// For each edit of the schedule, the edits at its places on a mesh prepared for them.
    calls: Vec<Vec<EditOf<M>>>,
    write_access: PhantomData<W>,
}

impl<M: Representation, W: WriteAccess<M>> Work<'_, M, W> {
    /// Returns the edits of `part`; `None` if `part` is not an edit.
    fn edits(&self, part: usize) -> Option<&[EditOf<M>]> {
        let nth = self.schedule.edits().position(|other| other == part)?;
        self.calls.get(nth).map(Vec::as_slice)
    }

    /// **Timed**: runs the operations `range` of one part on `mesh`. If the part is an edit, `range` contains
    /// the indices of the faces at which the edit is done. Returns the numbers of operations,
    /// results and refused edits.
    #[inline(never)]
    fn run_range(&self, mesh: &mut M, part: usize, range: Range<u64>) -> Counts {
        let operations = range.end - range.start;
        match self.schedule.parts[part].action {
            Action::SetPosition => {
                for run in vertices_of(&self.handles, range) {
                    run.iter().for_each(|&v| {
                        let at = mesh.position(v);
                        W::set_position(mesh, v, at);
                    });
                }
                [operations, operations, 0]
            }
            Action::Edit(_) => {
                let Some(calls) = self.edits(part) else {
                    return [0; 3];
                };
                let range = range.start as usize..range.end as usize;
                let some = calls.get(range).unwrap_or(&[]);
                let refused = some.iter().filter(|call| !W::apply_edit(mesh, call));
                let refused = refused.count() as u64;
                let done = some.len() as u64 - refused;
                [some.len() as u64, done, refused]
            }
            action => [
                operations,
                run_action(&self.handles, mesh, action, range),
                0,
            ],
        }
    }

    /// **Timed**: runs the operations `range` of one part, and visits the program's own data of the same
    /// elements. Returns the same counts as [`run_range`](Self::run_range).
    fn run_with_data(&self, mesh: &mut M, part: usize, range: Range<u64>) -> Counts {
        let kind = self.schedule.parts[part].action.kind();
        self.own_memory.visit(kind, range.clone());
        self.run_range(mesh, part, range)
    }

    /// **Timed**: runs the element operations of some turns. Returns the same counts as
    /// [`run_range`](Self::run_range). Edits start at their first place.
    fn run_turns_on_copy(&self, mesh: &mut M, turns: Range<u64>) -> Counts {
        let schedule = self.schedule;
        let range_of = |part: usize, turn: u64| {
            let is_edit = matches!(schedule.parts[part].action, Action::Edit(_));
            schedule.turn_range(part, if is_edit { turn - turns.start } else { turn })
        };
        run_turns(
            schedule.parts.len(),
            turns.clone(),
            &range_of,
            &mut |part, range| self.run_with_data(mesh, part, range),
        )
    }

    /// Returns the number of turns for which the places of the edits suffice: at most 16, and at
    /// least 1.
    fn turns_per_copy(&self) -> u64 {
        let fits = |turns: &u64| {
            self.schedule.edits().all(|part| {
                let places = self.edits(part).map_or(0, <[_]>::len);
                self.schedule.operations_within(part, *turns) <= places as u64
            })
        };
        let fitting = (1..=MAX_TURNS_PER_COPY).take_while(fits).last();
        fitting.unwrap_or(1)
    }

    /// Returns the number of operations of `part` that visit each of its elements once.
    fn cycle_length(&self, part: usize) -> u64 {
        let kind = self.schedule.parts[part].action.kind();
        kind.map_or(1, |kind| self.handles.len(kind) as u64)
    }

    /// Returns whether one operation of `part` visits all faces of the mesh.
    fn scans(&self, part: &Part) -> bool {
        let scans = |relation: &Relation| M::cost(*relation) == QueryCost::Scan;
        match part.action {
            Action::Edit(edit) => W::scans(edit),
            Action::SetPosition => W::scans(Edit::SetPosition),
            action => action.relations().iter().any(scans),
        }
    }
}

struct StructureMix<'a, M: Representation, W> {
    /// The structure as a study measures it.
    timed: TimedStructure<'a, M>,
    polygons: &'a PolygonMesh,
    work: Work<'a, M, W>,
    /// The mesh prepared for its edits; `None` if there are no edits.
    prepared: Option<M>,
    /// Copies of `prepared`, each with the counts of the last run on it.
    copies: ReusedCopies<(M, Counts)>,
}

impl<'a, M: Representation + 'static, W: WriteAccess<M>> StructureMix<'a, M, W> {
    fn new(input: &MixInput<'a>) -> Result<Self, MixRefusal> {
        let mesh = M::from_polygons(input.polygons)?;
        let faces = EditPlaces::new(input.schedule, input.polygons)?;
        let work = Work {
            schedule: input.schedule,
            handles: from_route(input.route, &mesh, input.polygons, &faces.occupied),
            own_memory: OwnMemory::new(
                &input.schedule.own_data,
                input.route,
                input.polygons,
                input.schedule.edges,
            ),
            faces,
            calls: Vec::new(),
            write_access: PhantomData,
        };
        let mut mix = Self {
            timed: TimedStructure::new(input.backend, input.polygons, Some(input.draw), mesh),
            polygons: input.polygons,
            work,
            prepared: None,
            copies: ReusedCopies::default(),
        };
        mix.prepare_places();
        Ok(mix)
    }

    /// Finds the places and prepares a copy of the mesh for the edits. Returns for each edit and
    /// place whether the preparation succeeded.
    fn prepare_places(&mut self) -> Vec<Vec<bool>> {
        if self.work.faces.by_edit.is_empty() {
            return Vec::new();
        }
        let mut mesh = self.timed.mesh.clone();
        let schedule = self.work.schedule;
        let edits = schedule
            .edits()
            .filter_map(|part| match schedule.parts[part].action {
                Action::Edit(edit) => Some(edit),
                _ => None,
            });
        let calls = edits.zip(&self.work.faces.by_edit).map(|(edit, faces)| {
            let mut prepare = |&f: &FaceId| W::prepare_edit(&mut mesh, self.polygons, edit, f);
            faces.iter().map(&mut prepare).collect()
        });
        let calls: Vec<Vec<Option<EditOf<M>>>> = calls.collect();
        let is_prepared = calls.iter();
        let is_prepared = is_prepared.map(|calls| calls.iter().map(Option::is_some).collect());
        let is_prepared = is_prepared.collect();
        let calls = calls.into_iter();
        self.work.calls = calls
            .map(|calls| calls.into_iter().flatten().collect())
            .collect();
        self.prepared = Some(mesh);
        self.copies = ReusedCopies::default();
        is_prepared
    }

    /// Runs turns of the mix; with edits, one run is as many turns as fit on a restored copy.
    fn run_mix(&mut self, first: u64, series: &Series<'_>) -> TimedRun {
        let Self { timed, work, .. } = self;
        if self.prepared.is_none() {
            let mesh = black_box(&mut timed.mesh);
            return time_turns(work.schedule, first, series, &mut |part, range| {
                work.run_with_data(mesh, part, range)
            });
        }
        let turns = work.turns_per_copy();
        let per_run = work.schedule.turn_operations * turns as f64;
        // The untimed runs are at other elements than the timed ones, as in a program.
        let run = |work: &Work<'a, M, W>, copy: &mut M, step: u64| {
            let start = (first + step) * turns;
            work.run_turns_on_copy(copy, start..start + turns)
        };
        if series.untimed > 0 {
            let before = Series {
                runs: series.untimed,
                untimed: 0,
                start: sixfold_measure::Start::Warm,
                check: false,
                ..*series
            };
            self.run_on_copies(&before, |work, copy| run(work, copy, 0));
        }
        let step = u64::from(series.untimed);
        let (time, counts) =
            self.run_on_copies(&series.with_untimed(0), |work, copy| run(work, copy, step));
        let [operations, yielded, _] = counts;
        let each = time.scaled(per_run / operations.max(1) as f64 / f64::from(series.runs));
        let outcome = series.check.then_some(Outcome {
            checksum: yielded as f64,
            elements: per_run as u64,
            refused: 0,
        });
        TimedRun::done(each, outcome)
    }

    /// Runs one part alone. Edits are done at the first places of restored copies; their result is
    /// the number of accepted edits on a copy.
    fn run_part(&mut self, part: usize, first: u64, series: &Series<'_>) -> TimedRun {
        let Some(places) = self.work.edits(part) else {
            let work = &self.work;
            let mesh = black_box(&mut self.timed.mesh);
            let scans = work.scans(&work.schedule.parts[part]);
            let all = (!scans).then(|| work.cycle_length(part));
            return time_part(first, series, all, &mut |range| {
                work.run_range(mesh, part, range)
            });
        };
        let each = places.len().clamp(1, series.runs as usize) as u64;
        let copies = Series {
            runs: u64::from(series.runs).div_ceil(each) as u32,
            untimed: series.untimed.min(1),
            ..*series
        };
        let (time, counts) =
            self.run_on_copies(&copies, |work, copy| work.run_range(copy, part, 0..each));
        let operations = counts[0].max(1) as f64 * f64::from(copies.runs);
        let outcome = series.check.then_some(Outcome {
            checksum: counts[1] as f64,
            elements: 1,
            refused: 0,
        });
        TimedRun::done(time.scaled(1.0 / operations), outcome)
    }

    /// Runs `run` on restored copies of the mesh that is prepared for its edits, as `series`
    /// describes. Returns the total time and the counts of one run.
    fn run_on_copies(
        &mut self,
        series: &Series<'_>,
        run: impl Fn(&Work<'a, M, W>, &mut M) -> Counts,
    ) -> (sixfold_results::Time, Counts) {
        let Self {
            work,
            prepared,
            copies,
            timed,
            ..
        } = self;
        let prepared = prepared.as_ref().unwrap_or(&timed.mesh);
        let time = copies.time(
            series,
            prepared.memory().total(),
            || (prepared.clone(), [0; 3]),
            |(copy, _)| copy.clone_from(prepared),
            |(copy, counts)| *counts = run(work, copy),
        );
        // All runs of a series have the same counts.
        let counts = copies.used_copy().map_or([0; 3], |(_, counts)| *counts);
        (time, counts)
    }
}

impl<M: Representation + 'static, W: WriteAccess<M>> TimedBackend for StructureMix<'_, M, W> {
    fn name(&self) -> &str {
        self.timed.name()
    }

    fn costs(&self) -> [QueryCost; 9] {
        self.timed.costs()
    }

    fn merged_vertices(&self) -> usize {
        self.timed.merged_vertices()
    }

    fn bytes(&self) -> usize {
        self.timed.bytes()
    }

    /// Builds the structure again. Its handles stay the same, because they depend only on the
    /// polygons.
    fn rebuild(&mut self) {
        self.timed.rebuild();
        if let Some(prepared) = &mut self.prepared {
            *prepared = prepared.clone();
            self.copies = ReusedCopies::default();
        }
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        match job.task {
            Task::Operation(_) => self.timed.run(job, series),
            Task::Mix => self.run_mix(job.first, series),
            Task::Part(part) => self.run_part(part, job.first, series),
            Task::Program => TimedRun::refused(NO_PROGRAM.into(), series),
        }
    }
}

impl<M: Representation + 'static, W: WriteAccess<M>> MixBackend for StructureMix<'_, M, W> {
    fn type_paths(&self) -> Vec<&'static str> {
        vec![M::type_path()]
    }

    fn scans(&self) -> Vec<bool> {
        let parts = self.work.schedule.parts.iter();
        parts.map(|part| self.work.scans(part)).collect()
    }

    fn accepted_places(&mut self) -> Vec<Vec<bool>> {
        let mut accepted = self.prepare_places();
        let Some(mut mesh) = self.prepared.clone() else {
            return accepted;
        };
        for (part, accepted) in self.work.schedule.edits().zip(&mut accepted) {
            // A place that could not be prepared has no edit.
            let prepared = accepted.iter_mut().filter(|accepted| **accepted);
            let calls = self.work.edits(part).unwrap_or(&[]);
            for (call, accepted) in calls.iter().zip(prepared) {
                *accepted = W::apply_edit(&mut mesh, call);
            }
        }
        accepted
    }

    fn keep_places(&mut self, accepted: &[Vec<bool>]) {
        self.work.faces = self.work.faces.filter_accepted(accepted);
        self.prepare_places();
    }
}

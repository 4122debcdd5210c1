//! Runs a mix on one structure.

use std::hint::black_box;
use std::marker::PhantomData;
use std::ops::Range;

use sixfold::{
    BuildError, Edit, FaceId, MeshEdit, Point, PolygonMesh, QueryCost, Relation, Representation,
};

use crate::backend::Backend;
use crate::clock::{Clock, Time, timed};
use crate::draw::Draw;
use crate::edit_place::{EditPlace, apply_edit, prepare_place};
use crate::mix::passes::pass_over;
use crate::mix::places::{EditPlaceError, EditPlaces};
use crate::mix::route::Route;
use crate::mix::route_handles::RouteHandles;
use crate::mix::schedule::Schedule;
use crate::mix::{MixBackend, MixRun};
use crate::operation::Operation;
use crate::series::{ReusedCopies, Series, time_making};
use crate::sweeps::Outputs;
use crate::timed_structure::{ElementSample, Job, Run, TimedBackend};
use crate::workload::{Action, Part};

/// A structure that is ready for a mix, or the reason why it is not ready.
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
    /// The structure does not support the edit.
    #[error("it does not support {0}")]
    UnsupportedEdit(Edit),
    /// The mix cannot be run on this mesh with any structure.
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

/// Builds the structure of `backend` from `polygons` and prepares it for `schedule` along `route`.
///
/// # Errors
///
/// Returns the reason if the structure cannot hold `polygons`, if it does not support the edits, or
/// if there is no place for an edit.
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
    fn prepare_place(mesh: &mut M, edit: Edit, place: &mut EditPlace<M>) -> bool;
    fn apply_edit(mesh: &mut M, edit: Edit, place: &EditPlace<M>) -> bool;
    /// Returns whether an edit visits all faces of the mesh.
    fn scans(edit: Edit) -> bool;
}

/// The access of schedules without writes. Its methods are never called.
struct ReadOnly;

impl<M: Representation> WriteAccess<M> for ReadOnly {
    fn set_position(_: &mut M, _: M::Vertex, _: Point) {}
    fn prepare_place(_: &mut M, _: Edit, _: &mut EditPlace<M>) -> bool {
        false
    }
    fn apply_edit(_: &mut M, _: Edit, _: &EditPlace<M>) -> bool {
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
    fn prepare_place(mesh: &mut M, edit: Edit, place: &mut EditPlace<M>) -> bool {
        prepare_place(mesh, edit, place).is_ok()
    }
    #[inline(always)]
    fn apply_edit(mesh: &mut M, edit: Edit, place: &EditPlace<M>) -> bool {
        apply_edit(mesh, edit, place).is_ok()
    }
    fn scans(edit: Edit) -> bool {
        M::EDITS[edit as usize] == Some(QueryCost::Scan)
    }
}

struct Task<'a, M: Representation, W> {
    schedule: &'a Schedule,
    handles: RouteHandles<M>,
    faces: EditPlaces,
    /// For each edit of the schedule, its places on a mesh prepared for the edits.
    places: Vec<Vec<EditPlace<M>>>,
    write_access: PhantomData<W>,
}

impl<M: Representation, W: WriteAccess<M>> Task<'_, M, W> {
    /// Returns the edit of `part` with its places; `None` if `part` is not an edit.
    fn edit(&self, part: usize) -> Option<(Edit, &[EditPlace<M>])> {
        let nth = self.schedule.edits().position(|other| other == part)?;
        match self.schedule.parts[part].action {
            Action::Edit(edit) => Some((edit, self.places.get(nth)?)),
            _ => None,
        }
    }

    /// Runs the operations `range` of one part on `mesh`. For edits, `range` is a range of places.
    /// Returns the numbers of operations, results and refused edits.
    #[inline]
    fn run_range(&self, mesh: &mut M, part: usize, range: Range<u64>) -> [u64; 3] {
        let operations = range.end - range.start;
        match self.schedule.parts[part].action {
            Action::SetPosition => {
                for run in self.handles.vertices(range) {
                    run.iter().for_each(|&v| {
                        let at = mesh.position(v);
                        W::set_position(mesh, v, at);
                    });
                }
                [operations, operations, 0]
            }
            Action::Edit(_) => {
                let Some((edit, places)) = self.edit(part) else {
                    return [0; 3];
                };
                let range = range.start as usize..range.end as usize;
                let some = places.get(range).unwrap_or(&[]);
                let refused = some
                    .iter()
                    .filter(|place| !W::apply_edit(mesh, edit, place));
                let refused = refused.count() as u64;
                let done = some.len() as u64 - refused;
                [some.len() as u64, done, refused]
            }
            action => [operations, self.handles.run_action(mesh, action, range), 0],
        }
    }

    /// Runs the element operations of some turns. Returns the same counts as
    /// [`run_range`](Self::run_range). Edits start at their first place.
    #[inline]
    fn run_turns(&self, mesh: &mut M, turns: Range<u64>) -> [u64; 3] {
        let mut sums = [0; 3];
        for turn in turns.clone() {
            for part in 0..self.schedule.parts.len() {
                let is_edit = matches!(self.schedule.parts[part].action, Action::Edit(_));
                let turn = if is_edit { turn - turns.start } else { turn };
                let range = self.schedule.turn_range(part, turn);
                if range.is_empty() {
                    continue;
                }
                let counts = self.run_range(mesh, part, range);
                sums = std::array::from_fn(|i| sums[i] + counts[i]);
            }
        }
        sums
    }
}

struct StructureMix<'a, M: Representation, W> {
    backend: Backend,
    mesh: M,
    polygons: &'a PolygonMesh,
    draw: &'a Draw,
    outputs: Outputs<M>,
    task: Task<'a, M, W>,
    /// The mesh prepared for the edits; `None` if there are no edits.
    prepared: Option<M>,
    /// Copies of `prepared`, each with the counts of its last run.
    copies: ReusedCopies<(M, [u64; 3])>,
    /// The structure for passes that make a mesh or visit a sample. It is built on first use.
    timed_backend: Option<Box<dyn TimedBackend + 'a>>,
}

impl<'a, M: Representation + 'static, W: WriteAccess<M>> StructureMix<'a, M, W> {
    fn new(input: &MixInput<'a>) -> Result<Self, MixRefusal> {
        let mesh = M::from_polygons(input.polygons)?;
        let faces = EditPlaces::new(input.schedule, input.polygons)?;
        let task = Task {
            schedule: input.schedule,
            handles: RouteHandles::from_route(input.route, &mesh, input.polygons, &faces.occupied),
            faces,
            places: Vec::new(),
            write_access: PhantomData,
        };
        let mut mix = Self {
            backend: input.backend,
            outputs: Outputs::for_mesh(&mesh),
            mesh,
            polygons: input.polygons,
            draw: input.draw,
            task,
            prepared: None,
            copies: ReusedCopies::default(),
            timed_backend: None,
        };
        mix.prepare_places();
        Ok(mix)
    }

    /// Finds the places and prepares a copy of the mesh for the edits. Returns for each edit and
    /// place whether the preparation succeeded.
    fn prepare_places(&mut self) -> Vec<Vec<bool>> {
        if self.task.faces.by_edit.is_empty() {
            return Vec::new();
        }
        let mut mesh = self.mesh.clone();
        let schedule = self.task.schedule;
        let edits = schedule
            .edits()
            .filter_map(|part| match schedule.parts[part].action {
                Action::Edit(edit) => Some(edit),
                _ => None,
            });
        let places = edits
            .clone()
            .zip(&self.task.faces.by_edit)
            .map(|(edit, faces)| {
                let place = |&f: &FaceId| EditPlace::new(&mesh, self.polygons, edit, f);
                faces.iter().map(place).collect()
            });
        let mut places: Vec<Vec<EditPlace<M>>> = places.collect();
        let is_prepared = edits.zip(&mut places).map(|(edit, places)| {
            let places = places.iter_mut();
            places
                .map(|place| W::prepare_place(&mut mesh, edit, place))
                .collect()
        });
        let is_prepared = is_prepared.collect();
        self.task.places = places;
        self.prepared = Some(mesh);
        is_prepared
    }

    /// Runs `work` once on the mesh. If there are edits, runs `work` `runs` times on copies. The
    /// copies are reset outside the timing.
    fn run_timed(
        &mut self,
        runs: usize,
        clock: &dyn Clock,
        work: impl Fn(&Task<'a, M, W>, &mut M) -> [u64; 3],
    ) -> MixRun {
        let Self {
            mesh,
            task,
            prepared,
            copies,
            ..
        } = self;
        let runs = if prepared.is_some() { runs.max(1) } else { 1 };
        let mut counts = [0; 3];
        let time = match prepared {
            None => timed(clock, || counts = work(task, black_box(mesh))),
            Some(prepared) => {
                let series = Series::with_runs(runs as u32, clock);
                let time = copies.time(
                    &series,
                    prepared.memory().total(),
                    || (prepared.clone(), counts),
                    |(copy, _)| copy.clone_from(prepared),
                    |(copy, counts)| *counts = work(task, copy),
                );
                counts = copies.used_copy().map_or(counts, |(_, counts)| *counts);
                time
            }
        };
        let [operations, yielded, refused] = counts.map(|count| count * runs as u64);
        MixRun {
            time,
            operations,
            yielded,
            refused,
        }
    }
}

impl<M: Representation + 'static, W: WriteAccess<M>> MixBackend for StructureMix<'_, M, W> {
    fn name(&self) -> &'static str {
        self.backend.name()
    }

    fn type_paths(&self) -> Vec<&'static str> {
        vec![M::type_path()]
    }

    fn bytes(&self) -> usize {
        self.mesh.memory().total()
    }

    fn merged_vertices(&self) -> usize {
        let input = self.polygons.vertex_count();
        input.saturating_sub(self.mesh.vertex_count())
    }

    fn scans(&self) -> Vec<bool> {
        let scans = |relation: &Relation| M::cost(*relation) == QueryCost::Scan;
        let of_part = |part: &Part| match part.action {
            Action::Edit(edit) => W::scans(edit),
            Action::SetPosition => W::scans(Edit::SetPosition),
            action => action.relations().iter().any(scans),
        };
        self.task.schedule.parts.iter().map(of_part).collect()
    }

    fn run(&mut self, turn: u64, turns: u64, copies: usize, clock: &dyn Clock) -> MixRun {
        self.run_timed(copies, clock, |task, mesh| {
            task.run_turns(mesh, turn..turn + turns)
        })
    }

    fn run_part(&mut self, part: usize, first: u64, operations: u64, clock: &dyn Clock) -> MixRun {
        let is_edit = self.task.edit(part).is_some();
        let first = if is_edit { 0 } else { first };
        self.run_timed(1, clock, |task, mesh| {
            task.run_range(mesh, part, first..first + operations)
        })
    }

    fn cycle_length(&self, part: usize) -> u64 {
        let places = |(_, places): (Edit, &[EditPlace<M>])| places.len() as u64;
        let elements = |kind| self.task.handles.len(kind) as u64;
        let action = self.task.schedule.parts[part].action;
        let of_elements = || action.kind().map_or(1, elements);
        self.task.edit(part).map_or_else(of_elements, places)
    }

    fn run_pass(
        &mut self,
        operation: Operation,
        sample: Option<ElementSample>,
        series: &Series<'_>,
    ) -> Run {
        if sample.is_none() && !operation.creates_mesh() && operation != Operation::VvSmooth {
            return pass_over(&self.mesh, &mut self.outputs, operation, series);
        }
        let timed_backend = match self.timed_backend.take() {
            Some(known) => known,
            None => match self.backend.prepare(self.polygons, Some(self.draw)) {
                Ok((built, _)) => built,
                Err(refusal) => return Run::refused(refusal.to_string(), series),
            },
        };
        let timed_backend = self.timed_backend.insert(timed_backend);
        timed_backend.run(&Job { operation, sample }, series)
    }

    fn accepted_places(&mut self) -> Vec<Vec<bool>> {
        let mut accepted = self.prepare_places();
        let Some(mut mesh) = self.prepared.clone() else {
            return accepted;
        };
        for (part, accepted) in self.task.schedule.edits().zip(&mut accepted) {
            let Some((edit, places)) = self.task.edit(part) else {
                continue;
            };
            for (place, accepted) in places.iter().zip(accepted) {
                *accepted = *accepted && W::apply_edit(&mut mesh, edit, place);
            }
        }
        accepted
    }

    fn keep_places(&mut self, accepted: &[Vec<bool>]) {
        self.task.faces = self.task.faces.filter_accepted(accepted);
        self.prepare_places();
    }

    fn build(&self, series: &Series<'_>) -> Time {
        let build = || M::from_polygons(black_box(self.polygons)).ok();
        let (time, _) = time_making(series, self.bytes(), build);
        time.scaled(1.0 / f64::from(series.runs))
    }
}

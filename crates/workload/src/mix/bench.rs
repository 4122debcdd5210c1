//! One structure on which a mix is run.

use std::hint::black_box;
use std::marker::PhantomData;
use std::ops::Range;

use sixfold::{
    BuildError, Edit, EditVisitor, FaceId, MeshEdit, Point, PolygonMesh, QueryCost, Relation,
    Representation, Visitor, visit, visit_editable,
};

use crate::backend::Backend;
use crate::candidate::{Job, Run, Sample, Subject};
use crate::clock::{Clock, Time, timed};
use crate::mix::passes::pass_over;
use crate::mix::places::{NoPlace, Places};
use crate::mix::route::Route;
use crate::mix::script::Script;
use crate::mix::streams::Streams;
use crate::mix::{MixRun, Mixer};
use crate::operation::Operation;
use crate::place::{Place, perform, prepare};
use crate::sample::Draw;
use crate::series::{KeptCopies, Series, time_making};
use crate::sweeps::Outputs;
use crate::workload::{Action, Part};

/// A structure ready for a mix, or the reason why it is not.
pub type MixOutcome<'a> = Result<Box<dyn Mixer + 'a>, MixRefusal>;

/// The reason why a structure cannot run a mix.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MixRefusal {
    /// The structure cannot hold the mesh.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The structure does not support the edit.
    #[error("it does not support {0}")]
    NoEdit(Edit),
    /// The mix cannot be run on this mesh with any structure.
    #[error(transparent)]
    NoPlace(#[from] NoPlace),
}

/// Builds the structure called `backend` from `polygons` and prepares it for `script` along
/// `route`. The mesh is editable if the script needs it. Returns `None` if there is no such
/// structure.
pub fn set_up<'a>(
    backend: &str,
    polygons: &'a PolygonMesh,
    draw: &'a Draw,
    script: &'a Script,
    route: &'a Route,
) -> Option<MixOutcome<'a>> {
    let mut start = Start {
        polygons,
        draw,
        script,
        route,
    };
    match script.editable {
        true => visit_editable(backend, &mut start),
        false => visit(backend, &mut start),
    }
}

struct Start<'a> {
    polygons: &'a PolygonMesh,
    draw: &'a Draw,
    script: &'a Script,
    route: &'a Route,
}

impl<'a> Visitor for Start<'a> {
    type Output = MixOutcome<'a>;

    fn visit<M: Representation + 'static>(&mut self) -> MixOutcome<'a> {
        let bench: Bench<'a, M, Never> = Bench::of(self)?;
        Ok(Box::new(bench))
    }
}

impl<'a> EditVisitor for Start<'a> {
    type Output = MixOutcome<'a>;

    fn visit<M: Representation + MeshEdit + 'static>(&mut self) -> MixOutcome<'a> {
        for part in &self.script.parts {
            if let Action::Edit(edit) = part.action
                && !M::offers(edit)
            {
                return Err(MixRefusal::NoEdit(edit));
            }
        }
        let bench: Bench<'a, M, ByEdits> = Bench::of(self)?;
        Ok(Box::new(bench))
    }
}

/// The write access to a mesh.
trait Writing<M: Representation> {
    fn set_position(mesh: &mut M, v: M::Vertex, to: Point);
    fn prepare(mesh: &mut M, edit: Edit, place: &mut Place<M>) -> bool;
    fn perform(mesh: &mut M, edit: Edit, place: &Place<M>) -> bool;
    /// Returns whether an edit visits all faces of the mesh.
    fn scans(edit: Edit) -> bool;
}

/// The write access of scripts that only read; its methods are never called.
struct Never;

impl<M: Representation> Writing<M> for Never {
    fn set_position(_: &mut M, _: M::Vertex, _: Point) {}
    fn prepare(_: &mut M, _: Edit, _: &mut Place<M>) -> bool {
        false
    }
    fn perform(_: &mut M, _: Edit, _: &Place<M>) -> bool {
        false
    }
    fn scans(_: Edit) -> bool {
        false
    }
}

/// The write access through [`MeshEdit`].
struct ByEdits;

impl<M: Representation + MeshEdit> Writing<M> for ByEdits {
    #[inline(always)]
    fn set_position(mesh: &mut M, v: M::Vertex, to: Point) {
        // Writes the current position: no structure refuses this, and the mesh does not change.
        let _ = black_box(mesh.set_position(v, to, &mut ()).is_ok());
    }
    fn prepare(mesh: &mut M, edit: Edit, place: &mut Place<M>) -> bool {
        prepare(mesh, edit, place).is_ok()
    }
    #[inline(always)]
    fn perform(mesh: &mut M, edit: Edit, place: &Place<M>) -> bool {
        perform(mesh, edit, place).is_ok()
    }
    fn scans(edit: Edit) -> bool {
        M::EDITS[edit as usize] == Some(QueryCost::Scan)
    }
}

/// The work of a mix: the script, the handles of the route, and the places of the edits.
struct Doing<'a, M: Representation, W> {
    script: &'a Script,
    streams: Streams<M>,
    chosen: Places,
    /// By edit of the script: its places, on a mesh prepared for the edits.
    places: Vec<Vec<Place<M>>>,
    writing: PhantomData<W>,
}

impl<M: Representation, W: Writing<M>> Doing<'_, M, W> {
    /// Returns the edit of `part` with its places; `None` if `part` is not an edit.
    fn edit(&self, part: usize) -> Option<(Edit, &[Place<M>])> {
        let nth = self.script.edits().position(|other| other == part)?;
        match self.script.parts[part].action {
            Action::Edit(edit) => Some((edit, self.places.get(nth)?)),
            _ => None,
        }
    }

    /// Runs the operations `range` of one part on `mesh`; for edits, `range` is a range of places.
    /// Returns the number of operations, the number of results, and the number of refused edits.
    #[inline]
    fn act(&self, mesh: &mut M, part: usize, range: Range<u64>) -> [u64; 3] {
        let operations = range.end - range.start;
        match self.script.parts[part].action {
            Action::SetPosition => {
                for run in self.streams.vertices(range) {
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
                let refused = some.iter().filter(|place| !W::perform(mesh, edit, place));
                let refused = refused.count() as u64;
                let done = some.len() as u64 - refused;
                [some.len() as u64, done, refused]
            }
            action => [operations, self.streams.ask(mesh, action, range), 0],
        }
    }

    /// Runs the element operations of some turns and returns the counts of [`act`](Self::act).
    /// Edits start at their first place, because each call gets a fresh copy of the mesh.
    #[inline]
    fn turns(&self, mesh: &mut M, turns: Range<u64>) -> [u64; 3] {
        let mut sums = [0; 3];
        for turn in turns.clone() {
            for part in 0..self.script.parts.len() {
                let is_edit = matches!(self.script.parts[part].action, Action::Edit(_));
                let turn = if is_edit { turn - turns.start } else { turn };
                let range = self.script.turn(part, turn);
                if range.is_empty() {
                    continue;
                }
                let came_to = self.act(mesh, part, range);
                sums = std::array::from_fn(|i| sums[i] + came_to[i]);
            }
        }
        sums
    }
}

/// A structure and the work of a mix on it.
struct Bench<'a, M: Representation, W> {
    mesh: M,
    polygons: &'a PolygonMesh,
    draw: &'a Draw,
    outputs: Outputs<M>,
    doing: Doing<'a, M, W>,
    /// The mesh prepared for its edits; `None` if there are no edits.
    ready: Option<M>,
    /// Copies of `ready`, each with the counts of the last run on it.
    copies: KeptCopies<(M, [u64; 3])>,
    /// The structure as a study measures it, for passes that make a mesh or visit a sample. Built
    /// when first needed.
    as_studied: Option<Box<dyn Subject + 'a>>,
}

impl<'a, M: Representation + 'static, W: Writing<M>> Bench<'a, M, W> {
    fn of(start: &Start<'a>) -> Result<Self, MixRefusal> {
        let mesh = M::from_polygons(start.polygons)?;
        let chosen = Places::of(start.script, start.polygons)?;
        let doing = Doing {
            script: start.script,
            streams: Streams::along(start.route, &mesh, start.polygons, &chosen.taken),
            chosen,
            places: Vec::new(),
            writing: PhantomData,
        };
        let mut bench = Self {
            outputs: Outputs::for_mesh(&mesh),
            mesh,
            polygons: start.polygons,
            draw: start.draw,
            doing,
            ready: None,
            copies: KeptCopies::default(),
            as_studied: None,
        };
        bench.look_up();
        Ok(bench)
    }

    /// Looks up the handles of the places and prepares a copy of the mesh for the edits there.
    /// Returns for each edit and place whether the preparation succeeded.
    fn look_up(&mut self) -> Vec<Vec<bool>> {
        if self.doing.chosen.by_edit.is_empty() {
            return Vec::new();
        }
        let mut mesh = self.mesh.clone();
        let script = self.doing.script;
        let edits = script
            .edits()
            .filter_map(|part| match script.parts[part].action {
                Action::Edit(edit) => Some(edit),
                _ => None,
            });
        let named = edits
            .clone()
            .zip(&self.doing.chosen.by_edit)
            .map(|(edit, faces)| {
                let place = |&f: &FaceId| Place::of(&mesh, self.polygons, edit, f);
                faces.iter().map(place).collect()
            });
        let mut places: Vec<Vec<Place<M>>> = named.collect();
        let prepared = edits.zip(&mut places).map(|(edit, places)| {
            let places = places.iter_mut();
            places
                .map(|place| W::prepare(&mut mesh, edit, place))
                .collect()
        });
        let prepared = prepared.collect();
        self.doing.places = places;
        self.ready = Some(mesh);
        prepared
    }

    /// Runs `work` once on the mesh. If there are edits, runs it `runs` times on copies that are
    /// reset outside the timing.
    fn run_timed(
        &mut self,
        runs: usize,
        clock: &dyn Clock,
        work: impl Fn(&Doing<'a, M, W>, &mut M) -> [u64; 3],
    ) -> MixRun {
        let Self {
            mesh,
            doing,
            ready,
            copies,
            ..
        } = self;
        let runs = if ready.is_some() { runs.max(1) } else { 1 };
        let mut counts = [0; 3];
        let time = match ready {
            None => timed(clock, || counts = work(doing, black_box(mesh))),
            Some(ready) => {
                let series = Series::of_runs(runs as u32, clock);
                let time = copies.time(
                    &series,
                    ready.memory().total(),
                    || (ready.clone(), counts),
                    |(copy, _)| copy.clone_from(ready),
                    |(copy, counts)| *counts = work(doing, copy),
                );
                // All runs have the same counts.
                counts = copies.changed().map_or(counts, |(_, counts)| *counts);
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

impl<M: Representation + 'static, W: Writing<M>> Mixer for Bench<'_, M, W> {
    fn name(&self) -> &'static str {
        M::NAME
    }

    fn type_paths(&self) -> Vec<&'static str> {
        vec![M::type_path()]
    }

    fn bytes(&self) -> usize {
        self.mesh.memory().total()
    }

    fn merged_vertices(&self) -> usize {
        {
            let input = self.polygons.vertex_count();
            input.saturating_sub(self.mesh.vertex_count())
        }
    }

    fn scans(&self) -> Vec<bool> {
        let scans = |relation: &Relation| M::COSTS[*relation as usize] == QueryCost::Scan;
        let of_part = |part: &Part| match part.action {
            Action::Edit(edit) => W::scans(edit),
            Action::SetPosition => W::scans(Edit::SetPosition),
            action => action.relations().iter().any(scans),
        };
        self.doing.script.parts.iter().map(of_part).collect()
    }

    fn run(&mut self, turn: u64, turns: u64, copies: usize, clock: &dyn Clock) -> MixRun {
        self.run_timed(copies, clock, |doing, mesh| {
            doing.turns(mesh, turn..turn + turns)
        })
    }

    fn run_part(&mut self, part: usize, first: u64, operations: u64, clock: &dyn Clock) -> MixRun {
        let is_edit = self.doing.edit(part).is_some();
        let first = if is_edit { 0 } else { first };
        self.run_timed(1, clock, |doing, mesh| {
            doing.act(mesh, part, first..first + operations)
        })
    }

    fn cycle(&self, part: usize) -> u64 {
        let places = |(_, places): (Edit, &[Place<M>])| places.len() as u64;
        let elements = |kind| self.doing.streams.len(kind) as u64;
        let action = self.doing.script.parts[part].action;
        let of_elements = || action.kind().map_or(1, elements);
        self.doing.edit(part).map_or_else(of_elements, places)
    }

    fn run_pass(
        &mut self,
        operation: Operation,
        sample: Option<Sample>,
        series: &Series<'_>,
    ) -> Run {
        if sample.is_none() && !operation.makes_a_mesh() && operation != Operation::VvSmooth {
            return pass_over(&self.mesh, &mut self.outputs, operation, series);
        }
        if self.as_studied.is_none() {
            let roster = Backend::roster();
            let backend = roster.iter().find(|backend| backend.name() == M::NAME);
            let built = backend.map(|b| b.put_on_the_bench(self.polygons, Some(self.draw)));
            self.as_studied = built.and_then(Result::ok).map(|(subject, _)| subject);
        }
        match &mut self.as_studied {
            Some(subject) => subject.run(&Job { operation, sample }, series),
            None => Run {
                refusal: Some("no such structure is in the roster".into()),
                ..Run::done(Time::none_like(series.clock.now()), None)
            },
        }
    }

    fn accepted(&mut self) -> Vec<Vec<bool>> {
        let mut accepted = self.look_up();
        let Some(mut mesh) = self.ready.clone() else {
            return accepted;
        };
        for (part, accepted) in self.doing.script.edits().zip(&mut accepted) {
            let Some((edit, places)) = self.doing.edit(part) else {
                continue;
            };
            for (place, accepted) in places.iter().zip(accepted) {
                *accepted = *accepted && W::perform(&mut mesh, edit, place);
            }
        }
        accepted
    }

    fn keep(&mut self, accepted: &[Vec<bool>]) {
        self.doing.chosen = self.doing.chosen.kept(accepted);
        self.look_up();
    }

    fn build(&self, series: &Series<'_>) -> Time {
        let build = || M::from_polygons(black_box(self.polygons)).ok();
        let (time, _) = time_making(series, self.bytes(), build);
        time.scaled(1.0 / f64::from(series.runs))
    }
}

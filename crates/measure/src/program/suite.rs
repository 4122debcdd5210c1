//! Programs with the structures on which they run.

use std::sync::Arc;

use sixfold::{
    MeshEdit, OrientedWalk, PolygonMesh, QueryCost, Refine, Representation, StructureInfo,
    for_each_editable, for_each_refinable, for_each_representation, for_each_walkable,
};

use super::forms::{Edits, Form, Moves, Queries, Refinements, Walks};
use super::on_tables::{MadeFrom, OnTables};
use super::recorded::{Asked, Recorded};
use super::subject::{ProgramRefusal, RecordedRun, Subject, record, run_once};
use super::tape::TapedRun;
use super::{EditProgram, MovingProgram, Program, RefineProgram, WalkProgram};
use crate::job::{Outcome, TimedBackend};
use crate::tables::{TABLE_TYPE, TABLES};
use crate::trace::{EditReplay, PlainReplay, Trace};

/// Programs that are measured one after the other.
///
/// A [`Program`] can be used in place of a suite of one program.
#[derive(Default)]
pub struct Suite {
    programs: Vec<SuiteProgram>,
}

/// A program with the structures on which it runs.
pub struct SuiteProgram {
    name: String,
    kind: ProgramKind,
    contestants: Vec<Contestant>,
    own_ns: f64,
}

sixfold_core::named! {
    /// What a program needs of a structure.
    pub enum ProgramKind: "kind of program" {
        /// The program is a [`Program`].
        Queries = "queries",
        /// The program is a [`WalkProgram`].
        Walks = "walks",
        /// The program is a [`MovingProgram`].
        Moves = "moves",
        /// The program is an [`EditProgram`].
        Edits = "edits",
        /// The program is a [`RefineProgram`].
        Refines = "refines",
    }
}

/// A structure on which a program runs.
pub struct Contestant {
    info: StructureInfo,
    type_paths: Vec<&'static str>,
    /// The structure from which relation tables are made; `None` for a structure.
    made_from: Option<StructureInfo>,
    prepare: Box<Prepare>,
    record: Option<Box<Record>>,
    /// Prepares the trace of a recorded run, to run it on the structure.
    replay: Option<Box<Replay>>,
    /// Runs the program once, in one order if the argument is true.
    run_once: Option<Box<RunOnce>>,
}

/// Builds the structure and the scratch data of the program.
type Prepare =
    dyn for<'p> Fn(&'p PolygonMesh) -> Result<Box<dyn TimedBackend + 'p>, ProgramRefusal>;

/// Builds the structure, and looks up the elements that the trace names.
type Replay =
    dyn for<'p> Fn(&Trace, &'p PolygonMesh) -> Result<Box<dyn TimedBackend + 'p>, ProgramRefusal>;

/// Runs the program once, in one order of elements if the last argument is true.
type RunOnce = dyn Fn(&PolygonMesh, bool) -> Result<Outcome, ProgramRefusal>;

/// Runs the program once on the recorded structure.
type Record = dyn Fn(&PolygonMesh, bool) -> Result<RecordedRun, ProgramRefusal>;

impl Suite {
    /// Makes an empty suite.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the programs.
    pub fn programs(&self) -> &[SuiteProgram] {
        &self.programs
    }

    /// Keeps only the programs with one of `names`.
    #[must_use]
    pub fn only<N: AsRef<str>>(mut self, names: &[N]) -> Self {
        let is_named = |p: &SuiteProgram| names.iter().any(|name| name.as_ref() == p.name);
        self.programs.retain(is_named);
        self
    }

    /// Makes a suite of one program, whose own work takes `own_ns` in each run.
    #[doc(hidden)]
    pub fn of_contestants(
        name: String,
        kind: ProgramKind,
        contestants: Vec<Contestant>,
        own_ns: f64,
    ) -> Self {
        let mut suite = Self::new().with(name, kind, contestants);
        if let Some(program) = suite.programs.last_mut() {
            program.own_ns = own_ns;
        }
        suite
    }

    /// Adds the contestants to the program called `name`.
    fn with(mut self, name: String, kind: ProgramKind, contestants: Vec<Contestant>) -> Self {
        let mut same = self.programs.iter_mut();
        match same.find(|p| p.name == name && p.kind == kind) {
            Some(program) => program.contestants.extend(contestants),
            None => self.programs.push(SuiteProgram {
                name,
                kind,
                contestants,
                own_ns: 0.0,
            }),
        }
        self
    }
}

/// Defines two methods for each kind of program: one adds a program on all structures of Sixfold,
/// the other lets a program also run on a structure of another crate. `recorded` are the kinds that
/// can be recorded, and `and` adds a contestant that is not a structure.
macro_rules! kinds_of_programs {
    ($(
        $kind:ident: $program:ident as $form:ident $(, recorded as $recorded:ident and run again as $replay:ident)?;
        $(#[$about:meta])*
        fn $add:ident in $each:ident $(and $other:ident)?;
        $(#[$about_on:meta])*
        fn $add_on:ident on $($bound:ident),+;
    )+) => {
        impl Suite {$(
            $(#[$about])*
            #[must_use]
            pub fn $add<P: $program + 'static>(self, program: P) -> Self {
                let (name, program) = (program.name().to_owned(), Arc::new(program));
                let mut contestants = Vec::new();
                $each!(M => {
                    let contestant = Contestant::new::<$form<P, M>>(&program);
                    $(let contestant = contestant.recorded::<$recorded<P, Recorded<M>>, M>(&name, &program).replayed::<$replay<M>>();)?
                    contestants.push(contestant);
                });
                $(contestants.push(Contestant::$other(&program));)?
                self.with(name, ProgramKind::$kind, contestants)
            }

            $(#[$about_on])*
            #[must_use]
            pub fn $add_on<P, M>(self, program: P) -> Self
            where
                P: $program + 'static,
                M: $($bound +)+ 'static,
            {
                let (name, program) = (program.name().to_owned(), Arc::new(program));
                let contestant = Contestant::new::<$form<P, M>>(&program);
                $(let contestant = contestant.recorded::<$recorded<P, Recorded<M>>, M>(&name, &program).replayed::<$replay<M>>();)?
                self.with(name, ProgramKind::$kind, vec![contestant])
            }
        )+}
    };
}

kinds_of_programs! {
    Queries: Program as Queries, recorded as Queries and run again as PlainReplay;
    /// Adds a program that only queries the mesh. It also runs on flat tables of the relations that
    /// it queries.
    fn program in for_each_representation and on_tables;
    /// Lets a program that only queries the mesh also run on `M`, a structure of another crate. If
    /// the suite has no program of the same name, the program is added, and runs only on `M`. The
    /// other kinds of programs have methods of the same form:
    /// [`walk_program_on`](Self::walk_program_on), [`moving_program_on`](Self::moving_program_on),
    /// [`edit_program_on`](Self::edit_program_on) and
    /// [`refine_program_on`](Self::refine_program_on).
    fn on_structure on Representation;

    Walks: WalkProgram as Walks, recorded as Walks and run again as PlainReplay;
    /// Adds a program that walks along the sides of faces.
    fn walk_program in for_each_walkable;
    /// Lets a program that walks along the sides of faces also run on `M`, a structure of another
    /// crate, like [`on_structure`](Self::on_structure).
    fn walk_program_on on Representation, OrientedWalk;

    Moves: MovingProgram as Moves, recorded as Moves and run again as PlainReplay;
    /// Adds a program that moves the vertices.
    fn moving_program in for_each_representation;
    /// Lets a program that moves the vertices also run on `M`, a structure of another crate, like
    /// [`on_structure`](Self::on_structure).
    fn moving_program_on on Representation;

    Edits: EditProgram as Edits, recorded as Edits and run again as EditReplay;
    /// Adds a program that edits the mesh.
    fn edit_program in for_each_editable;
    /// Lets a program that edits the mesh also run on `M`, the editable type of a structure of
    /// another crate, like [`on_structure`](Self::on_structure).
    fn edit_program_on on Representation, MeshEdit;

    Refines: RefineProgram as Refinements;
    /// Adds a program that splits all faces.
    fn refine_program in for_each_refinable;
    /// Lets a program that splits all faces also run on `M`, a structure of another crate, like
    /// [`on_structure`](Self::on_structure).
    fn refine_program_on on Refine;
}

/// A trace as a program of its own, which runs on every structure that supports its calls.
///
/// It is a macro, so that the crate that calls it compiles the traces for all structures, with its own optimisation.
#[doc(hidden)]
#[macro_export]
macro_rules! suite_of_trace {
    ($trace:expr) => {{
        let trace: $crate::Trace = $trace;
        let (name, kind) = (trace.program.clone(), trace.kind());
        let own_ns = trace.own_ns;
        let trace = ::std::sync::Arc::new(trace);
        let mut contestants = Vec::new();
        match kind {
            $crate::ProgramKind::Edits => {
                ::sixfold::for_each_editable!(M => {
                    contestants.push($crate::Contestant::new::<$crate::EditReplay<M>>(&trace));
                });
            }
            _ => {
                ::sixfold::for_each_representation!(M => {
                    contestants.push($crate::Contestant::new::<$crate::PlainReplay<M>>(&trace));
                });
            }
        }
        $crate::Suite::of_contestants(name, kind, contestants, own_ns)
    }};
}

impl<P: Program + 'static> From<P> for Suite {
    fn from(program: P) -> Self {
        Self::new().program(program)
    }
}

impl SuiteProgram {
    /// Returns the name of the program.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns what the program needs: `queries`, `walks`, `moves`, `edits` or `refines`.
    pub fn kind(&self) -> &'static str {
        self.kind.name()
    }

    /// Returns whether a run can be recorded: the calls of a program that walks along sides, or that
    /// refines the mesh, are not part of a trace.
    pub fn can_be_recorded(&self) -> bool {
        !matches!(self.kind, ProgramKind::Walks | ProgramKind::Refines)
    }

    /// Returns true if a run changes the mesh, so that each run needs a fresh copy.
    pub fn changes_mesh(&self) -> bool {
        matches!(self.kind, ProgramKind::Moves | ProgramKind::Edits)
    }

    /// Returns the time of one run that is added to the measured time, in nanoseconds. It is 0 unless
    /// the program is a trace, see [`Trace::own_ns`].
    pub fn own_ns(&self) -> f64 {
        self.own_ns
    }

    /// Returns the structures on which the program runs.
    pub fn contestants(&self) -> &[Contestant] {
        &self.contestants
    }
}

/// Returns whether two texts are equal.
const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

impl Contestant {
    /// Makes a contestant that runs `program` as `F`.
    #[doc(hidden)]
    pub fn new<F>(program: &Arc<F::Program>) -> Self
    where
        F: Form + 'static,
        F::Program: 'static,
    {
        let program = Arc::clone(program);
        Self {
            info: StructureInfo::new::<F::Mesh>(),
            type_paths: vec![F::Mesh::type_path()],
            made_from: None,
            prepare: Box::new(move |polygons| {
                Ok(Box::new(Subject::<F>::new(Arc::clone(&program), polygons)?))
            }),
            record: None,
            replay: None,
            run_once: None,
        }
    }

    /// Returns relation tables on which `program` runs.
    fn on_tables<P: Program + 'static>(program: &Arc<P>) -> Self {
        let program = Arc::clone(program);
        let made_from = StructureInfo::new::<MadeFrom>();
        Self {
            info: StructureInfo {
                name: TABLES,
                costs: [QueryCost::Local; 9],
                ..made_from
            },
            type_paths: vec![MadeFrom::type_path(), TABLE_TYPE],
            made_from: Some(made_from),
            prepare: Box::new(move |polygons| {
                Ok(Box::new(OnTables::new(Arc::clone(&program), polygons)?))
            }),
            record: None,
            replay: None,
            run_once: None,
        }
    }

    /// Adds the recording. `F` is the same kind of program on the recorded structure.
    fn recorded<F, M>(self, name: &str, program: &Arc<F::Program>) -> Self
    where
        F: Form<Mesh = Recorded<M>> + 'static,
        F::Program: 'static,
        M: Representation,
    {
        // Programs are recorded only where no query scans the mesh; the code for the others is not compiled.
        if const { !QueryCost::are_local(&M::COSTS) } {
            return self;
        }
        let (name, again) = (name.to_owned(), Arc::clone(program));
        let program = Arc::clone(program);
        Self {
            record: Some(Box::new(move |polygons, traced| {
                record::<F, M>(&program, &name, polygons, traced)
            })),
            run_once: Some(Box::new(move |polygons, canonical| {
                run_once::<F, M>(&again, polygons, canonical)
            })),
            ..self
        }
    }

    /// Adds running a trace again. `F` is a trace on the structure.
    fn replayed<F: Form<Program = Trace> + 'static>(self) -> Self {
        if const { !QueryCost::are_local(&F::Mesh::COSTS) } {
            return self;
        }
        // The code for a trace with edits is the largest. It is compiled for one structure, which holds every mesh.
        if const { F::EDITS && !is_same(F::Mesh::NAME, MadeFrom::NAME) } {
            return self;
        }
        Self {
            replay: Some(Box::new(|trace, polygons| {
                let trace = Arc::new(trace.clone());
                Ok(Box::new(Subject::<F>::new(trace, polygons)?))
            })),
            ..self
        }
    }

    /// Runs the program once, without timing. If `canonical`, all lists of elements and all results of queries are in one
    /// order, which is the same on every structure, see [`Recorded::start_canonical_order`]. Returns `None` if queries of
    /// the structure scan the mesh, or if the kind of program cannot be recorded.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`prepare`](Self::prepare).
    pub fn run_once(
        &self,
        polygons: &PolygonMesh,
        canonical: bool,
    ) -> Option<Result<Outcome, ProgramRefusal>> {
        Some(self.run_once.as_ref()?(polygons, canonical))
    }

    /// Returns whether a recorded run of the program can run again on the structure, to measure the program's own time.
    pub fn can_run_again(&self) -> bool {
        self.replay.is_some()
    }

    /// Prepares the trace of a recorded run of the program, to run it on the structure. Returns `None` if
    /// [`can_run_again`](Self::can_run_again) is false.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold the mesh, or if the trace does not run on it.
    pub fn replay<'p>(
        &self,
        trace: &Trace,
        polygons: &'p PolygonMesh,
    ) -> Option<Result<Box<dyn TimedBackend + 'p>, ProgramRefusal>> {
        Some(self.replay.as_ref()?(trace, polygons))
    }

    /// Returns the name of the structure, such as `half-edge`.
    pub fn name(&self) -> &'static str {
        self.info.name
    }

    /// Returns the properties of the structure that do not depend on a mesh.
    pub fn info(&self) -> &StructureInfo {
        &self.info
    }

    /// Runs the program once, and counts what it asks. Returns `None` if the kind of program cannot
    /// be recorded.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`prepare`](Self::prepare).
    pub fn record(&self, polygons: &PolygonMesh) -> Option<Result<Asked, ProgramRefusal>> {
        Some(self.record.as_ref()?(polygons, false).map(|run| run.asked))
    }

    /// Runs the program once, and keeps what it asks. Returns `None` if the kind of program cannot be
    /// recorded, or if it has more than 16 million calls. Steps along sides are counted, but are not
    /// part of the trace.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`prepare`](Self::prepare).
    pub fn record_calls(&self, polygons: &PolygonMesh) -> Option<Result<TapedRun, ProgramRefusal>> {
        match self.record.as_ref()?(polygons, true) {
            Ok(run) => Some(Ok(run.taped?)),
            Err(refusal) => Some(Err(refusal)),
        }
    }

    /// Returns the structure from which relation tables are made; `None` for a structure.
    pub fn made_from(&self) -> Option<&StructureInfo> {
        self.made_from.as_ref()
    }

    /// Returns the Rust paths of the types: the structure, and relation tables made from it.
    pub fn type_paths(&self) -> &[&'static str] {
        &self.type_paths
    }

    /// Builds the structure and the scratch data of the program.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold the mesh, or if the program refuses the mesh
    /// or panics.
    pub fn prepare<'p>(
        &self,
        polygons: &'p PolygonMesh,
    ) -> Result<Box<dyn TimedBackend + 'p>, ProgramRefusal> {
        (self.prepare)(polygons)
    }
}

#[cfg(test)]
mod tests {
    use sixfold::{EditableHalfEdgeMesh, HalfEdgeMesh, MeshQuery, Point, Split, shapes};

    use super::*;

    /// Implements each kind of program with the same methods.
    macro_rules! programs {
        ($($name:ident: $kind:ident on $bound:path, $run:expr, $mesh:ty;)+) => {
            $(
                struct $name;

                impl $kind for $name {
                    type Scratch<M: $bound> = ();

                    fn name(&self) -> &str {
                        "of-the-test"
                    }

                    fn set_up<M: $bound>(&self, _: &M) -> Result<(), String> {
                        Ok(())
                    }

                    fn run<M: $bound>(&self, mesh: $mesh, (): &mut ()) -> Outcome {
                        Outcome::new($run(mesh) as f64, 1)
                    }
                }
            )+
        };
    }

    programs! {
        Count: Program on MeshQuery, |mesh: &M| mesh.face_count(), &M;
        Walk: WalkProgram on OrientedWalk, |mesh: &M| mesh.sides().count(), &M;
        Move: MovingProgram on Representation, |mesh: &mut M| {
            let points = mesh.vertices().map(|_| Point::ZERO).collect::<Vec<_>>();
            points.len()
        }, &mut M;
        Remove: EditProgram on MeshEdit, |mesh: &mut M| {
            let first = mesh.faces().next().expect("a face");
            usize::from(mesh.remove_face(first).is_ok())
        }, &mut M;
        Halve: RefineProgram on Refine, |mesh: &M| {
            let split = M::SPLITS.contains(&Split::Triangles);
            mesh.face_count() + usize::from(split)
        }, &M;
    }

    #[test]
    fn every_kind_of_program_runs_on_a_structure_of_another_crate() {
        type Mesh = HalfEdgeMesh;
        type Editable = EditableHalfEdgeMesh;
        let cases = [
            (
                Suite::new().on_structure::<_, Mesh>(Count),
                Suite::new().program(Count).on_structure::<_, Mesh>(Count),
            ),
            (
                Suite::new().walk_program_on::<_, Mesh>(Walk),
                Suite::new()
                    .walk_program(Walk)
                    .walk_program_on::<_, Mesh>(Walk),
            ),
            (
                Suite::new().moving_program_on::<_, Mesh>(Move),
                Suite::new()
                    .moving_program(Move)
                    .moving_program_on::<_, Mesh>(Move),
            ),
            (
                Suite::new().edit_program_on::<_, Editable>(Remove),
                Suite::new()
                    .edit_program(Remove)
                    .edit_program_on::<_, Editable>(Remove),
            ),
            (
                Suite::new().refine_program_on::<_, Mesh>(Halve),
                Suite::new()
                    .refine_program(Halve)
                    .refine_program_on::<_, Mesh>(Halve),
            ),
        ];
        let polygons = shapes::icosahedron();
        for (alone, added) in cases {
            let ([alone], [added]) = (alone.programs(), added.programs()) else {
                panic!("a program that is added twice has one entry");
            };
            assert_eq!(alone.kind(), added.kind());
            let [contestant] = alone.contestants() else {
                panic!("{}: only on the structure", alone.kind());
            };
            assert_eq!(contestant.name(), "half-edge");
            assert!(contestant.prepare(&polygons).is_ok(), "{}", alone.kind());
            let names: Vec<_> = added.contestants().iter().map(Contestant::name).collect();
            let count = names.iter().filter(|name| **name == "half-edge").count();
            assert_eq!((count, names.last()), (2, Some(&"half-edge")), "{names:?}");
        }
    }
}

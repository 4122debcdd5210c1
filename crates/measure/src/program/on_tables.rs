//! A program on flat tables of the relations that it queries.

use std::hint::black_box;
use std::sync::Arc;

use sixfold::{FaceVertexMesh, MeshQuery, PolygonMesh, QueryCost, Relation, Representation};
use sixfold_relation_table::RelationTables;

use super::Program;
use super::forms::{Queries, refuses};
use super::panics::catch;
use super::recorded::Recorded;
use super::subject::{FirstResult, ONLY_WHOLE, ProgramRefusal, record, run_program};
use crate::job::{Job, Outcome, Task, TimedBackend, TimedRun};
use crate::operation::Operation;
use crate::series::Series;
use crate::tables::{TABLES, time_building};
use sixfold_results::Time;

/// The structure from which the tables are made. It holds every mesh.
pub(super) type MadeFrom = FaceVertexMesh;

/// A program that only queries, on tables.
pub(super) struct OnTables<'p, P: Program> {
    program: Arc<P>,
    polygons: &'p PolygonMesh,
    relations: Vec<Relation>,
    tables: RelationTables,
    scratch: P::Scratch<RelationTables>,
    merged: usize,
    first: FirstResult,
}

impl<'p, P: Program> OnTables<'p, P> {
    /// Finds the relations by a recorded run, and builds the tables and the scratch data.
    pub(super) fn new(program: Arc<P>, polygons: &'p PolygonMesh) -> Result<Self, ProgramRefusal> {
        let run =
            record::<Queries<P, Recorded<MadeFrom>>, MadeFrom>(&program, "", polygons, false)?;
        let is_asked = |relation: &Relation| {
            [run.asked, run.at_set_up]
                .iter()
                .any(|asked| asked.relations[*relation as usize] > 0)
        };
        let relations: Vec<Relation> = Relation::ALL.into_iter().filter(is_asked).collect();
        let mesh = MadeFrom::from_polygons(polygons)?;
        let tables = RelationTables::new(&mesh, &relations)
            .map_err(|reason| ProgramRefusal::Refused(reason.to_string()))?;
        let refused = |reason: String| ProgramRefusal::Refused(refuses(&reason));
        let set_up = || program.set_up(&tables).map_err(refused);
        let scratch = catch(set_up).map_err(ProgramRefusal::Panicked)??;
        Ok(Self {
            merged: polygons.vertex_count() - tables.vertex_count(),
            program,
            polygons,
            relations,
            tables,
            scratch,
            first: FirstResult::default(),
        })
    }

    fn run_program(&mut self, series: &Series<'_>) -> Result<(Time, Option<Outcome>), String> {
        let Self {
            program,
            tables,
            scratch,
            first,
            ..
        } = self;
        let mut last = None;
        let time = series.time_together(|| {
            last = black_box(Some(program.run(black_box(&*tables), scratch)));
        });
        let outcome = last.map(|last| first.checked(last)).transpose()?;
        Ok((time, outcome.filter(|_| series.check)))
    }

    fn build(&self, series: &Series<'_>) -> (Time, Option<Outcome>) {
        let bytes = self.tables.bytes();
        let time = time_building::<MadeFrom>(self.polygons, &self.relations, bytes, series);
        let faces = self.tables.face_count();
        let outcome = series
            .check
            .then(|| Outcome::new(faces as f64, faces as u64));
        (time, outcome)
    }
}

impl<P: Program> TimedBackend for OnTables<'_, P> {
    fn name(&self) -> &str {
        TABLES
    }

    fn costs(&self) -> [QueryCost; 9] {
        [QueryCost::Local; 9]
    }

    fn merged_vertices(&self) -> usize {
        self.merged
    }

    fn tabulated(&self) -> Vec<Relation> {
        self.relations.clone()
    }

    fn bytes(&self) -> usize {
        self.tables.bytes()
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

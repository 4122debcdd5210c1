//! Runs a mix on flat tables of the queried relations.

use std::hint::black_box;
use std::ops::Range;

use sixfold::{MeshQuery, Point, PolygonMesh, QueryCost, Relation, Representation};
use sixfold_relation_table::{Numbering, RelationTables};

use crate::backend::Backend;
use crate::mix::own_data::OwnMemory;
use crate::mix::route::Route;
use crate::mix::route_handles::{from_route, run_action, vertices_of};
use crate::mix::runs::{Counts, time_part, time_turns};
use crate::mix::schedule::Schedule;
use crate::mix::{MixBackend, NO_PROGRAM};
use crate::passes::run_whole;
use crate::sweeps::Outputs;
use crate::workload::Action;
use sixfold_measure::{
    HandleLists, Job, Operation, Outcome, Series, TABLE_TYPE, TABLES, Task, TimedBackend, TimedRun,
    time_building,
};
use sixfold_results::Time;

/// Builds the structure of `backend` from `polygons`, and copies the relations that `schedule`
/// queries into flat tables. Returns `None` if the structure cannot hold `polygons` or if an
/// operation of the schedule changes the connectivity of the mesh.
pub fn tabulate<'a>(
    backend: &Backend,
    polygons: &'a PolygonMesh,
    schedule: &'a Schedule,
    route: &'a Route,
) -> Option<Box<dyn MixBackend + 'a>> {
    let mut actions = schedule.parts.iter().map(|part| part.action);
    match actions.any(|action| action.changes_connectivity()) {
        true => None,
        false => (backend.queries.tabulate)(polygons, schedule, route),
    }
}

pub(crate) fn tabulate_structure<'a, M: Representation + 'static>(
    polygons: &'a PolygonMesh,
    schedule: &'a Schedule,
    route: &'a Route,
) -> Option<Box<dyn MixBackend + 'a>> {
    let mesh = M::from_polygons(polygons).ok()?;
    let tables = RelationTables::new(&mesh, &relations(schedule)).ok()?;
    let handles = route_handles(&mesh, polygons, route);
    Some(Box::new(TableMix {
        outputs: Outputs::for_mesh(&tables),
        moved: tables.positions().to_vec(),
        merged: polygons.vertex_count() - tables.vertex_count(),
        tables,
        schedule,
        handles,
        own_memory: OwnMemory::new(&schedule.own_data, route, polygons, schedule.edges),
        polygons,
        build: time_building::<M>,
        structure_type: M::type_path(),
    }))
}

/// Returns the relations that a schedule queries.
fn relations(schedule: &Schedule) -> Vec<Relation> {
    let is_queried = |relation: &Relation| {
        let mut parts = schedule.parts.iter();
        parts.any(|part| part.action.relations().contains(relation))
    };
    Relation::ALL.into_iter().filter(is_queried).collect()
}

/// Converts the route to the element numbers of the tables.
fn route_handles<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    route: &Route,
) -> HandleLists<RelationTables> {
    let handles = from_route(route, mesh, polygons, &[]);
    let numbers = Numbering::new(mesh);
    handles.map_handles(
        |v| numbers.vertex(v),
        |e| numbers.edge(e),
        |f| numbers.face(f),
    )
}

struct TableMix<'a> {
    tables: RelationTables,
    schedule: &'a Schedule,
    handles: HandleLists<RelationTables>,
    own_memory: OwnMemory,
    outputs: Outputs<RelationTables>,
    moved: Vec<Point>,
    merged: usize,
    polygons: &'a PolygonMesh,
    build: fn(&PolygonMesh, &[Relation], usize, &Series<'_>) -> Time,
    /// The path of the structure type from which the tables are built.
    structure_type: &'static str,
}

impl TableMix<'_> {
    fn build(&self, series: &Series<'_>) -> TimedRun {
        let bytes = self.tables.bytes();
        let time = (self.build)(self.polygons, &relations(self.schedule), bytes, series);
        let outcome = series.check.then(|| Outcome {
            checksum: (self.tables.vertex_count() + self.tables.face_count()) as f64,
            elements: self.tables.face_count() as u64,
            refused: 0,
        });
        TimedRun::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
    }

    fn run_pass(&mut self, operation: Operation, series: &Series<'_>) -> TimedRun {
        let Self {
            tables,
            moved,
            outputs,
            ..
        } = self;
        let mut run = run_whole(tables, outputs, operation, series);
        if operation == Operation::VvSmooth {
            // Writes to a copy, so that the mesh keeps its positions.
            let moving = series.time_together(|| {
                moved.copy_from_slice(black_box(outputs.vertices.values()));
                black_box(&mut *moved);
            });
            run.time = run.time.plus(moving);
        }
        let time = run.time.scaled(1.0 / f64::from(series.runs));
        TimedRun { time, ..run }
    }
}

/// **Timed**: runs the operations `range` of one part. Returns the numbers of operations, of results, and of
/// refused edits: tables have no edits.
fn run_range(
    tables: &mut RelationTables,
    handles: &HandleLists<RelationTables>,
    action: Action,
    range: Range<u64>,
) -> Counts {
    let operations = range.end - range.start;
    match action {
        Action::SetPosition => {
            for run in vertices_of(handles, range) {
                for &v in run {
                    let at = black_box(tables.position(v));
                    tables.set_position(v, at);
                }
            }
            [operations, operations, 0]
        }
        action => [
            operations,
            run_action(handles, black_box(tables), action, range),
            0,
        ],
    }
}

impl TimedBackend for TableMix<'_> {
    fn name(&self) -> &str {
        TABLES
    }

    /// Each query of a table is short, so passes always run in full.
    fn can_sample(&self) -> bool {
        false
    }

    fn costs(&self) -> [QueryCost; 9] {
        [QueryCost::Local; 9]
    }

    fn merged_vertices(&self) -> usize {
        self.merged
    }

    fn tabulated(&self) -> Vec<Relation> {
        relations(self.schedule)
    }

    fn bytes(&self) -> usize {
        self.tables.bytes()
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let Self {
            tables,
            handles,
            own_memory,
            schedule,
            ..
        } = self;
        let parts = &schedule.parts;
        match job.task {
            Task::Operation(Operation::Build) => self.build(series),
            Task::Operation(operation) => self.run_pass(operation, series),
            Task::Mix => time_turns(schedule, job.first, series, &mut |part, range| {
                own_memory.visit(parts[part].action.kind(), range.clone());
                run_range(tables, handles, parts[part].action, range)
            }),
            Task::Part(part) => {
                let action = parts[part].action;
                let all = action.kind().map_or(1, |kind| handles.len(kind) as u64);
                time_part(job.first, series, Some(all), &mut |range| {
                    run_range(tables, handles, action, range)
                })
            }
            Task::Program => TimedRun::refused(NO_PROGRAM.into(), series),
        }
    }
}

impl MixBackend for TableMix<'_> {
    fn type_paths(&self) -> Vec<&'static str> {
        vec![self.structure_type, TABLE_TYPE]
    }

    fn scans(&self) -> Vec<bool> {
        vec![false; self.schedule.parts.len()]
    }

    fn accepted_places(&mut self) -> Vec<Vec<bool>> {
        Vec::new()
    }

    fn keep_places(&mut self, _: &[Vec<bool>]) {}
}

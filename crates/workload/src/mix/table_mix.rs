//! Runs a mix on flat tables of the queried relations.

use std::hint::black_box;
use std::ops::Range;

use sixfold::{
    EdgeId, FaceId, MeshQuery, Point, PolygonMesh, QueryCost, Relation, Representation, VertexId,
};
use sixfold_core::RowId;
use sixfold_relation_table::{Numbering, RelationTable, TabulationError};

use crate::backend::Backend;
use crate::clock::Time;
use crate::job::{Job, Outcome, Run, Task, TimedBackend};
use crate::mix::MixBackend;
use crate::mix::passes::pass_over;
use crate::mix::route::Route;
use crate::mix::route_handles::RouteHandles;
use crate::mix::runs::{Counts, time_part, time_turns};
use crate::mix::schedule::Schedule;
use crate::operation::Operation;
use crate::series::{Series, time_making};
use crate::sweeps::Outputs;
use crate::workload::Action;

struct Tables {
    positions: Vec<Point>,
    edges: usize,
    faces: usize,
    vertex_vertices: Option<RelationTable<VertexId, VertexId>>,
    vertex_edges: Option<RelationTable<VertexId, EdgeId>>,
    vertex_faces: Option<RelationTable<VertexId, FaceId>>,
    edge_vertices: Option<RelationTable<EdgeId, VertexId>>,
    edge_edges: Option<RelationTable<EdgeId, EdgeId>>,
    edge_faces: Option<RelationTable<EdgeId, FaceId>>,
    face_vertices: Option<RelationTable<FaceId, VertexId>>,
    face_edges: Option<RelationTable<FaceId, EdgeId>>,
    face_faces: Option<RelationTable<FaceId, FaceId>>,
}

impl Tables {
    fn new<M: MeshQuery>(mesh: &M, relations: &[Relation]) -> Result<Self, TabulationError> {
        let numbers = Numbering::new(mesh);
        let is_queried = |relation| relations.contains(&relation);
        macro_rules! table {
            ($name:ident, $relation:ident) => {
                match is_queried(Relation::$relation) {
                    true => Some(numbers.$name()?),
                    false => None,
                }
            };
        }
        Ok(Self {
            positions: numbers.positions(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
            vertex_vertices: table!(vertex_vertices, VertexVertices),
            vertex_edges: table!(vertex_edges, VertexEdges),
            vertex_faces: table!(vertex_faces, VertexFaces),
            edge_vertices: table!(edge_vertices, EdgeVertices),
            edge_edges: table!(edge_edges, EdgeEdges),
            edge_faces: table!(edge_faces, EdgeFaces),
            face_vertices: table!(face_vertices, FaceVertices),
            face_edges: table!(face_edges, FaceEdges),
            face_faces: table!(face_faces, FaceFaces),
        })
    }

    fn bytes(&self) -> usize {
        fn bytes<A: RowId, B: RowId>(table: &Option<RelationTable<A, B>>) -> usize {
            table.as_ref().map_or(0, RelationTable::bytes)
        }
        size_of_val(&self.positions[..])
            + bytes(&self.vertex_vertices)
            + bytes(&self.vertex_edges)
            + bytes(&self.vertex_faces)
            + bytes(&self.edge_vertices)
            + bytes(&self.edge_edges)
            + bytes(&self.edge_faces)
            + bytes(&self.face_vertices)
            + bytes(&self.face_edges)
            + bytes(&self.face_faces)
    }
}

/// Defines one query. If the relation has no table, the query returns an empty row.
macro_rules! row {
    ($name:ident, $from:ty, $to:ty) => {
        #[inline]
        fn $name(&self, element: $from) -> impl Iterator<Item = $to> {
            let row = self
                .$name
                .as_ref()
                .map_or(&[][..], |table| table.row(element));
            row.iter().copied()
        }
    };
}

fn numbered<H: RowId>(count: usize) -> impl Iterator<Item = H> {
    (0..count as u32).map(H::from_row)
}

impl MeshQuery for Tables {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        numbered(self.positions.len())
    }
    fn edges(&self) -> impl Iterator<Item = EdgeId> {
        numbered(self.edges)
    }
    fn faces(&self) -> impl Iterator<Item = FaceId> {
        numbered(self.faces)
    }
    fn vertex_count(&self) -> usize {
        self.positions.len()
    }
    fn edge_count(&self) -> usize {
        self.edges
    }
    fn face_count(&self) -> usize {
        self.faces
    }
    #[inline]
    fn position(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }
    row!(vertex_vertices, VertexId, VertexId);
    row!(vertex_edges, VertexId, EdgeId);
    row!(vertex_faces, VertexId, FaceId);
    #[inline]
    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let table = self.edge_vertices.as_ref();
        let row = table.and_then(|table| table.row(e).first_chunk());
        *row.expect("a queried relation has a table, and an edge has two ends")
    }
    row!(edge_edges, EdgeId, EdgeId);
    row!(edge_faces, EdgeId, FaceId);
    row!(face_vertices, FaceId, VertexId);
    row!(face_edges, FaceId, EdgeId);
    row!(face_faces, FaceId, FaceId);
    fn vertex_rows(&self) -> usize {
        self.positions.len()
    }
    fn edge_rows(&self) -> usize {
        self.edges
    }
    fn face_rows(&self) -> usize {
        self.faces
    }
}

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
    let tables = Tables::new(&mesh, &relations(schedule)).ok()?;
    let handles = route_handles(&mesh, polygons, route);
    Some(Box::new(TableMix {
        outputs: Outputs::for_mesh(&tables),
        moved: tables.positions.clone(),
        merged: polygons.vertex_count() - tables.positions.len(),
        tables,
        schedule,
        handles,
        polygons,
        build: build::<M>,
        structure_type: M::type_path(),
    }))
}

/// Returns the relations that a schedule queries, with duplicates.
fn relations(schedule: &Schedule) -> Vec<Relation> {
    let relations = schedule
        .parts
        .iter()
        .flat_map(|part| part.action.relations());
    relations.collect()
}

/// Converts the route to the element numbers of the tables.
fn route_handles<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    route: &Route,
) -> RouteHandles<Tables> {
    let handles = RouteHandles::from_route(route, mesh, polygons, &[]);
    let numbers = Numbering::new(mesh);
    handles.map_handles(
        |v| numbers.vertex(v),
        |e| numbers.edge(e),
        |f| numbers.face(f),
    )
}

/// Builds the structure and the tables, and returns the time. The tables are dropped outside the
/// timing.
fn build<M: Representation>(
    polygons: &PolygonMesh,
    relations: &[Relation],
    bytes: usize,
    series: &Series<'_>,
) -> Time {
    let build = || {
        let mesh = M::from_polygons(black_box(polygons)).ok();
        mesh.map(|mesh| Tables::new(&mesh, relations))
    };
    time_making(series, bytes, build).0
}

struct TableMix<'a> {
    tables: Tables,
    schedule: &'a Schedule,
    handles: RouteHandles<Tables>,
    outputs: Outputs<Tables>,
    moved: Vec<Point>,
    merged: usize,
    polygons: &'a PolygonMesh,
    build: fn(&PolygonMesh, &[Relation], usize, &Series<'_>) -> Time,
    /// The path of the structure type from which the tables are built.
    structure_type: &'static str,
}

impl TableMix<'_> {
    fn build(&self, series: &Series<'_>) -> Run {
        let bytes = self.tables.bytes();
        let time = (self.build)(self.polygons, &relations(self.schedule), bytes, series);
        let outcome = series.check.then(|| Outcome {
            checksum: (self.tables.vertex_count() + self.tables.faces) as f64,
            elements: self.tables.faces as u64,
            refused: 0,
        });
        Run::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
    }

    fn run_pass(&mut self, operation: Operation, series: &Series<'_>) -> Run {
        let run = pass_over(&self.tables, &mut self.outputs, operation, series);
        if operation != Operation::VvSmooth {
            return run;
        }
        // Writes to a copy, so that the mesh keeps its positions.
        let Self { moved, outputs, .. } = self;
        let swap = series.time_together(|| {
            moved.copy_from_slice(black_box(outputs.vertices.values()));
            black_box(&mut *moved);
        });
        let time = run.time.plus(swap.scaled(1.0 / f64::from(series.runs)));
        Run { time, ..run }
    }
}

/// Runs the operations `range` of one part. Returns the numbers of operations, of results, and of
/// refused edits: tables have no edits.
fn run_range(
    tables: &mut Tables,
    handles: &RouteHandles<Tables>,
    action: Action,
    range: Range<u64>,
) -> Counts {
    let operations = range.end - range.start;
    match action {
        Action::SetPosition => {
            for run in handles.vertices(range) {
                for v in run {
                    let at = &mut tables.positions[v.index()];
                    *at = black_box(*at);
                }
            }
            [operations, operations, 0]
        }
        action => [
            operations,
            handles.run_action(black_box(tables), action, range),
            0,
        ],
    }
}

impl TimedBackend for TableMix<'_> {
    fn name(&self) -> &str {
        "relation-tables"
    }

    fn costs(&self) -> [QueryCost; 9] {
        [QueryCost::Local; 9]
    }

    fn merged_vertices(&self) -> usize {
        self.merged
    }

    fn bytes(&self) -> usize {
        self.tables.bytes()
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> Run {
        let Self {
            tables,
            handles,
            schedule,
            ..
        } = self;
        let parts = &schedule.parts;
        match job.task {
            Task::Operation(Operation::Build) => self.build(series),
            Task::Operation(operation) => self.run_pass(operation, series),
            Task::Mix => time_turns(schedule, job.first, series, |part, range| {
                run_range(tables, handles, parts[part].action, range)
            }),
            Task::Part(part) => {
                let action = parts[part].action;
                let all = action.kind().map_or(1, |kind| handles.len(kind) as u64);
                time_part(job.first, series, Some(all), |range| {
                    run_range(tables, handles, action, range)
                })
            }
        }
    }
}

impl MixBackend for TableMix<'_> {
    fn type_paths(&self) -> Vec<&'static str> {
        vec![self.structure_type, "sixfold_relation_table::RelationTable"]
    }

    fn scans(&self) -> Vec<bool> {
        vec![false; self.schedule.parts.len()]
    }

    fn accepted_places(&mut self) -> Vec<Vec<bool>> {
        Vec::new()
    }

    fn keep_places(&mut self, _: &[Vec<bool>]) {}
}

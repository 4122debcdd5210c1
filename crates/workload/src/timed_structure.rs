//! Runs jobs on one structure and measures their times.

use std::collections::HashMap;
use std::hint::black_box;

use sixfold::{MeshQuery, PolygonMesh, QueryCost, Relation, Representation};

use crate::backend::Backend;
use crate::draw::{Draw, Side};
use crate::operation::{build, edit_pass, subdivision, sweep, vv_smooth};
use crate::passes::{outcome, run_whole};
use crate::subdivision_job::SubdivisionJob;
use crate::sweeps::{All, Elements, Outputs, SweepResult, finish};
use sixfold_measure::{
    ElementKind, ElementSample, HandleLists, Job, Operation, Series, Sink, Start, Task,
    TimedBackend, TimedRun, exceeds_second_level,
};
use sixfold_results::Time;

/// A structure built from `polygons`, with storage for outputs and with handles of the drawn
/// elements.
pub(crate) struct TimedStructure<'a, M: Representation> {
    backend: Backend,
    polygons: &'a PolygonMesh,
    draw: Option<&'a Draw>,
    pub(crate) mesh: M,
    outputs: Outputs<M>,
    drawn: HandleLists<M>,
    merged_vertices: usize,
}

impl<'a, M: Representation + 'static> TimedStructure<'a, M> {
    pub(crate) fn new(
        backend: Backend,
        polygons: &'a PolygonMesh,
        draw: Option<&'a Draw>,
        mesh: M,
    ) -> Self {
        Self {
            backend,
            polygons,
            draw,
            outputs: Outputs::for_mesh(&mesh),
            drawn: HandleLists::default(),
            merged_vertices: polygons.vertex_count().saturating_sub(mesh.vertex_count()),
            mesh,
        }
    }

    fn run_whole(&mut self, operation: Operation, series: &Series<'_>) -> TimedRun {
        fill_caches(&self.mesh, series);
        fill_caches_with_outputs(&self.mesh, &self.outputs, series);
        run_whole(&self.mesh, &mut self.outputs, operation, series)
    }

    fn run_sampled(
        &mut self,
        operation: Operation,
        sample: ElementSample,
        series: &Series<'_>,
    ) -> TimedRun {
        let series = &Series {
            untimed: 0,
            runs: 1,
            ..*series
        };
        let Some(draw) = self.draw else {
            return self.run_whole(operation, series);
        };
        for kind in operation.kinds() {
            if sample.scanned[kind.index()] {
                extend_to(
                    &mut self.drawn,
                    kind,
                    &self.mesh,
                    self.polygons,
                    draw,
                    sample.size,
                );
            }
        }
        let (size, scale) = sizes_and_scales(draw, sample);
        let sampled = SampledElements {
            drawn: &self.drawn,
            size,
        };
        let mut results = [SweepResult::default(); 3];
        let mut total = Time::zero_like(series.clock.now());
        for kind in operation.kinds() {
            let k = kind.index();
            let time = series.timed(|| {
                let mesh = black_box(&self.mesh);
                let outputs = &mut self.outputs;
                results[k] = black_box(match sample.scanned[k] {
                    true => sweep(operation, kind, mesh, &sampled, outputs),
                    false => sweep(operation, kind, mesh, &All, outputs),
                });
                black_box(outputs);
            });
            total = total.plus(time.scaled(scale[k]));
        }
        if operation == Operation::VvSmooth {
            let moving = vv_smooth::time_moving(&self.mesh, &self.outputs.vertices, series);
            total = total.plus(moving);
        }
        let (mesh, outputs) = (&self.mesh, &self.outputs);
        let values = |kind: ElementKind| match sample.scanned[kind.index()] {
            true => outputs.sum(mesh, &sampled, kind),
            false => outputs.sum(mesh, &All, kind),
        };
        let check = series.check;
        let outcome = check.then(|| outcome(operation, results, scale, &values));
        TimedRun::done(total, outcome)
    }
}

impl<M: Representation + 'static> TimedBackend for TimedStructure<'_, M> {
    fn name(&self) -> &str {
        self.backend.name()
    }

    fn costs(&self) -> [QueryCost; 9] {
        M::COSTS
    }

    fn merged_vertices(&self) -> usize {
        self.merged_vertices
    }

    fn bytes(&self) -> usize {
        self.mesh.memory().total()
    }

    fn rebuild(&mut self) {
        if let Ok(mesh) = M::from_polygons(self.polygons) {
            self.outputs = Outputs::for_mesh(&mesh);
            self.mesh = mesh;
        }
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let Task::Operation(operation) = job.task else {
            return TimedRun::refused("the backend has no prepared workload".into(), series);
        };
        let run = match (operation, job.sample, SubdivisionJob::of(operation)) {
            (Operation::EditPass(pass), sample, _) => {
                edit_pass::run(&self.backend, pass, self.polygons, sample, series)
            }
            (_, sample, Some(job)) => {
                subdivision::run(&self.backend, job, self.polygons, sample, series)
            }
            (Operation::Build, ..) => build::run(&self.mesh, self.polygons, series),
            (operation, Some(sample), None) => {
                return self.run_sampled(operation, sample, series);
            }
            (Operation::VvSmooth, ..) => vv_smooth::run(&self.mesh, &mut self.outputs, series),
            (operation, ..) => self.run_whole(operation, series),
        };
        TimedRun {
            time: run.time.scaled(1.0 / f64::from(series.runs)),
            ..run
        }
    }
}

/// Returns, for each kind of elements, how many a sample visits, and the number of all elements divided
/// by this number.
fn sizes_and_scales(draw: &Draw, sample: ElementSample) -> ([usize; 3], [f64; 3]) {
    let population = draw.population();
    let size = population.map(|all| all.min(sample.size));
    let mut scale = [1.0; 3];
    for k in 0..3 {
        if sample.scanned[k] && size[k] > 0 {
            scale[k] = population[k] as f64 / size[k] as f64;
        }
    }
    (size, scale)
}

/// Reads every table of `mesh`, if runs start with warm caches and the mesh is larger than the
/// second-level cache.
///
/// Without this pass, the third-level cache holds the data of the previous backend. Runs that do
/// not read in row order then need up to ten passes to fill the cache. For example, `edge_edges` on
/// a winged-edge mesh of 200,000 faces took 8 ms instead of 3 ms.
pub(crate) fn fill_caches<M: Representation>(mesh: &M, series: &Series<'_>) {
    if needs_filling(mesh, series) {
        let scans = M::cost(Relation::VertexFaces) == QueryCost::Scan;
        read_tables(black_box(mesh), scans);
    }
}

/// Reads the output arrays of the operations, if [`fill_caches`] reads the tables of `mesh`.
pub(crate) fn fill_caches_with_outputs<M: Representation>(
    mesh: &M,
    outputs: &Outputs<M>,
    series: &Series<'_>,
) {
    if needs_filling(mesh, series) {
        mesh.vertices().for_each(|v| {
            black_box(outputs.vertices[v]);
        });
        mesh.faces().for_each(|f| {
            black_box(outputs.faces[f]);
        });
    }
}

fn needs_filling<M: Representation>(mesh: &M, series: &Series<'_>) -> bool {
    matches!(series.start, Start::Warm) && exceeds_second_level(mesh.memory().total())
}

/// Reads every row of every table, mostly in row order. `scans` means that relations of vertices
/// read all faces.
fn read_tables<M: MeshQuery>(mesh: &M, scans: bool) {
    mesh.faces().for_each(|f| {
        black_box(mesh.face_vertices(f).last());
    });
    mesh.vertices().for_each(|v| {
        black_box(mesh.position(v));
    });
    if !scans {
        mesh.vertices().for_each(|v| {
            black_box(mesh.vertex_faces(v).last());
        });
    }
    // If edges have no rows, no table contains them.
    if mesh.edge_rows() > 0 {
        mesh.edges().for_each(|e| {
            black_box(mesh.edge_vertices(e));
        });
    }
}

/// Looks up handles of drawn elements of one kind until there are `size` of them.
fn extend_to<M: Representation>(
    handles: &mut HandleLists<M>,
    kind: ElementKind,
    mesh: &M,
    polygons: &PolygonMesh,
    draw: &Draw,
    size: usize,
) {
    fn missing<T>(drawn: &[T], known: usize, size: usize) -> &[T] {
        &drawn[known..drawn.len().min(size).max(known)]
    }
    match kind {
        ElementKind::Vertex => {
            let vertices = missing(&draw.vertices, handles.vertices.len(), size).iter();
            handles
                .vertices
                .extend(vertices.map(|&v| M::vertex_handle(polygons, v)));
        }
        ElementKind::Edge => {
            let sides = missing(&draw.edges, handles.edges.len(), size);
            handles.edges.extend(edge_handles(mesh, polygons, sides));
        }
        ElementKind::Face => {
            let faces = missing(&draw.faces, handles.faces.len(), size).iter();
            handles
                .faces
                .extend(faces.map(|&f| M::face_handle(polygons, f)));
        }
    }
}

/// Finds the edge of each side among the edges of its face. Visits each face once.
pub(crate) fn edge_handles<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    sides: &[Side],
) -> Vec<M::Edge> {
    let mut by_face: Vec<usize> = (0..sides.len()).collect();
    by_face.sort_unstable_by_key(|&i| sides[i].face);
    let mut found = vec![None; sides.len()];
    for group in by_face.chunk_by(|&i, &j| sides[i].face == sides[j].face) {
        let face = M::face_handle(polygons, sides[group[0]].face);
        let edges = mesh.face_edges(face).map(|e| {
            let [a, b] = mesh.edge_vertices(e);
            ([a.min(b), a.max(b)], e)
        });
        let edges: HashMap<[M::Vertex; 2], M::Edge> = edges.collect();
        for &i in group {
            let [a, b] = sides[i].ends.map(|v| M::vertex_handle(polygons, v));
            found[i] = edges.get(&[a.min(b), a.max(b)]).copied();
        }
    }
    let found = found.into_iter();
    found
        .map(|e| e.expect("a face has an edge for each of its sides"))
        .collect()
}

/// The first elements of the draw: as many of each kind as `size` says.
struct SampledElements<'c, M: MeshQuery> {
    drawn: &'c HandleLists<M>,
    size: [usize; 3],
}

impl<M: MeshQuery> Elements<M> for SampledElements<'_, M> {
    fn vertices<'a>(&'a self, _: &'a M) -> impl Iterator<Item = M::Vertex> + 'a {
        self.drawn.vertices[..self.size[0]].iter().copied()
    }
    fn edges<'a>(&'a self, _: &'a M) -> impl Iterator<Item = M::Edge> + 'a {
        self.drawn.edges[..self.size[1]].iter().copied()
    }
    fn faces<'a>(&'a self, _: &'a M) -> impl Iterator<Item = M::Face> + 'a {
        self.drawn.faces[..self.size[2]].iter().copied()
    }
    fn query(&self, mesh: &M, relation: Relation) -> SweepResult {
        let size = self.size[ElementKind::queried_by(relation).index()];
        let sink = self.drawn.query(mesh, relation, 0..size, Sink::default());
        finish(sink, size as u64)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use sixfold::{
        CornerTable, FaceVertexMesh, HalfEdgeMesh, IndexedFaceSet, PolygonSoup, WingedEdgeMesh,
    };
    use sixfold_core::{Measured, Traced};

    use super::*;

    fn every_row_is_read<M: Measured>(polygons: &PolygonMesh) {
        let mesh = M::from_polygons(polygons).expect("a closed manifold");
        let bytes = mesh.memory().total();
        let scans = M::cost(Relation::VertexFaces) == QueryCost::Scan;
        let probe = Traced::default();
        read_tables(&mesh.probed(probe.clone()), scans);
        let reads = probe.take().into_iter();
        let rows: HashSet<_> = reads
            .map(|read| (read.table, read.row, read.bytes))
            .collect();
        let read: usize = rows.iter().map(|&(_, _, bytes)| bytes).sum();
        assert!(read * 100 >= bytes * 99, "{}: {read} of {bytes}", M::NAME);
    }

    #[test]
    fn every_table_is_read_completely_before_samples() {
        for polygons in [
            sixfold::shapes::geodesic(6).expect("a small frequency"),
            sixfold::shapes::cube(),
        ] {
            every_row_is_read::<PolygonSoup>(&polygons);
            every_row_is_read::<IndexedFaceSet>(&polygons);
            every_row_is_read::<FaceVertexMesh>(&polygons);
            every_row_is_read::<WingedEdgeMesh>(&polygons);
            every_row_is_read::<HalfEdgeMesh>(&polygons);
            if polygons.face_count() > 6 {
                every_row_is_read::<CornerTable>(&polygons);
            }
        }
    }
}

//! One structure on the bench: what it is asked to do, and how long it takes.

use std::hint::black_box;

use sixfold::{MeshQuery, PolygonMesh, QueryCost, Representation};

use crate::clock::Time;
use crate::editing::Editing;
use crate::operation::{Kind, Operation};
use crate::refining::Refining;
use crate::sample::{Draw, Side};
use crate::series::{KeptCopies, Series, time_making};
use crate::subdividing::{patch, subdivide};
use crate::sweeps::{All, Elements, Outputs, Tally, field_sum, share};

/// What to run: an operation on all elements, or on a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Job {
    /// The operation.
    pub operation: Operation,
    /// Which elements stand for all; `None` for all of them.
    pub sample: Option<Sample>,
}

/// The first few elements of the draw, of the kinds that are scanned for; the first few faces, as a
/// mesh of their own, where they are subdivided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// By kind: whether a sample stands for all. The other kinds are gone through in full.
    pub scanned: [bool; 3],
    /// How many elements of each such kind, if there are as many.
    pub size: usize,
}

/// What a run came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The time of one run of the whole operation; scaled where a sample stands for it.
    pub time: Time,
    /// What it found; `None` if nobody asked.
    pub outcome: Option<Outcome>,
    /// Why it cannot be done on this structure or mesh; the time means nothing then.
    pub refusal: Option<String>,
}

impl Run {
    /// A run that was done.
    pub fn done(time: Time, outcome: Option<Outcome>) -> Self {
        Self {
            time,
            outcome,
            refusal: None,
        }
    }
}

/// What an operation found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// A number that depends on all results, and not on the order of neighbours.
    pub checksum: f64,
    /// How many elements the whole operation visits; scaled where a sample stands for it.
    pub elements: u64,
}

/// Something that can be timed; a test can bring its own.
pub trait Subject {
    /// What users call it.
    fn name(&self) -> &str;
    /// It is a program of somebody else, which runs operations as a whole or not at all, and by whose
    /// results nothing is judged.
    fn is_external(&self) -> bool {
        false
    }
    /// How much of the mesh each relation looks at.
    fn costs(&self) -> [QueryCost; 9];
    /// How many vertices of the input are no vertices of their own here.
    fn merged_vertices(&self) -> usize;
    /// The bytes held.
    fn bytes(&self) -> usize;
    /// Builds it again from the same polygons, elsewhere in memory: for the time of some operations depends a
    /// little on which addresses and pages the tables have. Nothing where there is nothing to build.
    fn rebuild(&mut self) {}
    /// Runs `job` as `series` says, once if it has a sample; the time is that of one run.
    fn run(&mut self, job: &Job, series: &Series<'_>) -> Run;
}

/// A structure built from `polygons`, with room for outputs and its names of the draw.
pub(crate) struct Candidate<'a, M: Representation> {
    polygons: &'a PolygonMesh,
    draw: Option<&'a Draw>,
    mesh: M,
    outputs: Outputs<M>,
    chosen: Chosen<M>,
    merged_vertices: usize,
}

impl<'a, M: Representation + 'static> Candidate<'a, M> {
    /// Puts `mesh`, built from `polygons`, on the bench.
    pub(crate) fn new(polygons: &'a PolygonMesh, draw: Option<&'a Draw>, mesh: M) -> Self {
        Self {
            polygons,
            draw,
            outputs: Outputs::for_mesh(&mesh),
            chosen: Chosen::default(),
            merged_vertices: polygons.vertex_count().saturating_sub(mesh.vertex_count()),
            mesh,
        }
    }

    fn build(&self, series: &Series<'_>) -> Run {
        let build = || M::from_polygons(black_box(self.polygons)).ok();
        let (time, built) = time_making(series, self.mesh.memory().total(), build);
        let outcome = built.flatten().map(|mesh| Outcome {
            checksum: (mesh.vertex_count() + mesh.face_count()) as f64,
            elements: mesh.face_count() as u64,
        });
        Run::done(time, outcome)
    }

    /// Each run smooths a copy that has the positions of the mesh.
    fn smooth(&mut self, series: &Series<'_>) -> Run {
        let Self { mesh, outputs, .. } = self;
        let mut copies = KeptCopies::default();
        let mut tally = Tally::default();
        let mut moved = Ok(());
        let time = copies.time(
            series,
            mesh.memory().total(),
            || mesh.clone(),
            |copy| copy.clone_from(mesh),
            |copy| {
                tally = share(Operation::VvSmooth, Kind::Vertex, copy, &All, outputs);
                moved = copy.set_positions(&outputs.vertices);
            },
        );
        let outcome = copies.changed().filter(|_| series.check).map(|smoothed| {
            let after = smoothed.vertices().map(|v| smoothed.position(v));
            let means = mesh.vertices().map(|v| outputs.vertices[v]);
            // Where a vertex is its coordinates, two may have moved to one place, or two corners
            // of a face have been refused it: the same work up to there, and the means tell.
            let apart = smoothed.vertex_count() == mesh.vertex_count();
            let checksum = match moved.is_ok() && apart {
                true => field_sum(after),
                false => field_sum(means),
            };
            Outcome {
                checksum,
                elements: tally.elements,
            }
        });
        Run::done(time, outcome)
    }

    fn whole(&mut self, operation: Operation, series: &Series<'_>) -> Run {
        let mut tallies = [Tally::default(); 3];
        let time = series.time_together(|| {
            for &kind in operation.kinds() {
                let mesh = black_box(&self.mesh);
                tallies[kind.index()] =
                    black_box(share(operation, kind, mesh, &All, &mut self.outputs));
            }
            black_box(&mut self.outputs);
        });
        let outcome = series
            .check
            .then(|| self.outcome(operation, &All, tallies, [1.0; 3]));
        Run::done(time, outcome)
    }

    fn sampled(&mut self, operation: Operation, sample: Sample, series: &Series<'_>) -> Run {
        let series = &Series {
            untimed: 0,
            runs: 1,
            ..*series
        };
        let Some(draw) = self.draw else {
            return self.whole(operation, series);
        };
        self.chosen
            .grow(&self.mesh, self.polygons, draw, sample.size);
        let population = draw.population();
        let size = population.map(|all| all.min(sample.size));
        let mut scale = [1.0; 3];
        for kind in Kind::ALL {
            let k = kind.index();
            if sample.scanned[k] && size[k] > 0 {
                scale[k] = population[k] as f64 / size[k] as f64;
            }
        }
        let chosen = Picked {
            chosen: &self.chosen,
            scanned: sample.scanned,
            size,
        };
        let mut tallies = [Tally::default(); 3];
        let mut total = Time::none_like(series.clock.now());
        for &kind in operation.kinds() {
            let k = kind.index();
            let time = series.timed(|| {
                let mesh = black_box(&self.mesh);
                tallies[k] = black_box(share(operation, kind, mesh, &chosen, &mut self.outputs));
                black_box(&mut self.outputs);
            });
            total = total.plus(time.scaled(scale[k]));
        }
        if operation == Operation::VvSmooth {
            let mut copy = self.mesh.clone();
            let swap = series.timed(|| {
                let moved = copy.set_positions(&self.outputs.vertices);
                black_box((&mut copy, moved.is_ok()));
            });
            total = total.plus(swap);
        }
        let outcome = series
            .check
            .then(|| self.outcome(operation, &chosen, tallies, scale));
        Run::done(total, outcome)
    }

    /// On all faces, or on a patch that stands for them.
    fn subdivide(
        &mut self,
        refining: Refining,
        sample: Option<Sample>,
        series: &Series<'_>,
    ) -> Run {
        let Some(Sample { size, .. }) = sample else {
            return subdivide::<M>(refining, self.polygons, series);
        };
        let patch = patch(self.polygons, size);
        let scale = self.polygons.face_count() as f64 / patch.face_count() as f64;
        let run = subdivide::<M>(refining, &patch, series);
        Run {
            time: run.time.scaled(scale),
            ..run
        }
    }

    fn outcome<E: Elements<M>>(
        &self,
        operation: Operation,
        elements: &E,
        tallies: [Tally; 3],
        scale: [f64; 3],
    ) -> Outcome {
        let mesh = &self.mesh;
        let mut sum = Tally::default();
        tallies.into_iter().for_each(|tally| sum.add(tally));
        let checksum = match operation {
            Operation::FaceBarycenter => {
                let faces = elements.faces(mesh);
                field_sum(faces.map(|f| self.outputs.faces[f]))
            }
            Operation::VertexNormal | Operation::VvSmooth => {
                let vertices = elements.vertices(mesh);
                field_sum(vertices.map(|v| self.outputs.vertices[v]))
            }
            Operation::EdgeLength => sum.sum,
            _ => sum.count as f64,
        };
        let of = Kind::ALL
            .into_iter()
            .find(|kind| kind.name() == operation.per());
        let scaled = |kind: Kind, number: u64| number as f64 * scale[kind.index()];
        let visited = match of {
            Some(kind) => scaled(kind, tallies[kind.index()].elements),
            None => Kind::ALL
                .map(|kind| scaled(kind, tallies[kind.index()].count))
                .into_iter()
                .sum(),
        };
        Outcome {
            checksum,
            elements: visited.round() as u64,
        }
    }
}

impl<M: Representation + 'static> Subject for Candidate<'_, M> {
    fn name(&self) -> &str {
        M::NAME
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

    fn run(&mut self, job: &Job, series: &Series<'_>) -> Run {
        let refining = job.operation.refining();
        let run = match (job.operation, job.sample, refining) {
            (Operation::Editing(editing), sample, _) => {
                edit::<M>(editing, self.polygons, sample, series)
            }
            (_, sample, Some(refining)) => self.subdivide(refining, sample, series),
            (Operation::Build, ..) => self.build(series),
            (operation, Some(sample), None) => {
                return self.sampled(operation, sample, series);
            }
            (Operation::VvSmooth, ..) => self.smooth(series),
            (operation, ..) => self.whole(operation, series),
        };
        Run {
            time: run.time.scaled(1.0 / f64::from(series.runs)),
            ..run
        }
    }
}

/// Runs a workload that changes the mesh, or a patch of the mesh that stands for it.
fn edit<M: Representation>(
    editing: Editing,
    polygons: &PolygonMesh,
    sample: Option<Sample>,
    series: &Series<'_>,
) -> Run {
    let piece = sample.map(|sample| patch(polygons, sample.size));
    let of = piece.as_ref().unwrap_or(polygons);
    let editor = editing.on(M::NAME, of);
    let editor = editor.unwrap_or_else(|| Err("it cannot be edited".into()));
    let mut editor = match editor {
        Ok(editor) => editor,
        Err(refusal) => {
            return Run {
                time: Time::none_like(series.clock.now()),
                outcome: None,
                refusal: Some(refusal),
            };
        }
    };
    let time = editor.time(series);
    let outcome = series.check.then(|| {
        let edits = editor.result();
        Outcome {
            checksum: edits.checksum,
            elements: edits.elements,
        }
    });
    let scale = polygons.face_count() as f64 / of.face_count().max(1) as f64;
    Run::done(time.scaled(scale), outcome)
}

/// The structure's own names of the first elements of the draw.
struct Chosen<M: MeshQuery> {
    vertices: Vec<M::Vertex>,
    edges: Vec<M::Edge>,
    faces: Vec<M::Face>,
}

impl<M: MeshQuery> Default for Chosen<M> {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
        }
    }
}

impl<M: Representation> Chosen<M> {
    /// Names elements of the draw until there are `size` of each kind, or no more.
    fn grow(&mut self, mesh: &M, polygons: &PolygonMesh, draw: &Draw, size: usize) {
        fn more<T>(drawn: &[T], named: usize, size: usize) -> &[T] {
            &drawn[named..drawn.len().min(size).max(named)]
        }
        let vertices = more(&draw.vertices, self.vertices.len(), size).iter();
        self.vertices
            .extend(vertices.map(|&v| M::vertex_name(polygons, v)));
        let edges = more(&draw.edges, self.edges.len(), size).iter();
        self.edges
            .extend(edges.map(|&side| edge_name(mesh, polygons, side)));
        let faces = more(&draw.faces, self.faces.len(), size).iter();
        self.faces.extend(faces.map(|&f| M::face_name(polygons, f)));
    }
}

/// The name of the edge that `side` stands for, looked up among the edges of its face.
pub(crate) fn edge_name<M: Representation>(
    mesh: &M,
    polygons: &PolygonMesh,
    side: Side,
) -> M::Edge {
    let [a, b] = side.ends.map(|v| M::vertex_name(polygons, v));
    let joins = |&e: &M::Edge| {
        let ends = mesh.edge_vertices(e);
        ends == [a, b] || ends == [b, a]
    };
    mesh.face_edges(M::face_name(polygons, side.face))
        .find(joins)
        .expect("a face has an edge for each of its sides")
}

/// The first elements of the kinds that are sampled, and all of the others.
struct Picked<'c, M: MeshQuery> {
    chosen: &'c Chosen<M>,
    scanned: [bool; 3],
    size: [usize; 3],
}

impl<M: MeshQuery> Picked<'_, M> {
    /// The sampled `handles` of `kind`, or all of `others`, which may be costly to ask for.
    #[inline(always)]
    fn pick<'p, H: Copy, I: Iterator<Item = H> + 'p>(
        &self,
        kind: Kind,
        handles: &'p [H],
        others: impl FnOnce() -> I,
    ) -> impl Iterator<Item = H> + 'p {
        let k = kind.index();
        let (some, all) = match self.scanned[k] {
            true => (Some(&handles[..self.size[k]]), None),
            false => (None, Some(others())),
        };
        let some = some.into_iter().flatten().copied();
        some.chain(all.into_iter().flatten())
    }
}

impl<M: MeshQuery> Elements<M> for Picked<'_, M> {
    fn vertices<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Vertex> + 'a {
        self.pick(Kind::Vertex, &self.chosen.vertices, || mesh.vertices())
    }
    fn edges<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Edge> + 'a {
        self.pick(Kind::Edge, &self.chosen.edges, || mesh.edges())
    }
    fn faces<'a>(&'a self, mesh: &'a M) -> impl Iterator<Item = M::Face> + 'a {
        self.pick(Kind::Face, &self.chosen.faces, || mesh.faces())
    }
}

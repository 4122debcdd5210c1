//! Passes of edits over a whole mesh, on one structure, and what studies know about them.

use sixfold::algorithms::Algorithms;
use sixfold::remeshing::{Decimation, Target};
use sixfold::{
    Counts, EdgeMap, EditLog, HandleMap, MeshEdit, MeshQuery, PolygonMesh, Representation,
};
use sixfold_results::Time;

use crate::backend::Backend;
use sixfold_measure::{EditPass, ElementSample, Outcome, ReusedCopies, Series, TimedRun, patch};

/// Returns the part of the faces that is left; `None` if the pass keeps the number of faces.
const fn ratio(pass: EditPass) -> Option<f64> {
    match pass {
        EditPass::SplitCollapse | EditPass::FlipAll => None,
        EditPass::DecimateHalf => Some(0.5),
        EditPass::DecimateTenth => Some(0.1),
    }
}

/// Edits that are ready to run, or the reason why they cannot run.
pub type PreparedEditor = Result<Box<dyn Editor>, String>;

pub(crate) fn prepare_pass<M: Representation + MeshEdit + 'static>(
    pass: EditPass,
    algorithms: &Algorithms,
    polygons: &PolygonMesh,
) -> PreparedEditor {
    if let Some((f, degree)) = polygons.first_polygon() {
        return Err(format!(
            "face {f} has {degree} corners, and passes of edits need triangles: triangulate the mesh"
        ));
    }
    let mesh = M::from_polygons(polygons).map_err(|refusal| refusal.to_string())?;
    Ok(Box::new(EditPassRun {
        pass,
        algorithms: *algorithms,
        edges: match pass {
            EditPass::FlipAll => edges_in_face_order(&mesh),
            _ => Vec::new(),
        },
        mesh,
        copies: ReusedCopies::default(),
    }))
}

/// Edits that can run repeatedly. Each run starts with the initial mesh.
pub trait Editor {
    /// Runs the edits and returns the total time of the timed runs. `series` gives the number of
    /// runs.
    fn time(&mut self, series: &Series<'_>) -> Time;

    /// Returns the counts of the last run.
    fn result(&self) -> Edits;
}

/// The counts of one run of edits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edits {
    /// Number of visited elements: edges for flips of edges, faces for all other edits.
    pub elements: u64,
    /// Number of edits that were done.
    pub done: u64,
    /// Number of edits that the structure refused.
    pub refused: u64,
    /// A hash of the places of the refused edits, in the order of the edits; 0 if no edit was
    /// refused. Two structures that refuse equally many edits at different places have different
    /// hashes.
    pub refused_hash: u64,
    /// Sum of all edge lengths after the edits.
    pub checksum: f64,
}

impl Edits {
    /// Records that the edit at `place` was refused. The place is a number that is the same on all
    /// structures. Never inlined, because the loops over edits would keep the hash in a register.
    #[cold]
    #[inline(never)]
    pub(crate) fn refuse(&mut self, place: usize) {
        self.refused += 1;
        // A polynomial of the places, modulo 2⁶⁴. The odd factor mixes the order of the places in.
        let hash = self.refused_hash.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.refused_hash = hash.wrapping_add(place as u64 + 1);
    }
}

struct EditPassRun<M: MeshEdit> {
    pass: EditPass,
    /// The compiled decimation.
    algorithms: Algorithms,
    mesh: M,
    /// The edges to flip, in order.
    edges: Vec<M::Edge>,
    copies: ReusedCopies<WorkingCopy<M>>,
}

/// A copy of the mesh with the current edge handles and the counts of its last run.
struct WorkingCopy<M: MeshEdit> {
    mesh: M,
    edges: Option<TrackedEdges<M>>,
    edits: Edits,
}

impl<M: Representation + MeshEdit + 'static> Editor for EditPassRun<M> {
    fn time(&mut self, series: &Series<'_>) -> Time {
        let Self {
            pass,
            algorithms,
            mesh,
            edges,
            copies,
        } = self;
        let tracked = match pass {
            EditPass::FlipAll => Some(TrackedEdges::new(mesh, edges)),
            _ => None,
        };
        copies.time(
            series,
            mesh.memory().total(),
            || WorkingCopy {
                mesh: mesh.clone(),
                edges: tracked.clone(),
                edits: Edits::default(),
            },
            |copy| {
                copy.mesh.clone_from(mesh);
                copy.edges.clone_from(&tracked);
            },
            |copy| {
                copy.edits = match (ratio(*pass), &mut copy.edges) {
                    (_, Some(edges)) => flip_all(&mut copy.mesh, edges),
                    (Some(ratio), None) => decimate_to(&mut copy.mesh, algorithms, ratio),
                    (None, None) => split_collapse(&mut copy.mesh),
                };
            },
        )
    }

    fn result(&self) -> Edits {
        let Some(WorkingCopy { mesh, edits, .. }) = self.copies.used_copy() else {
            return Edits::default();
        };
        let lengths = mesh.edges().map(|e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v).as_dvec3());
            a.distance(b)
        });
        Edits {
            checksum: lengths.sum(),
            ..*edits
        }
    }
}

/// **Timed**: splits every face at its middle, and collapses an edge of each new vertex.
#[inline(never)]
fn split_collapse<M: MeshEdit>(mesh: &mut M) -> Edits {
    let mut edits = Edits::default();
    let faces: Vec<M::Face> = mesh.faces().collect();
    let mut middles = Vec::with_capacity(faces.len());
    let face_count = faces.len();
    for (place, f) in faces.into_iter().enumerate() {
        edits.elements += 1;
        let mut sum = sixfold::Point::ZERO;
        mesh.face_vertices(f).for_each(|v| sum += mesh.position(v));
        match mesh.poke_face(f, sum * (1.0 / 3.0)) {
            Ok(middle) => middles.push(middle),
            Err(_) => edits.refuse(place),
        }
    }
    for (place, middle) in middles.into_iter().enumerate() {
        let Some(spoke) = mesh.vertex_edges(middle).next() else {
            continue;
        };
        let [a, b] = mesh.edge_vertices(spoke);
        let corner = if a == middle { b } else { a };
        let at = mesh.position(corner);
        match mesh.collapse_edge(spoke, corner, at) {
            Ok(_) => edits.done += 1,
            Err(_) => edits.refuse(face_count + place),
        }
    }
    mesh.compact();
    edits
}

/// **Timed**: flips every edge, and then flips it again.
#[inline(never)]
fn flip_all<M: MeshEdit>(mesh: &mut M, tracked: &mut TrackedEdges<M>) -> Edits {
    let mut edits = Edits::default();
    for round in 0..2 {
        for i in 0..tracked.edges.len() {
            edits.elements += 1;
            tracked.flipping = i;
            match mesh.flip_edge_logged(tracked.edges[i], tracked) {
                Ok(flipped) => {
                    tracked.edges[i] = flipped;
                    tracked.apply_renames();
                    edits.done += 1;
                }
                Err(_) => edits.refuse(round * tracked.edges.len() + i),
            }
        }
    }
    edits
}

/// **Timed**: decimates the mesh to `ratio` of its faces.
#[inline(never)]
fn decimate_to<M: MeshEdit + 'static>(mesh: &mut M, algorithms: &Algorithms, ratio: f64) -> Edits {
    let elements = mesh.face_count() as u64;
    let job = Decimation {
        target: Target::Ratio(ratio),
        ..Decimation::default()
    };
    let done = algorithms.decimate(mesh, &job).and_then(Result::ok);
    Edits {
        elements,
        done: done.as_ref().map_or(0, |done| done.collapses as u64),
        refused: done.as_ref().map_or(elements, |done| done.refused as u64),
        refused_hash: done.as_ref().map_or(0, |done| done.refused_hash),
        checksum: 0.0,
    }
}

fn edges_in_face_order<M: MeshQuery>(mesh: &M) -> Vec<M::Edge> {
    let mut listed = mesh.edge_map(false);
    let mut edges = Vec::new();
    for f in mesh.faces() {
        for e in mesh.face_edges(f) {
            if !std::mem::replace(&mut listed[e], true) {
                edges.push(e);
            }
        }
    }
    edges
}

/// The current handles of a list of edges.
///
/// A flip returns the new handle of the flipped edge. In structures whose edge handle is the
/// opposite corner, a flip also changes handles of other edges. `indices` then finds these edges in
/// the list.
struct TrackedEdges<M: MeshEdit> {
    edges: Vec<M::Edge>,
    /// For each edge, its index in `edges`.
    indices: EdgeMap<M, u32>,
    /// The index of the edge that is being flipped.
    flipping: usize,
    /// The indices and new handles that the current flip has reported.
    renamed: Vec<(u32, M::Edge)>,
}

impl<M: MeshEdit> Clone for TrackedEdges<M> {
    fn clone(&self) -> Self {
        Self {
            edges: self.edges.clone(),
            indices: self.indices.clone(),
            flipping: self.flipping,
            renamed: self.renamed.clone(),
        }
    }

    /// Reuses the existing tables.
    fn clone_from(&mut self, source: &Self) {
        let Self {
            edges,
            indices,
            flipping,
            renamed,
        } = source;
        self.edges.clone_from(edges);
        self.indices.clone_from(indices);
        self.flipping = *flipping;
        self.renamed.clone_from(renamed);
    }
}

impl<M: MeshEdit> TrackedEdges<M> {
    fn new(mesh: &M, edges: &[M::Edge]) -> Self {
        let mut indices = mesh.edge_map(0);
        // Edges without rows would need a hash map. Their flips rename only the flipped edge, so
        // the map stays empty.
        if mesh.edge_rows() > 0 {
            for (index, &e) in (0..).zip(edges) {
                indices.insert(e, index);
            }
        }
        Self {
            edges: edges.to_vec(),
            indices,
            flipping: 0,
            renamed: Vec::with_capacity(8),
        }
    }

    /// Stores all new handles at once, because a new handle may be the old handle of another edge.
    #[inline]
    fn apply_renames(&mut self) {
        while let Some((index, edge)) = self.renamed.pop() {
            self.edges[index as usize] = edge;
            self.indices.insert(edge, index);
        }
    }
}

impl<M: MeshEdit> EditLog<M> for TrackedEdges<M> {
    #[inline]
    fn renamed_edge(&mut self, old: M::Edge, new: M::Edge) {
        if old == self.edges[self.flipping] {
            self.renamed.push((self.flipping as u32, new));
        } else {
            self.renamed.push((self.indices[old], new));
        }
    }
}

/// Runs a pass of edits over the mesh or over a patch.
pub(crate) fn run(
    backend: &Backend,
    pass: EditPass,
    polygons: &PolygonMesh,
    sample: Option<ElementSample>,
    series: &Series<'_>,
) -> TimedRun {
    let piece = sample.map(|sample| patch(polygons, sample.size));
    let input = piece.as_ref().unwrap_or(polygons);
    let editor: Option<PreparedEditor> = backend.prepare_pass(pass, input);
    let mut editor = match editor.unwrap_or_else(|| Err("it cannot be edited".into())) {
        Ok(editor) => editor,
        Err(refusal) => return TimedRun::refused(refusal, series),
    };
    let time = editor.time(series);
    let outcome = series.check.then(|| {
        let edits = editor.result();
        Outcome {
            checksum: edits.checksum,
            elements: edits.elements,
            refused: edits.refused_hash,
        }
    });
    let scale = polygons.face_count() as f64 / input.face_count().max(1) as f64;
    TimedRun::done(time.scaled(scale), outcome)
}

/// Returns the counts of the mesh after `pass`.
pub(crate) fn counts_after(
    pass: EditPass,
    backend: &Backend,
    polygons: &PolygonMesh,
    before: &Counts,
) -> Counts {
    let Some(ratio) = ratio(pass) else {
        return *before;
    };
    let edits = backend.edits;
    let counts =
        edits.and_then(|edits| (edits.decimated_counts)(&backend.algorithms, polygons, ratio));
    counts.unwrap_or(*before)
}

/// Returns the counts of the mesh after decimation to `ratio` of its faces; `None` if the
/// decimation is refused.
pub(crate) fn decimated_counts<M: Representation + MeshEdit + 'static>(
    algorithms: &Algorithms,
    polygons: &PolygonMesh,
    ratio: f64,
) -> Option<Counts> {
    let mut mesh = M::from_polygons(polygons).ok()?;
    let job = Decimation {
        target: Target::Ratio(ratio),
        ..Decimation::default()
    };
    algorithms.decimate(&mut mesh, &job)?.ok()?;
    Some(mesh.to_polygons().counts(mesh.edges().count()))
}

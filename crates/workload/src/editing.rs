//! Whole workloads that change a mesh: what programs do with edits, on one structure.

use std::fmt;

use sixfold::remeshing::{Decimation, Target, decimate};
use sixfold::{
    EdgeMap, EditLog, EditVisitor, HandleMap, MeshEdit, MeshQuery, PolygonMesh, Representation,
    visit_editable,
};

use crate::clock::Time;
use crate::series::{KeptCopies, Series};

/// One of the workloads that change a mesh of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Editing {
    /// A vertex into the middle of every face; then each back into a neighbour, with all checks; then
    /// the holes are closed. The mesh is what it was.
    SplitCollapse,
    /// Every edge that the mesh has at the start, in the order in which the faces first name them,
    /// flipped where that is legal; then again.
    FlipAll,
    /// Edge collapse by quadric error, to half of the faces.
    DecimateHalf,
    /// The same to a tenth.
    DecimateTenth,
}

impl Editing {
    /// All four.
    pub const ALL: [Self; 4] = [
        Self::SplitCollapse,
        Self::FlipAll,
        Self::DecimateHalf,
        Self::DecimateTenth,
    ];

    /// What users call it: `split_collapse`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SplitCollapse => "split_collapse",
            Self::FlipAll => "flip_all",
            Self::DecimateHalf => "decimate_half",
            Self::DecimateTenth => "decimate_tenth",
        }
    }

    /// Sets it up on the structure called `backend`; `None` where there is none, or none to be edited.
    ///
    /// # Errors
    ///
    /// Why the structure cannot hold `polygons`, or the workload is not for them.
    pub fn on(
        self,
        backend: &str,
        polygons: &PolygonMesh,
    ) -> Option<Result<Box<dyn Editor>, String>> {
        struct Start<'a>(Editing, &'a PolygonMesh);

        impl EditVisitor for Start<'_> {
            type Output = Result<Box<dyn Editor>, String>;

            fn visit<M: Representation + MeshEdit + 'static>(&mut self) -> Self::Output {
                let &mut Self(job, polygons) = self;
                if let Some((f, degree)) = polygons.first_polygon() {
                    return Err(format!(
                        "face {f} has {degree} corners, and {job} needs triangles: triangulate the mesh"
                    ));
                }
                let mesh = M::from_polygons(polygons).map_err(|refusal| refusal.to_string())?;
                Ok(Box::new(Edited {
                    job,
                    edges: match job {
                        Editing::FlipAll => first_named(&mesh),
                        _ => Vec::new(),
                    },
                    mesh,
                    copies: KeptCopies::default(),
                }))
            }
        }

        visit_editable(backend, &mut Start(self, polygons))
    }
}

impl fmt::Display for Editing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A workload that is set up to be run again and again, each time on the mesh as it was.
pub trait Editor {
    /// Runs it as `series` says; the time is that of all timed runs together.
    fn time(&mut self, series: &Series<'_>) -> Time;

    /// What the last run came to.
    fn result(&self) -> Edits;
}

/// What a run came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edits {
    /// What it visited: faces to be split or decimated, edges to be flipped.
    pub elements: u64,
    /// How many edits were done.
    pub done: u64,
    /// How many were refused.
    pub refused: u64,
    /// The sum of all edge lengths afterwards.
    pub checksum: f64,
}

/// A workload on a structure of one type.
struct Edited<M: MeshEdit> {
    job: Editing,
    mesh: M,
    /// Those to be flipped, in their order.
    edges: Vec<M::Edge>,
    copies: KeptCopies<Changed<M>>,
}

/// A copy of the mesh, what its workload needs to know of where its edges are, and what the last run on
/// it came to.
struct Changed<M: MeshEdit> {
    mesh: M,
    edges: Option<Followed<M>>,
    edits: Edits,
}

impl<M: Representation + MeshEdit + 'static> Editor for Edited<M> {
    fn time(&mut self, series: &Series<'_>) -> Time {
        let Self {
            job,
            mesh,
            edges,
            copies,
        } = self;
        let followed = match job {
            Editing::FlipAll => Some(Followed::of(mesh, edges)),
            _ => None,
        };
        copies.time(
            series,
            mesh.memory().total(),
            || Changed {
                mesh: mesh.clone(),
                edges: followed.clone(),
                edits: Edits::default(),
            },
            |copy| {
                copy.mesh.clone_from(mesh);
                copy.edges.clone_from(&followed);
            },
            |copy| {
                copy.edits = match (*job, &mut copy.edges) {
                    (Editing::FlipAll, Some(edges)) => flip_all(&mut copy.mesh, edges),
                    (Editing::DecimateHalf, _) => decimate_to(&mut copy.mesh, 0.5),
                    (Editing::DecimateTenth, _) => decimate_to(&mut copy.mesh, 0.1),
                    _ => split_collapse(&mut copy.mesh),
                };
            },
        )
    }

    fn result(&self) -> Edits {
        let Some(Changed { mesh, edits, .. }) = self.copies.changed() else {
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

#[inline(never)]
fn split_collapse<M: MeshEdit>(mesh: &mut M) -> Edits {
    let mut edits = Edits::default();
    let faces: Vec<M::Face> = mesh.faces().collect();
    let mut middles = Vec::with_capacity(faces.len());
    for f in faces {
        edits.elements += 1;
        let mut sum = sixfold::Point::ZERO;
        mesh.face_vertices(f).for_each(|v| sum += mesh.position(v));
        match mesh.poke_face(f, sum * (1.0 / 3.0), &mut ()) {
            Ok(middle) => middles.push(middle),
            Err(_) => edits.refused += 1,
        }
    }
    for middle in middles {
        let Some(spoke) = mesh.vertex_edges(middle).next() else {
            continue;
        };
        let [a, b] = mesh.edge_vertices(spoke);
        let corner = if a == middle { b } else { a };
        let at = mesh.position(corner);
        match mesh.collapse_edge(spoke, corner, at, &mut ()) {
            Ok(_) => edits.done += 1,
            Err(_) => edits.refused += 1,
        }
    }
    mesh.compact(&mut ());
    edits
}

#[inline(never)]
fn flip_all<M: MeshEdit>(mesh: &mut M, followed: &mut Followed<M>) -> Edits {
    let mut edits = Edits::default();
    for _ in 0..2 {
        for i in 0..followed.edges.len() {
            edits.elements += 1;
            followed.flipping = i;
            match mesh.flip_edge(followed.edges[i], followed) {
                Ok(flipped) => {
                    followed.edges[i] = flipped;
                    followed.settle();
                    edits.done += 1;
                }
                Err(_) => edits.refused += 1,
            }
        }
    }
    edits
}

#[inline(never)]
fn decimate_to<M: Representation + MeshEdit>(mesh: &mut M, ratio: f64) -> Edits {
    let elements = mesh.face_count() as u64;
    let half = Decimation {
        target: Target::Ratio(ratio),
        ..Decimation::default()
    };
    let done = decimate(mesh, &half);
    Edits {
        elements,
        done: done.as_ref().map_or(0, |done| done.collapses as u64),
        refused: done.as_ref().map_or(elements, |done| done.refused as u64),
        checksum: 0.0,
    }
}

/// The edges in the order in which the faces first name them.
fn first_named<M: MeshQuery>(mesh: &M) -> Vec<M::Edge> {
    let mut named = mesh.edge_map(false);
    let mut edges = Vec::new();
    for f in mesh.faces() {
        for e in mesh.face_edges(f) {
            if !std::mem::replace(&mut named[e], true) {
                edges.push(e);
            }
        }
    }
    edges
}

/// Edges by the names they have now, whatever flips call them.
///
/// The flipped edge is returned by its new name. Its neighbours are renamed only where an edge is
/// named by a corner that faces it: who is who then is looked up.
struct Followed<M: MeshEdit> {
    edges: Vec<M::Edge>,
    /// By edge: its place among them.
    places: EdgeMap<M, u32>,
    /// The place of the edge that is being flipped.
    flipping: usize,
    /// Places and names that the flip has told of, until it is over.
    told: Vec<(u32, M::Edge)>,
}

impl<M: MeshEdit> Clone for Followed<M> {
    fn clone(&self) -> Self {
        Self {
            edges: self.edges.clone(),
            places: self.places.clone(),
            flipping: self.flipping,
            told: self.told.clone(),
        }
    }

    /// Copies into the tables that are there.
    fn clone_from(&mut self, source: &Self) {
        let Self {
            edges,
            places,
            flipping,
            told,
        } = source;
        self.edges.clone_from(edges);
        self.places.clone_from(places);
        self.flipping = *flipping;
        self.told.clone_from(told);
    }
}

impl<M: MeshEdit> Followed<M> {
    fn of(mesh: &M, edges: &[M::Edge]) -> Self {
        let mut places = mesh.edge_map(0);
        // A hash map is not needed where flips rename no neighbour; rows are filled for all.
        if mesh.edge_rows() > 0 {
            for (place, &e) in (0..).zip(edges) {
                places.insert(e, place);
            }
        }
        Self {
            edges: edges.to_vec(),
            places,
            flipping: 0,
            told: Vec::with_capacity(8),
        }
    }

    /// Takes the new names over, all at once: one may be another's old one.
    #[inline]
    fn settle(&mut self) {
        while let Some((place, name)) = self.told.pop() {
            self.edges[place as usize] = name;
            self.places.insert(name, place);
        }
    }
}

impl<M: MeshEdit> EditLog<M> for Followed<M> {
    #[inline]
    fn renamed_edge(&mut self, old: M::Edge, new: M::Edge) {
        if old == self.edges[self.flipping] {
            self.told.push((self.flipping as u32, new));
        } else {
            self.told.push((self.places[old], new));
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold::{roster, shapes};

    use super::*;
    use crate::clock::MachineClock;

    #[test]
    fn every_structure_does_the_same_work() {
        let polygons = shapes::geodesic(3).expect("small");
        for job in Editing::ALL {
            let mut results = Vec::new();
            for backend in roster() {
                let editor = job.on(backend.name, &polygons);
                let mut editor = editor.expect("all six").expect("triangles");
                let clock = MachineClock::start();
                editor.time(&Series::once(&clock));
                let once = editor.result();
                editor.time(&Series::of_runs(3, &clock).after(1));
                assert_eq!(editor.result(), once, "{job} on {}, again", backend.name);
                results.push((backend.name, once));
            }
            let (_, first) = results[0];
            assert!(first.done > 0 && first.checksum > 0.0);
            for (name, result) in results {
                assert_eq!(
                    (result.elements, result.done),
                    (first.elements, first.done),
                    "{job} on {name}"
                );
                let error = (result.checksum - first.checksum).abs();
                assert!(error < 1e-6 * first.checksum, "{job} on {name}: {result:?}");
            }
        }
    }

    #[test]
    fn polygons_are_refused_by_name() {
        let refused = Editing::FlipAll
            .on("half-edge", &shapes::cube())
            .expect("one of six");
        let Err(refusal) = refused else {
            panic!("quads are no triangles")
        };
        assert!(refusal.contains("face f0 has 4 corners"), "{refusal}");
        assert!(Editing::FlipAll.on("abacus", &shapes::cube()).is_none());
    }
}

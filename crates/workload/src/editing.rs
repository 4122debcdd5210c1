//! Edit workloads: whole passes of edits over a mesh, on one structure.

use std::fmt;

use sixfold::remeshing::{Decimation, Target, decimate};
use sixfold::{
    EdgeMap, EditLog, EditVisitor, HandleMap, MeshEdit, MeshQuery, PolygonMesh, Representation,
    visit_editable,
};

use crate::clock::Time;
use crate::series::{KeptCopies, Series};

/// One of the workloads that change a triangle mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Editing {
    /// Inserts a vertex into the centre of every face, then collapses each into a neighbour, with
    /// all checks, then compacts the tables. At the end the mesh has its original faces.
    SplitCollapse,
    /// Flips every edge of the initial mesh if the flip is legal, in the order in which the faces
    /// first list the edges; then does the same again.
    FlipAll,
    /// Collapses edges by quadric error until half of the faces are left.
    DecimateHalf,
    /// Collapses edges by quadric error until a tenth of the faces is left.
    DecimateTenth,
}

impl Editing {
    /// All four workloads.
    pub const ALL: [Self; 4] = [
        Self::SplitCollapse,
        Self::FlipAll,
        Self::DecimateHalf,
        Self::DecimateTenth,
    ];

    /// Returns its name, as users write it: `split_collapse`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SplitCollapse => "split_collapse",
            Self::FlipAll => "flip_all",
            Self::DecimateHalf => "decimate_half",
            Self::DecimateTenth => "decimate_tenth",
        }
    }

    /// Sets it up on the structure called `backend`. Returns `None` if there is no such structure,
    /// or it cannot be edited.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`, or a face is not a triangle.
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

/// A workload that is ready to be run repeatedly, each time on the initial mesh.
pub trait Editor {
    /// Runs it as `series` describes and returns the total time of all timed runs.
    fn time(&mut self, series: &Series<'_>) -> Time;

    /// Returns the counts of a run; all runs do the same.
    fn result(&self) -> Edits;
}

/// The counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edits {
    /// Visited elements: faces to split or to decimate, edges to flip.
    pub elements: u64,
    /// Number of edits that were done.
    pub done: u64,
    /// Number of edits that were refused.
    pub refused: u64,
    /// The sum of all edge lengths afterwards.
    pub checksum: f64,
}

/// A workload on a structure of one type.
struct Edited<M: MeshEdit> {
    job: Editing,
    mesh: M,
    /// The edges to flip, in order.
    edges: Vec<M::Edge>,
    copies: KeptCopies<Changed<M>>,
}

/// A copy of the mesh, the current handles of its edges, and the counts of the last run on it.
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

/// Returns the edges in the order in which the faces first list them.
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

/// The current handles of a list of edges, updated when flips change handles.
///
/// A flip returns the new handle of the flipped edge. It changes handles of other edges only in
/// structures whose edge handle is a corner that faces the edge. Then `places` finds the list
/// entry.
struct Followed<M: MeshEdit> {
    edges: Vec<M::Edge>,
    /// By edge: its index in `edges`.
    places: EdgeMap<M, u32>,
    /// The index of the edge that is being flipped.
    flipping: usize,
    /// Indices and new handles that the current flip has reported.
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

    /// Copies into the existing tables.
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
        // Maps by row are always filled. Edges without rows need a hash map; their flips rename
        // only the flipped edge, so the map stays empty.
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

    /// Stores all new handles at once: a new handle may be the old handle of another edge.
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
    fn polygons_are_refused_with_the_first_such_face() {
        let refused = Editing::FlipAll
            .on("half-edge", &shapes::cube())
            .expect("one of six");
        let Err(refusal) = refused else {
            panic!("quads were accepted")
        };
        assert!(refusal.contains("face f0 has 4 corners"), "{refusal}");
        assert!(Editing::FlipAll.on("abacus", &shapes::cube()).is_none());
    }
}

//! One edit by itself, at places that do not touch each other.

use sixfold::{
    Edit, EditVisitor, FaceId, FaceVertexMesh, MeshEdit, MeshQuery, Point, PolygonMesh, Refusal,
    Representation, visit_editable,
};

use crate::editing::{Editor, Edits};

/// An edit to be done at some places of a closed mesh of triangles.
///
/// The places are spread over the mesh, in no order, and no edit at one touches the surroundings of
/// another: so handles that were looked up beforehand keep their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingleEdit {
    /// Which.
    pub edit: Edit,
    /// At how many places at most.
    pub places: usize,
}

impl SingleEdit {
    /// Sets it up on the structure called `backend`; `None` where there is none, or none with this edit.
    ///
    /// # Errors
    ///
    /// Why the structure cannot hold `polygons`, or the edit cannot be done on them.
    pub fn on(
        self,
        backend: &str,
        polygons: &PolygonMesh,
    ) -> Option<Result<Box<dyn Editor>, String>> {
        struct Start<'a>(SingleEdit, &'a PolygonMesh);

        impl EditVisitor for Start<'_> {
            type Output = Option<Result<Box<dyn Editor>, String>>;

            fn visit<M: Representation + MeshEdit + 'static>(&mut self) -> Self::Output {
                let &mut Self(job, polygons) = self;
                let edits = || AtPlaces::<M>::of(job, polygons).map(|edits| Box::new(edits) as _);
                M::offers(job.edit).then(edits)
            }
        }

        visit_editable(backend, &mut Start(self, polygons)).flatten()
    }

    /// Whether it is one pass over the whole mesh, whatever the places.
    pub const fn is_a_pass(self) -> bool {
        matches!(self.edit, Edit::Compact | Edit::RemoveIsolatedVertices)
    }
}

/// Faces none of whose one-rings touch, at most `most`, spread over the mesh, in no order.
fn places(polygons: &PolygonMesh, most: usize) -> Result<Vec<FaceId>, String> {
    let mesh = FaceVertexMesh::from_polygons(polygons).map_err(|refusal| refusal.to_string())?;
    let mut taken = vec![false; polygons.vertex_count()];
    let faces = polygons.face_count();
    // A stride that shares no divisor with the number of faces comes by all of them, far apart.
    let mut stride = (faces as f64 * 0.618) as usize | 1;
    while gcd(stride, faces) != 1 {
        stride += 2;
    }
    let mut chosen = Vec::new();
    let mut at = 0;
    for _ in 0..faces {
        at = (at + stride) % faces;
        let f = FaceId::new(at as u32);
        let around = || {
            let corners = mesh.face(f).iter();
            let faces = corners.flat_map(|&v| mesh.fan(v));
            faces.flat_map(|&g| mesh.face(g)).map(|v| v.index())
        };
        if around().any(|v| taken[v]) {
            continue;
        }
        around().for_each(|v| taken[v] = true);
        chosen.push(f);
        if chosen.len() == most {
            break;
        }
    }
    Ok(chosen)
}

const fn gcd(mut a: usize, mut b: usize) -> usize {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// What an edit needs to know of its place.
struct Place<M: MeshQuery> {
    face: M::Face,
    corners: [M::Vertex; 3],
    edge: Option<M::Edge>,
    /// A neighbour of the first corner, far from the second.
    far: Option<M::Vertex>,
    at: Point,
}

/// An edit at places of a mesh that has been made ready for it.
struct AtPlaces<M: MeshEdit> {
    edit: Edit,
    mesh: M,
    places: Vec<Place<M>>,
    copies: Vec<M>,
    done: Vec<(M, Edits)>,
}

impl<M: Representation + MeshEdit + 'static> AtPlaces<M> {
    fn of(job: SingleEdit, polygons: &PolygonMesh) -> Result<Self, String> {
        let mut mesh = M::from_polygons(polygons).map_err(|refusal| refusal.to_string())?;
        if let Some((f, _)) = polygons.first_polygon() {
            return Err(format!("face {f} is no triangle"));
        }
        // One more, to be done before the clock starts.
        let places = places(polygons, job.places.saturating_add(1))?;
        let mut ready = Vec::with_capacity(places.len());
        // Some structures search for these handles: only what the edit takes is looked up.
        let takes_edge = matches!(
            job.edit,
            Edit::SplitEdge
                | Edit::BisectEdge
                | Edit::SplitFace
                | Edit::DissolveEdge
                | Edit::FlipEdge
                | Edit::CollapseEdge
        );
        for f in places {
            let ids = polygons.faces().face(f);
            let corners = [0, 1, 2].map(|i| M::vertex_name(polygons, ids[i]));
            let [a, b, c] = [0, 1, 2].map(|i: usize| polygons.position(ids[i]));
            let mut place = Place {
                face: M::face_name(polygons, f),
                corners,
                edge: None,
                far: None,
                at: (a + b + c) / 3.0 + Point::splat(1e-3),
            };
            if takes_edge {
                place.edge = mesh.edge_between(corners[0], corners[1]);
            }
            if job.edit == Edit::SplitVertex {
                let mut around = mesh.vertex_vertices(corners[0]);
                place.far = around.find(|v| !corners.contains(v));
            }
            ready.push(place);
        }
        for place in &mut ready {
            let prepared = prepare(&mut mesh, job.edit, place);
            prepared.map_err(|refusal| refusal.to_string())?;
        }
        Ok(Self {
            edit: job.edit,
            mesh,
            places: ready,
            copies: Vec::new(),
            done: Vec::new(),
        })
    }
}

/// Brings one place into the state in which the edit finds something to do.
fn prepare<M: MeshEdit>(mesh: &mut M, edit: Edit, place: &mut Place<M>) -> Result<(), Refusal<M>> {
    match edit {
        Edit::AddFace | Edit::Compact => mesh.remove_face(place.face, &mut ()),
        Edit::SplitFace => {
            let edge = place.edge.take();
            let edge = edge.expect("looked up for all edits at edges");
            place.face = mesh.dissolve_edge(edge, &mut ())?;
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Does the edit at one place.
#[inline(always)]
fn perform<M: MeshEdit>(mesh: &mut M, edit: Edit, place: &Place<M>) -> Result<(), Refusal<M>> {
    let [a, b, c] = place.corners;
    let edge = || place.edge.expect("looked up for all edits at edges");
    let log = &mut ();
    match edit {
        Edit::SetPosition => mesh.set_position(a, place.at, log).map(drop),
        Edit::AddVertex => mesh.add_vertex(place.at, log).map(drop),
        Edit::AddFace => mesh.add_face(&[a, b, c], log).map(drop),
        Edit::RemoveFace => mesh.remove_face(place.face, log),
        Edit::RemoveVertex => mesh.remove_vertex(a, log),
        Edit::SplitEdge => mesh.split_edge(edge(), place.at, log).map(drop),
        Edit::BisectEdge => mesh.bisect_edge(edge(), place.at, log).map(drop),
        Edit::PokeFace => mesh.poke_face(place.face, place.at, log).map(drop),
        Edit::SplitFace => mesh.split_face(place.face, [a, b], log).map(drop),
        Edit::DissolveEdge => mesh.dissolve_edge(edge(), log).map(drop),
        Edit::FlipEdge => mesh.flip_edge(edge(), log).map(drop),
        Edit::CollapseEdge => mesh.collapse_edge(edge(), a, place.at, log).map(drop),
        Edit::SplitVertex => mesh
            .split_vertex(a, Some(b), place.far, place.at, log)
            .map(drop),
        // Passes over the whole mesh, and edits to come.
        _ => Ok(()),
    }
}

impl<M: Representation + MeshEdit + 'static> Editor for AtPlaces<M> {
    /// The edit is done at the first place of each copy: tables that are exactly full have moved then,
    /// and the bits of the holes are there, what many edits share and no single one should pay.
    fn prepare(&mut self, runs: usize) {
        self.done = Vec::with_capacity(runs);
        self.copies = vec![self.mesh.clone(); runs];
        for copy in &mut self.copies {
            if let Some(first) = self.places.first() {
                // Whether it is refused, the others will tell.
                let _ = perform(copy, self.edit, first);
            }
        }
    }

    fn run(&mut self) {
        let Some(mut mesh) = self.copies.pop() else {
            return;
        };
        let mut edits = Edits::default();
        match self.edit {
            Edit::Compact => {
                mesh.compact(&mut ());
                edits.done = 1;
            }
            Edit::RemoveIsolatedVertices => {
                mesh.remove_isolated_vertices(&mut ());
                edits.done = 1;
            }
            edit => {
                for place in self.places.iter().skip(1) {
                    match perform(&mut mesh, edit, place) {
                        Ok(()) => edits.done += 1,
                        Err(_) => edits.refused += 1,
                    }
                }
            }
        }
        edits.elements = edits.done + edits.refused;
        self.done.push((mesh, edits));
    }

    fn result(&self) -> Edits {
        let Some((mesh, edits)) = self.done.last() else {
            return Edits::default();
        };
        Edits {
            checksum: (mesh.vertex_count() + mesh.face_count()) as f64,
            ..*edits
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold::{VertexId, roster, shapes};

    use super::*;

    #[test]
    fn every_edit_is_accepted_at_every_place() {
        let torus = shapes::triangle_torus(40, 40).expect("small");
        for edit in Edit::ALL {
            let job = SingleEdit { edit, places: 20 };
            let mut results = Vec::new();
            for backend in roster() {
                let offers = backend.edits[edit as usize].is_some();
                let Some(editor) = job.on(backend.name, &torus) else {
                    assert!(!offers, "{edit} on {}", backend.name);
                    continue;
                };
                let mut editor = editor.expect("a closed triangle mesh");
                editor.prepare(1);
                editor.run();
                let edits = editor.result();
                let places = if job.is_a_pass() { 1 } else { 20 };
                assert_eq!(
                    (edits.done, edits.refused),
                    (places, 0),
                    "{edit} on {}",
                    backend.name
                );
                results.push(edits);
            }
            assert!(results.len() >= 5, "{edit}");
            assert!(
                results.iter().all(|r| r.checksum == results[0].checksum),
                "{edit}"
            );
        }
    }

    #[test]
    fn places_do_not_touch() {
        let torus = shapes::triangle_torus(30, 30).expect("small");
        let places = places(&torus, usize::MAX).expect("held by all");
        assert!(places.len() > 20, "{}", places.len());
        let mut corners: Vec<VertexId> = places
            .iter()
            .flat_map(|&f| torus.faces().face(f).to_vec())
            .collect();
        corners.sort_unstable();
        corners.dedup();
        assert_eq!(corners.len(), 3 * places.len());
    }
}

//! One edit by itself, at places that do not touch each other.

use sixfold::{Edit, EditVisitor, MeshEdit, PolygonMesh, Representation, visit_editable};

use crate::editing::{Editor, Edits};
use crate::place::{Place, perform, places, prepare};

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
        let look_up = |f| Place::of(&mesh, polygons, job.edit, f);
        let mut ready: Vec<Place<M>> = places.into_iter().map(look_up).collect();
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
    use sixfold::{roster, shapes};

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
}

//! One kind of edit, measured at many faces of a mesh.

use sixfold::{Edit, MeshEdit, PolygonMesh, Refusal, Representation};
use sixfold_core::EditOf;

use crate::backend::Backend;
use crate::edit_place::{independent_faces, prepare_edit};
use crate::operation::edit_pass::{Editor, Edits, PreparedEditor};
use sixfold_measure::{ReusedCopies, Series};
use sixfold_results::Time;

/// An edit that is done at several faces of a closed triangle mesh.
///
/// The chosen faces are spread over the mesh. An edit at one chosen face does not affect the other
/// chosen faces, so handles at the other chosen faces stay valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingleEdit {
    /// The kind of edit.
    pub edit: Edit,
    /// The maximum number of faces at which the edit is done.
    pub places: usize,
}

impl SingleEdit {
    /// Prepares the edit for the structure of `backend`. Returns `None` if the structure does not
    /// support the edit.
    ///
    /// # Errors
    ///
    /// Returns the reason if the structure cannot hold `polygons`, if a face is not a triangle, or
    /// if the edit cannot be prepared at a chosen face.
    pub fn prepare(self, backend: &Backend, polygons: &PolygonMesh) -> Option<PreparedEditor> {
        backend.info.edits[self.edit as usize]?;
        Some((backend.edits?.prepare_single)(self, polygons))
    }

    /// Returns true if the edit is a pass over the whole mesh.
    pub const fn is_pass(self) -> bool {
        matches!(self.edit, Edit::Compact | Edit::RemoveIsolatedVertices)
    }
}

pub(crate) fn prepare_single<M: Representation + MeshEdit + 'static>(
    job: SingleEdit,
    polygons: &PolygonMesh,
) -> PreparedEditor {
    Ok(Box::new(SingleEditRun::<M>::new(job, polygons)?))
}

struct SingleEditRun<M: MeshEdit> {
    edit: Edit,
    mesh: M,
    /// One for each place.
    calls: Vec<EditOf<M>>,
    copies: ReusedCopies<(M, Edits)>,
}

impl<M: Representation + MeshEdit + 'static> SingleEditRun<M> {
    fn new(job: SingleEdit, polygons: &PolygonMesh) -> Result<Self, String> {
        let mut mesh = M::from_polygons(polygons).map_err(|refusal| refusal.to_string())?;
        if let Some((f, _)) = polygons.first_polygon() {
            return Err(format!("face {f} is not a triangle"));
        }
        let faces = independent_faces(polygons, job.places)?;
        let calls = faces
            .into_iter()
            .map(|f| prepare_edit(&mut mesh, polygons, job.edit, f));
        let calls: Result<_, Refusal<M>> = calls.collect();
        let calls = calls.map_err(|refusal| refusal.to_string())?;
        Ok(Self {
            edit: job.edit,
            mesh,
            calls,
            copies: ReusedCopies::default(),
        })
    }
}

impl<M: Representation + MeshEdit + 'static> Editor for SingleEditRun<M> {
    fn time(&mut self, series: &Series<'_>) -> Time {
        let Self {
            edit,
            mesh,
            calls,
            copies,
        } = self;
        copies.time(
            series,
            mesh.memory().total(),
            || (mesh.clone(), Edits::default()),
            |(copy, _)| copy.clone_from(mesh),
            |(copy, edits)| *edits = apply_at_all_places(*edit, copy, calls),
        )
    }

    fn result(&self) -> Edits {
        let Some((mesh, edits)) = self.copies.used_copy() else {
            return Edits::default();
        };
        Edits {
            checksum: (mesh.vertex_count() + mesh.face_count()) as f64,
            ..*edits
        }
    }
}

/// Applies the edit at all places. A pass over the whole mesh is applied once.
fn apply_at_all_places<M: MeshEdit + Representation>(
    edit: Edit,
    mesh: &mut M,
    calls: &[EditOf<M>],
) -> Edits {
    let mut edits = Edits::default();
    match edit {
        Edit::Compact => {
            mesh.compact();
            edits.done = 1;
        }
        Edit::RemoveIsolatedVertices => {
            mesh.remove_isolated_vertices();
            edits.done = 1;
        }
        _ => {
            for (i, call) in calls.iter().enumerate() {
                match call.apply(mesh, &mut ()) {
                    Ok(_) => edits.done += 1,
                    Err(_) => edits.refuse(i),
                }
            }
        }
    }
    edits.elements = edits.done + edits.refused;
    edits
}

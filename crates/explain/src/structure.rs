//! The structures that can be explained.

use sixfold::{BuildError, MeshEdit, PolygonMesh, Representation};
use sixfold_core::{Described, EditByName, Measured, Traced};

use crate::built_mesh::BuiltMesh;
use crate::error::ExplainError;
use crate::named_mesh::named_mesh;

/// A structure whose tables can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    name: &'static str,
    build: fn(&PolygonMesh) -> Result<BuiltMesh, ExplainError>,
    no_room: fn(&BuildError) -> Option<String>,
}

impl Structure {
    /// Returns the structure `M`, which need not be part of Sixfold. Its edits are not shown.
    pub fn new<M>() -> Self
    where
        M: Representation + Measured,
        M::Probed<Traced>: Described + 'static,
    {
        Self {
            name: M::NAME,
            build: |polygons| named_mesh::<M>(polygons).map(BuiltMesh::fixed),
            no_room: M::Probed::<Traced>::no_room,
        }
    }

    /// Returns the structure whose editable form is `M`. Queries read the same rows in both forms, so
    /// this form is used for all that is shown.
    pub fn with_edits<M>() -> Self
    where
        M: Representation + Measured,
        M::Probed<Traced>: MeshEdit + Described + Clone + 'static,
    {
        Self {
            name: M::NAME,
            build: |polygons| named_mesh::<M>(polygons).map(BuiltMesh::editable),
            no_room: M::Probed::<Traced>::no_room,
        }
    }

    /// Returns the six structures of Sixfold.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        sixfold::for_each_editable!(M => { all.push(Self::with_edits::<M>()); });
        all
    }

    /// Returns the structure of Sixfold with this name, or `None` if no structure has it.
    pub fn find(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|one| one.name == name)
    }

    /// Returns the name of the structure, such as `half-edge`.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns why the structure cannot hold a mesh: the fault, and the field that has no room for it.
    pub(crate) fn refusal(&self, refusal: BuildError) -> ExplainError {
        ExplainError::Refused {
            structure: self.name,
            room: (self.no_room)(&refusal),
            refusal,
        }
    }

    /// Builds the structure from `polygons`. O(corners).
    ///
    /// To undo edits, build the mesh again, and run only the edits before them
    /// ([`build_after`](Self::build_after)).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh.
    pub fn build(&self, polygons: &PolygonMesh) -> Result<BuiltMesh, ExplainError> {
        (self.build)(polygons)
    }

    /// Builds the structure from `polygons`, and runs `edits`. O(corners), and the time of the edits.
    ///
    /// # Errors
    ///
    /// The errors of [`build`](Self::build) and of [`BuiltMesh::apply`], and
    /// [`ExplainError::RefusedEdit`] if the structure refuses an edit or does not have its elements.
    pub fn build_after(
        &self,
        polygons: &PolygonMesh,
        edits: &[EditByName],
    ) -> Result<BuiltMesh, ExplainError> {
        let mut mesh = self.build(polygons)?;
        for edit in edits {
            mesh.apply_accepted(edit)?;
        }
        Ok(mesh)
    }
}

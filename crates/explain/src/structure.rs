//! The structures that can be explained.

use sixfold::{MeshEdit, PolygonMesh, Representation};
use sixfold_core::{Described, Measured, Traced};

use crate::built_mesh::BuiltMesh;
use crate::edit_command::EditCommand;
use crate::error::ExplainError;
use crate::named_mesh::named_mesh;

type Build = fn(&PolygonMesh) -> Result<BuiltMesh, ExplainError>;

/// A structure whose tables can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    name: &'static str,
    build: Build,
    build_editable: Option<Build>,
}

impl Structure {
    /// Returns the structure `M`, which need not be part of Sixfold.
    pub fn new<M>() -> Self
    where
        M: Representation + Measured,
        M::Probed<Traced>: Described + 'static,
    {
        Self {
            name: M::NAME,
            build: |polygons| named_mesh::<M>(polygons).map(BuiltMesh::fixed),
            build_editable: None,
        }
    }

    /// Returns the same structure, whose editable form is `M`.
    #[must_use]
    pub fn with_edits<M>(self) -> Self
    where
        M: Representation + Measured,
        M::Probed<Traced>: MeshEdit + Described + Clone + 'static,
    {
        Self {
            build_editable: Some(|polygons| named_mesh::<M>(polygons).map(BuiltMesh::editable)),
            ..self
        }
    }

    /// Returns the six structures of Sixfold.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        sixfold::for_each_representation!(M => { all.push(Self::new::<M>()); });
        sixfold::for_each_editable!(M => {
            let own = all.iter_mut().find(|one| one.name == M::NAME);
            if let Some(own) = own {
                *own = own.with_edits::<M>();
            }
        });
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

    /// Builds the structure from `polygons`. O(corners).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh.
    pub fn build(&self, polygons: &PolygonMesh) -> Result<BuiltMesh, ExplainError> {
        (self.build)(polygons)
    }

    /// Builds the editable form of the structure from `polygons`. O(corners).
    ///
    /// To undo edits, build the mesh again, and run only the edits before them
    /// ([`build_after`](Self::build_after)).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh, and
    /// [`ExplainError::NoEdits`] without [`with_edits`](Self::with_edits).
    pub fn build_editable(&self, polygons: &PolygonMesh) -> Result<BuiltMesh, ExplainError> {
        let structure = self.name;
        let build = self.build_editable;
        let build = build.ok_or(ExplainError::NoEdits { structure })?;
        build(polygons)
    }

    /// Builds the structure from `polygons`, and runs `edits`. Without edits, does the same as
    /// [`build`](Self::build). O(corners), and the time of the edits.
    ///
    /// # Errors
    ///
    /// The errors of [`build_editable`](Self::build_editable) and of [`BuiltMesh::apply`], and
    /// [`ExplainError::RefusedEdit`] if the structure refuses an edit or does not have its elements.
    pub fn build_after(
        &self,
        polygons: &PolygonMesh,
        edits: &[EditCommand],
    ) -> Result<BuiltMesh, ExplainError> {
        if edits.is_empty() {
            return self.build(polygons);
        }
        let mut mesh = self.build_editable(polygons)?;
        for edit in edits {
            let reason = match mesh.apply(edit) {
                Ok(None) => continue,
                Ok(Some(refusal)) => refusal,
                Err(error @ ExplainError::NoSuchElement { .. }) => error.to_string(),
                Err(error) => return Err(error),
            };
            return Err(ExplainError::RefusedEdit {
                structure: self.name,
                edit: edit.to_string(),
                reason,
            });
        }
        Ok(mesh)
    }
}

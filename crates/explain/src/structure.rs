//! The structures that can be explained.

use sixfold::{BuildError, MeshEdit, PolygonMesh, Relation, Representation, UnknownName};
use sixfold_core::{Described, Measured, Traced};

use crate::built_mesh::BuiltMesh;
use crate::edit_command::EditCommand;
use crate::element::ElementName;
use crate::named_mesh::named_mesh;

/// A relation, and the element from which a query starts.
pub type Query = (Relation, ElementName);

type Build = fn(&PolygonMesh) -> Result<BuiltMesh, ExplainError>;

/// A structure whose tables can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    name: &'static str,
    build: Build,
    build_editable: Option<Build>,
}

/// The reason why a structure cannot be explained on a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ExplainError {
    /// The structure cannot hold the mesh.
    #[error("{structure} cannot hold the mesh: {refusal}")]
    Refused {
        structure: &'static str,
        refusal: BuildError,
    },
    /// A text that is not the name of an element.
    #[error("`{name}` names no element: write v3 for a vertex, v0-v1 for an edge, f2 for a face")]
    BadName { name: String },
    /// The structure has no element of this name.
    #[error("{structure} has no {} {name} in this mesh", name.kind())]
    NoSuchElement {
        structure: &'static str,
        name: ElementName,
    },
    /// The structure refuses an edit that comes before what is shown.
    #[error("{structure} refuses {edit}: {reason}")]
    RefusedEdit {
        structure: &'static str,
        edit: String,
        reason: String,
    },
    /// A text that is not an edit.
    #[error("{reason}")]
    BadEdit { reason: String },
    /// The structure was given without its editable form.
    #[error("{structure} has no edits")]
    NoEdits { structure: &'static str },
    /// A text that is not a walk, or that names a row that does not exist.
    #[error("{reason}")]
    BadWalk { reason: String },
    /// A step of a walk that has no answer.
    #[error("{reason}")]
    Stopped { reason: String },
    /// A word of a walk that the structure does not know.
    #[error(transparent)]
    UnknownWord(#[from] UnknownName),
    /// The relation starts from another kind of element.
    #[error("{relation} starts from {}, and {element} is {}", an(wanted), an(element.kind()))]
    WrongKind {
        relation: Relation,
        wanted: &'static str,
        element: ElementName,
    },
}

fn an(kind: &str) -> String {
    let article = if kind == "edge" { "an" } else { "a" };
    format!("{article} {kind}")
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
    /// [`ExplainError::RefusedEdit`] if the structure refuses an edit.
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
            if let Some(reason) = mesh.apply(edit)? {
                return Err(ExplainError::RefusedEdit {
                    structure: self.name,
                    edit: edit.to_string(),
                    reason,
                });
            }
        }
        Ok(mesh)
    }
}

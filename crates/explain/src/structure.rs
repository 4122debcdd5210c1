//! The structures that can be explained.

use std::ops::Range;

use sixfold::{BuildError, MeshEdit, PolygonMesh, Relation, Representation, UnknownName};
use sixfold_core::{Described, Measured, Traced};

use crate::edit::{EditTrace, edit, edited_records};
use crate::edit_command::EditCommand;
use crate::element::ElementName;
use crate::records::{Records, records};
use crate::trace::{Trace, trace};
use crate::walk::{Walk, walk};

/// A relation, and the element from which a query starts.
pub type Query = (Relation, ElementName);

type Explained<T> = Result<Vec<T>, ExplainError>;

/// The functions of the editable form of a structure.
#[derive(Clone, Copy, Debug)]
struct Edits {
    edit: fn(&PolygonMesh, &[EditCommand]) -> Explained<EditTrace>,
    records: fn(&PolygonMesh, &[EditCommand], &Range<usize>) -> Explained<Records>,
}

/// A structure whose tables can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    name: &'static str,
    records: fn(&PolygonMesh, &Range<usize>) -> Result<Vec<Records>, BuildError>,
    trace: fn(&PolygonMesh, Relation, ElementName) -> Result<Trace, ExplainError>,
    walk: fn(&PolygonMesh, &str, Option<Query>) -> Result<Walk, ExplainError>,
    edits: Option<Edits>,
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
        M: Representation + Measured + Described,
        M::Probed<Traced>: Described,
    {
        Self {
            name: M::NAME,
            records: |polygons, rows| Ok(records(&M::from_polygons(polygons)?, rows)),
            trace: trace::<M>,
            walk: walk::<M>,
            edits: None,
        }
    }

    /// Returns the same structure, whose editable form is `M`.
    #[must_use]
    pub fn with_edits<M>(self) -> Self
    where
        M: Representation + Measured + MeshEdit,
        M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face> + Described,
    {
        Self {
            edits: Some(Edits {
                edit: edit::<M>,
                records: edited_records::<M>,
            }),
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

    /// Builds the structure from `polygons`, and returns its records in the rows `rows`, for each kind
    /// of element. O(corners of the mesh).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh.
    pub fn records(
        &self,
        polygons: &PolygonMesh,
        rows: Range<usize>,
    ) -> Result<Vec<Records>, ExplainError> {
        (self.records)(polygons, &rows).map_err(|refusal| ExplainError::Refused {
            structure: self.name,
            refusal,
        })
    }

    /// Builds the structure from `polygons`, runs one query, and returns its reads and results.
    /// O(corners of the mesh).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh,
    /// [`ExplainError::NoSuchElement`] if it does not have the element, and
    /// [`ExplainError::WrongKind`] if the relation starts from another kind of element.
    pub fn trace(
        &self,
        polygons: &PolygonMesh,
        relation: Relation,
        element: ElementName,
    ) -> Result<Trace, ExplainError> {
        (self.trace)(polygons, relation, element)
    }

    /// Builds the structure from `polygons`, and runs a walk in the words of the structure: the names of
    /// its fields. Compares the results with the relation `expected`. O(corners of the mesh).
    ///
    /// ```text
    /// h = leaving(v3); repeat { yield target(h); h = next(twin(h)) }
    /// ```
    ///
    /// A loop ends when its variable has the first value again. A step that has no answer, such as the
    /// opposite of a corner at a boundary, ends the walk ([`Walk::stopped`]).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh, and
    /// [`ExplainError::BadWalk`] or [`ExplainError::UnknownWord`] for a text that is not a walk on this
    /// structure.
    pub fn walk(
        &self,
        polygons: &PolygonMesh,
        walk: &str,
        expected: Option<Query>,
    ) -> Result<Walk, ExplainError> {
        (self.walk)(polygons, walk, expected)
    }

    /// Builds the structure from `polygons`, runs the edits one after the other, and returns what each
    /// of them reads and writes. A refused edit changes nothing, and the next one runs. O(size of the mesh)
    /// for each edit, because all rows are compared.
    ///
    /// To undo the last edit, leave it out: the rows are then those before the edit.
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::Refused`] if the structure cannot hold the mesh,
    /// [`ExplainError::NoSuchElement`] if an edit names an element that does not exist, and
    /// [`ExplainError::NoEdits`] without [`with_edits`](Self::with_edits).
    pub fn edit(
        &self,
        polygons: &PolygonMesh,
        edits: &[EditCommand],
    ) -> Result<Vec<EditTrace>, ExplainError> {
        (self.editable()?.edit)(polygons, edits)
    }

    /// Does the same as [`records`](Self::records), after edits.
    ///
    /// # Errors
    ///
    /// The errors of [`edit`](Self::edit).
    pub fn records_after(
        &self,
        polygons: &PolygonMesh,
        edits: &[EditCommand],
        rows: Range<usize>,
    ) -> Result<Vec<Records>, ExplainError> {
        (self.editable()?.records)(polygons, edits, &rows)
    }

    fn editable(&self) -> Result<Edits, ExplainError> {
        let structure = self.name;
        self.edits.ok_or(ExplainError::NoEdits { structure })
    }
}

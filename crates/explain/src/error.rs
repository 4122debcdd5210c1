//! The reasons why a mesh, a query, an edit or a walk cannot be shown.

use serde::Serialize;
use sixfold::{BuildError, Relation, UnknownName};
use sixfold_core::{EditTextError, ElementName, NoElementName};

/// A structure that shows nothing, among others that do.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// The name of the structure.
    #[serde(rename = "backend")]
    pub structure: &'static str,
    /// Why it shows nothing.
    pub reason: String,
}

/// The reason why a structure cannot be explained on a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ExplainError {
    /// The structure cannot hold the mesh.
    #[error("{structure} cannot hold the mesh: {refusal}{}", after(room))]
    Refused {
        structure: &'static str,
        refusal: BuildError,
        /// Which field has no room ([`Described::no_room`](sixfold_core::Described::no_room)).
        room: Option<String>,
    },
    /// A text that is not the name of an element.
    #[error(transparent)]
    BadName(#[from] NoElementName),
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
    /// The edit reads and writes too many rows.
    #[error(
        "{structure} makes more than {limit} reads and writes for {edit}: choose a smaller mesh, or an \
         element with fewer faces"
    )]
    TooManyAccesses {
        structure: &'static str,
        edit: String,
        limit: usize,
    },
    /// A text that is not an edit.
    #[error(transparent)]
    BadEdit(#[from] EditTextError),
    /// The structure was given without its editable form.
    #[error("{structure} has no edits")]
    NoEdits { structure: &'static str },
    /// The structure is not part of Sixfold.
    #[error("{structure} has no sweeps: it is not a structure of Sixfold")]
    NoSweeps { structure: &'static str },
    /// A text that is not a walk, or that names a row that does not exist.
    #[error("{reason}")]
    BadWalk { reason: String },
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

fn after(room: &Option<String>) -> String {
    room.as_ref()
        .map_or(String::new(), |room| format!("; {room}"))
}

fn an(kind: &str) -> String {
    let article = if kind == "edge" { "an" } else { "a" };
    format!("{article} {kind}")
}

//! What the results say about an operation, so that a reader of a document needs no list of operations.

use serde::{Deserialize, Serialize};

/// An operation that a run can measure. The list of all operations is in [`Run`](crate::Run).
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct OperationInfo {
    /// The name, such as `vertex_normal`.
    pub name: String,
    /// The group of the operation in tables.
    pub group: OperationGroup,
    /// What one run of the operation does, in at most 45 characters.
    pub about: String,
    /// The kind of the visited elements: `vertex`, `edge`, `face`, `new face`, or `visit`.
    pub unit: String,
    /// For a method of subdivision, the name of the scheme, such as `Catmull–Clark`. The methods of a
    /// scheme do the same work. `None` for other operations.
    pub scheme: Option<String>,
    /// The method of a subdivision, such as `gather`; `None` for other operations.
    pub method: Option<String>,
}

sixfold_core::named! {
    /// A group of operations in tables. The groups have the order of the tables.
    pub enum OperationGroup: "group of operations" {
        /// Building the structure.
        Build = "build",
        /// Queries of relations.
        Queries = "queries",
        /// Passes over the mesh that compute something.
        Traversals = "traversals",
        /// Edits of the mesh.
        Edits = "edits",
        /// Subdivision of the mesh.
        Subdivision = "subdivision",
    }
}

sixfold_core::named! {
    /// A kind of work to which several operations belong, such as editing.
    pub enum Purpose: "purpose" {
        /// Building the structure from an indexed face set.
        Build = "build",
        /// Queries, and read-only passes over the mesh.
        Query = "query",
        /// Edits that change the connectivity of the mesh.
        Edit = "edit",
        /// Subdivision, with the fastest method of each backend.
        Subdivide = "subdivide",
    }
}

impl OperationGroup {
    /// Returns the purpose that the operations of this group serve.
    pub const fn purpose(self) -> Purpose {
        match self {
            Self::Build => Purpose::Build,
            Self::Queries | Self::Traversals => Purpose::Query,
            Self::Edits => Purpose::Edit,
            Self::Subdivision => Purpose::Subdivide,
        }
    }
}

impl Purpose {
    /// Returns the purpose of a choice, such as `for queries`.
    pub const fn of_choice(self) -> &'static str {
        match self {
            Self::Build => "to build",
            Self::Query => "for queries",
            Self::Edit => "for edits",
            Self::Subdivide => "for subdivision",
        }
    }

    /// Returns the name of the purpose as the title of a part, such as `Queries`.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Build => "Building",
            Self::Query => "Queries",
            Self::Edit => "Edits",
            Self::Subdivide => "Subdivision",
        }
    }
}

//! The capabilities that a program can require of a structure.

use std::fmt;
use std::str::FromStr;

use serde_with::{DeserializeFromStr, SerializeDisplay};
use sixfold_workload::{Backend, unknown};

/// A required capability of a structure.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, DeserializeFromStr, SerializeDisplay,
)]
pub enum Need {
    /// The structure can be edited: its edges can be split, collapsed and flipped.
    Edit,
    /// The structure can hold edges with three or more faces, and vertices whose faces form several
    /// fans (groups of faces that are connected by edges).
    NonManifold,
    /// The structure can hold faces with any number of corners.
    Polygons,
    /// The structure can hold adjacent faces with different orientations, which run along the
    /// common edge in the same direction.
    MixedOrientation,
    /// The structure can hold vertices without a face.
    IsolatedVertices,
    /// The structure keeps vertices with equal coordinates separate.
    CoincidentVertices,
    /// The structure can subdivide by splitting the elements in its own tables.
    Refine,
}

impl Need {
    /// All capabilities that a program can require.
    pub const ALL: [Self; 7] = [
        Self::Edit,
        Self::NonManifold,
        Self::Polygons,
        Self::MixedOrientation,
        Self::IsolatedVertices,
        Self::CoincidentVertices,
        Self::Refine,
    ];

    /// Returns the name of the capability in command-line options, such as `non-manifold`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Edit => "edit",
            Self::NonManifold => "non-manifold",
            Self::Polygons => "polygons",
            Self::MixedOrientation => "mixed-orientation",
            Self::IsolatedVertices => "isolated-vertices",
            Self::CoincidentVertices => "coincident-vertices",
            Self::Refine => "refine",
        }
    }

    /// Returns why `backend` does not meet this need; `None` if it meets the need.
    pub(crate) fn unmet_reason(self, backend: &Backend) -> Option<String> {
        let can = backend.info.capabilities;
        let (has, lacks) = match self {
            Self::Edit => (backend.info.is_editable(), "it cannot be edited"),
            Self::NonManifold => (
                can.non_manifold_edges && can.non_manifold_vertices,
                "it holds manifolds only",
            ),
            Self::Polygons => (can.polygons, "it holds triangles only"),
            Self::MixedOrientation => (
                can.inconsistent_orientation,
                "it holds consistently oriented faces only",
            ),
            Self::IsolatedVertices => (
                can.isolated_vertices,
                "it cannot hold a vertex without a face",
            ),
            Self::CoincidentVertices => (
                can.coincident_vertices,
                "it merges vertices that share coordinates",
            ),
            Self::Refine => (
                !backend.info.splits.is_empty(),
                "it cannot split its own tables",
            ),
        };
        (!has).then(|| format!("{lacks} (--needs {self})"))
    }
}

impl fmt::Display for Need {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The error for an unknown name of a capability.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", unknown("need", .name, &Need::ALL.map(Need::name)))]
pub struct UnknownNeed {
    /// The unknown name.
    pub name: String,
}

impl FromStr for Need {
    type Err = UnknownNeed;

    fn from_str(name: &str) -> Result<Self, UnknownNeed> {
        let mut all = Self::ALL.into_iter();
        all.find(|need| need.name() == name)
            .ok_or_else(|| UnknownNeed { name: name.into() })
    }
}

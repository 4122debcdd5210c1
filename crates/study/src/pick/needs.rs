//! What a program needs of its mesh data structure, by name.

use std::fmt;
use std::str::FromStr;

use serde_with::{DeserializeFromStr, SerializeDisplay};
use sixfold::subdivision::{Method, Scheme};
use sixfold::support;
use workload::{Backend, unknown};

/// Something that a structure has to be able to do, or to hold.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, DeserializeFromStr, SerializeDisplay,
)]
pub enum Need {
    /// Change connectivity: split, collapse, flip.
    Edit,
    /// Hold edges with three faces or more, and vertices whose faces form more than one fan.
    NonManifold,
    /// Hold faces with any number of corners.
    Polygons,
    /// Hold two faces that run along an edge in the same direction.
    MixedOrientation,
    /// Hold vertices without a face.
    IsolatedVertices,
    /// Keep vertices apart that share their coordinates.
    CoincidentVertices,
    /// Split its own tables for subdivision.
    Refine,
}

impl Need {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; 7] = [
        Self::Edit,
        Self::NonManifold,
        Self::Polygons,
        Self::MixedOrientation,
        Self::IsolatedVertices,
        Self::CoincidentVertices,
        Self::Refine,
    ];

    /// What users call it: `non-manifold`.
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

    /// What `backend` lacks of it, in words; `None` if it has it.
    pub(crate) fn lacking(self, backend: &Backend) -> Option<String> {
        let can = backend.info.capabilities;
        let (has, lacks) = match self {
            // The roster knows of edits what a backend of one type does not.
            Self::Edit => (edits(backend.name()), "it cannot be edited"),
            Self::NonManifold => (
                can.non_manifold_edges && can.non_manifold_vertices,
                "it holds manifolds only",
            ),
            Self::Polygons => (can.polygons, "it holds triangles only"),
            Self::MixedOrientation => (
                can.inconsistent_orientation,
                "it holds consistently oriented faces only",
            ),
            Self::IsolatedVertices => (can.isolated_vertices, "it holds no vertex without a face"),
            Self::CoincidentVertices => (
                can.coincident_vertices,
                "it merges vertices that share coordinates",
            ),
            Self::Refine => (refines(backend.name()), "it cannot split its own tables"),
        };
        (!has).then(|| format!("{lacks} (--needs {self})"))
    }
}

fn edits(name: &str) -> bool {
    let found = sixfold::roster().into_iter().find(|row| row.name == name);
    found.is_some_and(|row| row.edits.iter().any(Option::is_some))
}

fn refines(name: &str) -> bool {
    let splits = |scheme| {
        support(scheme)
            .iter()
            .any(|row| row.backend == name && row.best() == Some(Method::Native))
    };
    [Scheme::Loop, Scheme::CatmullClark].into_iter().any(splits)
}

impl fmt::Display for Need {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A need that nobody has heard of.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", unknown("need", .name, &Need::ALL.map(Need::name)))]
pub struct UnknownNeed {
    /// The name.
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

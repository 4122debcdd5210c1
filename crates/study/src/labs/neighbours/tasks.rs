//! What the lab times: building the indices, and the queries.

use std::fmt;
use std::str::FromStr;

use serde_with::{DeserializeFromStr, SerializeDisplay};

/// The number of vertices that [`SpatialTask::NearestEight`] searches.
pub(crate) const EIGHT: usize = 8;

/// One task of the lab: building an index, or one kind of query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, DeserializeFromStr, SerializeDisplay)]
#[non_exhaustive]
pub enum SpatialTask {
    /// Builds the index of the vertices.
    BuildVertices,
    /// Finds the nearest vertex of each query point.
    NearestVertex,
    /// Visits all vertices within a radius of each query point.
    VerticesWithin,
    /// Finds the eight nearest vertices of each query point.
    NearestEight,
    /// Builds the index of the triangles.
    BuildTriangles,
    /// Finds the point of the surface that is closest to each query point.
    ClosestPoint,
    /// Finds where each ray first hits the surface.
    FirstHit,
}

impl SpatialTask {
    /// All tasks, in the order in which tables list them.
    pub const ALL: [Self; 7] = [
        Self::BuildVertices,
        Self::NearestVertex,
        Self::VerticesWithin,
        Self::NearestEight,
        Self::BuildTriangles,
        Self::ClosestPoint,
        Self::FirstHit,
    ];

    /// Returns the name of the task in tables and files, such as `nearest_vertex`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BuildVertices => "build_vertices",
            Self::NearestVertex => "nearest_vertex",
            Self::VerticesWithin => "vertices_within",
            Self::NearestEight => "nearest_eight",
            Self::BuildTriangles => "build_triangles",
            Self::ClosestPoint => "closest_point",
            Self::FirstHit => "first_hit",
        }
    }

    /// Returns the unit of the elements that the task counts: `vertex`, `triangle`, `query` or
    /// `ray`.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::BuildVertices => "vertex",
            Self::BuildTriangles => "triangle",
            Self::FirstHit => "ray",
            _ => "query",
        }
    }

    /// Returns the task that builds the index for this query; `None` if the task is not a query.
    pub const fn build(self) -> Option<Self> {
        match self {
            Self::BuildVertices | Self::BuildTriangles => None,
            Self::NearestVertex | Self::VerticesWithin | Self::NearestEight => {
                Some(Self::BuildVertices)
            }
            Self::ClosestPoint | Self::FirstHit => Some(Self::BuildTriangles),
        }
    }
}

impl fmt::Display for SpatialTask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The error for an unknown name of a spatial task.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown spatial task `{name}`")]
pub struct UnknownSpatialTask {
    /// The unknown name.
    pub name: String,
}

impl FromStr for SpatialTask {
    type Err = UnknownSpatialTask;

    fn from_str(name: &str) -> Result<Self, UnknownSpatialTask> {
        let mut all = Self::ALL.into_iter();
        all.find(|task| task.name() == name)
            .ok_or_else(|| UnknownSpatialTask { name: name.into() })
    }
}

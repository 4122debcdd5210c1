//! The capabilities that a program can require of a structure.

use sixfold_workload::Backend;

sixfold_core::named! {
    /// A required capability of a structure.
    pub enum Need: "need" {
        /// The structure can be edited: its edges can be split, collapsed and flipped.
        Edit = "edit",
        /// The structure can hold edges with three or more faces, and vertices whose faces form
        /// several fans (groups of faces that are connected by edges).
        NonManifold = "non-manifold",
        /// The structure can hold faces with any number of corners.
        Polygons = "polygons",
        /// The structure can hold adjacent faces with different orientations, which run along the
        /// common edge in the same direction.
        MixedOrientation = "mixed-orientation",
        /// The structure can hold vertices without a face.
        IsolatedVertices = "isolated-vertices",
        /// The structure keeps vertices with equal coordinates separate.
        CoincidentVertices = "coincident-vertices",
        /// The structure can subdivide by splitting the elements in its own tables.
        Refine = "refine",
    }
}

impl Need {
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

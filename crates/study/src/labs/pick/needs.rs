//! The capabilities that a program can require of a structure.

use sixfold_results::Need;
use sixfold_workload::Backend;

/// Returns why `backend` does not meet `need`; `None` if it meets the need.
pub(crate) fn unmet_reason(need: Need, backend: &Backend) -> Option<String> {
    let can = backend.info.capabilities;
    let (has, lacks) = match need {
        Need::Edit => (backend.info.is_editable(), "it cannot be edited"),
        Need::NonManifold => (
            can.non_manifold_edges && can.non_manifold_vertices,
            "it holds manifolds only",
        ),
        Need::Polygons => (can.polygons, "it holds triangles only"),
        Need::MixedOrientation => (
            can.inconsistent_orientation,
            "it holds consistently oriented faces only",
        ),
        Need::IsolatedVertices => (
            can.isolated_vertices,
            "it cannot hold a vertex without a face",
        ),
        Need::CoincidentVertices => (
            can.coincident_vertices,
            "it merges vertices that share coordinates",
        ),
        Need::Refine => (
            !backend.info.splits.is_empty(),
            "it cannot split its own tables",
        ),
    };
    (!has).then(|| format!("{lacks} (--needs {need})"))
}

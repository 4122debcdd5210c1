//! What a mesh is, and which backends can hold it.

use sixfold::{BuildError, Counts, Facts, PolygonMesh};

use crate::report::{BackendReport, Inspection, MeshReport, SCHEMA};
use workload::Backend;

/// A mesh to be looked into.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Where it comes from, in words.
    pub name: String,
    /// What its file is, degenerate faces included; these have no edges.
    pub facts: Facts,
    /// The mesh to build structures from: the faces of the file that are not degenerate.
    pub polygons: PolygonMesh,
    /// How `polygons` differs from the file, in words.
    pub changes: Vec<String>,
}

impl Specimen {
    /// A mesh as it is, with its facts; O(corners) expected.
    pub fn new(name: impl Into<String>, polygons: PolygonMesh) -> Self {
        Self {
            name: name.into(),
            facts: Facts::of(&polygons),
            polygons,
            changes: Vec::new(),
        }
    }

    pub(crate) fn report(&self) -> MeshReport {
        MeshReport {
            name: self.name.clone(),
            facts: self.facts.clone(),
            changes: self.changes.clone(),
        }
    }
}

/// Asks each backend whether it can hold the mesh, and builds none; O(corners) expected for each.
pub fn inspect(specimen: &Specimen) -> Inspection {
    let counts = specimen.polygons.counts(specimen.facts.edges);
    let backends = Backend::roster().into_iter().map(|backend| {
        let verdict = backend.info.verdict(&specimen.polygons);
        unbuilt(&backend, &counts, verdict)
    });
    Inspection {
        schema: SCHEMA,
        mesh: specimen.report(),
        backends: backends.collect(),
    }
}

/// What there is to say of a backend before it is built, or that refused to be.
pub(crate) fn unbuilt(
    backend: &Backend,
    counts: &Counts,
    verdict: Result<(), BuildError>,
) -> BackendReport {
    let reason = verdict.err().map(|refusal| refusal.to_string());
    let holds = reason.is_none();
    let layout_bytes = holds.then(|| (backend.layout_bytes)(counts));
    BackendReport {
        name: backend.name().into(),
        holds,
        reason,
        bytes: None,
        bytes_per_vertex: None,
        layout_bytes,
        layout_bytes_per_vertex: layout_bytes.and_then(|bytes| per_vertex(bytes, counts)),
        tables: Vec::new(),
        merged_vertices: None,
        capabilities: Some(backend.info.capabilities),
        external: None,
    }
}

/// `bytes` for each vertex, if there are any.
pub(crate) fn per_vertex(bytes: usize, counts: &Counts) -> Option<f64> {
    (counts.vertices > 0).then(|| bytes as f64 / counts.vertices as f64)
}

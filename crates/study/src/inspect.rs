//! Facts of a mesh, and the backends that can hold it.

use sixfold::repair::Diagnosis;
use sixfold::{BuildError, Capabilities, Facts, PolygonMesh};
use sixfold_core::Counts;

use crate::refusal::Candidate;
use crate::report::{BackendReport, Inspection, MeshReport, SCHEMA};
use sixfold_workload::Backend;

/// A mesh to inspect or to measure, with its facts.
#[derive(Clone, Debug)]
pub struct StudyMesh {
    /// Origin of the mesh, such as its file name.
    pub name: String,
    /// Topological facts of the file, including the number of degenerate faces.
    pub facts: Facts,
    /// The mesh without the degenerate faces of the file.
    pub polygons: PolygonMesh,
    /// Differences between `polygons` and the file, as phrases.
    pub changes: Vec<String>,
}

impl StudyMesh {
    /// Creates a mesh to study and computes its facts. The expected time is O(corners).
    pub fn new(name: impl Into<String>, polygons: PolygonMesh) -> Self {
        Self {
            name: name.into(),
            facts: Facts::from_polygons(&polygons),
            polygons,
            changes: Vec::new(),
        }
    }

    /// Returns the name and the facts of the mesh, in the format of reports.
    pub fn report(&self) -> MeshReport {
        MeshReport {
            name: self.name.clone(),
            facts: self.facts.clone(),
            changes: self.changes.clone(),
        }
    }
}

/// Checks which backends can hold the mesh, without building the backends. The expected time is
/// O(corners) per backend.
pub fn inspect(study_mesh: &StudyMesh, backends: &[Backend]) -> Inspection {
    // The facts are known already, and enough for most meshes.
    let facts = &study_mesh.facts;
    inspect_unless(study_mesh, backends, |own| own.is_satisfied_by(facts))
}

/// Checks which backends can hold the mesh as [`inspect`] does, in less time. `diagnosis` must be
/// that of the polygons of `study_mesh`.
pub fn inspect_diagnosed(
    study_mesh: &StudyMesh,
    diagnosis: &Diagnosis,
    backends: &[Backend],
) -> Inspection {
    // A diagnosis has no faults of size. The polygons have no more edges than the file.
    let edges = study_mesh.facts.edges;
    inspect_unless(study_mesh, backends, |own| {
        own.can_name_edges(edges) && diagnosis.refusals(own).next().is_none()
    })
}

/// Checks which backends can hold the mesh, except those whose capabilities are known to suffice.
fn inspect_unless(
    study_mesh: &StudyMesh,
    backends: &[Backend],
    suffices: impl Fn(&Capabilities) -> bool,
) -> Inspection {
    let polygons = &study_mesh.polygons;
    let candidate = Candidate::from_study_mesh(study_mesh);
    let only_triangles = polygons.first_polygon().is_none();
    let mut checked: Vec<(Capabilities, Result<(), BuildError>)> = Vec::new();
    let backends = backends.iter().map(|backend| {
        let own = backend.info.capabilities;
        // Backends with the same capabilities have the same verdict, and a mesh of triangles needs no
        // polygons.
        let needed = Capabilities {
            polygons: own.polygons || only_triangles,
            ..own
        };
        let verdict = if suffices(&own) {
            Ok(())
        } else if let Some((_, known)) = checked.iter().find(|(other, _)| *other == needed) {
            known.clone()
        } else {
            let verdict = needed.check(polygons);
            checked.push((needed, verdict.clone()));
            verdict
        };
        unbuilt(backend, &candidate, verdict)
    });
    Inspection {
        schema: SCHEMA,
        mesh: study_mesh.report(),
        backends: backends.collect(),
    }
}

/// Returns the report of a backend that is not built.
pub(crate) fn unbuilt(
    backend: &Backend,
    candidate: &Candidate<'_>,
    verdict: Result<(), BuildError>,
) -> BackendReport {
    let counts = &candidate.counts;
    let refusal = verdict.err();
    let reason = refusal.map(|refusal| candidate.reason(&refusal, &backend.info.capabilities));
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

pub(crate) fn per_vertex(bytes: usize, counts: &Counts) -> Option<f64> {
    (counts.vertices > 0).then(|| bytes as f64 / counts.vertices as f64)
}

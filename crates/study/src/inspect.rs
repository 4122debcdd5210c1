//! Facts of a mesh, and the backends that can hold it.

use std::io;

use serde::{Deserialize, Serialize};
use sixfold::repair::Diagnosis;
use sixfold::{BuildError, Capabilities};
use sixfold_core::Counts;

use crate::refusal::BuildInput;
use sixfold_measure::StudyMesh;
use sixfold_results::{BackendReport, MeshReport, SCHEMA, write_json};
use sixfold_workload::Backend;

/// The facts of a mesh, and the backends that can hold it.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Inspection {
    /// The version of the JSON schema.
    pub schema: u32,
    /// The name, the facts and the hashes of the mesh.
    pub mesh: MeshReport,
    /// The backends, in the order of [`Backend::structures`](crate::Backend::structures).
    pub backends: Vec<BackendReport>,
}

impl Inspection {
    /// Writes the inspection as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// Checks which backends can hold the mesh, without building the backends. The expected time is
/// O(corners) per backend.
pub fn inspect(study_mesh: &StudyMesh, backends: &[Backend]) -> Inspection {
    // The facts are already known, and are sufficient for most meshes.
    let facts = &study_mesh.facts;
    inspect_unless(study_mesh, backends, |own| own.is_satisfied_by(facts))
}

/// Checks which backends can hold the mesh, with the same result as [`inspect`], in less time.
/// `diagnosis` must be the diagnosis of `study_mesh.polygons`.
pub fn inspect_diagnosed(
    study_mesh: &StudyMesh,
    diagnosis: &Diagnosis,
    backends: &[Backend],
) -> Inspection {
    // A diagnosis does not check the number of edges. The polygons have at most as many edges as
    // the facts.
    let edges = study_mesh.facts.edges;
    inspect_unless(study_mesh, backends, |own| {
        own.can_name_edges(edges) && diagnosis.refusals(own).next().is_none()
    })
}

/// Checks which backends can hold the mesh. Backends whose capabilities satisfy `suffices` can hold
/// the mesh and are not checked further.
fn inspect_unless(
    study_mesh: &StudyMesh,
    backends: &[Backend],
    suffices: impl Fn(&Capabilities) -> bool,
) -> Inspection {
    let polygons = &study_mesh.polygons;
    let input = BuildInput::from_study_mesh(study_mesh);
    let only_triangles = polygons.first_polygon().is_none();
    let mut checked: Vec<(Capabilities, Result<(), BuildError>)> = Vec::new();
    let backends = backends.iter().map(|backend| {
        let own = backend.info.capabilities;
        // Backends with the same capabilities have the same verdict. For a mesh of triangles, the
        // capability `polygons` makes no difference.
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
        unbuilt(backend, &input, verdict)
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
    input: &BuildInput<'_>,
    verdict: Result<(), BuildError>,
) -> BackendReport {
    let counts = &input.counts;
    let refusal = verdict.err();
    let reason = refusal.map(|refusal| input.reason(&refusal, &backend.info.capabilities));
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

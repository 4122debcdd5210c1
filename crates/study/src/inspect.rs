//! Facts of a mesh, and the backends that can hold it.

use std::io;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use sixfold::repair::Diagnosis;
use sixfold::{BuildError, Capabilities, Facts, PolygonMesh};
use sixfold_core::Counts;

use crate::refusal::BuildInput;
use sixfold_results::{BackendReport, MeshReport, SCHEMA, write_json};
use sixfold_workload::Backend;

/// Number of bytes that are hashed at once.
const HASH_BLOCK: usize = 1 << 16;

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

/// A mesh to inspect or to measure, with its facts.
#[derive(Clone, Debug)]
pub struct StudyMesh {
    /// Origin of the mesh, such as its file name.
    pub name: String,
    /// Topological facts of the file. If `polygons` was triangulated, the facts describe the
    /// triangulated mesh, but the number of degenerate faces is that of the file.
    pub facts: Facts,
    /// The mesh to measure, without the degenerate faces of the file.
    pub polygons: PolygonMesh,
    /// Differences between `polygons` and the file, as phrases.
    pub changes: Vec<String>,
    /// The number of degenerate faces of the file that `polygons` does not have.
    pub left_out_faces: usize,
    /// The number of faces of the file that were cut into triangles.
    pub cut_faces: usize,
    /// The SHA-256 of the file, as 64 hexadecimal digits; `None` if the mesh was not read from a
    /// regular file.
    pub file_sha256: Option<String>,
    /// A picture of the mesh for reports: a PNG file in Base64; `None` if no picture was drawn.
    pub picture: Option<String>,
}

impl StudyMesh {
    /// Creates a mesh to study and computes its facts. The expected time is O(corners).
    pub fn new(name: impl Into<String>, polygons: PolygonMesh) -> Self {
        let facts = Facts::from_polygons(&polygons);
        Self::with_facts(name, polygons, facts)
    }

    /// Creates a mesh to study from known facts, without changes.
    pub fn with_facts(name: impl Into<String>, polygons: PolygonMesh, facts: Facts) -> Self {
        Self {
            name: name.into(),
            facts,
            polygons,
            changes: Vec::new(),
            left_out_faces: 0,
            cut_faces: 0,
            file_sha256: None,
            picture: None,
        }
    }

    /// Returns the name, the facts and the hashes of the mesh, in the format of documents. The time
    /// is O(vertices + corners).
    pub fn report(&self) -> MeshReport {
        MeshReport {
            name: self.name.clone(),
            facts: self.facts.clone(),
            changes: self.changes.clone(),
            left_out_faces: self.left_out_faces,
            cut_faces: self.cut_faces,
            sha256: content_hash(&self.polygons),
            file_sha256: self.file_sha256.clone(),
            picture: self.picture.clone(),
        }
    }
}

/// Returns the SHA-256 of the positions and faces, as 64 hexadecimal digits. The hashed numbers
/// have 32 bits, each with the lowest byte first: the number of vertices, three coordinates for
/// each vertex, and for each face the number of corners and the vertices of the corners.
fn content_hash(polygons: &PolygonMesh) -> String {
    let mut hash = Sha256::new();
    let mut block = vec![0; HASH_BLOCK];
    let mut length = 0;
    // This crate is compiled for size, so the loop is written without iterators that would be called.
    let mut push = |number: [u8; 4]| {
        block[length..length + 4].copy_from_slice(&number);
        length += 4;
        if length == HASH_BLOCK {
            hash.update(&block);
            length = 0;
        }
    };
    push((polygons.vertex_count() as u32).to_le_bytes());
    for position in polygons.positions() {
        for coordinate in position.to_array() {
            push(coordinate.to_le_bytes());
        }
    }
    for (_, face) in polygons.faces().iter() {
        push((face.len() as u32).to_le_bytes());
        for &vertex in face {
            push((vertex.index() as u32).to_le_bytes());
        }
    }
    hash.update(&block[..length]);
    hex(&hash.finalize())
}

/// Returns the SHA-256 of all bytes that `reader` returns, as 64 hexadecimal digits.
///
/// # Errors
///
/// Returns the errors of `reader`.
pub fn sha256_of(mut reader: impl io::Read) -> io::Result<String> {
    let mut hash = Sha256::new();
    let mut buffer = vec![0; HASH_BLOCK];
    loop {
        match reader.read(&mut buffer) {
            Ok(0) => return Ok(hex(&hash.finalize())),
            Ok(count) => hash.update(&buffer[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
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

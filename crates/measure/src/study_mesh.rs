//! A mesh to measure, with its facts and hashes, and patches of it.

use std::collections::BTreeSet;
use std::io;

use sha2::{Digest, Sha256};
use sixfold::{Distribution, Facts, Point, PolygonMesh, VertexId};
use sixfold_results::MeshReport;

/// Number of bytes that are hashed at once.
const HASH_BLOCK: usize = 1 << 16;
/// Maximum valence or degree of a mesh that counts as not skewed.
const MAX_NEIGHBOURS: usize = 1000;

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

/// Returns whether an element of a mesh with these facts has very many neighbours.
pub fn is_skewed(facts: &Facts) -> bool {
    let most = |spread: &Option<Distribution>| spread.as_ref().map_or(0, |s| s.max);
    most(&facts.valence).max(most(&facts.face_degree)) > MAX_NEIGHBOURS
}

/// Returns a mesh of about the first `size` faces of `polygons`. Faces that touch other faces only
/// at a vertex are left out, so that every structure that holds `polygons` also holds the patch.
/// O(size · log size) for each of a few passes.
pub fn patch(polygons: &PolygonMesh, size: usize) -> PolygonMesh {
    let faces = polygons.faces().iter().take(size.max(1));
    let mut faces: Vec<&[VertexId]> = faces.map(|(_, corners)| corners).collect();
    loop {
        let mesh = submesh(polygons, &faces);
        let mut taken: BTreeSet<VertexId> = BTreeSet::new();
        let singular: BTreeSet<VertexId> = mesh.vertices_of_several_fans().into_iter().collect();
        if singular.is_empty() {
            return mesh;
        }
        // Keep the first face at each such vertex. Each pass removes faces, so the loop ends.
        let corners = mesh.faces().iter().map(|(_, corners)| corners);
        let is_kept: Vec<bool> = corners
            .map(|corners| {
                let at = corners.iter().filter(|v| singular.contains(v));
                let at: Vec<VertexId> = at.copied().collect();
                let free = at.iter().all(|v| !taken.contains(v));
                taken.extend(at);
                free
            })
            .collect();
        let mut is_kept = is_kept.into_iter();
        faces.retain(|_| is_kept.next().unwrap_or(false));
    }
}

/// Builds the mesh of some faces of `polygons`.
fn submesh(polygons: &PolygonMesh, faces: &[&[VertexId]]) -> PolygonMesh {
    let mut used: Vec<VertexId> = faces.iter().copied().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |v: &VertexId| used.partition_point(|u| u < v) as u32;
    let renumbered = faces.iter().map(|face| face.iter().map(number).collect());
    let renumbered: Vec<Vec<u32>> = renumbered.collect();
    let positions: Vec<Point> = used.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(positions, renumbered).expect("faces of a mesh, with their own vertices")
}

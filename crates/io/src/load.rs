//! Reads a file into a structure, and writes a structure to a file.

use std::path::Path;

use sixfold_core::{BuildError, FaceList, MeshQuery, Point, PolygonMesh, Representation, VertexId};

use crate::error::ReadError;
use crate::file_mesh::LeftOut;
use crate::place::Location;
use crate::read::read;
use crate::write::{Loss, WriteError, write};

/// The reason why [`load`] returns no mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The file has faces that are no polygons.
    #[error(
        "{file}: {first} (number of such faces: {count}): `read` and `FileMesh::into_polygons` leave \
         such faces out"
    )]
    LeftOut {
        /// The name of the file.
        file: String,
        /// The first of the faces.
        first: LeftOut,
        /// The number of the faces.
        count: usize,
    },
    /// The structure cannot hold the mesh.
    #[error("{at}: {cause}")]
    Build {
        /// The name of the file, and the place of the first face that `cause` names.
        at: String,
        /// What the structure does not hold.
        cause: BuildError,
    },
}

/// Reads the mesh file at `path` and builds a structure; O(bytes) expected. The format is recognised by
/// the content, as [`read()`] does.
///
/// The notices of [`read()`] are dropped: what the format has besides positions and faces, such as
/// normals and colours, is ignored. Use [`read()`] to see the notices, to set options, or to keep a mesh
/// whose file has faces that are no polygons.
///
/// # Errors
///
/// Returns [`LoadError`] if the file cannot be read, if a face has fewer than three corners or names a
/// vertex twice, or if the structure cannot hold the mesh.
///
/// # Examples
///
/// ```
/// use sixfold_core::MeshQuery;
/// use sixfold_half_edge::HalfEdgeMesh;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("cube.ply");
/// sixfold_io::write(&path, &sixfold_shapes::cube())?;
///
/// let mesh = sixfold_io::load::<HalfEdgeMesh>(&path)?;
/// assert_eq!(mesh.edge_count(), 12);
/// let losses = sixfold_io::save(folder.path().join("cube.obj"), &mesh)?;
/// assert!(losses.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load<M: Representation>(path: impl AsRef<Path>) -> Result<M, LoadError> {
    let path = path.as_ref();
    let (polygons, mut left_out, places) = read(path)?.into_polygons_with_places();
    let file = path.display().to_string();
    if !left_out.is_empty() {
        let count = left_out.len();
        let first = left_out.swap_remove(0);
        return Err(LoadError::LeftOut { file, first, count });
    }
    M::from_polygons(&polygons).map_err(|cause| {
        let face = cause.first_face();
        let at = match face.map(|face| places.place(face, &polygons)) {
            Some(place) => Location::new(&file, place).to_string(),
            None => file,
        };
        LoadError::Build { at, cause }
    })
}

/// Writes `mesh` to the file `path`, in the format of the ending of `path`; O(corners). Returns what the
/// format cannot keep, as [`write()`] does. Vertices and faces are numbered in the order of
/// [`vertices`](sixfold_core::MeshQuery::vertices) and [`faces`](sixfold_core::MeshQuery::faces).
///
/// # Errors
///
/// Fails like [`write()`].
pub fn save<M: MeshQuery>(path: impl AsRef<Path>, mesh: &M) -> Result<Vec<Loss>, WriteError> {
    let numbers = mesh.vertex_numbers();
    let positions: Vec<Point> = mesh.vertices().map(|v| mesh.position(v)).collect();
    let mut faces = FaceList::default();
    for f in mesh.faces() {
        let corners = mesh.face_vertices(f).map(|v| VertexId::new(numbers[v]));
        faces.push(corners)?;
    }
    write(path, &PolygonMesh::from_faces(positions, faces)?)
}

#[cfg(test)]
mod tests {
    use sixfold_half_edge::HalfEdgeMesh;

    use super::*;

    fn loaded(name: &str, text: &str) -> Result<HalfEdgeMesh, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a file");
        let folder = format!("{}/", folder.path().display());
        load(&path).map_err(|error| error.to_string().replace(&folder, ""))
    }

    #[test]
    fn a_mesh_is_loaded_or_the_error_names_the_place() {
        let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n";
        let mesh = loaded("one.obj", &format!("{corners}f 1 2 3\nf 2 4 3\n")).expect("a mesh");
        assert_eq!((mesh.face_count(), mesh.edge_count()), (2, 5));
        let twice = loaded(
            "twice.obj",
            &format!("{corners}f 1 2 3\nf 1 2 1 3\nf 1 2\nf 4 2 1\n"),
        );
        assert_eq!(
            twice.unwrap_err(),
            "twice.obj: line 6: face 1 2 1 3 names vertex 1 twice (number of such faces: 2): `read` and \
             `FileMesh::into_polygons` leave such faces out"
        );
        let turned = loaded("turned.obj", &format!("{corners}f 1 2 3\nf 1 2 4\n"));
        let message = turned.unwrap_err();
        assert!(
            message.starts_with("turned.obj:5: faces f0 and f1 both run"),
            "{message}"
        );
        let missing = loaded("missing.obj", "v 0 0 0\nf 1 2 3\n").unwrap_err();
        assert!(missing.starts_with("missing.obj:2: "), "{missing}");
    }
}

//! Real meshes: verdicts and building agree on all of them, and the small ones are answered alike.
//!
//! The folder is named by the variable `SIXFOLD_MESHES`; without it these tests pass at once.

use std::path::PathBuf;
use std::{env, fs};

use sixfold::{PolygonMesh, Representation, for_each_representation, mesh_io};

use crate::equivalence::agree;

/// Each OBJ file of the folder without its degenerate faces, by name.
fn meshes() -> Vec<(String, PolygonMesh)> {
    let Some(folder) = env::var_os("SIXFOLD_MESHES").map(PathBuf::from) else {
        return Vec::new();
    };
    let mut files = Vec::new();
    for sub in ["tiny", "fetched", "derived"] {
        for entry in fs::read_dir(folder.join(sub)).expect("a folder of meshes") {
            files.push(entry.expect("readable").path());
        }
    }
    files.retain(|file| file.extension().is_some_and(|extension| extension == "obj"));
    files.sort();
    assert!(files.len() > 50, "only {} meshes", files.len());
    let read = files.into_iter().map(|file| {
        let mesh = mesh_io::read_obj(&file).unwrap_or_else(|error| panic!("{error}"));
        (file.display().to_string(), mesh.into_polygons().0)
    });
    read.collect()
}

#[test]
fn verdicts_are_what_building_does() {
    for (name, polygons) in meshes() {
        for_each_representation!(M => {
            let built = M::from_polygons(&polygons);
            let verdict = M::CAPABILITIES.check(&polygons);
            assert_eq!(built.as_ref().err(), verdict.as_ref().err(), "{} on {name}", M::NAME);
            if let Ok(mesh) = built {
                assert_eq!(mesh.validate(), Ok(()), "{} on {name}", M::NAME);
            }
        });
    }
}

/// Small, because scans of all faces for every element grow with the square of the mesh.
#[test]
fn small_meshes_are_answered_alike() {
    for (_, polygons) in meshes() {
        if polygons.face_count() <= 200 {
            agree(&polygons);
        }
    }
}

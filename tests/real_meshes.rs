//! Checks on real meshes that `check` and building agree. Also checks that all structures give the
//! same answers on small meshes.
//!
//! The environment variable `SIXFOLD_MESHES` contains the path of the folder. If the variable is
//! not set, these tests do nothing.

use std::path::PathBuf;
use std::{env, fs};

use sixfold::{MeshQuery, PolygonMesh, Representation, for_each_representation, io};

use crate::equivalence::compare_structures;

/// Reads each OBJ file of the folder without its degenerate faces. Returns names and meshes.
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
        let mesh = io::read(&file).unwrap_or_else(|error| panic!("{error}"));
        (file.display().to_string(), mesh.into_polygons().0)
    });
    read.collect()
}

#[test]
fn building_fails_with_the_error_of_the_check() {
    for (name, polygons) in meshes() {
        for_each_representation!(M => {
            let built = M::from_polygons(&polygons);
            let check = M::CAPABILITIES.check(&polygons);
            assert_eq!(built.as_ref().err(), check.as_ref().err(), "{} on {name}", M::NAME);
            if let Ok(mesh) = built {
                assert_eq!(mesh.validate(), Ok(()), "{} on {name}", M::NAME);
            }
        });
    }
}

/// Scanning all faces for every element takes quadratic time.
#[test]
fn all_give_the_same_answers_on_small_meshes() {
    for (_, polygons) in meshes() {
        if polygons.face_count() <= 200 {
            compare_structures(&polygons);
        }
    }
}

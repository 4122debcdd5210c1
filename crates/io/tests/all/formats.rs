//! The rules of STL, PLY, OFF and glTF, one test for each, and their errors with their messages.

mod off;
mod ply;
mod stl;

use sixfold_io::{FileMesh, Place, ReadOptions, read_from};

pub(super) fn read(bytes: impl AsRef<[u8]>) -> FileMesh {
    read_as("a", bytes)
}

pub(super) fn read_as(name: &str, bytes: impl AsRef<[u8]>) -> FileMesh {
    let bytes = bytes.as_ref();
    read_from(name, bytes, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
pub(super) fn assert_refused(name: &str, bytes: impl AsRef<[u8]>, message: &str) {
    let error = read_from(name, bytes.as_ref(), &ReadOptions::default()).expect_err(message);
    assert_eq!(error.to_string(), message);
}

pub(super) fn faces(mesh: &FileMesh) -> Vec<Vec<usize>> {
    let faces = mesh.faces.iter();
    faces
        .map(|(_, face)| face.iter().map(|v| v.index()).collect())
        .collect()
}

pub(super) fn notices(mesh: &FileMesh) -> Vec<String> {
    mesh.notices.iter().map(ToString::to_string).collect()
}

pub(super) fn places(mesh: &FileMesh) -> Vec<Place> {
    mesh.faces.iter().map(|(f, _)| mesh.face_place(f)).collect()
}

#[test]
fn unknown_content_is_refused() {
    let message = "the format is not recognised: use a file in STL, PLY, OFF, glTF or OBJ, whose \
                   name ends in its format";
    for text in ["", "hello", "\x7FELF\x02\x01\x01\0\0\0\0\0"] {
        assert_refused("-", text, &format!("-: {message}"));
    }
}

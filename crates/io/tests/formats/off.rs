//! The rules of OFF.

use sixfold_core::Point;

use crate::{assert_refused, faces, notices, read, read_as};

#[test]
fn off_has_comments_colours_and_prefixes() {
    let text = "\u{feff}# a\n\nSTCN4OFF # b\n\n3 # c\n";
    assert_refused(
        "a",
        text,
        "a:5: expected OFF, or the numbers of vertices, faces and edges, found \"3\": correct the line",
    );
    let text = "COFF 3 2\r\n0 0 0 255 0 0 255 # a\r\n\r\n1 0 0 0.5\r\n# b\r\n0 1 0\r\n3 0 1 2 1 0 0\r\n\
                2 0 1\r\n";
    let mesh = read(text);
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    assert_eq!(mesh.short_faces.len(), 1);
    assert_eq!(notices(&mesh), ["ignored 3 colours (first at line 2)"]);
    let mesh = read("STN4OFF\n1 0 0\n2 4 6 2 0 0 1 0.5 0.5\n");
    assert_eq!(mesh.positions, [Point::new(1.0, 2.0, 3.0)]);
    assert_eq!(
        notices(&mesh),
        [
            "ignored 1 normal (line 3)",
            "ignored 1 texture coordinate (line 3)"
        ]
    );
    let mesh = read_as("a.off", "1 0 0\n1 2 3\n");
    assert_eq!(mesh.positions.len(), 1, "the keyword may be missing");
}

#[test]
fn faults_of_off_are_named_with_their_lines() {
    let binary = "a.off:1: the file is binary OFF, which is not read: save it as text, or as PLY";
    assert_refused("a.off", "OFF BINARY\n", binary);
    let dimensions = "a.off:1: points of n dimensions, which is not read: write three coordinates";
    assert_refused("a.off", "nOFF 4\n", dimensions);
    let refused = |text: &str, message: &str| {
        assert_refused(
            "a.off",
            format!("OFF 2 1 0\n{text}"),
            &format!("a.off:{message}"),
        );
    };
    let end = "copy the file again, or correct its counts";
    refused("", &format!("1: the file ends before vertex 1 of 2: {end}"));
    refused(
        "0 0 0\n0 1",
        "3: vertex 1 has 2 of three coordinates: add the missing ones",
    );
    refused(
        "0 0 x",
        "2: coordinate \"x\" of vertex 0 is not a number: write it like 0.5 or -2e-3",
    );
    let two = "0 0 0\n1 1 1\n";
    refused(two, &format!("3: the file ends before face 1 of 1: {end}"));
    refused(
        &format!("{two}a"),
        "4: \"a\" is not a number of corners: write a whole number",
    );
    refused(
        &format!("{two}3 0 1"),
        "4: expected 3 vertices of a face, found \"2 of them\": correct the line",
    );
    refused(
        &format!("{two}3 0 1 1.5"),
        "4: \"1.5\" is not a vertex number: write a whole number",
    );
    refused(
        &format!("{two}3 0 1 2"),
        "4: face names vertex 2, but there are 2 vertices: correct the index",
    );
    let mesh = read(format!("OFF 2 0 0\n{two}\n 3 0 1 2\n"));
    assert_eq!(
        notices(&mesh),
        ["ignored 4 bytes after the mesh (first at line 3)"]
    );
}

//! The rules of OFF.

use sixfold_core::Point;

use super::{assert_refused, faces, notices, read, read_as};

#[test]
fn off_has_comments_colours_and_prefixes() {
    let text = "\u{feff}# a\n\nSTCN4OFF # b\n\n3 # c\n";
    let end = "copy the file again, or export it again";
    assert_refused(
        "a",
        text,
        &format!("a:5: the file ends before the number of faces: {end}"),
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
    let dimensions =
        "a.off:1: points have 4 coordinates, which is not read: write three coordinates";
    assert_refused("a.off", "nOFF 4\n", dimensions);
    assert_refused(
        "a.off",
        "4nOFF # a\n\n4\n",
        &dimensions.replace(":1:", ":3:"),
    );
    let counts = "a.off:1: expected OFF, or the numbers of vertices, faces and edges, found ";
    for text in ["3 1 0 0", "3 -1 0", "CCOFF 3 1 0"] {
        assert_refused(
            "a.off",
            text,
            &format!("{counts}{text:?}: correct the line"),
        );
    }
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
        "3: vertex 1 has 2 of 3 coordinates: add the missing ones",
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
    for (rest, notice) in [
        ("\n 3 0 1 2\n", "ignored 1 line after the mesh (line 5)"),
        (
            "# end\r\n \r\nmore # text\rand # more",
            "ignored 2 lines after the mesh (first at line 6)",
        ),
        ("\n# 3 0 1\n \t", ""),
    ] {
        let mesh = read(format!("OFF 2 0 0\n{two}{rest}"));
        assert_eq!(notices(&mesh).concat(), notice, "{rest:?}");
    }
}

#[test]
fn prefixes_of_off_have_any_order_and_case() {
    let vertex = "2 4 6 2 0 0 1 1 0 0 1 0.5 0.5";
    for prefixes in ["STCN4", "NCST4", "CSTN4", "4NCST", "4CNST", "stCN4"] {
        for off in ["OFF", "off"] {
            let mesh = read(format!("{prefixes}{off} 1 0 0\n{vertex}\n"));
            assert_eq!(
                mesh.positions,
                [Point::new(1.0, 2.0, 3.0)],
                "{prefixes}{off}"
            );
            let expected = [
                "ignored 1 normal (line 2)",
                "ignored 1 colour (line 2)",
                "ignored 1 texture coordinate (line 2)",
            ];
            assert_eq!(notices(&mesh), expected, "{prefixes}{off}");
        }
    }
    for keyword in ["NCOFF", "CNOFF"] {
        let mesh = read(format!("{keyword}\n1 0 0\n1 2 3 0 0 1 255 0 0\n"));
        assert_eq!(mesh.positions, [Point::new(1.0, 2.0, 3.0)], "{keyword}");
    }
    let mesh = read("nOFF\n3\n1 0 0\n1 2 3\n");
    assert_eq!(mesh.positions, [Point::new(1.0, 2.0, 3.0)]);
}

#[test]
fn counts_of_off_may_have_lines_of_their_own() {
    let body = "0 0 0\n1 0 0 # a\n\n# b\n0 1 0\n\n3 0 1 2\n";
    for counts in [
        "OFF\n3\n1\n0\n",
        "OFF # a\n\n3 # b\n\n1 # c\n# d\n0\n",
        "OFF 3\n1 3\n",
        "off 3 1\n3\n",
        "OFF\n3 1\n",
        "OFF 3\n1\n",
        "3\n1\n3\n",
    ] {
        let mesh = read_as("a.off", format!("{counts}{body}"));
        assert_eq!(mesh.positions.len(), 3, "{counts:?}");
        assert_eq!(faces(&mesh), [[0, 1, 2]], "{counts:?}");
        assert!(mesh.notices.is_empty(), "{counts:?}");
    }
}

#[test]
fn counts_of_off_may_follow_the_keyword_without_a_blank() {
    let body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for start in [
        "OFF3 1 0",
        "off3 1 3",
        "OFF3\n1 3",
        "COFF3 1",
        "# a\nOFF3 1 0 # b",
    ] {
        let mesh = read(format!("{start}\n{body}"));
        assert_eq!(mesh.positions.len(), 3, "{start}");
        assert_eq!(faces(&mesh), [[0, 1, 2]], "{start}");
    }
    let mesh = read("4OFF1 0 0\n2 4 6 2\n");
    assert_eq!(mesh.positions, [Point::new(1.0, 2.0, 3.0)]);
    let mesh = read("nOFF3 1 0 0\n2 4 6\n");
    assert_eq!(mesh.positions, [Point::new(2.0, 4.0, 6.0)]);
    for text in ["OFFx 1 0 0", "OFF-3 1 0", "OFF3.5 1 0"] {
        let message = "a.off:1: expected OFF, or the numbers of vertices, faces and edges, found ";
        assert_refused(
            "a.off",
            text,
            &format!("{message}{text:?}: correct the line"),
        );
    }
}

#[test]
fn faces_of_off_may_continue_on_further_lines() {
    let vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    let file = |faces: &str| format!("OFF\n4 2 0\n{vertices}{faces}");
    for lines in [
        "4 0 1 2\n3\n3 0 1 2\n",
        "4\n0 1 2 3\n3\n0\n1\n2\n",
        "4 0 1 # a\n\n# b\n 2 3 # c\n3 0 1 2",
        "4 0\r\n1 2\r\n3\r\n3 0 1\r\n2\r\n",
    ] {
        let mesh = read(file(lines));
        assert_eq!(faces(&mesh), [&[0, 1, 2, 3][..], &[0, 1, 2]], "{lines:?}");
        assert!(mesh.notices.is_empty(), "{lines:?}");
    }
    let mesh = read(file("3 0 1 2 255 0 0\n3 0\n1 2\n"));
    assert_eq!(notices(&mesh), ["ignored 1 colour (line 7)"]);
    let refused = |lines: &str, message: &str| {
        assert_refused("a.off", file(lines), &format!("a.off:{message}"));
    };
    // The next line is the next face.
    refused(
        "4 0 1 2\n3 0 1 2\n",
        "7: expected 4 vertices of a face, found \"3 of them\": correct the line",
    );
    refused(
        "3 0 1 2\n18446744073709551615 0\n1\n2\n",
        "8: expected 18446744073709551615 vertices of a face, found \"3 of them\": correct the line",
    );
    refused(
        "4 0 1\n2 x\n",
        "8: \"x\" is not a vertex number: write a whole number",
    );
}

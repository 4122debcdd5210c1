//! Tests for each rule of reading, and for each error message.

use std::fs;
use std::io::{self, BufReader, Read};

use sixfold_core::{FaceId, Point, VertexId};
use sixfold_io::{FileMesh, LeftOutReason, Place, ReadError, parse_obj};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn read(text: impl AsRef<[u8]>) -> FileMesh {
    let text = text.as_ref();
    parse_obj("a.obj", text).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn assert_refused(text: impl AsRef<[u8]>, message: &str) {
    let error = parse_obj("bad.obj", text.as_ref()).expect_err(message);
    assert_eq!(error.to_string(), message);
}

/// Returns the faces with the vertex numbers of the file.
fn faces(obj: &FileMesh) -> Vec<Vec<usize>> {
    let faces = obj.faces.iter();
    faces
        .map(|(_, face)| face.iter().map(|v| v.index() + 1).collect())
        .collect()
}

#[test]
fn numbers_load_in_every_form() {
    let obj = read("v 1. .0 +0.0\nv 1E+00 -0 -2e-3\nv 1e-46 16777217 3.4028235e38\n");
    let bits = |p: &Point| p.to_array().map(f32::to_bits);
    let expected = [
        [1.0, 0.0, 0.0],
        [1.0, -0.0, -0.002],
        [0.0, 16_777_216.0, f32::MAX],
    ];
    let positions: Vec<[u32; 3]> = obj.positions.iter().map(bits).collect();
    assert_eq!(positions, expected.map(|p| p.map(f32::to_bits)));
}

#[test]
fn the_numbering_of_the_file_is_kept() {
    // Vertices 2 and 5 are not used. An object statement separates the vertices.
    let obj = read("v 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\no b\nf 4 3 1\nv 5 0 0\n");
    let x: Vec<f32> = obj.positions.iter().map(|p| p.x).collect();
    assert_eq!(x, [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(faces(&obj), [[4, 3, 1]]);
    assert_eq!(obj.facts().isolated_vertices, 2);
}

#[test]
fn objects_groups_and_materials_share_their_vertices() {
    let obj = read(format!(
        "{TRIANGLE}v 1 1 0\no a\nusemtl x\nf 1 2 3\no b\nusemtl y\ng c\nf 3 2 4\n"
    ));
    assert_eq!(faces(&obj), [[1, 2, 3], [3, 2, 4]]);
    assert_eq!(obj.facts().edges, 5);
}

#[test]
fn corners_count_from_either_end_and_may_have_texture_and_normal_numbers() {
    let obj = read(format!(
        "f 3 2 1\n{TRIANGLE}f 1/7/9 2//9 3/7\nf -3/-1 -2 -1//\nv 9 9 9\nf -1 +1 -3"
    ));
    assert_eq!(faces(&obj), [[3, 2, 1], [1, 2, 3], [1, 2, 3], [4, 1, 2]]);
    let lines = obj.faces.iter().map(|(f, _)| obj.face_place(f));
    assert!(lines.eq([1, 5, 6, 8].map(Place::Line)));
}

#[test]
fn weights_and_colours_are_ignored_with_a_notice() {
    let obj = read("v 1 2 3 0\nv 1 2 3 2\nv 1 2 3 1 0 0\nv 1 2 3 x\n");
    assert_eq!(obj.positions, [Point::new(1.0, 2.0, 3.0); 4]);
    let notices: Vec<String> = obj.notices.iter().map(ToString::to_string).collect();
    let expected = "ignored 4 vertex weights or colours (first at line 1)";
    assert_eq!(notices, [expected]);
}

#[test]
fn every_kind_of_ignored_statement_has_its_notice() {
    let text = "v 0 0 0\nvt 0 0\nvn\nvn 0 0 1\no\ng a b\nusemtl m\nmtllib m\ns off\nl 1 1\np 1\n\
                curv 0 1 1 1\nbevel on\nV 1 2 3\ncall b.obj\n#g\n\ng\\\nv 1 1 1\n";
    let obj = read(text);
    assert_eq!(obj.positions.len(), 1, "a continued group is one statement");
    let notices: Vec<String> = obj.notices.iter().map(ToString::to_string).collect();
    assert_eq!(
        notices,
        [
            "ignored 1 texture coordinate (line 2)",
            "ignored 2 normals (first at line 3)",
            "ignored 1 object name (line 5)",
            "ignored 2 groups (first at line 6)",
            "ignored 2 material statements (first at line 7)",
            "ignored 1 smoothing group (line 9)",
            "ignored 1 line (line 10)",
            "ignored 1 point statement (line 11)",
            "ignored 1 free-form statement (line 12)",
            "ignored 1 display attribute (line 13)",
            "ignored 2 unknown statements (first at line 14)",
        ]
    );
}

#[test]
fn ignored_statements_may_be_in_any_encoding() {
    let mut text = b"o W\xFCrfel \xFF\xFE\n# Stra\xDFe\n\xE9\xE9 1\n".to_vec();
    text.extend_from_slice(TRIANGLE.as_bytes());
    text.extend_from_slice(b"f 1 2 3 # \xFC");
    assert_eq!(faces(&read(text)), [[1, 2, 3]]);
}

#[test]
fn degenerate_and_short_faces_are_left_out_with_their_lines() {
    let obj = read(format!(
        "{TRIANGLE}f 1 2 2\nf 1 2 3\nf -1 1\nf\nf 1 2 3 1 2 3 1 2 3\nf 3\n"
    ));
    assert_eq!(obj.faces.len(), 3);
    let facts = obj.facts();
    assert_eq!((facts.faces, facts.degenerate_faces), (1, 5));
    let euler = facts.vertices as i64 - facts.edges as i64 + facts.faces as i64;
    assert_eq!(
        facts.euler_characteristic, euler,
        "the facts are those of one mesh"
    );
    let (polygons, left_out) = obj.into_polygons();
    assert_eq!(polygons.face_count(), 1);
    let face = polygons.faces().face(FaceId::new(0));
    assert_eq!(face, [0, 1, 2].map(VertexId::new));
    let messages: Vec<String> = left_out.iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "line 4: face 1 2 2 names vertex 2 twice",
            "line 6: face 3 1 has fewer than three corners",
            "line 7: face has fewer than three corners",
            "line 8: face 1 2 3 1 2 3 1 2 … names vertex 1 twice",
            "line 9: face 3 has fewer than three corners",
        ]
    );
    assert_eq!(left_out[3].vertices, [1, 2, 3, 1, 2, 3, 1, 2, 3]);
    assert_eq!(left_out[3].reason, LeftOutReason::RepeatedVertex(1));
}

#[test]
fn points_alone_have_facts() {
    let obj = read("v 0 0 0\nv 1 1 1\n");
    let facts = obj.facts();
    assert_eq!((facts.vertices, facts.isolated_vertices), (2, 2));
    assert_eq!((facts.faces, facts.consistently_oriented), (0, None));
    assert_eq!(obj.into_polygons().0.vertex_count(), 2);
}

#[test]
fn small_meshes_of_every_degree_load() {
    // If there are fewer than four vertices, the final polygon is a point, a line or a triangle.
    for vertices in 1..6 {
        let text = "v 0 0 0\n".repeat(vertices);
        for degree in 3..6 {
            let corners = " 1".repeat(degree - 1) + &format!(" {vertices}");
            let obj = read(format!("{text}f{corners}\nf{corners}\n"));
            assert_eq!(obj.positions.len(), vertices);
            assert_eq!(obj.faces.len(), 2);
            assert_eq!(obj.faces.uniform_degree(), Some(degree));
            assert_eq!(obj.faces.corners()[degree - 1].index(), vertices - 1);
        }
    }
}

#[test]
fn a_huge_polygon_is_one_face() {
    let n = 100_000;
    let mut text = "v 0 0 0\n".repeat(n) + "f";
    for number in 1..=n {
        text += &format!(" \\\n{number}");
    }
    let (polygons, left_out) = read(text).into_polygons();
    assert_eq!((polygons.corner_count(), left_out.len()), (n, 0));
}

#[test]
fn invalid_vertex_numbers_are_refused() {
    let refused = |faces: &str, message: &str| {
        assert_refused(format!("{TRIANGLE}{faces}"), &format!("bad.obj:{message}"));
    };
    let bad = |text: &str| {
        format!(
            "4: face corner {text:?} is not a vertex number: use whole numbers that count from 1, \
             or backwards from -1"
        )
    };
    refused(
        "f 1 2 99",
        "4: face names vertex 99, but there are 3 vertices: correct the index",
    );
    refused(
        "f 1 4",
        "4: face names vertex 4, but there are 3 vertices: correct the index",
    );
    refused(
        "f 4 2 3\nf 9 2 5\nv 0 0 0",
        "5: face names vertex 9, but there are 4 vertices: correct the index",
    );
    refused(
        "f 1 2 -4",
        "4: face names vertex -4, but before this line there are 3 vertices: correct the index",
    );
    refused(
        "f 0 1 2",
        "4: face names vertex 0, but OBJ counts from 1: add 1 to the indices of the file",
    );
    for text in ["x", "1.5", "/1", "-", "4294967296", "999999999999999999999"] {
        refused(&format!("f 1 2 {text}"), &bad(text));
    }
    refused("f 1 2 3\0", &bad("3\0"));
    refused(
        &format!("f {}", "9".repeat(1_000_000)),
        &bad(&("9".repeat(40) + "…")),
    );
    refused(
        "\n \\\nf 1 \\\n2 7",
        "5: face names vertex 7, but there are 3 vertices: correct the index",
    );
    assert_refused(
        "f -1 1 1\nv 0 0 0",
        "bad.obj:1: face names vertex -1, but before this line there is no vertex: correct the \
         index",
    );
    assert_refused(
        "v 0 0 0\nf 1 1 -9223372036854775808",
        "bad.obj:2: face names vertex -9223372036854775808, but before this line there is 1 \
         vertex: correct the index",
    );
}

#[test]
fn invalid_coordinates_are_refused() {
    for text in ["x", "1,5", "0x10", "1_0", "--1", ".", "1e", "0\0"] {
        assert_refused(
            format!("v 0 0 0\nv 0 {text} nan"),
            &format!(
                "bad.obj:2: coordinate {text:?} of vertex 2 is not a number: write it like 0.5 or \
                 -2e-3"
            ),
        );
    }
    for (text, found) in [("v", 0), ("v 1", 1), ("v 1 2 # 3", 2)] {
        assert_refused(
            format!("\r\n\r\n{text}\r\nv x"),
            &format!("bad.obj:3: vertex 1 has {found} of 3 coordinates: add the missing ones"),
        );
    }
    let large = "is not finite: keep coordinates below 3.4e38";
    let nan = "is not a number (NaN): correct it, or export the file again";
    let values = [
        "-inf",
        "infinity",
        "1e39",
        "-1e400",
        "3.4028236e38",
        "nan",
        "-NaN",
    ];
    for (i, text) in values.into_iter().enumerate() {
        let mut words = ["0"; 3];
        words[i % 3] = text;
        let [x, y, z] = words;
        let name = ['x', 'y', 'z'][i % 3];
        assert_refused(
            format!("f 2 2 2\nv 0 0 0\n\nv {x} {y} {z}\nv 0 0 inf\n"),
            &format!(
                "bad.obj:4: coordinate {name} of vertex 2 {}",
                if i < 5 { large } else { nan }
            ),
        );
    }
}

#[test]
fn statements_that_are_not_utf_8_are_refused() {
    let message = "bad.obj:2: the statement is not UTF-8 text: save the file as UTF-8, or correct \
                   the line";
    assert_refused(b"o a\nv 0 0 \xFF\n", message);
    assert_refused(b"v 0 0 0\nf 1 1 \xE9\n", message);
    let message = "bad.obj:1: the text is UTF-16: save it as UTF-8";
    assert_refused(b"\xFF\xFEv\0 \x000\0", message);
    assert_refused(b"\xFE\xFF\0v\0 \x000", message);
}

#[test]
fn a_file_without_vertices_and_faces_is_refused() {
    let message = "bad.obj: no vertex and no face: check that it is an OBJ file";
    let backslashes = "\\\n".repeat(100_000);
    let text: [&[u8]; 6] = [
        b"",
        b"\xEF\xBB\xBF",
        b"# v 0 0 0\n\no a\nvn 0 0 1",
        b"\0\0\0\0",
        b"solid\x89PNG\r\n",
        backslashes.as_bytes(),
    ];
    for text in text {
        assert_refused(text, message);
    }
}

#[test]
fn white_space_outside_ascii_separates_words_as_in_the_parser() {
    let obj = read("v 1\u{a0}2 3\u{2003}4\nv 0 0 0\x0b\x0c\n");
    assert_eq!(obj.positions, [Point::new(1.0, 2.0, 3.0), Point::ZERO]);
    assert_eq!(obj.notices[0].count, 1);
}

#[test]
fn errors_name_a_path_that_cannot_be_read() {
    let directory = std::env::temp_dir();
    let error = sixfold_io::read(&directory).expect_err("a directory");
    let shown = directory.display();
    assert_eq!(
        error.to_string(),
        format!("{shown}: is a directory: choose a file in it")
    );
    let error = sixfold_io::read("no/such/mesh.obj").expect_err("no such file");
    let message = error.to_string();
    assert!(
        message.starts_with("no/such/mesh.obj: cannot be opened ("),
        "{message}"
    );
    assert!(message.ends_with("): check the path"), "{message}");
    assert!(matches!(error, ReadError::Open { .. }));
}

#[test]
fn errors_name_a_file_by_its_path() {
    let folder = tempfile::tempdir().expect("the temporary folder is writable");
    let good = folder.path().join("good.obj");
    fs::write(&good, format!("{TRIANGLE}f 1 2 3")).expect("writable");
    assert_eq!(faces(&sixfold_io::read(&good).expect("valid")), [[1, 2, 3]]);
    let bad = folder.path().join("bad.obj");
    fs::write(&bad, "v 0 0\n").expect("writable");
    let message = sixfold_io::read(&bad).expect_err("short").to_string();
    let place = format!("{}:1: vertex 1 has 2 ", bad.display());
    assert!(message.starts_with(&place), "{message}");
}

#[test]
fn an_error_of_the_source_is_reported_with_its_line() {
    struct Failing;
    impl Read for Failing {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("unplugged"))
        }
    }
    let source = BufReader::new(TRIANGLE.as_bytes().chain(Failing));
    let error = parse_obj("disk.obj", source).expect_err("unplugged");
    let message = "disk.obj:4: cannot be read further (unplugged): copy the file again";
    assert_eq!(error.to_string(), message);
    let error = parse_obj("disk.obj", BufReader::new(Failing)).expect_err("unplugged");
    assert!(error.to_string().starts_with("disk.obj:1: "), "{error}");
}

/// A line that has lost its end is named, and not read as values that have no meaning.
#[test]
fn several_vertices_on_one_line_are_refused() {
    let text = "v 1 0 0\nv 0 0 0 v 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let error = sixfold_io::parse_obj("a.obj", text.as_bytes()).expect_err("two statements");
    let message = "a.obj:2: expected a vertex alone on its line, found \"v\"";
    assert!(error.to_string().starts_with(message), "{error}");
    let text = "v 1 0 0 1 0.5 0.5 0.5\nv 0 0 0 # first v\nv 0 1 0\nf 1 2 3\n";
    let mesh = sixfold_io::parse_obj("a.obj", text.as_bytes());
    assert_eq!(mesh.expect("values and a comment").faces.len(), 1);
}

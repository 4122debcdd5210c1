//! The rules of STL.

use sixfold_core::Point;
use sixfold_io::{Format, Place, ReadError, ReadOptions, Welding, read_from};

use super::{assert_refused, faces, notices, places, read, read_as};

/// Returns a binary STL of facets with these corners.
fn stl(facets: &[[[f32; 3]; 3]], count: u32) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(count.to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const FACET: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const SECOND: [[f32; 3]; 3] = [[1.0, -0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn facets_of_stl_share_equal_corners() {
    let bytes = stl(&[FACET, SECOND], 2);
    let mesh = read(&bytes);
    assert_eq!(mesh.format, Format::Stl);
    assert_eq!(faces(&mesh), [[0, 1, 2], [1, 3, 2]]);
    assert_eq!((mesh.positions.len(), mesh.welded_vertices), (4, 2));
    assert_eq!(places(&mesh), [84, 134].map(Place::Byte));
    let options = ReadOptions::default().with_welding(Welding::Nothing);
    let mesh = read_from("a", bytes.as_slice(), &options).expect("valid");
    assert_eq!((mesh.positions.len(), mesh.welded_vertices), (6, 0));
    let options = ReadOptions::default().recentred();
    let mesh = read_from("a", bytes.as_slice(), &options).expect("valid");
    assert_eq!((mesh.positions.len(), mesh.welded_vertices), (4, 2));
    assert_eq!(mesh.positions[3], Point::new(0.5, 0.5, 0.0));
}

#[test]
fn the_count_of_a_binary_stl_is_checked() {
    let message = "a.stl: byte 134: the file ends before facet 2 of 3: copy the file again, or \
                   correct its counts";
    assert_refused("a.stl", stl(&[FACET], 3), message);
    let huge = stl(&[FACET], u32::MAX);
    let message = "a.stl: byte 134: the file ends before facet 2 of 4294967295: copy the file \
                   again, or correct its counts";
    assert_refused("a.stl", huge, message);
    let mesh = read_as("a.stl", stl(&[FACET, SECOND], 1));
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    let trailing = "bytes after the mesh (first at byte 134)";
    assert!(
        notices(&mesh)[0].ends_with(trailing),
        "{:?}",
        notices(&mesh)
    );
    let message = "a.stl: no vertex and no face: check that it is a binary STL file";
    assert_refused("a.stl", stl(&[], 0), message);
    let message = "a.stl: byte 3: the file ends before the number of facets: copy the file again, \
                   or correct its counts";
    assert_refused("a.stl", "abc\0", &message.replace("byte 3", "byte 4"));
}

#[test]
fn other_texts_with_the_name_of_stl_are_refused() {
    let message = "a.stl: neither ASCII STL, which begins with `solid`, nor binary STL, whose size \
                   follows from its number of facets: export the file again, or rename it if it \
                   has another format";
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    for text in ["abc", "<html>\n", facet, &facet.repeat(1000)] {
        assert_refused("a.stl", text, message);
    }
    let options = ReadOptions::default().with_format(Format::Stl);
    let error = read_from("a.obj", "v 1 2 3\n".as_bytes(), &options).expect_err("not STL");
    assert_eq!(error.to_string(), message.replace("a.stl", "a.obj"));
}

#[test]
fn colour_lines_of_ascii_stl_are_passed_over() {
    let text = "solid a\ncolor 1 0 0\nfacet normal 0 0 1\n color 0.5 0.5 1e0 1\nouter loop\nvertex \
                0 0 0\nvertex 1 0 0\nColor 1 1 1 vertex 0 1 0\nendloop\nendfacet\ncolour 1\n\
                endsolid a\n";
    let mesh = read(text);
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    assert_eq!(notices(&mesh), ["ignored 4 colours (first at line 2)"]);
    let message = "a.stl:1: coordinate \"color\" of vertex 1 is not a number: write it like 0.5 or \
                   -2e-3";
    let text = "solid\rfacet outer loop vertex 0 color".replace('\r', "\n");
    assert_refused("a.stl", text, &message.replace(":1:", ":2:"));
}

/// A source that has no size, as a pipe.
struct Pipe<'a>(&'a [u8]);

impl std::io::Read for Pipe<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.0.read(buffer)
    }
}

#[test]
fn a_binary_stl_on_a_pipe_is_recognised_by_its_count() {
    let facets: Vec<[[f32; 3]; 3]> = (0..1000)
        .map(|i| FACET.map(|[x, y, z]| [x + i as f32, y, z]))
        .collect();
    let with_normals = |normal: f32, count: u32| {
        let mut bytes = stl(&facets, count);
        for facet in bytes[84..].as_chunks_mut::<50>().0 {
            facet[..4].copy_from_slice(&normal.to_le_bytes());
        }
        bytes
    };
    for normal in [0.0, 250.0, f32::NAN] {
        let bytes = with_normals(normal, 1000);
        let mesh = read_from("a", Pipe(&bytes), &ReadOptions::default());
        let mesh = mesh.unwrap_or_else(|error| panic!("{normal}: {error}"));
        assert_eq!((mesh.format, mesh.faces.len()), (Format::Stl, 1000));
    }
    for count in [1, 999, 1001, u32::MAX] {
        let bytes = with_normals(250.0, count);
        let error = read_from("a", Pipe(&bytes), &ReadOptions::default()).expect_err("not STL");
        assert!(
            matches!(error, ReadError::UnknownFormat { .. }),
            "{count}: {error}"
        );
    }
    let noise: Vec<u8> = (0..60_000_u32)
        .map(|i| (i.wrapping_mul(i) >> 7) as u8)
        .collect();
    let error = read_from("a", Pipe(&noise), &ReadOptions::default()).expect_err("not STL");
    assert!(matches!(error, ReadError::UnknownFormat { .. }), "{error}");
}

#[test]
fn coordinates_of_stl_must_be_finite() {
    let mut facet = SECOND;
    facet[1][2] = f32::NAN;
    let message = "a.stl: byte 158: coordinate z of vertex 2 is not finite: keep coordinates \
                   below 3.4e38";
    assert_refused("a.stl", stl(&[FACET, facet], 2), message);
}

#[test]
fn attributes_of_facets_are_reported() {
    let mut bytes = stl(&[FACET, SECOND], 2);
    bytes[182] = 1;
    assert_eq!(
        notices(&read_as("a.stl", bytes)),
        ["ignored 1 colour (byte 182)"]
    );
}

#[test]
fn ascii_stl_has_solids_in_any_layout() {
    let text = "solid Solid one facet\n facet normal 0 0 1\nOUTER LOOP\nvertex 0 0 0 vertex 1 0 0\n\
                vertex 0 1 0 endloop endfacet\nendsolid Solid\n\nsolid\nfacet outer loop vertex 1 0 \
                0\rvertex\t1 1 0\r\nvertex 0 1 0\nendloop\nendfacet\nendsolid";
    let mesh = read(text);
    assert_eq!(mesh.format, Format::StlAscii);
    assert_eq!(faces(&mesh), [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(places(&mesh), [2, 9].map(Place::Line));
    assert_eq!(notices(&mesh), ["ignored 1 object name (line 8)"]);
}

#[test]
fn faults_of_ascii_stl_are_named_with_their_lines() {
    let facet = "solid\nfacet normal 0 0 1\nouter loop\n";
    let refused = |text: &str, message: &str| {
        let text = format!("{facet}{text}");
        assert_refused("a.stl", text, &format!("a.stl:{message}"));
    };
    let end = "the file ends before";
    let rest = "copy the file again, or correct its counts";
    refused("", &format!("3: {end} endfacet: {rest}"));
    refused(
        "vertex 0 0 0\nvertex 0 x 0",
        "5: coordinate \"x\" of vertex 2 is not a number: write it like 0.5 or -2e-3",
    );
    refused(
        "vertex 0 0 1e39",
        "4: coordinate z of vertex 1 is not finite: keep coordinates below 3.4e38",
    );
    refused(
        "vertex 0 0 0\nendloop",
        "5: expected three vertices in a facet, found \"endloop after 1 of them\": correct the line",
    );
    let three = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    refused(
        &format!("{three}vertex 1 1 0"),
        "7: expected endloop after three vertices, found \"vertex\": correct the line",
    );
    refused(
        &format!("{three}endloop endsolid"),
        "7: expected endfacet, found \"endsolid\": correct the line",
    );
    refused(
        &format!("{three}endloop\nendfacet"),
        &format!("8: {end} endsolid: {rest}"),
    );
    let message = "a.stl: no vertex and no face: check that it is an ASCII STL file";
    assert_refused("a.stl", "solid\nendsolid\n", message);
}

//! The rules of STL.

use sixfold_core::Point;
use sixfold_io::{Format, Place, ReadOptions, Welding, read_from};

use crate::{assert_refused, faces, notices, places, read, read_as};

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
    assert_refused("a.stl", "abc", message);
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

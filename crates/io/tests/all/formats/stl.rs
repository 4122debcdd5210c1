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
                   export it again";
    assert_refused("a.stl", stl(&[FACET], 3), message);
    let huge = stl(&[FACET], u32::MAX);
    let message = "a.stl: byte 134: the file ends before facet 2 of 4294967295: copy the file \
                   again, or export it again";
    assert_refused("a.stl", huge, message);
    let message = "a.stl: no vertex and no face: check that it is a binary STL file";
    assert_refused("a.stl", stl(&[], 0), message);
    let message = "a.stl: byte 3: the file ends before the number of facets: copy the file again, \
                   or export it again";
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
    let message = "a.stl: byte 158: coordinate z of vertex 2 is not a number (NaN): correct \
                   it, or export the file again";
    assert_refused("a.stl", stl(&[FACET, facet], 2), message);
    facet[1][2] = f32::INFINITY;
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
    let rest = "copy the file again, or export it again";
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
        &format!("{three}endloop\nend"),
        &format!("8: {end} endfacet: {rest}"),
    );
    refused(
        &format!("{three}endloop\nendfacet\nendsolid\nfacet"),
        "10: expected solid, found \"facet\": correct the line",
    );
    refused(
        &format!("{three}endloop\nendfacet\nend loop"),
        "9: expected facet or endsolid, found \"endloop\": correct the line",
    );
    let message = "a.stl: no vertex and no face: check that it is an ASCII STL file";
    assert_refused("a.stl", "solid\nendsolid\n", message);
}

const TOO_SMALL: &str =
    "ignored 1 number of facets (byte 80): more facets follow than it says, and all are read";

#[test]
fn a_binary_stl_with_a_small_count_is_read_to_its_end() {
    let many: Vec<[[f32; 3]; 3]> = (0..5000)
        .map(|i| FACET.map(|[x, y, z]| [x + i as f32, y, z]))
        .collect();
    for (facets, counts) in [(&[FACET, SECOND][..], &[0, 1][..]), (&many, &[0, 7, 4999])] {
        for &count in counts {
            let bytes = stl(facets, count);
            for name in ["a", "a.stl"] {
                let mesh = read_as(name, &bytes);
                assert_eq!(mesh.faces.len(), facets.len(), "{count} {name}");
                assert_eq!(notices(&mesh), [TOO_SMALL], "{count} {name}");
                let last = mesh.faces.iter().last().expect("faces").0;
                assert_eq!(mesh.face_place(last), Place::Byte(bytes.len() as u64 - 50));
            }
            // What follows the facets is not read as facets.
            for rest in [vec![0; 200], vec![b'0'; 120], vec![0xFF; 60], vec![7; 49]] {
                let mut bytes = bytes.clone();
                bytes.extend(&rest);
                let mesh = read_as("a.stl", &bytes);
                assert_eq!(mesh.faces.len(), facets.len(), "{rest:?}");
                let trailing = format!(
                    "ignored {} bytes after the mesh (first at byte {})",
                    rest.len(),
                    bytes.len() - rest.len()
                );
                assert_eq!(notices(&mesh), [TOO_SMALL, &trailing], "{rest:?}");
            }
        }
    }
}

#[test]
fn zeros_after_a_binary_stl_are_passed_over() {
    for zeros in [1, 2, 50, 4096] {
        let mut bytes = stl(&[FACET, SECOND], 2);
        bytes[..6].copy_from_slice(b"solid ");
        bytes.extend(vec![0; zeros]);
        let mesh = read(&bytes);
        assert_eq!(faces(&mesh), [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(notices(&mesh).len(), 1);
        assert!(notices(&mesh)[0].contains("after the mesh"), "{zeros}");
    }
}

#[test]
fn a_binary_stl_may_begin_with_solid_and_have_odd_normals() {
    let mut bytes = stl(&[FACET, SECOND], 2);
    bytes[..12].copy_from_slice(b"solid facet ");
    for (i, normal) in [f32::NAN, -f32::NAN, 1.0].into_iter().enumerate() {
        bytes[84 + 4 * i..88 + 4 * i].copy_from_slice(&normal.to_le_bytes());
    }
    assert!(read(&bytes).notices.is_empty());
    for (count, found) in [(0_u32, TOO_SMALL), (1, TOO_SMALL)] {
        bytes[80..84].copy_from_slice(&count.to_le_bytes());
        let mesh = read(&bytes);
        assert_eq!((mesh.format, mesh.faces.len()), (Format::Stl, 2));
        assert_eq!(notices(&mesh), [found]);
    }
    assert_refused(
        "a",
        [0; 300],
        "a: the format is not recognised: use a file in STL, PLY, OFF, glTF or OBJ, whose name ends \
         in its format",
    );
}

/// Returns a facet of a text with this normal; `number` is its place along x.
fn text_facet(normal: &str, number: u32) -> String {
    let x = number + 1;
    format!(
        "facet{normal}\nouter loop\nvertex {number} 0 0\nvertex {x} 0 0\nvertex {number} 1 \
         0\nendloop\nendfacet\n"
    )
}

#[test]
fn normals_that_are_not_numbers_are_read() {
    for normal in [
        "",
        " normal",
        " normal -1.#IND -1.#IND -1.#IND",
        " normal nan NaN -nan(ind)",
        " normal 1.#QNAN 1.#INF +inf",
        " normal - - -",
        " normal #NUM! (null) undefined",
        " normal 0 0 1 0",
        " 0 -1.#IND 1",
        " normal 0,0,1",
    ] {
        let mesh = read(format!("solid a\n{}endsolid a\n", text_facet(normal, 0)));
        assert_eq!(faces(&mesh), [[0, 1, 2]], "{normal:?}");
        assert!(mesh.notices.is_empty(), "{normal:?}");
    }
    for coordinate in ["nan", "-1.#IND"] {
        let facet = text_facet("", 0).replace("vertex 1 0 0", &format!("vertex 1 {coordinate} 0"));
        let error = read_from(
            "a",
            format!("solid\n{facet}").as_bytes(),
            &ReadOptions::default(),
        );
        let error = error.expect_err("a coordinate is needed").to_string();
        assert!(error.starts_with("a:5: coordinate "), "{error}");
    }
    let missing = "solid\nfacet normal 0 0 1\nvertex 0 0 0\n";
    let message = "a.stl:3: expected outer loop, found \"vertex\": correct the line";
    assert_refused("a.stl", missing, message);
}

#[test]
fn ends_of_ascii_stl_may_be_odd() {
    let [first, second] = [0, 1].map(|number| text_facet(" normal 0 0 1", number));
    let spaced = |text: &str| {
        let text = text.replace("endloop", "End Loop");
        text.replace("endfacet", "end\nfacet")
    };
    for (text, notice) in [
        (format!("solid a\n{first}{second}endsolid b c\n"), ""),
        (format!("solid a\n{first}{second}endsolid;"), ""),
        (format!("solid a\n{first}{second}END SOLID a"), ""),
        (spaced(&format!("solid a\n{first}{second}end solid")), ""),
        (format!("solid a\n{first}{second}"), "(line 15)"),
        (format!("solid a\n{first}{second}\nend"), "(line 17)"),
        (
            format!("solid a\n{first}solid b\n{second}endsolid b"),
            "(line 9)",
        ),
        (
            format!("solid a\n{first}endsolid a\nsolid b\n{second}"),
            "(line 17)",
        ),
    ] {
        let mesh = read(&text);
        assert_eq!(mesh.format, Format::StlAscii, "{text}");
        assert_eq!(faces(&mesh).len(), 2, "{text}");
        let found = notices(&mesh);
        let found: Vec<&String> = found
            .iter()
            .filter(|text| text.contains("endsolid"))
            .collect();
        match notice {
            "" => assert_eq!(found, [""; 0], "{text}"),
            place => {
                let message = "ignored 1 missing `endsolid` ";
                let message = format!("{message}{place}: the file may be cut off");
                assert_eq!(found, [&message], "{text}");
            }
        }
    }
}

#[test]
fn lines_around_the_solids_of_ascii_stl_are_passed_over() {
    let facet = text_facet(" normal 0 0 1", 0);
    let unknown = |place: &str| vec![format!("ignored 1 unknown statement ({place})")];
    for (text, expected) in [
        (format!("\n \r\n\tsolid a\n{facet}endsolid\n"), vec![]),
        (
            format!("# made by a program\n\nsolid a\n{facet}endsolid\n"),
            vec![],
        ),
        (format!("; a\n// b\nSOLID\n\n{facet}endsolid\n"), vec![]),
        (
            format!("# solid\nsolid a # b\n# c\n{facet}# d\nendsolid\n# e\n"),
            vec![],
        ),
        (
            format!("Made by a program\nsolid a\n{facet}endsolid\n"),
            unknown("line 1"),
        ),
        (
            format!("solid a\n{facet}endsolid\nendsolid a\n"),
            unknown("line 10"),
        ),
        (
            format!("solid a\n{facet}endsolid\n\x1a"),
            unknown("line 10"),
        ),
        (format!("solid a\n{facet}endsolid\0\0\0"), vec![]),
        (
            format!("solid a\n{facet}endsolid\n\0\0\0"),
            unknown("line 10"),
        ),
        (
            format!("# a\nsolid b\ncolor 1 0 0\n{facet}endsolid"),
            vec!["ignored 1 colour (line 3)".to_owned()],
        ),
    ] {
        let mesh = read(&text);
        assert_eq!(mesh.format, Format::StlAscii, "{text}");
        assert_eq!(faces(&mesh), [[0, 1, 2]], "{text}");
        assert_eq!(notices(&mesh), expected, "{text}");
    }
    let message = "a: the format is not recognised: use a file in STL, PLY, OFF, glTF or OBJ, whose \
                   name ends in its format";
    assert_refused("a", "a text\nsolid state\nis not STL\n", message);
}

/// All of the text on one line, as some programs write it.
#[test]
fn text_without_line_ends_is_read() {
    let facet = |z: u32| {
        format!(
            "facet normal 0 0 1 outer loop vertex 0 0 {z} vertex 1 0 {z} vertex 0 1 {z} endloop endfacet "
        )
    };
    let (one, two) = (facet(0), facet(3));
    for text in [
        format!("solid {one}{two}endsolid"),
        format!("solid my facet of a solid {one}{two}endsolid my facet of a solid"),
        format!("solid a {one}endsolid a solid b {two}endsolid b"),
        format!("solid a {one}endsolid solid solid {two}endsolid\n"),
    ] {
        let mesh = read_from("a.stl", text.as_bytes(), &ReadOptions::default());
        let mesh = mesh.unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(
            (mesh.format, mesh.faces.len()),
            (Format::StlAscii, 2),
            "{text}"
        );
    }
    // The name of a solid is no facet.
    let text = format!("solid facet of normal size\n{one}\nendsolid solid facet\n");
    let mesh = read_from("a.stl", text.as_bytes(), &ReadOptions::default());
    assert_eq!(mesh.expect("valid").faces.len(), 1);
}

//! The rules of PLY.

use sixfold_core::Point;
use sixfold_io::{Format, Place, ReadOptions, read_from};

use super::{assert_refused, faces, notices, places, read};

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                   property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
                   end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn ply_has_properties_in_any_order_and_type() {
    let text = "ply\r\ncomment a\r\nformat ascii 1.0\r\nobj_info b\r\nelement face 2\r\n\
                property list uint double vertex_index\r\nproperty uchar red\r\nelement edge 1\r\n\
                property int vertex1\r\nelement vertex 3\r\nproperty short z\r\nproperty list char \
                float weights\r\nproperty double x\r\nproperty uchar y\r\nproperty float nx\r\n\
                property float ny\r\nproperty float nz\r\nproperty float quality\r\nend_header\r\n\
                3 0 1 2 255\r\n\r\n2 2.0 1 7 8\r\n9\r\n-1 0 0.1 2 0 0 1 5\r\n-2 2 7 8 3 4 0 0 1 5\r\n\
                3 0 1e-40 0 0 0 1 5\r\n";
    let mesh = read(text);
    assert_eq!(mesh.format, Format::PlyAscii);
    let expected = [[0.1, 2.0, -1.0], [3.0, 4.0, -2.0], [1e-40, 0.0, 3.0]];
    assert_eq!(mesh.positions, expected.map(Point::from_array));
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    assert_eq!(mesh.short_faces.len(), 1);
    assert_eq!(mesh.short_faces[0].place, Place::Line(22));
    assert_eq!(
        notices(&mesh),
        [
            "ignored 2 colours (first at line 7)",
            "ignored 1 other element: edge (line 8)",
            "ignored 2 other properties: weights, quality (first at line 12)",
            "ignored 3 normals (first at line 15)",
            "ignored 1 vertex weight or colour (line 22)",
        ]
    );
}

/// Returns a binary PLY with double coordinates, other properties, and faces of several degrees.
fn binary_ply(big: bool) -> Vec<u8> {
    let form = if big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\nformat binary_{form}_endian 1.0\nelement vertex 4\nproperty double x\nproperty list \
         uchar short w\nproperty float y\nproperty int z\nelement face 3\nproperty short flag\n\
         property list ushort uint vertex_indices\nproperty list uchar uchar more\nend_header\n"
    )
    .into_bytes();
    let mut number = |big_endian: &[u8]| {
        let mut number = big_endian.to_vec();
        if !big {
            number.reverse();
        }
        bytes.extend(number);
    };
    for (v, [x, y]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
        number(&f64::from(x).to_be_bytes());
        number(&[v as u8]);
        for _ in 0..v {
            number(&7_u16.to_be_bytes());
        }
        number(&(y as f32).to_be_bytes());
        number(&(-1_i32).to_be_bytes());
    }
    for face in [&[0_u32, 1, 2, 3][..], &[0, 1, 2], &[2, 3]] {
        number(&5_u16.to_be_bytes());
        number(&(face.len() as u16).to_be_bytes());
        for v in face {
            number(&v.to_be_bytes());
        }
        number(&[2]);
        number(&[8]);
        number(&[9]);
    }
    bytes
}

#[test]
fn binary_ply_has_both_byte_orders() {
    for (big, format) in [(false, Format::Ply), (true, Format::PlyBigEndian)] {
        let bytes = binary_ply(big);
        let mesh = read(&bytes);
        assert_eq!(mesh.format, format);
        assert_eq!(faces(&mesh), [&[0, 1, 2, 3][..], &[0, 1, 2]]);
        assert_eq!(mesh.positions[2], Point::new(1.0, 1.0, -1.0));
        assert_eq!(mesh.narrowing, sixfold_io::Narrowing::default());
        let last = bytes.len() as u64;
        let expected = [last - 15 - 19 - 23, last - 15 - 19].map(Place::Byte);
        assert_eq!(places(&mesh), expected);
        assert_eq!(mesh.short_faces[0].place, Place::Byte(last - 15));
        for cut in 0..bytes.len() {
            assert!(
                read_from("a.ply", &bytes[..cut], &ReadOptions::default()).is_err(),
                "{cut}"
            );
        }
    }
}

#[test]
fn an_lf_after_a_header_with_lone_cr_belongs_to_the_data() {
    let header = PLY
        .split("0 0 0")
        .next()
        .expect("a header")
        .replace('\n', "\r");
    let header = header.replace("ascii", "binary_little_endian");
    let mut bytes = header.into_bytes();
    // The first byte of the first coordinate is an LF.
    let first = f32::from_bits(0x3F80_000A);
    for x in [first, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.push(3);
    for v in [0_i32, 1, 2] {
        bytes.extend(v.to_le_bytes());
    }
    let mesh = read(bytes);
    assert_eq!(mesh.positions[0].x, first);
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
}

#[test]
fn triangle_strips_turn_every_other_triangle() {
    let text = PLY
        .replace("element face 1", "element tristrips 1")
        .replace("element vertex 3", "element vertex 5")
        .replace("3 0 1 2", "0 0 1\n1 1 1\n11 0 1 2 3 3 4 -1 4 3 2 1");
    let mesh = read(text);
    assert_eq!(faces(&mesh), [[0, 1, 2], [2, 1, 3], [4, 3, 2], [2, 3, 1]]);
    assert_eq!(
        notices(&mesh),
        ["ignored 2 joints of triangle strips (first at line 15)"]
    );
}

#[test]
fn indices_that_are_too_few_for_a_strip_are_named() {
    let strips = |indices: &str| {
        let count = indices.split(' ').count();
        let text = PLY
            .replace("element face 1", "element tristrips 1")
            .replace("3 0 1 2", &format!("{count} {indices}"));
        read(text)
    };
    let triangle = [[0, 1, 2]];
    for (indices, notice) in [
        ("0 1 2 -1", ""),
        ("-1 -1 0 1 2", ""),
        (
            "0 1 2 -1 2",
            "ignored 1 corner of an incomplete triangle (line 13)",
        ),
        (
            "0 1 -1 0 1 2 -1 2",
            "ignored 3 corners of incomplete triangles (first at line 13)",
        ),
    ] {
        let mesh = strips(indices);
        assert_eq!(faces(&mesh), triangle, "{indices}");
        assert_eq!(notices(&mesh).concat(), notice, "{indices}");
    }
}

#[test]
fn names_that_are_left_out_show_as_dots() {
    for (count, shown) in [
        (7, "p6"),
        (8, "p6, p7"),
        (9, "p6, p7, …"),
        (20, "p6, p7, …"),
    ] {
        let properties: String = (0..count).map(|i| format!("property int p{i}\n")).collect();
        let text = PLY
            .replace("end_header", &format!("{properties}end_header"))
            .replace("3 0 1 2", &format!("3 0 1 2{}", " 0".repeat(count)));
        let notice = notices(&read(text)).concat();
        assert!(
            notice.ends_with(&format!("{shown} (first at line 9)")),
            "{notice}"
        );
    }
}

#[test]
fn faults_of_ply_headers_are_named_with_their_lines() {
    let refused = |from: &str, to: &str, message: &str| {
        assert!(PLY.contains(from), "{from}");
        assert_refused("a.ply", PLY.replace(from, to), &format!("a.ply:{message}"));
    };
    refused(
        "format ascii 1.0",
        "comment",
        "3: the header has no `format` line before its elements: add `format ascii 1.0` if the \
         data is text",
    );
    refused(
        "ascii",
        "text",
        "2: \"text 1.0\" is not a form of PLY: use ascii, binary_little_endian or \
         binary_big_endian, and version 1.0",
    );
    refused(
        "element vertex 3",
        "element vertex -3",
        "3: \"element vertex -3\" is not an element: write `element`, a name and a count",
    );
    refused(
        "property float y",
        "property real y",
        "5: \"real\" is not a type of numbers: use int8, uint8, int16, uint16, int32, uint32, \
         int64, uint64, float32 or float64",
    );
    refused(
        "list uchar int",
        "list uchar long",
        "8: \"long\" is not a type of numbers: use int8, uint8, int16, uint16, int32, uint32, \
         int64, uint64, float32 or float64",
    );
    refused(
        "property float y",
        "property float",
        "5: \"property float\" is not a property: write `property float x` or `property list \
         uchar int x`",
    );
    refused(
        "property float y",
        "property float x",
        "5: \"x\" is declared twice: remove one of the declarations",
    );
    refused(
        "property float y",
        "property list uchar int y",
        "3: vertices have no number \"y\": declare `property float y`",
    );
    refused(
        "uchar int",
        "float int",
        "8: the length of list \"vertex_indices\" has a type with fractions: use an integer type",
    );
    refused(
        "vertex_indices",
        "corners",
        "7: the element \"face\" has no list of vertices: declare `property list uchar int \
         vertex_indices`",
    );
    refused(
        "element vertex",
        "element point",
        "9: the header declares no vertices: add `element vertex` and a count",
    );
    refused(
        "end_header",
        "begin",
        "14: the file ends before `end_header`: copy the file again, or export it again",
    );
    assert_refused(
        "a.ply",
        "ply\nformat ascii 1.0\n",
        "a.ply:3: the file ends before `end_header`: copy the file again, or export it again",
    );
}

#[test]
fn faults_of_ply_data_are_named_with_their_places() {
    let refused = |from: &str, to: &str, message: &str| {
        assert!(PLY.contains(from), "{from}");
        assert_refused("a.ply", PLY.replace(from, to), &format!("a.ply:{message}"));
    };
    refused(
        "vertex 3",
        "vertex 4",
        "14: the file ends before face 1 of 1: copy the file again, or correct its counts",
    );
    refused(
        "1 0 0",
        "1 0",
        "11: expected a value of \"z\", found \"the end of the line\": correct the line",
    );
    refused(
        "1 0 0",
        "1 a 0",
        "11: coordinate \"a\" of vertex 1 is not a number: write it like 0.5 or -2e-3",
    );
    refused(
        "1 0 0",
        "1 0 -inf",
        "11: coordinate z of vertex 1 is not finite: keep coordinates below 3.4e38",
    );
    refused(
        "3 0 1 2",
        "3 0 1 3",
        "13: face names vertex 3, but there are 3 vertices: correct the index",
    );
    refused(
        "3 0 1 2",
        "3 0 1 -1",
        "13: face names vertex -1, but there are 3 vertices: correct the index",
    );
    refused(
        "3 0 1 2",
        "3 0 1 0.5",
        "13: \"0.5\" is not a vertex number: write a whole number",
    );
    refused(
        "3 0 1 2",
        "-3 0 1 2",
        "13: \"-3\" is not the length of a list: write a whole number",
    );
    refused(
        "3 0 1 2",
        "99999999999 0 1 2",
        "13: expected a value of \"vertex_indices\", found \"the end of the line\": correct the line",
    );
}

#[test]
fn elements_without_content_need_no_time() {
    for form in ["ascii", "binary_little_endian"] {
        let text = format!(
            "ply\nformat {form} 1.0\nelement nothing 18446744073709551615\nelement vertex 0\n\
             property float x\nproperty float y\nproperty float z\nend_header\n"
        );
        let error = read_from("a", text.as_bytes(), &ReadOptions::default()).expect_err("empty");
        assert!(
            error.to_string().starts_with("a: no vertex and no face"),
            "{error}"
        );
    }
}

/// `benches/checks/reading_growth.py` counts the instructions for such files.
#[test]
fn headers_of_many_lines_are_read() {
    const MANY: usize = 200_000;
    let properties = (0..MANY).map(|i| format!("property uchar p{i}\n"));
    let properties: String = properties.collect();
    let elements = (0..MANY / 4).map(|i| format!("element e{i} 0\nproperty uchar p\n"));
    let elements: String = elements.collect();
    let unused = format!("element other 0\n{properties}");
    let expected = read(PLY);
    for (what, text) in [
        (
            "properties",
            PLY.replace("end_header", &format!("{unused}end_header")),
        ),
        (
            "elements",
            PLY.replace("end_header", &format!("{elements}end_header")),
        ),
        // Reading an element must not cost time for the number of properties of the one before.
        (
            "both",
            PLY.replace("end_header", &format!("{unused}{elements}end_header")),
        ),
    ] {
        let mesh = read(&text);
        assert_eq!(mesh.positions, expected.positions, "{what}");
        assert_eq!(faces(&mesh), faces(&expected), "{what}");
    }
}

#[test]
fn unknown_lines_of_a_ply_header_are_passed_over() {
    let text = PLY
        .replace("element face", "units mm\nelement face")
        .replace("end_header", "$flags\nunits\nend_header");
    let mesh = read(text);
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    assert_eq!(
        notices(&mesh),
        ["ignored 3 unknown statements: units, $flags (first at line 7)"]
    );
}

#[test]
fn numbers_of_64_bits_are_read() {
    let text = PLY
        .replace("float z", "int64 z")
        .replace("uchar int", "uint64 int64")
        .replace("0 1 0", "0 1 -9007199254740993");
    let mesh = read(text);
    assert_eq!(faces(&mesh), [[0, 1, 2]]);
    assert_eq!(mesh.positions[2].z, -9_007_199_254_740_992.0);
    for is_big in [false, true] {
        let form = if is_big { "big" } else { "little" };
        let number = |number: i64| match is_big {
            true => number.to_be_bytes(),
            false => number.to_le_bytes(),
        };
        let file = |numbers: &[i64]| {
            let header = PLY
                .split("0 0 0")
                .next()
                .expect("a header")
                .replace("ascii", &format!("binary_{form}_endian"))
                .replace("property float", "property int64")
                .replace("uchar int", "uint64 uint64");
            let mut bytes = header.into_bytes();
            bytes.extend(numbers.iter().flat_map(|&n| number(n)));
            bytes
        };
        let mut numbers = vec![0, 0, 0, 1, 0, 0, 0, -1, 1 << 40, 3, 0, 1, 2];
        let mesh = read(file(&numbers));
        assert_eq!(mesh.positions[2], Point::new(0.0, -1.0, 2_f32.powi(40)));
        assert_eq!(faces(&mesh), [[0, 1, 2]]);
        let refused = |numbers: &[i64], message: &str| {
            let bytes = file(numbers);
            let place = bytes.len() - 4 * 8;
            assert_refused("a", &bytes, &format!("a: byte {place}: {message}"));
        };
        numbers[11] = 1 << 40;
        refused(
            &numbers,
            "face names vertex 1099511627776, but there are 3 vertices: correct the index",
        );
        numbers[9] = -1;
        refused(
            &numbers,
            "\"2^63 or more\" is not the length of a list: write a whole number",
        );
        numbers[9] = i64::MAX;
        refused(
            &numbers,
            "\"9223372036854775807\" is not the length of a list: write a whole number",
        );
        numbers[9] = 1 << 40;
        refused(
            &numbers,
            "the file ends before face 1 of 1: copy the file again, or export it again",
        );
    }
}

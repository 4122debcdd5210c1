//! Properties of reading and writing for random meshes and random bytes.

use std::io::BufReader;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};
use sixfold_core::{FaceList, Point, PolygonMesh};
use sixfold_io::{FileMesh, Format, Place, WriteOptions, parse_obj, write_to};

fn coordinate() -> impl Strategy<Value = f32> {
    let any = any::<u32>()
        .prop_map(f32::from_bits)
        .prop_filter("finite", |x| x.is_finite());
    prop_oneof![
        any,
        (-9_i8..9).prop_map(f32::from),
        Just(-0.0),
        -1e3_f32..1e3
    ]
}

fn point() -> impl Strategy<Value = Point> {
    [coordinate(), coordinate(), coordinate()].prop_map(Point::from_array)
}

/// Generates random polygons. They can be non-manifold.
fn mesh() -> impl Strategy<Value = PolygonMesh> {
    let only_triangles = any::<bool>();
    (vec(point(), 3..12), only_triangles).prop_flat_map(|(positions, only_triangles)| {
        let numbers: Vec<u32> = (0..).take(positions.len()).collect();
        let max_corners = if only_triangles { 3 } else { numbers.len() };
        let face = subsequence(numbers, 3..=max_corners).prop_shuffle();
        vec(face, 0..12).prop_map(move |faces| {
            PolygonMesh::new(positions.clone(), faces).expect("three corners, each once")
        })
    })
}

fn written(mesh: &PolygonMesh) -> String {
    let mut text = Vec::new();
    write_to(mesh, Format::Obj, &WriteOptions::default(), &mut text).expect("memory does not fail");
    String::from_utf8(text).expect("OBJ is text")
}

/// Returns the bits of positions, so that −0 and 0 differ.
fn bits(positions: &[Point]) -> Vec<[u32; 3]> {
    positions
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect()
}

fn check_same(obj: FileMesh, mesh: &PolygonMesh) -> Result<(), TestCaseError> {
    let (polygons, left_out) = obj.into_polygons();
    prop_assert_eq!(left_out, []);
    prop_assert_eq!(polygons.faces(), mesh.faces());
    prop_assert_eq!(bits(polygons.positions()), bits(mesh.positions()));
    Ok(())
}

/// Checks that reading gives a consistent mesh or a short error message with file and line.
fn check_consistent(bytes: &[u8]) -> Result<(), TestCaseError> {
    match parse_obj("a.obj", bytes) {
        Ok(obj) => {
            let lines = bytes.iter().filter(|b| b"\r\n".contains(b)).count() + 1;
            prop_assert!(obj.positions.len() + obj.faces.len() <= lines);
            prop_assert!(obj.positions.iter().all(|p| p.is_finite()));
            prop_assert!(obj.faces.iter().map(|(f, _)| obj.face_place(f)).is_sorted());
            prop_assert!(obj.faces.iter().all(|(_, face)| face.len() >= 3));
            prop_assert!(obj.short_faces.iter().all(|face| face.corners.len() < 3));
            let facts = obj.facts();
            let all = obj.faces.len() + obj.short_faces.len();
            let (polygons, left_out) = obj.into_polygons();
            prop_assert_eq!(left_out.len(), facts.degenerate_faces);
            prop_assert_eq!(polygons.face_count() + left_out.len(), all);
            prop_assert_eq!(facts.faces, polygons.face_count());
        }
        Err(error) => {
            let message = error.to_string();
            prop_assert!(message.starts_with("a.obj:"), "{}", message);
            prop_assert!(message.len() < 400, "{}", message);
        }
    }
    Ok(())
}

/// Generates valid and invalid pieces of OBJ files.
fn piece() -> impl Strategy<Value = &'static [u8]> {
    let pieces: &[&[u8]] = &[
        b"v",
        b"f",
        b" ",
        b"\t",
        b"\n",
        b"\r\n",
        b"\r",
        b"\\",
        b"\\\n",
        b"#",
        b"1",
        b"2",
        b"0",
        b"-1",
        b"-2",
        b"/",
        b"//",
        b".5",
        b"1e39",
        b"nan",
        b"vt",
        b"vn",
        b"g",
        b"l",
        b"\0",
        b"\xFF",
        b"\xEF\xBB\xBF",
        b"\xC2\xA0",
        b"99999999999999999999",
        b"v 0 0 0\n",
        b"v 1 2 3\n",
        b"f 1 2 1\n",
        b"f -1 -1 -2\n",
    ];
    select(pieces.to_vec())
}

/// One of many equivalent ways to write a statement.
#[derive(Clone, Debug)]
struct Formatting {
    before: &'static str,
    blank: &'static str,
    after: &'static str,
    backwards: bool,
    corner: &'static str,
}

fn formatting() -> impl Strategy<Value = Formatting> {
    let before = select(vec![
        "",
        "",
        "vt 0 0\n",
        "# v 9 9 9 \\\n",
        "g a\n",
        "\n",
        " ",
        "x 1\n",
    ]);
    let blank = select(vec![" ", " ", "\t ", " \\\n", "\\  \n", "\u{a0}"]);
    let after = select(vec![
        "\n",
        "\n",
        "\r\n",
        "\r",
        " # f 1 1 1\\\n",
        "#\r",
        " \n\n",
    ]);
    let corner = select(vec!["", "/1", "//-7", "/9/9", "/"]);
    (before, blank, after, any::<bool>(), corner).prop_map(
        |(before, blank, after, backwards, corner)| Formatting {
            before,
            blank,
            after,
            backwards,
            corner,
        },
    )
}

/// Writes `vertices_first` vertices, then the faces, then the other vertices. Returns the text and
/// the lines of the faces.
fn format_mesh(
    mesh: &PolygonMesh,
    vertices_first: usize,
    formattings: &[Formatting],
) -> (String, Vec<u32>) {
    let mut formattings = formattings.iter().cycle();
    let mut next = || formattings.next().expect("at least one formatting");
    let vertices_first = vertices_first.min(mesh.vertex_count());
    let mut text = "\u{feff}".to_owned();
    let mut face_lines = Vec::new();
    let vertex = |text: &mut String, m: &Formatting, p: &Point| {
        let (before, blank, after, [x, y, z]) = (m.before, m.blank, m.after, p.to_array());
        *text += &format!("{before}v {x:e}{blank}{y}{blank}{z:?}{after}");
    };
    for p in &mesh.positions()[..vertices_first] {
        vertex(&mut text, next(), p);
    }
    for (_, face) in mesh.faces().iter() {
        let m = next();
        text += m.before;
        face_lines.push(count_line_ends(&text) + 1);
        text += "f ";
        for v in face {
            // A negative number can name only an earlier vertex.
            if m.backwards && v.index() < vertices_first {
                text += &format!("-{}", vertices_first - v.index());
            } else {
                text += &format!("{}", v.index() + 1);
            }
            text += m.corner;
            text += m.blank;
        }
        text += m.after;
    }
    for p in &mesh.positions()[vertices_first..] {
        vertex(&mut text, next(), p);
    }
    (text, face_lines)
}

fn count_line_ends(text: &str) -> u32 {
    let lone = text.replace("\r\n", "\n").replace('\r', "\n");
    lone.matches('\n').count() as u32
}

#[test]
fn every_shape_reads_back_bit_for_bit() -> Result<(), TestCaseError> {
    for generator in sixfold_shapes::GENERATORS {
        let mesh = generator.build(&[]).expect("defaults are possible");
        let obj = parse_obj(generator.name, written(&mesh).as_bytes());
        check_same(obj.expect("valid"), &mesh)?;
    }
    Ok(())
}

proptest! {
    #[test]
    fn a_written_mesh_reads_back_bit_for_bit(mesh in mesh()) {
        let obj = parse_obj("a.obj", written(&mesh).as_bytes());
        check_same(obj.expect("valid"), &mesh)?;
    }

    #[test]
    fn every_formatting_gives_the_same_mesh(
        mesh in mesh(),
        vertices_first in 0..12_usize,
        formattings in vec(formatting(), 1..30),
        buffer in 1..40_usize,
    ) {
        let (text, face_lines) = format_mesh(&mesh, vertices_first, &formattings);
        let source = BufReader::with_capacity(buffer, text.as_bytes());
        let obj = parse_obj("a.obj", source);
        let obj = obj.unwrap_or_else(|error| panic!("{error}\n{text}"));
        let found = obj.faces.iter().map(|(f, _)| obj.face_place(f));
        prop_assert!(found.eq(face_lines.iter().map(|&line| Place::Line(line))), "{}", text);
        check_same(obj, &mesh)?;
    }

    /// `tobj` alone numbers vertices in the order of their first use.
    #[test]
    fn tobj_alone_agrees(mesh in mesh()) {
        let mut numbers: Vec<Option<u32>> = vec![None; mesh.vertex_count()];
        let mut order = Vec::new();
        for v in mesh.faces().corners() {
            numbers[v.index()].get_or_insert_with(|| {
                order.push(mesh.position(*v));
                order.len() as u32 - 1
            });
        }
        let mut faces = FaceList::default();
        for (_, face) in mesh.faces().iter() {
            let renamed = face.iter().map(|v| sixfold_core::VertexId::new(numbers[v.index()].expect("used")));
            faces.push(renamed).expect("small");
        }
        let by_first_use = PolygonMesh::from_faces(order, faces).expect("as before");

        let text = written(&by_first_use);
        let mut source = text.as_bytes();
        let nothing = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
        let (models, _) = tobj::load_obj_buf(&mut source, &tobj::LoadOptions::default(), nothing)
            .expect("valid");
        let tobj_mesh = &models[0].mesh;
        let flat: Vec<u32> = tobj_mesh.positions.iter().map(|x| x.to_bits()).collect();
        prop_assert_eq!(flat, bits(by_first_use.positions()).concat());
        let corners = by_first_use.faces().corners();
        prop_assert!(tobj_mesh.indices.iter().copied().eq(corners.iter().map(|v| v.index() as u32)));
        if by_first_use.vertex_count() > 0 {
            let read_mesh = parse_obj("a.obj", text.as_bytes());
            check_same(read_mesh.expect("valid"), &by_first_use)?;
        }
    }

    #[test]
    fn random_bytes_give_a_consistent_mesh_or_an_error(bytes in vec(any::<u8>(), 0..200)) {
        check_consistent(&bytes)?;
    }

    #[test]
    fn random_pieces_give_a_consistent_mesh_or_an_error(pieces in vec(piece(), 0..60)) {
        check_consistent(&pieces.concat())?;
    }

    #[test]
    fn damaged_files_give_a_consistent_mesh_or_an_error(
        mesh in mesh(),
        damage in vec((any::<prop::sample::Index>(), 0..4_u8, piece()), 1..6),
    ) {
        let mut bytes = written(&mesh).into_bytes();
        for (index, kind, piece) in damage {
            let at = index.index(bytes.len() + 1);
            let end = (at + piece.len()).min(bytes.len());
            match kind {
                0 => { bytes.splice(at..at, piece.iter().copied()); }
                1 => { bytes.splice(at..end, piece.iter().copied()); }
                2 => { bytes.splice(at..end, []); }
                _ => bytes.truncate(at),
            }
        }
        check_consistent(&bytes)?;
    }
}

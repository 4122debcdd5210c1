//! Tests for reading sharpness from crease files and OBJ tags.

use std::env;
use std::io::{self, BufRead, Read};
use std::path::PathBuf;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use sixfold_core::{Creases, Pair, Point, PolygonMesh, VertexId};
use sixfold_io::{
    CreaseFileError, FileMesh, parse_creases, parse_obj, read_creases, write_creases,
};

/// Two squares side by side.
///
/// ```text
/// 3 ── 4 ── 5
/// │    │    │
/// 0 ── 1 ── 2
/// ```
const SQUARES: &str =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nf 1 2 5 4\nf 2 3 6 5\n";

fn squares() -> PolygonMesh {
    read(SQUARES).into_polygons().0
}

fn read(text: &str) -> FileMesh {
    parse_obj("a.obj", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn parse(text: impl AsRef<[u8]>) -> Result<Creases, CreaseFileError> {
    parse_creases("a.creases", text.as_ref(), &squares())
}

/// Edges and corners with their sharpness.
type Numbers = (Vec<(usize, usize, f32)>, Vec<(usize, f32)>);

fn numbers(creases: &Creases) -> Numbers {
    let edges = creases.edges().iter().map(|&(edge, sharpness)| {
        let [a, b] = edge.ends().map(VertexId::index);
        (a, b, sharpness)
    });
    let corners = creases.corners().iter();
    let corners = corners.map(|&(v, sharpness)| (v.index(), sharpness));
    (edges.collect(), corners.collect())
}

#[test]
fn a_crease_file_has_edges_corners_comments_and_empty_lines() {
    let expected = (vec![(0, 1, 2.5), (1, 4, f32::INFINITY)], vec![(5, 0.25)]);
    let text =
        "# creases\nedge 1 0 2.5\n\n  corner\t5 .25 # kept a while\nedge 1 4 inf\nedge 3 4 -0\n";
    for text in [
        text.to_owned(),
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        text.trim_end().to_owned(),
    ] {
        let creases = parse(&text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
        assert_eq!(numbers(&creases), expected, "{text:?}");
    }
    assert!(parse("").expect("an empty file is valid").is_empty());
    let twice = parse("edge 0 1 2\nedge 1 0 3\ncorner 2 1\ncorner 2 0\n").expect("valid");
    assert_eq!(numbers(&twice), (vec![(0, 1, 3.0)], vec![]));
}

#[test]
fn each_fault_of_a_crease_file_is_named_with_its_line() {
    let forms = "write `edge a b sharpness` or `corner v sharpness`";
    let edge = "write `edge a b sharpness`";
    let corner = "write `corner v sharpness`";
    let number = "is not a number from 0 to inf: write it like 2, 0.5 or inf";
    let vertex =
        "is not a vertex number: use whole numbers that count from 0; the number of vertices is 6";
    for (text, message) in [
        ("face 0 1 2", format!("1: \"face\" is not an entry: {forms}")),
        ("\n\nEdge 0 1 2", format!("3: \"Edge\" is not an entry: {forms}")),
        ("edge 0 1", format!("1: expected 4 fields, found 3: {edge}")),
        ("edge", format!("1: expected 4 fields, found 1: {edge}")),
        ("edge 0 1 2 3 4", format!("1: expected 4 fields, found 6: {edge}")),
        ("#\ncorner 0", format!("2: expected 3 fields, found 2: {corner}")),
        ("corner 0 1 2", format!("1: expected 3 fields, found 4: {corner}")),
        ("edge 0 x 2", format!("1: \"x\" {vertex}")),
        ("edge -1 0 2", format!("1: \"-1\" {vertex}")),
        ("corner 1.0 2", format!("1: \"1.0\" {vertex}")),
        ("corner 4294967296 2", format!("1: \"4294967296\" {vertex}")),
        ("edge 0 1 sharp", format!("1: sharpness \"sharp\" {number}")),
        ("edge 0 1 -0.5", format!("1: sharpness \"-0.5\" {number}")),
        ("corner 0 nan", format!("1: sharpness \"nan\" {number}")),
        ("corner 0 -inf", format!("1: sharpness \"-inf\" {number}")),
        (
            "corner 0 1\ncorner 6 1",
            "2: vertex 6 does not exist: the mesh has 6 vertices, counted from 0".into(),
        ),
        (
            "edge 0 1 1\ncorner 0 1\nedge 0 4294967295 1",
            "3: vertex 4294967295 does not exist: the mesh has 6 vertices, counted from 0".into(),
        ),
        (
            "corner 0 1\n\nedge 3 5 0",
            "3: v3 and v5 are not the ends of an edge: name two vertices that follow each other in a face"
                .into(),
        ),
        (
            "edge 2 2 1",
            "1: v2 and v2 are not the ends of an edge: name two vertices that follow each other in a face"
                .into(),
        ),
        // Faults of the text are reported before missing elements.
        ("corner 9 1\nedges", format!("2: \"edges\" is not an entry: {forms}")),
    ] {
        let error = parse(text).expect_err(text);
        assert_eq!(error.to_string(), format!("a.creases:{message}"), "{text:?}");
    }
    let error = parse(b"corner 0 1\nedge \xFF 0 1").expect_err("no text");
    assert!(
        error
            .to_string()
            .starts_with("a.creases:2: the line is not UTF-8")
    );
    let error = parse(b"\xFF\xFEe\0").expect_err("UTF-16");
    assert!(matches!(error, CreaseFileError::Utf16 { .. }), "{error}");
    let long = "x".repeat(10_000);
    let message = parse(&long).expect_err("no entry").to_string();
    assert!(message.len() < 200, "{message}");
}

#[test]
fn reading_stops_at_a_line_that_is_too_long() {
    let endless = io::BufReader::new(io::repeat(0).chain(&b""[..]));
    let error = parse_creases("zero", endless, &squares()).expect_err("no line feed");
    let message = "zero:1: the line is longer than 1048576 bytes: end each entry with a line feed";
    assert_eq!(error.to_string(), message);
    let endless = (&b"corner 0 1\n"[..]).chain(io::BufReader::new(io::repeat(b'\\')));
    let error = parse_creases("back", endless, &squares()).expect_err("no line feed");
    assert!(
        error.to_string().starts_with("back:2: the line is longer"),
        "{error}"
    );
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let missing = read_creases("no/such.creases", &squares()).expect_err("missing");
    let message = missing.to_string();
    assert!(
        message.starts_with("no/such.creases: cannot be opened"),
        "{message}"
    );
    let folder = read_creases(".", &squares()).expect_err("a directory");
    assert_eq!(folder.to_string(), ".: is a directory: choose a file in it");

    struct Broken;
    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("unplugged"))
        }
    }
    impl BufRead for Broken {
        fn fill_buf(&mut self) -> io::Result<&[u8]> {
            Err(io::Error::other("unplugged"))
        }
        fn consume(&mut self, _: usize) {}
    }
    let broken = (&b"edge 0 1 1\n"[..]).chain(Broken);
    let error = parse_creases("a.creases", broken, &squares()).expect_err("unplugged");
    let message = "a.creases:2: cannot be read further (unplugged): copy the file again";
    assert_eq!(error.to_string(), message);
}

#[test]
fn one_tag_can_have_a_chain_of_edges_or_several_corners() {
    let tags = "t crease 2/1/0 0 1 4.7\nt crease 4/3/0 1 4 3 0 1 0.5 inf\n\
                t\tcorner 2/1/0 2 5 3\nt corner 2/2/0 0 3 1 2 # two\nt crease 3/1/0 1 2 5 2\r\n";
    let expected = (
        vec![
            (0, 1, 4.7),
            (0, 3, f32::INFINITY),
            (1, 2, 2.0),
            (1, 4, 1.0),
            (2, 5, 2.0),
            (3, 4, 0.5),
        ],
        vec![(0, 1.0), (2, 3.0), (3, 2.0), (5, 3.0)],
    );
    // Tags may come before the vertices and faces that they name.
    for text in [format!("{SQUARES}{tags}"), format!("{tags}{SQUARES}")] {
        let obj = read(&text);
        assert_eq!(obj.notices, []);
        let (creases, unused) = obj.creases();
        assert_eq!(numbers(&creases), expected);
        assert_eq!(unused, []);
        let (polygons, _) = obj.into_polygons();
        let edges = creases.edges().iter().map(|&(edge, s)| {
            let ends = edge.ends().map(|v| u32::try_from(v.index()).expect("few"));
            (ends, s)
        });
        assert!(Creases::new(&polygons, edges, []).is_ok());
    }
}

#[test]
fn the_last_sharpness_counts_and_earlier_ones_are_named() {
    let values = |tags: &str| {
        let obj = read(&format!("{tags}{SQUARES}"));
        let notices: Vec<String> = obj.notices.iter().map(ToString::to_string).collect();
        (numbers(&obj.creases().0), notices.concat())
    };
    let twice = "t crease 2/1/0 0 1 4\nt crease 2/1/0 1 0 0\nt corner 2/1/0 1 1 2\n";
    let notice = "ignored 1 sharpness that a later one replaces (line 1)";
    assert_eq!(values(twice), ((vec![], vec![(1, 2.0)]), notice.into()));
    let corners = "t crease 2/1/0 1 2 5\nt corner 1/1/0 2 3\nt corner 1/1/0 2 1\nt corner 1/1/0 2 1\n\
                   t crease 2/1/0 2 1 6\nt corner 1/1/0 1 1\n";
    let notice = "ignored 2 sharpness values that later ones replace (first at line 1)";
    let expected = (vec![(1, 2, 6.0)], vec![(1, 1.0), (2, 1.0)]);
    assert_eq!(values(corners), (expected, notice.into()));
}

#[test]
fn other_tags_are_ignored_with_a_notice() {
    let tags = "t interpolateboundary 1/0/0 2\nt facevaryinginterpolateboundary 1/0/0 1\n\
                t creasemethod 0/0/1 chaikin\nt hole 1/0/0 3\nt vertexedit\nt\nt 0.5 0.5\n";
    let obj = read(&format!("{tags}{SQUARES}"));
    let notices: Vec<String> = obj.notices.iter().map(ToString::to_string).collect();
    assert_eq!(
        notices,
        [
            "ignored 2 boundary rule tags (first at line 1)",
            "ignored 1 crease method tag (line 3)",
            "ignored 1 hole tag (line 4)",
            "ignored 3 other tags (first at line 5)",
        ]
    );
    assert!(obj.creases().0.is_empty());
}

#[test]
fn creases_of_faces_that_are_left_out_are_unused() {
    // Side 3–4 belongs only to the degenerate face, and side 2–5 only to the short face.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 2 2\nv 3 3 3\nf 4 5 1 5\nf 1 2 3\nf 3 6\n\
                t crease 3/2/0 2 1 0 5 6\nt crease 2/1/0 3 4 7\nt crease 2/1/0 5 2 1\nt corner 1/1/0 4 2\n";
    let obj = read(text);
    let (creases, unused) = obj.creases();
    let expected = (vec![(0, 1, 6.0), (1, 2, 5.0)], vec![(4, 2.0)]);
    assert_eq!(numbers(&creases), expected);
    let unused: Vec<String> = unused.iter().map(ToString::to_string).collect();
    assert_eq!(
        unused,
        [
            "line 11: crease 3 4 is ignored, because all faces along it are left out",
            "line 12: crease 5 2 is ignored, because all faces along it are left out",
        ]
    );
    let (polygons, left_out) = obj.into_polygons();
    assert_eq!((polygons.vertex_count(), left_out.len()), (6, 2));
}

#[test]
fn each_fault_of_a_tag_is_named_with_its_line() {
    let crease = "write the tag like `t crease 2/1/0 0 1 2.5`";
    let corner = "write the tag like `t corner 1/1/0 0 2.5`";
    let of_crease = "n vertices in a row need 1 or n - 1 sharpness values";
    let of_corner = "n vertices need 1 or n sharpness values";
    let number = "is not a number from 0 to inf: write it like 2, 0.5 or inf";
    let most = usize::MAX;
    for (tag, message) in [
        (
            "crease",
            format!("tag crease has invalid counts \"\": {crease}"),
        ),
        (
            "crease 2/1 0 1 2",
            format!("tag crease has invalid counts \"2/1\": {crease}"),
        ),
        (
            "corner 1/1/0/0 0 2",
            format!("tag corner has invalid counts \"1/1/0/0\": {corner}"),
        ),
        (
            "corner -1/1/0 0",
            format!("tag corner has invalid counts \"-1/1/0\": {corner}"),
        ),
        (
            &format!("crease {most}/{most}/0 0 1 2"),
            format!(
                "tag crease has invalid counts \"{most}/{}…\": {crease}",
                &most.to_string()[..19]
            ),
        ),
        (
            &format!("crease {most}/0/0 0 1 2"),
            format!("the counts of tag crease require {most} values, found 3: correct the counts or the values"),
        ),
        (
            "crease 2/1/0 0 1",
            "the counts of tag crease require 3 values, found 2: correct the counts or the values".into(),
        ),
        (
            "crease 3/3/0 0 1 2 1 1 1",
            format!("counts 3/3/0 do not fit tag crease: {crease}; {of_crease}"),
        ),
        (
            "crease 1/1/0 0 2",
            format!("counts 1/1/0 do not fit tag crease: {crease}; {of_crease}"),
        ),
        (
            "crease 2/1/1 0 1 2 x",
            format!("counts 2/1/1 do not fit tag crease: {crease}; {of_crease}"),
        ),
        (
            "crease 0/0/0",
            format!("counts 0/0/0 do not fit tag crease: {crease}; {of_crease}"),
        ),
        (
            "corner 2/0/0 0 1",
            format!("counts 2/0/0 do not fit tag corner: {corner}; {of_corner}"),
        ),
        (
            "corner 3/2/0 0 1 2 1 1",
            format!("counts 3/2/0 do not fit tag corner: {corner}; {of_corner}"),
        ),
        (
            "crease 2/1/0 0 -1 2",
            "\"-1\" in tag crease is not a vertex number: use whole numbers that count from 0".into(),
        ),
        (
            "corner 1/1/0 4294967295 2",
            "\"4294967295\" in tag corner is not a vertex number: use whole numbers that count from 0"
                .into(),
        ),
        (
            "crease 2/1/0 0 1 x",
            format!("sharpness \"x\" in tag crease {number}"),
        ),
        (
            "corner 1/1/0 0 -2",
            format!("sharpness \"-2\" in tag corner {number}"),
        ),
        (
            "corner 1/1/0 0 NaN",
            format!("sharpness \"NaN\" in tag corner {number}"),
        ),
        (
            "corner 1/1/0 6 1",
            "tag corner: vertex 6 does not exist: the mesh has 6 vertices, counted from 0".into(),
        ),
        (
            "crease 3/1/0 0 1 6 1",
            "tag crease: vertex 6 does not exist: the mesh has 6 vertices, counted from 0".into(),
        ),
        (
            "crease 2/1/0 3 5 1",
            "tag crease: v3 and v5 are not the ends of an edge: \
             name two vertices that follow each other in a face"
                .into(),
        ),
    ] {
        let text = format!("{SQUARES}t {tag}\n");
        let error = parse_obj("a.obj", text.as_bytes()).expect_err(tag);
        assert_eq!(error.to_string(), format!("a.obj:9: {message}"), "{tag}");
    }
    // Edges are checked before corners, but the first fault in the file is reported.
    let text = format!("{SQUARES}t corner 1/1/0 9 1\nt crease 2/1/0 3 5 1\n");
    let error = parse_obj("a.obj", text.as_bytes()).expect_err("two faults");
    assert!(
        error.to_string().starts_with("a.obj:9: tag corner"),
        "{error}"
    );
    // A side from a vertex to itself is not an edge.
    let text = format!("{SQUARES}f 1 1 2\nt crease 2/1/0 0 0 1\n");
    let error = parse_obj("a.obj", text.as_bytes()).expect_err("no edge");
    assert!(error.to_string().contains("v0 and v0"), "{error}");
}

#[test]
fn the_torus_with_creases_is_read_completely() {
    let Some(folder) = env::var_os("SIXFOLD_MESHES").map(PathBuf::from) else {
        return;
    };
    let path = folder.join("fetched/catmark_torus_creases0.obj");
    let obj = sixfold_io::read(path).unwrap_or_else(|error| panic!("{error}"));
    let notices: Vec<String> = obj.notices.iter().map(ToString::to_string).collect();
    assert_eq!(
        notices,
        ["ignored 4 texture coordinates (first at line 58)"]
    );
    let (creases, unused) = obj.creases();
    assert_eq!((creases.corners(), unused.len()), (&[][..], 0));
    // The creases form a ring around the hole.
    let ring = (0..8).map(|i| [4 * i + 1, (4 * i + 5) % 32]);
    let ring = ring.map(|ends| ends.map(VertexId::new));
    let mut ring: Vec<_> = ring.map(|[a, b]| Pair::new(a, b)).collect();
    ring.sort_unstable();
    let edges: Vec<_> = creases.edges().iter().map(|&(edge, _)| edge).collect();
    assert_eq!(edges, ring);
    assert!(
        creases
            .edges()
            .iter()
            .all(|&(_, sharpness)| sharpness == 4.7)
    );
    // All vertices of the inner ring have the same distance from the axis.
    let (polygons, _) = obj.into_polygons();
    for &(edge, _) in creases.edges() {
        for v in edge.ends() {
            let p = polygons.position(v);
            assert!((p.x.hypot(p.y) - 0.646_446).abs() < 1e-5, "{p}");
        }
    }
}

fn sharpness() -> impl Strategy<Value = f32> {
    let any = (0_u32..=f32::INFINITY.to_bits()).prop_map(f32::from_bits);
    prop_oneof![any, Just(f32::INFINITY), 0_f32..12.0]
}

/// Builds a strip of `n` squares. Edges lead from `i` to `i + 1` and from `i` to `i + n + 1`.
fn strip(n: u32) -> PolygonMesh {
    let row = |y: f32| (0..=n).map(move |x| Point::new(x as f32, y, 0.0));
    let positions: Vec<Point> = row(0.0).chain(row(1.0)).collect();
    let faces = (0..n).map(|i| [i, i + 1, i + n + 2, i + n + 1]);
    PolygonMesh::new(positions, faces).expect("valid")
}

proptest! {
    #[test]
    fn crease_files_round_trip(
        n in 1_u32..9,
        edges in vec((0_u32..9, any::<bool>(), sharpness()), 0..20),
        corners in vec((0_u32..18, sharpness()), 0..9),
    ) {
        let polygons = strip(n);
        let edges = edges.into_iter().map(|(i, across, sharpness)| {
            let i = i % n;
            ([i, if across { i + n + 1 } else { i + 1 }], sharpness)
        });
        let corners = corners.into_iter().map(|(v, sharpness)| (v % (2 * n + 2), sharpness));
        let creases = Creases::new(&polygons, edges, corners).expect("valid");
        let mut text = Vec::new();
        write_creases(&creases, &mut text).expect("memory does not fail");
        let back = parse_creases("a.creases", text.as_slice(), &polygons);
        prop_assert_eq!(back.map_err(|e| e.to_string()), Ok(creases));
    }

    #[test]
    fn any_crease_file_gives_creases_or_an_error(
        pieces in vec(select(&[
            "edge", "corner", " ", " ", " ", "\n", "\r", "0", "1", "4", "7", "-1", "0.5", "inf", "nan",
            "#", "\\", "x", "\u{feff}", "\0", "1e99", "99999999999999999999",
        ][..]), 0..40),
        bytes in vec(any::<u8>(), 0..40),
    ) {
        for text in [pieces.concat().into_bytes(), bytes] {
            if let Err(error) = parse(&text) {
                let message = error.to_string();
                prop_assert!(message.starts_with("a.creases:"), "{}", message);
                prop_assert!(message.len() < 400, "{}", message);
            }
        }
    }

    #[test]
    fn any_tag_gives_creases_or_an_error(
        pieces in vec(select(&[
            "t crease ", "t corner ", "2/1/0 ", "1/1/0 ", "3/2/0 ", "0 ", "1 ", "4 ", "7 ", "-1 ",
            "0.5 ", "inf ", "nan ", "\n", "t ", "/", "18446744073709551615/1/0 ",
        ][..]), 0..40),
    ) {
        match parse_obj("a.obj", format!("{SQUARES}{}", pieces.concat()).as_bytes()) {
            Ok(obj) => {
                let (creases, unused) = obj.creases();
                prop_assert!(unused.is_empty());
                prop_assert!(creases.edges().len() <= obj.crease_tags.len());
                prop_assert!(creases.corners().len() <= obj.corner_tags.len());
            }
            Err(error) => {
                let message = error.to_string();
                prop_assert!(message.starts_with("a.obj:"), "{}", message);
                prop_assert!(message.len() < 400, "{}", message);
            }
        }
    }
}

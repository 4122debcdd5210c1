use super::*;
use crate::format::Format;
use crate::options::ReadOptions;
use crate::place::FacePlaces;

fn normaliser<'a>(text: &'a [u8]) -> Normaliser<'a, &'a [u8]> {
    let places = FacePlaces::Lines(Vec::new());
    let options = ReadOptions::default();
    Normaliser::new(
        MeshBuilder::new("a.obj", Format::Obj, options, places),
        text,
    )
}

#[test]
fn the_text_is_plain_and_ends_in_a_polygon_through_all_vertices() {
    let source = "g a\nf 1/2/3 2//3 3 3#c\nv 0\t1. 2 0.5 # w\n v -0 \\\n .5 1E+00 9 9 9\nvn\n\
                  f\nf -1\nv 1 1 1\nfo -3 -2 -1";
    let mut text = String::new();
    let mut normaliser = normaliser(source.as_bytes());
    normaliser.read_to_string(&mut text).expect("valid");
    assert_eq!(text, "v 0 1. 2\nv -0 .5 1E+00\nv 1 1 1\nf 1 2 3\n");
    assert!(
        !normaliser
            .finish_block(&[0.0, 1.0, 2.0, -0.0, 0.5, 1.0, 1.0, 1.0, 1.0])
            .expect("few")
    );
    let mesh = normaliser.builder.finish().expect("valid");
    assert_eq!((mesh.faces.len(), mesh.short_faces.len()), (2, 2));
}

#[test]
fn vertices_are_passed_on_in_blocks() {
    let vertices = BLOCK + 2;
    let source = "v 0 0 1\n".repeat(vertices) + "f 1 2 -1\n";
    let mut normaliser = normaliser(source.as_bytes());
    for (count, more) in [(BLOCK, true), (2, false)] {
        let mut text = String::new();
        normaliser.read_to_string(&mut text).expect("valid");
        assert_eq!(text.lines().count(), count + 1);
        assert!(text.ends_with(&format!(" {count}\n")), "{count}");
        let coordinates = [0.0, 0.0, 1.0].repeat(count);
        assert_eq!(normaliser.finish_block(&coordinates).expect("finite"), more);
    }
    let mesh = normaliser.builder.finish().expect("valid");
    assert_eq!(mesh.positions.len(), vertices);
    assert_eq!(mesh.faces.corners()[2].index(), vertices - 1);
}

#[test]
fn an_unexplained_error_of_the_parser_is_reported_with_its_reason() {
    let mut normaliser = normaliser(b"\nv 0 0 0\nf 1 1 1\n");
    normaliser.advance().expect("a vertex");
    assert_eq!(
        normaliser
            .diagnose(&tobj::LoadError::FaceParseError)
            .to_string(),
        "a.obj:2: the parser rejects \"v 0 0 0\" (face parse error): write the line in a simpler form"
    );
}

#[test]
fn lines_corners_and_vertices_are_limited() {
    let fault = |text: &str| {
        let mut normaliser = normaliser(text.as_bytes());
        normaliser.limit = 4;
        io::copy(&mut normaliser, &mut io::sink()).expect_err("too many");
        normaliser.fault.expect("kept").to_string()
    };
    let rest = "split the mesh, because handles have 32 bits";
    assert_eq!(
        fault("\n\n\n\nv 0 0 0"),
        format!("a.obj:4: more than 4 lines: {rest}")
    );
    assert_eq!(
        fault("v 0 0 0\nf 1 1 1 1 1"),
        format!("a.obj:2: more than 4 corners: {rest}")
    );
    let mut normaliser = normaliser(b"");
    normaliser.limit = 1;
    normaliser
        .read_vertex("0 0 0")
        .expect("one vertex is within the limit");
    let fault = normaliser.read_vertex("0 0 0").expect_err("too many");
    assert_eq!(
        fault.to_string(),
        format!("a.obj:1: more than 1 vertices: {rest}")
    );
}

//! Corners that repeat their neighbours: only the repeat is removed, in every format.

use sixfold_core::{FaceId, Facts};
use sixfold_io::{FileMesh, IgnoredKind, LeftOutReason, Place, ReadOptions, Welding, read_from};

/// A cube, counted from 0. All faces have the same side.
const CUBE: [[u32; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];
const FACES: [&[u32]; 6] = [
    &[0, 3, 2, 1],
    &[4, 5, 6, 7],
    &[0, 1, 5, 4],
    &[1, 2, 6, 5],
    &[2, 3, 7, 6],
    &[3, 0, 4, 7],
];

/// Faces of the cube with repeats: two neighbours, at the end, and several of both kinds.
const REPEATS: [(usize, &[u32], u64); 4] = [
    (2, &[0, 1, 1, 5, 4], 1),
    (0, &[0, 3, 2, 1, 0], 1),
    (5, &[3, 3, 3, 0, 4, 4, 7, 3, 3], 5),
    (4, &[2, 2, 3, 7, 6], 1),
];

/// Returns the faces of the cube, of which face `number` is `face`.
fn faces(number: usize, face: &[u32]) -> Vec<Vec<u32>> {
    let mut faces: Vec<Vec<u32>> = FACES.iter().map(|face| face.to_vec()).collect();
    faces[number] = face.to_vec();
    faces
}

fn obj(faces: &[Vec<u32>]) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in CUBE {
        text += &format!("v {x} {y} {z}\n");
    }
    for face in faces {
        let corners = face.iter().map(|v| format!(" {}/1", v + 1));
        text += &format!("f{}\n", corners.collect::<String>());
    }
    text.into_bytes()
}

fn off(faces: &[Vec<u32>]) -> Vec<u8> {
    let mut text = format!("OFF 8 {} 0\n", faces.len());
    for [x, y, z] in CUBE {
        text += &format!("{x} {y} {z}\n");
    }
    for face in faces {
        let corners = face.iter().map(|v| format!(" {v}"));
        text += &format!("{}{}\n", face.len(), corners.collect::<String>());
    }
    text.into_bytes()
}

fn ply(faces: &[Vec<u32>], form: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {form} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty \
         float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        faces.len()
    )
    .into_bytes();
    if form == "ascii" {
        let text = String::from_utf8(off(faces)).expect("text");
        let (_, body) = text.split_once('\n').expect("a header");
        bytes.extend(body.bytes());
        return bytes;
    }
    let is_big = form == "binary_big_endian";
    let number = |bytes: &mut Vec<u8>, number: u32| match is_big {
        true => bytes.extend(number.to_be_bytes()),
        false => bytes.extend(number.to_le_bytes()),
    };
    for x in CUBE.iter().flatten() {
        number(&mut bytes, (*x as f32).to_bits());
    }
    for face in faces {
        bytes.push(face.len() as u8);
        face.iter().for_each(|&v| number(&mut bytes, v));
    }
    bytes
}

/// Returns the cube in each format that has polygons.
fn files(faces: &[Vec<u32>]) -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a.obj", obj(faces)),
        ("a.off", off(faces)),
        ("ascii.ply", ply(faces, "ascii")),
        ("little.ply", ply(faces, "binary_little_endian")),
        ("big.ply", ply(faces, "binary_big_endian")),
    ]
}

fn read(name: &str, bytes: &[u8]) -> FileMesh {
    let mesh = read_from(name, bytes, &ReadOptions::default());
    mesh.unwrap_or_else(|error| panic!("{error}"))
}

/// Returns how many repeated corners the notices count.
fn repeats(mesh: &FileMesh) -> u64 {
    let kind = IgnoredKind::RepeatedCorners;
    let notices = mesh.notices.iter().filter(|notice| notice.kind == kind);
    notices.map(|notice| notice.count).sum()
}

#[test]
fn a_cube_with_repeated_corners_is_a_cube() {
    let plain = files(&faces(0, FACES[0]));
    for (number, face, count) in REPEATS {
        for ((name, bytes), (_, plain)) in files(&faces(number, face)).iter().zip(&plain) {
            let (mesh, plain) = (read(name, bytes), read(name, plain));
            assert_eq!(repeats(&mesh), count, "{name} {face:?}");
            assert_eq!(repeats(&plain), 0, "{name}");
            let kept = mesh.faces.face(FaceId::new(number as u32)).to_vec();
            assert_eq!(kept.len(), 4, "{name} {face:?}");
            let facts = mesh.facts();
            assert_eq!(facts, plain.facts(), "{name} {face:?}");
            assert_eq!((facts.edges, facts.genus), (12, Some(0)), "{name}");
            let (polygons, left_out) = mesh.into_polygons();
            assert_eq!(left_out, [], "{name}");
            assert_eq!(Facts::from_polygons(&polygons), facts, "{name}");
        }
    }
}

#[test]
fn the_notice_names_the_place() {
    let places = [
        ("a.obj", Place::Line(11)),
        ("a.off", Place::Line(12)),
        ("ascii.ply", Place::Line(20)),
    ];
    let (number, face, _) = REPEATS[0];
    for (name, bytes) in files(&faces(number, face)) {
        let mesh = read(name, &bytes);
        let found = mesh.notices.iter();
        let found = found.filter(|notice| notice.kind == IgnoredKind::RepeatedCorners);
        let found: Vec<_> = found.collect();
        let last = bytes.len() as u64 - 3 * 17;
        let expected = places.iter().find(|(other, _)| *other == name);
        let expected = expected.map_or(Place::Byte(last - 21), |&(_, place)| place);
        assert_eq!(found[0].first, expected, "{name}");
        let message = format!("ignored 1 repeated corner of a face ({expected})");
        assert_eq!(found[0].to_string(), message);
        // The faces after it keep their places.
        let place = mesh.face_place(FaceId::new(3));
        let (polygons, _, places) = mesh.into_polygons_with_places();
        assert_eq!(places.place(FaceId::new(3), &polygons), place, "{name}");
        match expected {
            Place::Line(line) => assert_eq!(place, Place::Line(line + 1), "{name}"),
            _ => assert_eq!(place, Place::Byte(last), "{name}"),
        }
    }
}

#[test]
fn faces_with_too_few_corners_and_other_repeats_are_left_out() {
    // Folded to an edge or a point; a spike.
    for (face, vertex) in [
        (&[0, 1, 1][..], 1),
        (&[0, 0, 1, 1], 0),
        (&[2; 6], 2),
        (&[0, 1, 2, 1], 1),
    ] {
        let mut all = faces(0, FACES[0]);
        all.push(face.to_vec());
        for (name, bytes) in files(&all) {
            let mesh = read(name, &bytes);
            assert_eq!(
                (repeats(&mesh), mesh.faces.len()),
                (0, 7),
                "{name} {face:?}"
            );
            assert!(mesh.has_degenerate_faces());
            let facts = mesh.facts();
            assert_eq!(
                (facts.faces, facts.degenerate_faces),
                (6, 1),
                "{name} {face:?}"
            );
            assert_eq!((facts.edges, facts.euler_characteristic), (12, 2), "{name}");
            let (polygons, left_out) = mesh.into_polygons();
            assert_eq!(
                (polygons.face_count(), left_out.len()),
                (6, 1),
                "{name} {face:?}"
            );
            let first = u32::from(name == "a.obj");
            let expected = LeftOutReason::RepeatedVertex(vertex + first);
            assert_eq!(left_out[0].reason, expected, "{name} {face:?}");
            let expected: Vec<u32> = face.iter().map(|v| v + first).collect();
            assert_eq!(left_out[0].vertices, expected, "as in the file");
        }
    }
}

/// A bow-tie whose vertex 2 also begins a triangle.
#[test]
fn a_crossing_polygon_loses_its_repeats_and_is_left_out() {
    let text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 3 0 0\nv 3 1 0\nf 1 2 5 5 6 2 4 3 3\n";
    let mesh = read("a.obj", text.as_bytes());
    assert_eq!(repeats(&mesh), 2);
    let (_, left_out) = mesh.into_polygons();
    let message = "line 7: face 1 2 5 6 2 4 3 names vertex 2 twice";
    assert_eq!(left_out[0].to_string(), message);
}

#[test]
fn corners_that_welding_joins_are_repeats() {
    let welding = ReadOptions::default().with_welding(Welding::All);
    // Vertices 2 and 3 have the same position, and 0 and 4: two repeats, and one at the end.
    let vertices = "0 0 0\n1 0 0\n1 1 0\n1 1 0\n0 0 0\n0 1 0\n";
    let faces = "5 0 1 2 3 5\n5 0 1 2 5 4\n4 0 1 2 3\n3 0 1 4\n4 2 3 2 3\n";
    let text = format!("OFF 6 5 0\n{vertices}{faces}");
    let mesh = read_from("a.off", text.as_bytes(), &welding).expect("valid");
    let found: Vec<usize> = mesh.faces.iter().map(|(_, face)| face.len()).collect();
    assert_eq!(found, [4, 4, 3, 3, 4]);
    let notices: Vec<String> = mesh.notices.iter().map(ToString::to_string).collect();
    assert_eq!(
        notices,
        ["ignored 3 repeated corners of faces (first at line 8)"]
    );
    let facts = mesh.facts();
    assert_eq!((facts.faces, facts.degenerate_faces), (3, 2));
    let (_, left_out) = mesh.into_polygons();
    let left_out: Vec<String> = left_out.iter().map(ToString::to_string).collect();
    assert_eq!(
        left_out,
        [
            "line 11: face 0 1 0 names vertex 0 twice",
            "line 12: face 2 2 2 2 names vertex 2 twice",
        ]
    );
}

#[test]
fn places_in_binary_files_survive_welding() {
    // All corners of the first face but three are one point after welding.
    let mut bytes = ply(&faces(0, FACES[0]), "binary_little_endian");
    let start = bytes.len() - 6 * 17 - 8 * 12;
    let first: [u8; 12] = bytes[start..start + 12].try_into().expect("a vertex");
    bytes[start + 12..start + 24].copy_from_slice(&first);
    let plain = read("a.ply", &bytes);
    let welding = ReadOptions::default().with_welding(Welding::All);
    let mesh = read_from("a.ply", bytes.as_slice(), &welding).expect("valid");
    assert_eq!((repeats(&mesh), mesh.welded_vertices), (2, 1));
    for (f, _) in plain.faces.iter() {
        assert_eq!(mesh.face_place(f), plain.face_place(f), "{f}");
    }
}

#[test]
fn facets_of_stl_that_weld_to_an_edge_are_left_out() {
    let facet = |corners: &str| format!("facet\nouter loop\n{corners}endloop\nendfacet\n");
    let text = format!(
        "solid\n{}{}endsolid\n",
        facet("vertex 0 0 0\nvertex 1 0 0\nvertex 1 -0 0\n"),
        facet("vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"),
    );
    let mesh = read("a.stl", text.as_bytes());
    assert_eq!(repeats(&mesh), 0);
    let facts = mesh.facts();
    assert_eq!(
        (facts.faces, facts.degenerate_faces, facts.edges),
        (1, 1, 3)
    );
    let (_, left_out) = mesh.into_polygons();
    assert_eq!(
        left_out[0].to_string(),
        "line 2: face 0 1 1 names vertex 1 twice"
    );
}

/// An outer square of side 3 and a hole of side 1: the outline runs along the bridge from 0 to 4 twice.
/// Two squares that meet in vertex 2. Two triangles that meet in vertex 0, with sides on common lines. A square with a spike from vertex 1 to 3.
#[test]
fn polygons_that_touch_themselves_in_a_vertex_are_cut() {
    let keyhole = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\n\
        f 1 2 3 4 1 5 6 7 8 5\nf 1 4 3 2\n";
    let squares = "f 1 2 3 4 5 6 3 7\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\n\
        v 1 2 0\nv 0 1 0\n";
    let spike = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 -1 0\nf 1 2 4 2 3\nf 1 3 2\n";
    let hourglass = "f 1 2 3 1 4 5\nf 1 3 2\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\n";
    for (text, triangles, area) in [
        (keyhole, 8, 8.0),
        (squares, 4, 2.0),
        (hourglass, 2, 1.0),
        (spike, 1, 0.5),
    ] {
        let mesh = read("a.obj", text.as_bytes());
        assert_eq!(mesh.facts().degenerate_faces, 0);
        let line = 1 + text
            .lines()
            .position(|line| line.starts_with('f'))
            .expect("a face");
        let message = format!(
            "cut 1 face that names a vertex twice (line {line}): the triangles have the same area"
        );
        assert_eq!(mesh.notices[0].to_string(), message);
        let (polygons, left_out, places) = mesh.into_polygons_with_places();
        assert_eq!(
            (polygons.face_count(), left_out),
            (triangles + 1, Vec::new())
        );
        let mut sum = 0.0;
        for (f, face) in polygons.faces().iter().take(triangles) {
            let [a, b, c] = [0, 1, 2].map(|i| polygons.position(face[i]));
            let part = 0.5 * (b - a).cross(c - a).z;
            assert!(part > 0.0, "{f} is turned");
            sum += part;
            assert_eq!(places.place(f, &polygons), Place::Line(line as u32));
        }
        assert_eq!(sum, area);
        let last = FaceId::new(triangles as u32);
        assert_eq!(places.place(last, &polygons), Place::Line(line as u32 + 1));
    }
}

/// The same in binary records, where places are computed.
#[test]
fn places_in_binary_files_survive_cuts() {
    let mut all = faces(0, FACES[0]);
    // A spike along the edge of vertices 5 and 1.
    all[1] = vec![4, 5, 1, 5, 6, 7];
    let bytes = ply(&all, "binary_little_endian");
    let mesh = read("a.ply", &bytes);
    assert_eq!(mesh.notices[0].kind, IgnoredKind::CutFaces);
    let start = (bytes.len() - 6 * 17 - 8) as u64;
    assert_eq!(mesh.notices[0].first, Place::Byte(start + 17));
    let last = FaceId::new(mesh.faces.len() as u32 - 1);
    assert_eq!(mesh.face_place(last), Place::Byte(bytes.len() as u64 - 17));
    assert_eq!(mesh.face_place(FaceId::new(0)), Place::Byte(start));
    let (polygons, left_out) = mesh.into_polygons();
    assert_eq!((polygons.face_count(), left_out.len()), (6, 0));
}

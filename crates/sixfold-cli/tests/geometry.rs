//! What commands do to the geometry of meshes: areas and volumes that are known, in every format.

use serde_json::Value;

use crate::json_csv::parsed;
use crate::run::{Run, Sixfold, TETRAHEDRON};

/// An L of area 5.
const L: &str = "v 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 0\nf 1 2 3 4 5 6\n";

/// Two squares that meet in a point, a square with a spike, and a square with a hole of side 1.
const TOUCHING: [(&str, f64); 3] = [
    ("0 0,1 0,1 1,2 1,2 2,1 2,1 1,0 1", 2.0),
    ("0 0,4 0,4 2,2 2,2 5,2 2,0 2", 8.0),
    ("0 0,3 0,3 3,0 3,0 0,1 1,1 2,2 2,2 1,1 1", 8.0),
];

impl Sixfold {
    fn passes(&self, arguments: &[&str]) -> Run {
        let run = self.run(arguments);
        assert_eq!(run.code, Some(0), "{arguments:?} {run:?}");
        run
    }

    fn measures(&self, mesh: &str) -> Value {
        let run = self.passes(&["inspect", mesh, "--json", "-"]);
        parsed(&run.stdout)["measures"].clone()
    }

    fn area(&self, mesh: &str) -> f64 {
        self.measures(mesh)["area"].as_f64().expect("an area")
    }

    fn volume(&self, mesh: &str) -> f64 {
        self.measures(mesh)["volume"].as_f64().expect("a volume")
    }
}

/// Returns a mesh of one polygon.
fn polygon(corners: &str) -> String {
    let corners: Vec<&str> = corners.split(',').collect();
    let vertices: String = corners.iter().map(|at| format!("v {at} 0\n")).collect();
    let numbers: String = (1..=corners.len()).map(|v| format!(" {v}")).collect();
    format!("{vertices}f{numbers}\n")
}

/// Returns the lines of a box from `-half` to `half` as OBJ. `first` is the number of the first vertex.
fn cuboid(half: f64, first: usize, is_inward: bool) -> String {
    let mut text = String::new();
    for i in 0..8 {
        let at = |bit: usize| if i >> bit & 1 == 1 { half } else { -half };
        text += &format!("v {} {} {}\n", at(0), at(1), at(2));
    }
    for mut face in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        if is_inward {
            face.reverse();
        }
        let corners: String = face.iter().map(|v| format!(" {}", v + first)).collect();
        text += &format!("f{corners}\n");
    }
    text
}

#[test]
fn polygons_keep_their_area_in_every_format() {
    let sixfold = Sixfold::new();
    let mut meshes = vec![("l.obj".to_owned(), 5.0)];
    sixfold.file("l.obj", L);
    for (i, (corners, area)) in TOUCHING.into_iter().enumerate() {
        let name = format!("touching{i}.obj");
        sixfold.file(&name, &polygon(corners));
        meshes.push((name, area));
    }
    for (mesh, area) in &meshes {
        for format in [
            "stl",
            "stl-ascii",
            "ply",
            "ply-ascii",
            "off",
            "gltf",
            "glb",
            "obj",
        ] {
            sixfold.passes(&["convert", mesh, "--format", format, "-o", "out"]);
            // The area of a polygon that touches itself is that of its outline.
            let found = sixfold.area("out");
            assert!((found - area).abs() < 1e-6, "{mesh} as {format}: {found}");
        }
        sixfold.passes(&["triangulate", mesh, "-o", "cut.obj"]);
        sixfold.passes(&["repair", mesh, "--weld", "-o", "welded.obj"]);
        for out in ["cut.obj", "welded.obj"] {
            let found = sixfold.area(out);
            assert!((found - area).abs() < 1e-6, "{mesh} {out}: {found}");
        }
        let run = sixfold.passes(&["distance", mesh, "cut.obj", "--json", "-"]);
        for side in parsed(&run.stdout)["distances"].as_array().expect("a list") {
            assert!(
                side["largest"].as_f64().expect("a distance") < 1e-12,
                "{side}"
            );
        }
    }
}

#[test]
fn polygons_that_cross_themselves_are_named_with_their_line() {
    let sixfold = Sixfold::new();
    // A bow-tie, and a pentagon that winds twice around some points.
    for corners in ["0 0,1 1,1 0,0 1", "1 -1,-1 3,3 2,1 -3,0 3"] {
        sixfold.file("cross.obj", &polygon(corners));
        let line = corners.split(',').count() + 1;
        for arguments in [
            &["convert", "cross.obj", "-o", "out.stl"][..],
            &["triangulate", "cross.obj", "-o", "out.obj"],
            &["distance", "cross.obj", "cross.obj"],
            &["inspect", "cross.obj", "--triangulate"],
            &["convert", "cross.obj", "-o", "out.ply"],
            &["repair", "cross.obj", "--triangulate", "-o", "out.off"],
            &["repair", "cross.obj", "--flat", "-o", "out.off"],
            &[
                "repair",
                "cross.obj",
                "--for",
                "corner-table",
                "-o",
                "out.off",
            ],
        ] {
            let run = sixfold.passes(arguments);
            let named = ["crosses itself", &format!("line {line}")];
            let is_named = |text: &String| named.iter().all(|name| text.contains(name));
            assert!(is_named(&run.stderr), "{arguments:?} {run:?}");
            let meshes = arguments.iter().filter(|word| **word == "cross.obj");
            assert_eq!(
                run.stderr.matches("crosses itself").count(),
                meshes.count(),
                "{run:?}"
            );
        }
        let run = sixfold.passes(&["render", "cross.obj", "-o", "out.svg"]);
        assert!(run.stderr.contains("crosses itself"), "{run:?}");
        let run = sixfold.passes(&["inspect", "cross.obj"]);
        assert!(run.stdout.contains("1 face that crosses itself"), "{run:?}");
        assert!(!run.stdout.contains("without area"), "{run:?}");
    }
}

#[test]
fn triangles_keep_the_area_of_polygons_that_are_not_planar() {
    let sixfold = Sixfold::new();
    let saddle = "v 0 0 0\nv 1 0 1\nv 1 1 0\nv 0 1 1\nf 1 2 3 4\n";
    sixfold.file("saddle.obj", saddle);
    sixfold.passes(&["triangulate", "saddle.obj", "-o", "out.obj"]);
    for mesh in ["saddle.obj", "out.obj"] {
        assert!((sixfold.area(mesh) - 3_f64.sqrt()).abs() < 1e-12, "{mesh}");
    }
    // The saddle has no outside.
    let run = sixfold.passes(&["inspect", "saddle.obj"]);
    assert!(!run.stdout.contains("turned"), "{run:?}");
    let repair = [
        "repair",
        "saddle.obj",
        "--orient",
        "outward",
        "-o",
        "out.obj",
    ];
    let run = sixfold.passes(&repair);
    assert!(run.stderr.contains("outside is not known"), "{run:?}");
}

#[test]
fn cavities_keep_their_volume() {
    let sixfold = Sixfold::new();
    for is_inward in [true, false] {
        let boxes = cuboid(5.0, 1, false) + &cuboid(2.0, 9, is_inward);
        sixfold.file("boxes.obj", &boxes);
        let run = sixfold.passes(&["inspect", "boxes.obj"]);
        assert_eq!(run.stdout.contains("faces turned"), !is_inward, "{run:?}");
        sixfold.passes(&[
            "repair",
            "boxes.obj",
            "--orient",
            "outward",
            "-o",
            "out.obj",
        ]);
        assert!((sixfold.volume("out.obj") - 936.0).abs() < 1e-9);
    }
}

/// The facets of a sphere disagree by a little: the command that is advised closes the mesh.
#[test]
fn cracks_are_welded_as_advised() {
    let sixfold = Sixfold::new();
    sixfold.passes(&["generate", "geodesic", "frequency=4", "-o", "ball.obj"]);
    let text = std::fs::read_to_string(sixfold.folder().join("ball.obj")).expect("a file");
    let rows = |kind: &'static str| {
        let lines = text.lines().filter(move |line| line.starts_with(kind));
        lines.map(|line| line[2..].split(' ').map(str::to_owned).collect::<Vec<_>>())
    };
    let positions: Vec<Vec<f64>> = rows("v ")
        .map(|row| row.iter().map(|x| x.parse().expect("a number")).collect())
        .collect();
    let (mut cracked, mut corners) = (String::new(), 0_usize);
    let mut faces = String::new();
    for row in rows("f ") {
        faces += "f";
        for vertex in row {
            let at = &positions[vertex.parse::<usize>().expect("a number") - 1];
            corners += 1;
            // At most 1e-5 away, in directions that differ.
            let shift = |i: usize| ((corners * (7 + i) % 11) as f64 / 11.0 - 0.5) * 1e-5;
            let [x, y, z] = [0, 1, 2].map(|i| at[i] + shift(i));
            cracked += &format!("v {x} {y} {z}\n");
            faces += &format!(" {corners}");
        }
        faces += "\n";
    }
    sixfold.file("cracked.obj", &(cracked + &faces));
    let run = sixfold.passes(&["inspect", "cracked.obj"]);
    let advice = run
        .stdout
        .split_whitespace()
        .find(|word| word.starts_with("--weld="));
    let advice = advice.unwrap_or_else(|| panic!("no advice: {run:?}"));
    sixfold.passes(&["repair", "cracked.obj", advice, "-o", "out.obj"]);
    let facts = parsed(
        &sixfold
            .passes(&["inspect", "out.obj", "--json", "-"])
            .stdout,
    );
    assert_eq!(facts["mesh"]["closed"], true);
    assert_eq!(facts["mesh"]["faces"], 20 * 16);
    let (before, after) = (sixfold.volume("ball.obj"), sixfold.volume("out.obj"));
    assert!((before - after).abs() < 1e-4 * before, "{before} {after}");
}

/// Two squares beside each other, the second one turned over.
#[test]
fn cracks_between_edges_in_the_same_direction_are_closed() {
    let sixfold = Sixfold::new();
    let squares = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1.01 0 0\nv 2 0 0\nv 2 1 0\nv 1.01 1 0\n\
                   f 1 2 3 4\nf 8 7 6 5\n";
    sixfold.file("squares.obj", squares);
    let run = sixfold.passes(&["inspect", "squares.obj"]);
    let advice = "2 of them nearly meet: closed by --weld=0.01 --orient outward;";
    assert!(run.stdout.contains(advice), "{run:?}");
    let options = ["--weld=0.01", "--orient", "outward", "-o", "out.obj"];
    sixfold.passes(&[&["repair", "squares.obj"], &options[..]].concat());
    let run = sixfold.passes(&["inspect", "out.obj", "--json", "-"]);
    let facts = parsed(&run.stdout);
    assert_eq!(facts["mesh"]["boundary_edges"], 6);
    assert_eq!(facts["mesh"]["consistently_oriented"], true);
}

/// A box with a face without area, which is needed to keep it closed.
/// Two parallel sheets and a crack beside a thin plate: welding would destroy them.
#[test]
fn a_weld_that_would_harm_other_parts_is_not_advised() {
    let sixfold = Sixfold::new();
    let mut sheets = String::new();
    for z in [0.0, 0.01] {
        for (x, y) in [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)] {
            sheets += &format!("v {x} {y} {z}\n");
        }
    }
    sheets += "f 1 2 5 4\nf 2 3 6 5\nf 10 11 8 7\nf 11 12 9 8\n";
    sixfold.file("sheets.obj", &sheets);
    let run = sixfold.passes(&["inspect", "sheets.obj"]);
    let text = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("nearly meet, but --weld=0.01, which closes them, would"),
        "{run:?}"
    );
    let has_advice = ["repair: --weld", "--fill-holes"].map(|advice| text.contains(advice));
    assert_eq!(has_advice, [false; 2], "{run:?}");
    let run = sixfold.passes(&["inspect", "sheets.obj", "--json", "-"]);
    let crack = &parsed(&run.stdout)["diagnosis"]["crack"];
    assert!(
        crack["repair"].is_null() && crack["collapsed_faces"] == 2,
        "{crack}"
    );
}

#[test]
fn removing_faces_without_area_opens_nothing() {
    let sixfold = Sixfold::new();
    let boxed = cuboid(1.0, 1, false).replace("f 1 2 6 5", "f 1 2 6\nf 1 6 5\nf 1 9 2");
    let boxed = "v 9 9 9\n".replace("9 9 9", "-1 -1 -1") + &boxed;
    // The vertices are one later now, and the last one is the middle of the edge from 2 to 3.
    let renumbered: String = boxed
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(face) => {
                let corners = face
                    .split(' ')
                    .map(|v| v.parse::<usize>().expect("a number") + 1);
                format!(
                    "f{}\n",
                    corners.map(|v| format!(" {v}")).collect::<String>()
                )
            }
            None => format!("{line}\n"),
        })
        .collect();
    let mesh = renumbered.replace("f 2 4 5 3", "f 2 4 5 3 10");
    let mesh = mesh.replacen("f 2", "v 0 -1 -1\nf 2", 1);
    sixfold.file("box.obj", &mesh);
    assert!((sixfold.volume("box.obj") - 8.0).abs() < 1e-12);
    let run = sixfold.passes(&["repair", "box.obj", "--flat", "--isolated", "-o", "out.obj"]);
    let facts = parsed(
        &sixfold
            .passes(&["inspect", "out.obj", "--json", "-"])
            .stdout,
    );
    assert_eq!(facts["mesh"]["closed"], true, "{run:?}");
    assert_eq!(facts["mesh"]["faces"], 8);
    assert!((sixfold.volume("out.obj") - 8.0).abs() < 1e-12);
}

#[test]
fn seams_stay_closed() {
    let sixfold = Sixfold::new();
    sixfold.passes(&["generate", "geodesic", "frequency=6", "-o", "ball.obj"]);
    // Facets of STL have no common vertices; --as-stored keeps them apart in the glTF file.
    sixfold.passes(&["convert", "ball.obj", "-o", "ball.stl"]);
    sixfold.passes(&["convert", "ball.stl", "--as-stored", "-o", "seams.glb"]);
    let closed = |mesh: &str| {
        let facts = parsed(&sixfold.passes(&["inspect", mesh, "--json", "-"]).stdout);
        facts["mesh"]["closed"] == true
    };
    assert!(!closed("seams.glb"));
    for command in [
        &["decimate", "--ratio", "0.3"][..],
        &["smooth"],
        &["subdivide", "--scheme", "loop"],
        &["remesh"],
        &["dual"],
    ] {
        let run = sixfold.passes(&[command, &["seams.glb", "-o", "out.obj"]].concat());
        assert!(
            run.stderr.contains("seam") || run.stderr.contains("joined"),
            "{run:?}"
        );
        assert!(closed("out.obj"), "{command:?}");
    }
    let run = sixfold.run(&["dual", "seams.glb", "--as-stored", "-o", "out.obj"]);
    assert_eq!(run.code, Some(3), "{run:?}");
    assert!(run.stderr.contains("sixfold repair --weld"), "{run:?}");
}

#[test]
fn scenes_of_gltf_are_chosen() {
    let sixfold = Sixfold::new();
    let triangle = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let document = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0,
        "scenes": [{{"nodes": [0]}}, {{"nodes": [1, 2]}}],
        "nodes": [{{"mesh": 0}}, {{"mesh": 0}}, {{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "buffers": [{{"byteLength": 36, "uri": "data:;base64,{triangle}"}}]}}"#
    );
    sixfold.file("scenes.gltf", &document);
    let faces = |options: &[&str]| {
        let run = sixfold.passes(&[&["inspect", "scenes.gltf", "--json", "-"], options].concat());
        (parsed(&run.stdout)["mesh"]["faces"].clone(), run.stderr)
    };
    let (count, notes) = faces(&[]);
    assert_eq!(count, 1);
    assert!(
        notes.contains("2 nodes with meshes outside the scene"),
        "{notes}"
    );
    assert!(notes.contains("--scene all reads them"), "{notes}");
    assert_eq!(faces(&["--scene", "1"]).0, 2);
    let (count, notes) = faces(&["--scene", "all"]);
    assert_eq!(count, 3);
    assert!(!notes.contains("scene"), "{notes}");
    sixfold.file("a.obj", TETRAHEDRON);
    for (mesh, scene, message) in [
        ("scenes.gltf", "2", "scene 2: no such scene: the file has 2"),
        ("scenes.gltf", "-1", "from 0, or all"),
        (
            "a.obj",
            "0",
            "a.obj: there is no scene 0: only glTF has scenes",
        ),
    ] {
        let scene = format!("--scene={scene}");
        let run = sixfold.run(&["inspect", mesh, &scene]);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
    }
    sixfold.passes(&["inspect", "a.obj", "--scene", "all"]);
}

/// Two closed boxes side by side whose edges along z have vertices at the same positions.
#[test]
fn edges_that_welding_makes_non_manifold_are_named() {
    let sixfold = Sixfold::new();
    let shifted = |text: String| {
        let lines = text.lines().map(|line| match line.strip_prefix("v ") {
            Some(at) => {
                let at: Vec<f64> = at.split(' ').map(|x| x.parse().expect("x")).collect();
                format!("v {} {} {}\n", at[0] + 2.0, at[1] + 2.0, at[2])
            }
            None => format!("{line}\n"),
        });
        lines.collect::<String>()
    };
    let boxes = cuboid(1.0, 1, false) + &shifted(cuboid(1.0, 9, false));
    sixfold.file("boxes.obj", &boxes);
    let run = sixfold.passes(&["repair", "boxes.obj", "--weld", "-o", "out.obj"]);
    let warning = "out.obj: 1 edge has three or more faces, 0 before the repair";
    assert!(run.stderr.contains(warning), "{run:?}");
    let run = sixfold.passes(&["repair", "boxes.obj", "--weld", "--cut", "-o", "out.obj"]);
    assert!(!run.stderr.contains("three or more faces"), "{run:?}");
}

#[test]
fn a_shape_that_is_destroyed_is_reported() {
    let sixfold = Sixfold::new();
    sixfold.passes(&["generate", "geodesic", "frequency=6", "-o", "ball.obj"]);
    let remesh = ["remesh", "--edge-length", "5", "ball.obj", "-o", "out.obj"];
    let run = sixfold.passes(&remesh);
    assert!(run.stderr.contains("the shape has changed"), "{run:?}");
    let run = sixfold.run(&[&remesh[..], &["--check"]].concat());
    assert_eq!(run.code, Some(1), "{run:?}");
    let gentle = [
        "smooth",
        "--iterations",
        "1",
        "ball.obj",
        "-o",
        "out.obj",
        "--check",
    ];
    assert!(
        !sixfold
            .passes(&gentle)
            .stderr
            .contains("the shape has changed")
    );
}

#[test]
fn results_without_a_face_have_exit_code_1() {
    let sixfold = Sixfold::new();
    sixfold.file("l.obj", L);
    sixfold.file("line.obj", "v 0 0 0\nv 1 0 0\nf 1 2 1\n");
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    sixfold.passes(&["convert", "points.obj", "-o", "out.ply"]);
    for arguments in [
        &["repair", "l.obj", "--components", "5", "-o", "out.obj"][..],
        &["repair", "l.obj", "--weld=9", "-o", "out.obj"],
        &["subdivide", "l.obj", "--boundary", "none", "-o", "out.obj"],
        &["convert", "line.obj", "-o", "out.ply"],
        &["convert", "points.obj", "-o", "out.stl"],
        &["triangulate", "line.obj", "-o", "out.obj"],
        &["smooth", "line.obj", "-o", "out.obj"],
        &["subdivide", "line.obj", "-o", "out.obj"],
        &["decimate", "line.obj", "--ratio", "0.5", "-o", "out.obj"],
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(1), "{arguments:?} {run:?}");
        assert!(run.stderr.contains("no face"), "{arguments:?} {run:?}");
    }
}

/// Coordinates of a projected map: two triangles, one metre apart.
#[test]
fn far_meshes_keep_their_place_and_distance() {
    let sixfold = Sixfold::new();
    let far = |dx: f64| {
        let vertices = [(0.0, 0.0), (7.25, 0.5), (3.0, 9.125)];
        let vertices =
            vertices.map(|(x, y)| format!("v {} {} 31.5\n", 500_000.1 + x + dx, 4_649_776.3 + y));
        vertices.concat() + "f 1 2 3\n"
    };
    sixfold.file("a.obj", &far(0.0));
    sixfold.file("b.obj", &far(1.0));
    let run = sixfold.passes(&["distance", "a.obj", "b.obj", "--recentre", "--json", "-"]);
    let largest = parsed(&run.stdout)["distances"][0]["largest"].as_f64();
    assert!((largest.expect("a distance") - 1.0).abs() < 1e-6, "{run:?}");
    for format in ["obj", "ply", "ply-ascii", "off", "glb", "gltf", "stl-ascii"] {
        sixfold.passes(&[
            "convert",
            "a.obj",
            "--recentre",
            "--format",
            format,
            "-o",
            "out",
        ]);
        let run = sixfold.passes(&["distance", "a.obj", "out", "--recentre", "--json", "-"]);
        let largest = parsed(&run.stdout)["distances"][0]["largest"].as_f64();
        assert!(largest.expect("a distance") < 1e-6, "{format} {run:?}");
    }
    let run = sixfold.passes(&["convert", "a.obj", "--recentre", "-o", "out.stl"]);
    let moved = "rounding to 32 bits merged no positions and moved coordinates by up to";
    assert!(run.stderr.contains(moved), "{run:?}");
    let very_far = far(0.0).replace("v 50000", "v 50000000000");
    sixfold.file("far.obj", &very_far.replace(" 46497", " 46497000000"));
    let run = sixfold.passes(&["convert", "far.obj", "--recentre", "-o", "out.stl"]);
    assert!(
        run.stderr
            .contains("rounding to 32 bits merged 2 positions"),
        "{run:?}"
    );
}

/// Options and figures are in the coordinates of the file, also if the mesh is moved.
#[test]
fn places_are_those_of_the_file() {
    let sixfold = Sixfold::new();
    let mut grid = String::new();
    for y in 0..3 {
        for x in 0..3 {
            grid += &format!("v {} {} 7\n", 500_000 + x, 5_400_000 + y);
        }
    }
    for corner in [1, 2, 4, 5] {
        grid += &format!("f {corner} {} {}\n", corner + 1, corner + 4);
        grid += &format!("f {corner} {} {}\n", corner + 4, corner + 3);
    }
    sixfold.file("grid.obj", &grid);
    let run = sixfold.passes(&["inspect", "grid.obj", "--recentre"]);
    assert!(
        run.stdout
            .contains("from 500000 5400000 7 to 500002 5400002 7"),
        "{run:?}"
    );
    let run = sixfold.passes(&["inspect", "grid.obj", "--recentre", "--json", "-"]);
    let low = parsed(&run.stdout)["measures"]["bounds"][0].clone();
    assert_eq!(low, serde_json::json!([500_000.0, 5_400_000.0, 7.0]));
    let run = sixfold.passes(&[
        "distance",
        "grid.obj",
        "grid.obj",
        "--recentre",
        "--json",
        "-",
    ]);
    let at = &parsed(&run.stdout)["distances"][0]["farthest"];
    assert!(at[1].as_f64().expect("a number") >= 5_400_000.0, "{at}");
    let select = "box:499999.5,5399999.5,0,500000.2,5400000.2,9";
    for recentre in [&[][..], &["--recentre"]] {
        let refine = [
            "subdivide",
            "grid.obj",
            "--scheme",
            "midpoint",
            "-o",
            "out.obj",
        ];
        let run = sixfold.passes(&[&refine, &["--select", select][..], recentre].concat());
        assert!(run.stdout.contains("16 faces"), "{run:?}");
    }
}

/// A cube with sharp edges stays a cube, level after level.
#[test]
fn sharpness_that_remains_is_written() {
    let sixfold = Sixfold::new();
    let mut cube = cuboid(1.0, 1, false);
    for [a, b] in [
        [1, 2],
        [3, 4],
        [5, 6],
        [7, 8],
        [1, 3],
        [2, 4],
        [5, 7],
        [6, 8],
        [1, 5],
        [2, 6],
        [3, 7],
        [4, 8],
    ] {
        cube += &format!("t crease 2/1/0 {} {} inf\n", a - 1, b - 1);
    }
    for v in 0..8 {
        cube += &format!("t corner 1/1/0 {v} inf\n");
    }
    sixfold.file("cube.obj", &cube);
    sixfold.passes(&["subdivide", "cube.obj", "-o", "one.obj"]);
    sixfold.passes(&["subdivide", "one.obj", "-o", "two.obj"]);
    assert!((sixfold.volume("two.obj") - 8.0).abs() < 1e-9);
    let run = sixfold.passes(&["subdivide", "cube.obj", "-o", "one.ply"]);
    assert!(run.stderr.contains("sharpness of"), "{run:?}");
}

#[test]
fn parts_that_touch_are_named() {
    let sixfold = Sixfold::new();
    let crossing = cuboid(1.0, 1, false) + &cuboid(1.0, 9, false).replace("v 1 ", "v 3 ");
    sixfold.file("crossing.obj", &crossing);
    let run = sixfold.passes(&["inspect", "crossing.obj"]);
    assert!(
        run.stdout
            .contains("2 closed parts that touch or cross others"),
        "{run:?}"
    );
    sixfold.file("one.obj", &cuboid(1.0, 1, false));
    let run = sixfold.passes(&["inspect", "one.obj"]);
    assert!(!run.stdout.contains("touch"), "{run:?}");
}

#[test]
fn decimation_stops_before_a_distance() {
    let sixfold = Sixfold::new();
    sixfold.passes(&["generate", "geodesic", "frequency=16", "-o", "ball.obj"]);
    let mut faces = 20 * 16 * 16;
    for limit in ["0.005", "0.02", "0.1"] {
        sixfold.passes(&[
            "decimate",
            "--max-error",
            limit,
            "ball.obj",
            "-o",
            "out.obj",
        ]);
        let run = sixfold.passes(&["distance", "ball.obj", "out.obj", "--json", "-"]);
        let limit: f64 = limit.parse().expect("a number");
        for side in parsed(&run.stdout)["distances"].as_array().expect("a list") {
            let largest = side["largest"].as_f64().expect("a distance");
            assert!(largest <= limit, "{largest} of {limit}");
        }
        let facts = parsed(
            &sixfold
                .passes(&["inspect", "out.obj", "--json", "-"])
                .stdout,
        );
        let left = facts["mesh"]["faces"].as_u64().expect("a number");
        assert!(left < faces / 2, "{left} at {limit}");
        faces = left;
    }
    let both = [
        "decimate",
        "--max-error",
        "0.01",
        "--faces",
        "4",
        "ball.obj",
        "-o",
        "out.obj",
    ];
    assert!(sixfold.passes(&both).stderr.contains("exceed the distance"));
    let wrong = ["decimate", "--max-error", "-1", "ball.obj", "-o", "out.obj"];
    assert_eq!(sixfold.run(&wrong).code, Some(2));
}

//! Every format, from files, folders and standard input.

use std::fs::File;
use std::process::Stdio;

use crate::obj::Obj;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// The endings of mesh files.
const ENDINGS: [&str; 6] = ["obj", "stl", "ply", "off", "gltf", "glb"];

#[test]
fn commands_read_and_write_every_format() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    for ending in ENDINGS {
        let (there, back) = (format!("there.{ending}"), format!("back {ending}.obj"));
        run_ok(&sixfold, &["triangulate", "a.obj", "-o", &there]);
        run_ok(&sixfold, &["triangulate", &there, "-o", &back]);
        let [old, new] = ["a.obj", &back].map(|name| Obj::parse(&text(&sixfold, name)));
        assert_eq!(new.canonical_faces(), old.canonical_faces(), "{ending}");
        let run = run_ok(&sixfold, &["inspect", &there]);
        assert!(run.stdout.contains("4 vertices"), "{ending}: {run:?}");
    }
}

#[test]
fn the_format_of_an_output_can_be_chosen() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    let run = run_ok(
        &sixfold,
        &["triangulate", "a.obj", "--format", "off", "-o", "-"],
    );
    assert!(run.stdout.starts_with("OFF\n4 4 0\n"), "{run:?}");
    let arguments = ["dual", "a.obj", "--format", "stl-ascii", "-o", "a.ply"];
    let run = run_ok(&sixfold, &arguments);
    assert!(text(&sixfold, "a.ply").starts_with("solid"));
    assert_eq!(run.stderr, "", "STL keeps all of a mesh of triangles");
    let run = sixfold.run(&["dual", "a.obj", "--format", "step", "-o", "b.obj"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stderr.contains("stl-ascii"), "{run:?}");
}

#[test]
fn facets_can_be_kept_apart_and_meshes_moved() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    run_ok(&sixfold, &["triangulate", "a.obj", "-o", "a.stl"]);
    let run = run_ok(&sixfold, &["inspect", "a.stl"]);
    let note = "note: a.stl: joined 12 corners at equal positions to 4 vertices";
    assert!(run.stderr.contains(note), "{run:?}");
    let run = run_ok(&sixfold, &["inspect", "a.stl", "--as-stored"]);
    assert!(run.stdout.contains("12 vertices"), "{run:?}");

    sixfold.file(
        "far.obj",
        "v 5e5 0 0\nv 500000.01 0 0\nv 5e5 1 0\nf 1 2 3\n",
    );
    let run = run_ok(&sixfold, &["inspect", "far.obj"]);
    assert!(
        run.stderr
            .contains("merged 1 position with a different one"),
        "{run:?}"
    );
    assert!(run.stderr.contains("--recentre moves the mesh"), "{run:?}");
    let run = run_ok(&sixfold, &["inspect", "far.obj", "--recentre"]);
    assert!(!run.stderr.contains("merged"), "{run:?}");
    assert!(
        run.stderr
            .contains("moved by -500000.005, -0.5, 0 to the origin"),
        "{run:?}"
    );
}

#[test]
fn standard_input_may_have_every_format() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    for ending in ENDINGS {
        let name = format!("there.{ending}");
        run_ok(&sixfold, &["triangulate", "a.obj", "-o", &name]);
        let file = File::open(sixfold.folder().join(&name)).expect("the file");
        let mut command = sixfold.command(&["inspect", "-"]);
        let output = command.stdin(Stdio::from(file)).output().expect("it runs");
        let printed = String::from_utf8(output.stdout).expect("UTF-8");
        assert!(printed.contains("4 vertices"), "{ending}: {printed}");
    }
}

#[test]
fn folders_have_every_format_and_other_files_are_counted() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    std::fs::create_dir(sixfold.folder().join("scans")).expect("a folder");
    run_ok(&sixfold, &["triangulate", "a.obj", "-o", "scans/a.stl"]);
    run_ok(&sixfold, &["triangulate", "a.obj", "-o", "scans/b.ply"]);
    for name in ["notes.txt", "more.fbx", "other.FBX", "shape.x3d"] {
        sixfold.file(&format!("scans/{name}"), "text");
    }
    for name in [".hidden.obj", ".DS_Store"] {
        sixfold.file(&format!("scans/{name}"), "text");
    }
    std::os::unix::fs::symlink("nowhere", sixfold.folder().join("scans/broken.obj"))
        .expect("a link");
    let note = "note: scans: other files are left out: 2 .fbx, 1 .txt, 1 .x3d, 2 hidden, 1 link or \
                device; convert .fbx and .x3d to OBJ or PLY";
    let run = run_ok(&sixfold, &["study", "scans", "--rounds", "2"]);
    assert!(run.stderr.contains(note), "{run:?}");
    for name in ["scans/a.stl", "scans/b.ply"] {
        assert!(run.stdout.contains(name), "{name}: {run:?}");
    }
}

#[test]
fn every_command_can_cut_polygons() {
    let sixfold = Sixfold::new();
    sixfold.file(
        "quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let cut = "--triangulate";
    for command in [
        &["subdivide", "quad.obj", "--scheme", "loop", "-o", "out.obj"][..],
        &[
            "remesh",
            "quad.obj",
            "--edge-length",
            "0.5",
            "-o",
            "out.obj",
        ],
        &[
            "smooth",
            "quad.obj",
            "--backend",
            "corner-table",
            "-o",
            "out.obj",
        ],
    ] {
        assert_eq!(sixfold.run(command).code, Some(3), "{command:?}");
        run_ok(&sixfold, &[command, &[cut]].concat());
        let out = Obj::parse(&text(&sixfold, "out.obj"));
        assert!(
            out.canonical_faces().iter().all(|face| face.len() == 3),
            "{command:?}"
        );
    }
    run_ok(&sixfold, &["distance", "quad.obj", "quad.obj", cut]);
    run_ok(&sixfold, &["memory", "quad.obj", cut]);
}

/// Returns a grid of 10 × 10 squares of 1 km, whose first corner is at `east` and `north` in metres.
fn survey_tile(east: f64, north: f64) -> String {
    let mut text = String::new();
    for i in 0..121_u32 {
        let (x, y) = (f64::from(i % 11), f64::from(i / 11));
        let height = f64::from(i * 37 % 100) / 100.0;
        text += &format!(
            "v {} {} {height}\n",
            east + 1000.013 * x,
            north + 1000.013 * y
        );
    }
    for i in (0..110).filter(|i| i % 11 < 10) {
        text += &format!("f {} {} {} {}\n", i + 1, i + 2, i + 13, i + 12);
    }
    text
}

/// Moving a mesh does not help where its coordinates are tiny, and is not advised there.
#[test]
fn rounding_of_tiny_coordinates_is_reported() {
    let sixfold = Sixfold::new();
    sixfold.file("tiny.obj", "v 0 0 0\nv 1e-40 0 0\nv 0 1e-40 0\nf 1 2 3\n");
    let run = run_ok(&sixfold, &["inspect", "tiny.obj"]);
    assert!(
        run.stderr.ends_with("of the size of the mesh)\n"),
        "{run:?}"
    );
}

#[test]
fn rounding_far_from_the_origin_is_reported() {
    let sixfold = Sixfold::new();
    sixfold.file("tile.obj", &survey_tile(500_000.0, 0.0));
    sixfold.file("north.obj", &survey_tile(500_000.0, 4_500_000.0));
    let json = |name: &str| -> serde_json::Value {
        serde_json::from_str(&text(&sixfold, name)).expect("JSON")
    };
    for (name, least, most) in [("tile.obj", 0.012, 0.016), ("north.obj", 0.1, 0.26)] {
        let run = run_ok(&sixfold, &["inspect", name, "--json", "i.json"]);
        let note = format!(
            "note: {name}: rounding to 32 bits merged no positions and moved coordinates by up to "
        );
        assert!(run.stderr.contains(&note), "{run:?}");
        let rest = "of the size of the mesh): --recentre moves the mesh to the origin first\n";
        assert!(run.stderr.ends_with(rest), "{run:?}");
        let narrowing = &json("i.json")["narrowing"];
        assert_eq!(narrowing["merged_vertices"], 0);
        let shift = narrowing["largest_shift"].as_f64().expect("a number");
        assert!((least..most).contains(&shift), "{shift}");
        let run = run_ok(
            &sixfold,
            &["inspect", name, "--recentre", "--json", "i.json"],
        );
        assert!(!run.stderr.contains("rounding"), "{run:?}");
        let shift = json("i.json")["narrowing"]["largest_shift"].as_f64();
        assert!(shift.is_some_and(|shift| shift < 5e-4), "{shift:?}");
    }
    // Near the origin, rounding of decimals is not worth a note.
    sixfold.file(
        "near.obj",
        "v -0.1 0.2 0.3\nv 1.1 0 0.7\nv 0 1.3 0.123456789\nf 1 2 3\n",
    );
    assert_eq!(run_ok(&sixfold, &["inspect", "near.obj"]).stderr, "");
}

#[test]
fn unknown_endings_of_outputs_are_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", TETRAHEDRON);
    let message = "cube.3mf: .3mf is not the ending of a format that can be written: use one of \
                   .obj, .stl, .ply, .off, .gltf, .glb, or choose the format with --format";
    for command in [
        &["generate", "cube"][..],
        &["triangulate", "a.obj"],
        &["dual", "a.obj"],
        &["smooth", "a.obj"],
        &["repair", "a.obj", "--cut"],
        &["decimate", "a.obj", "--faces", "2"],
        &["subdivide", "a.obj", "--scheme", "loop"],
        &[
            "subdivide",
            "a.obj",
            "--scheme",
            "loop",
            "-o",
            "b.obj",
            "--limit",
            "cube.3mf",
        ],
    ] {
        let mut words = command.to_vec();
        if !words.contains(&"-o") {
            words.extend(["-o", "cube.3mf"]);
        }
        crate::bad_input::assert_refused(&sixfold, &words, 2, message);
    }
    run_ok(
        &sixfold,
        &["generate", "cube", "-o", "cube.3mf", "--format", "off"],
    );
    assert!(text(&sixfold, "cube.3mf").starts_with("OFF\n"));
    run_ok(&sixfold, &["generate", "cube", "-o", "cube"]);
    assert!(
        text(&sixfold, "cube").contains("\nf "),
        "OBJ if there is no ending"
    );
}

#[test]
fn standard_input_has_one_name() {
    let sixfold = Sixfold::new();
    sixfold.file(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty \
                           float y\nproperty float z\nproperty float nx\nelement face 1\nproperty \
                           list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n\
                           3 0 1 2\n",
    );
    let piped = |arguments: &[&str]| {
        let file = File::open(sixfold.folder().join("a.ply")).expect("the file");
        let mut command = sixfold.command(arguments);
        let output = command.stdin(Stdio::from(file)).output().expect("it runs");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        (text(output.stdout), text(output.stderr))
    };
    let (stdout, stderr) = piped(&["inspect", "-"]);
    assert!(
        stderr.starts_with("note: standard input: ignored 3 normals"),
        "{stderr}"
    );
    assert!(stdout.contains("mesh         standard input\n"), "{stdout}");
    let (stdout, stderr) = piped(&["distance", "-", "a.ply"]);
    assert!(stderr.contains("note: standard input: ignored"), "{stderr}");
    // The cells of a table break in a narrow terminal.
    let cells = ["standard", "input"]
        .iter()
        .all(|word| stdout.contains(word));
    assert!(cells, "{stdout}");
    let message = "both meshes are standard input";
    crate::bad_input::assert_refused(&sixfold, &["distance", "-", "-"], 2, message);
    let render = ["render", "-", "-", "-o", "a.png"];
    crate::bad_input::assert_refused(&sixfold, &render, 2, "several meshes are standard input");
}

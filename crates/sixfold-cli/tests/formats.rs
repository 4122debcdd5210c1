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
    assert!(
        run.stderr.contains("note: a.ply: vertices are not shared"),
        "{run:?}"
    );
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
    let run = run_ok(&sixfold, &["study", "scans", "--budget", "50ms"]);
    let note = "note: scans: files of other formats are left out (2 .fbx, 1 .x3d)";
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

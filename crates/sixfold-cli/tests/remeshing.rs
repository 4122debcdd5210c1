//! Tests of `sixfold decimate`, `remesh` and `edits`.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::obj::Obj;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

const BACKENDS: [&str; 6] = [
    "polygon-soup",
    "indexed-face-set",
    "face-vertex",
    "winged-edge",
    "half-edge",
    "corner-table",
];
const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const BOOK: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";

/// Runs the command and returns the written mesh.
fn written_mesh(sixfold: &Sixfold, arguments: &[&str]) -> Obj {
    run_ok(sixfold, &[arguments, &["-o", "out.obj"]].concat());
    Obj::parse(&text(sixfold, "out.obj"))
}

fn generate(sixfold: &Sixfold, name: &str, shape: &[&str]) {
    run_ok(sixfold, &[&["generate"], shape, &["-o", name]].concat());
}

/// Returns the signed area of a triangle mesh in the plane z = 0. Flipped faces have a negative
/// area.
fn flat_area(obj: &Obj) -> f64 {
    let areas = obj.faces.iter().map(|face| {
        let [a, b, c] = [0, 1, 2].map(|i| obj.positions[face[i] - 1].map(f64::from));
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    });
    areas.sum()
}

/// Three sheets of `n` × `n` squares with a common edge curve of `n` edges.
fn sheets(n: usize) -> String {
    let (mut vertices, mut faces) = (String::new(), String::new());
    for z in 0..=n {
        vertices += &format!("v 0 0 {z}\n");
    }
    for (sheet, [x, y]) in [[1.0, 0.0], [-0.5, 0.9], [-0.5, -0.9]]
        .into_iter()
        .enumerate()
    {
        let vertex = |i: usize, z: usize| match i {
            0 => z + 1,
            _ => (n + 1) * (sheet * n + i) + z + 1,
        };
        for i in 1..=n {
            for z in 0..=n {
                vertices += &format!("v {} {} {z}\n", x * i as f64, y * i as f64);
            }
            for z in 0..n {
                let [a, b] = [vertex(i - 1, z), vertex(i, z)];
                let [c, d] = [vertex(i, z + 1), vertex(i - 1, z + 1)];
                faces += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
            }
        }
    }
    vertices + &faces
}

#[test]
fn what_becomes_of_non_manifold_edges_is_said() {
    let sixfold = Sixfold::new();
    sixfold.file("sheets.obj", &sheets(6));
    for backend in ["polygon-soup", "indexed-face-set", "face-vertex"] {
        let options = ["sheets.obj", "--backend", backend, "-o", "out.obj"];
        let run = run_ok(
            &sixfold,
            &[&["decimate", "--ratio", "0.2"], &options[..]].concat(),
        );
        let inspected = run_ok(&sixfold, &["inspect", "out.obj", "--json", "-"]);
        let facts: Value = serde_json::from_str(&inspected.stdout).expect("JSON");
        let left = facts["mesh"]["non_manifold_edges"]
            .as_u64()
            .expect("a number");
        assert!((1..6).contains(&left), "{left}");
        let note = format!(
            "note: out.obj: not a manifold: edges with three or more faces: 6 before, {left} after"
        );
        assert!(run.stderr.contains(&note), "{run:?}");
        let run = run_ok(&sixfold, &[&["remesh"], &options[..]].concat());
        assert!(
            run.stderr
                .contains("edges with three or more faces: 6 before"),
            "{run:?}"
        );
    }
    // Two triangles that meet in a point, and a manifold.
    let touching = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n";
    sixfold.file("touching.obj", touching);
    sixfold.file("manifold.obj", TETRAHEDRON);
    for (mesh, says) in [("touching.obj", true), ("manifold.obj", false)] {
        let run = run_ok(
            &sixfold,
            &[
                "remesh",
                mesh,
                "--backend",
                "face-vertex",
                "--edge-length",
                "9",
                "-o",
                "out.obj",
            ],
        );
        let note = "vertices where parts of the surface only touch: 1 before, 1 after";
        assert_eq!(run.stderr.contains("not a manifold"), says, "{run:?}");
        assert_eq!(run.stderr.contains(note), says, "{run:?}");
    }
}

#[test]
fn a_closed_surface_gets_the_target_number_of_faces_and_stays_closed() {
    let sixfold = Sixfold::new();
    generate(&sixfold, "ball.obj", &["geodesic", "frequency=8"]);
    generate(&sixfold, "ring.obj", &["triangle-torus", "m=20", "n=10"]);
    for (file, goal, faces, chi) in [
        ("ball.obj", ["--faces", "500"], 500, 2),
        ("ball.obj", ["--ratio", "0.1"], 128, 2),
        ("ball.obj", ["--ratio", "1"], 1280, 2),
        ("ball.obj", ["--faces", "99999"], 1280, 2),
        ("ring.obj", ["--faces", "120"], 120, 0),
        ("ring.obj", ["--ratio", "0.25"], 100, 0),
    ] {
        let obj = written_mesh(&sixfold, &[&["decimate", file], &goal[..]].concat());
        assert_eq!(obj.faces.len(), faces, "{file} {goal:?}");
        assert_eq!(obj.euler_characteristic(), chi, "{file} {goal:?}");
        assert_eq!(obj.boundary_edges(), 0, "{file} {goal:?}");
    }
    let run = run_ok(&sixfold, &["inspect", "out.obj"]);
    assert!(run.stdout.contains("closed, genus 1"), "{run:?}");
    let all = ["decimate", "ball.obj", "--faces", "500", "-o", "out.obj"];
    let run = run_ok(&sixfold, &all);
    assert_eq!(run.stderr, "", "progress is for terminals");
    assert_eq!(
        run.stdout,
        "out.obj: 252 vertices, 500 faces; 390 edges collapsed on corner-table\n"
    );
}

#[test]
fn a_boundary_keeps_its_shape_or_all_its_vertices() {
    let sixfold = Sixfold::new();
    generate(&sixfold, "grid.obj", &["triangle-grid", "m=10", "n=10"]);
    let decimate = ["decimate", "grid.obj", "--faces", "60", "--boundary"];
    let remesh = ["remesh", "grid.obj", "--edge-length", "1.7"];
    for arguments in [
        &[&decimate[..], &["follow"]].concat()[..],
        &[&decimate[..], &["fixed"]].concat(),
        &remesh,
    ] {
        let obj = written_mesh(&sixfold, arguments);
        assert_eq!(obj.euler_characteristic(), 1, "{arguments:?}");
        assert!((flat_area(&obj) - 100.0).abs() < 1e-3, "{arguments:?}");
        for corner in [[0.0, 0.0], [10.0_f32, 0.0], [10.0, 10.0], [0.0, 10.0]] {
            let there = |p: &[f32; 3]| (0..2).all(|i| (p[i] - corner[i]).abs() < 1e-6);
            assert!(obj.positions.iter().any(there), "{arguments:?}");
        }
        let fixed = arguments.contains(&"fixed");
        assert_eq!(obj.boundary_edges() == 40, fixed, "{arguments:?}");
    }
}

#[test]
fn edges_get_the_target_length() {
    let sixfold = Sixfold::new();
    generate(&sixfold, "ball.obj", &["geodesic", "frequency=4"]);
    for (length, edge_length) in [(0.15, "0.15"), (0.6, "0.6")] {
        let arguments = ["remesh", "ball.obj", "--edge-length", edge_length];
        let obj = written_mesh(&sixfold, &arguments);
        assert_eq!(obj.euler_characteristic(), 2);
        assert_eq!(obj.boundary_edges(), 0);
        let lengths = obj.lengths();
        let mean = lengths.iter().sum::<f32>() / lengths.len() as f32;
        assert!((mean / length - 1.0).abs() < 0.15, "{mean} for {length}");
    }
    let run = run_ok(
        &sixfold,
        &[
            "remesh",
            "ball.obj",
            "--edge-length",
            "0.2",
            "--iterations",
            "1",
            "-o",
            "-",
        ],
    );
    assert!(
        run.stdout
            .lines()
            .all(|line| line.starts_with(['#', 'v', 'f'])),
        "{run:?}"
    );
    let none = [
        "remesh",
        "ball.obj",
        "--edge-length",
        "0.2",
        "--iterations",
        "0",
    ];
    let obj = written_mesh(&sixfold, &none);
    assert_eq!(
        obj.canonical_faces(),
        Obj::parse(&text(&sixfold, "ball.obj")).canonical_faces()
    );
}

#[test]
fn every_backend_makes_the_same_mesh() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 9);
    for command in [
        &["decimate", "grid.obj", "--ratio", "0.3"][..],
        &[
            "remesh",
            "grid.obj",
            "--edge-length",
            "1.5",
            "--iterations",
            "3",
        ],
    ] {
        let of = |backend| {
            let arguments = [command, &["--backend", backend]].concat();
            written_mesh(&sixfold, &arguments).canonical_faces()
        };
        let first = of(BACKENDS[0]);
        for backend in &BACKENDS[1..] {
            assert_eq!(of(backend), first, "{command:?} on {backend}");
        }
    }
}

#[test]
fn a_target_that_is_not_reached_gets_a_note() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.file("square.obj", SQUARE);
    sixfold.grid("grid.obj", 5);
    sixfold.file(
        "tagged.obj",
        &format!("{TETRAHEDRON}t crease 2/1/0 0 1 2\n"),
    );
    for (arguments, faces, message) in [
        (
            &["decimate", "t.obj", "--faces", "0"][..],
            4,
            "note: out.obj: the target of 0 faces was not reached",
        ),
        (
            &[
                "decimate",
                "grid.obj",
                "--ratio",
                "0",
                "--boundary",
                "fixed",
            ],
            14,
            "move the boundary",
        ),
        (
            &[
                "remesh",
                "square.obj",
                "--edge-length",
                "0.2",
                "--max-faces",
                "60",
            ],
            60,
            "--max-faces 60",
        ),
        (
            &["decimate", "tagged.obj", "--faces", "4"],
            4,
            "does not keep",
        ),
    ] {
        let run = run_ok(&sixfold, &[arguments, &["-o", "out.obj"]].concat());
        let is_warning = |line: &&str| line.starts_with("warning: out.obj: the shape has changed");
        let notes = run.stderr.lines().filter(|line| !is_warning(line));
        assert!(
            notes.clone().count() == 1 && notes.clone().all(|line| line.starts_with("note: ")),
            "{run:?}"
        );
        assert!(run.stderr.contains(message), "{run:?}");
        let obj = Obj::parse(&text(&sixfold, "out.obj"));
        assert_eq!(obj.faces.len(), faces, "{arguments:?}");
    }
}

#[test]
fn a_note_explains_why_scans_are_slow() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 51);
    let run = |backend| {
        let arguments = [
            "decimate",
            "grid.obj",
            "--faces",
            "4998",
            "-o",
            "out.obj",
            "--backend",
        ];
        run_ok(&sixfold, &[&arguments[..], &[backend]].concat())
    };
    let scanning = run("polygon-soup");
    assert!(
        scanning.stderr.contains("so this command is slow"),
        "{scanning:?}"
    );
    assert!(scanning.stderr.contains("half-edge"), "{scanning:?}");
    assert_eq!(run("half-edge").stderr, "");
}

#[test]
fn invalid_input_is_refused_before_anything_is_written() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.file("quad.obj", QUAD);
    sixfold.file("book.obj", BOOK);
    sixfold.file("empty.obj", "");
    std::fs::create_dir(sixfold.folder().join("folder.obj")).expect("a folder");
    let decimate = ["decimate", "--faces", "2"];
    let remesh = ["remesh", "--edge-length", "0.5"];
    for command in [&decimate, &remesh] {
        for (arguments, code, message) in [
            (&["quad.obj"][..], 3, "face f0 has 4 corners"),
            (&["quad.obj"], 3, "`sixfold triangulate`"),
            (
                &["quad.obj", "--backend", "corner-table"],
                3,
                "`sixfold triangulate`",
            ),
            (
                &["book.obj"],
                3,
                "corner-table cannot hold the mesh: edge v0–v1 has 3 faces",
            ),
            (
                &["book.obj"],
                3,
                "`sixfold inspect` shows which backends can hold the mesh",
            ),
            (&["t.obj", "--backend", "abacus"], 2, "corner-table"),
            (&["missing.obj"], 2, "missing.obj"),
            (&["empty.obj"], 2, "empty.obj"),
            (&["folder.obj"], 2, "directory"),
            (&["-"], 2, "standard input: the format is not recognised"),
            (&["t.obj", "--sideways"], 2, "--sideways"),
        ] {
            let arguments = [command, arguments, &["-o", "x.obj"]].concat();
            assert_refused(&sixfold, &arguments, code, message);
        }
        for (output, message) in [
            ("./t.obj", "would overwrite the mesh"),
            ("folder.obj", "is a directory"),
            ("no/such/folder.obj", "cannot be written"),
        ] {
            assert_refused(
                &sixfold,
                &[command, &["t.obj", "-o", output][..]].concat(),
                2,
                message,
            );
        }
    }
    for (arguments, code, message) in [
        (&["decimate"][..], 2, "--faces <N>|--ratio <PART>"),
        (
            &["decimate", "--faces", "2", "--ratio", "0.5"],
            2,
            "cannot be used with",
        ),
        (&["decimate", "--faces", "-1"], 2, "from 0 to"),
        (&["decimate", "--faces", "many"], 2, "from 0 to"),
        (&["decimate", "--ratio", "1.5"], 2, "from 0 to 1"),
        (&["decimate", "--ratio", "-0.5"], 2, "from 0 to 1"),
        (&["decimate", "--ratio", "nan"], 2, "from 0 to 1"),
        (
            &["decimate", "--ratio", "0.5", "--boundary", "open"],
            2,
            "follow, fixed",
        ),
        (&["remesh", "--edge-length", "0"], 2, "above 0"),
        (&["remesh", "--edge-length", "-1"], 2, "above 0"),
        (&["remesh", "--edge-length", "nan"], 2, "above 0"),
        (&["remesh", "--edge-length", "inf"], 2, "above 0"),
        (&["remesh", "--edge-length", "1e-30"], 3, "e60 triangles"),
        (&["remesh", "--edge-length", "1e-300"], 3, "need more than"),
        (
            &["remesh", "--edge-length", "0.1", "--max-faces", "50"],
            3,
            "only 50 are allowed",
        ),
        (
            &["remesh", "--edge-length", "1", "--iterations", "-1"],
            2,
            "from 0 to",
        ),
    ] {
        let arguments = [arguments, &["t.obj", "-o", "x.obj"]].concat();
        assert_refused(&sixfold, &arguments, code, message);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    for command in [
        &["decimate", "--faces", "4"][..],
        &["remesh", "--edge-length", "0.5"],
    ] {
        let arguments = [command, &["t.obj", "-o", "/dev/full"]].concat();
        assert_refused(&sixfold, &arguments, 2, "/dev/full: cannot be written");
    }
}

#[test]
fn some_backends_edit_non_manifold_meshes() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    let arguments = ["remesh", "book.obj", "--edge-length", "0.3", "--backend"];
    for backend in ["face-vertex", "indexed-face-set"] {
        let obj = written_mesh(&sixfold, &[&arguments[..], &[backend]].concat());
        assert!(obj.faces.len() > 3 && obj.euler_characteristic() == 1);
    }
}

#[test]
fn edits_writes_json() {
    let sixfold = Sixfold::new();
    let run = run_ok(&sixfold, &["edits", "--json", "-"]);
    let rows: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let rows = rows.as_array().expect("a list");
    assert_eq!(rows.len(), 16);
    for row in rows {
        let backends = row["backends"].as_array().expect("a list");
        let names: Vec<_> = backends.iter().map(|b| b["backend"].as_str()).collect();
        assert_eq!(names, BACKENDS.map(Some), "{row}");
        let words = [None, Some("constant"), Some("local"), Some("scan")];
        let known = |b: &Value| words.contains(&b["cost"].as_str());
        assert!(backends.iter().all(known), "{row}");
    }
    let flip = rows.iter().find(|row| row["edit"] == "flip_edge");
    let half_edge = &flip.expect("a row")["backends"][4];
    assert_ne!(half_edge["cost"], "scan");
}

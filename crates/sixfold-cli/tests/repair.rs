//! Tests of `sixfold repair`: meshes that no manifold structure holds become meshes that it holds.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// Three triangles on one edge.
const BOOK: &str = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 2 1 4\nf 2 1 5\n";

/// Two triangles that should share two vertices.
const UNWELDED: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0.001\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";

#[test]
fn a_book_is_cut_for_a_structure() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    let arguments = [
        "repair",
        "book.obj",
        "--for",
        "half-edge",
        "-o",
        "cut.obj",
        "--json",
        "r.json",
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(
        run.stdout
            .contains("cut into manifolds: vertices added: 2, edges cut: 1\n"),
        "{run:?}"
    );
    assert!(
        run.stdout.ends_with("cut.obj: 7 vertices, 3 faces\n"),
        "{run:?}"
    );
    let report = std::fs::read_to_string(sixfold.folder().join("r.json")).expect("a report");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["before"]["vertices"], 5);
    assert_eq!(report["after"]["vertices"], 7);
    let steps = report["steps"].as_array().expect("steps");
    let cut = steps
        .iter()
        .find(|step| step["step"] == "cut into manifolds");
    assert_eq!(cut.expect("the step")["counts"]["vertices_added"], 2);
    let again = sixfold.run(&["repair", "cut.obj", "--for", "half-edge", "-o", "again.obj"]);
    assert!(
        again.stdout.starts_with("the mesh needs no repair\n"),
        "{again:?}"
    );
    let file = |name| std::fs::read(sixfold.folder().join(name)).expect("a mesh");
    assert_eq!(file("again.obj"), file("cut.obj"));
    assert_eq!(
        sixfold.names(),
        ["again.obj", "book.obj", "cut.obj", "r.json"],
        "no draft is left"
    );
}

#[test]
fn steps_run_in_order() {
    let sixfold = Sixfold::new();
    sixfold.file("a.obj", UNWELDED);
    for weld in [&["--weld"][..], &["--weld=0"], &["--weld=0.1%"]] {
        let run = sixfold.run(&[&["repair", "a.obj", "-o", "b.obj"], weld].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        let expected = "weld vertices: vertices merged: 2\nb.obj: 4 vertices, 2 faces\n";
        assert_eq!(run.stdout, expected, "{weld:?}");
    }
    let filled = ["repair", "a.obj", "--weld", "--fill-holes=3", "-o", "-"];
    let run = sixfold.run(&filled);
    assert_eq!(
        run.stdout
            .lines()
            .filter(|line| line.starts_with("f "))
            .count(),
        2,
        "{run:?}"
    );
    let filled = [
        "repair",
        "a.obj",
        "--weld",
        "--fill-holes",
        "--hole-method",
        "ears",
        "-o",
        "-",
    ];
    let run = sixfold.run(&filled);
    // The hole has four edges; one of its diagonals is an edge already.
    assert_eq!(
        run.stdout
            .lines()
            .filter(|line| line.starts_with("f "))
            .count(),
        4,
        "{run:?}"
    );
}

#[test]
fn wrong_use_is_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    for (arguments, message) in [
        (&["-o", "out.obj"][..], "no repair is chosen"),
        (&["--weld=far", "-o", "out.obj"], "write a distance"),
        (
            &["--weld=-1", "-o", "out.obj"],
            "not a finite number of 0 or more",
        ),
        (&["--weld=200%", "-o", "out.obj"], "above 1"),
        (&["--for", "abacus", "-o", "out.obj"], "abacus"),
        (&["--cut", "-o", "book.obj"], "would overwrite the mesh"),
    ] {
        let all = [&["repair", "book.obj"], arguments].concat();
        assert_refused(&sixfold, &all, 2, message);
    }
    let holes = ["repair", "book.obj", "--fill-holes", "-o", "out.obj"];
    assert_refused(&sixfold, &holes, 3, "cut the mesh first");
    assert_eq!(sixfold.names(), ["book.obj"], "nothing is written");
}

/// Returns the commands of a text, as words.
fn commands(text: &str) -> Vec<Vec<String>> {
    let lines = text.lines().map(str::trim);
    let commands = lines.filter_map(|line| line.strip_prefix("sixfold "));
    commands
        .map(|command| command.split(' ').map(ToOwned::to_owned).collect())
        .collect()
}

#[test]
fn the_commands_that_inspect_prints_repair_the_mesh() {
    let sixfold = Sixfold::new();
    for (name, text) in [("book.obj", BOOK), ("unwelded.obj", UNWELDED)] {
        sixfold.file(name, text);
        let commands = commands(&run_ok(&sixfold, &["inspect", name]).stdout);
        assert!(commands.len() >= 2, "{name}: {commands:?}");
        for command in commands {
            let words: Vec<&str> = command.iter().map(String::as_str).collect();
            run_ok(&sixfold, &words);
            let after = run_ok(&sixfold, &["inspect", "repaired.obj"]).stdout;
            if words.contains(&"--for") {
                assert!(!after.contains("refuse"), "{words:?}: {after}");
            }
        }
    }
}

#[test]
fn inspect_names_lines_bytes_and_unshared_vertices() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", &format!("f 1 1 2\n{BOOK}"));
    let run = run_ok(&sixfold, &["inspect", "book.obj"]);
    let fault = "1 edge with three or more faces: v0–v1 (line 7)";
    assert!(run.stdout.contains(fault), "{run:?}");
    run_ok(&sixfold, &["triangulate", "book.obj", "-o", "book.stl"]);
    let run = run_ok(&sixfold, &["inspect", "book.stl"]);
    let fault = "1 edge with three or more faces: v0–v1 (byte 84)";
    assert!(run.stdout.contains(fault), "{run:?}");
    sixfold.file("a.obj", TETRAHEDRON);
    run_ok(&sixfold, &["triangulate", "a.obj", "-o", "a.stl"]);
    let run = run_ok(&sixfold, &["inspect", "a.stl", "--as-stored"]);
    let unshared = "the faces do not share vertices (12 vertices at 4 positions)\n               \
                    sixfold repair a.stl --weld -o repaired.obj";
    assert!(run.stdout.contains(unshared), "{run:?}");
}

#[test]
fn inspect_takes_several_meshes_and_folders() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    std::fs::create_dir(sixfold.folder().join("scans")).expect("a folder");
    sixfold.file(
        "scans/quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let both = ["inspect", "book.obj", "scans", "--json", "all.json"];
    let run = run_ok(&sixfold, &both);
    assert!(run.stdout.contains("mesh         book.obj\n"), "{run:?}");
    assert!(
        run.stdout.contains("mesh         scans/quad.obj\n"),
        "{run:?}"
    );
    let json = |name: &str| -> Value { serde_json::from_str(&text(&sixfold, name)).expect("JSON") };
    let all = json("all.json");
    assert_eq!(all[1]["mesh"]["name"], "scans/quad.obj");
    let faults = all[0]["diagnosis"]["faults"].as_array().expect("faults");
    assert_eq!(faults[0]["kind"], "non_manifold_edge");
    let place = serde_json::json!({ "edge": [0, 1], "line": 6 });
    assert_eq!(faults[0]["places"][0], place);
    let command = "sixfold repair book.obj --cut -o repaired.obj";
    assert_eq!(faults[0]["repair"], command);
    assert_eq!(faults[0]["refused_by"][0], "winged-edge");

    let cut = ["inspect", "scans", "--triangulate", "--json", "one.json"];
    let run = run_ok(&sixfold, &cut);
    assert!(run.stdout.contains("2 faces"), "{run:?}");
    assert_eq!(json("one.json")["mesh"]["faces"], 2);

    sixfold.file("scans/broken.obj", "v 0 0 0\nf 1 2 3\n");
    let run = sixfold.run(&["inspect", "book.obj", "scans"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    let message = "error: scans/broken.obj:2: face names vertex 2";
    assert!(run.stderr.contains(message), "{run:?}");
    assert!(
        run.stderr
            .contains("error: 1 of 3 meshes could not be read"),
        "{run:?}"
    );
    assert!(
        run.stdout.contains("mesh         scans/quad.obj\n"),
        "{run:?}"
    );
}

#[test]
fn a_refusal_names_the_command_that_repairs() {
    let sixfold = Sixfold::new();
    sixfold.file("book.obj", BOOK);
    let command = ["smooth", "book.obj", "-o", "out.obj"];
    assert_refused(&sixfold, &command, 3, "`sixfold repair --for half-edge`");
}

//! Tests of `sixfold repair`: meshes that no manifold structure holds become meshes that it holds.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::Sixfold;

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

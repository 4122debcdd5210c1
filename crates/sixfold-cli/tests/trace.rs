//! `sixfold trace`.

use serde_json::Value;

use crate::run::{Sixfold, run_ok, text};

#[test]
fn a_query_is_shown_read_by_read() {
    let sixfold = Sixfold::new();
    let run = run_ok(&sixfold, &["trace", "vertex_vertices", "v3"]);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(
        lines[..3],
        [
            "vertex_vertices of v3 in half-edge, cube: 3 results, 4 reads of rows, 4 cache",
            "lines, 40 bytes",
            "",
        ]
    );
    for part in [
        "  3    t = twin(h)",
        "   3  halves h0   twin of h1",
        "   4  yield v7",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
}

#[test]
fn queries_and_walks_run_after_edits() {
    let sixfold = Sixfold::new();
    let edit = ["--triangulate", "--edit", "flip_edge v0-v2"];
    let query = [&["trace", "VV", "v0"][..], &edit].concat();
    let run = run_ok(&sixfold, &query);
    let headline = "vertex_vertices of v0 in half-edge, cube after flip_edge v0-v2: 4 results";
    assert!(run.stdout.starts_with(headline), "{}", run.stdout);
    assert!(!run.stdout.contains("yield v2"), "{}", run.stdout);
    let walk = "h = leaving(v0); repeat { yield target(h); h = next(twin(h)) }";
    let walk = [
        "trace", "--walk", walk, "--expect", "VV v0", "--edit", "compact",
    ];
    let run = run_ok(&sixfold, &[&walk[..], &edit].concat());
    assert!(
        run.stdout
            .starts_with("walk in half-edge, cube after 2 edits: ")
    );
    assert!(run.stdout.contains("Right: "), "{}", run.stdout);
    // A structure that refuses the edit has no trace.
    let refused = [
        "trace",
        "VV",
        "v0",
        "--triangulate",
        "--edit",
        "dissolve_edge v0-v2",
        "--all",
    ];
    let run = run_ok(&sixfold, &refused);
    let reason = "! corner-table refuses dissolve_edge v0-v2: ";
    assert!(run.stdout.contains(reason), "{}", run.stdout);
}

#[test]
fn all_structures_are_traced_and_their_costs_compared() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let arguments = [
        "trace",
        "grid.obj",
        "edge_faces",
        "v21-v22",
        "--all",
        "--triangulate",
    ];
    let run = run_ok(
        &sixfold,
        &[&arguments[..], &["--json", "traces.json"]].concat(),
    );
    assert!(
        run.stdout.lines().all(|line| line.chars().count() <= 80),
        "{}",
        run.stdout
    );
    // A scan is one line, although it reads thousands of rows.
    assert!(run.stdout.contains("every row in order"), "{}", run.stdout);
    let document: Value = serde_json::from_str(&text(&sixfold, "traces.json")).expect("JSON");
    let traces = document["traces"].as_array().expect("a list");
    assert_eq!(traces.len(), 6);
    for trace in traces {
        assert_eq!(
            trace["results"].as_array().expect("a list").len(),
            2,
            "{trace}"
        );
        let steps = trace["steps"].as_array().expect("a list");
        let rows = steps
            .iter()
            .filter_map(|step| step["rows"].as_u64())
            .sum::<u64>();
        assert_eq!(Some(rows), trace["reads"].as_u64(), "{trace}");
    }
    assert_eq!(traces[0]["backend"], "polygon-soup");
    assert!(traces[0]["reads"].as_u64().expect("a number") > 2_000);
}

#[test]
fn an_edit_is_shown_with_the_rows_before_and_after() {
    let sixfold = Sixfold::new();
    let edits = ["--edit", "flip_edge v0-v2", "--edit", "compact"];
    let run = run_ok(
        &sixfold,
        &[&["trace", "--triangulate", "--all"][..], &edits].concat(),
    );
    assert!(
        run.stdout.lines().all(|line| line.chars().count() <= 80),
        "{}",
        run.stdout
    );
    for part in [
        "flip_edge v0-v2 in half-edge, cube: 7 rows change, 16 reads, 8 writes",
        "  halves h2   origin v0 → v3, next h11 → h5",
        "half-edge                    7     16       8",
        "only read: spokes v0, v2, edges e6 to e7, e11 to e12",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    let refused = run_ok(&sixfold, &["trace", "--edit", "flip_edge v0-v1"]);
    assert!(refused.stdout.contains("refused"), "{}", refused.stdout);
    assert!(
        refused.stdout.contains("! face f1 has 4 corners"),
        "{}",
        refused.stdout
    );
}

#[test]
fn a_walk_is_compared_with_a_relation() {
    let sixfold = Sixfold::new();
    let right = "h = leaving(v3); repeat { yield target(h); h = next(twin(h)) }";
    let expect = ["--expect", "vertex_vertices v3"];
    let run = run_ok(
        &sixfold,
        &[&["trace", "--walk", right][..], &expect].concat(),
    );
    let answer = "Right: the walk yields vertex_vertices of v3.";
    assert!(run.stdout.contains(answer), "{}", run.stdout);
    let wrong = right.replace("target", "origin");
    let run = sixfold.run(&[&["trace", "--walk", &wrong][..], &expect].concat());
    assert_eq!(run.code, Some(1), "{run:?}");
    let answer = "Not vertex_vertices of v3: the walk does not yield";
    assert!(run.stdout.contains(answer), "{}", run.stdout);
    let stopped = sixfold.run(&[
        "trace",
        "--triangulate",
        "--backend",
        "corner-table",
        "--walk",
        "yield next(none)",
    ]);
    assert_eq!(stopped.code, Some(1), "{stopped:?}");
    assert!(
        stopped
            .stdout
            .contains("! the walk ends here: line 1: none is none"),
        "{stopped:?}"
    );
    for (walk, message) in [
        ("h =", "the walk ends where a value"),
        ("yield nxt(h0)", "`nxt`"),
    ] {
        let run = sixfold.run(&["trace", "--walk", walk]);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
    }
}

#[test]
fn lessons_are_listed_and_run() {
    let sixfold = Sixfold::new();
    let list = run_ok(&sixfold, &["lessons"]);
    assert!(list.stdout.lines().count() > 12, "{}", list.stdout);
    for line in list.stdout.lines().take_while(|line| !line.is_empty()) {
        let name = line.split_whitespace().next().expect("a name");
        assert!(line.len() > name.len() + 2, "{line}");
    }
    // Standard input is no terminal, so the lesson does not wait.
    let lesson = run_ok(&sixfold, &["lessons", "flip"]);
    for part in [
        "HOW MANY ROWS",
        "$ sixfold trace --triangulate --all",
        "? When is a flip refused?",
    ] {
        assert!(lesson.stdout.contains(part), "{part}: {}", lesson.stdout);
    }
    // A chapter leaves out its pictures, and shows only the counts of folded traces.
    let chapter = run_ok(&sixfold, &["lessons", "corner-table"]);
    for part in [
        "CORNER TABLE",
        "Picture: The cube of this chapter.",
        "$ sixfold trace face_faces f0 --triangulate --backend corner-table\n3 results, 3 reads",
    ] {
        assert!(chapter.stdout.contains(part), "{part}: {}", chapter.stdout);
    }
    assert!(!chapter.stdout.contains("](") && !chapter.stdout.contains("```"));
    assert_eq!(sixfold.names(), Vec::<String>::new());
    let unknown = sixfold.run(&["lessons", "flap"]);
    assert_eq!(unknown.code, Some(2));
    assert!(
        unknown.stderr.contains("did you mean `flip`?"),
        "{unknown:?}"
    );
}

#[test]
fn what_cannot_be_traced_is_one_clear_line() {
    let sixfold = Sixfold::new();
    let cases: [(&[&str], i32, &str); 9] = [
        (&["trace"], 2, "name a relation and an element"),
        (&["trace", "v3"], 2, "name a relation and an element"),
        (
            &["trace", "v3", "vertex_vertices"],
            2,
            "no relation is called `v3`",
        ),
        (
            &["trace", "vertex_vertices", "3"],
            2,
            "`3` names no element: write v3",
        ),
        (
            &["trace", "vertex_vertices", "v8"],
            2,
            "half-edge has no vertex v8",
        ),
        (
            &["trace", "vertex_vertices", "f0"],
            2,
            "vertex_vertices starts from a vertex",
        ),
        (
            &["trace", "edge_faces", "v0-v6", "--all"],
            2,
            "has no edge v0-v6",
        ),
        (
            &["trace", "face_faces", "f0", "--backend", "corner-table"],
            3,
            "corner-table cannot hold the mesh",
        ),
        (&["trace", "--edit", "flip"], 2, "no edit is called `flip`"),
    ];
    for (arguments, code, message) in cases {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {run:?}");
        assert!(
            run.stderr.starts_with("error: ") && run.stderr.contains(message),
            "{run:?}"
        );
        assert_eq!(run.stderr.lines().count(), 1, "{run:?}");
    }
}

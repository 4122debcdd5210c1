//! Tests of `sixfold pick` and `workloads`.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::json_csv::finding;
use crate::run::{Sixfold, run_ok, text};

const MINE: &str = "summary = 'Mine.'\naccess = 'random'\noperations = '20 per face'\n\
    [mix]\nvertex_faces = 2\ncorner_positions = 1\n";

#[test]
fn the_answer_has_a_ranking_with_reasons() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 30);
    sixfold.file("mine.toml", MINE);
    let arguments = [
        "pick",
        "grid.obj",
        "--workload",
        "mine.toml",
        "--rounds",
        "8",
        "--json",
        "answer.json",
    ];
    let run = run_ok(&sixfold, &arguments);
    for part in [
        "Workload: mine. Mine.",
        "2 vertex_faces, 1 corner_positions; random; 33,640 operations",
        "pays: number of operations after which",
        "relation-tables: flat tables of only the relations in the mix, made from ",
        "For mine, ",
        "To use it in your package: cargo add sixfold",
        "= io::load(\"grid.obj\")?;",
    ] {
        let words: Vec<&str> = run.stdout.split_whitespace().collect();
        assert!(words.join(" ").contains(part), "{part}: {}", run.stdout);
    }
    assert!(
        run.stdout.lines().all(|line| line.chars().count() <= 80),
        "{}",
        run.stdout
    );
    let answer: Value = finding(&text(&sixfold, "answer.json"));
    let ranking = answer["ranking"].as_array().expect("a list");
    assert_eq!(ranking.len(), 7);
    for row in ranking {
        assert!(
            row["ns_per_operation"].as_f64().is_some_and(|ns| ns > 0.0),
            "{row}"
        );
        assert!(row["build_ns"].as_f64().is_some_and(|ns| ns > 0.0), "{row}");
        assert!(
            row["tied_with_best"].is_boolean() && row["bytes"].is_u64(),
            "{row}"
        );
    }
    assert_eq!(ranking[0]["ratio_to_best"], 1.0);
    assert_eq!(answer["break_even"].as_array().map(Vec::len), Some(6));
}

#[test]
fn json_on_standard_output_has_no_text_beside_it() {
    let sixfold = Sixfold::new();
    sixfold.grid("a.obj", 12);
    sixfold.grid("b.obj", 14);
    let run = run_ok(
        &sixfold,
        &[
            "pick",
            "a.obj",
            "b.obj",
            "--workload",
            "geodesic-dijkstra",
            "--needs",
            "edit",
            "--rounds",
            "8",
            "--json",
            "-",
        ],
    );
    let answer: Value = finding(&run.stdout);
    assert_eq!(answer["by_mesh"].as_array().map(Vec::len), Some(2));
    let excluded = answer["excluded"].as_array().expect("a list");
    let tables = excluded.iter().find(|e| e["backend"] == "relation-tables");
    let why = tables.and_then(|tables| tables["reason"].as_str());
    assert!(
        why.is_some_and(|why| why.contains("edited")),
        "{}",
        answer["excluded"]
    );
}

#[test]
fn no_qualifying_backend_has_its_own_exit_code() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let run = sixfold.run(&[
        "pick",
        "grid.obj",
        "--max-memory",
        "10",
        "--json",
        "none.json",
    ]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(
        run.stderr.contains("no backend qualifies"),
        "{}",
        run.stderr
    );
    let answer: Value = finding(&text(&sixfold, "none.json"));
    assert_eq!(answer["ranking"].as_array().map(Vec::len), Some(0));
    assert_eq!(answer["excluded"].as_array().map(Vec::len), Some(6));
}

#[test]
fn meshes_that_cannot_be_read_are_left_out() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold.file("broken.obj", "v 0 0 0\nf 1 2 3\n");
    std::fs::create_dir(sixfold.folder().join("empty")).expect("a folder");
    sixfold.file("mine.toml", MINE);
    let arguments = ["pick", "empty", "missing.obj", "broken.obj", "grid.obj"];
    let options = [
        "--workload",
        "mine.toml",
        "--rounds",
        "8",
        "--json",
        "p.json",
    ];
    let run = sixfold.run(&[&arguments[..], &options].concat());
    assert_eq!(run.code, Some(1), "{run:?}");
    let last = run.stderr.lines().last().unwrap_or_default();
    assert!(
        last.starts_with("error: not measured: empty, missing.obj, broken.obj: repair the files"),
        "{run:?}"
    );
    let document: Value = serde_json::from_str(&text(&sixfold, "p.json")).expect("JSON");
    assert_eq!(document["failures"][2]["mesh"], "broken.obj");
    assert_eq!(document["planned"], Value::Array(Vec::new()));
    let kept = sixfold.run(&[&arguments[..], &options, &["--keep-going"]].concat());
    assert_eq!(kept.code, Some(0), "{kept:?}");
    let last = "note: not measured: empty, missing.obj, broken.obj\n";
    assert!(kept.stderr.ends_with(last), "{kept:?}");
    for name in ["empty: no mesh file", "missing.obj", "broken.obj"] {
        let note = format!("note: not measured: {name}");
        assert!(run.stderr.contains(&note), "{note}: {}", run.stderr);
    }
    assert!(run.stdout.contains("For mine, "), "{}", run.stdout);
}

#[test]
fn invalid_arguments_are_refused() {
    let sixfold = Sixfold::new();
    std::fs::create_dir(sixfold.folder().join("empty")).expect("a folder");
    sixfold.grid("grid.obj", 12);
    sixfold.file(
        "quads.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    sixfold.file("tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    sixfold.file("name.toml", "operations = 5\n[mix]\nvertex_face = 1\n");
    sixfold.file("name_only.toml", "[mix]\nvertex_face = 1\n");
    sixfold.file(
        "key.toml",
        "operations = 5\nspeed = 1\n[mix]\nposition = 1\n",
    );
    sixfold.file("broken.toml", "operations = 5\n[mix\n");
    sixfold.file("empty.toml", "");
    std::fs::write(sixfold.folder().join("bytes.toml"), b"\xff\xfe").expect("a scratch file");
    let pick = |workload| ["pick", "grid.obj", "--workload", workload];
    for (workload, message) in [
        ("abacus", "choose from rendering-upload, "),
        ("missing.toml", "missing.toml: No such file"),
        (
            "name.toml",
            "name.toml:3: no operation is called `vertex_face` (did you mean `vertex_faces`?)",
        ),
        // The missing field `operations` must not hide the unknown name.
        (
            "name_only.toml",
            "name_only.toml:2: no operation is called `vertex_face` (did you mean `vertex_faces`?)",
        ),
        ("key.toml", "key.toml:2: unknown field `speed`"),
        ("broken.toml", "broken.toml:2: "),
        ("empty.toml", "empty.toml:1: missing table `[mix]`"),
        ("bytes.toml", "bytes.toml: "),
    ] {
        assert_refused(&sixfold, &pick(workload), 2, message);
    }
    for (arguments, message) in [
        (
            &["pick", "quads.obj", "--workload", "remeshing"][..],
            "needs triangles",
        ),
        (
            &["pick", "tiny.obj", "--workload", "remeshing"],
            "too small for 3 kinds of edits",
        ),
        (
            &["pick", "grid.obj", "--needs", "wings"],
            "choose from edit, non-manifold",
        ),
        (
            &["pick", "grid.obj", "--max-memory", "much"],
            "2GiB, 500MB or 1000000",
        ),
        (
            &["workloads", "--show", "abacus"],
            "choose from rendering-upload, ",
        ),
    ] {
        assert_refused(&sixfold, arguments, 2, message);
    }
}

#[test]
fn a_workload_that_is_shown_can_be_run() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let shown = run_ok(&sixfold, &["workloads", "--show", "region-growing"]);
    sixfold.file("mine.toml", &shown.stdout);
    let run = run_ok(
        &sixfold,
        &[
            "pick",
            "grid.obj",
            "--workload",
            "mine.toml",
            "--rounds",
            "8",
        ],
    );
    assert!(run.stdout.contains("For mine, "), "{}", run.stdout);
    let run = run_ok(&sixfold, &["workloads", "--json", "-"]);
    let all: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(all.as_array().map(Vec::len), Some(15));
}

#[test]
fn pick_continues_after_a_mesh_that_cannot_be_read() {
    let sixfold = Sixfold::new();
    sixfold.grid("a.obj", 8);
    sixfold.grid("c.obj", 9);
    sixfold.file("b.obj", "v 0 0 0\nf 1 2 3\n");
    let meshes = ["pick", "a.obj", "b.obj", "c.obj"];
    let run = run_ok(
        &sixfold,
        &[&meshes[..], &["--rounds", "2", "--keep-going"]].concat(),
    );
    let note = "note: not measured: b.obj:2: face names vertex 2";
    assert!(run.stderr.contains(note), "{run:?}");
    for mesh in ["a.obj", "c.obj"] {
        assert!(
            run.stdout.contains(&format!("Mesh:     {mesh}: ")),
            "{run:?}"
        );
    }
    assert_refused(&sixfold, &["pick", "b.obj"], 2, "b.obj:2");
    let none = ["pick", "b.obj", "missing.obj"];
    assert_refused(&sixfold, &none, 2, "none of the meshes can be measured");
}

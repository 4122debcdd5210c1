//! Selecting operations, tags, baselines, and measuring saved results again.

use std::fs;

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, run_ok, text};

fn list(sixfold: &Sixfold, operations: &str) -> Vec<String> {
    let run = run_ok(sixfold, &["study", "--list", "--operations", operations]);
    run.stdout.lines().map(str::to_owned).collect()
}

#[test]
fn operations_are_selected_by_names_patterns_and_groups() {
    let sixfold = Sixfold::new();
    assert_eq!(list(&sixfold, "build"), ["build"]);
    let vertices = [
        "vertex_vertices",
        "vertex_edges",
        "vertex_faces",
        "vertex_normal",
    ];
    assert_eq!(list(&sixfold, "vertex_*"), vertices);
    assert_eq!(list(&sixfold, "*_vertices,vertex_*").len(), 6);
    assert_eq!(
        list(&sixfold, "v*_*s"),
        ["vertex_vertices", "vertex_edges", "vertex_faces"]
    );
    let edits = list(&sixfold, "edits");
    assert!(
        edits.contains(&"flip_all".to_owned()) && edits.len() < 10,
        "{edits:?}"
    );
    let all = run_ok(&sixfold, &["study", "--list"]).stdout;
    assert!(all.lines().count() > 20, "{all}");
    for (wrong, message) in [
        ("nothing*", "no operation matches `nothing*`"),
        ("vertex_face", "vertex_faces"),
        ("*x*y*z", "`sixfold operations` lists them"),
    ] {
        assert_refused(&sixfold, &["study", "--operations", wrong], 2, message);
    }
    // The document names what was measured.
    sixfold.grid("grid.obj", 6);
    let study = [
        "study",
        "grid.obj",
        "--operations",
        "edge_v*,build",
        "--rounds",
        "1",
        "--json",
        "s.json",
    ];
    run_ok(&sixfold, &study);
    let study: Value = serde_json::from_str(&text(&sixfold, "s.json")).expect("JSON");
    let named = &study["runs"][0]["settings"]["operations"];
    assert_eq!(named, &serde_json::json!(["edge_vertices", "build"]));
    let orders = [
        "orders",
        "grid.obj",
        "--operations",
        "edge_v*",
        "--rounds",
        "1",
    ];
    assert!(run_ok(&sixfold, &orders).stdout.contains("edge_vertices"));
}

#[test]
fn tags_are_kept_and_compared() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 6);
    for (name, tag) in [("a.json", "machine=laptop"), ("b.json", "machine = server")] {
        let study = [
            "study",
            "grid.obj",
            "--operations",
            "build",
            "--rounds",
            "1",
        ];
        let tags = ["--tag", tag, "--tag", "why=test=1", "--json", name];
        run_ok(&sixfold, &[&study[..], &tags].concat());
    }
    let study: Value = serde_json::from_str(&text(&sixfold, "b.json")).expect("JSON");
    let tags = serde_json::json!({"machine": "server", "why": "test=1"});
    assert_eq!(study["runs"][0]["tags"], tags);
    let compared = run_ok(&sixfold, &["compare", "a.json", "b.json"]).stdout;
    assert!(
        compared.contains("machine      laptop → server"),
        "{compared}"
    );
    assert!(!compared.contains("test=1"), "{compared}");
    for wrong in ["laptop", "=laptop"] {
        let message = "write KEY=VALUE";
        assert_refused(&sixfold, &["study", "--tag", wrong], 2, message);
    }
}

#[test]
fn later_results_are_compared_with_a_baseline() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 6);
    let study = [
        "study",
        "grid.obj",
        "--operations",
        "build",
        "--rounds",
        "2",
        "--launches",
        "2",
    ];
    let with = |more: &[&'static str]| [&study[..], more].concat();
    let missing = sixfold.run(&with(&["--baseline", "main"]));
    assert_eq!(missing.code, Some(2), "{missing:?}");
    assert!(
        missing
            .stderr
            .contains("there is no baseline main in .sixfold"),
        "{missing:?}"
    );
    assert!(
        missing.stdout.is_empty(),
        "nothing is measured: {missing:?}"
    );
    let saved = run_ok(&sixfold, &with(&["--save-baseline", "main"]));
    assert!(!saved.stdout.contains("Compared"), "{saved:?}");
    let kept = sixfold.folder().join(".sixfold/main.json");
    let first = fs::read_to_string(&kept).expect("the baseline");
    let compared = run_ok(&sixfold, &with(&["--baseline", "main", "--seed", "2"]));
    assert!(
        compared.stdout.contains("Compared with the baseline main:"),
        "{compared:?}"
    );
    assert!(
        compared.stdout.contains("seed         1 → 2"),
        "{compared:?}"
    );
    assert!(
        compared.stdout.contains("Of 6 measurements"),
        "{compared:?}"
    );
    assert_eq!(fs::read_to_string(&kept).ok(), Some(first), "it stays");
    // Tags are in the baseline, and in what is compared with it.
    run_ok(
        &sixfold,
        &with(&["--save-baseline", "tagged", "--tag", "a=b"]),
    );
    let tagged = run_ok(&sixfold, &with(&["--baseline", "tagged", "--tag", "a=c"]));
    assert!(tagged.stdout.contains("a            b → c"), "{tagged:?}");
    fs::remove_file(sixfold.folder().join(".sixfold/tagged.json")).expect("it was saved");
    let other = sixfold.run(&with(&["--baseline", "other"]));
    assert!(other.stderr.contains("only main"), "{other:?}");
    // A baseline of a pick has nothing in common with a study.
    let pick = [
        "pick",
        "grid.obj",
        "--rounds",
        "1",
        "--save-baseline",
        "pick",
    ];
    run_ok(&sixfold, &pick);
    let pick = run_ok(
        &sixfold,
        &["pick", "grid.obj", "--rounds", "1", "--baseline", "pick"],
    );
    assert!(
        pick.stdout.contains("Compared with the baseline pick:"),
        "{pick:?}"
    );
    let different = run_ok(&sixfold, &with(&["--baseline", "pick"]));
    assert!(
        different.stderr.contains("not compared with pick"),
        "{different:?}"
    );
    for wrong in ["", "../main", ".main", "a b"] {
        let message = "write letters, digits, hyphens";
        assert_refused(&sixfold, &["study", "--save-baseline", wrong], 2, message);
    }
}

/// Makes the slowest backend of the only operation the winner of a study.
fn with_other_winner(sixfold: &Sixfold, from: &str, to: &str) {
    let mut study: Value = serde_json::from_str(&text(sixfold, from)).expect("JSON");
    let rows = study["findings"][0]["results"]
        .as_array_mut()
        .expect("rows");
    for row in rows {
        let standing = match row["backend"] == "polygon-soup" {
            true => "best",
            false => "slower",
        };
        row["standing"] = standing.into();
    }
    sixfold.file(to, &study.to_string());
}

#[test]
fn saved_results_are_measured_again_and_their_conclusions_confirmed() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    // The soup scans all faces for each vertex, so the other backend is always the fastest.
    let study = [
        "study",
        "grid.obj",
        "--operations",
        "vertex_normal",
        "--backends",
        "polygon-soup,half-edge",
        "--rounds",
        "4",
        "--launches",
        "3",
        "--csv",
        "old.csv",
        "--json",
        "old.json",
    ];
    run_ok(&sixfold, &study);
    fs::remove_file(sixfold.folder().join("old.csv")).expect("it was written");
    let again = run_ok(&sixfold, &["rerun", "old.json", "--json", "new.json"]);
    assert!(again.stdout.contains("running study grid.obj"), "{again:?}");
    assert!(
        again
            .stdout
            .contains("Of 1 conclusion, 1 stand, 0 are reversed"),
        "{again:?}"
    );
    assert!(
        !sixfold.folder().join("old.csv").exists(),
        "files are not written again"
    );
    let new: Value = serde_json::from_str(&text(&sixfold, "new.json")).expect("JSON");
    assert_eq!(new["findings"][0]["kind"], "study");
    assert_eq!(new["runs"][0]["settings"]["launches"], 3);

    with_other_winner(&sixfold, "old.json", "wrong.json");
    let reversed = sixfold.run(&["rerun", "wrong.json"]);
    assert_eq!(reversed.code, Some(1), "{reversed:?}");
    let words = reversed
        .stdout
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let expected = "vertex_normal on grid.obj: polygon-soup was the fastest, and now half-edge is.";
    assert!(words.contains(expected), "{words}");

    // The labs of a report are not measured again.
    let report = ["--labs", "none", "--report", "page"];
    run_ok(
        &sixfold,
        &[&study[..8], &["--launches", "3"], &report].concat(),
    );
    let again = run_ok(&sixfold, &["rerun", "page"]);
    assert!(
        again.stdout.contains("Of 1 conclusion, 1 stand"),
        "{again:?}"
    );

    // The mesh may be in another folder, but must be the same.
    fs::create_dir(sixfold.folder().join("moved")).expect("a folder");
    let [here, there] = ["grid.obj", "moved/grid.obj"].map(|name| sixfold.folder().join(name));
    fs::rename(&here, &there).expect("moved");
    assert_refused(
        &sixfold,
        &["rerun", "old.json"],
        2,
        "give its folder with --meshes",
    );
    let moved = run_ok(&sixfold, &["rerun", "old.json", "--meshes", "moved"]);
    assert!(
        moved.stdout.contains("Of 1 conclusion, 1 stand"),
        "{moved:?}"
    );
    sixfold.grid("moved/grid.obj", 11);
    let arguments = ["rerun", "old.json", "--meshes", "moved"];
    assert_refused(&sixfold, &arguments, 2, "its content differs");
    assert_refused(&sixfold, &["rerun", "none.json"], 2, "cannot be read");
    let over = ["rerun", "old.json", "--json", "old.json"];
    assert_refused(&sixfold, &over, 2, "would overwrite");
}

#[test]
fn conclusions_of_picks_and_of_several_commands_are_confirmed() {
    let sixfold = Sixfold::new();
    let backends = ["--backends", "indexed-face-set,half-edge"];
    let pick = [
        "pick",
        "--workload",
        "smoothing",
        "--rounds",
        "4",
        "--json",
        "pick.json",
    ];
    run_ok(&sixfold, &[&pick[..], &backends].concat());
    let growth = [
        "growth",
        "--to",
        "2000",
        "--steps",
        "2",
        "--rounds",
        "1",
        "--json",
        "growth.json",
    ];
    run_ok(&sixfold, &[&growth[..], &backends].concat());
    run_ok(
        &sixfold,
        &["merge", "pick.json", "growth.json", "--json", "all.json"],
    );
    let again = run_ok(&sixfold, &["rerun", "all.json", "--json", "again.json"]);
    assert!(
        again.stdout.contains("running pick") && again.stdout.contains("running growth"),
        "{again:?}"
    );
    let again: Value = serde_json::from_str(&text(&sixfold, "again.json")).expect("JSON");
    assert_eq!(again["findings"].as_array().map(Vec::len), Some(2));
    // Without a command, nothing can be repeated.
    let mut nothing: Value = serde_json::from_str(&text(&sixfold, "pick.json")).expect("JSON");
    nothing["runs"][0]["command"] = Value::Null;
    sixfold.file("nothing.json", &nothing.to_string());
    assert_refused(&sixfold, &["rerun", "nothing.json"], 2, "have no command");
}

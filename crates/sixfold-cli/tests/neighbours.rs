//! Tests of `sixfold neighbours`.

use crate::bad_input::assert_refused;
use crate::json_csv::finding;
use crate::run::{Sixfold, run_ok, text};

#[test]
fn all_indices_are_measured_and_the_cheapest_is_named() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let run = run_ok(
        &sixfold,
        &[
            "neighbours",
            "grid.obj",
            "--rounds",
            "2",
            "--json",
            "n.json",
            "--csv",
            "n.csv",
        ],
    );
    for name in [
        "list",
        "grid",
        "octree",
        "kd-tree",
        "bvh",
        "closest_point",
        "building included",
    ] {
        assert!(run.stdout.contains(name), "{name}: {}", run.stdout);
    }
    let json = text(&sixfold, "n.json");
    let found = finding(&json);
    assert_eq!(found["kind"], "neighbours");
    assert_eq!(found["queries"], 144);
    let rows = found["results"].as_array().expect("a list");
    assert_eq!(rows.len(), 7 * 5);
    assert!(rows.iter().all(|row| row["agreement"] == "same"));
    // A header and a row for each task and index.
    assert_eq!(text(&sixfold, "n.csv").lines().count(), 1 + 7 * 5);
    // A report of the finding has a figure with the rankings of all tasks.
    run_ok(&sixfold, &["report", "n.json", "--to", "page"]);
    let page = text(&sixfold, "page/report.md");
    assert!(page.contains("Neighbours in space: grid.obj"), "{page}");
    assert!(page.contains("figures/neighbours.svg"), "{page}");
}

#[test]
fn some_indices_and_points_can_be_chosen() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let words = ["neighbours", "grid.obj", "--rounds", "2", "--json", "-"];
    let run = run_ok(
        &sixfold,
        &[&words[..], &["--points", "box", "--indices", "bvh,kd-tree"]].concat(),
    );
    let found = finding(&run.stdout);
    assert_eq!(found["points"], "box");
    let mut names: Vec<&String> = found["backends"]
        .as_object()
        .expect("by name")
        .keys()
        .collect();
    names.sort();
    assert_eq!(names, ["bvh", "kd-tree"]);
}

#[test]
fn unknown_names_and_unusable_meshes_are_refused() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 2);
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    sixfold.file("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
    for (words, message) in [
        (
            &["neighbours", "grid.obj", "--indices", "quadtree"][..],
            "list, grid, octree",
        ),
        (&["neighbours", "grid.obj", "--points", "far"], "near"),
        (&["neighbours", "points.obj"], "no faces"),
        (&["neighbours", "nan.obj"], "not a number"),
        (&["neighbours", "missing.obj"], "missing.obj"),
    ] {
        assert_refused(&sixfold, words, 2, message);
    }
}

//! Tests of `sixfold history`.

use std::fs;

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::changes::set_times;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// Writes studies of one mesh, measured by four commits, to the folder `all`: half-edge takes twice the time from the
/// third on, and corner-table does so in the second alone. The names are not in the order of time.
fn four_commits() -> Sixfold {
    let sixfold = Sixfold::new();
    fs::create_dir(sixfold.folder().join("all")).expect("a folder");
    sixfold.file("t.obj", TETRAHEDRON);
    let study = ["study", "t.obj", "--rounds", "2", "--json", "a.json"];
    let operations = ["--operations", "boundary,edge_length"];
    run_ok(&sixfold, &[&study[..], &operations].concat());
    let mut study: Value = serde_json::from_str(&text(&sixfold, "a.json")).expect("JSON");
    for (number, name) in ["d", "c", "b", "a"].into_iter().enumerate() {
        set_times(&mut study["findings"][0], |backend| {
            match (backend, number) {
                ("half-edge", 2..) | ("corner-table", 1) => 2000.0,
                _ => 1000.0,
            }
        });
        study["findings"][0]["start"]["unix_time"] = (86_400 * (number + 1)).into();
        study["runs"][0]["environment"]["commit"] = format!("c0ffee{number}").into();
        sixfold.file(&format!("all/{name}.json"), &study.to_string());
    }
    sixfold
}

#[test]
fn changes_are_shown_with_the_commit_since_which_they_last() {
    let sixfold = four_commits();
    let files = ["--json", "h.json", "--csv", "h.csv", "--report", "page"];
    let run = run_ok(&sixfold, &[&["history", "all"][..], &files].concat());
    let unbroken = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "1 1970-01-02 c0ffee0 1.00 d.json",
        "boundary half-edge 1.00 µs 2.00",
        "==++",
        "Of 12 measurements over 4 documents, 0 are faster in the last one than in the first, 2 are slower, 10 are equal, \
         and 0 cannot be told.",
        "Since document 3 (b.json, commit c0ffee2), 2 are slower and 0 are faster.",
        "2 measurements changed in between",
    ] {
        assert!(unbroken.contains(part), "{part}: {}", run.stdout);
    }
    // The changes that last come first; unchanged times are not shown.
    let lines: Vec<&str> = run
        .stdout
        .lines()
        .filter(|line| line.contains("µs"))
        .collect();
    assert_eq!(lines.len(), 4, "{}", run.stdout);
    assert!(
        lines[0].contains("half-edge") && lines[2].contains("corner-table"),
        "{lines:?}"
    );
    assert!(lines[2].ends_with("=+=="), "{lines:?}");
    assert!(
        run.stdout.lines().all(|line| line.chars().count() <= 80),
        "{}",
        run.stdout
    );

    let history: Value = serde_json::from_str(&text(&sixfold, "h.json")).expect("JSON");
    let group = &history["groups"][0];
    assert_eq!(group["documents"][3]["name"], "a.json");
    let rows = group["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 12);
    for row in rows {
        let since = match row["backend"] == "half-edge" {
            true => 3.into(),
            false => Value::Null,
        };
        assert_eq!(row["since"], since, "{row}");
        let ratios = row["points"].as_array().expect("points").iter();
        let ratios: Vec<f64> = ratios.filter_map(|point| point["ratio"].as_f64()).collect();
        let expected = match row["backend"].as_str() {
            Some("half-edge") => [1.0, 1.0, 2.0, 2.0],
            Some("corner-table") => [1.0, 2.0, 1.0, 1.0],
            _ => [1.0; 4],
        };
        assert_eq!(ratios, expected, "{row}");
        let last = &row["points"][3];
        let [low, high] = ["ci_low", "ci_high"].map(|end| last[end].as_f64().expect("an interval"));
        assert!(low < ratios[3] && ratios[3] < high, "{row}");
    }
    assert_eq!(text(&sixfold, "h.csv").lines().count(), 1 + 12 * 4);
    assert_eq!(
        text(&sixfold, "page/history.json"),
        text(&sixfold, "h.json")
    );
    let page = text(&sixfold, "page/report.md");
    for part in [
        "# History of 4 documents",
        "](figures/history-1.svg)",
        "c0ffee2",
        "2.00 (1.",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    let all = run_ok(&sixfold, &["history", "all", "--all"]).stdout;
    assert_eq!(
        all.lines().filter(|line| line.contains("µs")).count(),
        12,
        "{all}"
    );
}

#[test]
fn what_cannot_be_read_or_compared_is_named() {
    let sixfold = four_commits();
    sixfold.file("all/half.json", "{\"schema\": 4");
    sixfold.file("all/notes.txt", "no document");
    sixfold.grid("grid.obj", 4);
    let other = [
        "study",
        "grid.obj",
        "--rounds",
        "2",
        "--operations",
        "boundary",
    ];
    run_ok(
        &sixfold,
        &[&other[..], &["--json", "all/grid.json"]].concat(),
    );
    let run = run_ok(&sixfold, &["history", "all"]);
    assert!(
        run.stderr.contains("note: left out: all/half.json: "),
        "{run:?}"
    );
    let note = "note: grid.json is left out: compared with d.json: the first is of t.obj";
    assert!(run.stderr.contains(note), "{run:?}");
    assert!(run.stdout.contains("over 4 documents"), "{run:?}");

    // Two documents of the other mesh are a group of their own.
    sixfold.file("all/grid-2.json", &text(&sixfold, "all/grid.json"));
    let two = run_ok(&sixfold, &["history", "all", "--json", "-"]).stdout;
    let two: Value = serde_json::from_str(&two).expect("JSON alone");
    assert_eq!(two["groups"].as_array().map(Vec::len), Some(2));
    assert_eq!(two["groups"][1]["documents"][1]["name"], "grid.json");
    assert_eq!(two["alone"], Value::Array(Vec::new()));

    let refused = |arguments: &[&str], message: &str| {
        let arguments = [&["history"], arguments].concat();
        let run = sixfold.run(&arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{message}: {run:?}");
    };
    refused(
        &["all/a.json", "all/grid.json"],
        "no two documents have a measurement in common",
    );
    refused(&["all/half.json"], "none of the files can be read");
    refused(&["none"], "none of the files can be read");
    refused(
        &["all", "--json", "all/a.json"],
        "--json would overwrite the results all/a.json",
    );
    fs::create_dir(sixfold.folder().join("empty")).expect("a folder");
    assert_refused(
        &sixfold,
        &["history", "empty"],
        2,
        "no results in this folder",
    );
}

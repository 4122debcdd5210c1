//! Tests of `sixfold compare`.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// Writes a study of a tetrahedron to `a.json`. Writes the same study with doubled half-edge times
/// to `b.json`.
fn two_studies() -> Sixfold {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    let arguments = [
        "study",
        "t.obj",
        "--rounds",
        "2",
        "--operations",
        "boundary,edge_length",
        "--json",
        "a.json",
    ];
    run_ok(&sixfold, &arguments);
    let mut study: Value = serde_json::from_str(&text(&sixfold, "a.json")).expect("JSON");
    set_times(&mut study["findings"][0], |_| 1000.0);
    sixfold.file("a.json", &study.to_string());
    let finding = &mut study["findings"][0];
    set_times(finding, |backend| match backend {
        "half-edge" => 2000.0,
        _ => 1000.0,
    });
    study["runs"][0]["environment"]["commit"] = "0123456".into();
    sixfold.file("b.json", &study.to_string());
    sixfold
}

/// The times of eight launches, relative to that of the study. Their product is 1.
const LAUNCHES: [f64; 8] = [
    1.0,
    1.01,
    1.0 / 1.01,
    1.005,
    1.0,
    1.0 / 1.005,
    1.002,
    1.0 / 1.002,
];

/// Replaces all samples by nine known ones, from 2 % below to 2 % above the time of the backend, and all launches by
/// known ones, which differ from row to row.
pub(crate) fn set_times(finding: &mut Value, ns_of: impl Fn(&str) -> f64) {
    finding["control"] = Value::Null;
    let rows = finding["results"].as_array_mut().expect("rows");
    for (number, row) in rows.iter_mut().enumerate() {
        let ns = ns_of(row["backend"].as_str().expect("a name"));
        row["median_ns"] = ns.into();
        let launches = (0..8).map(|launch| ns * LAUNCHES[(launch + number) % 8]);
        row["launch_ns"] = launches.collect();
    }
    for raw in finding["samples"].as_array_mut().expect("samples") {
        let ns = ns_of(raw["backend"].as_str().expect("a name"));
        let times = (-4..=4).map(|i| ns * (1.0 + 0.005 * f64::from(i)));
        let times: Vec<f64> = times.collect();
        raw["rounds"] = (0..9).collect();
        (raw["cpu_ns"], raw["wall_ns"]) = (times.clone().into(), times.into());
        raw["slowdowns"] = vec![1.0; 9].into();
        raw["faults"] = Value::Null;
    }
}

#[test]
fn a_change_is_shown_and_can_set_the_exit_code() {
    let sixfold = two_studies();
    let run = run_ok(
        &sixfold,
        &["compare", "a.json", "b.json", "--json", "c.json"],
    );
    for part in [
        "half-edge",
        "2.00",
        "slower",
        "commit",
        "0123456",
        "2 are slower",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    assert!(!run.stdout.contains("corner-table"), "{}", run.stdout);
    let changes: Value = serde_json::from_str(&text(&sixfold, "c.json")).expect("JSON");
    let rows = changes["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 12);
    let slower = rows.iter().filter(|row| row["verdict"] == "slower");
    assert!(slower.clone().all(|row| row["backend"] == "half-edge"));
    assert_eq!(slower.count(), 2);

    let all = run_ok(&sixfold, &["compare", "a.json", "b.json", "--all"]);
    assert!(all.stdout.contains("corner-table"), "{}", all.stdout);
    let failing = ["compare", "a.json", "b.json", "--fail-if-slower"];
    assert_eq!(sixfold.run(&failing).code, Some(1));
    // No row is slower if the studies are equal or if the second study is faster.
    let same = ["compare", "a.json", "a.json", "--fail-if-slower"];
    assert!(!run_ok(&sixfold, &same).stdout.contains("Only in the"));
    run_ok(
        &sixfold,
        &["compare", "b.json", "a.json", "--fail-if-slower"],
    );
    // One launch cannot tell, so nothing is known to be slower, and the check did not pass.
    let mut one: Value = serde_json::from_str(&text(&sixfold, "a.json")).expect("JSON");
    for row in one["findings"][0]["results"].as_array_mut().expect("rows") {
        row["launch_ns"] = Value::Array(Vec::new());
    }
    sixfold.file("one.json", &one.to_string());
    let cannot = sixfold.run(&["compare", "a.json", "one.json", "--fail-if-slower"]);
    assert_eq!(cannot.code, Some(3), "{cannot:?}");
    assert!(cannot.stdout.contains("12 cannot be told"), "{cannot:?}");
    assert!(cannot.stdout.contains("--launches 3"), "{cannot:?}");
    let all = run_ok(&sixfold, &["compare", "a.json", "one.json", "--all"]);
    assert!(
        all.stdout.contains("?: cannot be told from chance"),
        "{all:?}"
    );
    assert!(
        all.stdout.lines().all(|line| line.chars().count() <= 80),
        "{all:?}"
    );
    let piped = run_ok(&sixfold, &["compare", "a.json", "b.json", "--json", "-"]);
    serde_json::from_str::<Value>(&piped.stdout).expect("JSON alone");
}

#[test]
fn files_without_common_results_are_refused_in_one_message() {
    let sixfold = two_studies();
    let whole = text(&sixfold, "a.json");
    sixfold.file("half.json", &whole[..whole.len() / 2]);
    sixfold.file("old.json", "{\"schema\": 1, \"results\": []}");
    sixfold.file("foreign.json", "{\"name\": \"package\"}");
    sixfold.file("words.json", "not JSON\n");
    let pick = [
        "pick",
        "t.obj",
        "--rounds",
        "2",
        "--json",
        "pick.json",
        "--workload",
        "smoothing",
    ];
    run_ok(&sixfold, &pick);
    let fewer = [
        "study",
        "t.obj",
        "--rounds",
        "2",
        "--operations",
        "build",
        "--json",
        "build.json",
    ];
    run_ok(&sixfold, &fewer);
    for (file, message) in [
        ("half.json", "ends too early"),
        ("old.json", "reads schema 4: measure again"),
        ("foreign.json", "no `schema`"),
        ("words.json", "is not JSON, line 1"),
        ("pick.json", "nothing to compare"),
        ("none.json", "cannot be read"),
        (".", "cannot be read"),
        ("build.json", "nothing to compare"),
    ] {
        assert_refused(&sixfold, &["compare", "a.json", file], 2, message);
        assert_refused(&sixfold, &["compare", file, "a.json"], 2, message);
    }
    let over = ["compare", "a.json", "b.json", "--json", "b.json"];
    assert_refused(&sixfold, &over, 2, "would overwrite");
}

#[test]
fn results_of_any_command_are_merged_and_compared() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    run_ok(&sixfold, &["memory", "t.obj", "--json", "m.json"]);
    let quick = ["--rounds", "2", "--json", "p.json"];
    run_ok(&sixfold, &[&["pick", "t.obj"], &quick[..]].concat());
    let same = run_ok(&sixfold, &["compare", "m.json", "m.json"]);
    assert!(same.stdout.contains("the same counts of bytes"), "{same:?}");
    let more =
        text(&sixfold, "m.json").replacen("\"allocated_bytes\": ", "\"allocated_bytes\": 1", 1);
    sixfold.file("more.json", &more);
    let different = run_ok(&sixfold, &["compare", "m.json", "more.json"]);
    assert!(
        different.stdout.contains("1 count of bytes differs"),
        "{different:?}"
    );
    assert!(different.stdout.contains("(build)"), "{different:?}");
    let merged = run_ok(
        &sixfold,
        &["merge", "p.json", "m.json", "--json", "all.json"],
    );
    assert!(
        merged
            .stdout
            .contains("results of other commands: pick, memory"),
        "{merged:?}"
    );
    let left_out = run_ok(&sixfold, &["compare", "all.json", "p.json"]).stdout;
    assert!(
        left_out.contains("Only in the first file: structure on polygon-soup, "),
        "{left_out}"
    );
    let quick = [
        "--operations",
        "ff_bfs",
        "--rounds",
        "2",
        "--json",
        "o.json",
    ];
    run_ok(&sixfold, &[&["orders", "t.obj"], &quick[..]].concat());
    run_ok(
        &sixfold,
        &["merge", "p.json", "o.json", "--json", "both.json"],
    );
    let cases = run_ok(&sixfold, &["compare", "both.json", "p.json"]).stdout;
    assert!(cases.contains("(breadth-first)"), "{cases}");
    assert!(left_out.contains("more."), "{left_out}");
}

/// Returns the names of the files that the list of a folder names, sorted.
fn listed(sixfold: &Sixfold, folder: &str) -> Vec<String> {
    let list = text(sixfold, &format!("{folder}/sixfold-files.txt"));
    let mut names: Vec<String> = list.lines().map(str::to_owned).collect();
    names.sort_unstable();
    names
}

#[test]
fn a_figure_that_cannot_be_pdf_is_named_and_the_others_are_written() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", TETRAHEDRON);
    sixfold.grid("网格.obj", 3);
    let study = ["study", "t.obj", "网格.obj", "--rounds", "2"];
    let results = ["--operations", "boundary", "--json", "a.json"];
    run_ok(&sixfold, &[&study[..], &results].concat());
    let mut study: Value = serde_json::from_str(&text(&sixfold, "a.json")).expect("JSON");
    for (name, ns) in [("a.json", 1000.0), ("b.json", 2000.0)] {
        for finding in study["findings"].as_array_mut().expect("studies") {
            set_times(finding, |backend| match backend {
                "half-edge" => ns,
                _ => 1000.0,
            });
        }
        sixfold.file(name, &study.to_string());
    }
    let figures = ["compare", "a.json", "b.json", "--figures", "paper"];
    let run = run_ok(&sixfold, &figures);
    let notice = "note: changes.pdf is not written: the font of PDF files, DejaVu Sans, has no 格 (U+683C), 网 (U+7F51); \
                  changes.svg has the figure\n";
    assert_eq!(run.stderr, notice);
    let exists = |name: &str| sixfold.folder().join("paper").join(name).exists();
    for (name, expected) in [
        ("changes.svg", true),
        ("changes.pdf", false),
        ("changes.csv", true),
        ("ratios.svg", true),
        ("ratios.pdf", true),
    ] {
        assert_eq!(exists(name), expected, "{name}");
    }
}

#[test]
fn a_report_shows_the_changes_and_keeps_the_exit_code() {
    let sixfold = two_studies();
    let plain = run_ok(&sixfold, &["compare", "a.json", "b.json"]).stdout;
    let arguments = ["compare", "a.json", "b.json", "--report", "changes"];
    let drawn = run_ok(&sixfold, &arguments).stdout;
    assert_eq!(drawn, format!("{plain}- Report: changes/report.html\n"));
    let failing = [&arguments[..], &["--fail-if-slower", "--json", "c.json"]].concat();
    assert_eq!(sixfold.run(&failing).code, Some(1));
    let files = [
        "changes.json",
        "figures/changes.svg",
        "figures/ratios.svg",
        "report.html",
        "report.md",
    ];
    assert_eq!(listed(&sixfold, "changes"), files);
    assert_eq!(
        text(&sixfold, "changes/changes.json"),
        text(&sixfold, "c.json")
    );
    let page = text(&sixfold, "changes/report.md");
    for part in [
        "# What changed: a.json → b.json",
        "of 12 times, 2 are slower and 0 are faster; 10 are equal and",
        "on half-edge, 2.00 × the time before (1.00 µs → 2.00 µs)",
        "0123456",
        "](figures/changes.svg)",
        "# a.json: sixfold study t.obj",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    // Figures that are no longer drawn are removed; files of others stay.
    sixfold.file("changes/figures/mine.svg", "mine");
    run_ok(
        &sixfold,
        &["compare", "a.json", "a.json", "--report", "changes"],
    );
    let files: Vec<&str> = files
        .into_iter()
        .filter(|name| !name.ends_with("changes.svg"))
        .collect();
    assert_eq!(listed(&sixfold, "changes"), files);
    assert!(
        !sixfold
            .folder()
            .join("changes/figures/changes.svg")
            .exists()
    );
    assert_eq!(text(&sixfold, "changes/figures/mine.svg"), "mine");
    assert!(text(&sixfold, "changes/report.md").contains("No change found"));

    let figures = ["compare", "a.json", "b.json", "--figures", "paper"];
    assert_eq!(run_ok(&sixfold, &figures).stdout, plain);
    let csv = text(&sixfold, "paper/changes.csv");
    assert_eq!(csv.lines().count(), 1 + 2, "{csv}");
    assert!(text(&sixfold, "paper/changes.txt").contains("Measured: a.json: "));
}

#[test]
fn a_report_of_changes_replaces_no_file_of_others() {
    let sixfold = two_studies();
    for folder in ["before", "after", "foreign"] {
        std::fs::create_dir(sixfold.folder().join(folder)).expect("a folder");
    }
    sixfold.file("before/results.json", &text(&sixfold, "a.json"));
    sixfold.file("after/results.json", &text(&sixfold, "b.json"));
    sixfold.file("foreign/report.html", "mine");
    let refused = |options: &[&str], message: &str| {
        let arguments = [&["compare", "before", "after"], options].concat();
        assert_refused(&sixfold, &arguments, 2, message);
    };
    refused(
        &["--report", "before"],
        "--report would overwrite the results before",
    );
    refused(
        &["--report", "./after/"],
        "--report would overwrite the results ./after/",
    );
    refused(
        &["--figures", "after"],
        "--figures would overwrite the results after",
    );
    refused(&["--report", "foreign"], "has files of others");
    refused(&["--report", "."], "has files of others");
    refused(&["--report", "a.json"], "cannot be written");
    refused(
        &["--report", "new", "--figures", "new"],
        "both write to new",
    );
    assert_eq!(text(&sixfold, "foreign/report.html"), "mine");
    assert_eq!(
        text(&sixfold, "before/results.json"),
        text(&sixfold, "a.json")
    );
    // The folder of a refused comparison is not created.
    sixfold.file("none.json", "{}");
    let arguments = ["compare", "a.json", "none.json", "--report", "new"];
    assert_refused(&sixfold, &arguments, 2, "no `schema`");
    assert!(!sixfold.folder().join("new").exists());

    // A new file of another program is not replaced, and nothing else is written.
    let arguments = ["compare", "before", "after", "--report", "new"];
    run_ok(
        &sixfold,
        &["compare", "before", "before", "--report", "new"],
    );
    sixfold.file("new/figures/changes.svg", "mine");
    let old = text(&sixfold, "new/report.html");
    let refused = sixfold.run(&arguments);
    assert_eq!(refused.code, Some(2), "{refused:?}");
    assert!(
        refused.stderr.contains("changes.svg exists already"),
        "{refused:?}"
    );
    assert_eq!(text(&sixfold, "new/figures/changes.svg"), "mine");
    assert_eq!(text(&sixfold, "new/report.html"), old);
    // Files with one name are named with their folders.
    let other = [
        "compare",
        "before/results.json",
        "after/results.json",
        "--report",
        "other",
    ];
    run_ok(&sixfold, &other);
    let page = text(&sixfold, "other/report.md");
    assert!(
        page.starts_with("# What changed: before/results.json → after/results.json\n"),
        "{page}"
    );
}

#[test]
fn interrupted_and_partial_results_are_drawn_and_labelled() {
    let sixfold = two_studies();
    let mut study: Value = serde_json::from_str(&text(&sixfold, "b.json")).expect("JSON");
    study["findings"][0]["interrupted"] = true.into();
    study["planned"] = vec!["t.obj", "next.obj"].into();
    sixfold.file("part.json", &study.to_string());
    run_ok(
        &sixfold,
        &["compare", "a.json", "part.json", "--report", "changes"],
    );
    let page = text(&sixfold, "changes/report.md");
    for part in [
        "part.json was interrupted",
        "part.json is partial: 1 of 2 meshes not studied yet: next.obj.",
        "part.json (interrupted, partial): ",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
}

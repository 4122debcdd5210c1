//! Tests of Ctrl-C.
#![cfg(unix)]

use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::run::{Sixfold, send, text};

#[test]
fn an_interrupted_study_keeps_what_is_finished() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 40);
    let arguments = [
        "study",
        "grid.obj",
        "--budget",
        "10m",
        "--json",
        "kept.json",
    ];
    let start = Instant::now();
    sixfold.run_interrupted(&arguments, "INT", Duration::from_secs(2));
    assert!(
        start.elapsed() < Duration::from_secs(120),
        "it did not wait for the budget"
    );
    let report: Value = crate::json_csv::finding(&text(&sixfold, "kept.json"));
    assert_eq!(report["interrupted"], true);
    assert!(
        report["results"]
            .as_array()
            .is_some_and(|rows| !rows.is_empty())
    );
    assert_eq!(sixfold.names(), ["grid.obj", "kept.json"]);
}

#[test]
fn an_interrupted_report_has_the_finished_results() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 40);
    let arguments = ["study", "grid.obj", "--budget", "10m", "--report", "R"];
    sixfold.run_interrupted(&arguments, "INT", Duration::from_secs(4));
    let document = text(&sixfold, "R/results.json");
    let study: Value = crate::json_csv::finding(&document);
    assert_eq!(study["interrupted"], true);
    let page = text(&sixfold, "R/report.md");
    assert!(
        page.contains("Interrupted: some results are incomplete"),
        "{page}"
    );
    assert!(!page.contains("on 0 meshes"), "{page}");
    // `--resume` measures the mesh again.
    let studies = std::fs::read_dir(sixfold.folder().join("R/studies"));
    assert_eq!(studies.expect("the folder").count(), 0);
}

#[test]
fn an_interrupted_report_on_nothing_is_not_written() {
    let sixfold = Sixfold::new();
    // The first operation on this mesh takes longer than the time until the signal.
    sixfold.grid("grid.obj", 400);
    let arguments = ["study", "grid.obj", "--budget", "10m", "--report", "R"];
    let run = sixfold.run_interrupted(&arguments, "INT", Duration::from_millis(1));
    match run.stderr.contains("no result was finished") {
        true => assert_eq!(sixfold.names(), ["grid.obj"]),
        false => assert!(!text(&sixfold, "R/report.md").contains("on 0 meshes")),
    }
}

#[test]
fn an_interrupted_explanation_keeps_what_is_finished() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 40);
    let arguments = ["why", "grid.obj", "--budget", "10m", "--json", "kept.json"];
    let start = Instant::now();
    sixfold.run_interrupted(&arguments, "INT", Duration::from_secs(4));
    assert!(
        start.elapsed() < Duration::from_secs(120),
        "it did not wait for the budget"
    );
    let report: Value = crate::json_csv::finding(&text(&sixfold, "kept.json"));
    assert_eq!(report["interrupted"], true);
    assert_eq!(sixfold.names(), ["grid.obj", "kept.json"]);
}

#[test]
fn no_draft_is_left_after_an_interrupt() {
    let sixfold = Sixfold::new();
    for signal in ["INT", "TERM"] {
        let arguments = ["generate", "grid", "m=1500", "n=1500", "-o", "big.obj"];
        sixfold.run_interrupted(&arguments, signal, Duration::ZERO);
        assert!(sixfold.names().is_empty(), "{:?}", sixfold.names());
    }
}

#[test]
fn an_interrupted_decimation_writes_nothing() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 100);
    sixfold.file("out.obj", "precious");
    // A polygon soup scans all faces for each collapse, so this command would take minutes.
    let arguments = [
        "decimate",
        "grid.obj",
        "--ratio",
        "0.1",
        "--backend",
        "polygon-soup",
        "-o",
        "out.obj",
    ];
    let run = sixfold.run_interrupted(&arguments, "INT", Duration::from_millis(200));
    assert_eq!(run.stdout, "");
    assert_eq!(sixfold.names(), ["grid.obj", "out.obj"]);
    assert_eq!(text(&sixfold, "out.obj"), "precious");
}

#[test]
fn no_draft_is_left_after_two_interrupts_of_a_study() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 40);
    let arguments = [
        "study", "grid.obj", "--budget", "10m", "--json", "x.json", "--csv", "x.csv",
    ];
    let start = Instant::now();
    let mut child = sixfold.start(&arguments, 2);
    // Two signals may arrive as one signal, so signals are sent until the program ends.
    let status = loop {
        if let Some(status) = child.try_wait().expect("our child") {
            break status;
        }
        send("INT", &child);
        assert!(start.elapsed() < Duration::from_secs(120), "still runs");
        sleep(Duration::from_millis(1));
    };
    // One signal may be enough.
    assert!(matches!(status.code(), Some(4 | 130)), "{status}");
    let names = sixfold.names();
    assert!(
        names.iter().all(|name| !name.ends_with(".draft")),
        "{names:?}"
    );
}

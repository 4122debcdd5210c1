//! Tests of Ctrl-C. All wait for a step of the program, none for a time. The programs would not end in
//! hours, because they have a million rounds.
#![cfg(unix)]

use serde_json::Value;

use crate::run::{Sixfold, send, text, wait_for};

#[test]
fn an_interrupted_study_keeps_what_is_finished() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let arguments = [
        "study",
        "grid.obj",
        "--rounds",
        "1000000",
        "--json",
        "kept.json",
    ];
    sixfold.run_interrupted(&arguments, "INT", "measuring ");
    let report: Value = crate::json_csv::finding(&text(&sixfold, "kept.json"));
    assert_eq!(report["interrupted"], true);
    // Every operation was run once before the rounds.
    let rows = report["results"].as_array().expect("a list").len();
    let refusals = report["refusals"].as_array().expect("a list").len();
    assert_eq!(rows + refusals, 28 * 6);
    assert_eq!(sixfold.names(), ["grid.obj", "kept.json"]);
}

#[test]
fn an_interrupted_report_has_the_finished_results() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let arguments = ["study", "grid.obj", "--rounds", "1000000", "--report", "R"];
    let run = sixfold.run_interrupted(&arguments, "INT", "measuring ");
    let rest = "to measure the rest, run the same command with --resume: R has what is finished";
    assert!(run.stderr.contains(rest), "{run:?}");
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
    sixfold.grid("grid.obj", 20);
    let arguments = ["study", "grid.obj", "--rounds", "1000000", "--report", "R"];
    // The first operation may be finished before the program sees the signal.
    let run = sixfold.run_interrupted(&arguments, "INT", "warming up build");
    match run.stderr.contains("no result was finished") {
        true => assert_eq!(sixfold.names(), ["grid.obj"]),
        false => assert!(!text(&sixfold, "R/report.md").contains("on 0 meshes")),
    }
}

#[test]
fn an_interrupted_explanation_keeps_what_is_finished() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let arguments = [
        "why",
        "grid.obj",
        "--rounds",
        "1000000",
        "--json",
        "kept.json",
    ];
    sixfold.run_interrupted(&arguments, "INT", "measuring vertex_vertices");
    let report: Value = crate::json_csv::finding(&text(&sixfold, "kept.json"));
    assert_eq!(report["interrupted"], true);
    assert_eq!(report["rows"].as_array().map(Vec::len), Some(6 * 9));
    assert_eq!(sixfold.names(), ["grid.obj", "kept.json"]);
}

/// Makes a named pipe that nobody writes. A program that reads it waits.
fn endless_file(sixfold: &Sixfold, name: &str) {
    let path = sixfold.folder().join(name);
    let made = std::process::Command::new("mkfifo").arg(&path).status();
    assert!(made.expect("mkfifo runs").success());
}

#[test]
fn no_draft_is_left_after_an_interrupt() {
    for signal in ["INT", "TERM"] {
        let sixfold = Sixfold::new();
        endless_file(&sixfold, "endless.obj");
        let arguments = ["study", "endless.obj", "--json", "x.json", "--csv", "x.csv"];
        let mut child = sixfold.start_with_draft(&arguments);
        // The study waits for the mesh. The first signal asks it to stop, and the second ends it. Two
        // signals may arrive as one, so signals are sent until the program ends.
        let status = wait_for(|| {
            let status = child.try_wait().expect("our child");
            if status.is_none() {
                send(signal, &child);
            }
            status
        });
        assert_eq!(status.code(), Some(130), "{status}");
        assert_eq!(sixfold.names(), ["endless.obj"]);
    }
}

#[test]
fn no_draft_of_a_mesh_is_left_after_an_interrupt() {
    let sixfold = Sixfold::new();
    for signal in ["INT", "TERM"] {
        // Writing this mesh takes seconds. If it is written before the signal arrives, there is no
        // draft either.
        let arguments = ["generate", "grid", "m=1500", "n=1500", "-o", "big.obj"];
        let child = sixfold.start_with_draft(&arguments);
        send(signal, &child);
        let status = child.wait_with_output().expect("it ends").status;
        match status.code() {
            Some(0) => std::fs::remove_file(sixfold.folder().join("big.obj")).expect("written"),
            code => assert_eq!(code, Some(4), "{status}"),
        }
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
    let run = sixfold.run_interrupted(&arguments, "INT", "faces removed");
    assert_eq!(run.stdout, "");
    assert_eq!(sixfold.names(), ["grid.obj", "out.obj"]);
    assert_eq!(text(&sixfold, "out.obj"), "precious");
}

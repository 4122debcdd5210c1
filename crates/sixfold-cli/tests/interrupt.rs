//! Ctrl-C: the study ends between two samples, keeps what it has, and says so.
#![cfg(unix)]

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::run::Sixfold;

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
    let mut command = sixfold.command(&arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().expect("the binary runs");
    // The draft appears before the study begins; the handler is set soon after.
    let start = Instant::now();
    while sixfold.names().len() < 2 && start.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(20));
    }
    sleep(Duration::from_secs(2));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
    let output = child.wait_with_output().expect("it ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{stderr}");
    assert!(stderr.contains("interrupted"), "{stderr}");
    assert!(
        start.elapsed() < Duration::from_secs(120),
        "it did not wait for the budget"
    );
    let text = fs::read_to_string(sixfold.folder().join("kept.json")).expect("the file");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(report["interrupted"], true);
    assert!(
        report["results"]
            .as_array()
            .is_some_and(|rows| !rows.is_empty())
    );
    assert_eq!(sixfold.names(), ["grid.obj", "kept.json"]);
}

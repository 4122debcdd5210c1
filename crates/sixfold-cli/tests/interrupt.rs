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

#[test]
fn no_draft_outlives_an_interrupt() {
    let sixfold = Sixfold::new();
    for signal in ["-INT", "-TERM"] {
        let arguments = ["generate", "grid", "m=1500", "n=1500", "-o", "big.obj"];
        let mut command = sixfold.command(&arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("the binary runs");
        let start = Instant::now();
        while sixfold.names().is_empty() && start.elapsed() < Duration::from_secs(60) {
            sleep(Duration::from_millis(5));
        }
        let sent = Command::new("kill")
            .args([signal, child.id().to_string().as_str()])
            .status();
        assert!(sent.expect("kill runs").success());
        let output = child.wait_with_output().expect("it ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(4), "{stderr}");
        assert!(stderr.contains("interrupted"), "{stderr}");
        assert!(sixfold.names().is_empty(), "{:?}", sixfold.names());
    }
}

#[test]
fn an_interrupted_decimation_writes_nothing() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 100);
    sixfold.file("out.obj", "precious");
    // A soup searches all its faces for each collapse: it would take minutes.
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
    let mut command = sixfold.command(&arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().expect("the binary runs");
    let start = Instant::now();
    while sixfold.names().len() < 3 && start.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
    sleep(Duration::from_millis(200));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
    let output = child.wait_with_output().expect("it ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{stderr}");
    assert!(stderr.contains("interrupted"), "{stderr}");
    assert_eq!(output.stdout, b"");
    assert_eq!(sixfold.names(), ["grid.obj", "out.obj"]);
    let kept = fs::read_to_string(sixfold.folder().join("out.obj")).expect("the file");
    assert_eq!(kept, "precious");
}

#[test]
fn no_draft_outlives_two_interrupts_of_a_study() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 40);
    let arguments = [
        "study", "grid.obj", "--budget", "10m", "--json", "x.json", "--csv", "x.csv",
    ];
    let mut command = sixfold.command(&arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the binary runs");
    let start = Instant::now();
    while sixfold.names().len() < 3 && start.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
    // Two that come as one are one: until it ends, another follows.
    let status = loop {
        if let Some(status) = child.try_wait().expect("our child") {
            break status;
        }
        let sent = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(sent.expect("kill runs").success());
        assert!(start.elapsed() < Duration::from_secs(120), "it goes on");
        sleep(Duration::from_millis(1));
    };
    // The first may have been enough.
    assert!(matches!(status.code(), Some(4 | 130)), "{status}");
    let names = sixfold.names();
    assert!(
        names.iter().all(|name| !name.ends_with(".draft")),
        "{names:?}"
    );
}

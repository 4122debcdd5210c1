//! Tests of external programs as columns of a study.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::run::{Run, Sixfold, TETRAHEDRON, send, wait_for};

fn has_python() -> bool {
    let found = Command::new("python3").arg("--version").output();
    let there = found.is_ok_and(|output| output.status.success());
    assert!(
        there || std::env::var_os("SIXFOLD_MESHES").is_none(),
        "developers have python3"
    );
    there
}

fn repository() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().and_then(Path::parent).expect("two floors up")
}

/// Studies a tetrahedron with an external program. `mode` selects how the program fails.
fn study_with_program(mode: &str, more: &[&str]) -> (Sixfold, Run) {
    let sixfold = Sixfold::new();
    let arguments = with_program(&sixfold, mode, more);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let run = sixfold.run(&arguments);
    (sixfold, run)
}

/// Returns the arguments of a study of a tetrahedron with an external program.
fn with_program(sixfold: &Sixfold, mode: &str, more: &[&str]) -> Vec<String> {
    sixfold.file("t.obj", TETRAHEDRON);
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/external/misbehaving.py");
    let external = format!(
        "other=python3 '{}' {{mesh}} '{mode}' pid.txt",
        program.display()
    );
    let arguments = [
        "study",
        "t.obj",
        "--rounds",
        "8",
        "--operations",
        "boundary,edge_length",
        "--json",
        "s.json",
        "--external",
        &external,
    ];
    let all = arguments.iter().chain(more);
    all.map(|&argument| argument.to_owned()).collect()
}

fn report(sixfold: &Sixfold) -> Value {
    crate::json_csv::finding(&crate::run::text(sixfold, "s.json"))
}

fn row<'v>(report: &'v Value, backend: &str, operation: &str) -> Option<&'v Value> {
    let mut rows = report["results"].as_array().expect("rows").iter();
    rows.find(|row| row["backend"] == backend && row["operation"] == operation)
}

fn refusal(report: &Value, operation: &str) -> String {
    let mut rows = report["refusals"].as_array().expect("refusals").iter();
    let row = rows.find(|row| row["backend"] == "other" && row["operation"] == operation);
    let row = row.unwrap_or_else(|| panic!("no refusal of {operation}: {report}"));
    row["reason"].as_str().expect("a reason").to_owned()
}

#[test]
fn the_documented_example_does_the_same_work() {
    if !has_python() {
        return;
    }
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let program = repository().join("benches/external/corner_lists.py");
    let external = format!("lists=python3 '{}' {{mesh}}", program.display());
    let arguments = [
        "study",
        "grid.obj",
        "--rounds",
        "2",
        "--json",
        "s.json",
        "--external",
        &external,
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(0), "{run:?}");
    let report = report(&sixfold);
    for operation in [
        "build",
        "vertex_faces",
        "face_vertices",
        "circulate",
        "face_barycenter",
        "vertex_normal",
    ] {
        let row = row(&report, "lists", operation);
        let row = row.unwrap_or_else(|| panic!("no row of {operation}"));
        assert_eq!(row["agreement"], "same", "{row}");
        assert!(row["standing"].is_string(), "{row}");
        let ours = self::row(&report, "half-edge", operation).expect("ours");
        assert_eq!(row["elements"], ours["elements"], "{operation}");
    }
    assert_eq!(row(&report, "lists", "vv_smooth"), None);
    let column = &report["backends"]["lists"];
    assert_eq!(column["external"]["library"], "lists of Python", "{column}");
    assert_eq!(column["external"]["command"][2], "{mesh}");
    assert!(column["bytes"].is_null() && column["capabilities"].is_null());
    assert!(run.stdout.contains("lists"), "{}", run.stdout);
}

#[test]
fn a_refusal_of_a_program_is_shown() {
    if !has_python() {
        return;
    }
    let (sixfold, run) = study_with_program("well", &[]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let report = report(&sixfold);
    assert_eq!(
        refusal(&report, "edge_length"),
        "it measures\\u{1b}[31m no lengths"
    );
    assert_eq!(row(&report, "other", "edge_length"), None);
    let row = row(&report, "other", "boundary").expect("a row");
    assert_eq!(row["agreement"], "same");
    let taken = row["samples"].as_u64().zip(row["disturbed"].as_u64());
    assert_eq!(taken.map(|(counted, not)| counted + not), Some(8), "{row}");
    assert!(
        run.stdout.contains("it measures\\u{1b}[31m no lengths"),
        "{run:?}"
    );
}

#[test]
fn a_failing_program_is_reported_and_the_study_continues() {
    if !has_python() {
        return;
    }
    for (mode, more, message) in [
        ("refuses", &[][..], "it is Tuesday"),
        ("other version", &[], "version 7 of the protocol"),
        ("rubbish", &[], "Segmentation fault (not really)"),
        ("crashes at once", &[], "no licence found"),
        ("endless line", &[], "longer than 65536 bytes"),
        ("wrong unit", &[], "but its answer took"),
        ("no time", &[], "no `wall_ns`"),
        ("hangs", &["--patience", "300ms"], "within 0.3 s"),
        ("crashes later", &[], "out of luck"),
        ("answers twice", &[], "without a request"),
    ] {
        let (sixfold, run) = study_with_program(mode, more);
        // A program may refuse a mesh.
        let code = if mode == "refuses" { 0 } else { 1 };
        assert_eq!(run.code, Some(code), "{mode}: {run:?}");
        assert!(!run.stderr.contains("panicked"), "{mode}: {run:?}");
        let missing = run.stderr.lines().last().unwrap_or_default();
        let names = missing.contains("error: t.obj: results of other are missing: ")
            && missing.contains(message)
            && missing.contains("leave out --external other");
        assert_eq!(names, mode != "refuses", "{mode}: {run:?}");
        let unbroken = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(unbroken.contains(message), "{mode}: {run:?}");
        let report = report(&sixfold);
        let ours = row(&report, "half-edge", "boundary").expect("ours");
        assert_eq!(ours["agreement"], "same", "{mode}");
        let before = row(&report, "other", "boundary");
        assert_eq!(
            before.is_some(),
            mode == "crashes later" || mode == "answers twice",
            "{mode}: {before:?}"
        );
        assert_eq!(sixfold.names(), ["s.json", "t.obj"], "{mode}");
    }
}

#[test]
fn results_of_a_program_that_fails_in_one_launch_are_incomplete() {
    if !has_python() {
        return;
    }
    let more = ["--launches", "2", "--keep-going"];
    let (sixfold, run) = study_with_program("crashes later", &more);
    assert_eq!(run.code, Some(0), "{run:?}");
    let note =
        "note: t.obj: results of other are missing: it ended (exit status: 1): out of luck\n";
    assert!(run.stderr.ends_with(note), "{run:?}");
    let failed = &report(&sixfold)["backends"]["other"]["external"]["failed"];
    assert_eq!(failed, "it ended (exit status: 1): out of luck");
}

#[test]
fn a_program_with_another_number_of_elements_is_a_mismatch() {
    if !has_python() {
        return;
    }
    let (sixfold, run) = study_with_program("other elements", &[]);
    assert_eq!(run.code, Some(1), "{run:?}");
    let report = report(&sixfold);
    let theirs = row(&report, "other", "boundary").expect("theirs");
    assert_eq!(theirs["agreement"], "mismatch");
}

#[test]
fn a_program_with_another_checksum_is_not_ranked() {
    if !has_python() {
        return;
    }
    let (sixfold, run) = study_with_program("other checksum", &[]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(
        run.stderr
            .contains("other: the checksum of boundary is 3, but 0"),
        "{}",
        run.stderr
    );
    assert!(!run.stderr.contains("fault in Sixfold"), "{}", run.stderr);
    let report = report(&sixfold);
    let theirs = row(&report, "other", "boundary").expect("theirs");
    assert_eq!(theirs["agreement"], "mismatch");
    assert!(theirs["standing"].is_null() && theirs["ratio_to_best"].is_null());
    let ours = row(&report, "half-edge", "boundary").expect("ours");
    assert_eq!(ours["agreement"], "same");
}

#[cfg(target_os = "linux")]
#[test]
fn child_processes_of_a_program_end_with_the_study() {
    if !has_python() {
        return;
    }
    let sixfold = Sixfold::new();
    let arguments = with_program(&sixfold, "child that hangs", &[]);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let study = sixfold.start(&arguments);
    // The program has started its child when it has written the number of the child.
    let child = wait_for(|| {
        sixfold
            .names()
            .contains(&"pid.txt".to_owned())
            .then(|| crate::run::text(&sixfold, "pid.txt"))
            .filter(|pid| !pid.is_empty())
    });
    send("INT", &study);
    let output = study.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    let stat = std::fs::read_to_string(format!("/proc/{child}/stat"));
    // The process has ended, or is a zombie.
    assert!(
        stat.as_ref().map_or(true, |stat| stat.contains(") Z ")),
        "{stat:?}"
    );
}

#[test]
fn invalid_commands_are_refused_before_anything_is_measured() {
    let sixfold = Sixfold::new();
    for (given, message) in [
        ("run {mesh}", "has no name"),
        ("a b=run {mesh}", "not a program name"),
        ("a=run", "no {mesh}"),
        (
            "half-edge=run {mesh}",
            "two backends or programs are called `half-edge`",
        ),
    ] {
        let run = sixfold.run(&["study", "--external", given]);
        assert_eq!(run.code, Some(2), "{given}: {run:?}");
        assert!(run.stderr.contains(message), "{given}: {run:?}");
        assert_eq!(run.stdout, "", "{given}");
    }
    sixfold.file("t.obj", TETRAHEDRON);
    let no_program = "a=/no/such {mesh}";
    let run = sixfold.run(&["study", "t.obj", "--rounds", "2", "--external", no_program]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.stdout.contains("cannot be started"), "{run:?}");
}

//! Tests of standard output and of output files.

use std::fs;
use std::io::Read;
use std::process::Stdio;

use crate::run::{Sixfold, TETRAHEDRON};

#[test]
fn data_on_standard_output_has_no_text_beside_it() {
    let sixfold = Sixfold::new();
    sixfold.file("mesh.obj", &format!("{TETRAHEDRON}vt 0 0\nf 1 1 2\n"));
    let study = [
        "study",
        "mesh.obj",
        "--rounds",
        "2",
        "--operations",
        "build",
    ];
    let run = sixfold.run(&[&study[..], &["--csv", "-"]].concat());
    assert!(run.stdout.starts_with("mesh,vertices,edges,"), "{run:?}");
    let fields = run.stdout.lines().map(|line| line.split(',').count());
    assert!(
        fields.clone().all(|n| Some(n) == fields.clone().next()),
        "{run:?}"
    );
    assert!(
        run.stderr.contains("left out"),
        "notes are on standard error: {run:?}"
    );
    let run = sixfold.run(&[&study[..], &["--json", "x.json"]].concat());
    assert!(
        run.stdout.contains("build") && run.stdout.contains("mesh.obj"),
        "{run:?}"
    );
    assert!(
        !run.stdout.contains('\u{1b}'),
        "no colours if standard output is not a terminal"
    );
    let run = sixfold.run(&["generate", "cube", "-o", "-"]);
    assert_eq!(run.code, Some(0));
    assert!(
        run.stdout
            .lines()
            .all(|line| line.starts_with(['#', 'v', 'f'])),
        "{run:?}"
    );
}

#[test]
fn a_generated_shape_reads_back_in_any_order() {
    let sixfold = Sixfold::new();
    for order in ["given", "shuffled", "morton", "breadth-first"] {
        let arguments = [
            "generate", "torus", "m=6", "n=5", "--order", order, "-o", "t.obj",
        ];
        let run = sixfold.run(&arguments);
        assert_eq!(run.code, Some(0), "{run:?}");
        let run = sixfold.run(&["inspect", "t.obj"]);
        let facts = "30 vertices, 60 edges, 30 faces; Euler characteristic 0";
        assert!(run.stdout.contains(facts), "{order}: {run:?}");
        assert!(run.stdout.contains("genus 1"), "{order}: {run:?}");
    }
}

#[test]
fn a_failed_run_leaves_the_old_file() {
    let sixfold = Sixfold::new();
    sixfold.file("old.json", "precious");
    let run = sixfold.run(&["study", "missing.obj", "--json", "old.json"]);
    assert_eq!(run.code, Some(2));
    let kept = fs::read_to_string(sixfold.folder().join("old.json")).expect("the file");
    assert_eq!(kept, "precious");
    assert_eq!(sixfold.names(), ["old.json"]);
    sixfold.file("mesh.obj", TETRAHEDRON);
    let run = sixfold.run(&["inspect", "mesh.obj", "--json", "old.json"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(sixfold.names(), ["mesh.obj", "old.json"]);
    let new = fs::read_to_string(sixfold.folder().join("old.json")).expect("the file");
    assert!(new.starts_with('{'));
}

#[test]
fn a_closed_pipe_does_not_cause_a_panic() {
    let sixfold = Sixfold::new();
    for arguments in [
        &["generate", "grid", "m=200", "n=200", "-o", "-"][..],
        &["study", "--rounds", "2", "--operations", "build"],
        &["generate", "--help"],
    ] {
        let mut command = sixfold.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the binary runs");
        drop(child.stdout.take());
        let status = child.wait().expect("it ends");
        let mut errors = String::new();
        let stderr = child.stderr.as_mut().expect("piped");
        stderr.read_to_string(&mut errors).expect("UTF-8");
        assert!(!errors.contains("panicked"), "{arguments:?}: {errors}");
        assert_eq!(status.code(), Some(0), "{arguments:?}: {errors}");
    }
}

#[cfg(unix)]
#[test]
fn a_device_is_written_to_and_not_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let sixfold = Sixfold::new();
    sixfold.file("mesh.obj", TETRAHEDRON);
    let run = sixfold.run(&["inspect", "mesh.obj", "--json", "/dev/null"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let device = fs::metadata("/dev/null").expect("there");
    assert!(device.file_type().is_char_device());
}

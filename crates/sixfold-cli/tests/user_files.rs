//! Tests that commands do not damage files of the user.

use std::fs;

use serde_json::Value;

use crate::json_csv::finding;
use crate::run::{Sixfold, TETRAHEDRON};

#[test]
fn no_output_overwrites_the_mesh_or_another_output() {
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    let same = fs::canonicalize(sixfold.folder()).expect("a folder");
    let same = same.join("ok.obj").display().to_string();
    for (arguments, message) in [
        (&["study", "ok.obj", "--json", "ok.obj"][..], "overwrite"),
        (&["study", "ok.obj", "--csv", "./ok.obj"], "overwrite"),
        (&["study", "./ok.obj", "--json", &same], "overwrite"),
        (&["inspect", "ok.obj", "--json", &same], "overwrite"),
        (&["memory", "ok.obj", "--json", &same], "overwrite"),
        // The budget is a week, so the command must be refused before it measures.
        (
            &[
                "study", "ok.obj", "--budget", "10000m", "--json", "new", "--csv", "./new",
            ],
            "two different files",
        ),
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
        assert_eq!(run.stdout, "");
        assert_eq!(sixfold.names(), ["ok.obj"]);
        let kept = fs::read_to_string(sixfold.folder().join("ok.obj")).expect("the file");
        assert_eq!(kept, TETRAHEDRON);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn text_that_cannot_be_written_is_an_error() {
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    for arguments in [
        &["study", "ok.obj", "--rounds", "2", "--json", "x.json"][..],
        &["inspect", "ok.obj"],
        &["generate", "cube", "-o", "cube.obj"],
        &["generate", "cube", "-o", "-"],
        &["decimate", "ok.obj", "--faces", "4", "-o", "small.obj"],
        &["edits"],
        &["memory", "ok.obj"],
        &["--help"],
        &["study", "--help"],
        &["--version"],
    ] {
        let full = fs::File::options().write(true).open("/dev/full");
        let mut command = sixfold.command(arguments);
        let output = command.stdout(full.expect("the device")).output();
        let output = output.expect("the binary runs");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains("standard output: cannot be written"));
    }
    assert_eq!(
        sixfold.names(),
        ["cube.obj", "ok.obj", "small.obj", "x.json"]
    );
}

#[cfg(target_os = "linux")]
/// Each file may have at most 4 blocks, as on a disk with little space. The results on standard
/// output are not limited.
#[test]
fn a_full_disk_under_the_report_does_not_lose_the_study() {
    let sixfold = Sixfold::new();
    sixfold.file("t.obj", crate::run::TETRAHEDRON);
    let run = |more: &[&str]| {
        let command = sixfold.command(&[]);
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\""]);
        shell.arg(command.get_program());
        shell.args(["study", "t.obj", "--rounds", "2", "--labs", "orders"]);
        shell
            .args(["--operations", "boundary,edge_length"])
            .args(more);
        shell.current_dir(sixfold.folder());
        let output = shell.output().expect("sh runs");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        let (stdout, stderr) = (text(output.stdout), text(output.stderr));
        assert_eq!(output.status.code(), Some(2), "{stdout}\n{stderr}");
        assert!(stderr.contains("cannot be written"), "{stderr}");
        stdout
    };
    let table = run(&["--report", "out"]);
    assert!(table.contains("edge_length"), "{table}");
    let document = run(&["--report", "other", "--json", "-"]);
    let document: serde_json::Value = serde_json::from_str(&document).expect("JSON");
    let kinds = document["findings"].as_array().expect("a list").iter();
    let kinds: Vec<_> = kinds.map(|finding| &finding["kind"]).collect();
    assert_eq!(kinds, ["study", "orders"]);
}

#[test]
fn a_full_disk_does_not_lose_the_study() {
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    let arguments = [
        "study",
        "ok.obj",
        "--rounds",
        "2",
        "--json",
        "/dev/full",
        "--csv",
        "x.csv",
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stderr.contains("error: /dev/full"), "{run:?}");
    assert!(run.stdout.contains("vv_smooth"), "{run:?}");
    let csv = fs::read_to_string(sixfold.folder().join("x.csv")).expect("the file");
    assert!(csv.lines().count() > 1);
    let run = sixfold.run(&["inspect", "ok.obj", "--json", "/dev/full"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stdout.contains("4 vertices"), "{run:?}");
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_its_mode() {
    use std::os::unix::fs::PermissionsExt;
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    let secret = sixfold.file("secret.json", "old");
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o600)).expect("our file");
    let run = sixfold.run(&["inspect", "ok.obj", "--json", "secret.json"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let mode = fs::metadata(&secret)
        .expect("the file")
        .permissions()
        .mode();
    assert_eq!(mode & 0o777, 0o600);
    assert!(fs::read_to_string(&secret).expect("ours").starts_with('{'));
}

#[cfg(unix)]
#[test]
fn file_names_cannot_control_the_terminal() {
    let sixfold = Sixfold::new();
    let name = "a\u{1b}[31mb\nc.obj";
    sixfold.file(name, &format!("{TETRAHEDRON}f 1 1 2\n"));
    for arguments in [
        &["inspect", name][..],
        &["study", name, "--rounds", "2"],
        &["inspect", "none\u{1b}[2J.obj"],
        &["decimate", name, "--faces", "0", "-o", "x\u{1b}[2J.obj"],
        &["generate", "cube", "-o", name],
        &["generate", name, "-o", "x.obj"],
    ] {
        let run = sixfold.run(arguments);
        let text = format!("{}{}", run.stdout, run.stderr);
        assert!(text.contains("\\u{1b}["), "{run:?}");
        assert!(!text.contains('\u{1b}'), "{run:?}");
        assert!(!text.contains("b\nc.obj"), "{run:?}");
    }
}

#[test]
fn json_is_written_if_all_backends_refuse() {
    let sixfold = Sixfold::new();
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("book.obj", book);
    let arguments = [
        "study",
        "book.obj",
        "--backends",
        "half-edge",
        "--json",
        "-",
        "--csv",
        "x.csv",
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(3), "{run:?}");
    assert!(run.stderr.contains("f0, f1, f2"), "{run:?}");
    let report = finding(&run.stdout);
    assert_eq!(report["mesh"]["non_manifold_edges"], 1);
    let backends = report["backends"].as_object().expect("a map");
    assert_eq!(backends.len(), 1, "only the selected backend is listed");
    assert_eq!(backends["half-edge"]["holds"], false);
    let reason = backends["half-edge"]["reason"].as_str().expect("a reason");
    assert!(reason.contains("f0, f1, f2"), "{reason}");
    assert_eq!(report["results"], Value::Array(Vec::new()));
    let csv = fs::read_to_string(sixfold.folder().join("x.csv")).expect("the file");
    assert!(csv.starts_with("mesh,vertices,") && csv.lines().count() == 1);
}

#[test]
fn a_triangulation_that_changes_more_than_faces_is_reported() {
    let sixfold = Sixfold::new();
    // Both diagonals of the quad are already edges of two triangles.
    let shared = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 1\nv 2 2 -1\nf 1 2 3 4\nf 1 3 5\n\
                  f 3 1 6\nf 2 4 5\nf 4 2 6\n";
    sixfold.file("shared.obj", shared);
    sixfold.file(
        "crossing.obj",
        "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    sixfold.file(
        "square.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    for (name, expected) in [
        ("shared.obj", "non-manifold edges: 0 before, 1 now"),
        ("crossing.obj", "1 face crosses itself"),
    ] {
        let study = ["study", name, "--triangulate", "--rounds", "2"];
        let run = sixfold.run(&study);
        assert!(run.stderr.contains(expected), "{run:?}");
        let words = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(expected), "{run:?}");
    }
    let run = sixfold.run(&["study", "square.obj", "--triangulate", "--rounds", "2"]);
    assert!(
        run.stdout.contains("cut 1 face into 2 triangles"),
        "{run:?}"
    );
    assert!(!run.stderr.contains("--triangulate"), "{run:?}");
}

#[test]
fn wrong_arguments_get_a_useful_hint() {
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    for (arguments, message) in [
        (&["ok.obj"][..], "did you mean `sixfold study ok.obj`?"),
        (
            &["study", "ok.obj", "--seed", "-1"],
            "the seed must be a whole number from 0",
        ),
        (
            &["study", "ok.obj", "--seed", "x"],
            "the seed must be a whole number from 0",
        ),
        (&["study", "ok.obj", "--budget", "-1s"], "above 0"),
        (
            &["inspect", "-"],
            "standard input: the format is not recognised",
        ),
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
    }
}

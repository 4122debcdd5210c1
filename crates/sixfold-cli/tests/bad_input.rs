//! Tests of bad input: the error, the exit code and the written files.

use crate::run::{Run, Sixfold, TETRAHEDRON};

/// Asserts one `error:` line that contains `message`, an empty standard output, and no new file.
pub(crate) fn assert_refused(
    sixfold: &Sixfold,
    arguments: &[&str],
    code: i32,
    message: &str,
) -> Run {
    let before = sixfold.names();
    let run = sixfold.run(arguments);
    assert_eq!(run.code, Some(code), "{arguments:?}: {run:?}");
    let errors = run
        .stderr
        .lines()
        .filter(|line| line.starts_with("error: "));
    assert_eq!(errors.count(), 1, "{arguments:?}: {run:?}");
    assert!(
        run.stderr.contains(message),
        "{arguments:?}: no {message:?} in {run:?}"
    );
    assert!(!run.stderr.contains("panicked"), "{run:?}");
    // A pick prints the mesh and the mix before it builds anything.
    assert!(
        run.stdout.is_empty() || run.stdout.starts_with("Model:"),
        "{arguments:?}: {run:?}"
    );
    assert_eq!(sixfold.names(), before, "{arguments:?} wrote something");
    run
}

#[test]
fn unusable_files_are_refused_by_both_commands() {
    let sixfold = Sixfold::new();
    sixfold.file("empty.obj", "");
    sixfold.file("comment.obj", "# nothing\n");
    sixfold.file("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
    sixfold.file("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    sixfold.file("infinite.obj", "v 0 0 0\nv 1 1e99 0\nv 0 1 0\nf 1 2 3\n");
    std::fs::create_dir(sixfold.folder().join("folder.obj")).expect("a folder");
    for (file, message) in [
        ("empty.obj", "empty.obj"),
        ("comment.obj", "comment.obj"),
        ("range.obj", "range.obj:4"),
        ("nan.obj", "nan.obj:2"),
        ("infinite.obj", "infinite.obj:2"),
        ("folder.obj", "directory"),
        ("missing.obj", "missing.obj"),
    ] {
        for command in ["inspect", "study"] {
            assert_refused(&sixfold, &[command, file, "--json", "out.json"], 2, message);
        }
    }
}

#[test]
fn a_file_of_points_has_facts_but_no_study() {
    let sixfold = Sixfold::new();
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    let run = sixfold.run(&["inspect", "points.obj"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.stdout.contains("2 vertices"), "{run:?}");
    assert_refused(&sixfold, &["study", "points.obj"], 2, "no faces");
}

#[test]
fn degenerate_faces_are_left_out_with_a_note_or_refused() {
    let sixfold = Sixfold::new();
    let text = format!("{TETRAHEDRON}f 1 1 2\nf 1 2\n");
    sixfold.file("degenerate.obj", &text);
    let run = sixfold.run(&["study", "degenerate.obj", "--rounds", "2"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    for place in ["left out 2 degenerate faces", "line 9", "line 10"] {
        assert!(run.stderr.contains(place), "{run:?}");
    }
    assert!(
        run.stdout.contains("left out 2 degenerate faces"),
        "{run:?}"
    );
    assert!(run.stdout.contains("2 degenerate faces"), "{run:?}");
    let run = sixfold.run(&["inspect", "degenerate.obj"]);
    for place in ["line 9", "line 10"] {
        assert!(run.stderr.contains(place), "{run:?}");
    }
    assert!(run.stdout.contains("2 degenerate faces"), "{run:?}");
    assert_refused(
        &sixfold,
        &["study", "degenerate.obj", "--strict"],
        2,
        "line 9",
    );
    sixfold.file("nothing_else.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n");
    assert_refused(
        &sixfold,
        &["study", "nothing_else.obj"],
        2,
        "no faces except 1 degenerate",
    );
}

#[test]
fn wrong_usage_says_what_is_allowed() {
    let sixfold = Sixfold::new();
    sixfold.file("mesh.obj", TETRAHEDRON);
    for (arguments, message) in [
        (
            &["study", "mesh.obj", "--backends", "abacus"][..],
            "half-edge",
        ),
        (&["study", "mesh.obj", "--operations", "fly"], "vv_smooth"),
        (&["study", "mesh.obj", "--budget", "0s"], "above 0"),
        (&["study", "mesh.obj", "--budget", "soon"], "500ms"),
        (&["study", "mesh.obj", "--rounds", "0"], "from 1 to"),
        (&["pick", "mesh.obj", "--rounds", "-3"], "from 1 to"),
        (&["orders", "mesh.obj", "--rounds", "many"], "whole number"),
        (&["growth", "--rounds", "2.5"], "whole number"),
        (
            &["neighbours", "mesh.obj", "--rounds", "4294967296"],
            "4294967295",
        ),
        (
            &["study", "mesh.obj", "--rounds", "2", "--budget", "1s"],
            "cannot be used with",
        ),
        (
            &["growth", "--budget", "1s", "--rounds", "2"],
            "cannot be used with",
        ),
        (
            &["study", "mesh.obj", "--json", "no/such/folder.json"],
            "folder.json",
        ),
        (&["study", "mesh.obj", "--json", "."], "directory"),
        (
            &["study", "mesh.obj", "--json", "-", "--csv", "-"],
            "two different files",
        ),
        (&["generate", "teapot", "-o", "x.obj"], "icosahedron"),
        (&["generate", "torus", "q=3", "-o", "x.obj"], "q"),
        (&["generate", "torus", "m=2", "-o", "x.obj"], "m"),
        (&["generate", "torus", "m", "-o", "x.obj"], "name=number"),
        (
            &["generate", "torus", "--order", "odd", "-o", "x.obj"],
            "morton",
        ),
        (&["generate", "torus"], "--output"),
        (&["fly"], "fly"),
    ] {
        assert_refused(&sixfold, arguments, 2, message);
    }
}

#[test]
fn a_mesh_that_no_selected_backend_can_hold_has_its_own_exit_code() {
    let sixfold = Sixfold::new();
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("book.obj", book);
    let arguments = ["study", "book.obj", "--backends", "half-edge"];
    assert_refused(&sixfold, &arguments, 3, "f0, f1, f2");
    let run = sixfold.run(&["study", "book.obj", "--rounds", "2"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let mut refusals = run
        .stdout
        .lines()
        .filter(|line| line.starts_with("refused by"));
    assert!(refusals.any(|line| line.contains("half-edge")), "{run:?}");
}

/// On two triangles with the same corners, structures refuse equally many but different edits. That
/// is not a fault.
#[test]
fn different_refused_edits_on_a_pillow_are_not_a_fault() {
    let sixfold = Sixfold::new();
    sixfold.file("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
    for pass in ["split_collapse", "flip_all", "decimate_half"] {
        let arguments = ["study", "p.obj", "--rounds", "2", "--operations", pass];
        let run = sixfold.run(&arguments);
        assert_eq!(run.code, Some(0), "{pass}: {run:?}");
    }
}

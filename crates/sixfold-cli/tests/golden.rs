//! Compares text that does not depend on the clock with golden files. `SIXFOLD_GOLDEN=write`
//! rewrites the golden files.

use std::fs;
use std::path::Path;

use crate::run::{Sixfold, TETRAHEDRON};

fn golden(name: &str, text: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let path = folder.join(name);
    if std::env::var_os("SIXFOLD_GOLDEN").is_some_and(|value| value == "write") {
        fs::create_dir_all(&folder).expect("the folder");
        fs::write(&path, text).expect("the file");
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(
        text, expected,
        "{name} differs; SIXFOLD_GOLDEN=write rewrites it"
    );
}

/// Returns the text that a command prints. Asserts that no line is wider than 100 columns.
fn printed(sixfold: &Sixfold, arguments: &[&str]) -> String {
    let run = sixfold.run(arguments);
    assert_eq!(run.code, Some(0), "{run:?}");
    for line in run.stdout.lines() {
        assert!(line.chars().count() <= 100, "too wide: {line}");
    }
    run.stdout
}

#[test]
fn help() {
    let sixfold = Sixfold::new();
    for (name, arguments) in [
        ("help.txt", &["--help"][..]),
        ("help_study.txt", &["study", "--help"]),
        ("help_why.txt", &["why", "--help"]),
        ("help_orders.txt", &["orders", "--help"]),
        ("help_growth.txt", &["growth", "--help"]),
        ("help_pick.txt", &["pick", "--help"]),
        ("help_new.txt", &["new", "--help"]),
        ("help_workloads.txt", &["workloads", "--help"]),
        ("help_operations.txt", &["operations", "--help"]),
        ("help_inspect.txt", &["inspect", "--help"]),
        ("help_distance.txt", &["distance", "--help"]),
        ("help_memory.txt", &["memory", "--help"]),
        ("help_compare.txt", &["compare", "--help"]),
        ("help_history.txt", &["history", "--help"]),
        ("help_merge.txt", &["merge", "--help"]),
        ("help_report.txt", &["report", "--help"]),
        ("help_generate.txt", &["generate", "--help"]),
        ("help_render.txt", &["render", "--help"]),
        ("help_repair.txt", &["repair", "--help"]),
        ("help_schemes.txt", &["schemes", "--help"]),
        ("help_subdivide.txt", &["subdivide", "--help"]),
        ("help_smooth.txt", &["smooth", "--help"]),
        ("help_dual.txt", &["dual", "--help"]),
        ("help_triangulate.txt", &["triangulate", "--help"]),
        ("help_edits.txt", &["edits", "--help"]),
        ("help_decimate.txt", &["decimate", "--help"]),
        ("help_remesh.txt", &["remesh", "--help"]),
        ("help_completions.txt", &["completions", "--help"]),
        ("help_manual.txt", &["manual", "--help"]),
    ] {
        golden(name, &printed(&sixfold, arguments));
    }
}

#[test]
fn schemes() {
    golden("schemes.txt", &printed(&Sixfold::new(), &["schemes"]));
}

#[test]
fn edits() {
    golden("edits.txt", &printed(&Sixfold::new(), &["edits"]));
}

#[test]
fn workloads() {
    let sixfold = Sixfold::new();
    golden("workloads.txt", &printed(&sixfold, &["workloads"]));
    golden(
        "workload_operations.txt",
        &printed(&sixfold, &["workloads", "--operations"]),
    );
}

#[test]
fn operations() {
    golden("operations.txt", &printed(&Sixfold::new(), &["operations"]));
}

#[test]
fn memories() {
    let sixfold = Sixfold::new();
    golden("memory.txt", &printed(&sixfold, &["memory"]));
    // The mesh has mixed degrees, and two vertices at the same position.
    let seam =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 5 6 7\n";
    sixfold.file("seam.obj", seam);
    let some = [
        "memory",
        "seam.obj",
        "--backends",
        "polygon-soup,half-edge,corner-table",
    ];
    golden("memory_seam.txt", &printed(&sixfold, &some));
}

#[test]
fn counts() {
    let why = ["why", "--counts-only"];
    golden("why_counts.txt", &printed(&Sixfold::new(), &why));
}

#[test]
fn inspections() {
    let sixfold = Sixfold::new();
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nv 9 9 9\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    let bow_tie = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\nf 1 2 2\n";
    let flipped = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4 \nf 1 3 4\n";
    for (name, text) in [
        ("tetrahedron", TETRAHEDRON),
        ("book", book),
        ("bow_tie", bow_tie),
        ("flipped", flipped),
        ("points", "v 0 0 0\n"),
    ] {
        let file = format!("{name}.obj");
        sixfold.file(&file, text);
        let text = printed(&sixfold, &["inspect", &file]);
        golden(&format!("inspect_{name}.txt"), &text);
    }
}

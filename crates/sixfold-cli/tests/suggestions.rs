//! Unknown names have suggestions, and messages name what the user wrote.

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, run_ok};

#[test]
fn unknown_names_suggest_the_nearest_one() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 4);
    let commands: [(&[&str], &str); 12] = [
        (
            &["studdy"],
            "no command is called `studdy` (did you mean `study`?)",
        ),
        (
            &["help", "studdy"],
            "no command is called `studdy` (did you mean `study`?)",
        ),
        (
            &["xyz"],
            "no command is called `xyz`: `sixfold --help` lists",
        ),
        (
            &["generate", "geodesic", "freq=30", "-o", "out.obj"],
            "no parameter \"freq\" (did you mean `frequency`?): choose from frequency",
        ),
        (
            &["generate", "sphere", "-o", "out.obj"],
            "did you mean `uv-sphere`?",
        ),
        (&["generate", "spere"], "did you mean `uv-sphere`?"),
        (
            &["tables", "--relations", "VV"],
            "`sixfold tables` has no option --relations, but `sixfold why` has it",
        ),
        (
            &["dual", "grid.obj", "--seed", "3", "-o", "out.obj"],
            "have it: `sixfold dual --help` lists its options",
        ),
        (&["growth", "--shape", "sphere"], "did you mean `geodesic`?"),
        (
            &["study", "--operations", "VV"],
            "did you mean `vertex_vertices`?",
        ),
        (
            &["neighbours", "--indices", "octre"],
            "did you mean `octree`?",
        ),
        (
            &["why", "--relations", "vertexfaces"],
            "did you mean `vertex_faces`?",
        ),
    ];
    for (command, message) in commands {
        assert_refused(&sixfold, command, 2, message);
        let run = sixfold.run(command);
        assert!(!run.stderr.contains("subcommand"), "{run:?}");
    }
    let short = ["why", "grid.obj", "--relations", "VV,FE", "--counts-only"];
    let run = run_ok(&sixfold, &short);
    assert!(run.stdout.contains("face_edges"), "{run:?}");
}

#[test]
fn advice_fits_the_command_and_the_mesh() {
    let sixfold = Sixfold::new();
    run_ok(&sixfold, &["generate", "grid", "-o", "quads.obj"]);
    let decimate = ["decimate", "quads.obj", "--ratio", "0.5", "-o", "out.obj"];
    let run = sixfold.run(&decimate);
    assert!(!run.stderr.contains("remeshing"), "{run:?}");
    assert!(
        run.stderr.contains("a mesh of triangles is needed"),
        "{run:?}"
    );
    let dual = ["dual", "quads.obj", "-o", "out.obj"];
    assert_refused(&sixfold, &dual, 3, "so the mesh is open");
    assert_refused(
        &sixfold,
        &dual,
        3,
        "a surface with a rim, such as a plane, stays open",
    );
    // The advice holds for a solid with a hole.
    let box_with_hole = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                         f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    sixfold.file("open.obj", box_with_hole);
    assert_refused(
        &sixfold,
        &["dual", "open.obj", "-o", "out.obj"],
        3,
        "--fill-holes",
    );
    run_ok(
        &sixfold,
        &["repair", "open.obj", "--fill-holes", "-o", "closed.obj"],
    );
    run_ok(&sixfold, &["dual", "closed.obj", "-o", "out.obj"]);
}

#[test]
fn a_workload_with_edits_recommends_an_editable_type() {
    let sixfold = Sixfold::new();
    run_ok(&sixfold, &["generate", "geodesic", "-o", "ball.obj"]);
    for workload in ["decimation", "remeshing", "modelling"] {
        let pick = ["pick", "ball.obj", "--workload", workload, "--rounds", "2"];
        let said = run_ok(&sixfold, &pick).stdout.replace('\n', " ");
        let to_use = said.split("To use it").nth(1).expect("the lines");
        assert!(
            to_use.contains("let mut mesh: Editable"),
            "{workload}: {to_use}"
        );
    }
    let needs = ["pick", "ball.obj", "--needs", "edit", "--rounds", "2"];
    let said = run_ok(&sixfold, &needs).stdout.replace("\n  ", " ");
    assert!(!said.contains("they cannot"), "{said}");
    assert_eq!(
        said.matches("relation-tables is excluded").count(),
        1,
        "{said}"
    );
}

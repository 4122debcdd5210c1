//! Tests of `sixfold distance`: figures, JSON, refusals.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::run::{Sixfold, run_ok};

/// Two unit squares, one cut in two triangles and 0.5 above the other.
const LOW: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const HIGH: &str = "v 0 0 0.5\nv 1 0 0.5\nv 1 1 0.5\nv 0 1 0.5\nf 1 2 3\nf 1 3 4\n";

#[test]
fn parallel_squares_have_one_distance() {
    let sixfold = Sixfold::new();
    sixfold.file("low.obj", LOW);
    sixfold.file("high.obj", HIGH);
    let run = run_ok(
        &sixfold,
        &["distance", "low.obj", "high.obj", "--samples", "500"],
    );
    // Nine distances and the height of a farthest point. The diagonal of the first square is 1.4142.
    assert_eq!(run.stdout.matches(" 0.5 ").count(), 9, "{}", run.stdout);
    assert!(
        run.stdout.contains("farthest point of the second mesh: "),
        "{}",
        run.stdout
    );
    assert_eq!(run.stdout.matches("35.355").count(), 3, "{}", run.stdout);
    let arguments = ["distance", "low.obj", "high.obj", "--json", "-"];
    let document: Value = serde_json::from_str(&run_ok(&sixfold, &arguments).stdout).expect("JSON");
    let rows = document["distances"].as_array().expect("rows");
    assert_eq!(rows.len(), 3);
    for row in rows {
        assert_eq!(
            (row["mean"].as_f64(), row["largest"].as_f64()),
            (Some(0.5), Some(0.5))
        );
    }
    assert_eq!(rows[0]["farthest"][2], 0.0);
    assert_eq!(rows[1]["farthest"][2], 0.5);
}

#[test]
fn meshes_without_faces_and_bad_counts_are_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("low.obj", LOW);
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    assert_refused(
        &sixfold,
        &["distance", "low.obj", "points.obj"],
        2,
        "no faces",
    );
    for samples in ["0", "-1", "4294967296", "many"] {
        let arguments = ["distance", "low.obj", "low.obj", "--samples", samples];
        assert_refused(&sixfold, &arguments, 2, "from 1 to 4294967295");
    }
}

#[test]
fn both_meshes_are_moved_in_the_same_way() {
    let sixfold = Sixfold::new();
    let far = |mesh: &str, east: &str| {
        mesh.replace("v 0", &format!("v {east}"))
            .replace("v 1", "v 500001")
    };
    sixfold.file("low.obj", &far(LOW, "500000"));
    sixfold.file("high.obj", &far(HIGH, "500000.01"));
    let arguments = [
        "distance",
        "low.obj",
        "high.obj",
        "--recentre",
        "--json",
        "-",
    ];
    let run = run_ok(&sixfold, &arguments);
    let document: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let rows = &document["distances"];
    let (mean, largest) = (rows[1]["mean"].as_f64(), rows[0]["largest"].as_f64());
    assert!(mean.is_some_and(|mean| (mean - 0.5).abs() < 1e-6), "{rows}");
    // The low square is 1 cm wider.
    let expected = (0.25_f64 + 1e-4).sqrt();
    assert!(
        largest.is_some_and(|largest| (largest - expected).abs() < 1e-6),
        "{rows}"
    );
    let moved = "moved by -500000.5, -0.5, 0 to the origin";
    assert_eq!(run.stderr.matches(moved).count(), 2, "{run:?}");
}

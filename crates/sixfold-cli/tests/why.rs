//! Tests of `sixfold why`.

use serde_json::Value;

use crate::json_csv::finding;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

fn row<'a>(why: &'a Value, backend: &str, relation: &str) -> &'a Value {
    let rows = why["rows"].as_array().expect("a list");
    let is_it = |row: &&Value| row["backend"] == backend && row["relation"] == relation;
    rows.iter().find(is_it).expect("a row")
}

#[test]
fn counts_equal_those_computed_by_hand() {
    let sixfold = Sixfold::new();
    sixfold.file("square.obj", SQUARE);
    let arguments = ["why", "square.obj", "--counts-only", "--json", "-"];
    let why: Value = finding(&run_ok(&sixfold, &arguments).stdout);
    assert_eq!(why["rows"].as_array().map(Vec::len), Some(6 * 9));
    assert_eq!(why["memory"], Value::Null);
    assert_eq!(why["samples"].as_array().map(Vec::len), Some(0));
    assert_eq!(why["model"]["line_bytes"], 64);

    // Three corners of 4 bytes lie in one cache line.
    let corners = row(&why, "indexed-face-set", "face_vertices");
    for (field, value) in [
        ("reads", 3.0),
        ("bytes", 12.0),
        ("lines", 1.0),
        ("moved_bytes", 32.0),
    ] {
        assert_eq!(corners[field], value, "{field}");
    }
    // Five edges of two halves take 24 bytes each. One edge lies in two cache lines.
    let ends = row(&why, "half-edge", "edge_vertices");
    for (field, value) in [
        ("reads", 2.0),
        ("bytes", 24.0),
        ("lines", 1.2),
        ("moved_bytes", 25.6),
    ] {
        assert_eq!(ends[field], value, "{field}");
    }
    assert_eq!(ends["tables"][0]["table"], "halves");
    assert_eq!(ends["timed"], Value::Null);
    // The handle of an edge of a polygon soup contains the ends of the edge.
    assert_eq!(row(&why, "polygon-soup", "edge_vertices")["reads"], 0.0);
}

#[test]
fn times_come_with_what_bounds_them() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let arguments = [
        "why",
        "grid.obj",
        "--relations",
        "vertex_faces,edge_vertices",
        "--rounds",
        "2",
        "--json",
        "why.json",
    ];
    let run = run_ok(&sixfold, &arguments);
    for line in run.stdout.lines() {
        assert!(line.chars().count() <= 100, "too wide: {line}");
    }
    let why: Value = finding(&text(&sixfold, "why.json"));
    let speeds = why["memory"].as_array().expect("a list");
    assert!(!speeds.is_empty());
    for row in why["rows"].as_array().expect("a list") {
        let timed = &row["timed"];
        let number = |field: &str| timed[field].as_f64().expect("a number");
        let speed = timed["speed"]["gb_per_s"].as_f64().expect("a number");
        let moved = row["moved_bytes"].as_f64().expect("a number");
        let close = (number("floor_ns") - moved / speed).abs() <= 1e-9 * moved;
        assert!(close, "{row}");
        let half = number("ns_per_element") / 2.0;
        let expected = match () {
            () if number("floor_ns") >= half => "bandwidth",
            () if number("waits_ns") >= half => "latency",
            () => "work",
        };
        assert_eq!(timed["bound"], expected, "{row}");
        assert_eq!(timed["agreement"], "same");
    }
    // The text begins with the sentences of the document. Named relations have a table of reads.
    let text = |sentence: &Value| sentence.as_str().expect("a text").to_owned();
    let sentences: Vec<String> = why["sentences"]
        .as_array()
        .expect("a list")
        .iter()
        .map(text)
        .collect();
    assert_eq!(sentences.len(), 3, "{sentences:?}");
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (answer, tables) = run
        .stdout
        .split_once("\nmemory ")
        .expect("the table of the memory");
    for sentence in &sentences {
        assert!(words(answer).contains(&format!("- {sentence}")), "{answer}");
    }
    assert_eq!(tables.matches("reads by table").count(), 2, "{tables}");
    assert!(tables.contains("halves 2.00"), "{tables}");
    assert!(tables.contains("GB/s"), "{tables}");
}

#[test]
fn invalid_input_is_refused_with_a_hint() {
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("book.obj", book);
    sixfold.file("points.obj", "v 0 0 0\n");
    for (arguments, code, message) in [
        (
            &["why", "ok.obj", "--relations", "neighbours"][..],
            2,
            "choose from vertex_vertices",
        ),
        (
            &["why", "ok.obj", "--backends", "abacus"],
            2,
            "choose from polygon-soup",
        ),
        (&["why", "ok.obj", "--json", "ok.obj"], 2, "overwrite"),
        (&["why", "--counts-only", "--budget", "1s"], 2, "--budget"),
        (&["why", "--counts-only", "--rounds", "2"], 2, "--rounds"),
        (
            &["why", "points.obj", "--counts-only"],
            2,
            "nothing to study",
        ),
        (&["why", "none.obj", "--counts-only"], 2, "none.obj"),
        (
            &[
                "why",
                "book.obj",
                "--counts-only",
                "--backends",
                "half-edge",
            ],
            3,
            "f0, f1, f2",
        ),
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(code), "{run:?}");
        assert!(run.stderr.contains(message), "{message}: {run:?}");
        assert_eq!(run.stdout, "");
    }
    // Structures that cannot hold the mesh are listed.
    let run = run_ok(&sixfold, &["why", "book.obj", "--counts-only"]);
    let refused = "refused by   winged-edge, half-edge, corner-table: edge v0–v1";
    assert!(run.stdout.contains(refused), "{run:?}");
    let rows = |name: &str| {
        run.stdout
            .lines()
            .filter(|line| line.trim_start().starts_with(name))
            .count()
    };
    assert_eq!(rows("face-vertex "), 9);
    assert_eq!(rows("corner-table "), 0);
}

/// A short budget does not suffice for all buffers. The document records the given budget, so that
/// `compare` shows no difference between two equal commands.
#[test]
fn a_short_budget_leaves_out_large_buffers() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    // No machine reads the largest buffer, of 256 MiB, sixteen times within half of this time.
    let arguments = ["why", "grid.obj", "--budget", "20ms", "--json", "-"];
    let why: Value = finding(&run_ok(&sixfold, &arguments).stdout);
    assert_eq!(why["run"]["settings"]["budget_s"], 0.02);
    let buffers = why["memory"].as_array().expect("a list").len();
    assert!((1..8).contains(&buffers), "{buffers}");
    let warnings = why["warnings"].to_string();
    assert!(
        warnings.contains("too short to measure the speed of buffers"),
        "{warnings}"
    );
}

#[test]
fn one_backend_has_one_table_of_all_relations() {
    let sixfold = Sixfold::new();
    let arguments = ["why", "--counts-only", "--backends", "half-edge"];
    let printed = run_ok(&sixfold, &arguments).stdout;
    let heads = printed.lines().filter(|line| line.contains("jumps  moved"));
    assert_eq!(heads.count(), 1, "{printed}");
    assert!(printed.contains("\nface_faces "), "{printed}");
}

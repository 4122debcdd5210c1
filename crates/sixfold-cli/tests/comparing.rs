//! Tests of `sixfold orders` and `growth`.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::json_csv::finding;
use crate::run::{Sixfold, TETRAHEDRON, run_ok};

fn list<'v>(value: &'v Value, name: &str) -> &'v [Value] {
    let list = value[name].as_array();
    list.unwrap_or_else(|| panic!("no list {name} in {value}"))
}

/// Returns the sorted keys of an object.
fn names(value: &Value) -> Vec<&str> {
    let object = value.as_object();
    let object = object.unwrap_or_else(|| panic!("no object: {value}"));
    let mut names: Vec<&str> = object.keys().map(String::as_str).collect();
    names.sort_unstable();
    names
}

#[test]
fn orders_writes_json() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let arguments = [
        "orders",
        "grid.obj",
        "--rounds",
        "2",
        "--operations",
        "vertex_faces,ff_bfs",
        "--json",
        "-",
    ];
    let report = finding(&run_ok(&sixfold, &arguments).stdout);
    let fields = [
        "backends",
        "comparisons",
        "control",
        "interrupted",
        "kind",
        "mesh",
        "meshes",
        "orders",
        "refusals",
        "results",
        "run",
        "samples",
        "sentences",
        "start",
        "timer",
        "warnings",
    ];
    assert_eq!(names(&report), fields);
    assert_eq!(report["mesh"]["faces"], 242);
    let orders = ["given", "shuffled", "morton", "breadth-first"];
    assert_eq!(list(&report, "orders"), orders);
    let results = list(&report, "results");
    assert_eq!(results.len(), 2 * 6 * 4);
    for (row, order) in results.iter().zip(orders.iter().cycle()) {
        assert_eq!(row["case"], *order);
        for field in ["backend", "operation", "agreement", "per"] {
            assert!(row[field].is_string(), "{field} in {row}");
        }
        let time = row["median_ns"].as_f64().or(row["estimated_ns"].as_f64());
        assert!(time > Some(0.0), "{row}");
    }
    let comparisons = list(&report, "comparisons");
    assert_eq!(comparisons.len(), 2);
    for comparison in comparisons {
        let fields = ["larger", "noise", "operation", "orders", "structures"];
        assert_eq!(names(comparison), fields);
        let effect = &list(comparison, "orders")[0];
        let fields = [
            "backend",
            "best",
            "given_to_best",
            "matters",
            "scans",
            "worst",
            "worst_to_best",
        ];
        assert_eq!(names(effect), fields);
        assert_eq!(
            names(&effect["worst_to_best"]),
            ["ci_high", "ci_low", "ratio"]
        );
        let larger = comparison["larger"].as_str();
        assert!(
            matches!(larger, Some("order" | "structure" | "depends")),
            "{comparison}"
        );
        let fields = [
            "fastest",
            "fastest_order",
            "matters",
            "slowest",
            "slowest_order",
            "slowest_to_fastest",
        ];
        assert_eq!(names(&comparison["structures"]), fields);
    }
    assert_eq!(report["interrupted"], false);
}

#[test]
fn growth_writes_json() {
    let sixfold = Sixfold::new();
    let arguments = [
        "growth",
        "--shape",
        "torus",
        "--from",
        "100",
        "--to",
        "900",
        "--steps",
        "3",
        "--order",
        "shuffled",
        "--rounds",
        "2",
        "--operations",
        "vertex_faces",
        "--json",
        "growth.json",
    ];
    let run = run_ok(&sixfold, &arguments);
    // The faces are quads. One structure refuses them.
    assert!(run.stdout.contains("corner-table refuses"), "{run:?}");
    assert!(run.stdout.contains("power"), "{run:?}");
    let report = finding(&crate::run::text(&sixfold, "growth.json"));
    let fields = [
        "backends",
        "cache_limits",
        "caches",
        "fits",
        "interrupted",
        "kind",
        "left_out",
        "mesh",
        "meshes",
        "order",
        "refused_by",
        "run",
        "sentences",
        "shape",
        "sizes",
        "start",
        "timer",
        "warnings",
    ];
    assert_eq!(names(&report), fields);
    assert_eq!(
        (&report["shape"], &report["order"]),
        (&"torus".into(), &"shuffled".into())
    );
    assert_eq!(list(&report, "backends").len(), 5);
    assert_eq!(
        names(&list(&report, "refused_by")[0]),
        ["backend", "reason"]
    );
    check_sizes(list(&report, "sizes"));
    check_fits(list(&report, "fits"));
    for cache in list(&report, "caches") {
        assert_eq!(names(cache), ["bytes", "kind", "level", "shared_by"]);
    }
    for end in list(&report, "cache_limits") {
        assert_eq!(names(end), ["backend", "cache_bytes", "faces", "level"]);
    }
}

/// Checks the three sizes of a growth in JSON.
fn check_sizes(sizes: &[Value]) {
    assert_eq!(sizes.len(), 3);
    for size in sizes {
        let fields = [
            "backend_bytes",
            "control",
            "edges",
            "faces",
            "refusals",
            "results",
            "samples",
            "vertices",
        ];
        assert_eq!(names(size), fields);
        assert_eq!(
            size["edges"].as_u64(),
            size["faces"].as_u64().map(|faces| 2 * faces)
        );
        assert_eq!(list(size, "results").len(), 5);
        assert_eq!(
            names(&list(size, "backend_bytes")[0]),
            ["backend", "bytes", "fits_in"]
        );
    }
}

/// Checks the fitted powers of five backends over three sizes.
fn check_fits(fits: &[Value]) {
    assert_eq!(fits.len(), 5);
    for fit in fits {
        let fields = [
            "all",
            "backend",
            "beyond",
            "estimated",
            "in_cache",
            "operation",
            "scans",
        ];
        assert_eq!(names(fit), fields);
        assert_eq!(names(&fit["all"]), ["exponent", "sizes", "standard_error"]);
        assert_eq!(fit["all"]["sizes"], 3);
    }
}

#[test]
fn invalid_arguments_are_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("mesh.obj", TETRAHEDRON);
    sixfold.file("points.obj", "v 0 0 0\n");
    for (arguments, code, message) in [
        (
            &["orders", "mesh.obj", "--backends", "abacus"][..],
            2,
            "half-edge",
        ),
        (
            &["orders", "mesh.obj", "--operations", "fly"],
            2,
            "vv_smooth",
        ),
        (
            &["orders", "mesh.obj", "--json", "mesh.obj"],
            2,
            "overwrite",
        ),
        (&["orders", "points.obj"], 2, "no faces"),
        (&["growth", "--shape", "teapot"], 2, "geodesic"),
        (
            &["growth", "--from", "9000", "--to", "1000"],
            2,
            "the smaller first",
        ),
        (&["growth", "--from", "ten"], 2, "whole number"),
        (&["growth", "--from", "-5"], 2, "whole number"),
        (&["growth", "--steps", "1"], 2, "from 2"),
        (&["growth", "--to", "99999999999"], 2, "choose from 100"),
        (&["growth", "--order", "odd"], 2, "morton"),
        (
            &["growth", "--from", "1000", "--to", "1001", "--steps", "2"],
            2,
            "further apart",
        ),
        (
            &["growth", "--shape", "grid", "--backends", "corner-table"],
            3,
            "corner-table",
        ),
        // These sizes need hundreds of gigabytes.
        (&["growth", "--to", "500000000"], 3, "smaller --to"),
    ] {
        assert_refused(&sixfold, arguments, code, message);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_keeps_the_sizes_that_are_finished() {
    let sixfold = Sixfold::new();
    // 60 rounds of one size are more steps than the pipe to this test holds.
    let sizes = ["--from", "400", "--to", "100000", "--steps", "5"];
    let arguments = ["growth", "--rounds", "60", "--json", "kept.json"];
    let arguments = [&arguments[..], &sizes].concat();
    let first_of_second = "1620 faces: measuring";
    sixfold.run_interrupted(&arguments, "INT", first_of_second);
    let report = finding(&crate::run::text(&sixfold, "kept.json"));
    assert_eq!(report["interrupted"], true);
    assert_eq!(list(&report, "sizes").len(), 1);
    assert_eq!(sixfold.names(), ["kept.json"]);
}

/// Facts are printed before the measurement.
#[test]
fn growth_and_memory_print_what_is_known_before_they_measure() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let growth = ["growth", "--to", "2000", "--steps", "2", "--rounds", "1"];
    for (arguments, first) in [
        (&growth[..], "shape        "),
        (&["memory", "grid.obj"], "mesh         grid.obj"),
    ] {
        // Both outputs go to one pipe, in the order in which they are written.
        let (mut reader, writer) = std::io::pipe().expect("a pipe");
        let mut command = sixfold.command(arguments);
        command.env("SIXFOLD_PROGRESS", "lines");
        command.stderr(writer.try_clone().expect("a pipe"));
        command.stdout(writer);
        let mut child = command.spawn().expect("it starts");
        // The pipe ends when the program ends, if no other handle is left.
        drop(command);
        let mut text = String::new();
        std::io::Read::read_to_string(&mut reader, &mut text).expect("UTF-8");
        assert!(child.wait().expect("it ends").success(), "{text}");
        let facts = text.find(first).expect("facts");
        let progress = text.find("progress: ").expect("progress");
        assert!(facts < progress, "{text}");
        assert_eq!(text.matches(first).count(), 1, "printed twice: {text}");
    }
}

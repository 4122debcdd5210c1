//! Tests of `sixfold memory`.

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::json_csv::{FACTS, assert_fields, finding};
use crate::run::{Sixfold, TETRAHEDRON, run_ok};

const BACKEND: [(&str, &str); 16] = [
    ("holds", "boolean"),
    ("reason", "string or null"),
    ("bytes", "number or null"),
    ("bytes_per_vertex", "number or null"),
    ("layout_bytes", "number or null"),
    ("layout_bytes_per_vertex", "number or null"),
    ("layout_words_per_vertex", "number or null"),
    ("closed_triangles_words_per_vertex", "number"),
    ("counted_bytes", "number or null"),
    ("counted_bytes_per_vertex", "number or null"),
    ("peak_bytes", "number or null"),
    ("peak_to_counted", "number or null"),
    ("agrees", "boolean or null"),
    ("tables", "array"),
    ("merged_vertices", "number or null"),
    ("operations", "array"),
];

const OPERATION: [(&str, &str); 6] = [
    ("operation", "string"),
    ("allocated_bytes", "number or null"),
    ("result_bytes", "number or null"),
    ("allocated_to_result", "number or null"),
    ("reason", "string or null"),
    ("scans", "boolean"),
];

#[test]
fn json_has_the_three_counts_and_the_tables() {
    let sixfold = Sixfold::new();
    sixfold.file(
        "quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let run = run_ok(&sixfold, &["memory", "quad.obj", "--json", "-"]);
    let audit = finding(&run.stdout);
    assert_fields(&audit["mesh"], &FACTS);
    let backends = audit["backends"].as_object().expect("a map");
    assert_eq!(backends.len(), 6);
    for (name, backend) in backends {
        assert_fields(backend, &BACKEND);
        if name == "corner-table" {
            assert_eq!(backend["holds"], false);
            assert_eq!(backend["agrees"], Value::Null);
            assert_eq!(backend["counted_bytes"], Value::Null);
            continue;
        }
        assert_eq!(backend["agrees"], true, "{name}");
        assert_eq!(backend["layout_bytes"], backend["bytes"], "{name}");
        assert_eq!(backend["counted_bytes"], backend["bytes"], "{name}");
        let tables = backend["tables"].as_array().expect("a list").iter();
        let sum: u64 = tables.filter_map(|table| table["bytes"].as_u64()).sum();
        assert_eq!(Some(sum), backend["bytes"].as_u64(), "{name}");
        assert!(backend["peak_bytes"].as_u64() >= Some(sum), "{name}");
    }
    // Indexed face set: 4 positions of 12 bytes and 4 corners of 4 bytes. Half-edge: 4 · 2
    // half-edges of 12 bytes, 4 vertices of 16 bytes, and 1 face of 4 bytes.
    assert_eq!(backends["indexed-face-set"]["counted_bytes"], 64);
    assert_eq!(backends["half-edge"]["counted_bytes"], 164);
    assert_eq!(backends["half-edge"]["layout_words_per_vertex"], 10.25);
    let least = "polygon-soup needs the least memory: 48 bytes, 12.0 per vertex.";
    let sentence = audit["sentences"][0].as_str().expect("a sentence");
    assert!(sentence.starts_with(least), "{sentence}");
}

/// Maximum number of bytes that building a structure allocates, per byte of the result. Building
/// needs scratch memory in addition to the result. A corner table and half-edges need 4 bytes per
/// corner and 8 per vertex. Winged edges need 12 bytes per corner and 8 per vertex.
const BUILD_LIMITS: [(&str, f64); 6] = [
    ("polygon-soup", 1.02),
    ("indexed-face-set", 1.0),
    ("face-vertex", 1.0),
    ("winged-edge", 1.67),
    ("half-edge", 1.34),
    ("corner-table", 1.5),
];

/// Maximum number of bytes that a subdivision allocates, per byte of the result. The key is the
/// suffix of the operation.
const SUBDIVISION_LIMITS: [(&str, f64); 3] =
    [("_gather", 3.0), ("_scatter", 3.0), ("_native", 1.2)];

#[test]
fn operations_on_the_built_in_mesh_allocate_little_besides_their_result() {
    let run = run_ok(&Sixfold::new(), &["memory", "--json", "-"]);
    let audit = finding(&run.stdout);
    let mut counted = 0;
    for (backend, build_limit) in BUILD_LIMITS {
        let operations = audit["backends"][backend]["operations"].as_array();
        for operation in operations.expect("a list") {
            assert_fields(operation, &OPERATION);
            let name = operation["operation"].as_str().expect("a name");
            let Some(ratio) = operation["allocated_to_result"].as_f64() else {
                assert!(operation["reason"].is_string(), "{name} on {backend}");
                continue;
            };
            counted += 1;
            let mut ends = SUBDIVISION_LIMITS.into_iter();
            let limit = match ends.find(|(end, _)| name.ends_with(end)) {
                Some((_, limit)) => limit,
                None if name == "build" => build_limit,
                None => continue,
            };
            assert!(
                ratio <= limit,
                "{name} on {backend} allocates {ratio} bytes for each byte of the result"
            );
        }
    }
    assert!(counted > 40, "{counted} operations were run");
}

#[test]
fn operations_that_scan_are_run_on_small_meshes_only() {
    let sixfold = Sixfold::new();
    sixfold.file("ok.obj", TETRAHEDRON);
    let run = run_ok(&sixfold, &["memory", "ok.obj"]);
    assert!(run.stdout.contains("loop_gather"), "{run:?}");
    assert!(!run.stdout.contains("scans"), "{run:?}");
    let run = run_ok(&sixfold, &["memory"]);
    let words = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    let reason = "scans all faces for each element (polygon-soup, indexed-face-set)";
    assert!(words.contains(reason), "{run:?}");
    assert_eq!(words.matches("scans").count(), 1, "{run:?}");
}

/// Two cones over one rim: each edit at a tip visits all faces of a cone.
#[test]
fn operations_are_not_run_at_elements_with_very_many_neighbours() {
    let sixfold = Sixfold::new();
    for (rim, is_run) in [(1000_usize, true), (4000, false)] {
        let mut text = String::from("v 0 0 1\nv 0 0 -1\n");
        for i in 0..rim {
            let (sin, cos) = (i as f64 / rim as f64 * std::f64::consts::TAU).sin_cos();
            text += &format!("v {cos} {sin} 0\n");
        }
        for i in 0..rim {
            let [a, b] = [i + 3, (i + 1) % rim + 3];
            text += &format!("f {a} {b} 1\nf {b} {a} 2\n");
        }
        sixfold.file("cones.obj", &text);
        let command = [
            "memory",
            "cones.obj",
            "--backends",
            "half-edge",
            "--json",
            "a.json",
        ];
        let run = run_ok(&sixfold, &command);
        let why = "it visits all neighbours of elements, and some elements have very many";
        let shown = run.stdout.replace('\n', " ");
        assert_eq!(shown.contains(why), !is_run, "{run:?}");
        let audit = finding(&crate::run::text(&sixfold, "a.json"));
        for operation in audit["backends"]["half-edge"]["operations"]
            .as_array()
            .expect("a list")
        {
            let name = operation["operation"].as_str().expect("a name");
            let is_left_out = operation["reason"] == why;
            assert_eq!(is_left_out, name != "build" && !is_run, "{operation}");
        }
    }
}

#[test]
fn a_corner_table_holds_a_triangulated_quad() {
    let sixfold = Sixfold::new();
    sixfold.file(
        "quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let asked = ["memory", "quad.obj", "--backends", "corner-table"];
    let run = assert_refused(&sixfold, &asked, 3, "none of the selected backends can");
    assert!(run.stderr.contains("4 corners"), "{run:?}");
    let run = run_ok(&sixfold, &[&asked[..], &["--triangulate"]].concat());
    assert!(
        run.stdout.contains("cut 1 face into 2 triangles"),
        "{run:?}"
    );
    assert!(run.stdout.contains("agree to the byte"), "{run:?}");
}

#[test]
fn json_is_written_if_all_backends_refuse() {
    let sixfold = Sixfold::new();
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("book.obj", book);
    let arguments = [
        "memory",
        "book.obj",
        "--backends",
        "half-edge",
        "--json",
        "-",
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(3), "{run:?}");
    let backends = &finding(&run.stdout)["backends"];
    assert_eq!(backends.as_object().map(|map| map.len()), Some(1));
    let reason = backends["half-edge"]["reason"].as_str().expect("a reason");
    assert!(reason.contains("f0, f1, f2"), "{reason}");
}

#[test]
fn invalid_input_is_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    sixfold.file("ok.obj", TETRAHEDRON);
    for (arguments, message) in [
        (&["memory", "points.obj"][..], "no faces"),
        (&["memory", "missing.obj"], "missing.obj"),
        (
            &["memory", "-"],
            "standard input: the format is not recognised",
        ),
        (&["memory", "ok.obj", "--backends", "abacus"], "half-edge"),
        (
            &["memory", "ok.obj", "--json", "nowhere/x.json"],
            "cannot be written",
        ),
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {run:?}");
        assert!(run.stderr.contains(message), "{arguments:?}: {run:?}");
        assert_eq!(run.stdout, "", "{arguments:?}");
    }
}

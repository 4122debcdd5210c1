//! `sixfold memory`: three ways to one number, for people, for machines and for shells.

use serde_json::Value;

use crate::bad_input::refused;
use crate::machine::{FACTS, has, parsed};
use crate::run::{Sixfold, TETRAHEDRON, done};

const BACKEND: [(&str, &str); 15] = [
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
];

#[test]
fn machines_read_the_three_ways_and_their_tables() {
    let sixfold = Sixfold::new();
    sixfold.file(
        "quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let run = done(&sixfold, &["memory", "quad.obj", "--json", "-"]);
    let audit = parsed(&run.stdout);
    assert_eq!(audit["schema"], 1);
    has(&audit["mesh"], &FACTS);
    let backends = audit["backends"].as_object().expect("a map");
    assert_eq!(backends.len(), 6);
    for (name, backend) in backends {
        has(backend, &BACKEND);
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
    // 4 positions and 4 corners: 12 · 4 + 4 · 4; half-edges: 4 · 2 of 12 bytes, 4 · 16, and 4.
    assert_eq!(backends["indexed-face-set"]["counted_bytes"], 64);
    assert_eq!(backends["half-edge"]["counted_bytes"], 164);
    assert_eq!(backends["half-edge"]["layout_words_per_vertex"], 10.25);
}

#[test]
fn cut_into_triangles_a_corner_table_holds_it() {
    let sixfold = Sixfold::new();
    sixfold.file(
        "quad.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    );
    let asked = ["memory", "quad.obj", "--backends", "corner-table"];
    let run = refused(&sixfold, &asked, 3, "none of the backends asked for");
    assert!(run.stderr.contains("4 corners"), "{run:?}");
    let run = done(&sixfold, &[&asked[..], &["--triangulate"]].concat());
    assert!(
        run.stdout.contains("cut 1 face into 2 triangles"),
        "{run:?}"
    );
    assert!(run.stdout.contains("agree to the byte"), "{run:?}");
}

#[test]
fn a_refusal_by_all_is_an_answer_for_machines_too() {
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
    let backends = &parsed(&run.stdout)["backends"];
    assert_eq!(backends.as_object().map(|map| map.len()), Some(1));
    let reason = backends["half-edge"]["reason"].as_str().expect("a reason");
    assert!(reason.contains("f0, f1, f2"), "{reason}");
}

#[test]
fn what_cannot_be_weighed_is_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("points.obj", "v 0 0 0\nv 1 0 0\n");
    sixfold.file("ok.obj", TETRAHEDRON);
    for (arguments, says) in [
        (&["memory", "points.obj"][..], "no faces"),
        (&["memory", "missing.obj"], "missing.obj"),
        (&["memory", "-"], "standard input is not read"),
        (&["memory", "ok.obj", "--backends", "abacus"], "half-edge"),
        (
            &["memory", "ok.obj", "--json", "nowhere/x.json"],
            "cannot be written",
        ),
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {run:?}");
        assert!(run.stderr.contains(says), "{arguments:?}: {run:?}");
        assert_eq!(run.stdout, "", "{arguments:?}");
    }
}

//! Tests of the JSON and CSV of a study: the schema of `reports/SCHEMA.md`, and the checksums.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

use crate::run::{Sixfold, TETRAHEDRON};

pub(crate) const FACTS: [(&str, &str); 19] = [
    ("vertices", "number"),
    ("edges", "number"),
    ("faces", "number"),
    ("euler_characteristic", "number"),
    ("components", "number"),
    ("boundary_edges", "number"),
    ("boundary_loops", "number or null"),
    ("non_manifold_edges", "number"),
    ("non_manifold_vertices", "number"),
    ("inconsistent_edges", "number"),
    ("consistently_oriented", "boolean or null"),
    ("orientable", "boolean or null"),
    ("closed", "boolean"),
    ("genus", "number or null"),
    ("isolated_vertices", "number"),
    ("duplicate_faces", "number"),
    ("degenerate_faces", "number"),
    ("valence", "object or null"),
    ("face_degree", "object or null"),
];

const RESULT: [(&str, &str); 30] = [
    ("backend", "string"),
    ("operation", "string"),
    ("median_ns", "number or null"),
    ("min_ns", "number or null"),
    ("ci_low_ns", "number or null"),
    ("ci_high_ns", "number or null"),
    ("elements", "number or null"),
    ("per", "string"),
    ("ns_per_element", "number or null"),
    ("wall_median_ns", "number or null"),
    ("wall_min_ns", "number or null"),
    ("sampled", "boolean"),
    ("sample_size", "number or null"),
    ("estimated_ns", "number or null"),
    ("checksum", "number or null"),
    ("agreement", "string"),
    ("standing", "string or null"),
    ("ratio_to_best", "number or null"),
    ("ratio_ci_low", "number or null"),
    ("ratio_ci_high", "number or null"),
    ("samples", "number"),
    ("runs_per_sample", "number"),
    ("warm_up_only", "boolean"),
    ("by_name_only", "boolean"),
    ("faults", "number or null"),
    ("retaken", "number"),
    ("disturbed", "number"),
    ("first_ns", "number or null"),
    ("first_samples", "number"),
    ("first_faults", "number or null"),
];

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    }
}

pub(crate) fn assert_fields(object: &Value, fields: &[(&str, &str)]) {
    for (field, kinds) in fields {
        let value = object
            .get(field)
            .unwrap_or_else(|| panic!("no {field} in {object}"));
        assert!(
            kinds.split(" or ").any(|k| k == kind(value)),
            "{field}: {value}"
        );
    }
}

pub(crate) fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Returns the only finding of a document, with its run as `run`, its only mesh as `mesh`, and its
/// backends by name.
pub(crate) fn finding(text: &str) -> Value {
    let document = parsed(text);
    assert_eq!(document["schema"], 4);
    let findings = document["findings"].as_array().expect("a list");
    assert_eq!(findings.len(), 1, "{document:.200}");
    completed(&document, &findings[0])
}

/// Returns a finding of `document`, as [`finding`] does.
pub(crate) fn completed(document: &Value, finding: &Value) -> Value {
    let mut complete = finding.clone();
    let place = |value: &Value| value.as_u64().expect("a place") as usize;
    complete["run"] = document["runs"][place(&finding["run"])].clone();
    if let Some(mesh) = finding["meshes"].get(0) {
        complete["mesh"] = document["meshes"][place(mesh)].clone();
    }
    complete["backends"] = by_name(&finding["backends"]);
    complete
}

/// Returns a list of objects as an object, by their names. Other values are returned unchanged.
pub(crate) fn by_name(list: &Value) -> Value {
    let named = list.as_array().into_iter().flatten().map(|entry| {
        let name = entry["name"].as_str()?;
        Some((name.to_owned(), entry.clone()))
    });
    match named.collect::<Option<serde_json::Map<String, Value>>>() {
        Some(named) if !named.is_empty() => Value::Object(named),
        _ => list.clone(),
    }
}

#[test]
fn a_study_follows_its_schema_and_all_backends_agree() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let arguments = [
        "study", "grid.obj", "--rounds", "2", "--json", "-", "--csv", "out.csv",
    ];
    let run = sixfold.run(&arguments);
    assert_eq!(run.code, Some(0), "{run:?}");
    let report = finding(&run.stdout);
    assert_eq!(report["kind"], "study");
    let hashes = ["sha256", "file_sha256"].map(|field| report["mesh"][field].as_str());
    assert!(
        hashes
            .iter()
            .all(|hash| hash.is_some_and(|h| h.len() == 64))
    );
    assert_fields(&report["mesh"], &FACTS);
    let backends = report["backends"].as_object().expect("a map");
    assert!(backends.len() >= 3);
    for backend in backends.values() {
        assert_fields(
            backend,
            &[
                ("holds", "boolean"),
                ("reason", "string or null"),
                ("bytes", "number"),
            ],
        );
        assert!(backend["bytes"].as_f64() > Some(0.0));
    }
    let results = report["results"].as_array().expect("a list");
    let refusals = report["refusals"].as_array().expect("a list");
    assert_eq!(results.len() + refusals.len(), 28 * backends.len());
    for refusal in refusals {
        let fields = ["backend", "operation", "reason"].map(|field| (field, "string"));
        assert_fields(refusal, &fields);
    }
    let mut checksums: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for row in results {
        assert_fields(row, &RESULT);
        assert_eq!(row["agreement"], "same", "{row}");
        assert!(
            row["median_ns"].is_number() && row["estimated_ns"].is_null(),
            "{row}"
        );
        if row["sampled"] == false {
            assert!(row["min_ns"].as_f64() <= row["median_ns"].as_f64(), "{row}");
            let operation = row["operation"].as_str().expect("a name");
            let checksum = row["checksum"].as_f64().expect("a number");
            checksums.entry(operation).or_default().push(checksum);
        }
    }
    for (operation, sums) in &checksums {
        let close = |sum: &f64| (sum - sums[0]).abs() <= 1e-4 * sums[0].abs();
        assert!(sums.iter().all(close), "{operation}: {sums:?}");
    }
    // The grid has 4 · 11 boundary edges, 242 faces and 3 · 242 corners. The corners are visited
    // twice.
    assert_eq!(
        checksums["boundary"],
        vec![44.0; checksums["boundary"].len()]
    );
    assert_eq!(checksums["circulate"][0], 2.0 * 3.0 * 242.0);
    assert_eq!(checksums["build"][0], 144.0 + 242.0);
    let clock = report["run"]["environment"]["clock"].as_str();
    assert!(matches!(clock, Some("thread-cpu" | "wall")));
    assert_eq!(report["interrupted"], false);

    let csv = fs::read_to_string(sixfold.folder().join("out.csv")).expect("the file");
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(header[..3], ["mesh", "vertices", "edges"]);
    let fields = results[0].as_object().expect("a row").keys();
    assert!(
        fields
            .into_iter()
            .all(|field| header.contains(&field.as_str()))
    );
    // A refused operation has a row without a time.
    assert_eq!(lines.count(), results.len() + refusals.len());
}

#[test]
fn an_inspection_writes_facts_and_verdicts() {
    let sixfold = Sixfold::new();
    sixfold.file("mesh.obj", TETRAHEDRON);
    let run = sixfold.run(&["inspect", "mesh.obj", "--json", "-"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let inspection = parsed(&run.stdout);
    assert_eq!(inspection["schema"], 4);
    assert_fields(&inspection["mesh"], &FACTS);
    assert_eq!(inspection["mesh"]["edges"], 6);
    assert_eq!(inspection["mesh"]["genus"], 0);
    for (name, backend) in by_name(&inspection["backends"]).as_object().expect("a map") {
        assert_eq!(backend["holds"], true, "{name}");
        assert_eq!(backend["reason"], Value::Null, "{name}");
    }
}

#[test]
fn the_selected_rows_are_measured() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 5);
    let run = sixfold.run(&[
        "study",
        "grid.obj",
        "--rounds",
        "2",
        "--json",
        "-",
        "--triangulate",
        "--seed",
        "9",
        "--backends",
        "half-edge,face-vertex",
        "--operations",
        "vv_smooth,build",
    ]);
    let report = finding(&run.stdout);
    let rows = report["results"].as_array().expect("a list").iter();
    let rows: Vec<_> = rows
        .map(|row| (&row["operation"], &row["backend"]))
        .collect();
    // The rows have the order of the table, not the order of the arguments.
    let expected = [
        ("build", "face-vertex"),
        ("build", "half-edge"),
        ("vv_smooth", "face-vertex"),
        ("vv_smooth", "half-edge"),
    ];
    assert_eq!(rows.len(), expected.len());
    for (row, expected) in rows.into_iter().zip(expected) {
        assert_eq!(
            (row.0.as_str(), row.1.as_str()),
            (Some(expected.0), Some(expected.1))
        );
    }
    let run = &report["run"];
    assert_eq!(run["settings"]["seed"], 9);
    assert_eq!(run["settings"]["triangulate"], true);
    assert_eq!(run["settings"]["rounds"], 2);
    assert_eq!(run["settings"]["budget_s"], Value::Null);
    let command = run["command"].as_str().expect("a command");
    assert!(command.starts_with("sixfold study grid.obj --rounds 2"));
}

#[test]
fn merged_vertices_are_reported_and_are_not_a_failure() {
    let sixfold = Sixfold::new();
    // Two triangles touch along an edge in space, but share no vertex.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 5 4 6\n";
    sixfold.file("seam.obj", text);
    let run = sixfold.run(&["study", "seam.obj", "--rounds", "2", "--json", "-"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let report = finding(&run.stdout);
    assert_eq!(report["backends"]["polygon-soup"]["merged_vertices"], 2);
    let sentences = report["notes"].to_string();
    assert!(
        sentences.contains("polygon-soup merges 2 vertices that share coordinates"),
        "{sentences}"
    );
    for row in report["results"].as_array().expect("a list") {
        let merged = row["backend"] == "polygon-soup" && row["operation"] == "boundary";
        let expected = if merged { "merged" } else { "same" };
        if merged || row["backend"] != "polygon-soup" {
            assert_eq!(row["agreement"], expected, "{row}");
        }
        let taken = row["samples"].as_u64().zip(row["disturbed"].as_u64());
        assert_eq!(taken.map(|(counted, not)| counted + not), Some(2), "{row}");
    }
}

/// Returns the rows of a table as lists of cells by column. No cell may contain a comma.
fn csv_rows(csv: &str) -> Vec<BTreeMap<String, String>> {
    let mut lines = csv.lines().map(|line| line.split(',').map(str::to_owned));
    let header: Vec<String> = lines.next().expect("a header").collect();
    lines
        .map(|line| header.iter().cloned().zip(line).collect())
        .collect()
}

#[test]
fn counts_have_rows_in_csv() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let run = crate::run::run_ok(
        &sixfold,
        &["why", "grid.obj", "--counts-only", "--csv", "-"],
    );
    let rows = csv_rows(&run.stdout);
    assert_eq!(rows.len(), 9 * 6);
    for row in &rows {
        assert_eq!(row["status"], "counted", "{row:?}");
        assert!(
            !row["reads"].is_empty() && !row["lines"].is_empty(),
            "{row:?}"
        );
        assert!(row["median_ns"].is_empty(), "{row:?}");
    }
    let run = crate::run::run_ok(&sixfold, &["memory", "grid.obj", "--csv", "-"]);
    let rows = csv_rows(&run.stdout);
    let structures = rows.iter().filter(|row| row["operation"] == "structure");
    let structures: Vec<_> = structures.collect();
    assert_eq!(structures.len(), 6);
    for row in structures {
        assert_eq!(row["layout_bytes"], row["counted_bytes"], "{row:?}");
        let bytes = |column: &str| row[column].parse::<u64>().expect("a number");
        assert!(bytes("peak_bytes") >= bytes("counted_bytes"), "{row:?}");
    }
}

#[test]
fn growth_records_its_meshes_and_the_features_of_the_build() {
    let sixfold = Sixfold::new();
    let arguments = ["growth", "--to", "2000", "--steps", "2", "--rounds", "2"];
    let run = crate::run::run_ok(&sixfold, &[&arguments[..], &["--json", "-"]].concat());
    let document = parsed(&run.stdout);
    let growth = &document["findings"][0];
    let sizes = growth["sizes"].as_array().expect("a list").len();
    let meshes = document["meshes"].as_array().expect("a list");
    assert_eq!(meshes.len(), sizes);
    for (mesh, size) in meshes
        .iter()
        .zip(growth["sizes"].as_array().expect("a list"))
    {
        assert_eq!(mesh["sha256"].as_str().map(str::len), Some(64));
        assert_eq!(mesh["faces"], size["faces"]);
    }
    let environment = &document["runs"][0]["environment"];
    assert_eq!(environment["features"], serde_json::json!([]));
}

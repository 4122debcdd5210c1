//! Compares `reports/SCHEMA.md` with the documents that the commands write.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::json_csv::parsed;
use crate::run::{Sixfold, TETRAHEDRON, run_ok, text};

/// Objects whose keys are not names of fields.
const MAPS: [&str; 2] = ["hist", "tags"];

/// Adds the names of all fields of `value`, at any depth.
fn add_fields(value: &Value, fields: &mut BTreeSet<String>) {
    match value {
        Value::Array(list) => list.iter().for_each(|entry| add_fields(entry, fields)),
        Value::Object(object) => {
            for (name, inner) in object {
                fields.insert(name.clone());
                if !MAPS.contains(&name.as_str()) {
                    add_fields(inner, fields);
                }
            }
        }
        _ => {}
    }
}

/// Writes a document of each command, all documents merged, and a comparison. Returns the names of
/// all their fields, and of the columns of the tables.
fn written_fields() -> BTreeSet<String> {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold.file("t.obj", TETRAHEDRON);
    fs::create_dir(sixfold.folder().join("history")).expect("a folder");
    let commands: [&[&str]; 8] = [
        &[
            "study",
            "grid.obj",
            "--rounds",
            "2",
            "--launches",
            "2",
            "--tag",
            "a=b",
            "--warmup",
            "3",
            "--confidence",
            "99%",
        ],
        &[
            "study",
            "t.obj",
            "--rounds",
            "2",
            "--launches",
            "2",
            "--warmup",
            "3",
            "--confidence",
            "99%",
        ],
        &["orders", "grid.obj", "--rounds", "2"],
        &["growth", "--to", "2000", "--steps", "3", "--rounds", "2"],
        &["why", "grid.obj", "--rounds", "2", "--launches", "2"],
        &["memory", "grid.obj"],
        &["neighbours", "grid.obj", "--rounds", "2"],
        &[
            "pick",
            "grid.obj",
            "t.obj",
            "--rounds",
            "2",
            "--launches",
            "2",
        ],
    ];
    let mut merge = vec!["merge".to_owned()];
    for (i, command) in commands.iter().enumerate() {
        let file = format!("{i}.json");
        run_ok(&sixfold, &[command, &["--json", &file][..]].concat());
        merge.push(file);
    }
    // A second study of one mesh, with another fastest backend and another size.
    let mut other = parsed(&text(&sixfold, "0.json"));
    let results = other["findings"][0]["results"].as_array_mut();
    for row in results.expect("a list") {
        row["standing"] = match row["backend"] == "half-edge" {
            true => "slower".into(),
            false => "best".into(),
        };
    }
    let other = other.to_string().replacen("\"bytes\": ", "\"bytes\": 1", 1);
    sixfold.file("other.json", &other);
    let mut words: Vec<&str> = merge.iter().map(String::as_str).collect();
    words.extend(["--json", "all.json", "--csv", "all.csv"]);
    words.extend(["--samples-csv", "samples.csv"]);
    run_ok(&sixfold, &words);
    run_ok(
        &sixfold,
        &["compare", "0.json", "other.json", "--json", "c.json"],
    );
    sixfold.file("history/memory.json", &text(&sixfold, "5.json"));
    for file in ["0.json", "other.json"] {
        sixfold.file(&format!("history/{file}"), &text(&sixfold, file));
    }
    let history = ["history", "history", "--json", "h.json", "--csv", "h.csv"];
    run_ok(&sixfold, &history);
    run_ok(&sixfold, &["inspect", "t.obj", "--json", "i.json"]);
    let distance = ["distance", "t.obj", "grid.obj", "--json", "distance.json"];
    run_ok(&sixfold, &distance);
    run_ok(
        &sixfold,
        &["tables", "--json", "tables.json", "--csv", "tables.csv"],
    );
    let query = ["trace", "vertex_edges", "v3", "--json", "trace.json"];
    run_ok(&sixfold, &query);
    let edit = ["trace", "--edit", "poke_face f0", "--json", "edit.json"];
    run_ok(&sixfold, &edit);
    let walk = [
        "trace",
        "--walk",
        "yield v0",
        "--expect",
        "vertex_vertices v3",
    ];
    let walk = [&walk[..], &["--json", "walk.json"]].concat();
    assert_eq!(sixfold.run(&walk).code, Some(1));
    let mut fields = BTreeSet::new();
    let documents = [
        "all.json",
        "c.json",
        "h.json",
        "tables.json",
        "trace.json",
        "edit.json",
        "walk.json",
        "distance.json",
    ];
    for file in documents {
        add_fields(&parsed(&text(&sixfold, file)), &mut fields);
    }
    let inspection = parsed(&text(&sixfold, "i.json"));
    fields.extend(inspection.as_object().expect("an object").keys().cloned());
    for file in ["all.csv", "samples.csv", "tables.csv", "h.csv"] {
        let table = text(&sixfold, file);
        let header = table.lines().next().expect("a header");
        fields.extend(header.split(',').map(str::to_owned));
    }
    fields
}

/// Returns the words between backticks that can be names of fields.
fn code_words(line: &str) -> impl Iterator<Item = &str> {
    let is_name = |word: &&str| {
        !word.is_empty()
            && word
                .chars()
                .all(|c| c.is_ascii_lowercase() || c == '_' || c.is_ascii_digit())
    };
    line.split('`').skip(1).step_by(2).filter(is_name)
}

#[test]
fn every_field_is_documented_and_every_documented_field_exists() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports/SCHEMA.md");
    let schema = fs::read_to_string(file).expect("the file");
    let written = written_fields();
    let mentioned: BTreeSet<&str> = schema.lines().flat_map(code_words).collect();
    let undocumented: Vec<&String> = written
        .iter()
        .filter(|field| !mentioned.contains(field.as_str()))
        .collect();
    assert!(undocumented.is_empty(), "not documented: {undocumented:?}");
    // The first column of a table has the names of fields. Traces have lines, not fields.
    let documents = schema.split("\n## Traces").next().expect("a part");
    let first_columns = documents
        .lines()
        .filter_map(|line| line.strip_prefix("| `"))
        .filter_map(|line| line.split(" |").next())
        .map(|cell| format!("`{cell}"));
    let first_columns: Vec<String> = first_columns.collect();
    let documented: BTreeSet<&str> = first_columns.iter().flat_map(|c| code_words(c)).collect();
    let optional = ["faults", "first_ns", "slowdowns"];
    let missing: Vec<&&str> = documented
        .iter()
        .filter(|name| !written.contains(**name) && !optional.contains(*name))
        .collect();
    assert!(
        missing.is_empty(),
        "documented, but not written: {missing:?}"
    );
}

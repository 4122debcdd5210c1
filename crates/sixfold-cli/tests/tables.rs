//! `sixfold tables`.

use serde_json::Value;

use crate::json_csv::parsed;
use crate::run::{Sixfold, run_ok, text};

#[test]
fn a_cube_is_shown_in_a_half_edge_mesh() {
    let sixfold = Sixfold::new();
    let run = run_ok(&sixfold, &["tables"]);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(lines[0], "half-edge of cube");
    for part in [
        "8 vertices",
        "24 half-edges",
        "6 faces",
        "twin†",
        "† not stored",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    assert!(lines.iter().all(|line| line.chars().count() <= 80));
    assert!(!run.stdout.contains("deleted"), "{}", run.stdout);
    let is_row = |line: &&&str| line.starts_with('h') && line[1..].starts_with(char::is_numeric);
    let rows = lines.iter().filter(is_row);
    assert_eq!(rows.count(), 24);
}

#[test]
fn all_structures_are_shown_and_the_refusal_of_one() {
    let sixfold = Sixfold::new();
    let run = run_ok(&sixfold, &["tables", "--all"]);
    for name in [
        "polygon-soup of cube",
        "indexed-face-set of cube",
        "half-edge of cube",
    ] {
        assert!(run.stdout.contains(name), "{name}");
    }
    assert!(
        run.stdout.contains("! corner-table cannot hold the mesh"),
        "{}",
        run.stdout
    );
    let six = run_ok(&sixfold, &["tables", "--all", "--triangulate"]);
    assert!(six.stdout.contains("corner-table of cube") && !six.stdout.contains('!'));
    assert!(six.stdout.lines().all(|line| line.chars().count() <= 80));
    let only = sixfold.run(&["tables", "--backend", "corner-table"]);
    assert_eq!(only.code, Some(3), "{only:?}");
}

#[test]
fn large_meshes_are_shown_in_parts() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 20);
    let all = sixfold.run(&["tables", "grid.obj"]);
    assert_eq!(all.code, Some(2), "{all:?}");
    let message = "half-edge has 2,242 half-edges, and a table shows at most 200 rows: name the rows, \
                   such as --rows 0..20";
    assert!(all.stderr.contains(message), "{all:?}");
    let part = run_ok(&sixfold, &["tables", "grid.obj", "--rows", "399..400"]);
    for shown in [
        "400 vertices, of which v399 to v399",
        "2,242 half-edges, of which h399 to h400",
        "722 faces, of which f399 to f400",
    ] {
        assert!(part.stdout.contains(shown), "{shown}: {}", part.stdout);
    }
    let none = run_ok(&sixfold, &["tables", "grid.obj", "--rows", "5000..6000"]);
    assert!(
        none.stdout
            .contains("2,242 half-edges, none of them in these rows")
    );
    let reversed = sixfold.run(&["tables", "grid.obj", "--rows", "7..3"]);
    assert_eq!(reversed.code, Some(2), "{reversed:?}");
    assert!(reversed.stderr.contains("write 3..7"), "{reversed:?}");
}

#[test]
fn tables_are_written_as_json_csv_and_markdown() {
    let sixfold = Sixfold::new();
    let run = run_ok(
        &sixfold,
        &[
            "tables",
            "--backend",
            "half-edge,face-vertex",
            "--json",
            "-",
        ],
    );
    let document = parsed(&run.stdout);
    let structures = document["structures"].as_array().expect("a list");
    let names: Vec<&Value> = structures.iter().map(|one| &one["backend"]).collect();
    assert_eq!(names, ["face-vertex", "half-edge"]);
    let halves = &structures[1]["records"][1];
    assert_eq!(halves["element"], "half-edge");
    assert_eq!(halves["total"], 24);
    let columns = halves["columns"].as_array().expect("a list");
    let fields = halves["rows"][0]["fields"].as_array().expect("a list");
    assert_eq!(columns.len(), fields.len());
    assert_eq!(
        (&columns[0]["name"], &columns[0]["derived"]),
        (&"origin".into(), &false.into())
    );
    assert_eq!(fields[0], "v0");

    run_ok(
        &sixfold,
        &["tables", "--csv", "t.csv", "--markdown", "t.md"],
    );
    let csv = text(&sixfold, "t.csv");
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some("backend,element,row,field,derived,table,value")
    );
    assert!(
        csv.contains("half-edge,half-edge,h0,origin,false,halves,v0\n"),
        "{csv:.300}"
    );
    assert!(
        csv.contains("half-edge,half-edge,h0,twin,true,halves,h1\n"),
        "{csv:.300}"
    );
    assert!(csv.contains("half-edge,vertex,v0,position,false,positions,\"(-1, -1, -1)\"\n"));
    assert_eq!(lines.count(), 8 * 2 + 24 * 6 + 6);
    let markdown = text(&sixfold, "t.md");
    assert!(
        markdown.starts_with("## half-edge\n\n| vertex | position | half-edge |\n|---|---|---|\n")
    );
    assert!(markdown.contains("| h0 | v0 |"), "{markdown}");
    assert!(markdown.contains("\n24 half-edges.\n"), "{markdown}");
    let twice = sixfold.run(&["tables", "--csv", "x", "--json", "x"]);
    assert_eq!(twice.code, Some(2), "{twice:?}");
}

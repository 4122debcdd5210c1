//! Tests of report pages and of the commands that they show.

use std::fs;

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::json_csv::completed;
use crate::run::{Run, Sixfold, TETRAHEDRON, run_ok, text};

/// Studies half-edge and corner table on one mesh. `more` are additional arguments.
fn study(sixfold: &Sixfold, more: &[&str]) -> Run {
    let mut arguments = vec!["study", "grid.obj", "--rounds", "2"];
    arguments.extend(["--backends", "half-edge,corner-table"]);
    arguments.extend(["--operations", "vertex_vertices,boundary"]);
    arguments.extend(more);
    sixfold.run(&arguments)
}

fn grid() -> Sixfold {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold
}

fn json(sixfold: &Sixfold, name: &str) -> Value {
    serde_json::from_str(&text(sixfold, name)).expect("JSON")
}

/// Returns the findings of one command, each with its run, mesh and backends.
fn of_kind(results: &Value, kind: &str) -> Vec<Value> {
    let findings = results["findings"].as_array().expect("a list").iter();
    findings
        .filter(|finding| finding["kind"] == kind)
        .map(|finding| completed(results, finding))
        .map(|mut finding| {
            // The places change if a finding is measured again.
            finding["meshes"] = Value::Null;
            finding
        })
        .collect()
}

fn figures(page: &str) -> Vec<&str> {
    let parts = page.split("data-figure=\"").skip(1);
    parts.filter_map(|part| part.split('"').next()).collect()
}

#[test]
fn the_report_of_one_mesh_has_orders_growth_and_a_roofline() {
    let sixfold = grid();
    let run = study(&sixfold, &["--report", "out"]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.stdout.contains("How costs grow: "), "{}", run.stdout);
    let results = json(&sixfold, "out/results.json");
    for lab in ["orders", "growth", "why"] {
        assert_eq!(of_kind(&results, lab).len(), 1, "{lab}");
    }
    let page = text(&sixfold, "out/report.html");
    let expected = [
        "heat-map", "memory", "rankings", "orders", "growth", "roofline",
    ];
    let drawn = figures(&page);
    for id in expected {
        assert!(drawn.contains(&id), "{id}: {drawn:?}");
        let svg = text(&sixfold, &format!("out/figures/{id}.svg"));
        assert!(svg.starts_with("<svg") && svg.contains("<title>"), "{id}");
        let [opened, closed] = ["<g", "</g>"].map(|tag| svg.matches(tag).count());
        assert_eq!(opened, closed, "{id} is not XML");
    }
    // The page, the data and each figure have the command that reproduces them.
    let command = "sixfold study grid.obj --rounds 2 --backends 'half-edge,corner-table'";
    let markdown = text(&sixfold, "out/report.md");
    assert!(
        markdown.matches(command).count() > drawn.len(),
        "{markdown}"
    );
    for lab in ["orders", "growth", "why"] {
        let typed = &of_kind(&results, lab)[0]["run"]["command"];
        assert!(
            typed
                .as_str()
                .is_some_and(|typed| typed.starts_with(command))
        );
    }

    // Finished labs are not measured again. Missing labs are measured.
    fs::remove_file(sixfold.folder().join("out/labs/growth.json")).expect("it is there");
    let again = study(&sixfold, &["--report", "out", "--resume"]);
    assert_eq!(again.code, Some(0), "{again:?}");
    let resumed = json(&sixfold, "out/results.json");
    for lab in ["study", "orders", "why"] {
        assert_eq!(of_kind(&resumed, lab), of_kind(&results, lab), "{lab}");
    }
    assert_ne!(of_kind(&resumed, "growth"), of_kind(&results, "growth"));

    let without = study(&sixfold, &["--report", "bare", "--labs", "none"]);
    assert_eq!(without.code, Some(0), "{without:?}");
    let page = text(&sixfold, "bare/report.html");
    assert!(!figures(&page).iter().any(|id| id.starts_with("growth")));
    assert!(!sixfold.folder().join("bare/labs").exists());
}

#[test]
fn a_lab_that_cannot_be_measured_is_reported_and_left_out() {
    let sixfold = grid();
    let arguments = ["--report", "out", "--rounds", "2", "--labs", "orders,why"];
    let run = sixfold.run(
        &[
            &["study", "grid.obj", "--operations", "boundary"],
            &arguments[..],
        ]
        .concat(),
    );
    assert_eq!(run.code, Some(0), "{run:?}");
    let none = "without why: none of the selected operations is a relation";
    assert!(run.stderr.contains(none), "{}", run.stderr);
    let results = json(&sixfold, "out/results.json");
    let count = |lab: &str| of_kind(&results, lab).len();
    assert_eq!((count("orders"), count("why")), (1, 0));
}

#[test]
fn results_of_several_commands_are_drawn_on_one_page() {
    let sixfold = grid();
    let quickly = ["--rounds", "2", "--backends", "half-edge,corner-table"];
    let run = |command: &[&str], file: &str| {
        run_ok(&sixfold, &[command, &quickly, &["--json", file]].concat());
    };
    run(
        &["study", "grid.obj", "--operations", "boundary"],
        "study.json",
    );
    run(
        &["orders", "grid.obj", "--operations", "boundary"],
        "orders.json",
    );
    run(
        &["why", "grid.obj", "--relations", "face_faces"],
        "why.json",
    );
    run(
        &[
            "growth",
            "--from",
            "100",
            "--to",
            "2000",
            "--steps",
            "3",
            "--operations",
            "boundary",
        ],
        "growth.json",
    );
    let second =
        text(&sixfold, "growth.json").replacen("\"order\": \"given\"", "\"order\": \"morton\"", 1);
    let second = second.replacen("\"seed\": 1", "\"seed\": 2", 1);
    sixfold.file("growth-2.json", &second);
    run(
        &["pick", "grid.obj", "--workload", "smoothing"],
        "pick.json",
    );
    let all = [
        "study.json",
        "orders.json",
        "why.json",
        "growth.json",
        "pick.json",
    ];
    run_ok(
        &sixfold,
        &[&["report"], &all[..], &["growth-2.json", "--to", "out"]].concat(),
    );
    let page = text(&sixfold, "out/report.html");
    let drawn = figures(&page);
    for id in [
        "rankings",
        "orders",
        "roofline",
        "growth",
        "growth-2",
        "pick",
        "pick-break-even",
    ] {
        assert!(drawn.contains(&id), "{id}: {drawn:?}");
    }
    // Each figure shows the command that measured it, not the command that drew it.
    assert!(page.contains("sixfold pick grid.obj --workload smoothing"));
    assert!(page.contains("sixfold why grid.obj --relations face_faces"));

    // `compare` accepts the report of one mesh as a study.
    let quick = ["--rounds", "2", "--operations", "boundary"];
    let report = ["--report", "again", "--labs", "none"];
    run_ok(
        &sixfold,
        &[&["study", "grid.obj"], &quick[..], &report].concat(),
    );
    run_ok(&sixfold, &["compare", "study.json", "again"]);

    run_ok(&sixfold, &["report", "growth.json", "--to", "alone"]);
    let page = text(&sixfold, "alone/report.html");
    assert!(page.contains("<h1>How costs grow: "), "{page:.2000}");
    assert_eq!(figures(&page), ["growth"]);
}

#[test]
fn invalid_results_are_refused() {
    let sixfold = grid();
    sixfold.file("other.json", "{\"schema\": 4}");
    sixfold.file("cut.json", "{\"schema\": 4, \"findings\": [");
    sixfold.file("mesh.obj", TETRAHEDRON);
    fs::create_dir(sixfold.folder().join("foreign")).expect("a folder");
    sixfold.file("foreign/results.json", "{\"mine\": true}");
    let quick = ["--rounds", "2", "--operations", "boundary", "--json"];
    run_ok(
        &sixfold,
        &[&["study", "grid.obj"], &quick[..], &["a.json"]].concat(),
    );
    let later = text(&sixfold, "a.json").replacen("\"unix_time\": 1", "\"unix_time\": 2", 1);
    sixfold.file("b.json", &later);
    run_ok(
        &sixfold,
        &["compare", "a.json", "a.json", "--json", "changes.json"],
    );
    for (arguments, message) in [
        (
            &["report", "other.json", "--to", "out"][..],
            "has no findings",
        ),
        (&["report", "cut.json", "--to", "out"], "ends too early"),
        (
            &["report", "changes.json", "--to", "out"],
            "has no findings",
        ),
        (
            &["study", "grid.obj", "--report", "foreign"],
            "exists already",
        ),
        (&["report", "mesh.obj", "--to", "out"], "is not JSON"),
        (&["report", "none.json", "--to", "out"], "cannot be read"),
        (
            &["report", "a.json", "b.json", "--to", "out"],
            "both have a study of grid.obj",
        ),
        (
            &["report", "a.json", "--to", "mesh.obj"],
            "cannot be written",
        ),
        (&["report", "a.json"], "--to"),
        (&["study", "grid.obj", "--labs", "why"], "--report"),
        (
            &[
                "study", "grid.obj", "mesh.obj", "--report", "x", "--labs", "why",
            ],
            "one mesh",
        ),
        (
            &["study", "grid.obj", "--report", "x", "--labs", "none,why"],
            "no lab is called `none`",
        ),
    ] {
        assert_refused(&sixfold, arguments, 2, message);
    }
    assert!(
        !sixfold.folder().join("out").exists(),
        "nothing was written"
    );
}

/// The page of every document has its results, also if they are counts without times.
#[test]
fn memory_and_counts_have_pages() {
    let sixfold = grid();
    let counts = ["why", "grid.obj", "--counts-only", "--json", "counts.json"];
    run_ok(&sixfold, &counts);
    run_ok(&sixfold, &["memory", "grid.obj", "--json", "memory.json"]);
    for (files, parts) in [
        (&["counts.json"][..], &["Reads of each query"][..]),
        (
            &["memory.json"],
            &["the allocator give the same bytes", "Allocated bytes"],
        ),
        (
            &["counts.json", "memory.json"],
            &["Reads of each query", "Bytes of each structure"],
        ),
    ] {
        let arguments = [&["report"], files, &["--to", "page"]].concat();
        run_ok(&sixfold, &arguments);
        let pages = ["page/report.html", "page/report.md"].map(|name| text(&sixfold, name));
        for part in parts {
            assert!(pages.iter().all(|page| page.contains(part)), "{part}");
        }
        assert!(pages[0].contains("half-edge"));
    }
}

/// The tables of a Markdown file have the same number of cells in each row, and names of meshes are escaped.
#[test]
fn results_are_written_as_markdown() {
    let sixfold = Sixfold::new();
    sixfold.grid("a_b#1.obj", 8);
    let study = ["study", "a_b#1.obj", "--rounds", "8", "--json", "a.json"];
    let more = ["--operations", "boundary,edge_length", "--markdown", "a.md"];
    run_ok(&sixfold, &[&study[..], &more].concat());
    let markdown = text(&sixfold, "a.md");
    let title = "# Mesh data structures on a\\_b\\#1.obj\n";
    assert!(markdown.starts_with(title), "{markdown}");
    assert!(!markdown.contains("]("), "no links to figures: {markdown}");
    let cells = |line: &str| line.replace("\\|", "").matches('|').count();
    let lines: Vec<&str> = markdown.lines().collect();
    let mut tables = lines.chunk_by(|a, b| !a.is_empty() && !b.is_empty());
    let tables = tables.by_ref().filter(|lines| lines[0].starts_with('|'));
    let tables: Vec<&[&str]> = tables.collect();
    for table in &tables {
        assert!(
            table.iter().all(|row| cells(row) == cells(table[0])),
            "{table:?}"
        );
    }
    let header = "|  | structure | × the fastest | 95 % | time | per | remark |";
    let ranking = tables
        .iter()
        .find(|table| table[0] == header)
        .expect("all times");
    let of = |operation: &str| {
        let rows = ranking.iter();
        rows.filter(|row| row.starts_with(&format!("| {operation} |")))
            .count()
    };
    assert_eq!([of("boundary"), of("edge\\_length")], [6, 6], "{markdown}");
    // Those that are not the fastest have an interval.
    assert!(
        ranking.iter().filter(|row| row.contains(" to ")).count() >= 10,
        "{ranking:?}"
    );

    run_ok(&sixfold, &["merge", "a.json", "--markdown", "merged.md"]);
    assert_eq!(text(&sixfold, "merged.md"), markdown);
    let pick = ["pick", "a_b#1.obj", "--rounds", "8", "--markdown", "-"];
    let pick = run_ok(&sixfold, &pick).stdout;
    assert!(pick.starts_with("# ") && pick.contains(header), "{pick}");
    let same = run_ok(
        &sixfold,
        &["compare", "a.json", "a.json", "--markdown", "-"],
    )
    .stdout;
    assert!(
        same.starts_with("# What changed: a.json → a.json\n"),
        "{same}"
    );
    assert_eq!(same.matches("| edge\\_length | ").count(), 6, "{same}");
}

#[test]
fn a_page_of_another_program_is_replaced_only_by_force() {
    let sixfold = grid();
    fs::create_dir(sixfold.folder().join("site")).expect("a folder");
    sixfold.file("site/report.html", "<!DOCTYPE html><title>mine</title>");
    let message = "site/report.html exists already and is not a report of Sixfold: name another folder, or replace it with --force";
    let measure = ["study", "grid.obj", "--rounds", "2"];
    let into_site = [&measure[..], &["--labs", "none", "--report", "site"]].concat();
    assert_refused(&sixfold, &into_site, 2, message);
    assert!(text(&sixfold, "site/report.html").ends_with("<title>mine</title>"));
    run_ok(
        &sixfold,
        &[
            &measure[..],
            &["--operations", "boundary", "--json", "results.json"],
        ]
        .concat(),
    );
    let draw = ["report", "results.json", "--to", "site"];
    assert_refused(&sixfold, &draw, 2, message);
    run_ok(&sixfold, &[&draw[..], &["--force"]].concat());
    assert!(
        text(&sixfold, "site/report.html")
            .contains("<meta name=\"generator\" content=\"Sixfold\">")
    );
    // It is ours now.
    run_ok(&sixfold, &draw);
}

#[test]
fn reports_do_not_name_the_folders_of_the_machine() {
    let sixfold = grid();
    let folder = sixfold.folder().to_str().expect("a name").to_owned();
    let (mesh, out) = (format!("{folder}/grid.obj"), format!("{folder}/out"));
    let measure = ["study", &mesh, "--rounds", "2", "--labs", "none"];
    let into_out = ["--operations", "boundary", "--report", &out];
    run_ok(
        &sixfold,
        &[&measure[..], &into_out, &["--figures", "paper"]].concat(),
    );
    let mut files = 0;
    for part in ["out", "paper"] {
        for entry in fs::read_dir(sixfold.folder().join(part)).expect("a folder") {
            let path = entry.expect("an entry").path();
            let Ok(text) = fs::read_to_string(&path) else {
                continue; // a folder or a PDF file
            };
            assert!(!text.contains(&folder), "{}", path.display());
            files += 1;
        }
    }
    assert!(files > 10, "{files} files");
    assert!(text(&sixfold, "out/report.md").contains("sixfold study grid.obj"));
    // The study goes on: the file of the mesh has its whole name.
    run_ok(&sixfold, &[&measure[..], &into_out, &["--resume"]].concat());
}

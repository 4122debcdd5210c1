//! The command line of a user's programs, by the example `programs`.

use serde_json::Value;

use crate::json_csv::finding;
use crate::run::{Sixfold, TETRAHEDRON, interrupted, text};

#[test]
fn programs_are_measured_and_written() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let run = sixfold.run_programs(&[
        "grid.obj",
        "--programs",
        "geodesics,regions",
        "--backends",
        "half-edge,corner-table",
        "--rounds",
        "2",
        "--json",
        "r.json",
    ]);
    assert_eq!(run.code, Some(0), "{run:?}");
    for part in [
        "grid",
        "144 vertices",
        "geodesics",
        "regions",
        "cargo add sixfold",
    ] {
        assert!(run.stdout.contains(part), "`{part}` in {run:?}");
    }
    let results: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    let findings = results["findings"].as_array().expect("a list");
    let names: Vec<&Value> = findings
        .iter()
        .map(|finding| &finding["workload"]["name"])
        .collect();
    assert_eq!(names, ["geodesics", "regions"]);
    for finding in findings {
        assert_eq!(finding["kind"], "pick");
        let ranking = finding["ranking"].as_array().expect("a list");
        assert_eq!(ranking.len(), 2, "{finding}");
        assert_eq!(finding["workload"]["own_ns"], 0.0, "{finding}");
        let asked = finding["program"]["asked"].as_array().expect("recorded");
        assert!(!asked.is_empty(), "{finding}");
    }
}

#[test]
fn the_commands_for_results_accept_results_of_programs() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    for file in ["a.json", "b.json"] {
        let run = sixfold.run_programs(&[
            "grid.obj",
            "--programs",
            "regions",
            "--backends",
            "half-edge,corner-table",
            "--rounds",
            "2",
            "--json",
            file,
        ]);
        assert_eq!(run.code, Some(0), "{run:?}");
    }
    let merged = sixfold.run(&["merge", "a.json", "b.json", "--json", "both.json"]);
    assert_eq!(merged.code, Some(0), "{merged:?}");
    let compared = sixfold.run(&["compare", "a.json", "b.json"]);
    // Building and the program, on two structures.
    assert!(
        compared.stdout.contains("Of 4 measurements"),
        "{compared:?}"
    );
    let report = sixfold.run(&["report", "a.json", "--to", "out"]);
    assert_eq!(report.code, Some(0), "{report:?}");
    let page = text(&sixfold, "out/report.html");
    assert!(page.contains("regions"), "the page names the program");
}

#[test]
fn bad_arguments_and_meshes_are_refused() {
    let sixfold = Sixfold::new();
    sixfold.file("no-mesh.obj", "v 0 0 0\n");
    sixfold.file("tetrahedron.obj", TETRAHEDRON);
    let cases: [(&[&str], &str); 4] = [
        (
            &["--programs", "dijkstra"],
            "no program is called `dijkstra`: choose from geodesics, feature-lines",
        ),
        (&["missing.obj"], "missing.obj"),
        (&["no-mesh.obj"], "no face"),
        (
            &["tetrahedron.obj", "--backends", "half-edges"],
            "half-edges",
        ),
    ];
    for (arguments, message) in cases {
        let run = sixfold.run_programs(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {run:?}");
        assert!(run.stderr.contains(message), "{arguments:?}: {run:?}");
    }
    let one_structure = ["--order", "canonical", "tetrahedron.obj", "--backends"];
    for (backend, code, message) in [
        ("half-edges", 2, "half-edges"),
        ("half-edge", 0, "nothing to compare"),
    ] {
        let run = sixfold.run_programs(&[&one_structure[..], &[backend]].concat());
        assert_eq!(run.code, Some(code), "{run:?}");
        assert!((run.stdout + &run.stderr).contains(message), "{message}");
    }
    let piped = sixfold.run_programs(&["-", "--isolate"]);
    assert_eq!(piped.code, Some(2), "{piped:?}");
    assert!(piped.stderr.contains("save it to a file"), "{piped:?}");
    let help = sixfold.run_programs(&["--help"]);
    assert_eq!(help.code, Some(0));
    assert!(help.stdout.contains("scattered-normals"), "{help:?}");
}

#[test]
fn recorded_programs_run_again_on_every_structure() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold.grid("other.obj", 13);
    let programs = "geodesics,remesh,taubin";
    let run = sixfold.run_programs(&[
        "grid.obj",
        "--triangulate",
        "--programs",
        programs,
        "--record",
        "r",
        "--rounds",
        "2",
    ]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(run.stdout.matches("Recorded: ").count(), 3, "{run:?}");
    for program in programs.split(',') {
        let trace = format!("r/{program}.trace");
        let options = ["--triangulate", "--budget", "100ms"];
        let run =
            sixfold.run(&[&["workloads", "--trace", &trace, "grid.obj"], &options[..]].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        assert!(run.stdout.contains("[mix]"), "{run:?}");
        sixfold.file(&format!("r/{program}.toml"), &run.stdout);
        for option in ["--workload", "--trace"] {
            let ending = if option == "--trace" { "trace" } else { "toml" };
            let file = format!("r/{program}.{ending}");
            let run = sixfold.run(&[
                "pick",
                "grid.obj",
                "--triangulate",
                option,
                &file,
                "--rounds",
                "2",
                "--json",
                "p.json",
            ]);
            assert_eq!(run.code, Some(0), "{run:?}");
            let results: Value = serde_json::from_str(&text(&sixfold, "p.json")).expect("JSON");
            let finding = &results["findings"][0];
            assert_eq!(finding["workload"]["name"], program);
            let ranking = finding["ranking"].as_array().expect("a list");
            assert!(ranking.len() >= 3, "{finding}");
            let words: Vec<&str> = run.stdout.split_whitespace().collect();
            // Whether the program's own work can be measured depends on the machine.
            let own_ns = finding["workload"]["own_ns"].as_f64().expect("a number");
            let is_told = words.join(" ").contains("own work");
            assert_eq!(is_told, own_ns > 0.0, "{run:?}");
        }
    }
    let trace = [
        "pick",
        "grid.obj",
        "--triangulate",
        "--trace",
        "r/geodesics.trace",
    ];
    let twice = ["--rounds", "1", "--launches", "2", "--json", "t.json"];
    let run = sixfold.run(&[&trace[..], &twice].concat());
    assert_eq!(run.code, Some(0), "{run:?}");
    let results: Value = serde_json::from_str(&text(&sixfold, "t.json")).expect("JSON");
    assert!(
        launches(&results["findings"][0])
            .iter()
            .all(|&count| count == 2)
    );

    let run = sixfold.run(&[
        "pick",
        "other.obj",
        "--triangulate",
        "--trace",
        "r/geodesics.trace",
        "--rounds",
        "2",
    ]);
    assert_eq!(run.code, Some(1), "{run:?}");
    let words: Vec<&str> = run.stdout.split_whitespace().collect();
    let refusal = "the trace was recorded on a mesh with";
    assert!(words.join(" ").contains(refusal), "{run:?}");
    let trace = text(&sixfold, "r/geodesics.trace");
    let (cut, _) = trace.split_at(trace.len() / 2);
    let (cut, _) = cut.rsplit_once('\n').expect("several lines");
    sixfold.file("cut.trace", cut);
    for (file, message) in [
        ("cut.trace", "cut off"),
        ("grid.obj", "this is not a trace"),
        ("missing.trace", "missing.trace"),
    ] {
        let run = sixfold.run(&["pick", "grid.obj", "--trace", file]);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
    }
    let run = sixfold.run_programs(&["grid.obj", "other.obj", "--record", "r"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stderr.contains("single mesh"), "{run:?}");
    // The Laplacian needs triangles.
    assert_eq!(
        sixfold.run(&["generate", "cube", "-o", "cube.obj"]).code,
        Some(0)
    );
    let run = sixfold.run_programs(&["cube.obj", "--programs", "laplacian", "--record", "r"]);
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.stderr.contains("is not a triangle"), "{run:?}");
}

#[test]
fn queries_also_run_on_relation_tables() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let run = sixfold.run_programs(&[
        "grid.obj",
        "--triangulate",
        "--programs",
        "laplacian,feature-lines",
        "--backends",
        "half-edge,relation-tables",
        "--rounds",
        "2",
        "--json",
        "r.json",
    ]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let results: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    for finding in results["findings"].as_array().expect("a list") {
        let ranking = finding["ranking"].as_array().expect("a list");
        let tables = ranking.iter().find(|r| r["backend"] == "relation-tables");
        assert_eq!(tables.expect("measured")["made_from"], "face-vertex");
        assert_eq!(finding["mismatches"], Value::Array(Vec::new()), "{finding}");
    }
}

#[test]
fn a_new_package_is_written_once() {
    let sixfold = Sixfold::new();
    let checkout = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    // The folder of the test is not below a repository.
    let lost = sixfold.run(&["new", "lost"]);
    assert_eq!(lost.code, Some(2), "{lost:?}");
    assert!(lost.stderr.contains("--checkout"), "{lost:?}");
    let run = sixfold.run(&["new", "my-program", "--checkout", checkout]);
    assert_eq!(run.code, Some(0), "{run:?}");
    let flags = text(&sixfold, "my-program/.cargo/config.toml");
    let own = std::fs::read_to_string(format!("{checkout}/.cargo/config.toml")).expect("a file");
    let flags_of = |text: &str| {
        text.lines()
            .find(|l| l.starts_with("rustflags"))
            .map(str::to_owned)
    };
    assert_eq!(flags_of(&flags), flags_of(&own), "times can be compared");
    let manifest = text(&sixfold, "my-program/Cargo.toml");
    assert!(manifest.contains("name = \"my-program\""), "{manifest}");
    let (_, path) = manifest
        .split_once("sixfold-measure = { path = \"")
        .expect("a dependency");
    let (path, _) = path.split_once('"').expect("a path");
    assert!(std::path::Path::new(path).join("Cargo.toml").is_file());
    assert!(text(&sixfold, "my-program/src/main.rs").contains("sixfold_measure::main"));
    let run = sixfold.run(&["new", "editing", "--edits", "--checkout", checkout]);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(text(&sixfold, "editing/src/main.rs").contains("impl EditProgram"));
    for (arguments, message) in [
        (
            &["new", "my-program", "--checkout", checkout][..],
            "not empty",
        ),
        (&["new", "1st"], "package name"),
        (
            &["new", "another", "--checkout", "my-program"],
            "no Sixfold repository",
        ),
    ] {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(message), "{run:?}");
    }
}

/// Runs faulty programs on four structures. Returns the finding of each.
fn run_faulty(sixfold: &Sixfold, programs: &str, more: &[&str], code: i32) -> (String, Vec<Value>) {
    let mut arguments = vec![
        "grid.obj",
        "--programs",
        programs,
        "--backends",
        "face-vertex,half-edge,corner-table,relation-tables",
        "--triangulate",
        "--rounds",
        "2",
        "--json",
        "r.json",
    ];
    arguments.extend(more);
    let run = sixfold.run_example("faulty_programs", &arguments);
    assert_eq!(run.code, Some(code), "{run:?}");
    let results: Value = serde_json::from_str(&text(sixfold, "r.json")).expect("JSON");
    let findings = results["findings"].as_array().expect("a list").clone();
    (run.stderr, findings)
}

#[test]
fn different_results_are_shown_with_their_likely_reasons() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let arguments = [
        "grid.obj",
        "--triangulate",
        "--programs",
        "first-neighbours",
        "--backends",
        "face-vertex,half-edge,winged-edge",
        "--rounds",
        "2",
        "--json",
        "r.json",
    ];
    let run = sixfold.run_example("faulty_programs", &arguments);
    assert_eq!(run.code, Some(1), "{run:?}");
    let finding = finding(&text(&sixfold, "r.json"));
    let wrong = finding["mismatches"].as_array().expect("a list");
    assert!(!wrong.is_empty(), "{finding}");
    let header = run.stdout.lines().find(|line| line.contains("differs by"));
    let header = header.unwrap_or_else(|| panic!("{}", run.stdout));
    assert!(header.trim_start().starts_with("same"), "{header}");
    let ranking = finding["ranking"].as_array().expect("a list");
    for row in ranking {
        let name = row["backend"].as_str().expect("a name");
        let result = row["result"].as_f64().expect("a number");
        let mut lines = run.stdout.lines();
        let line =
            lines.find(|line| line.starts_with(name) && line.contains(&format!("{result:?}")));
        let line = line.unwrap_or_else(|| panic!("{name} {result}: {}", run.stdout));
        let mut cells = line.split_whitespace().skip(1);
        let letter = cells.next().expect("a letter");
        // Only what differs has a third cell.
        assert_eq!(cells.count(), if letter == "A" { 1 } else { 2 }, "{line}");
    }
    assert!(
        run.stdout
            .contains("The results differ, so the times are not"),
        "{run:?}"
    );
    assert!(!run.stdout.contains("clearly"), "{run:?}");
    let said = run.stdout.replace("\n  ", " ");
    for reason in [
        "agrees with no other",
        "Likely reasons",
        "sorting them by their positions",
        "(3) sums of `f32`",
    ] {
        assert!(said.contains(reason), "{reason}: {said}");
    }
    // In one order of the neighbours, all structures find the same first one.
    let arguments = [
        "grid.obj",
        "--triangulate",
        "--order",
        "canonical",
        "--programs",
    ];
    let run = sixfold.run_example(
        "faulty_programs",
        &[&arguments[..], &["first-neighbours"]].concat(),
    );
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(
        run.stdout.contains("in the canonical order only"),
        "{run:?}"
    );
    let run = sixfold.run_example(
        "faulty_programs",
        &[&arguments[..], &["sound,panicking"]].concat(),
    );
    assert_eq!(run.code, Some(1), "{run:?}");
    assert_eq!(
        run.stdout.matches("results agree, up to rounding").count(),
        2,
        "{run:?}"
    );
    assert!(
        run.stdout.contains("half-edge: the program panicked"),
        "{run:?}"
    );
    let run = sixfold.run_programs(&["grid.obj", "--triangulate", "--order", "canonical"]);
    assert_eq!(run.stdout.matches("Program: ").count(), 8, "{run:?}");
}

fn ranked(finding: &Value) -> Vec<&str> {
    let ranking = finding["ranking"].as_array().expect("a list").iter();
    let mut names: Vec<&str> = ranking.filter_map(|row| row["backend"].as_str()).collect();
    names.sort_unstable();
    names
}

#[test]
#[cfg(unix)]
fn isolated_programs_exclude_only_the_structures_on_which_they_fail() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let limits = ["--isolate", "--time-limit", "5s", "--memory-limit", "250MB"];
    let (stderr, findings) = run_faulty(
        &sixfold,
        "sound,endless,crashing,hoarding,panicking",
        &limits,
        1,
    );
    let named = "endless on half-edge; crashing on half-edge; hoarding on half-edge; panicking on half-edge";
    assert!(stderr.contains(named), "{stderr}");
    let reasons = [
        None,
        Some("no answer to run within 5 s"),
        Some("SIGABRT"),
        Some("memory allocation of"),
        Some("half-edges are not welcome (at crates/measure/examples/faulty_programs.rs:"),
    ];
    assert_eq!(findings.len(), reasons.len());
    for (finding, expected) in findings.iter().zip(reasons) {
        let excluded = finding["excluded"].as_array().expect("a list");
        let mut names = vec!["corner-table", "face-vertex", "relation-tables"];
        match expected {
            None => names.insert(2, "half-edge"),
            Some(expected) => {
                assert_eq!(excluded.len(), 1, "{finding}");
                assert_eq!(excluded[0]["backend"], "half-edge");
                assert_eq!(excluded[0]["failed"], true);
                let reason = excluded[0]["reason"].as_str().expect("a text");
                assert!(reason.contains(expected), "{reason}");
            }
        }
        assert_eq!(ranked(finding), names);
        assert_eq!(finding["mismatches"], Value::Array(Vec::new()), "{finding}");
        let asked = &finding["program"]["asked"];
        assert_eq!(asked[0]["operation"], "position", "{asked}");
        for row in finding["ranking"].as_array().expect("a list") {
            assert!(row["bytes"].as_u64().expect("a number") > 1000, "{row}");
            assert!(row["build_ns"].as_f64().expect("a number") > 0.0, "{row}");
        }
    }
}

#[test]
fn a_program_that_fails_on_one_structure_is_an_error_that_names_it() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let failing = "panicking,not-a-number";
    let named = "a program fails: panicking on half-edge; not-a-number on half-edge: correct it";
    let (stderr, findings) = run_faulty(&sixfold, failing, &[], 1);
    assert!(stderr.contains(&format!("error: {named}")), "{stderr}");
    for finding in &findings {
        assert_eq!(finding["excluded"][0]["failed"], true, "{finding}");
        assert_eq!(finding["ranking"].as_array().map(Vec::len), Some(3));
        let first = finding["warnings"][0].as_str().expect("a text");
        assert!(
            first.starts_with("The program fails on half-edge: "),
            "{first}"
        );
    }
    // The panic is a result, and not printed a second time.
    assert!(!stderr.contains("panicked at"), "{stderr}");
    let (stderr, _) = run_faulty(&sixfold, failing, &["--keep-going"], 0);
    assert!(stderr.contains(&format!("note: {named}")), "{stderr}");
    // Nothing is left to rank.
    let only = ["--backends", "half-edge"];
    let arguments = ["grid.obj", "--programs", "panicking", "--rounds", "2"];
    let run = sixfold.run_example("faulty_programs", &[&arguments[..], &only].concat());
    assert_eq!(run.code, Some(1), "{run:?}");
    let none =
        "error: no structure is ranked for panicking, for the reasons above: correct the program";
    assert!(run.stderr.contains(none), "{run:?}");
    assert!(!run.stderr.contains("other results"), "{run:?}");
    assert!(
        run.stdout.contains("The program fails on half-edge"),
        "{run:?}"
    );
    // A failure in one launch of three is one, too.
    let (stderr, findings) = run_faulty(&sixfold, "panicking-once", &["--launches", "3"], 1);
    assert!(stderr.contains("panicking-once on half-edge"), "{stderr}");
    assert_eq!(
        ranked(&findings[0]),
        ["corner-table", "face-vertex", "relation-tables"]
    );
}

#[test]
fn a_program_with_other_work_on_one_structure_has_a_different_result() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let (stderr, findings) = run_faulty(&sixfold, "skipping", &[], 1);
    assert!(stderr.contains("differ"), "{stderr}");
    let wrong = findings[0]["mismatches"].as_array().expect("a list");
    assert!(wrong.contains(&Value::from("half-edge")), "{wrong:?}");
    let arguments = [
        "grid.obj",
        "--triangulate",
        "--programs",
        "skipping",
        "--rounds",
        "2",
    ];
    let run = sixfold.run_example("faulty_programs", &arguments);
    let header = run.stdout.lines().find(|line| line.ends_with("elements"));
    assert!(header.is_some_and(|line| line.contains("same")), "{run:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_program_beyond_a_limit_ends_the_command_and_keeps_the_others() {
    for (fault, option, limit, message) in [
        ("endless", "--time-limit", "5s", "did not end within 5.0 s"),
        (
            "hoarding",
            "--memory-limit",
            "250MB",
            "uses more memory than 250 MB",
        ),
    ] {
        let sixfold = Sixfold::new();
        sixfold.grid("grid.obj", 12);
        let programs = format!("sound,{fault}");
        let (stderr, findings) = run_faulty(&sixfold, &programs, &[option, limit], 4);
        assert!(stderr.contains(message), "{stderr}");
        assert!(stderr.contains("on half-edge"), "{stderr}");
        assert_eq!(findings.len(), 1, "{findings:?}");
        assert_eq!(findings[0]["workload"]["name"], "sound");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn an_interrupt_ends_an_endless_program_and_keeps_the_others() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let mut command = sixfold.example("faulty_programs");
    command.args(["grid.obj", "--programs", "sound,endless", "--rounds", "2"]);
    command.args(["--backends", "half-edge", "--json", "r.json"]);
    let run = interrupted(command, "INT", "endless: ");
    assert!(
        run.stderr.contains("did not end after the interrupt"),
        "{run:?}"
    );
    let results: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    let findings = results["findings"].as_array().expect("a list");
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!(findings[0]["workload"]["name"], "sound");
}

/// Returns the number of launches that measured each backend of a ranking.
fn launches(finding: &Value) -> Vec<usize> {
    let ranking = finding["ranking"].as_array().expect("a list").iter();
    let times = ranking.map(|row| row["launch_ns"].as_array().map_or(1, Vec::len));
    times.collect()
}

#[test]
fn programs_are_measured_in_launches() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold.grid("other.obj", 9);
    let measure = |file, more: &[&'static str]| {
        let programs = [
            "grid.obj",
            "--programs",
            "geodesics,regions",
            "--rounds",
            "2",
        ];
        let options = ["--backends", "half-edge,corner-table", "--json", file];
        let run = sixfold.run_programs(&[&programs[..], &options, more].concat());
        assert_eq!(run.code, Some(0), "{run:?}");
        for program in ["geodesics", "regions"] {
            let answer = format!("Program:  {program}\n");
            assert_eq!(run.stdout.matches(&answer).count(), 1, "{run:?}");
        }
        let results: Value = serde_json::from_str(&text(&sixfold, file)).expect("JSON");
        assert_eq!(results["runs"].as_array().map(Vec::len), Some(1));
        results
    };
    let results = measure("r.json", &["--launches", "3"]);
    assert_eq!(results["runs"][0]["settings"]["launches"], 3);
    let findings = results["findings"].as_array().expect("a list");
    let names = findings.iter().map(|finding| &finding["workload"]["name"]);
    assert_eq!(names.collect::<Vec<_>>(), ["geodesics", "regions"]);
    for finding in findings {
        assert_eq!(launches(finding), [3; 2], "{finding}");
        assert_eq!(finding["control_ratios"].as_array().map(Vec::len), Some(3));
        for row in finding["ranking"].as_array().expect("a list") {
            assert!(
                row["ns_ci_low"].as_f64() < row["ns_ci_high"].as_f64(),
                "{row}"
            );
            assert_eq!(row["samples"], 6, "{row}");
        }
        assert!(
            !finding["program"]["asked"]
                .as_array()
                .expect("recorded")
                .is_empty()
        );
    }
    // Each program has its times of all documents and on all meshes.
    measure("again.json", &["--seed", "9"]);
    let all = [
        "merge",
        "--repeat",
        "r.json",
        "again.json",
        "--json",
        "all.json",
    ];
    let run = sixfold.run(&all);
    assert_eq!(run.code, Some(0), "{run:?}");
    let all: Value = serde_json::from_str(&text(&sixfold, "all.json")).expect("JSON");
    let all = all["findings"].as_array().expect("a list");
    assert!(all.len() == 2 && all.iter().all(|finding| launches(finding) == [4; 2]));
    let two = measure("two.json", &["other.obj", "--launches", "2"]);
    for on_mesh in two["findings"][1]["by_mesh"]
        .as_array()
        .expect("two meshes")
    {
        assert_eq!(launches(on_mesh), [2; 2], "{on_mesh}");
    }
    for (option, value) in [("--isolate", None), ("--record", Some("folder"))] {
        let arguments = ["grid.obj", "--launches", "2", option]
            .into_iter()
            .chain(value);
        let run = sixfold.run_programs(&arguments.collect::<Vec<_>>());
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains("cannot be used with"), "{run:?}");
    }
}

#[test]
fn the_lines_that_a_program_prints_do_not_disturb_its_launches() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let (_, findings) = run_faulty(&sixfold, "chatting", &["--launches", "2"], 0);
    assert_eq!(launches(&findings[0]), [2; 4]);
}

/// A launch of a program that does not end is the last one, so that the others do not wait as long.
#[test]
#[cfg(target_os = "linux")]
fn the_launch_of_an_endless_program_is_the_last_one() {
    let three = ["--launches", "3", "--time-limit", "5s"];
    for (programs, launch, kept) in [
        ("sound,endless", 1, &[("sound", 1)][..]),
        // The first launch is whole.
        (
            "sound,endless-once",
            2,
            &[("sound", 2), ("endless-once", 1)],
        ),
    ] {
        let sixfold = Sixfold::new();
        sixfold.grid("grid.obj", 12);
        let (stderr, findings) = run_faulty(&sixfold, programs, &three, 4);
        let message = format!(
            "error: launch {launch} of 3 is the last one: a program did not end within 5.0 s, at: {}: ",
            kept.last()
                .map_or("endless", |(name, _)| if *name == "sound" {
                    "endless"
                } else {
                    name
                })
        );
        assert!(stderr.contains(&message), "{stderr}");
        assert_eq!(stderr.matches("did not end").count(), 1, "{stderr}");
        let found = findings.iter().map(|finding| {
            let name = finding["workload"]["name"].as_str().expect("a name");
            assert_eq!(finding["interrupted"], false);
            let launches = launches(finding);
            assert_eq!(launches, [launches[0]; 4]);
            (name, launches[0])
        });
        assert_eq!(found.collect::<Vec<_>>(), kept);
        assert!(
            text(&sixfold, "r.json").contains(&message),
            "the document has it"
        );
    }
}

#[test]
#[cfg(unix)]
fn a_launch_in_which_a_program_crashes_is_left_out() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let three = ["--launches", "3"];
    let (stderr, findings) = run_faulty(&sixfold, "sound,crashing-once", &three, 1);
    let message = "note: launch 2 of 3 is left out: it ended with signal: 6";
    assert!(stderr.contains(message), "{stderr}");
    assert_eq!(findings.len(), 2);
    assert!(
        findings.iter().all(|finding| launches(finding) == [2; 4]),
        "{findings:?}"
    );
    let mut command = sixfold.example("faulty_programs");
    command.args([
        "grid.obj",
        "--programs",
        "crashing",
        "--rounds",
        "1",
        "--launches",
        "2",
    ]);
    let run = crate::run::Run::from_output(command.output().expect("it runs"));
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.stderr
            .contains("error: no launch has a result: it ended with signal: 6"),
        "{run:?}"
    );
}

#[test]
#[cfg(target_os = "linux")]
fn an_interrupt_ends_the_launch_of_an_endless_program() {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    let mut command = sixfold.example("faulty_programs");
    command.args(["grid.obj", "--programs", "sound,endless", "--rounds", "2"]);
    command.args([
        "--backends",
        "half-edge",
        "--launches",
        "2",
        "--json",
        "r.json",
    ]);
    let run = interrupted(command, "INT", "launch 1 of 2: endless: ");
    assert!(
        run.stderr.contains("did not end after the interrupt"),
        "{run:?}"
    );
    let results: Value = serde_json::from_str(&text(&sixfold, "r.json")).expect("JSON");
    let findings = results["findings"].as_array().expect("a list");
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!(findings[0]["workload"]["name"], "sound");
}

#[test]
fn a_mesh_that_cannot_be_read_is_not_left_out_of_a_recording() {
    let sixfold = Sixfold::new();
    sixfold.grid("a.obj", 5);
    let run = sixfold.run_programs(&["a.obj", "missing.obj", "--record", "out"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.stderr.contains("--record needs a single mesh"),
        "{run:?}"
    );
    assert!(!sixfold.folder().join("out").exists());
}

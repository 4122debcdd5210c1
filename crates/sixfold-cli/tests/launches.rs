//! Several launches of a study: pooled documents, a launch that dies, interruptions, and `merge --repeat`.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::Child;

use serde_json::Value;

use crate::run::{Run, Sixfold, run_ok, text, wait_for};

const STUDY: [&str; 6] = [
    "study",
    "grid.obj",
    "--operations",
    "build,circulate",
    "--backends",
    "face-vertex,half-edge",
];

fn with_grid() -> Sixfold {
    let sixfold = Sixfold::new();
    sixfold.grid("grid.obj", 12);
    sixfold
}

/// Returns the arguments of a short study, and `more`.
fn study<'a>(more: &[&'a str]) -> Vec<&'a str> {
    STUDY.iter().chain(more).copied().collect()
}

fn document(sixfold: &Sixfold, name: &str) -> Value {
    serde_json::from_str(&text(sixfold, name)).expect("JSON")
}

/// Returns the times of each row in each launch.
fn launches_of_rows(document: &Value) -> Vec<usize> {
    let rows = document["findings"][0]["results"].as_array().expect("rows");
    let launches = rows.iter().map(|row| &row["launch_ns"]);
    launches
        .map(|launches| {
            let times = launches.as_array().expect("several launches");
            times.iter().filter(|ns| ns.is_f64()).count()
        })
        .collect()
}

fn launches_of_samples(document: &Value) -> Vec<u64> {
    let samples = &document["findings"][0]["samples"][0]["launches"];
    let launches = samples.as_array().expect("several launches").iter();
    launches.map(|n| n.as_u64().expect("a number")).collect()
}

#[test]
fn a_study_of_three_launches_has_three_values_of_each_time() {
    let sixfold = with_grid();
    let arguments = study(&[
        "--rounds",
        "2",
        "--launches",
        "3",
        "--json",
        "all.json",
        "--samples-csv",
        "all.csv",
    ]);
    let run = run_ok(&sixfold, &arguments);
    assert!(
        run.stdout
            .replace('\n', " ")
            .contains("means over 3 launches of medians; up to 6 rounds in total"),
        "{run:?}"
    );
    let all = document(&sixfold, "all.json");
    assert_eq!(launches_of_rows(&all), [3; 4]);
    assert_eq!(launches_of_samples(&all), [0, 0, 1, 1, 2, 2]);
    assert_eq!(
        all["findings"][0]["samples"][0]["rounds"],
        serde_json::json!([0, 1, 2, 3, 4, 5])
    );
    let settings = &all["runs"][0]["settings"];
    assert_eq!(
        (
            &settings["launches"],
            &settings["rounds"],
            &settings["seed"]
        ),
        (&3.into(), &2.into(), &1.into())
    );
    // The picture is that of the first process, which a launch does not draw.
    assert!(all["meshes"][0]["picture"].is_string());
    let csv = text(&sixfold, "all.csv");
    let last = csv.lines().last().expect("a sample");
    assert!(last.contains(",2,5,"), "launch and round: {last}");
    // The page and the paper show the launches.
    run_ok(&sixfold, &["report", "all.json", "--to", "page"]);
    let page = text(&sixfold, "page/report.md");
    assert!(page.contains("2 rounds each in 3 launches"), "{page}");
}

#[test]
fn a_pick_of_three_launches_ranks_by_their_times() {
    let sixfold = with_grid();
    sixfold.grid("other.obj", 9);
    let pick = |meshes: &[&str], more: &[&str]| {
        let options = [
            "--rounds",
            "2",
            "--workload",
            "smoothing",
            "--launches",
            "3",
        ];
        let arguments = [&["pick"], meshes, &options, more].concat();
        run_ok(&sixfold, &arguments)
    };
    let run = pick(&["grid.obj"], &["--json", "one.json"]);
    assert!(run.stdout.contains("For smoothing, "), "{run:?}");
    let one = document(&sixfold, "one.json");
    assert_eq!(one["findings"].as_array().map(Vec::len), Some(1));
    let finding = &one["findings"][0];
    let backends = counts(&finding["ranking"]).len();
    assert!(backends >= 6, "{finding}");
    assert_eq!(counts(&finding["ranking"]), vec![3; backends]);
    for row in finding["ranking"].as_array().expect("rows") {
        assert!(row["ns_ci_low"].is_f64() && row["build_launch_ns"].as_array().is_some());
        assert_eq!(row["samples"], 6);
        let parts = row["parts"].as_array().expect("parts");
        assert!(
            parts
                .iter()
                .all(|part| part["launch_ns"].as_array().map(Vec::len) == Some(3))
        );
    }
    assert_eq!(finding["control_ratios"].as_array().map(Vec::len), Some(3));
    assert!(!finding["break_even"].as_array().expect("rows").is_empty());
    assert_eq!(one["runs"][0]["settings"]["launches"], 3);
    assert!(one["meshes"][0]["picture"].is_string());
    // On several meshes, each has its launches.
    pick(&["grid.obj", "other.obj"], &["--json", "two.json"]);
    let two = document(&sixfold, "two.json");
    let by_mesh = two["findings"][0]["by_mesh"]
        .as_array()
        .expect("two meshes");
    assert_eq!(by_mesh.len(), 2);
    for of_mesh in by_mesh {
        assert_eq!(counts(&of_mesh["ranking"]), vec![3; backends]);
        assert!(of_mesh["operations"].as_f64() > Some(1.0));
    }
    // Launches of the same pick are pooled, those of another workload are not.
    pick(&["grid.obj"], &["--seed", "9", "--json", "again.json"]);
    run_ok(
        &sixfold,
        &[
            "merge",
            "--repeat",
            "one.json",
            "again.json",
            "--json",
            "all.json",
        ],
    );
    let all = document(&sixfold, "all.json");
    assert_eq!(counts(&all["findings"][0]["ranking"]), vec![6; backends]);
    assert_eq!(all["runs"][0]["settings"]["launches"], 6);
    let copy = [
        "merge", "--repeat", "one.json", "one.json", "--json", "no.json",
    ];
    let copy = sixfold.run(&copy);
    assert_eq!(copy.code, Some(2), "{copy:?}");
    assert!(copy.stderr.contains("same samples"), "{copy:?}");
}

#[test]
fn the_results_on_standard_output_are_those_of_all_launches() {
    let sixfold = with_grid();
    let run = run_ok(
        &sixfold,
        &study(&["--rounds", "1", "--launches", "2", "--json", "-"]),
    );
    let all: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(launches_of_rows(&all), [2; 4]);
}

#[test]
fn each_mesh_of_a_folder_and_of_a_report_has_its_launches() {
    let sixfold = with_grid();
    sixfold.grid("other.obj", 9);
    let arguments = [
        "--rounds",
        "1",
        "--launches",
        "2",
        "--report",
        "all",
        "--backends",
        "face-vertex,half-edge",
    ];
    let meshes = [
        "study",
        "grid.obj",
        "other.obj",
        "--operations",
        "build,circulate",
    ];
    run_ok(&sixfold, &[&meshes[..], &arguments].concat());
    let all = document(&sixfold, "all/results.json");
    let names = all["meshes"]
        .as_array()
        .expect("meshes")
        .iter()
        .map(|mesh| &mesh["name"]);
    assert_eq!(names.collect::<Vec<_>>(), ["grid.obj", "other.obj"]);
    for finding in all["findings"].as_array().expect("studies") {
        assert_eq!(
            finding["results"][0]["launch_ns"].as_array().map(Vec::len),
            Some(2)
        );
    }
}

#[test]
fn studies_that_repeat_one_measurement_are_pooled() {
    let sixfold = with_grid();
    run_ok(&sixfold, &study(&["--rounds", "2", "--json", "a.json"]));
    run_ok(
        &sixfold,
        &study(&[
            "--rounds",
            "2",
            "--seed",
            "7",
            "--launches",
            "2",
            "--json",
            "b.json",
        ]),
    );
    run_ok(
        &sixfold,
        &[
            "merge", "--repeat", "a.json", "b.json", "--json", "all.json",
        ],
    );
    let all = document(&sixfold, "all.json");
    assert_eq!(launches_of_rows(&all), [3; 4]);
    assert_eq!(launches_of_samples(&all), [0, 0, 1, 1, 2, 2]);
    assert_eq!(all["runs"][0]["settings"]["launches"], 3);

    let refused = |arguments: &[&str], why: &str| {
        let run = sixfold.run(arguments);
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.contains(why), "{run:?}");
    };
    refused(
        &["merge", "a.json", "b.json", "--json", "-"],
        "the settings differ",
    );
    let copy = "a.json: this file and an earlier one have the same samples of grid.obj";
    refused(
        &[
            "merge", "--repeat", "b.json", "a.json", "a.json", "--json", "-",
        ],
        copy,
    );
    run_ok(
        &sixfold,
        &[
            "study",
            "grid.obj",
            "--operations",
            "build",
            "--rounds",
            "1",
            "--json",
            "c.json",
        ],
    );
    refused(
        &["merge", "--repeat", "a.json", "c.json", "--json", "-"],
        "c.json: the settings differ: --backends",
    );
    sixfold.grid("grid.obj", 5);
    run_ok(&sixfold, &study(&["--rounds", "2", "--json", "d.json"]));
    refused(
        &["merge", "--repeat", "a.json", "d.json", "--json", "-"],
        "of different meshes",
    );
}

/// The first process has the whole message and the reasons, which a launch only prints.
#[test]
fn a_mesh_that_no_backend_holds_has_its_reasons() {
    let sixfold = Sixfold::new();
    let faces = "f 1 2 3\nf 2 1 4\nf 1 2 5\n";
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\n";
    sixfold.file("book.obj", &format!("{points}{faces}"));
    let study = |launches: &str| {
        let backends = [
            "study",
            "book.obj",
            "--backends",
            "half-edge,corner-table",
            "--rounds",
            "1",
        ];
        let run = sixfold.run(
            &[
                &backends[..],
                &["--json", "out.json", "--launches", launches],
            ]
            .concat(),
        );
        assert_eq!(run.code, Some(3), "{run:?}");
        (
            run.stderr,
            document(&sixfold, "out.json")["findings"][0]["backends"].to_string(),
        )
    };
    assert_eq!(study("1"), study("2"));
}

/// An external program can be a command of this kind itself.
#[test]
fn external_programs_are_no_launches() {
    let sixfold = with_grid();
    let script =
        "import os, sys; sys.exit('a launch' if 'SIXFOLD_LAUNCH' in os.environ else 'no launch')";
    sixfold.file("program.py", script);
    let external = "other=python3 program.py {mesh}";
    let run = sixfold.run(&study(&[
        "--rounds",
        "1",
        "--launches",
        "2",
        "--external",
        external,
    ]));
    assert!(run.stdout.contains("no launch"), "{run:?}");
    assert!(!run.stdout.contains("a launch"), "{run:?}");
}

#[test]
fn numbers_of_launches_that_are_not_possible_are_refused() {
    let sixfold = with_grid();
    let refused = |arguments: &[&str], why: &str| {
        let run = sixfold.run(&study(arguments));
        assert_eq!(run.code, Some(2), "{run:?}");
        assert!(run.stderr.replace('\n', " ").contains(why), "{run:?}");
    };
    for number in ["0", "-1", "many"] {
        refused(
            &["--launches", number],
            "write a whole number of launches, at least 1",
        );
    }
    refused(
        &["--launches", "5", "--budget", "2s"],
        "a budget of 2 s holds at most 4 launches on this mesh",
    );
}

#[cfg(unix)]
#[test]
fn a_mesh_that_can_be_read_once_is_measured_in_one_launch() {
    let sixfold = with_grid();
    let piped = |more: &str| {
        let binary = env!("CARGO_BIN_EXE_sixfold");
        let script = format!(
            "rm -f pipe.obj; mkfifo pipe.obj; cat grid.obj > pipe.obj & {binary} study pipe.obj --operations build --rounds 1 {more}"
        );
        let mut command = std::process::Command::new("sh");
        command.args(["-c", &script]).current_dir(sixfold.folder());
        Run::from_output(command.output().expect("sh runs"))
    };
    let run = piped("");
    assert_eq!(run.code, Some(0), "{run:?}");
    let run = piped("--launches 2");
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.stderr.contains("so it cannot be read 2 times"),
        "{run:?}"
    );
}

/// Starts a study of three launches, and calls `at_second` with the process when the second one has begun. Returns
/// its end.
#[cfg(target_os = "linux")]
fn disturbed(sixfold: &Sixfold, options: &[&str], at_second: impl FnOnce(&Child)) -> Run {
    let three = ["--rounds", "400", "--launches", "3", "--json", "all.json"];
    let mut child = sixfold.start(&study(&[&three[..], options].concat()));
    let mut errors = BufReader::new(child.stderr.take().expect("piped"));
    let mut line = String::new();
    while !line.contains("launch 2 of 3: measuring") {
        line.clear();
        assert!(
            errors.read_line(&mut line).expect("UTF-8") > 0,
            "it ended early"
        );
    }
    at_second(&child);
    let mut rest = String::new();
    errors.read_to_string(&mut rest).expect("UTF-8");
    let lines = rest.lines().filter(|line| !line.starts_with("progress: "));
    let stderr = lines.collect::<Vec<_>>().join(" ");
    let output = child.wait_with_output().expect("it ends");
    Run {
        stderr,
        ..Run::from_output(output)
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_launch_that_is_killed_is_named_and_left_out() {
    let missing = "a launch is missing, for the reason in the note above";
    let ends = [
        (&[][..], 1, format!("error: {missing}: measure again.")),
        (&["--keep-going"], 0, format!("note: {missing}")),
    ];
    for (options, code, last) in ends {
        let sixfold = with_grid();
        let run = disturbed(&sixfold, options, |child| {
            let id = child.id();
            let launches =
                fs::read_to_string(format!("/proc/{id}/task/{id}/children")).expect("its launch");
            let killed = std::process::Command::new("kill")
                .arg("-9")
                .args(launches.split_whitespace())
                .status();
            assert!(killed.expect("kill runs").success());
        });
        assert_eq!(run.code, Some(code), "{run:?}");
        let left_out = "launch 2 of 3 is left out";
        let why = format!("{left_out}: it ended with signal: 9");
        assert!(run.stderr.contains(&why), "{run:?}");
        assert!(run.stderr.contains(&last), "{run:?}");
        let all = document(&sixfold, "all.json");
        assert_eq!(launches_of_rows(&all), [2; 4]);
        assert!(all["notices"].to_string().contains(left_out));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_interruption_keeps_what_the_launches_have_measured() {
    let sixfold = with_grid();
    // Only the first process gets the signal; it tells the launch.
    let run = disturbed(&sixfold, &[], |child| crate::run::send("INT", child));
    assert_eq!(run.code, Some(4), "{run:?}");
    let all = document(&sixfold, "all.json");
    assert_eq!(all["findings"][0]["interrupted"], true);
    assert!(
        launches_of_rows(&all)
            .iter()
            .all(|&launches| (1..=2).contains(&launches)),
        "{all}"
    );
}

/// A launch does not outlive the process that started it.
#[cfg(target_os = "linux")]
#[test]
fn a_launch_ends_with_its_command() {
    let sixfold = with_grid();
    let mut launches = String::new();
    disturbed(&sixfold, &[], |child| {
        let id = child.id();
        launches =
            fs::read_to_string(format!("/proc/{id}/task/{id}/children")).expect("its launch");
        crate::run::send("KILL", child);
    });
    for launch in launches.split_whitespace() {
        let state = || fs::read_to_string(format!("/proc/{launch}/stat")).unwrap_or_default();
        // A process that has ended keeps the state Z until its parent asks for its exit code.
        wait_for(|| (state().is_empty() || state().contains(") Z ")).then_some(()));
    }
}

#[test]
fn what_is_forced_is_run_whatever_it_takes() {
    let sixfold = Sixfold::new();
    // A search of the soup for each of 7,200 faces takes far longer than the budget.
    sixfold.grid("large.obj", 60);
    let study = |more: &[&'static str]| {
        let arguments = [
            "study",
            "large.obj",
            "--operations",
            "catmull_clark_gather",
            "--backends",
            "polygon-soup,half-edge",
            "--budget",
            "50ms",
            "--json",
            "study.json",
        ];
        run_ok(&sixfold, &[&arguments, more].concat());
        let study = document(&sixfold, "study.json");
        let rows = study["findings"][0]["results"]
            .as_array()
            .expect("rows")
            .clone();
        let row = rows.iter().find(|row| row["backend"] == "polygon-soup");
        row.is_some_and(|row| row["median_ns"].is_f64())
    };
    assert!(!study(&[]), "the budget holds");
    assert!(study(&["--force"]));
}

/// Returns the number of times of each row in the launches.
fn counts(rows: &Value) -> Vec<usize> {
    let rows = rows.as_array().expect("rows").iter();
    let launches = rows.map(|row| row["launch_ns"].as_array().expect("several launches"));
    launches.map(Vec::len).collect()
}

#[test]
fn orders_growth_and_neighbours_are_measured_in_launches() {
    let sixfold = with_grid();
    let measure = |command: &[&'static str], name: &'static str| {
        let options = [
            "--operations",
            "vertex_faces",
            "--backends",
            "half-edge,face-vertex",
        ];
        let effort = ["--rounds", "2", "--launches", "3", "--json", name];
        let run = run_ok(&sixfold, &[command, &options, &effort].concat());
        let words = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("means over 3 launches"), "{words}");
        document(&sixfold, name)
    };
    let orders = measure(&["orders", "grid.obj"], "orders.json");
    let finding = &orders["findings"][0];
    assert_eq!(counts(&finding["results"]), vec![3; 8]);
    assert_eq!(finding["results"][0]["case"], "given");
    let [comparison] = &finding["comparisons"].as_array().expect("comparisons")[..] else {
        panic!("{finding}")
    };
    let effects = comparison["orders"].as_array().expect("effects");
    assert_eq!(effects.len(), 2);
    for effect in effects {
        let factor = &effect["worst_to_best"];
        assert!(
            factor["ci_low"].as_f64() <= factor["ratio"].as_f64(),
            "{effect}"
        );
    }
    assert!(comparison["structures"]["slowest_to_fastest"]["ci_high"].is_f64());
    assert_eq!(orders["runs"][0]["settings"]["launches"], 3);

    // All launches have the same meshes, also in random order.
    let sizes = [
        "growth", "--to", "4000", "--steps", "3", "--order", "shuffled",
    ];
    let growth = measure(&sizes, "growth.json");
    let finding = &growth["findings"][0];
    let sizes = finding["sizes"].as_array().expect("sizes");
    assert_eq!(sizes.len(), 3);
    for size in sizes {
        assert_eq!(counts(&size["results"]), vec![3; 2]);
        assert_eq!(
            size["control"]["operations"][0]["launches"]
                .as_array()
                .map(Vec::len),
            Some(3)
        );
    }
    let fits = finding["fits"].as_array().expect("fitted lines");
    assert!(
        fits.len() == 2 && fits[0]["all"]["exponent"].is_f64(),
        "{fits:?}"
    );
    let command = ["neighbours", "grid.obj", "--indices", "grid,bvh"];
    let effort = ["--rounds", "2", "--launches", "3", "--json", "near.json"];
    run_ok(&sixfold, &[&command[..], &effort].concat());
    let neighbours = document(&sixfold, "near.json");
    let finding = &neighbours["findings"][0];
    assert_eq!(counts(&finding["results"]), vec![3; 14]);
    // The noise is that of all launches, and not that of the noisiest.
    for row in finding["control"]["operations"].as_array().expect("noise") {
        assert_eq!(row["launches"].as_array().map(Vec::len), Some(3));
    }
    // The page shows them.
    run_ok(
        &sixfold,
        &[
            "report",
            "orders.json",
            "growth.json",
            "near.json",
            "--to",
            "page",
        ],
    );
}

#[test]
fn times_of_queries_are_measured_in_launches_and_explained_anew() {
    let sixfold = with_grid();
    let why = |more: &[&'static str]| {
        let arguments = [
            "why",
            "grid.obj",
            "--relations",
            "vertex_faces,face_vertices",
        ];
        let backends = ["--backends", "half-edge,face-vertex"];
        run_ok(&sixfold, &[&arguments[..], &backends, more].concat())
    };
    let run = why(&["--rounds", "2", "--launches", "3", "--json", "why.json"]);
    let words = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("over 3 launches"), "{words}");
    why(&["--counts-only", "--json", "counts.json"]);
    let document = |name| document(&sixfold, name);
    let (timed, counted) = (document("why.json"), document("counts.json"));
    assert_eq!(timed["runs"][0]["settings"]["launches"], 3);
    assert_eq!(counted["runs"][0]["settings"]["launches"], Value::Null);
    let [finding, counts] = [&timed, &counted].map(|document| &document["findings"][0]);
    assert_eq!(launches_of_samples(&timed), [0, 0, 1, 1, 2, 2]);
    assert_eq!(
        finding["control"]["operations"][0]["launches"]
            .as_array()
            .map(Vec::len),
        Some(3)
    );
    let rows = finding["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    for (row, counts) in rows.iter().zip(counts["rows"].as_array().expect("rows")) {
        let times = &row["timed"];
        assert_eq!(
            times["launch_ns"].as_array().map(Vec::len),
            Some(3),
            "{row}"
        );
        let number = |name: &str| times[name].as_f64().expect("a number");
        let ns = number("ns_per_element");
        assert!(
            number("ci_low_ns") <= ns && ns <= number("ci_high_ns"),
            "{row}"
        );
        let memory = finding["memory"].as_array().expect("speeds");
        assert!(memory.contains(&times["speed"]), "{row}");
        let moved = row["moved_bytes"].as_f64().expect("a number");
        let speed = times["speed"]["gb_per_s"].as_f64().expect("a number");
        assert!(
            (number("floor_ns") - moved / speed).abs() <= 1e-9 * moved,
            "{row}"
        );
        let mut untimed = row.clone();
        untimed["timed"] = Value::Null;
        assert_eq!(&untimed, counts, "the counts are those of one launch");
    }
    // The document repeats that of one launch.
    why(&["--rounds", "2", "--json", "one.json"]);
    let all = [
        "merge", "--repeat", "why.json", "one.json", "--json", "all.json",
    ];
    run_ok(&sixfold, &all);
    let all = document("all.json");
    let rows = all["findings"][0]["rows"].as_array().expect("rows");
    let launches = rows
        .iter()
        .map(|row| row["timed"]["launch_ns"].as_array().map(Vec::len));
    assert!(launches.eq([Some(4); 4]), "{rows:?}");
    run_ok(&sixfold, &["report", "all.json", "--to", "page"]);
    let refused = ["why", "grid.obj", "--counts-only", "--launches", "2"];
    let run = sixfold.run(&refused);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stderr.contains("--launches"), "{run:?}");
}

/// The arguments of a report on few operations, with `options`.
fn report_on_few<'a>(options: &[&'a str]) -> Vec<&'a str> {
    let few = [
        "study",
        "grid.obj",
        "--operations",
        "vertex_faces",
        "--backends",
        "face-vertex,half-edge",
        "--report",
        "out",
    ];
    [&few[..], options].concat()
}

#[test]
fn each_lab_of_a_report_has_its_launches() {
    let sixfold = with_grid();
    let labs = ["--rounds", "1", "--launches", "2", "--labs", "orders,why"];
    let arguments = report_on_few(&labs);
    run_ok(&sixfold, &arguments);
    let all = document(&sixfold, "out/results.json");
    let [study, orders, why] = &all["findings"].as_array().expect("findings")[..] else {
        panic!("{all}")
    };
    assert_eq!(counts(&study["results"]), [2; 2]);
    assert_eq!(counts(&orders["results"]), [2; 8]);
    assert_eq!(
        (&orders["kind"], &why["kind"]),
        (&"orders".into(), &"why".into())
    );
    let times = why["rows"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| row["timed"].clone());
    assert_eq!(counts(&times.collect::<Vec<_>>().into()), [2; 2]);
    for run in all["runs"].as_array().expect("runs") {
        assert_eq!(run["settings"]["launches"], 2, "{run}");
        assert_eq!(run["settings"]["seed"], 1, "{run}");
    }
    // The mesh has the picture that the first process drew.
    assert_eq!(all["meshes"].as_array().map(Vec::len), Some(1));
    assert!(all["meshes"][0]["picture"].is_string());
    let files = fs::read_dir(sixfold.folder()).expect("the folder").count();
    assert_eq!(files, 2, "launches write no files");
    // Finished studies are not measured again.
    run_ok(&sixfold, &[&arguments[..], &["--resume"]].concat());
    assert_eq!(
        document(&sixfold, "out/results.json")["findings"],
        all["findings"]
    );
}

/// The meshes of growth are larger than that of the study.
#[test]
fn a_lab_has_as_many_launches_as_its_budget_holds() {
    let sixfold = with_grid();
    let labs = ["--budget", "2s", "--launches", "2", "--labs", "growth"];
    let run = run_ok(&sixfold, &report_on_few(&labs));
    let note = "note: growth does not have 2 launches: a budget of 1 s holds at most 1 launch";
    assert!(run.stderr.contains(note), "{run:?}");
    let all = document(&sixfold, "out/results.json");
    let [study, growth] = &all["findings"].as_array().expect("findings")[..] else {
        panic!("{all}")
    };
    assert_eq!(counts(&study["results"]), [2; 2]);
    assert!(
        growth["sizes"][0]["results"][0].get("launch_ns").is_none(),
        "{growth}"
    );
}

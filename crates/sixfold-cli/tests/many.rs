//! Tests of studies of many meshes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::bad_input::assert_refused;
use crate::json_csv::completed;
use crate::run::{Run, Sixfold, TETRAHEDRON, run_ok, text};

const QUICK_ARGUMENTS: [&str; 4] = ["--rounds", "2", "--operations", "boundary,edge_length"];

/// Writes three valid meshes, one of them in a subfolder, and a broken mesh.
fn scans() -> Sixfold {
    let sixfold = Sixfold::new();
    fs::create_dir_all(sixfold.folder().join("scans/deep")).expect("a folder");
    sixfold.grid("scans/b grid.obj", 8);
    sixfold.file("scans/a.OBJ", TETRAHEDRON);
    sixfold.file("scans/deep/c.obj", TETRAHEDRON);
    sixfold.file("scans/broken.obj", "v 0 0 0\nf 1 2 3\n");
    sixfold.file("scans/notes.txt", "no mesh");
    sixfold.file("scans/._a.obj", "what another system left behind");
    sixfold
}

/// Studies the meshes that can be read.
fn study(sixfold: &Sixfold, more: &[&str]) -> Run {
    let mut arguments = vec!["study", "scans", "--keep-going"];
    arguments.extend(QUICK_ARGUMENTS);
    arguments.extend(more);
    sixfold.run(&arguments)
}

fn results(sixfold: &Sixfold, folder: &str) -> Value {
    serde_json::from_str(&text(sixfold, &format!("{folder}/results.json"))).expect("JSON")
}

/// Returns the studies of a document, each with its mesh.
fn studies(results: &Value) -> Value {
    let findings = results["findings"].as_array().expect("a list").iter();
    let studies = findings.filter(|finding| finding["kind"] == "study");
    studies.map(|study| completed(results, study)).collect()
}

/// Returns the mesh names in a list of names, studies or failures.
fn names(list: &Value) -> Vec<String> {
    let name = |entry: &Value| {
        let places = [entry, &entry["mesh"], &entry["mesh"]["name"]];
        let name = places.into_iter().find_map(Value::as_str);
        name.expect("a name").to_owned()
    };
    list.as_array().expect("a list").iter().map(name).collect()
}

fn study_files(sixfold: &Sixfold, folder: &str) -> Vec<PathBuf> {
    let folder = sixfold.folder().join(folder).join("studies");
    let entries = fs::read_dir(folder).expect("the folder");
    let mut study_files: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
    study_files.sort();
    study_files
}

#[test]
fn all_meshes_of_a_folder_are_studied_and_failures_are_listed() {
    let sixfold = scans();
    let arguments = [
        &["study", "scans", "--report", "out", "--json", "-"],
        &QUICK_ARGUMENTS[..],
    ];
    let run = sixfold.run(&arguments.concat());
    assert_eq!(run.code, Some(1), "{run:?}");
    let last = "error: not measured: scans/broken.obj: repair the files, for the reasons in the notes above, or leave \
                them out. The other results are complete; with --keep-going, this is no error\n";
    assert!(run.stderr.ends_with(last), "{}", run.stderr);
    let report = results(&sixfold, "out");
    let piped: Value = serde_json::from_str(&run.stdout).expect("JSON alone");
    assert_eq!(report, piped);
    let all = [
        "scans/a.OBJ",
        "scans/b grid.obj",
        "scans/broken.obj",
        "scans/deep/c.obj",
    ];
    assert_eq!(names(&report["planned"]), all);
    assert_eq!(names(&studies(&report)), [all[0], all[1], all[3]]);
    assert_eq!(names(&report["failures"]), [all[2]]);
    let reason = report["failures"][0]["reason"].as_str().expect("a reason");
    assert!(reason.contains("line 2"), "{reason}");
    assert_eq!(report["missing"], 0);
    assert!(run.stderr.contains("broken.obj"), "{}", run.stderr);
    let pooled = report["pool"]["groups"][0]["pooled"]
        .as_array()
        .expect("rows");
    assert_eq!(pooled.len(), 12);
    for row in pooled {
        assert_eq!(row["meshes"], 3, "{row}");
        assert!(row["ratio_to_best"].as_f64() > Some(0.99), "{row}");
        // Three meshes are too few for an interval.
        assert!(row["ci_low"].is_null() && row["ci_high"].is_null(), "{row}");
    }
    // Each sample has one line. The samples of the control are left out.
    let studies = studies(&report);
    let studies = studies.as_array().expect("studies");
    let samples = studies
        .iter()
        .flat_map(|s| s["samples"].as_array().expect("samples"))
        .filter(|samples| samples["control"] == false);
    let samples: usize = samples
        .map(|samples| samples["rounds"].as_array().map_or(0, Vec::len))
        .sum();
    let csv = text(&sixfold, "out/samples.csv");
    assert_eq!(csv.lines().count(), samples + 1);
    assert!(
        csv.contains("scans/b grid.obj,study,,boundary,half-edge,"),
        "{csv:.400}"
    );
    let csv = text(&sixfold, "out/results.csv");
    assert_eq!(csv.lines().count(), 3 * 12 + 1);
    assert_eq!(study_files(&sixfold, "out").len(), 3);

    let shown = study(&sixfold, &[]);
    assert_eq!(shown.code, Some(0), "{shown:?}");
    let last = "note: not measured: scans/broken.obj\n";
    assert!(shown.stderr.ends_with(last), "{}", shown.stderr);
    for part in [
        "3 meshes of 4 studied",
        "1 of 4: scans/a.OBJ",
        "× the best",
        "half\nedge",
    ] {
        let part = part.split('\n').next().expect("a part");
        assert!(shown.stdout.contains(part), "{part}: {}", shown.stdout);
    }
}

#[cfg(unix)]
#[test]
fn a_name_that_is_not_utf8_is_one_mesh() {
    use std::os::unix::ffi::OsStrExt as _;
    let sixfold = Sixfold::new();
    let name = std::ffi::OsStr::from_bytes(b"b\xff.obj");
    fs::create_dir(sixfold.folder().join("scans")).expect("a folder");
    if fs::write(sixfold.folder().join("scans").join(name), TETRAHEDRON).is_err() {
        return; // a file system that has only names in UTF-8
    }
    let first = study(&sixfold, &["--report", "out"]);
    assert_eq!(first.code, Some(0), "{first:?}");
    let before = results(&sixfold, "out");
    assert_eq!(names(&studies(&before)), ["scans/b\\xFF.obj"]);
    let again = study(&sixfold, &["--report", "out", "--resume"]);
    assert_eq!(again.code, Some(0), "{again:?}");
    assert!(!again.stderr.contains("xFF.obj, 4 faces"), "{again:?}");
    assert_eq!(results(&sixfold, "out"), before);
}

#[test]
fn finished_studies_are_not_repeated() {
    let sixfold = scans();
    assert_eq!(study(&sixfold, &["--report", "out"]).code, Some(0));
    let before = text(&sixfold, "out/results.json");
    assert_refused(
        &sixfold,
        &["study", "scans", "--report", "out"],
        2,
        "continue with --resume",
    );
    let again = study(&sixfold, &["--report", "out", "--resume"]);
    assert_eq!(again.code, Some(0), "{again:?}");
    assert_eq!(text(&sixfold, "out/results.json"), before);

    // One file is deleted, one file is truncated, and the mesh of one file is changed.
    let paths = study_files(&sixfold, "out");
    let name = |path: &Path| {
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
    };
    let second = name(&paths[1]).expect("a name");
    assert!(second.starts_with("b_grid-"), "{second}");
    fs::remove_file(&paths[0]).expect("removed");
    let whole = fs::read(&paths[1]).expect("a piece");
    fs::write(&paths[1], &whole[..whole.len() / 2]).expect("cut off");
    sixfold.grid("scans/deep/c.obj", 5);
    let rest = study(&sixfold, &["--report", "out", "--resume"]);
    assert_eq!(rest.code, Some(0), "{rest:?}");
    assert!(
        rest.stderr.contains("not a study of this program"),
        "{}",
        rest.stderr
    );
    assert!(
        rest.stderr
            .contains("the file has changed since it was studied"),
        "{}",
        rest.stderr
    );
    assert!(
        rest.stdout.contains("4 of 4: scans/deep/c.obj, 32 faces"),
        "{}",
        rest.stdout
    );
    let report = results(&sixfold, "out");
    assert_eq!(names(&studies(&report)).len(), 3);
    assert_eq!(studies(&report)[2]["mesh"]["faces"], 32);
    let other = [
        "study", "scans", "--report", "out", "--resume", "--seed", "7",
    ];
    assert_refused(
        &sixfold,
        &other,
        2,
        "other settings (--operations was boundary,edge_length, and is the default now)",
    );
}

#[test]
fn notices_of_finished_studies_stay() {
    let sixfold = scans();
    sixfold.file("scans/textured.obj", &format!("vt 0 0\n{TETRAHEDRON}"));
    let ignored = "note: scans/textured.obj: ignored 1 texture coordinate (line 1)";
    for _ in 0..2 {
        let run = study(&sixfold, &["--report", "out", "--resume"]);
        assert_eq!(run.code, Some(0), "{run:?}");
        let found = results(&sixfold, "out")["notices"].clone();
        let lines = found.as_array().expect("a list");
        assert_eq!(
            lines.iter().filter(|line| **line == ignored).count(),
            1,
            "{found}"
        );
    }
    // Another reading of the files makes other meshes.
    let other = [
        "study",
        "scans",
        "--report",
        "out",
        "--resume",
        "--recentre",
    ];
    assert_refused(&sixfold, &other, 2, "other settings");
}

#[test]
fn merged_shards_equal_a_single_run() {
    let sixfold = scans();
    for shard in ["1/2", "2/2"] {
        let folder = format!("shard-{}", &shard[..1]);
        let run = study(&sixfold, &["--shard", shard, "--report", &folder]);
        assert_eq!(run.code, Some(0), "{run:?}");
        let report = results(&sixfold, &folder);
        assert_eq!(report["missing"], 2, "{shard}");
    }
    let alone = run_ok(&sixfold, &["merge", "shard-1", "--json", "half.json"]);
    assert!(
        alone.stdout.contains("2 meshes are not studied yet"),
        "{}",
        alone.stdout
    );
    run_ok(
        &sixfold,
        &[
            "merge",
            "shard-1",
            "shard-2/results.json",
            "--report",
            "all",
        ],
    );
    assert_eq!(study(&sixfold, &["--report", "one"]).code, Some(0));
    let [merged, single] = ["all", "one"].map(|folder| results(&sixfold, folder));
    let form = |value: &Value| -> Vec<String> {
        value
            .as_object()
            .expect("an object")
            .keys()
            .cloned()
            .collect()
    };
    assert_eq!(form(&merged), form(&single));
    for list in ["planned", "failures", "missing", "meshes"] {
        assert_eq!(merged[list], single[list], "{list}");
    }
    assert_eq!(names(&studies(&merged)), names(&studies(&single)));
    let keys = |report: &Value| -> Vec<(Value, Value)> {
        let rows = report["pool"]["groups"][0]["pooled"]
            .as_array()
            .expect("rows")
            .iter();
        rows.map(|row| (row["backend"].clone(), row["operation"].clone()))
            .collect()
    };
    assert_eq!(keys(&merged), keys(&single));
}

#[test]
fn shards_that_do_not_belong_together_are_not_merged() {
    let sixfold = scans();
    assert_eq!(study(&sixfold, &["--report", "one"]).code, Some(0));
    let mut other: Value = results(&sixfold, "one");
    other["runs"][0]["settings"]["budget_s"] = 60.into();
    other["runs"][0]["settings"]["rounds"] = Value::Null;
    sixfold.file("slow.json", &other.to_string());
    let mut other: Value = results(&sixfold, "one");
    other["meshes"][0]["sha256"] = "another".into();
    sixfold.file("elsewhere.json", &other.to_string());
    let whole = text(&sixfold, "one/results.json");
    sixfold.file("half.json", &whole[..whole.len() / 2]);
    sixfold.file("foreign.json", "{}");
    sixfold.file("later.json", "{\"schema\": 9}");
    for (shard, message) in [
        ("slow.json", "--budget is 60 s"),
        (
            "elsewhere.json",
            "both have a study of scans/a.OBJ, but of different meshes",
        ),
        ("half.json", "ends too early"),
        ("foreign.json", "no `schema`"),
        ("later.json", "schema 9"),
        ("none", "cannot be read"),
        ("scans", "cannot be read"),
    ] {
        assert_refused(
            &sixfold,
            &["merge", "one", shard, "--json", "-"],
            2,
            message,
        );
    }
    assert_refused(&sixfold, &["merge", "one"], 2, "--report DIR");
    let over = ["merge", "one", "slow.json", "--json", "slow.json"];
    assert_refused(&sixfold, &over, 2, "would overwrite");
}

#[test]
fn invalid_places_are_refused_before_anything_is_measured() {
    let sixfold = scans();
    fs::create_dir(sixfold.folder().join("empty")).expect("a folder");
    for (arguments, message) in [
        (&["study", "empty"][..], "no mesh file"),
        (
            &["study", "scans", "--report", "scans/a.OBJ/x"],
            "cannot be written",
        ),
        (
            &["study", "scans", "--shard", "3/2", "--report", "x"],
            "from 1/n to n/n",
        ),
        (&["study", "scans", "--shard", "1/2"], "--report"),
        (&["study", "scans", "--resume"], "--report"),
    ] {
        assert_refused(&sixfold, arguments, 2, message);
    }
    sixfold.file("only.obj", "v 0 0 0\n");
    let run = sixfold.run(&["study", "only.obj", "none.obj", "--rounds", "2"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.stderr.contains("none of the meshes could be studied"),
        "{run:?}"
    );
    let run = sixfold.run(&["study", "none.obj", "only.obj", "--report", "nothing"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(!sixfold.folder().join("nothing").exists(), "no report");
}

#[test]
fn places_without_meshes_do_not_stop_the_others() {
    let sixfold = scans();
    fs::create_dir(sixfold.folder().join("empty")).expect("a folder");
    fs::create_dir(sixfold.folder().join("prints")).expect("a folder");
    sixfold.file("prints/part.FBX", "text");
    sixfold.file("scans/b.x3d", "text");
    let rounds = ["--rounds", "2", "--operations", "boundary", "--keep-going"];
    let places = ["study", "empty", "prints", "scans/a.OBJ"];
    let run = sixfold.run(&[&places[..], &rounds].concat());
    assert_eq!(run.code, Some(0), "{run:?}");
    for message in [
        "empty: not studied: no mesh file in this directory or its subdirectories\n",
        "prints: not studied: no mesh file in this directory or its subdirectories, but 1 .fbx; convert .fbx to",
    ] {
        assert!(run.stderr.contains(message), "{message}: {run:?}");
    }
    let run = sixfold.run(&[&["study", "scans"][..], &rounds].concat());
    assert!(
        run.stderr
            .contains("note: scans: other files are left out: 1 .txt, 1 .x3d, 1 hidden; convert"),
        "{run:?}"
    );
}

#[test]
fn meshes_that_no_selected_backend_can_hold_have_their_own_exit_code() {
    let sixfold = Sixfold::new();
    let book = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    sixfold.file("a.obj", book);
    sixfold.file("b.obj", book);
    let mut arguments = vec!["study", "a.obj", "b.obj", "--report", "out"];
    arguments.extend(["--backends", "half-edge"]);
    for _ in 0..2 {
        let run = sixfold.run(&arguments);
        assert_eq!(run.code, Some(3), "{run:?}");
        assert!(run.stderr.contains("all meshes failed"), "{run:?}");
        let failures = &results(&sixfold, "out")["failures"];
        assert_eq!(failures[1]["kind"], "none_holds", "{failures}");
        arguments.push("--resume");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_does_not_suppress_the_text() {
    let sixfold = scans();
    let run = study(&sixfold, &["--json", "/dev/full"]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(run.stderr.contains("cannot be written"), "{}", run.stderr);
    assert!(
        run.stdout.contains("3 meshes of 4 studied"),
        "{}",
        run.stdout
    );
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_can_be_resumed() {
    let sixfold = scans();
    // 500 rounds on each mesh are more steps than the pipe to this test holds, so the study cannot
    // end before the signal.
    let arguments = [
        "study",
        "scans",
        "--rounds",
        "500",
        "--operations",
        "face_vertices",
        "--report",
        "out",
        "--keep-going",
    ];
    let run = sixfold.run_interrupted(&arguments, "INT", "2 of 4");
    assert!(run.stdout.contains("not studied yet"), "{run:?}");
    let kept = results(&sixfold, "out");
    // The interrupted study is in the results, but it is studied again.
    let kept_studies = studies(&kept);
    let kept_studies = kept_studies.as_array().expect("a list").iter();
    let finished = kept_studies.filter(|study| study["interrupted"] == false);
    let finished = finished.count();
    assert!((1..3).contains(&finished), "{finished}");
    assert_eq!(study_files(&sixfold, "out").len(), finished);
    let mut go_on = arguments.to_vec();
    go_on.push("--resume");
    run_ok(&sixfold, &go_on);
    let whole = results(&sixfold, "out");
    assert_eq!(names(&studies(&whole)).len(), 3);
    let first = |results: &Value| studies(results)[0]["results"].clone();
    assert_eq!(first(&whole), first(&kept));
}

/// Runs the documented script as Slurm does, once per job of the array.
#[cfg(unix)]
#[test]
fn the_script_for_a_cluster_studies_all_meshes() {
    let sixfold = scans();
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let script = here.join("../../reports/cluster/study.sbatch");
    let program = Path::new(env!("CARGO_BIN_EXE_sixfold"));
    let path = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{path}", program.parent().expect("a folder").display());
    for job in 1..=3 {
        let mut command = Command::new("bash");
        command.arg(&script).current_dir(sixfold.folder());
        command
            .env("PATH", &path)
            .env("MESHES", "scans")
            .env("RESULTS", "results");
        command.env("SLURM_ARRAY_TASK_ID", job.to_string());
        command
            .env("SLURM_ARRAY_TASK_COUNT", "3")
            .env("BUDGET", "100ms");
        let output = command.output().expect("bash runs");
        assert!(output.status.success(), "{output:?}");
    }
    let shards = ["results/shard-1", "results/shard-2", "results/shard-3"];
    let mut merge = vec!["merge"];
    merge.extend(shards);
    merge.extend(["--report", "results/all"]);
    run_ok(&sixfold, &merge);
    let report = results(&sixfold, "results/all");
    assert_eq!(names(&studies(&report)).len(), 3);
    assert_eq!(report["missing"], 0);
}

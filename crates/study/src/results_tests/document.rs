use std::sync::atomic::AtomicBool;

use sixfold::shapes;

use sixfold_measure::Operation;
use sixfold_results::{
    Confidence, Failed, FailureKind, Finding, Policy, Report, Results, Samples, Standing,
};

use crate::engine::effort::Effort;
use crate::engine::simulated_machine::SimulatedMachine;
use crate::labs::growth::growth_on;
use crate::labs::orders::orders_on;
use crate::labs::pick::pick_on;
use crate::labs::study::study_on;
use crate::{Settings, StudyMesh};

/// A study in which the time of half-edge is `ratio` times the time of corner-table.
fn report(mesh: &str, ratio: f64) -> Report {
    let study_mesh = StudyMesh::new(mesh, shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Boundary],
        effort: Effort::of_rounds(2),
        ..Settings::default()
    };
    let stop = AtomicBool::new(false);
    let machine = SimulatedMachine::equal_costs();
    let report = study_on(&machine, &study_mesh, &settings, &stop, &mut |_| ());
    let mut report = report.expect("a study");
    // Other tests of this program may have changed the policy.
    report
        .run
        .environment
        .heap
        .as_mut()
        .expect("measured")
        .policy = Policy::Kept;
    report
        .results
        .retain(|row| row.backend == "half-edge" || row.backend == "corner-table");
    for row in &mut report.results {
        let best = row.backend == "corner-table";
        let ratio = if best { 1.0 } else { ratio };
        row.ratio_to_best = Some(ratio);
        row.median_ns = Some(1000.0 * ratio);
        row.standing = Some(if best {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    report
}

/// Gives each result three samples, and one result the samples of a control.
fn with_samples(mut report: Report) -> Report {
    let samples = |backend: &str, control: bool| Samples {
        case: String::new(),
        backend: backend.into(),
        operation: "boundary".into(),
        control,
        launches: Vec::new(),
        rounds: vec![0, 1, 2],
        cpu_ns: Some(vec![10.0, 20.0, 30.0]),
        wall_ns: vec![11.0, 21.0, 31.0],
        faults: None,
        slowdowns: vec![1.0, 1.1, 1.2],
        first_ns: Vec::new(),
    };
    let first = report
        .results
        .iter()
        .map(|row| samples(&row.backend, false));
    report.samples = first.chain([samples("half-edge", true)]).collect();
    report
}

fn failed(mesh: &str, reason: &str) -> Failed {
    Failed {
        mesh: mesh.into(),
        reason: reason.into(),
        kind: FailureKind::NotMeasured,
    }
}

fn names(list: &[&str]) -> Vec<String> {
    list.iter().map(|&name| name.to_owned()).collect()
}

fn written(results: &Results) -> String {
    let mut text = Vec::new();
    results.write_json(&mut text).expect("memory");
    String::from_utf8(text).expect("UTF-8")
}

fn study_names(results: &Results) -> Vec<&str> {
    results.studies().map(|s| s.mesh.name.as_str()).collect()
}

#[test]
fn studies_are_in_the_order_of_the_planned_meshes() {
    let mut all = Results::new(names(&["a", "b", "c", "d"]));
    all.add(report("c", 8.0).into());
    all.add(report("a", 2.0).into());
    all.add_failure(failed("d", "no faces"));
    assert_eq!(all.missing().collect::<Vec<_>>(), ["b"]);
    all.add(report("b", 4.0).into());
    assert_eq!(study_names(&all), ["a", "b", "c"]);
    assert_eq!(all.missing().count(), 0);
    // A new study replaces a study or a failure of the same mesh.
    all.add(report("b", 1.0).into());
    all.add(report("d", 1.0).into());
    assert_eq!(study_names(&all), ["a", "b", "c", "d"]);
    assert_eq!(all.failures, []);
}

#[test]
fn merged_shards_equal_one_whole_run() {
    let meshes = names(&["a", "b", "c"]);
    let mut whole = Results::new(meshes.clone());
    let studies = [report("a", 2.0), report("b", 3.0)];
    let [mut one, mut two] = [0, 1].map(|_| Results::new(meshes.clone()));
    for (study, shard) in studies.into_iter().zip([&mut one, &mut two]) {
        whole.add(study.clone().into());
        shard.add(study.into());
    }
    whole.add_failure(failed("c", "broken"));
    one.add_failure(failed("c", "broken"));
    let two = Results::read_json(&written(&two)).expect("as written");
    // Merging a second time changes nothing.
    one.merge(two.clone()).expect("the same settings");
    one.merge(two).expect("the same settings");
    assert_eq!(written(&one), written(&whole));
}

#[test]
fn documents_of_other_meshes_are_joined() {
    let mut one = Results::from(report("a", 2.0));
    let mut two = Results::from(report("b", 2.0));
    two.add_failure(failed("z", "broken"));
    one.merge(two).expect("the same settings");
    assert_eq!(one.planned, ["a", "b", "z"]);
    assert_eq!(study_names(&one), ["a", "b"]);
    assert_eq!(one.failures.len(), 1);
}

#[test]
fn studies_that_cannot_be_pooled_are_not_merged() {
    let one = report("a", 2.0);
    let mut slower = report("b", 2.0);
    (slower.run.settings.budget_s, slower.run.settings.rounds) = (Some(60.0), None);
    let mut again = one.clone();
    again.run.start.unix_time += 1;
    let mut other = one.clone();
    other.mesh.sha256 = "another".into();
    for (second, message) in [
        (slower, "is 60 s, expected 2 rounds"),
        (again, "both have a study of a: pool them with --repeat"),
        (other, "but of different meshes"),
    ] {
        let mut merged = Results::from(one.clone());
        let error = merged.merge(second.into()).expect_err(message).to_string();
        assert!(error.contains(message), "{error}");
        assert_eq!(study_names(&merged), ["a"], "unchanged");
    }
}

#[test]
fn written_documents_are_read_back_exactly() {
    let mut all = Results::from(report("a", 2.0));
    all.add(report("b", 2.0).into());
    let ball = StudyMesh::new("ball", shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Boundary],
        effort: Effort::of_rounds(3),
        ..Settings::default()
    };
    let stop = AtomicBool::new(false);
    let machine = SimulatedMachine::equal_costs();
    let orders = orders_on(&machine, &ball, &settings, &stop, &mut |_| ());
    all.add(orders.expect("all hold it").into());
    let growth = crate::GrowthSettings {
        study: settings,
        from: 100,
        to: 200,
        steps: 2,
        ..crate::GrowthSettings::default()
    };
    let growth = growth_on(&machine, &growth, &stop, &mut |_| ());
    all.add(growth.expect("all hold it").into());
    let why = crate::why(&ball, &crate::WhySettings::default(), &stop, &mut |_| ());
    all.add(why.expect("all hold it").into());
    let picked = crate::PickSettings {
        workload: crate::built_in("smoothing").expect("a built-in"),
        backends: Vec::new(),
        extra: Vec::new(),
        needs: vec![sixfold_results::Need::Edit],
        max_memory: None,
        effort: Effort::of_rounds(2),
        confidence: Confidence::default(),
        seed: 1,
        heap: Policy::Kept,
    };
    let pick = pick_on(&machine, &[ball], &picked, &stop, &mut |_, _| ());
    all.add(pick.expect("a ranking").into());

    let text = written(&all);
    let read = Results::read_json(&text).expect("as written");
    assert_eq!(written(&read), text);
    let kinds: Vec<&str> = read.findings.iter().map(Finding::kind).collect();
    assert_eq!(kinds, ["study", "study", "orders", "growth", "why", "pick"]);
    for (before, after) in all.findings.iter().zip(&read.findings) {
        assert_eq!(before.run(), after.run());
        assert_eq!(before.meshes(), after.meshes());
        assert_eq!(before.figures(), after.figures());
        assert!(before.is_interrupted() == after.is_interrupted());
    }
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    // Three equal icosahedra have three names. Growth has a mesh for each size. The settings of
    // orders and growth are equal.
    let sizes = all.growth().map(|growth| growth.sizes.len()).sum::<usize>();
    assert!(sizes > 0);
    assert_eq!(value["meshes"].as_array().map(Vec::len), Some(3 + sizes));
    let growth = &value["findings"][3];
    assert_eq!(growth["meshes"].as_array().map(Vec::len), Some(sizes));
    assert_eq!(value["runs"].as_array().map(Vec::len), Some(4));
    assert_eq!(value["findings"][2]["kind"], "orders");
}

#[test]
fn tables_have_a_row_for_each_time_and_each_sample() {
    let mut all = Results::from(with_samples(report("a, with a comma", 2.0)));
    all.add(with_samples(report("b", 2.0)).into());
    let table = |samples: bool| {
        let mut text = Vec::new();
        match samples {
            true => all.write_samples_csv(&mut text),
            false => all.write_csv(&mut text),
        }
        .expect("memory");
        let mut reader = csv::Reader::from_reader(&text[..]);
        let names = reader.headers().expect("a header").clone();
        let rows: Result<Vec<_>, _> = reader.records().collect();
        let rows = rows.expect("lines of one length").into_iter();
        let row = |row: csv::StringRecord| -> std::collections::BTreeMap<String, String> {
            let pairs = names.iter().zip(row.iter());
            pairs.map(|(a, b)| (a.into(), b.into())).collect()
        };
        rows.map(row).collect::<Vec<_>>()
    };
    let rows = table(false);
    assert_eq!(rows.len(), 4, "two backends on two meshes");
    let row = &rows[0];
    let [mesh, faces, closed, degree, unit] =
        ["mesh", "faces", "closed", "largest_face_degree", "per"].map(|name| row[name].as_str());
    assert_eq!(
        [mesh, faces, closed, degree, unit],
        ["a, with a comma", "20", "true", "3", "edge"]
    );
    assert_eq!((&*row["kind"], &*row["status"]), ("study", "measured"));
    assert_eq!((&*row["median_ns"], &*row["samples"]), ("2000.0", "2"));
    // Three samples of each of the four times; the samples of the control have no rows.
    let samples = table(true);
    assert_eq!(samples.len(), 3 * 4);
    let row = &samples[1];
    let fields = [
        "backend", "round", "cpu_ns", "wall_ns", "faults", "slowdown",
    ];
    assert_eq!(
        fields.map(|name| row[name].as_str()),
        ["half-edge", "1", "20.0", "21.0", "", "1.1"]
    );
    // Without findings, there is only the header.
    let mut empty = Vec::new();
    Results::default().write_csv(&mut empty).expect("memory");
    assert_eq!(String::from_utf8_lossy(&empty).lines().count(), 1);
}

#[test]
fn text_that_is_no_document_is_refused() {
    let text = written(&report("a", 2.0).into());
    let half = &text[..text.len() / 2];
    let no_mesh = text.replacen("\"meshes\": [0]", "\"meshes\": [7]", 1);
    let no_run = text.replacen("\"run\": 0", "\"run\": 3", 1);
    let two = text.replacen("\"meshes\": [0]", "\"meshes\": [0, 0]", 1);
    let kind = text.replacen("\"kind\": \"study\"", "\"kind\": \"guess\"", 1);
    for (given, expected) in [
        ("", "ends too early"),
        (half, "ends too early"),
        ("{\"schema\": 1.", "ends too early"),
        ("{\"schema\": -", "ends too early"),
        ("{\"schema\": tr", "ends too early"),
        ("no JSON", "is not JSON, line 1, column 2"),
        ("{}", "no `schema`"),
        ("{\"schema\": \"three\"}", "is not in the format"),
        ("[1]", "is not in the format"),
        ("{\"schema\": 99}", "schema 99"),
        (
            "{\"schema\": 3, \"results\": []}",
            "reads schema 4: measure again",
        ),
        ("{\"schema\": 4, \"rows\": []}", "has no findings"),
        ("{\"schema\": 4, \"findings\": []}", "missing field"),
        (&no_mesh, "entry 7 of `meshes`"),
        (&no_run, "entry 3 of `runs`"),
        (&two, "a finding of one mesh has 2 meshes"),
        (&kind, "a finding has the unknown kind `guess`"),
    ] {
        let error = Results::read_json(given).expect_err(expected).to_string();
        assert!(error.contains(expected), "{given:.40}: {error}");
    }
}

#[test]
fn impossible_values_are_refused() {
    let mut negative = report("a", 2.0);
    negative.results[0].median_ns = Some(-1.0);
    let mut short = with_samples(report("a", 2.0));
    short.samples[0].rounds.pop();
    for (study, expected) in [
        (negative, "invalid time or ratio"),
        (short, "columns of different lengths"),
    ] {
        let error = Results::read_json(&written(&study.into())).expect_err(expected);
        assert!(error.to_string().contains(expected), "{error}");
    }
}

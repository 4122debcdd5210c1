use crate::engine::effort::Effort;
use crate::engine::simulated_machine::SimulatedMachine;
use crate::labs::orders::orders_on;
use crate::labs::study::study_on;
use sixfold_results::{
    CacheState, Change, Changes, CompareError, CompareSettings, Measurement, Policy, Report,
    ResultRow, Results, Samples, Standing, Verdict, compare,
};
use std::sync::atomic::AtomicBool;

use sixfold::shapes;

use crate::{Operation, Settings, StudyMesh};

/// The times of the launches of a row, relative to its time. Their product is 1.
const LAUNCHES: [f64; 5] = [1.0, 1.01, 1.0 / 1.01, 1.005, 1.0 / 1.005];

/// Returns a study with known samples and launches: 1000 ns times `factor`.
fn report(factor: impl Fn(&str, Operation) -> f64) -> Report {
    let study_mesh = StudyMesh::new("ball", shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Boundary, Operation::EdgeLength, Operation::Build],
        effort: Effort::of_rounds(2),
        ..Settings::default()
    };
    let stop = AtomicBool::new(false);
    let machine = SimulatedMachine::equal_costs();
    let report = study_on(&machine, &study_mesh, &settings, &stop, &mut |_| ());
    let mut report = report.expect("a study");
    report.control = None;
    // Other tests of this program may have changed the policy.
    report
        .run
        .environment
        .heap
        .as_mut()
        .expect("measured")
        .policy = Policy::Kept;
    let samples = report.results.iter().map(|row| {
        let base = 1000.0 * factor(&row.backend, row.operation.parse().expect("an operation"));
        // Nine samples, from −2 % to +2 %.
        let known: Vec<f64> = (0..9)
            .map(|i| base * (1.0 + 0.005 * f64::from(i - 4)))
            .collect();
        Samples {
            case: String::new(),
            backend: row.backend.clone(),
            operation: row.operation.clone(),
            control: false,
            launches: Vec::new(),
            rounds: (0..9).collect(),
            cpu_ns: Some(known.clone()),
            wall_ns: known,
            faults: None,
            slowdowns: vec![1.0; 9],
            first_ns: Vec::new(),
        }
    });
    report.samples = samples.collect();
    for (number, row) in report.results.iter_mut().enumerate() {
        let ns = 1000.0 * factor(&row.backend, row.operation.parse().expect("an operation"));
        row.median_ns = Some(ns);
        // Rows are slow in different launches.
        let launches = (0..5).map(|launch| Some(ns * LAUNCHES[(launch + number) % 5]));
        row.launch_ns = launches.collect();
        let fastest = row.backend == "half-edge";
        row.standing = Some(if fastest {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    report
}

fn compared(
    before: &Report,
    after: &Report,
    settings: CompareSettings,
) -> Result<Changes, CompareError> {
    compare(&before.clone().into(), &after.clone().into(), settings)
}

/// Returns a study in one launch.
fn in_one_launch(report: &Report) -> Report {
    let mut report = report.clone();
    for row in &mut report.results {
        row.launch_ns.clear();
    }
    report
}

/// The samples say nothing about what differs from process to process: with launches, they do not decide.
#[test]
fn studies_are_compared_by_their_launches() {
    let with_launches = |factors: [f64; 3]| {
        let mut report = report(|_, _| 1.0);
        for row in &mut report.results {
            let factors = match &*row.backend {
                "half-edge" => factors,
                _ => [1.0, 1.01, 0.99],
            };
            let ns = row.median_ns.expect("measured");
            row.launch_ns = factors.map(|factor| Some(ns * factor)).into();
            row.median_ns = Some(ns * factors.iter().product::<f64>().cbrt());
        }
        report
    };
    let settings = CompareSettings::default();
    let verdicts = |after: [f64; 3]| {
        let changes = compared(
            &with_launches([1.0, 1.01, 0.99]),
            &with_launches(after),
            settings,
        );
        let rows = changes.expect("one memory state").rows;
        let [own, others]: [Vec<Change>; 2] = rows
            .into_iter()
            .partition(|row| row.measurement.backend == "half-edge")
            .into();
        assert!(others.iter().all(|row| !row.verdict.is_change()));
        let row = &own[0];
        assert!(
            (row.ratio - row.after_ns / row.before_ns).abs() < 1e-9,
            "{row:?}"
        );
        own.into_iter().map(|row| row.verdict).collect::<Vec<_>>()
    };
    assert_eq!(verdicts([5.0, 5.05, 4.95]), [Verdict::Slower; 3]);
    // One launch is as fast as before.
    assert_eq!(verdicts([1.0, 1.5, 2.25]), [Verdict::CannotTell; 3]);
}

#[test]
fn one_launch_cannot_tell_unless_a_time_doubles() {
    let before = in_one_launch(&report(|_, _| 1.0));
    let after = report(|backend, _| match backend {
        "half-edge" => 2.1,
        "corner-table" => 1.9,
        _ => 1.0,
    });
    for (a, b) in [(&before, &after), (&before, &in_one_launch(&after))] {
        let changes = compared(a, b, CompareSettings::default()).expect("one memory state");
        for row in &changes.rows {
            let expected = match row.measurement.backend.as_str() {
                "half-edge" => Verdict::Slower,
                _ => Verdict::CannotTell,
            };
            assert_eq!(row.verdict, expected, "{row:?}");
            assert!(row.ci_low.is_some() && row.detectable.is_none());
        }
        assert!(
            changes.sentences[1].contains("15 of them were measured in one launch"),
            "{:?}",
            changes.sentences
        );
    }
    // Two samples tell nothing.
    let mut few = in_one_launch(&after);
    for samples in &mut few.samples {
        samples.rounds.truncate(2);
        samples.wall_ns.truncate(2);
        samples.slowdowns.truncate(2);
        samples.cpu_ns.iter_mut().for_each(|ns| ns.truncate(2));
    }
    let changes = compared(&before, &few, CompareSettings::default()).expect("one memory state");
    assert_eq!(changes.count(Verdict::CannotTell), changes.rows.len());
}

#[test]
fn a_known_change_is_found_and_nothing_else() {
    let before = report(|_, _| 1.0);
    let after = report(|backend, operation| match (backend, operation) {
        ("half-edge", Operation::EdgeLength) => 1.5,
        ("corner-table", Operation::Build) => 0.5,
        // Less than what counts.
        ("winged-edge", Operation::Boundary) => 1.06,
        _ => 1.0,
    });
    let settings = CompareSettings {
        noise: 1.1,
        ..CompareSettings::default()
    };
    let changes = compared(&before, &after, settings).expect("one memory state");
    assert_eq!(changes.count(Verdict::CannotTell), 0);
    assert_eq!(changes.rows.len(), before.results.len());
    let found: Vec<_> = changes
        .changed()
        .map(|row| {
            (
                row.measurement.backend.as_str(),
                row.measurement.operation.as_str(),
                row.verdict,
            )
        })
        .collect();
    assert_eq!(
        found,
        [
            ("corner-table", "build", Verdict::Faster),
            ("half-edge", "edge_length", Verdict::Slower),
        ]
    );
    let row = changes.changed().last().expect("two");
    assert!((row.ratio - 1.5).abs() < 1e-9, "{row:?}");
    let (low, high) = row.ci_low.zip(row.ci_high).expect("five launches each");
    assert!(
        low > 1.4 && low < 1.5 && high > 1.5 && high < 1.6,
        "{row:?}"
    );
    assert_eq!(changes.overall, Some(1.0));
    assert_eq!(changes.environment, []);
    assert!(
        changes.sentences[0].contains("1 is faster in the second file, 1 is slower"),
        "{:?}",
        changes.sentences
    );
}

#[test]
fn a_slower_machine_is_one_factor_that_relative_removes() {
    let before = report(|_, _| 1.0);
    let mut after = report(|backend, operation| match (backend, operation) {
        ("half-edge", Operation::EdgeLength) => 2.0,
        _ => 3.0,
    });
    after.run.environment.cpu_model = Some("an old one".into());
    let absolute = compared(&before, &after, CompareSettings::default()).expect("one memory state");
    assert_eq!(absolute.count(Verdict::Slower), 0);
    assert_eq!(absolute.slower_as_a_whole(), Some(3.0));
    let overall = &absolute.sentences[2];
    assert!(
        overall.contains("has 3.00 × the times of the first") && overall.contains("--relative"),
        "{:?}",
        absolute.sentences
    );
    assert_eq!(absolute.environment[0].what, "processor");
    let relative = compared(
        &before,
        &after,
        CompareSettings {
            relative: true,
            ..CompareSettings::default()
        },
    )
    .expect("one memory state");
    let found: Vec<_> = relative
        .changed()
        .map(|row| (row.measurement.backend.as_str(), row.verdict))
        .collect();
    assert_eq!(found, [("half-edge", Verdict::Faster)]);
    assert_eq!(relative.slower_as_a_whole(), None);
    assert!(
        relative.sentences[1].contains("Each ratio is compared with this median"),
        "{:?}",
        relative.sentences
    );
}

#[test]
fn different_heaps_and_caches_are_refused() {
    let before = report(|_, _| 1.0);
    let mut after = before.clone();
    let heap = after.run.environment.heap.as_mut().expect("measured");
    heap.policy = match heap.policy {
        Policy::Kept => Policy::System,
        Policy::System => Policy::Kept,
    };
    let refused = compared(&before, &after, CompareSettings::default());
    let message = refused.expect_err("two policies").to_string();
    assert!(
        message.contains("--heap kept") && message.contains("--heap system"),
        "{message}"
    );
    let mut after = before.clone();
    let caches = after
        .run
        .environment
        .cache_state
        .as_mut()
        .expect("measured");
    caches.state = CacheState::Cold;
    let refused = compared(&before, &after, CompareSettings::default());
    let message = refused.expect_err("two states").to_string();
    assert!(message.contains("--caches cold"), "{message}");
}

#[test]
fn missing_rows_other_checksums_and_new_winners_are_reported() {
    let before = report(|_, _| 1.0);
    let mut after = report(|_, _| 1.0);
    after
        .results
        .retain(|row| row.operation != Operation::Build.name());
    for row in &mut after.results {
        let now = row.backend == "corner-table";
        row.standing = Some(if now {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    let edge_length = |row: &&mut ResultRow| row.operation == Operation::EdgeLength.name();
    let row = after.results.iter_mut().find(edge_length).expect("a row");
    row.checksum = row.checksum.map(|sum| sum * 1.01);
    let name = row.backend.clone();
    after.backends[3].bytes = Some(7);
    let changes = compared(&before, &after, CompareSettings::default()).expect("one memory state");
    assert_eq!(changes.only_before.len(), 6);
    assert_eq!(changes.only_before[0].operation, "build");
    let other: Vec<_> = changes
        .changed()
        .map(|row| &row.measurement.backend)
        .collect();
    assert_eq!(other, [&name]);
    assert_eq!(changes.bytes[0].backend, "winged-edge");
    assert_eq!(changes.bytes[0].after, 7);
    assert_eq!(changes.winners.len(), 2);
    assert_eq!(changes.winners[0].after, "corner-table");
    assert!(
        changes.sentences.last().expect("sentences").contains(&name),
        "{:?}",
        changes.sentences
    );
}

#[test]
fn without_samples_no_change_can_be_told() {
    let before = report(|_, _| 1.0);
    let mut after = report(|backend, _| if backend == "half-edge" { 2.5 } else { 1.5 });
    after.samples.clear();
    let [before, after] = [before, after].map(|report| in_one_launch(&report));
    let changes = compared(&before, &after, CompareSettings::default()).expect("one memory state");
    assert_eq!(changes.count(Verdict::CannotTell), changes.rows.len());
    assert!(changes.rows.iter().all(|row| row.ci_low.is_none()));
}

#[test]
fn studies_of_other_meshes_are_refused() {
    let before = report(|_, _| 1.0);
    let mut after = before.clone();
    after.mesh.name = "cube".into();
    // The name alone makes no difference: the file may have moved.
    compared(&before, &after, CompareSettings::default()).expect("one mesh");
    after.mesh.facts.faces = 12;
    after.mesh.sha256 = "another".into();
    let error = compared(&before, &after, CompareSettings::default()).expect_err("two meshes");
    assert!(
        error
            .to_string()
            .contains("the first is of ball (12 vertices, 20 faces), the second of cube"),
        "{error}"
    );
}

#[test]
fn several_meshes_are_compared_by_name_or_content() {
    let before = report(|_, _| 1.0);
    let mut moved = before.clone();
    moved.mesh.name = "other/ball".into();
    let mut refined = report(|_, _| 3.0);
    refined.mesh.name = "fine".into();
    refined.mesh.facts.faces = 80;
    refined.mesh.sha256 = "fine".into();
    let mut cube = refined.clone();
    cube.mesh.name = "cube".into();
    cube.mesh.facts.faces = 12;
    cube.mesh.sha256 = "cube".into();
    let document = |studies: [&Report; 2]| {
        let mut all = Results::default();
        studies
            .into_iter()
            .for_each(|study| all.add(study.clone().into()));
        all
    };
    let settings = CompareSettings::default();
    let [a, b] = [document([&before, &refined]), document([&moved, &cube])];
    let changes = compare(&a, &b, settings).expect("one common mesh");
    assert_eq!(changes.rows.len(), before.results.len());
    assert!(
        changes
            .rows
            .iter()
            .all(|row| row.measurement.mesh == "ball")
    );
    let meshes = |only: &[Measurement]| only.iter().all(|m| m.mesh == "fine" || m.mesh == "cube");
    assert!(meshes(&changes.only_before) && meshes(&changes.only_after));
    assert_eq!(changes.only_before.len(), refined.results.len());
    assert_eq!(changes.only_after.len(), cube.results.len());
}

#[test]
fn other_labs_are_compared_and_nothing_in_common_is_an_error() {
    let ball = StudyMesh::new("ball", shapes::icosahedron());
    let stop = std::sync::atomic::AtomicBool::new(false);
    let settings = Settings {
        operations: vec![Operation::Boundary],
        effort: Effort::of_rounds(4),
        ..Settings::default()
    };
    let orders = orders_on(
        &SimulatedMachine::equal_costs(),
        &ball,
        &settings,
        &stop,
        &mut |_| (),
    )
    .expect("all hold it");
    let mut slower = orders.clone();
    for row in &mut slower.results {
        row.median_ns = row.median_ns.map(|ns| 10.0 * ns);
    }
    for samples in &mut slower.samples {
        let cpu = samples.cpu_ns.iter_mut().flatten();
        cpu.chain(&mut samples.wall_ns).for_each(|ns| *ns *= 10.0);
    }
    let document = Results::from(orders.clone());
    let changes = compare(&document, &slower.into(), CompareSettings::default()).expect("common");
    assert_eq!(changes.count(Verdict::Slower), orders.results.len());
    assert_eq!(changes.rows[1].measurement.case, "shuffled");
    let study = Results::from(report(|_, _| 1.0));
    let error = compare(&document, &study, CompareSettings::default());
    assert_eq!(error.expect_err("two kinds"), CompareError::NothingInCommon);
}

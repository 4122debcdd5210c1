//! Whole measurements of growth on a simulated machine.

use std::time::Duration;

use super::*;
use crate::engine::simulated_machine::{SimulatedMachine, Work};
use crate::labs::study::Settings;
use sixfold_measure::{Operation, Task};
use sixfold_results::{Finding, Results};

fn small(effort: Effort) -> GrowthSettings {
    let operations = ["vertex_vertices", "face_vertices"];
    GrowthSettings {
        study: Settings {
            effort,
            operations: operations
                .map(|name| name.parse().expect("a name"))
                .to_vec(),
            seed: 3,
            ..Settings::default()
        },
        shape: "triangle-torus".into(),
        from: 400,
        to: 3_200,
        steps: 4,
        ..GrowthSettings::default()
    }
}

fn quick_on(
    machine: &SimulatedMachine,
    settings: &GrowthSettings,
) -> Result<GrowthReport, GrowthError> {
    growth_on(machine, settings, &AtomicBool::new(false), &mut |_| ())
}

fn quick(settings: &GrowthSettings) -> Result<GrowthReport, GrowthError> {
    quick_on(&SimulatedMachine::usual(), settings)
}

/// Costs with exact exponents: a scan takes the square of the size.
fn powers(work: &Work<'_>) -> f64 {
    let faces = work.counts.faces as f64;
    let scans = ["polygon-soup", "indexed-face-set"].contains(&work.backend);
    let vertices =
        work.task == Task::Operation(Operation::Relation(sixfold::Relation::VertexVertices));
    match (work.task, scans && vertices) {
        (Task::Operation(Operation::Build), _) => 60.0 * faces,
        (_, true) => faces * faces,
        // A structure may be sublinear or superlinear.
        (_, false) if work.backend == "half-edge" => 100.0 * faces.powf(1.25),
        (_, false) => 10.0 * faces,
    }
}

#[test]
fn exponents_are_those_of_the_costs_at_any_speed() {
    for speed in [1.0, 0.05, 10.0] {
        for effort in [Effort::of_ms(20_000), Effort::of_rounds(2)] {
            let machine = SimulatedMachine::with_costs(powers).at_speed(speed);
            let report = quick_on(&machine, &small(effort)).expect("all backends hold it");
            let faces: Vec<usize> = report.sizes.iter().map(|size| size.faces).collect();
            assert_eq!(
                (faces.len(), &report.left_out[..]),
                (4, &[][..]),
                "speed {speed}"
            );
            assert!(faces.is_sorted());
            assert!(faces[0].abs_diff(400) < 40 && faces[3].abs_diff(3_200) < 320);
            let finding = Finding::from(report.clone());
            assert_eq!(finding.mismatches(), 0, "{:?}", report.sentences);
            assert_eq!(report.fits.len(), 2 * 6);
            for fit in &report.fits {
                let slope = fit.all.expect("four sizes");
                assert_eq!(slope.sizes, 4);
                let scans = fit.operation == "vertex_vertices"
                    && ["polygon-soup", "indexed-face-set"].contains(&fit.backend.as_str());
                assert_eq!(fit.scans, scans, "{fit:?}");
                let expected = match fit.backend.as_str() {
                    "half-edge" => 1.25,
                    _ if scans => 2.0,
                    _ => 1.0,
                };
                assert!(
                    (slope.exponent - expected).abs() < 1e-6,
                    "speed {speed}: {fit:?}"
                );
            }
            for size in &report.sizes {
                assert_eq!(size.backend_bytes.len(), 6);
                let (v, f) = (size.vertices as i64, size.faces as i64);
                assert_eq!(v - size.edges as i64 + f, 0, "a torus");
            }
            // Each of the six structures has one row for each data cache.
            let data = report.caches.iter().filter(|cache| cache.holds_data());
            assert_eq!(report.cache_limits.len(), 6 * data.count());
            let sentences = report.sentences.join(" ");
            assert!(
                sentences.contains("face_vertices: ") && sentences.contains("to the power"),
                "{sentences}"
            );
        }
    }
}

#[test]
fn exponents_are_found_on_a_drifting_machine() {
    let machine = SimulatedMachine::with_costs(powers).drifting();
    let report = quick_on(&machine, &small(Effort::of_ms(4000))).expect("all backends hold it");
    for fit in &report.fits {
        let exponent = fit.all.expect("four sizes").exponent;
        let expected = match fit.backend.as_str() {
            "half-edge" => 1.25,
            _ if fit.scans => 2.0,
            _ => 1.0,
        };
        // A jump of 1.8 times between sizes that are twice as large changes an exponent.
        assert!((exponent - expected).abs() < 0.45, "{fit:?}");
    }
}

#[test]
fn finished_sizes_are_kept_after_a_stop() {
    let stop = AtomicBool::new(false);
    let machine = SimulatedMachine::usual();
    let settings = small(Effort::of_ms(2000));
    let mut seen: Option<String> = None;
    let report = growth_on(&machine, &settings, &stop, &mut |at| {
        let size = at.stage.split(' ').next().map(str::to_owned);
        if seen.is_some() && seen != size {
            stop.store(true, Ordering::Relaxed); // the second size has begun
        }
        seen = size;
    });
    let report = report.expect("an interruption is not an error");
    assert!(report.interrupted);
    assert_eq!(report.sizes.len(), 1);
    assert!(
        report.fits.iter().all(|fit| fit.all.is_none()),
        "one size gives no line"
    );
    let stopped = AtomicBool::new(true);
    let report = growth_on(&machine, &settings, &stopped, &mut |_| ()).expect("a report");
    assert!(report.interrupted && report.sizes.is_empty() && report.fits.is_empty());
}

#[test]
fn sizes_that_cannot_be_built_in_time_are_left_out_and_listed() {
    // The sizes are 400, 800, 1,600 and 3,200 faces. Building takes 1 ms per face, and the corner
    // table is built twice.
    let slow_to_build = |work: &Work<'_>| match work.task {
        Task::Operation(Operation::Build) => 1e6 * work.counts.faces as f64,
        _ => 10.0 * work.counts.faces as f64,
    };
    for (budget_s, finished) in [(2, 1), (5, 2), (12, 3), (40, 4)] {
        for speed in [0.1, 1.0, 10.0] {
            let budget = Duration::from_millis((1000.0 * budget_s as f64 / speed) as u64);
            let mut settings = small(budget.into());
            settings.study.operations.remove(0);
            settings.study.backends = vec!["corner-table".into()];
            let machine = SimulatedMachine::with_costs(slow_to_build).at_speed(speed);
            let report = quick_on(&machine, &settings).expect("it holds triangles");
            let context = format!("{budget_s} s at speed {speed}");
            assert!(!report.interrupted);
            assert_eq!(report.sizes.len(), finished, "{context}");
            assert_eq!(report.left_out.len(), 4 - finished, "{context}");
            // A size that was begun is finished.
            let used = machine.ns() / budget.as_nanos() as f64;
            assert!(used < 1.5, "{context}: {used} of the budget");
            let sentences = report.sentences.join(" ");
            assert_eq!(
                sentences.contains("too short to measure sizes of about"),
                finished < 4,
                "{context}: {sentences}"
            );
            assert_eq!(
                sentences.contains("3,200"),
                finished < 4,
                "{context}: {sentences}"
            );
            // Nothing is left out of a fixed number of rounds.
            settings.study.effort = Effort::of_rounds(1);
            let report = quick_on(&machine, &settings).expect("it holds triangles");
            assert_eq!((report.sizes.len(), report.left_out.len()), (4, 0));
        }
    }
}

#[test]
fn growth_of_a_quad_shape_excludes_corner_tables() {
    let mut settings = small(Effort::of_rounds(1));
    settings.shape = "torus".into();
    settings.study.operations.remove(0);
    let report = quick(&settings).expect("five hold quads");
    assert_eq!((report.backends.len(), report.refused_by.len()), (5, 1));
    assert_eq!(report.refused_by[0].backend, "corner-table");
    settings.study.backends = vec!["corner-table".into()];
    let refused = quick(&settings).err();
    assert!(matches!(
        refused,
        Some(GrowthError::Study(StudyError::NoneHolds { .. }))
    ));
    // All sizes between these limits give the same mesh.
    settings = small(Effort::of_rounds(1));
    (settings.from, settings.to) = (400, 401);
    assert_eq!(
        quick(&settings).err(),
        Some(GrowthError::OneSize { from: 400, to: 401 })
    );
}

#[test]
fn a_document_with_missing_meshes_or_impossible_times_is_refused() {
    let report = quick(&small(Effort::of_rounds(1))).expect("a measurement");
    assert_eq!(report.meshes.len(), report.sizes.len());
    let refusal = |change: &dyn Fn(&mut GrowthReport)| {
        let mut changed = report.clone();
        change(&mut changed);
        let mut json = Vec::new();
        let written = Results::from(changed).write_json(&mut json);
        written.expect("written to memory");
        let read = Results::read_json(std::str::from_utf8(&json).expect("UTF-8"));
        read.err().map(|error| error.to_string())
    };
    assert_eq!(refusal(&|_| ()), None);
    assert!(refusal(&|r| r.meshes.clear()).is_some());
    let missing = refusal(&|r| r.meshes.truncate(3)).expect("a mesh is missing");
    assert!(missing.contains("has 3 meshes, not 4"), "{missing}");
    let negative = refusal(&|r| r.sizes[1].results[0].median_ns = Some(-1.0));
    let negative = negative.expect("a negative time");
    assert!(negative.contains("invalid time"), "{negative}");
}

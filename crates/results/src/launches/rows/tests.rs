use super::*;
use crate::rows::Standing;

fn row(backend: &str, operation: &str, ns: f64) -> ResultRow {
    ResultRow {
        median_ns: Some(ns),
        uncorrected_ns: Some(ns),
        min_ns: Some(0.9 * ns),
        wall_median_ns: Some(1.1 * ns),
        elements: Some(10),
        ns_per_element: Some(ns / 10.0),
        agreement: Agreement::Same,
        samples: 5,
        disturbed: 1,
        retaken: 2,
        faults: Some(ns as u64),
        ..ResultRow::new(backend, operation, "vertex")
    }
}

fn samples(backend: &str, control: bool, count: u32) -> Samples {
    Samples {
        backend: backend.into(),
        operation: "build".into(),
        control,
        rounds: (0..count).collect(),
        cpu_ns: Some(vec![1.0; count as usize]),
        wall_ns: vec![2.0; count as usize],
        slowdowns: vec![1.5; count as usize],
        ..Samples::default()
    }
}

fn control(ratio: f64) -> Option<Control> {
    let row = ControlRow {
        operation: "build".into(),
        ratio,
        ci_low: None,
        ci_high: None,
        launches: Vec::new(),
    };
    Control::new("a", vec![row])
}

/// What a launch measured.
#[derive(Default)]
struct Launch {
    results: Vec<ResultRow>,
    refusals: Vec<Refusal>,
    samples: Vec<Samples>,
    control: Option<Control>,
}

impl Launch {
    fn rows(&self) -> LaunchRows<'_> {
        LaunchRows {
            results: &self.results,
            refusals: &self.refusals,
            samples: &self.samples,
            control: self.control.as_ref(),
        }
    }
}

fn pool(launches: &[Launch]) -> PooledRows {
    let rows: Vec<LaunchRows<'_>> = launches.iter().map(Launch::rows).collect();
    pool_rows(&rows, Confidence::default(), |row| row.operation.clone())
}

fn close(a: Option<f64>, b: f64) -> bool {
    a.is_some_and(|a| (a / b - 1.0).abs() < 1e-9)
}

#[test]
fn a_row_has_the_values_of_its_launches() {
    let launch = |factor: f64| Launch {
        results: vec![
            row("a", "build", 10.0 * factor),
            row("b", "build", 30.0 * factor),
        ],
        ..Launch::default()
    };
    let pooled = pool(&[launch(1.0), launch(4.0), launch(2.0)]);
    let [a, b] = &pooled.results[..] else {
        panic!("{pooled:?}")
    };
    assert_eq!(a.launch_ns, [10.0, 40.0, 20.0].map(Some));
    assert!(close(a.median_ns, 20.0) && close(a.ns_per_element, 2.0));
    assert_eq!((a.samples, a.disturbed, a.retaken), (15, 3, 6));
    assert_eq!((a.min_ns, a.faults), (Some(9.0), Some(40)));
    assert!(close(a.wall_median_ns, 22.0) && close(a.uncorrected_ns, 20.0));
    assert!(a.ci_low_ns < a.median_ns && a.median_ns < a.ci_high_ns);
    assert_eq!(
        (a.standing, b.standing),
        (Some(Standing::Best), Some(Standing::Slower))
    );
    assert!(close(b.ratio_to_best, 3.0) && close(b.ratio_ci_high, 3.0));
    assert_eq!(b.agreement, Agreement::Same);
}

#[test]
fn pooled_rows_can_be_pooled_again() {
    let launch = |ns: f64| Launch {
        results: vec![row("a", "build", ns), row("b", "build", 2.0 * ns)],
        samples: vec![samples("a", false, 3), samples("a", true, 2)],
        control: control(1.0 + ns / 100.0),
        ..Launch::default()
    };
    let all = [1.0, 2.0, 5.0, 7.0].map(launch);
    let at_once = pool(&all);
    let [first, second] = [&all[..1], &all[1..]].map(|part| {
        let pooled = pool(part);
        Launch {
            results: pooled.results,
            refusals: pooled.refusals,
            samples: pooled.samples,
            control: pooled.control,
        }
    });
    let in_steps = pool(&[first, second]);
    assert_eq!(in_steps.samples, at_once.samples);
    assert_eq!(in_steps.control, at_once.control);
    for (steps, once) in in_steps.results.iter().zip(&at_once.results) {
        assert_eq!(steps.launch_ns, once.launch_ns);
        assert_eq!(
            (steps.ci_low_ns, steps.samples),
            (once.ci_low_ns, once.samples)
        );
        assert_eq!(
            (steps.ratio_ci_high, steps.standing),
            (once.ratio_ci_high, once.standing)
        );
    }
    assert_eq!(
        at_once.samples[0].launches,
        [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3]
    );
    assert_eq!(at_once.samples[0].rounds, (0..12).collect::<Vec<u32>>());
    // Both columns of the control have the same rounds, because they are compared within rounds.
    assert_eq!(at_once.samples[1].rounds, [0, 1, 3, 4, 6, 7, 9, 10]);
    let control = at_once.control.expect("measured twice");
    assert!(close(
        Some(control.operations[0].ratio),
        (1.01_f64 * 1.02 * 1.05 * 1.07).powf(0.25)
    ));
}

#[test]
fn what_one_launch_lacks_comes_from_the_others() {
    let estimate = |ns: f64| ResultRow {
        median_ns: None,
        estimated_ns: Some(ns),
        samples: 0,
        ..row("b", "build", ns)
    };
    let refusal = |operation: &str, kind| Refusal {
        backend: "a".into(),
        operation: operation.into(),
        kind,
        reason: String::new(),
    };
    let (ended, impossible) = (RefusalKind::BudgetEnded, RefusalKind::Impossible);
    let first = Launch {
        results: vec![row("a", "build", 10.0), estimate(90.0)],
        refusals: vec![refusal("loop", ended), refusal("flip", ended)],
        ..Launch::default()
    };
    let second = Launch {
        results: vec![
            row("a", "build", 10.0),
            estimate(80.0),
            row("a", "loop", 5.0),
        ],
        refusals: vec![refusal("flip", impossible)],
        ..Launch::default()
    };
    let pooled = pool(&[first, second]);
    let [a, b, late] = &pooled.results[..] else {
        panic!("{pooled:?}")
    };
    assert_eq!(
        (b.median_ns, b.estimated_ns, b.standing),
        (None, Some(90.0), None)
    );
    assert_eq!(a.standing, Some(Standing::Alone));
    assert_eq!(late.launch_ns, [None, Some(5.0)]);
    assert!(close(late.median_ns, 5.0) && late.ci_low_ns.is_none());
    assert_eq!(pooled.refusals, [refusal("flip", impossible)]);
    // A time in one launch is better than an estimate in another one.
    let first = Launch {
        results: vec![estimate(90.0)],
        ..Launch::default()
    };
    let second = Launch {
        results: vec![row("b", "build", 70.0)],
        ..Launch::default()
    };
    let pooled = pool(&[first, second]);
    assert!(close(pooled.results[0].median_ns, 70.0));
    assert_eq!(
        (pooled.results[0].estimated_ns, pooled.results[0].samples),
        (None, 5)
    );
}

#[test]
fn a_backend_that_did_other_work_in_one_launch_is_not_ranked() {
    let launch = |agreement| Launch {
        results: vec![
            row("a", "build", 10.0),
            ResultRow {
                agreement,
                ..row("b", "build", 1.0)
            },
        ],
        ..Launch::default()
    };
    for agreement in [Agreement::Mismatch, Agreement::OtherEdits] {
        let pooled = pool(&[launch(Agreement::Same), launch(agreement)]);
        assert_eq!(pooled.results[1].agreement, agreement);
        assert_eq!(
            (pooled.results[1].standing, pooled.results[1].ratio_to_best),
            (None, None)
        );
        assert_eq!(pooled.results[0].ratio_to_best, Some(1.0));
    }
    let merged = pool(&[launch(Agreement::Unchecked), launch(Agreement::Merged)]);
    assert_eq!(merged.results[1].agreement, Agreement::Merged);
}

#[test]
fn rows_that_differ_in_their_case_are_compared_as_the_group_says() {
    let of_case = |case: &str, ns: f64| ResultRow {
        case: case.into(),
        ..row("a", "build", ns)
    };
    let launch = |ns: f64| Launch {
        results: vec![of_case("given", ns), of_case("shuffled", 3.0 * ns)],
        ..Launch::default()
    };
    let launches = [launch(1.0), launch(2.0)];
    let rows = launches.each_ref().map(Launch::rows);
    let together = pool_rows(&rows, Confidence::default(), |row| row.backend.clone());
    assert!(close(together.results[1].ratio_to_best, 3.0));
    let apart = pool_rows(&rows, Confidence::default(), |row| row.case.clone());
    assert_eq!(apart.results[1].standing, Some(Standing::Alone));
}

#[test]
fn samples_without_a_value_in_one_launch_have_none() {
    let counted = |faults| Launch {
        samples: vec![Samples {
            faults,
            slowdowns: Vec::new(),
            ..samples("a", false, 1)
        }],
        ..Launch::default()
    };
    let pooled = pool(&[counted(Some(vec![1])), counted(Some(vec![2]))]);
    assert_eq!(pooled.samples[0].faults, Some(vec![1, 2]));
    assert_eq!(pooled.samples[0].slowdowns, [1.0; 2]);
    let pooled = pool(&[counted(Some(vec![1])), counted(None)]);
    assert_eq!(pooled.samples[0].faults, None);
}

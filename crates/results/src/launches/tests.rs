//! Tests of the intervals over launches, on hand-made times and on simulated studies with known truth.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

use super::*;
use crate::corrected::corrected_times;
use crate::rows::ResultRow;
use crate::simulated::{LAUNCHING, normal, uniform};
use crate::time::Time;

/// Number of simulated studies.
const STUDIES: usize = 1000;
/// True time of the first backend, and that of the second divided by it.
const TRUE_NS: f64 = 100.0;
const TRUE_RATIO: f64 = 1.1;

fn close(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-9
}

#[test]
fn a_time_is_the_geometric_mean_over_the_launches() {
    let launches = [Some(1.0), Some(4.0), Some(16.0)];
    assert!(matches!(times_over_launches(&[&launches])[..], [Some(ns)] if close(ns, 4.0)));
    let time = time_over_launches(4.0, &launches).expect("launches");
    let [low, high] = time
        .interval(Confidence::default())
        .expect("three launches");
    // The standard deviation of the logarithms is ln 4, and the quantile of two degrees of freedom is 4.303.
    let half = 4.302_653 * 4_f64.ln() * (ALIKE / 3.0 + LASTING_IN_TIMES).sqrt();
    assert!((high / (4.0 * half.exp()) - 1.0).abs() < 1e-3, "{high}");
    assert!(close(low * high, 16.0) && time.least == 1.0);
}

#[test]
fn a_backend_gains_nothing_by_its_absence_from_a_slow_launch() {
    let first = [Some(10.0), Some(20.0), Some(40.0)];
    let second = [Some(30.0), Some(60.0), None];
    let times = times_over_launches(&[&first, &second, &[None; 3]]);
    let [Some(a), Some(b), None] = times[..] else {
        panic!("{times:?}")
    };
    assert!(close(a, 20.0) && close(b, 60.0), "{times:?}");
    let ratio = ratio_over_launches([b, a], [&second, &first]).expect("two common launches");
    assert!(close(ratio.value, 3.0));
    let [low, high] = ratio
        .interval(Confidence::default())
        .expect("two common launches");
    assert!(
        close(low, 3.0) && close(high, 3.0),
        "no variation of the ratio"
    );
}

/// Found in a study of 15 launches of which three had time for an operation: the times were ten times too short.
#[test]
fn launches_without_times_change_nothing() {
    let soup = [4396.0, 8055.0, 3675.0];
    let faces = [1987.0, 2098.0, 409.0];
    let others = [
        [2.289, 2.423, 2.316],
        [0.647, 0.432, 0.438],
        [0.286, 0.298, 0.283],
    ];
    let rows = [&[soup, faces][..], &others].concat();
    let times = |empty: usize| -> Vec<f64> {
        let launches = rows.iter().map(|row| {
            let known = row.map(Some).into_iter();
            known.chain(vec![None; empty]).collect()
        });
        let launches: Vec<Vec<Option<f64>>> = launches.collect();
        let lists: Vec<&[Option<f64>]> = launches.iter().map(Vec::as_slice).collect();
        let times = times_over_launches(&lists).into_iter();
        times.collect::<Option<_>>().expect("times")
    };
    let expected = times(0);
    for (row, &time) in rows.iter().zip(&expected) {
        let ends = [f64::min, f64::max].map(|of| row.iter().copied().reduce(of).expect("three"));
        assert!((ends[0]..=ends[1]).contains(&time), "{time} of {row:?}");
    }
    for (time, expected) in times(12).iter().zip(&expected) {
        assert!(close(*time, *expected), "{time} {expected}");
    }
}

/// Returns the row over launches of which each has a number of samples; 0 is a single run before the rounds.
fn row_over(samples: &[usize]) -> ResultRow {
    let row = |&samples: &usize| ResultRow {
        median_ns: Some(if samples == 0 { 90.0 } else { 10.0 }),
        warm_up_only: samples == 0,
        samples: samples.max(1),
        ..ResultRow::new("half-edge", "boundary", "edge")
    };
    let rows: Vec<[ResultRow; 1]> = samples.iter().map(|samples| [row(samples)]).collect();
    let launches = rows.iter().map(|results| LaunchRows {
        results,
        refusals: &[],
        samples: &[],
        control: None,
    });
    let launches: Vec<LaunchRows<'_>> = launches.collect();
    let pooled = pool_rows(&launches, Confidence::default(), |row| {
        row.operation.clone()
    });
    let [row] = &pooled.results[..] else {
        panic!("one row")
    };
    row.clone()
}

#[test]
fn runs_before_the_rounds_count_only_without_better_ones() {
    let row = row_over(&[0, 4, 0, 5]);
    assert_eq!(row.launch_ns, [None, Some(10.0), None, Some(10.0)]);
    assert!(row.median_ns.is_some_and(|ns| close(ns, 10.0)) && row.samples == 9);
    let row = row_over(&[0, 4, 0]);
    assert_eq!(row.launch_ns, [Some(90.0), Some(10.0), Some(90.0)]);
    assert_eq!((row.samples, row.warm_up_only), (6, false));
}

#[test]
fn a_single_launch_has_no_interval() {
    let one = [Some(5.0)];
    let time = time_over_launches(5.0, &one).expect("a time");
    assert_eq!(time.interval(Confidence::default()), None);
    let ratio = ratio_over_launches([5.0, 4.0], [&one, &[Some(4.0)]]).expect("a ratio");
    assert_eq!(
        (ratio.value, ratio.interval(Confidence::default())),
        (1.25, None)
    );
    assert_eq!(ratio_over_launches([5.0, 4.0], [&one, &[None]]), None);
    assert_eq!(time_over_launches(5.0, &[None]), None);
}

#[test]
fn without_logarithms_times_are_means() {
    let times = times_over_launches(&[&[Some(0.0), Some(4.0)], &[Some(3.0), None]]);
    assert_eq!(times, [Some(2.0), Some(3.0)]);
    let ratio = ratio_over_launches([2.0, 0.0], [&[Some(2.0)], &[Some(0.0)]]);
    assert_eq!(ratio, None, "the ratio is not finite");
    let time = time_over_launches(2.0, &[Some(0.0), Some(4.0)]).expect("a time");
    assert_eq!(time.interval(Confidence::default()), None);
}

#[test]
fn one_disturbed_launch_does_not_decide() {
    let steady = [10.0, 10.1, 9.9, 10.0, 10.05].map(Some);
    let disturbed = [20.0, 20.2, 19.8, 80.0, 20.1].map(Some);
    let [Some(a), Some(b)] = times_over_launches(&[&steady, &disturbed])[..] else {
        panic!("two times")
    };
    assert!((b / a - 2.0).abs() < 0.01, "{a} {b}");
    let ratio = ratio_over_launches([b, a], [&disturbed, &steady]).expect("a ratio");
    let [low, high] = ratio
        .interval(Confidence::default())
        .expect("five launches");
    assert!(1.9 < low && high < 2.1, "{low} {high}");
    // The time of a single backend is the geometric mean.
    let alone = times_over_launches(&[&disturbed])[0].expect("a time");
    let logs = disturbed.iter().flatten().map(|ns| ns.ln()).sum::<f64>() / 5.0;
    assert!(close(alone, logs.exp()));
}

#[test]
fn the_error_of_a_trimmed_mean_is_that_of_its_winsorised_values() {
    let values = [5.0, 1.0, 2.0, 3.0, 100.0];
    let error = squared_error(&values, 1, 0.1).expect("three are kept");
    // 2, 2, 3, 5, 5 have the variance 2.3, and three of five values are kept.
    assert!(
        close(error.squared, 2.3 / 0.36 * (ALIKE / 5.0 + 0.1)),
        "{error:?}"
    );
    assert_eq!(error.freedom, 2.0);
    assert_eq!(squared_error(&values, 2, 0.1), None);
    assert_eq!(squared_error(&[f64::NAN, 1.0, 2.0], 0, 0.1), None);
    assert_eq!([4, 5, 9, 10].map(trimmed), [0, 1, 1, 2]);
}

/// Correlation of what differs from launch to launch with that of the launch before.
const LIKENESS: f64 = 0.2;
/// What differs from study to study, for each backend.
const HOURS: f64 = 0.006;
/// Probability and factor of a stall: all of a launch is slow.
const STALL: (f64, f64) = (0.1, 1.5);

/// One study of two backends: for each launch, the corrected times.
fn study(launches: usize, stalls: bool, random: &mut ChaCha8Rng) -> [Vec<Option<f64>>; 2] {
    let mut values = [const { Vec::new() }; 2];
    // Addresses and pages differ from launch to launch, for each backend.
    let mut own = [(); 2].map(|()| normal(random, LAUNCHING.launches));
    let hour = [(); 2].map(|()| normal(random, HOURS));
    let innovation = LAUNCHING.launches * (1.0 - LIKENESS * LIKENESS).sqrt();
    for _ in 0..launches {
        let stall = if stalls && uniform(random) < STALL.0 {
            STALL.1
        } else {
            1.0
        };
        let common = LAUNCHING.common(random);
        let samples = [0, 1].map(|backend| {
            let true_ns = [TRUE_NS, TRUE_NS * TRUE_RATIO][backend];
            own[backend] = LIKENESS * own[backend] + normal(random, innovation);
            let own = stall * (hour[backend] + own[backend]).exp();
            let times = LAUNCHING.times(&common, true_ns * own, random);
            (0..)
                .zip(times.into_iter().map(Time::from_wall_ns))
                .collect()
        });
        for (values, ns) in values.iter_mut().zip(corrected_times(&samples)) {
            values.push(ns);
        }
    }
    values
}

/// Returns the part of 1,000 studies, in percent, whose intervals of the ratio and of the time contain the truth.
fn covered(launches: usize, stalls: bool, confidence: Confidence) -> [f64; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(67);
    let mut covered = [0; 2];
    for _ in 0..STUDIES {
        let [a, b] = &study(launches, stalls, &mut random);
        let [Some(ns), Some(other)] = times_over_launches(&[a, b])[..] else {
            panic!("two times")
        };
        let ratio = ratio_over_launches([other, ns], [b, a]).expect("a ratio");
        let time = time_over_launches(ns, a).expect("a time");
        let contains = |found: Median, truth: f64| {
            let [low, high] = found.interval(confidence).expect("two launches or more");
            usize::from((low..=high).contains(&truth))
        };
        covered[0] += contains(ratio, TRUE_RATIO);
        covered[1] += contains(time, TRUE_NS);
    }
    covered.map(|count| 100.0 * count as f64 / STUDIES as f64)
}

/// Few launches and many, on a machine that differs from launch to launch and from round to round, drifts, jumps,
/// stutters and stalls.
#[test]
fn intervals_of_ratios_contain_the_truth_in_95_percent_of_the_studies() {
    for launches in [2, 3, 5, 10, 20] {
        let [ratios, _] = covered(launches, true, Confidence::default());
        assert!(
            (93.0..=97.0).contains(&ratios),
            "{launches} launches: {ratios} %"
        );
    }
}

#[test]
fn intervals_of_another_confidence_contain_the_truth_as_often_as_they_say() {
    for (confidence, allowed) in [("80%", 77.0..=83.0), ("99%", 97.5..=100.0)] {
        let confidence = confidence.parse().expect("allowed");
        let [ratios, _] = covered(10, true, confidence);
        assert!(allowed.contains(&ratios), "{confidence}: {ratios} %");
    }
}

#[test]
fn intervals_of_times_contain_the_truth_and_have_room_for_the_drift_that_no_launch_sees() {
    for launches in [2, 3, 5, 10, 20] {
        let [_, times] = covered(launches, false, Confidence::default());
        assert!(times >= 93.0, "{launches} launches: {times} %");
    }
}

/// The samples of one launch do not show what differs from launch to launch. If this test fails, the simulated
/// machine is too steady to test anything.
#[test]
fn the_interval_of_one_launch_is_too_narrow() {
    let mut random = ChaCha8Rng::seed_from_u64(68);
    let mut covered = 0;
    for _ in 0..STUDIES {
        let common = LAUNCHING.common(&mut random);
        let samples = [TRUE_NS, TRUE_NS * TRUE_RATIO].map(|true_ns| {
            let own = normal(&mut random, LAUNCHING.launches).exp();
            let times = LAUNCHING.times(&common, true_ns * own, &mut random);
            times.into_iter()
        });
        let [a, b] = samples;
        let ratio = Median::from_ratios(b.zip(a).map(|(b, a)| b / a)).expect("samples");
        let [low, high] = ratio
            .interval(Confidence::default())
            .expect("enough samples");
        covered += usize::from((low..=high).contains(&TRUE_RATIO));
    }
    assert!(covered < STUDIES * 9 / 10, "{covered} of {STUDIES}");
}

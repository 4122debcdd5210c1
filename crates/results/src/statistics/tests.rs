//! Tests of the intervals, on hand-made samples and on simulated studies with known truth.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

use super::*;
use crate::corrected::corrected_times;
use crate::ranking::{NO_DIFFERENCE, Rank, rank};
use crate::rows::Standing;
use crate::simulated::{MACHINES, Machine, STEADY, STUDIES, normal, uniform};
use crate::time::Time;

/// Returns the studies of a single backend, and the median of the times of many other studies.
fn studies(machine: Machine) -> (Vec<Vec<f64>>, f64) {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut study = || {
        let common = machine.common(&mut random);
        machine.times(&common, 100.0, &mut random)
    };
    let studies: Vec<Vec<f64>> = (0..STUDIES).map(|_| study()).collect();
    let others = (0..2 * STUDIES).flat_map(|_| study());
    let truth = median_of_sorted(&sorted(others).expect("samples"));
    (studies, truth)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    median_of_sorted(&sorted(values).expect("values"))
}

fn percent(count: usize, all: usize) -> f64 {
    100.0 * count as f64 / all as f64
}

/// Returns the part of `intervals` that contain `truth`, in percent, and their median width.
fn coverage(intervals: &[[f64; 2]], truth: f64) -> (f64, f64) {
    let covered = intervals
        .iter()
        .filter(|[low, high]| (*low..=*high).contains(&truth));
    let width = median(intervals.iter().map(|[low, high]| (high - low) / truth));
    (percent(covered.count(), intervals.len()), width)
}

#[test]
fn intervals_contain_the_truth_on_machines_that_drift() {
    for machine in MACHINES {
        let (studies, truth) = studies(machine);
        let interval = |samples: &Vec<f64>| {
            let median = Median::from_samples(samples.iter().copied()).expect("samples");
            median
                .interval(Confidence::default())
                .expect("enough samples")
        };
        let intervals: Vec<[f64; 2]> = studies.iter().map(interval).collect();
        let (covered, width) = coverage(&intervals, truth);
        assert!(covered >= 90.0, "{machine:?}: {covered} %");
        // The narrowest interval that contains 95 % of the medians, with full knowledge.
        let medians = sorted(
            studies
                .iter()
                .map(|samples| median(samples.iter().copied())),
        );
        let medians = medians.expect("studies");
        let tail = STUDIES / 40;
        let narrowest = (medians[STUDIES - 1 - tail] - medians[tail]) / truth;
        assert!(width <= 1.8 * narrowest, "{machine:?}: {width} {narrowest}");
    }
}

/// The interval between the 7th and the 18th of 24 samples contains the median in 97.7 % of the
/// cases if the samples are independent. If this test fails, the simulated drift is too small to
/// test anything.
#[test]
fn an_interval_for_independent_samples_is_too_narrow_on_machines_that_drift() {
    let covered = |machine: Machine| {
        let (studies, truth) = studies(machine);
        let interval = |samples: Vec<f64>| {
            let sorted = sorted(samples.into_iter()).expect("samples");
            [sorted[6], sorted[17]]
        };
        let intervals: Vec<[f64; 2]> = studies.into_iter().map(interval).collect();
        coverage(&intervals, truth).0
    };
    assert!(covered(STEADY) >= 95.0, "{}", covered(STEADY));
    let [.., all] = MACHINES;
    for machine in [MACHINES[1], MACHINES[2], all] {
        let covered = covered(machine);
        assert!(covered < 88.0, "{machine:?}: {covered} %");
    }
}

/// Measures two backends in each study. The second takes `gap` times as long.
fn pairs(machine: Machine, gap: f64) -> Vec<[Vec<(u32, Time)>; 2]> {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let study = |_| {
        let common = machine.common(&mut random);
        [100.0, 100.0 * gap].map(|true_ns| {
            let times = machine.times(&common, true_ns, &mut random);
            (0..)
                .zip(times.into_iter().map(Time::from_wall_ns))
                .collect()
        })
    };
    (0..STUDIES).map(study).collect()
}

fn ranked(pair: &[Vec<(u32, Time)>]) -> Vec<Option<Rank>> {
    rank(
        pair,
        &corrected_times(pair),
        NO_DIFFERENCE,
        Confidence::default(),
    )
}

#[test]
fn differences_of_a_tenth_are_found_and_equal_backends_are_tied() {
    for machine in MACHINES {
        let (mut found, mut ordered, mut covered, mut tied) = (0, 0, 0, 0);
        for pair in pairs(machine, 1.1) {
            let [first, second] = ranked(&pair)[..] else {
                panic!("two backends");
            };
            let (first, second) = (first.expect("samples"), second.expect("samples"));
            found += usize::from(second.standing == Some(Standing::Slower));
            ordered += usize::from(first.ratio.value == 1.0 && second.ratio.value > 1.0);
            let [low, high] = second
                .ratio
                .interval(Confidence::default())
                .expect("enough rounds");
            covered += usize::from(low <= 1.1 && 1.1 <= high);
        }
        for pair in pairs(machine, 1.0) {
            let ranks = ranked(&pair);
            let slower = |rank: &Rank| rank.standing == Some(Standing::Slower);
            tied += usize::from(!ranks.iter().flatten().any(slower));
        }
        let [found, ordered, covered, tied] =
            [found, ordered, covered, tied].map(|count| percent(count, STUDIES));
        assert!(found >= 90.0, "{machine:?}: {found} % found");
        assert!(
            ordered >= 95.0,
            "{machine:?}: {ordered} % in the true order"
        );
        assert!(
            covered >= 90.0,
            "{machine:?}: {covered} % contain the ratio"
        );
        assert!(tied >= 90.0, "{machine:?}: {tied} % tied");
    }
}

#[test]
fn quotients_of_separate_studies_contain_the_truth() {
    for machine in MACHINES {
        let (studies, _) = studies(machine);
        let interval = |pair: &[Vec<f64>]| {
            let (ratio, interval) =
                quotient(&pair[0], &pair[1], Confidence::default()).expect("samples");
            let [low, high] = interval.expect("enough samples");
            assert!(low <= ratio && ratio <= high);
            [low, high]
        };
        let intervals: Vec<[f64; 2]> = studies.chunks_exact(2).map(interval).collect();
        let (covered, _) = coverage(&intervals, 1.0);
        assert!(covered >= 90.0, "{machine:?}: {covered} %");
    }
    assert_eq!(quotient(&[], &[1.0], Confidence::default()), None);
    assert_eq!(
        quotient(&[4.0, 4.0], &[2.0], Confidence::default()),
        Some((2.0, None))
    );
    assert_eq!(quotient(&[1.0; 5], &[0.0; 5], Confidence::default()), None);
}

#[test]
fn differences_contain_the_truth() {
    for machine in MACHINES {
        let mut covered = 0;
        for [a, b] in pairs(machine, 1.1) {
            let pairs: Vec<[f64; 2]> = a
                .iter()
                .zip(&b)
                .map(|(a, b)| [b.1.ns(), a.1.ns()])
                .collect();
            let (_, interval) = difference(&pairs, Confidence::default()).expect("rounds");
            let [low, high] = interval.expect("enough rounds");
            covered += usize::from(low <= 10.0 && 10.0 <= high);
        }
        let covered = percent(covered, STUDIES);
        assert!(covered >= 90.0, "{machine:?}: {covered} %");
    }
}

#[test]
fn few_samples_have_wide_intervals_or_none() {
    assert_eq!(Median::from_samples([]), None);
    let two = Median::from_samples([4.0, 2.0]).expect("two samples");
    assert_eq!((two.value, two.least), (3.0, 2.0));
    assert_eq!(two.interval(Confidence::default()), None);
    assert_eq!(difference(&[], Confidence::default()), None);
    let (studies, truth) = studies(STEADY);
    let mut widths = Vec::new();
    for count in [3, 4, 5, 6] {
        let interval = |samples: &Vec<f64>| {
            let few = samples[..count].iter().copied();
            Median::from_samples(few)
                .and_then(|median| median.interval(Confidence::default()))
                .expect("enough")
        };
        let intervals: Vec<[f64; 2]> = studies.iter().map(interval).collect();
        let (covered, width) = coverage(&intervals, truth);
        assert!(covered >= 93.0, "{count} samples: {covered} %");
        widths.push(width);
    }
    assert!(widths.is_sorted_by(|a, b| a > b), "{widths:?}");
}

#[test]
fn an_interval_has_the_half_width_of_batch_means_and_of_the_unseen_drift() {
    // Six batches of two samples. The medians of their logarithms are 0, 1, 0, 1, 0, 1.
    let logs = [0.0, 1.0].repeat(3);
    let samples = logs.iter().flat_map(|log: &f64| [log.exp(), log.exp()]);
    let median = Median::from_samples(samples.clone()).expect("samples");
    let [low, high] = median.interval(Confidence::default()).expect("12 samples");
    // The standard error is √(6 · 0.25 / 5 / 6).
    let expected = (2.570_582 * 0.05_f64.sqrt()).hypot(1.959_964 * 0.01);
    assert!(((high / median.value).ln() - expected).abs() < 1e-6);
    assert!(((low / median.value).ln() + expected).abs() < 1e-6);
    let ratios = Median::from_ratios(samples)
        .and_then(|m| m.interval(Confidence::default()))
        .expect("12 samples");
    let expected = (2.570_582 * 0.05_f64.sqrt()).hypot(1.959_964 * 0.02_f64.sqrt() / 10.0);
    assert!(((ratios[1] / median.value).ln() - expected).abs() < 1e-6);
}

#[test]
fn intervals_grow_with_their_confidence() {
    let samples: Vec<f64> = (0..12).map(|i| 10.0 + f64::from(i % 5)).collect();
    let median = Median::from_samples(samples.iter().copied()).expect("samples");
    let pairs: Vec<[f64; 2]> = samples.iter().map(|ns| [2.0 * ns, *ns]).collect();
    let widths = |confidence: &str| {
        let confidence = confidence.parse().expect("allowed");
        let of_median = median.interval(confidence);
        let of_others = [
            difference(&pairs, confidence),
            quotient(&samples, &samples[..6], confidence),
            geometric_mean(&samples, confidence),
        ];
        let others = of_others.map(|found| found.and_then(|(_, interval)| interval));
        let all = [of_median, others[0], others[1], others[2]];
        all.map(|interval| {
            interval
                .map(|[low, high]| high - low)
                .expect("enough samples")
        })
    };
    let widths = ["50%", "80%", "95%", "99%", "99.9%"].map(widths);
    let is_wider = |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).all(|(a, b)| a < b);
    assert!(widths.is_sorted_by(is_wider), "{widths:?}");
}

#[test]
fn intervals_do_not_depend_on_the_unit_and_ignore_the_distance_of_outliers() {
    let samples: Vec<f64> = (0..12).map(|i| 10.0 + f64::from(i % 5)).collect();
    let of = |samples: &[f64]| Median::from_samples(samples.iter().copied()).expect("samples");
    let [low, high] = of(&samples)
        .interval(Confidence::default())
        .expect("12 samples");
    let scaled: Vec<f64> = samples.iter().map(|ns| 1e9 * ns).collect();
    let [scaled_low, scaled_high] = of(&scaled)
        .interval(Confidence::default())
        .expect("12 samples");
    assert!((scaled_low / low / 1e9 - 1.0).abs() < 1e-9);
    assert!((scaled_high / high / 1e9 - 1.0).abs() < 1e-9);
    let with_outlier = |ns: f64| {
        let mut samples = samples.clone();
        samples[4] = ns;
        of(&samples)
            .interval(Confidence::default())
            .expect("12 samples")
    };
    assert_eq!(with_outlier(1e3), with_outlier(1e6));
    assert_eq!(
        of(&[5.0; 4])
            .interval(Confidence::default())
            .map(|[low, high]| low < 5.0 && 5.0 < high),
        Some(true)
    );
    // A coarse clock may measure zero, and a ratio to zero is not finite.
    assert_eq!(of(&[0.0, 1.0, 2.0]).interval(Confidence::default()), None);
    assert_eq!(
        of(&[f64::INFINITY, 1.0, 2.0]).interval(Confidence::default()),
        None
    );
}

/// The intervals of means over few meshes contain the mean of all meshes in 95 % of the cases if the
/// logarithms are normal, and in nearly as many cases if a few meshes are much slower.
#[test]
fn intervals_of_geometric_means_contain_the_mean_of_all_meshes() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    // The logarithm of an exponential value is skewed. Its mean is minus Euler's constant.
    let exponential = |random: &mut ChaCha8Rng| -(1.0 - uniform(random)).ln();
    let euler = 0.577_215_664_901_532_9_f64;
    for count in [3, 4, 5, 6, 8, 12, 30] {
        let mut means = |value: &mut dyn FnMut(&mut ChaCha8Rng) -> f64, truth: f64| {
            let studies = 4000;
            let intervals: Vec<[f64; 2]> = (0..studies)
                .filter_map(|_| {
                    let values: Vec<f64> = (0..count).map(|_| value(&mut random)).collect();
                    geometric_mean(&values, Confidence::default())?.1
                })
                .collect();
            assert_eq!(intervals.len(), studies);
            coverage(&intervals, truth).0
        };
        let covered = means(&mut |random| normal(random, 0.5).exp(), 1.0);
        assert!((93.5..96.5).contains(&covered), "{count}: {covered} %");
        let covered = means(&mut |random| exponential(random), (-euler).exp());
        assert!(covered > 90.0, "{count} skewed: {covered} %");
    }
    assert_eq!(
        geometric_mean(&[2.0, 8.0], Confidence::default()),
        Some((4.0, None))
    );
}

#[test]
fn a_median_that_is_corrected_is_not_below_the_least_value() {
    let raw = Median::from_samples([3.0, 3.0, 4.0]).expect("samples");
    for (value, least) in [(2.999_999, 2.999_999), (3.5, 3.0)] {
        let moved = raw.moved_to(value);
        assert_eq!((moved.value, moved.least), (value, least));
    }
}

//! Tests of the changes between studies, on hand-made times and on simulated studies.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

use super::*;
use crate::launches::times_over_launches;
use crate::simulated::normal;

/// Number of rows of a simulated study.
const ROWS: usize = 40;
/// The level for each row, so that one of 200 comparisons finds a change by chance.
const LEVEL: f64 = 1.0 / 200.0 / (2 * ROWS) as f64;

type Launches = Vec<Vec<Option<f64>>>;

/// Returns the times of all rows in each launch of a study. All rows are slow in the same launches.
fn study(launches: usize, own: f64, common: f64, random: &mut ChaCha8Rng) -> Launches {
    let speeds: Vec<f64> = (0..launches).map(|_| normal(random, common)).collect();
    let row = |row: usize| {
        let ns = 100.0 * (row + 1) as f64;
        let time = |speed: &f64| Some(ns * (speed + normal(random, own)).exp());
        speeds.iter().map(time).collect()
    };
    (0..ROWS).map(row).collect()
}

fn changes(before: &Launches, after: &Launches) -> StudyChanges {
    let ns = |launches: &Vec<Option<f64>>| times_over_launches(&[launches])[0].unwrap_or(f64::NAN);
    let pairs = before.iter().zip(after).map(|(a, b)| LaunchPair {
        ns: [ns(a), ns(b)],
        launches: [a, b],
    });
    study_changes(&pairs.collect::<Vec<_>>(), false, Confidence::default())
}

/// Returns the numbers of the rows whose change is not due to chance.
fn found(changes: &StudyChanges) -> Vec<usize> {
    let beyond = |change: &Option<StudyChange>| (*change)?.beyond_chance(LEVEL, 1.05);
    let rows = changes.rows.iter().enumerate();
    rows.filter_map(|(row, change)| beyond(change).map(|_| row))
        .collect()
}

#[test]
fn one_of_200_comparisons_of_a_program_with_itself_finds_a_change() {
    const COMPARISONS: usize = 2000;
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut alarms = 0;
    for _ in 0..COMPARISONS {
        let [before, after] = [(); 2].map(|()| study(8, 0.04, 0.1, &mut random));
        alarms += usize::from(!found(&changes(&before, &after)).is_empty());
    }
    assert!(alarms <= COMPARISONS / 200, "{alarms} of {COMPARISONS}");
}

#[test]
fn a_slowdown_of_one_row_is_found_though_the_machine_is_unsteady() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let mut hits = 0;
    for row in 0..100 {
        let [before, mut after] = [(); 2].map(|()| study(15, 0.02, 0.05, &mut random));
        let slowed = row % ROWS;
        for ns in after[slowed].iter_mut().flatten() {
            *ns *= 1.1;
        }
        hits += usize::from(found(&changes(&before, &after)) == [slowed]);
    }
    assert!(hits >= 95, "{hits} of 100");
}

#[test]
fn few_launches_borrow_the_variance_of_the_other_rows() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let (mut hits, mut alarms) = (0, 0);
    for row in 0..100 {
        let [before, mut after] = [(); 2].map(|()| study(5, 0.03, 0.05, &mut random));
        let slowed = row % ROWS;
        for ns in after[slowed].iter_mut().flatten() {
            *ns *= 1.35;
        }
        let found = found(&changes(&before, &after));
        hits += usize::from(found.contains(&slowed));
        alarms += usize::from(found.iter().any(|row| *row != slowed));
    }
    assert!(hits >= 95 && alarms <= 1, "{hits} found, {alarms} alarms");
}

#[test]
fn a_machine_that_is_slower_as_a_whole_makes_no_row_slower_than_the_others() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let [before, mut after] = [(); 2].map(|()| study(15, 0.02, 0.001, &mut random));
    for ns in after.iter_mut().flatten().flatten() {
        *ns *= 1.25;
    }
    let changes = changes(&before, &after);
    assert!((changes.common.expect("enough rows") / 1.25 - 1.0).abs() < 0.02);
    assert_eq!(found(&changes), [0; 0]);
    for ns in after[7].iter_mut().flatten() {
        *ns *= 1.12;
    }
    assert_eq!(
        found(&self::changes(&before, &after)),
        [7],
        "all others changed alike"
    );
    // If the slow machine affects the rows differently, this one may be affected more than most.
    for (row, ns) in after.iter_mut().enumerate() {
        let affected = 1.0 + 0.03 * (row % 8) as f64;
        ns.iter_mut().flatten().for_each(|ns| *ns *= affected);
    }
    assert_eq!(found(&self::changes(&before, &after)), [0; 0]);
    let pairs = before.iter().zip(&after).map(|(a, b)| LaunchPair {
        ns: [1.0, 1.5],
        launches: [a, b],
    });
    let other_machine = study_changes(&pairs.collect::<Vec<_>>(), true, Confidence::default());
    assert!(found(&other_machine).contains(&7));
}

#[test]
fn few_rows_are_compared_without_the_others() {
    let pair = |factor: f64| {
        let before = [1.0, 1.01, 0.99, 1.0].map(Some);
        let after = before.map(|ns| ns.map(|ns| factor * ns));
        [before, after]
    };
    let change = |[before, after]: &[[Option<f64>; 4]; 2], ns: [f64; 2]| {
        let pair = LaunchPair {
            ns,
            launches: [before, after],
        };
        let changes = study_changes(&[pair], false, Confidence::default());
        assert_eq!(changes.common, None);
        changes.rows[0]
    };
    let slower = change(&pair(1.5), [1.0, 1.5]).expect("four launches");
    let [low, high] = slower.interval;
    assert!(1.4 < low && low < 1.5 && 1.5 < high && high < 1.6);
    assert_eq!(
        slower
            .beyond_chance(0.005, 1.05)
            .map(|ratio| (10.0 * ratio).round()),
        Some(15.0)
    );
    assert_eq!(slower.beyond_chance(0.005, 1.6), None, "it counts as equal");
    let same = change(&pair(1.0), [1.0, 1.0]).expect("four launches");
    assert_eq!(same.beyond_chance(0.005, 1.0), None);
    // The machine alone may be this much slower.
    assert!(same.detectable(0.005) > 1.02 * LASTING_SPEED);
    assert!(same.detectable(0.005) < 1.1 * LASTING_SPEED);
    assert!(same.detectable(0.0005) > same.detectable(0.005));
    // A single launch shows nothing.
    let one = [Some(1.0)];
    let pair = LaunchPair {
        ns: [1.0, 2.0],
        launches: [&one, &one],
    };
    assert_eq!(
        study_changes(&[pair], false, Confidence::default()).rows,
        [None]
    );
    assert_eq!(study_changes(&[], false, Confidence::default()).rows, []);
}

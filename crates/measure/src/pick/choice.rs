//! The choice of one backend from a ranking.

use sixfold_results::numbers::{list, times};
use sixfold_results::{Choice, EQUAL_UP_TO, PartCost, Ranked, TurningPoint};

/// Largest factor for which [`Choice::turning_point`] is looked for.
const LARGEST_FACTOR: f64 = 100.0;

/// The order of backends of equal speed and equal size. Other backends come after these.
const ORDER: [&str; 6] = [
    "polygon-soup",
    "indexed-face-set",
    "face-vertex",
    "corner-table",
    "half-edge",
    "winged-edge",
];

/// Chooses a backend from a ranking, the fastest first; `None` if no backend was measured.
pub(super) fn choose(ranking: &[Ranked]) -> Option<Choice> {
    // Without an interval, only the ratio counts: too few samples cannot show a difference.
    let equal = |r: &&Ranked| {
        let tied = r.tied_with_best && r.ci_low.is_some();
        !r.estimated && (r.ratio_to_best <= EQUAL_UP_TO || tied)
    };
    let chosen = ranking.iter().filter(equal).min_by_key(|r| size_order(r))?;
    let others = ranking.iter().filter(equal);
    let others = others.filter(|r| r.backend != chosen.backend);
    let slower = ranking.iter().filter(|r| !equal(r) && !r.estimated);
    let turning_points = slower.filter_map(|r| turning_point(chosen, r));
    Some(Choice {
        backend: chosen.backend.clone(),
        equally_fast: others.map(|r| r.backend.clone()).collect(),
        turning_point: turning_points.min_by(|a, b| a.factor.total_cmp(&b.factor)),
    })
}

/// Returns the key of the rule for backends of equal speed.
fn size_order(ranked: &Ranked) -> (usize, usize) {
    (ranked.bytes, position(&ranked.backend))
}

/// Returns the position of a backend in the order for backends of equal speed and size.
pub fn position(name: &str) -> usize {
    let position = ORDER.iter().position(|&known| known == name);
    position.unwrap_or(ORDER.len())
}

/// Returns the smallest factor by which the weight of one part must grow until `other` is as fast
/// as `chosen`.
fn turning_point(chosen: &Ranked, other: &Ranked) -> Option<TurningPoint> {
    let behind = other.ns_per_operation - chosen.ns_per_operation;
    let pairs = chosen.parts.iter().zip(&other.parts);
    let points = pairs.filter_map(|(own, theirs): (&PartCost, &PartCost)| {
        own.ns?;
        theirs.ns?;
        let gain = own.weighted_ns() - theirs.weighted_ns();
        let factor = 1.0 + behind / gain;
        (gain > 0.0 && factor <= LARGEST_FACTOR).then(|| TurningPoint {
            operation: own.operation.clone(),
            factor,
            backend: other.backend.clone(),
        })
    });
    points.min_by(|a, b| a.factor.total_cmp(&b.factor))
}

/// Returns the rule that decided between equally fast backends, as a sentence; `None` if no
/// other backend is as fast.
pub(super) fn rule(choice: &Choice, ranking: &[Ranked]) -> Option<String> {
    let bytes = |name: &str| {
        let row = ranking.iter().find(|row| row.backend == name)?;
        Some((row.bytes, row.bytes_per_vertex))
    };
    if choice.equally_fast.is_empty() {
        return None;
    }
    let (own, per_vertex) = bytes(&choice.backend)?;
    let same_size = choice
        .equally_fast
        .iter()
        .any(|name| bytes(name).is_some_and(|(b, _)| b == own));
    let reason = match same_size {
        true => "is the simplest of the backends with the fewest bytes",
        false => "has the fewest bytes",
    };
    Some(format!(
        "Choose {}: none of {} is clearly more than 5 % slower than the fastest, and {} \
         {reason} ({per_vertex:.1} per vertex).",
        choice.backend,
        list(std::iter::once(&choice.backend).chain(&choice.equally_fast)),
        choice.backend,
    ))
}

/// Returns what would change the choice, as a sentence.
pub(super) fn what_would_change(choice: &Choice) -> String {
    match &choice.turning_point {
        Some(point) => format!(
            "{} would be as fast as {} if the weight of {} in the mix were {} its present \
             weight.",
            point.backend,
            choice.backend,
            point.operation,
            times(point.factor)
        ),
        None => format!(
            "{} stays ahead of the slower backends even if any one operation of the mix has 100 \
             times its weight.",
            choice.backend
        ),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use crate::Operation;

    use super::*;

    pub(in crate::pick) fn ranked(
        backend: &str,
        ratio: f64,
        tied: bool,
        bytes: usize,
        parts: [f64; 2],
    ) -> Ranked {
        let part = |operation: Operation, ns| PartCost {
            operation: operation.name().into(),
            share: 0.5,
            ns: Some(ns),
            launch_ns: Vec::new(),
            estimated: false,
        };
        Ranked {
            backend: backend.into(),
            made_from: None,
            ns_per_operation: 0.5 * (parts[0] + parts[1]),
            launch_ns: Vec::new(),
            ns_ci_low: None,
            ns_ci_high: None,
            ratio_to_best: ratio,
            ci_low: tied.then_some(0.9 * ratio),
            ci_high: tied.then_some(1.1 * ratio),
            tied_with_best: tied,
            build_ns: 1.0,
            build_launch_ns: Vec::new(),
            first_build_ns: None,
            bytes,
            bytes_per_vertex: bytes as f64,
            sampled: false,
            estimated: false,
            parts: vec![
                part(Operation::Boundary, parts[0]),
                part(Operation::EdgeLength, parts[1]),
            ],
            samples: 10,
            warm_up_only: false,
            faults: None,
            result: None,
            elements: None,
            types: Vec::new(),
            tabulated: Vec::new(),
        }
    }

    #[test]
    fn equally_fast_backends_are_chosen_by_size_and_then_by_order() {
        let ranking = [
            ranked("half-edge", 1.0, true, 96, [10.0, 10.0]),
            ranked("winged-edge", 1.04, false, 80, [10.0, 10.8]),
            ranked("corner-table", 1.2, true, 80, [12.0, 12.0]),
            ranked("face-vertex", 1.06, false, 60, [10.0, 11.2]),
        ];
        let choice = choose(&ranking).expect("not empty");
        assert_eq!(choice.backend, "corner-table");
        assert_eq!(choice.equally_fast, ["half-edge", "winged-edge"]);
        let text = rule(&choice, &ranking).expect("two others");
        assert!(text.contains("simplest of the backends"), "{text}");
        assert_eq!(choose(&[]), None);
        // Too few samples for an interval: only the ratio counts.
        let mut few = ranking.clone();
        few[2].ci_low = None;
        let choice = choose(&few).expect("not empty");
        assert_eq!(choice.backend, "winged-edge");
        let alone = choose(&ranking[..1]).expect("one");
        assert_eq!(rule(&alone, &ranking[..1]), None);
    }

    #[test]
    fn a_lower_bound_is_never_chosen() {
        let bound = Ranked {
            estimated: true,
            ..ranked("polygon-soup", 0.2, false, 8, [1.0, 1.0])
        };
        let measured = ranked("half-edge", 1.0, true, 96, [10.0, 10.0]);
        let choice = choose(&[measured, bound.clone()]).expect("one is measured");
        assert_eq!(choice.backend, "half-edge");
        assert_eq!((choice.equally_fast.len(), choice.turning_point), (0, None));
        assert_eq!(choose(&[bound]), None);
    }

    #[test]
    fn the_turning_point_makes_both_times_equal() {
        let ranking = [
            ranked("half-edge", 1.0, true, 96, [10.0, 10.0]),
            ranked("corner-table", 1.4, false, 64, [6.0, 22.0]),
        ];
        let choice = choose(&ranking).expect("not empty");
        let point = choice
            .turning_point
            .clone()
            .expect("it is faster in one part");
        assert_eq!(
            (point.operation.as_str(), point.backend.as_str()),
            ("boundary", "corner-table")
        );
        // 10 k + 10 = 6 k + 22 at k = 3.
        assert!((point.factor - 3.0).abs() < 1e-9, "{point:?}");
        assert!(
            what_would_change(&choice)
                .contains("if the weight of boundary in the mix were 3.00 × its present weight"),
            "{}",
            what_would_change(&choice)
        );
        let never = [
            ranked("half-edge", 1.0, true, 96, [10.0, 10.0]),
            ranked("corner-table", 1.4, false, 64, [9.99, 1000.0]),
        ];
        let choice = choose(&never).expect("not empty");
        assert_eq!(choice.turning_point, None);
    }
}

//! Effects of the element order and of the structure on times, as ratios with confidence intervals.

use sixfold::shapes::Order;

use sixfold_measure::Operation;
use sixfold_results::launches::ratio_over_launches;
use sixfold_results::ranking::quotient;
use sixfold_results::{Comparison, Confidence, Factor, Larger, OrderEffect, StructureEffect, Time};

/// The time of one operation on one structure in one order.
pub(super) struct OrderTime<'t> {
    pub(super) backend: &'t str,
    pub(super) order: Order,
    /// Whether the structure scans all faces for each element.
    pub(super) scans: bool,
    pub(super) values: Values<'t>,
    /// The corrected time; `None` without values.
    pub(super) ns: Option<f64>,
}

/// What the ratio of two times is formed from.
pub(super) enum Values<'t> {
    /// The samples of one launch, with their rounds.
    Rounds(Vec<(u32, Time)>),
    /// The time in each launch.
    Launches(&'t [Option<f64>]),
}

/// Returns the quotient of two times; `None` if one is unknown.
fn factor(slow: &OrderTime<'_>, fast: &OrderTime<'_>, confidence: Confidence) -> Option<Factor> {
    let times = [slow.ns?, fast.ns?];
    let ratio = match (&slow.values, &fast.values) {
        (Values::Rounds(slow), Values::Rounds(fast)) => quotient([slow, fast], times)?,
        (Values::Launches(slow), Values::Launches(fast)) => {
            ratio_over_launches(times, [slow, fast])?
        }
        _ => return None,
    };
    let interval = ratio.interval(confidence);
    Some(Factor {
        ratio: ratio.value,
        ci_low: interval.map(|[low, _]| low),
        ci_high: interval.map(|[_, high]| high),
    })
}

/// Compares the orders and the structures in one operation.
pub(super) fn comparison(
    operation: Operation,
    timed: &[OrderTime<'_>],
    noise: f64,
    confidence: Confidence,
) -> Comparison {
    let same_backend = |a: &OrderTime<'_>, b: &OrderTime<'_>| a.backend == b.backend;
    let by_backend = || timed.chunk_by(same_backend);
    let orders: Vec<OrderEffect> = by_backend()
        .filter_map(|orders| order_effect(orders, noise, confidence))
        .collect();
    let local = by_backend().filter(|orders| !orders[0].scans);
    let best: Vec<&OrderTime<'_>> = local
        .filter_map(|orders| Some(extremes(orders)?.0))
        .collect();
    let structures = structure_effect(&best, noise, confidence);
    let larger = structures.as_ref().and_then(|between| {
        let local = orders.iter().filter(|effect| !effect.scans);
        let factors: Vec<Factor> = local.map(|effect| effect.worst_to_best).collect();
        larger(&factors, &between.slowest_to_fastest)
    });
    Comparison {
        operation: operation.name().into(),
        noise,
        orders,
        structures,
        larger,
    }
}

/// Returns the smallest and the largest time.
fn extremes<'t, 'v: 't>(
    timed: impl IntoIterator<Item = &'t OrderTime<'v>>,
) -> Option<(&'t OrderTime<'v>, &'t OrderTime<'v>)> {
    let measured = timed.into_iter().filter_map(|t| Some((t.ns?, t)));
    let mut sorted: Vec<(f64, &OrderTime<'_>)> = measured.collect();
    sorted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    Some((sorted.first()?.1, sorted.last()?.1))
}

fn order_effect(
    orders: &[OrderTime<'_>],
    noise: f64,
    confidence: Confidence,
) -> Option<OrderEffect> {
    let (best, worst) = extremes(orders)?;
    if orders.iter().filter(|t| t.ns.is_some()).count() < 2 {
        return None;
    }
    let worst_to_best = factor(worst, best, confidence)?;
    let given = orders.iter().find(|t| t.order == Order::Given);
    Some(OrderEffect {
        backend: best.backend.into(),
        scans: best.scans,
        best: best.order.to_string(),
        worst: worst.order.to_string(),
        worst_to_best,
        given_to_best: given.and_then(|given| factor(given, best, confidence)),
        matters: worst_to_best.is_beyond(noise),
    })
}

fn structure_effect(
    best: &[&OrderTime<'_>],
    noise: f64,
    confidence: Confidence,
) -> Option<StructureEffect> {
    let (fastest, slowest) = extremes(best.iter().copied())?;
    if best.len() < 2 {
        return None;
    }
    let slowest_to_fastest = factor(slowest, fastest, confidence)?;
    Some(StructureEffect {
        fastest: fastest.backend.into(),
        fastest_order: fastest.order.to_string(),
        slowest: slowest.backend.into(),
        slowest_order: slowest.order.to_string(),
        slowest_to_fastest,
        matters: slowest_to_fastest.is_beyond(noise),
    })
}

/// Returns the larger effect according to the intervals; `None` if `orders` is empty.
fn larger(orders: &[Factor], structures: &Factor) -> Option<Larger> {
    if orders.is_empty() {
        return None;
    }
    let above = |order: &Factor| order.low() > structures.high();
    let below = |order: &Factor| order.high() < structures.low();
    Some(if orders.iter().all(above) {
        Larger::Order
    } else if orders.iter().all(below) {
        Larger::Structure
    } else {
        Larger::Depends
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timed(backend: &'static str, order: Order, ns: f64, scans: bool) -> OrderTime<'static> {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let time = |drift: f64| Time {
            cpu_ns: Some(ns * drift),
            wall_ns: ns * drift,
            faults: None,
        };
        OrderTime {
            backend,
            order,
            scans,
            values: Values::Rounds((0..).zip(drift.map(time)).collect()),
            ns: Some(ns * 2.0), // the median of the drift
        }
    }

    fn compared(times: &[(&'static str, [f64; 2], bool)]) -> Comparison {
        let timed = times
            .iter()
            .flat_map(|&(backend, [given, shuffled], scans)| {
                [
                    timed(backend, Order::Given, given, scans),
                    timed(backend, Order::Shuffled, shuffled, scans),
                ]
            });
        let timed: Vec<OrderTime<'_>> = timed.collect();
        comparison(Operation::Boundary, &timed, 1.02, Confidence::default())
    }

    #[test]
    fn orders_are_compared_within_a_structure_and_structures_in_their_best_order() {
        let all = compared(&[
            ("scan", [500.0, 505.0], true),
            ("a", [10.0, 40.0], false),
            ("b", [30.0, 15.0], false),
        ]);
        let ratios: Vec<f64> = all.orders.iter().map(|o| o.worst_to_best.ratio).collect();
        for (ratio, expected) in ratios.iter().zip([1.01, 4.0, 2.0]) {
            assert!((ratio - expected).abs() < 1e-9, "{ratios:?}");
        }
        let given: Vec<f64> = all
            .orders
            .iter()
            .filter_map(|o| Some(o.given_to_best?.ratio))
            .collect();
        assert!(
            (given[2] - 2.0).abs() < 1e-9 && given[1] == 1.0,
            "{given:?}"
        );
        let matters: Vec<bool> = all.orders.iter().map(|o| o.matters).collect();
        assert_eq!(matters, [false, true, true]);
        assert_eq!(
            (&*all.orders[2].best, &*all.orders[2].worst),
            (Order::Shuffled.name(), Order::Given.name())
        );
        let between = all.structures.expect("two that do not scan");
        assert_eq!(
            (between.fastest.as_str(), between.slowest.as_str()),
            ("a", "b")
        );
        assert_eq!(between.slowest_order, Order::Shuffled.name());
        assert!((between.slowest_to_fastest.ratio - 1.5).abs() < 1e-9);
        assert_eq!(all.larger, Some(Larger::Order));
    }

    #[test]
    fn the_larger_effect_is_named_only_if_the_intervals_are_apart() {
        let larger =
            |a: [f64; 2], b: [f64; 2]| compared(&[("a", a, false), ("b", b, false)]).larger;
        assert_eq!(larger([10.0, 11.0], [30.0, 31.0]), Some(Larger::Structure));
        assert_eq!(larger([10.0, 50.0], [30.0, 31.0]), Some(Larger::Depends));
        assert_eq!(larger([10.0, 50.0], [11.0, 44.0]), Some(Larger::Order));
        assert_eq!(compared(&[("a", [1.0, 2.0], false)]).larger, None);
        let beside_scan = compared(&[("a", [1.0, 2.0], false), ("s", [9.0, 9.0], true)]);
        assert_eq!((beside_scan.structures, beside_scan.larger), (None, None));
        assert_eq!(beside_scan.orders.len(), 2);
    }

    #[test]
    fn few_samples_show_no_difference() {
        let mut a = [
            timed("a", Order::Given, 10.0, false),
            timed("a", Order::Morton, 14.0, false),
        ];
        for time in &mut a {
            let Values::Rounds(rounds) = &mut time.values else {
                panic!("samples")
            };
            rounds.truncate(2);
        }
        let effect = order_effect(&a, 1.02, Confidence::default()).expect("two orders");
        assert_eq!(effect.worst_to_best.ci_low, None);
        assert!(!effect.matters, "{effect:?}");
        a[1].ns = None;
        assert_eq!(super::order_effect(&a, 1.02, Confidence::default()), None);
    }

    #[test]
    fn times_over_launches_are_compared_within_launches() {
        let launches = [[10.0, 20.0, 15.0], [15.0, 30.0, 22.6]].map(|times| times.map(Some));
        let time = |i: usize, order| OrderTime {
            backend: "a",
            order,
            scans: false,
            values: Values::Launches(&launches[i]),
            ns: Some([14.4, 21.6][i]),
        };
        let both = [time(0, Order::Given), time(1, Order::Shuffled)];
        let effect = order_effect(&both, 1.02, Confidence::default()).expect("two orders");
        let Factor { ratio, ci_low, .. } = effect.worst_to_best;
        assert!((ratio - 1.5).abs() < 1e-9 && effect.matters, "{effect:?}");
        assert!(
            ci_low.is_some_and(|low| (1.4..1.5).contains(&low)),
            "{effect:?}"
        );
        let other = timed("a", Order::Morton, 10.0, false);
        assert_eq!(factor(&both[0], &other, Confidence::default()), None);
    }
}

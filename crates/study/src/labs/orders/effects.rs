//! Effects of the element order and of the structure on times, as ratios with confidence intervals.

use serde::{Deserialize, Serialize};
use sixfold::shapes::Order;

use crate::engine::ranking::quotient;
use sixfold_workload::{Operation, Time};

/// Assumed error factor of a ratio without an interval.
const ASSUMED_ERROR: f64 = 1.5;

pub(super) struct OrderSamples {
    pub(super) backend: &'static str,
    pub(super) order: Order,
    /// Whether the structure scans all faces for each element.
    pub(super) scans: bool,
    pub(super) samples: Vec<(u32, Time)>,
    /// The corrected time; `None` without samples.
    pub(super) ns: Option<f64>,
}

/// The time of one measurement divided by the time of another measurement, with a 95 % confidence
/// interval.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Factor {
    /// The quotient of the two times.
    pub ratio: f64,
    /// Lower end of the 95 % confidence interval of `ratio`; `None` with fewer than three rounds.
    pub ci_low: Option<f64>,
    /// Upper end of the 95 % confidence interval of `ratio`.
    pub ci_high: Option<f64>,
}

impl Factor {
    fn new(slow: &OrderSamples, fast: &OrderSamples) -> Option<Self> {
        let ratio = quotient([&slow.samples, &fast.samples], [slow.ns?, fast.ns?])?;
        Some(Self {
            ratio: ratio.value,
            ci_low: ratio.interval.map(|[low, _]| low),
            ci_high: ratio.interval.map(|[_, high]| high),
        })
    }

    /// Returns whether the ratio is larger than the noise and its interval lies above 1.
    fn beyond(&self, noise: f64) -> bool {
        self.ratio > noise && self.low() > 1.0
    }

    fn low(&self) -> f64 {
        self.ci_low.unwrap_or(self.ratio / ASSUMED_ERROR)
    }

    fn high(&self) -> f64 {
        self.ci_high.unwrap_or(self.ratio * ASSUMED_ERROR)
    }
}

/// The effect of the element order on the time of one operation on one structure.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct OrderEffect {
    /// The name of the structure.
    pub backend: String,
    /// True if the operation scans all faces of the mesh for each element on this structure.
    pub scans: bool,
    /// The order with the smallest time.
    pub best: Order,
    /// The order with the largest time.
    pub worst: Order,
    /// Time in the order `worst` divided by the time in the order `best`.
    pub worst_to_best: Factor,
    /// Time in the original order of the mesh divided by the time in the order `best`. `None` if
    /// the original order was not measured.
    pub given_to_best: Option<Factor>,
    /// True if `worst_to_best` is larger than the noise, and the confidence interval of
    /// `worst_to_best` lies above 1.
    pub matters: bool,
}

/// The effect of the structure on the time of one operation. For each structure, the time in the
/// fastest order of this structure counts. Structures that scan all faces for each element are left
/// out.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct StructureEffect {
    /// The name of the structure with the smallest time.
    pub fastest: String,
    /// The order with the smallest time on the fastest structure.
    pub fastest_order: Order,
    /// The name of the structure with the largest time.
    pub slowest: String,
    /// The order with the smallest time on the slowest structure.
    pub slowest_order: Order,
    /// Time of the slowest structure divided by the time of the fastest structure.
    pub slowest_to_fastest: Factor,
    /// True if `slowest_to_fastest` is larger than the noise, and the confidence interval of
    /// `slowest_to_fastest` lies above 1.
    pub matters: bool,
}

/// Whether the element order or the structure has the larger effect on a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Larger {
    /// The order of the elements has a larger effect than the choice of the structure, for every
    /// structure that does not scan all faces.
    Order,
    /// The choice of the structure has a larger effect than the order of the elements, for every
    /// structure that does not scan all faces.
    Structure,
    /// The order has the larger effect only for some structures, or the confidence intervals
    /// overlap.
    Depends,
}

/// The effects of the element order and of the structure on the time of one operation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Comparison {
    /// The measured operation, such as `vertex_normal`.
    pub operation: Operation,
    /// Ratios of times up to this value count as noise.
    pub noise: f64,
    /// Effect of the order on each structure that was measured in at least two orders.
    pub orders: Vec<OrderEffect>,
    /// Effect of the structure; `None` if fewer than two structures do the operation without
    /// scanning all faces.
    pub structures: Option<StructureEffect>,
    /// The larger effect; `None` if an effect is unknown.
    pub larger: Option<Larger>,
}

impl Comparison {
    pub(super) fn new(operation: Operation, timed: &[OrderSamples], noise: f64) -> Self {
        let same_backend = |a: &OrderSamples, b: &OrderSamples| a.backend == b.backend;
        let by_backend = || timed.chunk_by(same_backend);
        let orders: Vec<OrderEffect> = by_backend()
            .filter_map(|orders| order_effect(orders, noise))
            .collect();
        let local = by_backend().filter(|orders| !orders[0].scans);
        let best: Vec<&OrderSamples> = local
            .filter_map(|orders| Some(extremes(orders)?.0))
            .collect();
        let structures = structure_effect(&best, noise);
        let larger = structures.as_ref().and_then(|between| {
            let local = orders.iter().filter(|effect| !effect.scans);
            let factors: Vec<Factor> = local.map(|effect| effect.worst_to_best).collect();
            larger(&factors, &between.slowest_to_fastest)
        });
        Self {
            operation,
            noise,
            orders,
            structures,
            larger,
        }
    }
}

/// Returns the samples with the smallest and the largest time.
fn extremes<'t>(
    timed: impl IntoIterator<Item = &'t OrderSamples>,
) -> Option<(&'t OrderSamples, &'t OrderSamples)> {
    let measured = timed.into_iter().filter_map(|t| Some((t.ns?, t)));
    let mut sorted: Vec<(f64, &OrderSamples)> = measured.collect();
    sorted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    Some((sorted.first()?.1, sorted.last()?.1))
}

fn order_effect(orders: &[OrderSamples], noise: f64) -> Option<OrderEffect> {
    let (best, worst) = extremes(orders)?;
    if orders.iter().filter(|t| !t.samples.is_empty()).count() < 2 {
        return None;
    }
    let worst_to_best = Factor::new(worst, best)?;
    let given = orders.iter().find(|t| t.order == Order::Given);
    Some(OrderEffect {
        backend: best.backend.into(),
        scans: best.scans,
        best: best.order,
        worst: worst.order,
        worst_to_best,
        given_to_best: given.and_then(|given| Factor::new(given, best)),
        matters: worst_to_best.beyond(noise),
    })
}

fn structure_effect(best: &[&OrderSamples], noise: f64) -> Option<StructureEffect> {
    let (fastest, slowest) = extremes(best.iter().copied())?;
    if best.len() < 2 {
        return None;
    }
    let slowest_to_fastest = Factor::new(slowest, fastest)?;
    Some(StructureEffect {
        fastest: fastest.backend.into(),
        fastest_order: fastest.order,
        slowest: slowest.backend.into(),
        slowest_order: slowest.order,
        slowest_to_fastest,
        matters: slowest_to_fastest.beyond(noise),
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

    fn timed(backend: &'static str, order: Order, ns: f64, scans: bool) -> OrderSamples {
        let drift = [1.0, 3.0, 2.0, 1.5, 5.0, 2.5, 1.1];
        let time = |drift: f64| Time {
            cpu_ns: Some(ns * drift),
            wall_ns: ns * drift,
            faults: None,
        };
        OrderSamples {
            backend,
            order,
            scans,
            samples: (0..).zip(drift.map(time)).collect(),
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
        let timed: Vec<OrderSamples> = timed.collect();
        Comparison::new(Operation::Boundary, &timed, 1.02)
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
            (all.orders[2].best, all.orders[2].worst),
            (Order::Shuffled, Order::Given)
        );
        let between = all.structures.expect("two that do not scan");
        assert_eq!(
            (between.fastest.as_str(), between.slowest.as_str()),
            ("a", "b")
        );
        assert_eq!(between.slowest_order, Order::Shuffled);
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
        a.iter_mut().for_each(|t| t.samples.truncate(2));
        let effect = order_effect(&a, 1.02).expect("two orders");
        assert_eq!(effect.worst_to_best.ci_low, None);
        assert!(!effect.matters, "{effect:?}");
        a[1].samples.clear();
        a[1].ns = None;
        assert_eq!(super::order_effect(&a, 1.02), None);
    }
}

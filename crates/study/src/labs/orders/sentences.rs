//! Sentences about the results of one mesh in several orders.

use sixfold::shapes::Order;

use super::{Comparison, Larger, OrderEffect, OrderRow};
use crate::numbers::times;
use crate::results::rows::{Agreement, Control, Standing};

pub(super) fn sentences(
    rows: &[OrderRow],
    comparisons: &[Comparison],
    control: Option<&Control>,
) -> Vec<String> {
    let mut sentences = Vec::new();
    sentences.extend(best_orders(rows));
    sentences.extend(given_order(comparisons));
    sentences.extend(comparisons.iter().filter_map(effects));
    sentences.extend(scan_effect(comparisons));
    sentences.extend(verdict(comparisons));
    sentences.extend(control.map(|control| {
        let percent = |ratio: f64| format!("{:.1} %", 100.0 * (ratio - 1.0));
        format!(
            "Noise: {} in the given order was measured twice. Its two times differ by {} (median \
             over the operations), and by at most {}. Two results are tied if they differ by no \
             more than the noise of the operation. With one or two samples, they are tied if the \
             longer time is less than 2 × the shorter time.",
            control.backend,
            percent(control.typical),
            percent(control.worst),
        )
    }));
    for OrderRow { order, row } in rows {
        if row.agreement == Agreement::Mismatch {
            let (backend, operation) = (&row.backend, row.operation);
            sentences.push(format!(
                "{operation} on {backend} gives different results in the order {order}. This is a \
                 fault in Sixfold: please report it."
            ));
        }
    }
    sentences
}

/// Counts for each order how often it is the best order or tied with the best.
fn best_orders(rows: &[OrderRow]) -> Option<String> {
    let pairs =
        rows.chunk_by(|a, b| a.row.operation == b.row.operation && a.row.backend == b.row.backend);
    let pairs: Vec<&[OrderRow]> = pairs
        .filter(|pair| pair.iter().filter(|r| r.row.standing.is_some()).count() > 1)
        .collect();
    if pairs.is_empty() {
        return None;
    }
    let counts = Order::ALL.map(|order| {
        let with = |wanted: Standing| {
            let has_standing =
                |row: &OrderRow| row.order == order && row.row.standing == Some(wanted);
            pairs
                .iter()
                .filter(|pair| pair.iter().any(has_standing))
                .count()
        };
        (order, with(Standing::Best), with(Standing::Tied))
    });
    let mut sorted = counts.to_vec();
    sorted.sort_by_key(|&(_, best, tied)| std::cmp::Reverse((best + tied, best)));
    let parts: Vec<String> = sorted
        .iter()
        .map(|(order, best, tied)| {
            format!("{order} is the single best order in {best} and tied for the best in {tied}")
        })
        .collect();
    Some(format!(
        "Of {} pairs of a structure and an operation, {}.",
        pairs.len(),
        parts.join("; ")
    ))
}

fn given_order(comparisons: &[Comparison]) -> Option<String> {
    let effects = comparisons
        .iter()
        .flat_map(|comparison| comparison.orders.iter().map(move |o| (comparison, o)));
    let given: Vec<(f64, &Comparison, &OrderEffect)> = effects
        .filter_map(|(comparison, effect)| Some((effect.given_to_best?.ratio, comparison, effect)))
        .collect();
    let (most, comparison, effect) = given.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let within_noise = given
        .iter()
        .filter(|(ratio, c, _)| *ratio <= c.noise)
        .count();
    let all = given.len();
    if within_noise == all {
        return Some(
            "In all pairs of a structure and an operation, the given order is as fast as the best \
             order, within the noise."
                .into(),
        );
    }
    Some(format!(
        "In {within_noise} of {all} pairs of a structure and an operation, the given order is as \
         fast as the best order, within the noise. In the worst case ({} on {}), the given order \
         takes {} the time of the best order ({}).",
        comparison.operation,
        effect.backend,
        times(*most),
        effect.best,
    ))
}

/// Describes the effects of order and structure on one operation.
fn effects(comparison: &Comparison) -> Option<String> {
    let local = || comparison.orders.iter().filter(|effect| !effect.scans);
    let ratio = |effect: &&OrderEffect| effect.worst_to_best.ratio;
    let least = local().min_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
    let most = local().max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
    let describe = |effect: &OrderEffect| match effect.matters {
        true => format!("{} ({})", times(effect.worst_to_best.ratio), effect.backend),
        false => format!("within the noise ({})", effect.backend),
    };
    let operation = comparison.operation;
    let orders = match local().count() {
        _ if !most.matters => format!(
            "{operation}: the order makes no measurable difference on the structures that do not \
             scan all faces"
        ),
        1 => format!(
            "{operation}: time of the worst order relative to the best order: {}",
            describe(most)
        ),
        _ => format!(
            "{operation}: time of the worst order relative to the best order: {} to {}",
            describe(least),
            describe(most)
        ),
    };
    let Some(structures) = &comparison.structures else {
        return Some(format!("{orders}."));
    };
    let between = match structures.matters {
        true => format!(
            "Among the structures that do not scan all faces, each in its best order, the slowest \
             ({}) takes {} the time of the fastest ({})",
            structures.slowest,
            times(structures.slowest_to_fastest.ratio),
            structures.fastest
        ),
        false => {
            "The times of the structures that do not scan all faces, each in its best order, are \
             equal within the noise"
                .into()
        }
    };
    let larger = match comparison.larger? {
        Larger::Order => "The effect of the order is larger",
        Larger::Structure => "The effect of the structure is larger",
        Larger::Depends => "The larger effect depends on the structure, or is uncertain",
    };
    Some(format!("{orders}. {between}. {larger}."))
}

/// Describes the effect of the order on structures that scan.
fn scan_effect(comparisons: &[Comparison]) -> Option<String> {
    let scans = comparisons.iter().flat_map(|comparison| {
        let scans = comparison.orders.iter().filter(|effect| effect.scans);
        scans.map(move |effect| (comparison.operation, effect))
    });
    let (operation, most) = scans.max_by(|(_, a), (_, b)| {
        let (a, b) = (a.worst_to_best.ratio, b.worst_to_best.ratio);
        a.total_cmp(&b)
    })?;
    Some(match most.matters {
        true => format!(
            "On structures that scan all faces for each element, the worst order takes at most {} \
             the time of the best order ({operation} on {}).",
            times(most.worst_to_best.ratio),
            most.backend
        ),
        false => "On structures that scan all faces for each element, all orders are equally \
                  fast, within the noise."
            .into(),
    })
}

fn verdict(comparisons: &[Comparison]) -> Option<String> {
    let known: Vec<Larger> = comparisons.iter().filter_map(|c| c.larger).collect();
    let count = |larger: Larger| known.iter().filter(|&&l| l == larger).count();
    let (order, structure) = (count(Larger::Order), count(Larger::Structure));
    (known.len() > 1).then(|| {
        format!(
            "Overall, {} operations were compared. The effect of the order is larger in {order} \
             operations, and the effect of the structure is larger in {structure}. In {} \
             operations, the larger effect depends on the structure, or is uncertain.",
            known.len(),
            count(Larger::Depends)
        )
    })
}

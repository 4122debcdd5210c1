//! Sentences about the results of one mesh in several orders.

use std::cmp::Reverse;

use sixfold::shapes::Order;

use sixfold_results::numbers::{counted, shown_ratio, times};
use sixfold_results::{
    Agreement, Comparison, Control, Larger, ResultRow, Standing, describe_noise,
};

/// The results of one operation on one structure in all orders.
type Pair<'r> = &'r [ResultRow];

/// Returns at most six sentences, the most useful first.
pub(super) fn sentences(
    rows: &[ResultRow],
    comparisons: &[Comparison],
    control: Option<&Control>,
) -> Vec<String> {
    let pairs = rows.chunk_by(|a, b| a.operation == b.operation && a.backend == b.backend);
    let (decided, undecided): (Vec<Pair<'_>>, Vec<Pair<'_>>) = pairs
        .filter(|pair| pair.iter().filter(|r| r.median_ns.is_some()).count() > 1)
        .partition(|pair| pair.iter().any(ResultRow::is_fastest));
    let times = Times(rows);
    let sentences = [
        given_order(&decided),
        best_orders(&decided, undecided.len()),
        effects(comparisons, &times),
        verdict(comparisons),
        scan_effect(comparisons, &times),
        control.and_then(how_sure),
    ];
    sentences.into_iter().flatten().collect()
}

/// Returns a warning for each result that differs from the results of the other orders.
pub(super) fn mismatches(rows: &[ResultRow]) -> impl Iterator<Item = String> {
    let wrong = rows
        .iter()
        .filter(|row| row.agreement == Agreement::Mismatch);
    wrong.map(|row| {
        format!(
            "{} on {} gives different results in the order {}. This is a fault in Sixfold: please \
             report it.",
            row.operation, row.backend, row.case
        )
    })
}

/// The times per element, as the table shows them.
struct Times<'r>(&'r [ResultRow]);

impl Times<'_> {
    /// Returns the quotient of the shown times of two structures, each in an order.
    fn ratio(&self, operation: &str, [a, b]: [(&str, &str); 2]) -> Option<f64> {
        let time = |(backend, order): (&str, &str)| {
            let mut rows = self.0.iter();
            let row =
                rows.find(|r| r.case == order && r.operation == operation && r.backend == backend);
            row?.ns_per_element
        };
        Some(shown_ratio(time(a)?, time(b)?))
    }
}

/// Says whether sorting the elements would make the mesh faster than it is in the given order.
fn given_order(pairs: &[Pair<'_>]) -> Option<String> {
    let given: Vec<(&ResultRow, Pair<'_>)> = pairs
        .iter()
        .filter_map(|pair| {
            let mut rows = pair.iter();
            Some((rows.find(|row| row.case == Order::Given.name())?, *pair))
        })
        .collect();
    let slower = given
        .iter()
        .filter(|(row, _)| row.standing == Some(Standing::Slower));
    let ratio = |row: &ResultRow| row.ratio_to_best.unwrap_or(1.0);
    let worst = slower
        .clone()
        .max_by(|(a, _), (b, _)| ratio(a).total_cmp(&ratio(b)));
    let (equal, all) = (given.len() - slower.count(), given.len());
    if all == 0 {
        return None;
    }
    let lead = format!(
        "The given order is the best order, or has no clear difference to it, in {equal} of {} of a \
         structure and an operation",
        counted(all, "pair", "pairs")
    );
    let Some((row, pair)) = worst else {
        return Some(format!("{lead}."));
    };
    let time = |row: &&ResultRow| row.median_ns.unwrap_or(f64::INFINITY);
    let best = pair.iter().min_by(|a, b| time(a).total_cmp(&time(b)))?;
    let ratio = shown_ratio(row.ns_per_element?, best.ns_per_element?);
    Some(format!(
        "{lead}; at worst ({} on {}), it takes {} the time of the order {}.",
        row.operation,
        row.backend,
        times(ratio),
        best.case,
    ))
}

/// Counts for each order how often it is the best order, or has no clear difference to the best.
fn best_orders(pairs: &[Pair<'_>], undecided: usize) -> Option<String> {
    let mut counts = Order::ALL.map(|order| {
        let with = |wanted: &dyn Fn(&ResultRow) -> bool| {
            let has = |row: &ResultRow| row.case == order.name() && wanted(row);
            pairs.iter().filter(|pair| pair.iter().any(has)).count()
        };
        let only = |row: &ResultRow| row.standing == Some(Standing::Best);
        (order, with(&only), with(&ResultRow::shares_first))
    });
    counts.sort_by_key(|&(_, only, shared)| Reverse((only + shared, only)));
    let counts = counts.map(|(order, only, shared)| format!("{order} {only} and {shared}"));
    let few = match undecided {
        0 => String::new(),
        1 => " One more pair has too few samples.".into(),
        _ => format!(" {undecided} more pairs have too few samples."),
    };
    match pairs.len() {
        0 if undecided > 0 => Some(format!(
            "{} of a structure and an operation have too few samples to compare the orders.",
            counted(undecided, "pair", "pairs")
        )),
        0 => None,
        _ => Some(format!(
            "Number of pairs in which an order is the only best order, and in which it is one of \
             several without a clear difference: {}.{few}",
            counts.join(", ")
        )),
    }
}

/// Describes the largest effect of the order and of the structure.
fn effects(comparisons: &[Comparison], shown: &Times<'_>) -> Option<String> {
    let by_order = comparisons.iter().flat_map(|comparison| {
        let local = comparison.orders.iter();
        let local = local.filter(|effect| !effect.scans && effect.matters);
        local.filter_map(|effect| {
            let name = effect.backend.as_str();
            let orders = [(name, effect.worst.as_str()), (name, &effect.best)];
            let ratio = shown.ratio(&comparison.operation, orders)?;
            Some((ratio, format!("{} on {name}", comparison.operation)))
        })
    });
    let by_structure = comparisons.iter().filter_map(|comparison| {
        let effect = comparison
            .structures
            .as_ref()
            .filter(|effect| effect.matters)?;
        let slowest = (effect.slowest.as_str(), effect.slowest_order.as_str());
        let fastest = (effect.fastest.as_str(), effect.fastest_order.as_str());
        let ratio = shown.ratio(&comparison.operation, [slowest, fastest])?;
        let operation = &comparison.operation;
        Some((
            ratio,
            format!("{operation}, {} to {}", slowest.0, fastest.0),
        ))
    });
    let largest = |effects: &mut dyn Iterator<Item = (f64, String)>| {
        let largest = effects.max_by(|(a, _), (b, _)| a.total_cmp(b));
        largest.map(|(ratio, what)| format!("{} ({what})", times(ratio)))
    };
    let order = match largest(&mut by_order.into_iter()) {
        Some(largest) => format!("the order changes a time by up to {largest}"),
        None => "the order makes no clear difference".into(),
    };
    let structure = match largest(&mut by_structure.into_iter()) {
        Some(largest) => {
            format!("the structure, each in its best order, by up to {largest}")
        }
        None => "the structure, each in its best order, makes no clear difference".into(),
    };
    let any_local = comparisons.iter().flat_map(|comparison| &comparison.orders);
    any_local
        .filter(|effect| !effect.scans)
        .count()
        .gt(&0)
        .then(|| format!("On structures that do not scan all faces, {order}, and {structure}."))
}

/// Counts the operations in which the order or the structure has the larger effect.
fn verdict(comparisons: &[Comparison]) -> Option<String> {
    let known: Vec<Larger> = comparisons.iter().filter_map(|c| c.larger).collect();
    let count = |larger: Larger| known.iter().filter(|&&l| l == larger).count();
    (!known.is_empty()).then(|| {
        format!(
            "The order has the larger effect in {} of {}, the structure in {}; in {}, this depends \
             on the structure, or is uncertain.",
            count(Larger::Order),
            counted(known.len(), "operation", "operations"),
            count(Larger::Structure),
            count(Larger::Depends)
        )
    })
}

/// Describes the effect of the order on structures that scan.
fn scan_effect(comparisons: &[Comparison], shown: &Times<'_>) -> Option<String> {
    let scans = comparisons.iter().flat_map(|comparison| {
        let scans = comparison.orders.iter().filter(|effect| effect.scans);
        scans.map(move |effect| (&comparison.operation, effect))
    });
    let (operation, most) = scans.max_by(|(_, a), (_, b)| {
        let (a, b) = (a.worst_to_best.ratio, b.worst_to_best.ratio);
        a.total_cmp(&b)
    })?;
    let name = most.backend.as_str();
    let ratio = shown.ratio(operation, [(name, &most.worst), (name, &most.best)])?;
    let of_scans = |row: &&ResultRow| {
        let mut effects = comparisons.iter().flat_map(|comparison| &comparison.orders);
        effects.any(|effect| effect.scans && effect.backend == row.backend)
    };
    let mut bounds = shown.0.iter().filter(of_scans);
    let measured = match bounds.any(|row| row.median_ns.is_none() && row.estimated_ns.is_some()) {
        true => ", of the times that are no lower bounds",
        false => "",
    };
    Some(match most.matters {
        true => format!(
            "On structures that scan all faces for each element, the worst order takes at most {} \
             the time of the best order ({operation} on {name}){measured}.",
            times(ratio),
        ),
        false => "On structures that scan all faces for each element, the order makes no clear \
                  difference."
            .into(),
    })
}

fn how_sure(control: &Control) -> Option<String> {
    Some(format!(
        "How sure: {}, in the given order.",
        describe_noise(control)?
    ))
}

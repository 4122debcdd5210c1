//! Pools the rows of several launches: what each launch measured becomes one value of a row.

use super::{FEWEST_LAUNCHES, ratio_over_launches, time_over_launches, times_over_launches};
use crate::confidence::Confidence;
use crate::ranking::{Rank, rank_launches};
use crate::rows::{
    Agreement, Control, ControlRow, Refusal, RefusalKind, ResultRow, Samples, noise,
};
use crate::statistics::median;

/// The rows of one or more launches, with what belongs to them.
#[derive(Clone, Copy, Debug)]
pub struct LaunchRows<'r> {
    /// The times; those of one group are adjacent.
    pub results: &'r [ResultRow],
    /// The operations without a time.
    pub refusals: &'r [Refusal],
    /// The samples of the times, and of the second measurement of the control.
    pub samples: &'r [Samples],
    /// The difference between two measurements of one backend.
    pub control: Option<&'r Control>,
}

/// The rows over all launches.
#[derive(Clone, Debug, Default)]
pub struct PooledRows {
    /// The times over all launches, in the order of the first launch.
    pub results: Vec<ResultRow>,
    /// The operations without a time in any launch.
    pub refusals: Vec<Refusal>,
    /// The samples of all launches.
    pub samples: Vec<Samples>,
    /// The difference between the two measurements over all launches.
    pub control: Option<Control>,
}

impl LaunchRows<'_> {
    /// Returns the number of launches: 1, unless the rows were pooled before.
    pub fn launches(&self) -> usize {
        let rows = self.results.iter().map(|row| row.launch_ns.len());
        rows.max().unwrap_or(0).max(1)
    }
}

/// Pools the rows of launches that measured the same. Rows with the same `group` are compared with each other.
///
/// A time in one launch is a value; the time over all launches and its interval come from the values of the
/// launches (see [`times_over_launches`] and [`time_over_launches`]), and so do the ratios and the standing
/// ([`rank_launches`]). A row without a time in any launch keeps its longest estimate.
///
/// O(launches · rows²) for the rows of one group.
pub fn pool_rows<K: PartialEq>(
    launches: &[LaunchRows<'_>],
    confidence: Confidence,
    group: impl Fn(&ResultRow) -> K,
) -> PooledRows {
    let counts: Vec<usize> = launches.iter().map(LaunchRows::launches).collect();
    let control = pool_controls(launches, &counts, confidence);
    let mut groups: Vec<(K, Vec<Vec<Option<&ResultRow>>>)> = Vec::new();
    for (launch, rows) in launches.iter().enumerate() {
        for row in rows.results {
            let key = group(row);
            let place = groups.iter().position(|(known, _)| *known == key);
            let place = place.unwrap_or_else(|| {
                groups.push((key, Vec::new()));
                groups.len() - 1
            });
            let known = &mut groups[place].1;
            let same = |of: &&mut Vec<Option<&ResultRow>>| {
                of.iter().flatten().any(|other| is_same(other, row))
            };
            match known.iter_mut().find(same) {
                Some(of) => of[launch] = Some(row),
                None => {
                    let mut of = vec![None; launches.len()];
                    of[launch] = Some(row);
                    known.push(of);
                }
            }
        }
    }
    let pooled = groups
        .iter()
        .flat_map(|(_, rows)| pool_group(rows, &counts, control.as_ref(), confidence));
    let results: Vec<ResultRow> = pooled.collect();
    PooledRows {
        refusals: pool_refusals(launches, &results),
        samples: pool_samples(launches, &counts),
        results,
        control,
    }
}

fn is_same(a: &ResultRow, b: &ResultRow) -> bool {
    (&a.case, &a.operation, &a.backend) == (&b.case, &b.operation, &b.backend)
}

/// Pools the rows that are compared with each other. Each row has an entry for each document.
fn pool_group(
    rows: &[Vec<Option<&ResultRow>>],
    counts: &[usize],
    control: Option<&Control>,
    confidence: Confidence,
) -> Vec<ResultRow> {
    let values: Vec<Vec<Option<f64>>> = rows
        .iter()
        .map(|row| {
            let of = that_count(row).into_iter().zip(counts);
            of.flat_map(|(row, &count)| values(row, count)).collect()
        })
        .collect();
    let values: Vec<&[Option<f64>]> = values.iter().map(Vec::as_slice).collect();
    let times = times_over_launches(&values);
    let agreements: Vec<Agreement> = rows
        .iter()
        .map(|row| {
            let all = row.iter().flatten().map(|row| row.agreement);
            all.min_by_key(|agreement| trust(*agreement))
                .unwrap_or_default()
        })
        .collect();
    let compared = agreements.iter().zip(&times).map(|(agreement, ns)| {
        ns.filter(|_| !matches!(agreement, Agreement::Mismatch | Agreement::OtherEdits))
    });
    let compared: Vec<Option<f64>> = compared.collect();
    let operation = rows.iter().flatten().flatten().next();
    let noise = operation.map_or(1.0, |row| noise(control, &row.operation));
    let ranks = rank_launches(&values, &compared, noise, confidence);
    let parts = rows
        .iter()
        .zip(values)
        .zip(times)
        .zip(agreements)
        .zip(ranks);
    let pooled = parts.filter_map(|((((rows, values), ns), agreement), rank)| {
        let counted = that_count(rows);
        let counted = counted.iter().flatten().map(|row| row.samples);
        let rows: Vec<&ResultRow> = rows.iter().copied().flatten().collect();
        Some(ResultRow {
            agreement,
            samples: counted.sum(),
            ..pool_row(&rows, values, ns, rank, confidence)?
        })
    });
    pooled.collect()
}

/// Returns the rows of those launches whose time counts, among the rows of all launches. A single run before the rounds,
/// with cold caches, counts only if there is nothing better.
fn that_count<'r>(rows: &[Option<&'r ResultRow>]) -> Vec<Option<&'r ResultRow>> {
    let in_rounds = |row: &&ResultRow| row.median_ns.is_some() && !row.warm_up_only;
    let is_enough = rows.iter().flatten().filter(|row| in_rounds(row)).count() >= FEWEST_LAUNCHES;
    let rows = rows.iter();
    rows.map(|row| row.filter(|row| !is_enough || in_rounds(row)))
        .collect()
}

/// Returns the times of a row in `count` launches.
fn values(row: Option<&ResultRow>, count: usize) -> Vec<Option<f64>> {
    match row {
        Some(row) if !row.launch_ns.is_empty() => row.launch_ns.clone(),
        row => {
            let mut values = vec![None; count];
            values[0] = row.and_then(|row| row.median_ns);
            values
        }
    }
}

/// Orders agreements: the least trusted decides about several launches.
fn trust(agreement: Agreement) -> u8 {
    match agreement {
        Agreement::Mismatch => 0,
        Agreement::OtherEdits => 1,
        Agreement::Merged => 2,
        Agreement::Same => 3,
        Agreement::Unchecked => 4,
    }
}

fn pool_row(
    rows: &[&ResultRow],
    values: &[Option<f64>],
    ns: Option<f64>,
    rank: Option<Rank>,
    confidence: Confidence,
) -> Option<ResultRow> {
    // The plan of a launch may differ from that of another one.
    let timed = rows.iter().filter(|row| row.median_ns.is_some());
    let timed: Vec<&ResultRow> = timed.copied().collect();
    let first = timed.first().or(rows.first()).copied()?;
    let typical = |of: &dyn Fn(&ResultRow) -> Option<f64>| {
        median(timed.iter().filter_map(|row| of(row)).collect())
    };
    let least = |of: &dyn Fn(&ResultRow) -> Option<f64>| {
        let all = timed.iter().filter_map(|row| of(row));
        all.min_by(f64::total_cmp)
    };
    let most = |of: &dyn Fn(&ResultRow) -> Option<u64>| rows.iter().filter_map(|row| of(row)).max();
    let sum = |of: &dyn Fn(&ResultRow) -> usize| rows.iter().map(|row| of(row)).sum::<usize>();
    let time = ns.and_then(|ns| time_over_launches(ns, values));
    let interval = time.and_then(|time| time.interval(confidence));
    let ratio = rank.and_then(|rank| rank.ratio.interval(confidence));
    let elements = rows.iter().find_map(|row| row.elements);
    let estimates = rows.iter().filter_map(|row| row.estimated_ns);
    let first_ratio = typical(&ResultRow::first_ratio);
    Some(ResultRow {
        median_ns: ns,
        launch_ns: values.to_vec(),
        uncorrected_ns: typical(&|row| row.uncorrected_ns),
        min_ns: least(&|row| row.min_ns),
        ci_low_ns: interval.map(|[low, _]| low),
        ci_high_ns: interval.map(|[_, high]| high),
        elements,
        ns_per_element: ns.and_then(|ns| Some(ns / elements.filter(|&n| n > 0)? as f64)),
        wall_median_ns: typical(&|row| row.wall_median_ns),
        wall_min_ns: least(&|row| row.wall_min_ns),
        estimated_ns: match ns {
            Some(_) => None,
            None => estimates.max_by(f64::total_cmp),
        },
        standing: rank.and_then(|rank| rank.standing),
        ratio_to_best: rank.map(|rank| rank.ratio.value),
        ratio_ci_low: ratio.map(|[low, _]| low),
        ratio_ci_high: ratio.map(|[_, high]| high),
        warm_up_only: rows.iter().all(|row| row.warm_up_only),
        by_name_only: rows.iter().all(|row| row.by_name_only),
        faults: most(&|row| row.faults),
        retaken: rows.iter().map(|row| row.retaken).sum(),
        disturbed: sum(&|row| row.disturbed),
        first_ns: ns.and_then(|ns| Some(ns * first_ratio?)),
        first_samples: sum(&|row| row.first_samples),
        first_faults: most(&|row| row.first_faults),
        ..first.clone()
    })
}

/// Returns the refusals of all launches, without those of a task that has a result in another launch.
fn pool_refusals(launches: &[LaunchRows<'_>], results: &[ResultRow]) -> Vec<Refusal> {
    let mut pooled: Vec<Refusal> = Vec::new();
    for refusal in launches.iter().flat_map(|rows| rows.refusals) {
        let of = |backend: &str, operation: &str| {
            (backend, operation) == (refusal.backend.as_str(), refusal.operation.as_str())
        };
        let has_result = results.iter().any(|row| of(&row.backend, &row.operation));
        let known = pooled.iter_mut().find(|r| of(&r.backend, &r.operation));
        match known {
            _ if has_result => {}
            // That an operation is impossible says more than that the budget ended.
            Some(known) if known.kind == RefusalKind::BudgetEnded => *known = refusal.clone(),
            Some(_) => {}
            None => pooled.push(refusal.clone()),
        }
    }
    pooled
}

fn pool_samples(launches: &[LaunchRows<'_>], counts: &[usize]) -> Vec<Samples> {
    let mut pooled: Vec<Samples> = Vec::new();
    let (mut launch, mut round) = (0, 0);
    for (rows, &count) in launches.iter().zip(counts) {
        let mut next_round = round;
        for samples in rows.samples {
            let moved = moved(samples, launch, round);
            next_round = moved
                .rounds
                .iter()
                .fold(next_round, |next, &r| next.max(r + 1));
            let same = |known: &&mut Samples| {
                (&known.case, &known.operation, &known.backend, known.control)
                    == (&moved.case, &moved.operation, &moved.backend, moved.control)
            };
            match pooled.iter_mut().find(same) {
                Some(known) => append(known, moved),
                None => pooled.push(moved),
            }
        }
        launch += count as u32;
        round = next_round;
    }
    pooled
}

/// Returns samples with the numbers of their launches and rounds among all launches.
fn moved(samples: &Samples, launch: u32, round: u32) -> Samples {
    let count = samples.rounds.len();
    let launches = match samples.launches.is_empty() {
        true => vec![0; count],
        false => samples.launches.clone(),
    };
    let slowdowns = match samples.slowdowns.is_empty() {
        true => vec![1.0; count],
        false => samples.slowdowns.clone(),
    };
    Samples {
        launches: launches.into_iter().map(|own| own + launch).collect(),
        rounds: samples.rounds.iter().map(|own| own + round).collect(),
        slowdowns,
        ..samples.clone()
    }
}

fn append(known: &mut Samples, more: Samples) {
    fn both<T>(known: &mut Option<Vec<T>>, more: Option<Vec<T>>) {
        *known = known.take().zip(more).map(|(mut known, more)| {
            known.extend(more);
            known
        });
    }
    known.launches.extend(more.launches);
    known.rounds.extend(more.rounds);
    known.wall_ns.extend(more.wall_ns);
    known.slowdowns.extend(more.slowdowns);
    known.first_ns.extend(more.first_ns);
    both(&mut known.cpu_ns, more.cpu_ns);
    both(&mut known.faults, more.faults);
}

fn pool_controls(
    launches: &[LaunchRows<'_>],
    counts: &[usize],
    confidence: Confidence,
) -> Option<Control> {
    let controls = || launches.iter().filter_map(|rows| rows.control);
    let backend = &controls().next()?.backend;
    let mut operations: Vec<ControlRow> = Vec::new();
    for row in controls().flat_map(|control| &control.operations) {
        if operations
            .iter()
            .any(|known| known.operation == row.operation)
        {
            continue;
        }
        let of_launch = launches.iter().zip(counts).flat_map(|(rows, &count)| {
            let own = rows.control.filter(|control| control.backend == *backend);
            let mut own = own.iter().flat_map(|control| &control.operations);
            match own.find(|own| own.operation == row.operation) {
                Some(own) if !own.launches.is_empty() => own.launches.clone(),
                own => {
                    let mut values = vec![None; count];
                    values[0] = own.map(|own| own.ratio);
                    values
                }
            }
        });
        let ratios: Vec<Option<f64>> = of_launch.collect();
        let ones = vec![Some(1.0); ratios.len()];
        let ratio = times_over_launches(&[&ratios])[0]
            .and_then(|ratio| ratio_over_launches([ratio, 1.0], [&ratios, &ones]));
        operations
            .extend(ratio.map(|ratio| ControlRow::new(&row.operation, ratio, confidence, ratios)));
    }
    Control::new(backend, operations)
}

#[cfg(test)]
mod tests;

//! The sentences of the report.

use super::{Cheapest, NeighboursReport, SpatialTask};
use crate::numbers::{counted, figure, list};
use crate::results::rows::Standing;

/// Returns the sentences that describe the results.
pub(super) fn sentences(report: &NeighboursReport) -> Vec<String> {
    let tasks = SpatialTask::ALL.into_iter();
    let mut sentences: Vec<String> = tasks.filter_map(|task| fastest(report, task)).collect();
    for query in &report.cheapest {
        if let Some(ranges) = in_words(&query.ranges) {
            sentences.push(format!(
                "With building, least total time of {}: {ranges}.",
                query.operation
            ));
        }
    }
    if let Some(noise) = report.noise {
        sentences.push(format!(
            "Noise: one index was measured twice. The two times differ by at most {:.1} %.",
            100.0 * (noise - 1.0)
        ));
    }
    sentences
}

/// Names the fastest indices of a task, and the ratio of the slowest index.
fn fastest(report: &NeighboursReport, task: SpatialTask) -> Option<String> {
    let best = report.rows(task).filter(|row| {
        let standing = row.standing;
        standing.is_some_and(|standing| standing != Standing::Slower)
    });
    let best: Vec<_> = best.collect();
    let first = best.first()?;
    let slowest = report
        .rows(task)
        .filter(|row| row.standing == Some(Standing::Slower))
        .max_by(|a, b| a.median_ns.total_cmp(&b.median_ns));
    let names: Vec<&str> = best.iter().map(|row| row.backend.as_str()).collect();
    let slowest = slowest.and_then(|row| {
        let ratio = figure(row.ratio_to_best?);
        Some(format!("; {} takes {ratio} × this time", row.backend))
    });
    let lead = if best.len() == 1 {
        "is fastest"
    } else {
        "are fastest, with no clear difference between them"
    };
    let times = best.iter().map(|row| row.ns_per_element);
    let least = figure(times.clone().fold(f64::INFINITY, f64::min));
    let most = figure(times.fold(0.0, f64::max));
    let range = match least == most {
        true => least,
        false => format!("{least} to {most}"),
    };
    Some(format!(
        "{task}: {} {lead} ({range} ns per {}){}.",
        list(names),
        first.per,
        slowest.unwrap_or_default()
    ))
}

/// Describes the ranges, such as "list for up to 10 queries and bvh for more".
fn in_words(ranges: &[Cheapest]) -> Option<String> {
    let (last, others) = ranges.split_last()?;
    if others.is_empty() {
        return Some(format!("{} for any number of queries", last.index));
    }
    let ends = ranges.iter().skip(1).map(|next| next.from - 1);
    let others = others.iter().zip(ends);
    let others: Vec<String> = others
        .map(|(range, end)| {
            let queries = counted(end as usize, "query", "queries");
            format!("{} for up to {queries}", range.index)
        })
        .collect();
    Some(format!(
        "{}, and {} for more",
        others.join(", "),
        last.index
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_described_in_words() {
        let range = |from, index: &str| Cheapest {
            from,
            index: index.into(),
        };
        let words = |ranges: &[Cheapest]| in_words(ranges);
        assert_eq!(words(&[]), None);
        let one = words(&[range(1, "bvh")]).unwrap();
        assert_eq!(one, "bvh for any number of queries");
        let three = [range(1, "list"), range(12, "grid"), range(20_001, "bvh")];
        let three = words(&three).unwrap();
        assert_eq!(
            three,
            "list for up to 11 queries, grid for up to 20,000 queries, and bvh for more"
        );
    }
}

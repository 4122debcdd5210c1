//! The sentences of the report.

use super::SpatialTask;
use sixfold_results::numbers::{grouped, list, rounded};
use sixfold_results::{Cheapest, NeighboursReport, describe_noise};

/// Returns the fastest indices of all tasks, then for each kind of query the index with the least
/// total time, and the noise.
pub(super) fn sentences(report: &NeighboursReport) -> Vec<String> {
    let mut sentences: Vec<String> = fastest(report).into_iter().collect();
    for query in &report.cheapest {
        if let Some(ranges) = in_words(&query.ranges) {
            let task = &query.operation;
            sentences.push(format!(
                "{task}, building included: least time with {ranges}."
            ));
        }
    }
    let noise = report.control.as_ref().and_then(describe_noise);
    sentences.extend(noise.map(|noise| format!("How sure: {noise}.")));
    sentences
}

/// Names the fastest indices of each task, such as "grid for nearest_vertex; bvh for first_hit".
fn fastest(report: &NeighboursReport) -> Option<String> {
    let mut winners: Vec<(String, Vec<SpatialTask>)> = Vec::new();
    for task in SpatialTask::ALL {
        let best = report.rows(task.name()).filter(|row| row.is_fastest());
        let names: Vec<&str> = best.map(|row| row.backend.as_str()).collect();
        let names = names.join(" or ");
        match winners.iter_mut().find(|(known, _)| *known == names) {
            _ if names.is_empty() => {}
            Some((_, tasks)) => tasks.push(task),
            None => winners.push((names, vec![task])),
        }
    }
    let winners = winners.into_iter().map(|(names, tasks)| {
        let tasks = tasks.into_iter().map(SpatialTask::name);
        format!("{names} for {}", list(tasks))
    });
    let winners: Vec<String> = winners.collect();
    (!winners.is_empty()).then(|| format!("Fastest: {}.", winners.join("; ")))
}

/// Describes the ranges, such as "list up to 11 queries, then grid up to 20,000, then bvh".
fn in_words(ranges: &[Cheapest]) -> Option<String> {
    let (last, others) = ranges.split_last()?;
    if others.is_empty() {
        return Some(format!("{} for any number of queries", last.index));
    }
    let ends = ranges.iter().skip(1).map(|next| next.from - 1);
    let others = others.iter().zip(ends).enumerate();
    let others: Vec<String> = others
        .map(|(i, (range, end))| {
            // The times are not known to more digits.
            let end = grouped(rounded(end as f64) as usize);
            let queries = match (i, end.as_str()) {
                (0, "1") => " query",
                (0, _) => " queries",
                _ => "",
            };
            format!("{} up to {end}{queries}", range.index)
        })
        .collect();
    Some(format!("{}, then {}", others.join(", then "), last.index))
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
            "list up to 11 queries, then grid up to 20,000, then bvh"
        );
    }
}

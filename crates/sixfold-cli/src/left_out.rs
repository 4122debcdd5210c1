//! Notes on missing and estimated figures, below the conclusions: one paragraph for each reason.

use sixfold_results::numbers::duration;
use sixfold_results::{Refusal, Report, ResultRow};

/// Explains why figures of a study are missing or only estimated.
pub(crate) fn left_out_notes(report: &Report) -> Vec<String> {
    let mut notes = refusal_notes(&report.refusals);
    notes.extend(not_run_notes(&report.results));
    notes
}

/// Lists the operations that are only estimated, one note for each remedy.
fn not_run_notes(results: &[ResultRow]) -> Vec<String> {
    let remedies = [
        (true, "name them in --operations"),
        (false, "use a longer --budget"),
    ];
    let note = |(by_name_only, remedy)| {
        let rows = results
            .iter()
            .filter(|row| row.by_name_only == by_name_only);
        let rows: Vec<&ResultRow> = rows.filter(|row| row.estimated_ns.is_some()).collect();
        let time = |row: &&&ResultRow| row.estimated_ns.unwrap_or(0.0);
        let longest = rows.iter().max_by(|a, b| time(a).total_cmp(&time(b)))?;
        let places = rows
            .iter()
            .map(|row| (row.operation.as_str(), row.backend.as_str()));
        Some(format!(
            "≥ not run, because a run would take long ({} on {}: {} or more): {}. To run them, \
             {remedy}.",
            longest.operation,
            longest.backend,
            duration(longest.estimated_ns?),
            grouped_places(places)
        ))
    };
    remedies.into_iter().filter_map(note).collect()
}

/// Lists the reasons for missing figures, one line per reason. Reasons that differ only in numbers
/// count as one reason; the line has the first of them.
pub(crate) fn refusal_notes<'r>(refusals: impl IntoIterator<Item = &'r Refusal>) -> Vec<String> {
    let mut reasons: Vec<(String, Vec<&Refusal>)> = Vec::new();
    for refusal in refusals {
        let pattern: String = refusal
            .reason
            .chars()
            .filter(|c| !c.is_ascii_digit())
            .collect();
        match reasons.iter_mut().find(|(known, _)| *known == pattern) {
            Some((_, same)) => same.push(refusal),
            None => reasons.push((pattern, vec![refusal])),
        }
    }
    let line = |(_, same): (String, Vec<&Refusal>)| {
        let places = same
            .iter()
            .map(|r| (r.operation.as_str(), r.backend.as_str()));
        format!("– {}: {}", grouped_places(places), same[0].reason)
    };
    reasons.into_iter().map(line).collect()
}

/// Lists operations and their backends, such as `loop_native, loop_gather on half-edge; flip_all on
/// polygon-soup`.
fn grouped_places<'p>(places: impl Iterator<Item = (&'p str, &'p str)>) -> String {
    let mut backends: Vec<(&str, Vec<&str>)> = Vec::new();
    for (operation, backend) in places {
        match backends.iter_mut().find(|(known, _)| *known == backend) {
            Some((_, operations)) if operations.contains(&operation) => {}
            Some((_, operations)) => operations.push(operation),
            None => backends.push((backend, vec![operation])),
        }
    }
    let mut groups: Vec<(Vec<&str>, Vec<&str>)> = Vec::new();
    for (backend, operations) in backends {
        match groups.iter_mut().find(|(known, _)| *known == operations) {
            Some((_, backends)) => backends.push(backend),
            None => groups.push((operations, vec![backend])),
        }
    }
    let group = |(operations, backends): &(Vec<&str>, Vec<&str>)| {
        format!("{} on {}", operations.join(", "), backends.join(", "))
    };
    groups.iter().map(group).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_has_one_line() {
        let refusal = |backend: &str, operation: &str, reason: &str| Refusal {
            backend: backend.into(),
            operation: operation.parse().expect("an operation"),
            kind: sixfold_results::RefusalKind::Impossible,
            reason: reason.into(),
        };
        let triangles = "face f0 has 4 corners, and edits need triangles";
        let others = "face f12 has 5 corners, and edits need triangles";
        let refusals = [
            refusal("half-edge", "flip_all", triangles),
            refusal("half-edge", "decimate_half", triangles),
            refusal("half-edge", "flip_all", others),
            refusal("winged-edge", "flip_all", triangles),
            refusal("winged-edge", "decimate_half", others),
            refusal("polygon-soup", "flip_all", triangles),
            refusal("polygon-soup", "loop_native", "no native method"),
        ];
        assert_eq!(
            refusal_notes(&refusals),
            [
                "– flip_all, decimate_half on half-edge, winged-edge; flip_all on polygon-soup: \
                 face f0 has 4 corners, and edits need triangles",
                "– loop_native on polygon-soup: no native method",
            ]
        );
    }
}

//! The main results of a study, as sentences.

use sixfold::Relation;

use crate::labs::study::methods::methods;
use sixfold_results::numbers::{grouped, list};
use sixfold_results::{
    Agreement, BackendReport, Overall, Purpose, Report, ResultRow, leaders, next_row, not_ranked,
};

/// Returns the answer in at most three sentences: which backend for what, by how much, and how sure.
/// `scanning` tells whether a backend scans all faces for a relation.
pub(crate) fn answer(report: &Report, scanning: &dyn Fn(&str, Relation) -> bool) -> Vec<String> {
    let overall = report.overall();
    let purposes: Vec<&[Overall]> = overall
        .chunk_by(|a, b| a.purpose == b.purpose)
        .filter(|rows| rows.len() > 1 && !leaders(rows).is_empty())
        .collect();
    let scanning = scanning_backends(report, scanning);
    let parts = [
        next_best(&purposes, &scanning),
        scans(report, &purposes, &scanning),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    let by_how_much = (!parts.is_empty()).then(|| parts.join("; ") + ".");
    let sentences = [choice(report, &purposes), by_how_much, report.how_sure()];
    sentences.into_iter().flatten().collect()
}

/// Returns the backends that scan all faces for a measured relation.
fn scanning_backends<'r>(
    report: &'r Report,
    scanning: &dyn Fn(&str, Relation) -> bool,
) -> Vec<&'r str> {
    let is_scan = |row: &ResultRow| {
        let relation = row.operation.parse::<Relation>();
        relation.is_ok_and(|relation| scanning(&row.backend, relation))
    };
    let names = report.backends.iter().map(|backend| backend.name.as_str());
    let scans = |name: &&str| {
        let mut rows = report.results.iter();
        rows.any(|row| row.backend == *name && is_scan(row))
    };
    names.filter(scans).collect()
}

/// Names the fastest backends for each kind of work.
fn choice(report: &Report, purposes: &[&[Overall]]) -> Option<String> {
    let mut choices: Vec<(String, Vec<String>)> = Vec::new();
    for rows in purposes {
        let best = leaders(rows);
        let names: Vec<&str> = best.iter().map(|row| row.backend.as_str()).collect();
        let names = match names[..] {
            [name] => name.to_owned(),
            _ if best.len() == rows.len() => "all backends, with no clear difference,".to_owned(),
            _ => format!("{} (no clear difference)", names.join(" or ")),
        };
        let names = match not_ranked(rows) {
            Some(open) => format!("{names} ({open})"),
            None => names,
        };
        let purpose = match report.mean_over(rows) {
            over if over.is_empty() => rows[0].purpose.of_choice().to_owned(),
            over => format!("{} ({over})", rows[0].purpose.of_choice()),
        };
        match choices.iter_mut().find(|(known, _)| *known == names) {
            Some((_, purposes)) => purposes.push(purpose),
            None => choices.push((names, vec![purpose])),
        }
    }
    let choices = choices.into_iter();
    let choices: Vec<String> = choices
        .map(|(names, purposes)| format!("{names} {}", list(purposes)))
        .collect();
    (!choices.is_empty()).then(|| format!("Fastest: {}.", choices.join("; ")))
}

/// Names the next best backend for each kind of work, with its time. [`scans`] names the backends
/// that scan.
fn next_best(purposes: &[&[Overall]], scanning: &[&str]) -> Option<String> {
    let next = purposes.iter().filter_map(|rows| {
        let first = next_row(rows)?;
        let is_local = !scanning.contains(&first.backend.as_str());
        let purpose = rows[0].purpose.title().to_lowercase();
        let (next, ratio) = sixfold_results::next_best(rows)?;
        is_local.then(|| format!("{next} {ratio} the time in {purpose}"))
    });
    let next: Vec<String> = next.collect();
    (!next.is_empty()).then(|| format!("Next best: {}", next.join(", ")))
}

/// Describes the mean time in queries of the backends that scan all faces for a relation.
fn scans(report: &Report, purposes: &[&[Overall]], scanning: &[&str]) -> Option<String> {
    let queries = purposes
        .iter()
        .find(|rows| rows[0].purpose == Purpose::Query)?;
    let scanning = queries
        .iter()
        .filter(|mean| scanning.contains(&mean.backend.as_str()));
    let mut scanning: Vec<&Overall> = scanning.collect();
    let column = |mean: &&Overall| report.backends.iter().position(|b| b.name == mean.backend);
    scanning.sort_by_key(column);
    let (verb, times) = match scanning.len() {
        0 => return None,
        1 => ("scans", "takes"),
        _ => ("scan", "take"),
    };
    let faces = grouped(report.mesh.facts.faces);
    let ratios = scanning.iter().map(|mean| mean.times(&queries[0]));
    Some(format!(
        "{} {verb} all {faces} faces for most relations and {times} {} the time in queries",
        list(scanning.iter().map(|mean| &mean.backend)),
        list(ratios)
    ))
}

/// Returns sentences about single results: the subdivision methods, and merged vertices.
pub(crate) fn notes(backends: &[BackendReport], results: &[ResultRow]) -> Vec<String> {
    let mut notes = methods(backends, results);
    let merged = backends.iter();
    notes.extend(merged.filter_map(|backend| merging(backend, results)));
    notes
}

/// Returns a warning for each result that differs from the results of the other backends.
pub(crate) fn mismatches(report: &Report) -> Vec<String> {
    let ours = report.mismatches().map(fault);
    let programs = report.external_mismatches();
    let not_compared = "The times of this backend cannot be compared.";
    let programs = programs.map(|row| mismatch(row, not_compared));
    ours.chain(programs).collect()
}

/// Returns the warning about a result that differs from those of other backends of Sixfold.
pub(crate) fn fault(row: &ResultRow) -> String {
    mismatch(row, "This is a fault in Sixfold: please report it.")
}

fn mismatch(row: &ResultRow, consequence: &str) -> String {
    let (operation, backend) = (&row.operation, &row.backend);
    format!(
        "{operation} on {backend} gives different results from the other backends. {consequence}"
    )
}

fn merging(backend: &BackendReport, results: &[ResultRow]) -> Option<String> {
    let merged = backend.merged_vertices.filter(|&merged| merged > 0)?;
    let name = &backend.name;
    let vertices = if merged == 1 { "vertex" } else { "vertices" };
    let share = if merged == 1 { "shares" } else { "share" };
    let differs = results
        .iter()
        .any(|r| r.backend == *name && r.agreement == Agreement::Merged);
    let suffix = if differs {
        "; results marked m are results of the merged mesh"
    } else {
        ""
    };
    Some(format!(
        "{name} merges {merged} {vertices} that {share} coordinates with another vertex{suffix}."
    ))
}

#[cfg(test)]
pub(crate) fn row(
    backend: &str,
    operation: sixfold_measure::Operation,
    ratio: f64,
    standing: sixfold_results::Standing,
) -> ResultRow {
    ResultRow {
        median_ns: Some(100.0 * ratio),
        elements: Some(1),
        ns_per_element: Some(100.0 * ratio),
        agreement: Agreement::Same,
        standing: Some(standing),
        ratio_to_best: Some(ratio),
        samples: 9,
        ..ResultRow::new(backend, operation.name(), operation.unit())
    }
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;
    use sixfold::subdivision::Method::{Gather, Native, Scatter};
    use sixfold_measure::{Operation, StudyMesh};
    use sixfold_results::Run;
    use sixfold_workload::Backend;

    use sixfold_results::{Control, ControlRow, Standing};

    use super::*;
    use crate::inspect::inspect;

    /// Returns a report on a tetrahedron with these results.
    fn report(results: Vec<ResultRow>) -> Report {
        let mesh = StudyMesh::new("test", shapes::tetrahedron());
        let inspection = inspect(&mesh, &Backend::structures());
        Report {
            mesh: inspection.mesh,
            backends: inspection.backends,
            results,
            run: Run {
                operations: Operation::ALL.map(Operation::info).into(),
                ..Run::default()
            },
            ..Report::default()
        }
    }

    fn said(report: &Report) -> Vec<String> {
        answer(report, &|backend, _| backend == "polygon-soup")
    }

    #[test]
    fn the_answer_says_which_by_how_much_and_how_sure() {
        use Operation::{Boundary, Build, Relation as Query};
        let query = Query(Relation::FaceFaces);
        let estimate = ResultRow {
            median_ns: None,
            estimated_ns: Some(90_000.0),
            standing: None,
            ..row("polygon-soup", Boundary, 1.0, Standing::Slower)
        };
        let mut report = report(vec![
            row("polygon-soup", Build, 1.0, Standing::Undecided),
            row("half-edge", Build, 1.04, Standing::Undecided),
            row("corner-table", Build, 2.08, Standing::Slower),
            row("polygon-soup", query, 400.0, Standing::Slower),
            row("half-edge", query, 1.0, Standing::Best),
            row("corner-table", query, 4.0, Standing::Slower),
            estimate,
            row("half-edge", Boundary, 1.0, Standing::Best),
            row("corner-table", Boundary, 1.0, Standing::Slower),
        ]);
        let which = "Fastest: polygon-soup or half-edge (no clear difference) to build; half-edge for \
                     queries (geometric mean of 2 operations).";
        // Queries: the roots of 4 * 1, and of 400 * 900.
        let how_much = "Next best: corner-table takes 2.08 × the time in building, corner-table takes \
                        2.00 × the time in queries; polygon-soup scans all 4 faces for most relations and \
                        takes ≥ 600 × the time in queries.";
        let counts = "How sure: of 3 operations, 2 with a clear winner and 1 undecided";
        assert_eq!(said(&report), [which, how_much, &format!("{counts}.")]);

        let control = |ratio| ControlRow {
            operation: Build.name().into(),
            ratio,
            ci_low: None,
            ci_high: None,
            launches: Vec::new(),
        };
        report.control = Some(Control {
            backend: "half-edge".into(),
            operations: vec![
                control(1.01),
                ControlRow {
                    operation: query.name().into(),
                    ..control(0.8)
                },
            ],
            typical: 1.02,
            worst: 1.25,
        });
        let noise = "two measurements of half-edge differ by 2.0 % (median; at most 25.0 % in \
                     face_faces)";
        assert_eq!(said(&report)[2], format!("{counts}; {noise}."));

        for row in &mut report.results {
            row.median_ns = Some(100.0);
        }
        let equal = "Fastest: all backends, with no clear difference, to build and for queries \
                     (geometric mean of 2 operations).";
        assert_eq!(said(&report)[0], equal);

        report.results.truncate(1);
        report.control = None;
        assert_eq!(said(&report), [""; 0], "one backend has no comparison");
    }

    #[test]
    fn backends_whose_means_differ_by_less_than_their_error_share_the_first_place() {
        let timed = |backend: &str, operation, ratio: f64, spread: f64| ResultRow {
            ratio_ci_low: Some(ratio / spread),
            ratio_ci_high: Some(ratio * spread),
            ..row(backend, operation, ratio, Standing::Undecided)
        };
        let loops = Operation::Loop(Scatter);
        let with_spread = |spread| {
            report(vec![
                timed("half-edge", Operation::Boundary, 1.0, 1.0),
                timed("corner-table", Operation::Boundary, 1.2, spread),
                timed("half-edge", Operation::EdgeLength, 1.0, 1.0),
                timed("corner-table", Operation::EdgeLength, 1.2, spread),
                timed("half-edge", loops, 1.0, 1.0),
                timed("corner-table", loops, 3.0, 1.1),
            ])
        };
        // The error of the mean of two operations is that of one divided by the root of 2.
        assert!(1.28_f64.powf(0.5_f64.sqrt()) < 1.2 && 1.31_f64.powf(0.5_f64.sqrt()) > 1.2);
        let which = |spread| said(&with_spread(spread)).swap_remove(0);
        assert_eq!(
            which(1.28),
            "Fastest: half-edge for queries (geometric mean of 2 operations) and for subdivision \
             (fastest method of Loop)."
        );
        assert_eq!(
            which(1.31),
            "Fastest: all backends, with no clear difference, for queries (geometric mean of 2 \
             operations); half-edge for subdivision (fastest method of Loop)."
        );
    }

    #[test]
    fn operations_with_few_samples_have_no_winner() {
        let undecided = |backend: &str, ratio| ResultRow {
            standing: None,
            ..row(backend, Operation::Build, ratio, Standing::Slower)
        };
        let report = report(vec![
            undecided("half-edge", 1.0),
            undecided("winged-edge", 1.5),
        ]);
        let sure = said(&report).pop();
        let expected = "How sure: of 1 operation, 1 with too few samples.";
        assert_eq!(sure.as_deref(), Some(expected));
    }

    #[test]
    fn wrong_results_are_warned_of() {
        let mut wrong = row("half-edge", Operation::Build, 1.0, Standing::Best);
        wrong.agreement = Agreement::Mismatch;
        let mut report = report(vec![wrong]);
        let warned = mismatches(&report);
        let expected = "build on half-edge gives different results from the other backends. This is \
                        a fault in Sixfold: please report it.";
        assert_eq!(warned, [expected]);
        report.results[0].agreement = Agreement::Same;
        assert_eq!(mismatches(&report), [""; 0]);
    }

    #[test]
    fn methods_are_compared_if_they_differ_significantly() {
        let timed = |backend: &str, method, ratio, spread: f64| ResultRow {
            ci_low_ns: Some(100.0 * ratio / spread),
            ci_high_ns: Some(100.0 * ratio * spread),
            ..row(backend, Operation::Loop(method), ratio, Standing::Undecided)
        };
        let searching = ResultRow {
            median_ns: None,
            estimated_ns: Some(9000.0),
            ..row(
                "polygon-soup",
                Operation::Loop(Gather),
                1.0,
                Standing::Undecided,
            )
        };
        let report = report(vec![
            searching,
            timed("face-vertex", Gather, 1.2, 1.3),
            timed("half-edge", Gather, 2.0, 1.01),
            timed("polygon-soup", Scatter, 3.0, 1.01),
            timed("face-vertex", Scatter, 1.0, 1.3),
            timed("half-edge", Scatter, 3.0, 1.01),
            timed("half-edge", Native, 0.5, 1.01),
        ]);
        let expected = "Loop: scatter is faster than gather on polygon-soup (≥ 30.0 ×); scatter is \
                        slower than gather on half-edge (1.50 ×); native is faster than gather and \
                        scatter on half-edge (4.00 ×).";
        assert_eq!(notes(&report.backends, &report.results), [expected]);
    }
}

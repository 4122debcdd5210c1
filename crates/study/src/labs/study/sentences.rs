//! The main results of a study, as sentences.

use sixfold::{PolygonMesh, Relation};

use crate::engine::statistics::Median;
use crate::labs::study::methods::methods;
use crate::numbers::{duration, grouped, times};
use crate::results::rows::{Agreement, BackendReport, Control, ControlRow, ResultRow, Standing};
use sixfold_workload::Operation;

/// Returns sentences about speed, scans, memory and merged vertices.
pub(crate) fn sentences(
    backends: &[BackendReport],
    results: &[ResultRow],
    polygons: &PolygonMesh,
    control: Option<&Control>,
    scanning: &dyn Fn(&str, Relation) -> bool,
) -> Vec<String> {
    let mut sentences = Vec::new();
    sentences.extend(speed(backends, results));
    sentences.extend(control.and_then(noise));
    for backend in backends.iter().filter(|backend| backend.holds) {
        sentences.extend(scans(&backend.name, results, polygons, scanning));
    }
    sentences.extend(methods(backends, results, times));
    sentences.extend(memory(backends));
    for backend in backends {
        sentences.extend(merging(backend, results));
    }
    let mismatches = results
        .iter()
        .filter(|row| row.agreement == Agreement::Mismatch);
    for row in mismatches {
        let ResultRow {
            backend, operation, ..
        } = row;
        let column = backends.iter().find(|column| column.name == *backend);
        let consequence = match column.is_some_and(|column| column.external.is_some()) {
            true => "The times of this backend cannot be compared.",
            false => "This is a fault in Sixfold: please report it.",
        };
        sentences.push(format!(
            "{operation} on {backend} gives different results from the other backends. \
             {consequence}"
        ));
    }
    sentences
}

fn speed(backends: &[BackendReport], results: &[ResultRow]) -> Option<String> {
    let rows = results.chunk_by(|a, b| a.operation == b.operation);
    let compared: Vec<&[ResultRow]> = rows
        .filter(|row| row.iter().filter(|r| r.median_ns.is_some()).count() > 1)
        .collect();
    if compared.is_empty() {
        return None;
    }
    let mut fastest: Vec<(usize, f64, &str)> = Vec::new();
    for backend in backends {
        let ratios: Vec<f64> = compared
            .iter()
            .filter_map(|row| ratio_to_next(row, &backend.name))
            .collect();
        let wins = ratios.len();
        if let Some(ratio_to_next) = Median::from_samples(ratios) {
            fastest.push((wins, ratio_to_next.value, &backend.name));
        }
    }
    fastest.sort_by_key(|(wins, ..)| std::cmp::Reverse(*wins));
    let count = compared.len();
    let ties = count - fastest.iter().map(|(wins, ..)| wins).sum::<usize>();
    let mut parts = Vec::new();
    for (i, (wins, ratio_to_next, name)) in fastest.into_iter().enumerate() {
        let ratio_to_next = times(ratio_to_next);
        parts.push(match i {
            0 => format!(
                "{name} is fastest in {wins} (the second backend typically takes {ratio_to_next} \
                 the time)"
            ),
            _ => format!("{name} in {wins} ({ratio_to_next})"),
        });
    }
    match ties {
        0 => {}
        1 => parts.push("1 has a tie for the fastest".into()),
        _ => parts.push(format!("{ties} have a tie for the fastest")),
    }
    let operations = if count == 1 {
        "operation"
    } else {
        "operations"
    };
    Some(format!("Of {count} {operations}, {}.", parts.join(", ")))
}

/// Describes the difference between the two columns of the control.
fn noise(control: &Control) -> Option<String> {
    let difference = |row: &&ControlRow| row.difference();
    let worst = control
        .operations
        .iter()
        .max_by(|a, b| difference(a).total_cmp(&difference(b)))?;
    let percent = |ratio: f64| format!("{:.1} %", 100.0 * (ratio - 1.0));
    Some(format!(
        "Noise: {} was measured twice. Its two times differ by {} (median over the operations), \
         and by at most {} ({}). A backend is tied with the fastest if it differs by no more than \
         the noise of the operation. With one or two samples, it is tied if it takes less than \
         2 × the time.",
        control.backend,
        percent(control.typical),
        percent(control.worst),
        worst.operation,
    ))
}

/// If `backend` is the only fastest backend, returns the ratio of the next fastest to it.
fn ratio_to_next(row: &[ResultRow], backend: &str) -> Option<f64> {
    let best = |r: &&ResultRow| r.standing == Some(Standing::Best) && r.backend == backend;
    row.iter().find(best)?;
    let others = row.iter().filter(|r| r.standing == Some(Standing::Slower));
    others
        .filter_map(|r| r.ratio_to_best)
        .min_by(f64::total_cmp)
}

/// Describes the cost of the most expensive query that scans all faces.
fn scans(
    backend: &str,
    results: &[ResultRow],
    polygons: &PolygonMesh,
    scanning: &dyn Fn(&str, Relation) -> bool,
) -> Option<String> {
    let of_it = |r: &&ResultRow| r.backend == backend;
    let is_scan = |operation| match operation {
        Operation::Relation(relation) => scanning(backend, relation),
        _ => false,
    };
    let scans = results
        .iter()
        .filter(of_it)
        .filter(|r| r.sampled && is_scan(r.operation));
    let worst = scans.max_by(|a, b| {
        let cost = |r: &ResultRow| r.ns_per_element.unwrap_or(0.0);
        cost(a).total_cmp(&cost(b))
    })?;
    let each = duration(worst.ns_per_element?);
    let ResultRow { operation, per, .. } = worst;
    let faces = grouped(polygons.face_count());
    let mut text =
        format!("{backend} scans all {faces} faces to answer {operation}: {each} per {per}");
    if let Some(ratio) = worst.ratio_to_best.filter(|&ratio| ratio > 2.0) {
        text += &format!(", {} the time of the fastest backend", times(ratio));
    }
    Some(text + ".")
}

fn memory(backends: &[BackendReport]) -> Option<String> {
    let mut sizes: Vec<(f64, &str)> = backends
        .iter()
        .filter_map(|backend| Some((backend.bytes_per_vertex?, backend.name.as_str())))
        .collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let parts: Vec<String> = sizes
        .iter()
        .map(|(bytes, name)| format!("{name} {bytes:.0}"))
        .collect();
    (!parts.is_empty()).then(|| format!("Bytes per vertex: {}.", parts.join(", ")))
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
    operation: Operation,
    ratio: f64,
    standing: Standing,
) -> ResultRow {
    ResultRow {
        median_ns: Some(100.0 * ratio),
        elements: Some(1),
        ns_per_element: Some(100.0 * ratio),
        agreement: Agreement::Same,
        standing: Some(standing),
        ratio_to_best: Some(ratio),
        samples: 9,
        ..ResultRow::new(backend, operation)
    }
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use sixfold_workload::Backend;

    use super::*;
    use crate::inspect::{StudyMesh, inspect};

    #[test]
    fn the_fastest_is_named_unless_tied() {
        let mesh = shapes::tetrahedron();
        let backends = inspect(
            &StudyMesh::new("test", mesh.clone()),
            &Backend::structures(),
        )
        .backends;
        let (a, b) = (&backends[0].name, &backends[1].name);
        let mut results = vec![
            row(a, Operation::Build, 1.0, Standing::Best),
            row(b, Operation::Build, 1.5, Standing::Slower),
            row(a, Operation::Boundary, 1.0, Standing::Tied),
            row(b, Operation::Boundary, 1.01, Standing::Tied),
        ];
        let found = sentences(&backends, &results, &mesh, None, &|_, _| false);
        let expected = format!(
            "Of 2 operations, {a} is fastest in 1 (the second backend typically takes 1.5 × the \
             time), 1 has a tie for the fastest."
        );
        assert_eq!(found, [expected]);
        let found = sentences(&backends, &results[2..], &mesh, None, &|_, _| false);
        assert_eq!(found, ["Of 1 operation, 1 has a tie for the fastest."]);
        results[2].agreement = Agreement::Mismatch;
        let found = sentences(&backends, &results, &mesh, None, &|_, _| false).join(" ");
        assert!(
            found.contains(&format!("on {a} gives different results from")),
            "{found}"
        );
    }

    #[test]
    fn methods_are_compared_if_they_differ_significantly() {
        use sixfold::subdivision::Method::{Gather, Native, Scatter};
        let mesh = shapes::tetrahedron();
        let backends = inspect(
            &StudyMesh::new("test", mesh.clone()),
            &Backend::structures(),
        )
        .backends;
        let timed = |backend: &str, method, ratio, spread: f64| ResultRow {
            ci_low_ns: Some(100.0 * ratio / spread),
            ci_high_ns: Some(100.0 * ratio * spread),
            ..row(backend, Operation::Loop(method), ratio, Standing::Tied)
        };
        let searching = ResultRow {
            median_ns: None,
            estimated_ns: Some(9000.0),
            ..row("polygon-soup", Operation::Loop(Gather), 1.0, Standing::Tied)
        };
        let results = [
            searching,
            timed("face-vertex", Gather, 1.2, 1.3),
            timed("half-edge", Gather, 2.0, 1.01),
            timed("polygon-soup", Scatter, 3.0, 1.01),
            timed("face-vertex", Scatter, 1.0, 1.3),
            timed("half-edge", Scatter, 3.0, 1.01),
            timed("half-edge", Native, 0.5, 1.01),
        ];
        let found = sentences(&backends, &results, &mesh, None, &|_, _| false);
        let expected = "Loop: scatter is faster than gather on polygon-soup (30 ×); scatter is \
                        slower than gather on half-edge (1.5 ×); native is faster than gather and \
                        scatter on half-edge (4.0 ×).";
        assert!(
            found.iter().any(|sentence| sentence == expected),
            "{found:?}"
        );
    }

    #[test]
    fn ratios_and_counts_are_short() {
        let found = [1.034, 1.52, 9.96, 8710.4].map(times);
        assert_eq!(found, ["1.03 ×", "1.5 ×", "10 ×", "8,710 ×"]);
        assert_eq!(grouped(1_002_003), "1,002,003");
    }
}

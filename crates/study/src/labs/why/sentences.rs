//! Sentences on the reads of queries, and on what limits their times.

use sixfold_results::{Bound, WhyRow};
use sixfold_workload::SCAN_SAMPLE;

use sixfold_results::numbers::{counted, figure, grouped, list};

/// Describes the rows, which are sorted by relation: the backends with the fewest cache lines for
/// each query, what limits the times, and how exact the figures are.
pub(super) fn sentences(rows: &[WhyRow]) -> Vec<String> {
    [fewest_lines(rows), limits(rows), certainty(rows)]
        .into_iter()
        .flatten()
        .collect()
}

/// Lists the backends with the fewest cache lines for each relation. Backends whose figures are
/// equal as printed share the place. Returns `None` if no relation has two backends.
fn fewest_lines(rows: &[WhyRow]) -> Option<String> {
    // The best backends, and the relations for which they are the best.
    let mut groups: Vec<(Vec<&str>, Vec<&str>)> = Vec::new();
    for rows in rows.chunk_by(|a, b| a.reads.relation == b.reads.relation) {
        let least = rows.iter().map(|row| row.reads.lines);
        let least = figure(least.fold(f64::INFINITY, f64::min));
        let best = rows.iter().filter(|row| figure(row.reads.lines) == least);
        let best: Vec<&str> = best.map(|row| row.backend.as_str()).collect();
        let relation = rows[0].reads.relation.name();
        match groups.iter_mut().find(|(other, _)| *other == best) {
            _ if rows.len() < 2 => {}
            Some((_, relations)) => relations.push(relation),
            None => groups.push((best, vec![relation])),
        }
    }
    // The sort is stable: of two groups with equally many relations, the first stays the first.
    groups.sort_by_key(|(_, relations)| std::cmp::Reverse(relations.len()));
    let groups = groups.iter();
    let groups = groups.map(|(best, relations)| format!("{} for {}", list(best), list(relations)));
    let groups: Vec<String> = groups.collect();
    (!groups.is_empty()).then(|| format!("Fewest cache lines per query: {}.", groups.join("; ")))
}

/// Counts the times that each factor limits. Returns `None` if there are no rows.
fn limits(rows: &[WhyRow]) -> Option<String> {
    if rows.is_empty() {
        return None;
    }
    let all = rows.iter().filter(|row| row.timed.is_some()).count();
    let mut parts = Vec::new();
    for (bound, name) in [
        (Bound::Work, "work on nearby data"),
        (Bound::Bandwidth, "memory bandwidth"),
        (Bound::Latency, "memory latency"),
    ] {
        let is_it = |row: &&WhyRow| row.timed.as_ref().is_some_and(|timed| timed.bound == bound);
        let limited: Vec<&WhyRow> = rows.iter().filter(is_it).collect();
        match limited.len() {
            0 => {}
            count if count == all || bound == Bound::Work => {
                parts.push(format!("{name} in {}", grouped(count)));
            }
            count => {
                let backends = by_backend(&limited);
                parts.push(format!("{name} in {} ({backends})", grouped(count)));
            }
        }
    }
    Some(match all {
        0 => "No times were measured, so what limits them is not known.".to_owned(),
        _ => format!(
            "What limits the {}: {}.",
            counted(all, "time", "times"),
            list(parts)
        ),
    })
}

/// Lists the backends of `rows`: a single backend by its name, several each with its number of rows,
/// such as `2 of half-edge`.
fn by_backend(rows: &[&WhyRow]) -> String {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for row in rows {
        match counts.iter_mut().find(|(name, _)| *name == row.backend) {
            Some((_, count)) => *count += 1,
            None => counts.push((&row.backend, 1)),
        }
    }
    if let [(name, _)] = counts[..] {
        return name.to_owned();
    }
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    list(
        counts
            .iter()
            .map(|(name, count)| format!("{count} of {name}")),
    )
}

/// States how exact the figures are. Returns `None` if there are no rows.
fn certainty(rows: &[WhyRow]) -> Option<String> {
    let sampled = rows.iter().filter(|row| row.reads.sampled).count();
    let mut text = match sampled {
        0 => "The counts are exact.".to_owned(),
        sampled => format!(
            "The counts are exact, except in {} of {} rows (~), which are means of {SCAN_SAMPLE} \
             queries.",
            grouped(sampled),
            grouped(rows.len())
        ),
    };
    if rows.iter().any(|row| row.timed.is_some()) {
        text += " What limits a time is an estimate: the time is compared with the measured speed \
                 of memory.";
    }
    (!rows.is_empty()).then_some(text)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use sixfold::{Relation, shapes};
    use sixfold_results::BufferSpeed;

    use super::*;
    use crate::labs::why::{Timed, WhySettings, why};
    use sixfold_measure::StudyMesh;
    use sixfold_results::Agreement;

    fn timed(bound: Bound) -> Option<Timed> {
        Some(Timed {
            ns_per_element: 1.0,
            launch_ns: Vec::new(),
            ci_low_ns: None,
            ci_high_ns: None,
            sampled: false,
            agreement: Agreement::Same,
            speed: BufferSpeed {
                bytes: 1 << 20,
                gb_per_s: 10.0,
                latency_ns: 5.0,
            },
            floor_ns: 0.0,
            waits_ns: 0.0,
            bound,
        })
    }

    #[test]
    fn the_answer_agrees_with_the_rows() {
        let grid = shapes::triangle_grid(6, 6).expect("a grid");
        let settings = WhySettings {
            backends: vec!["face-vertex".into(), "half-edge".into()],
            relations: vec![Relation::VertexFaces, Relation::FaceVertices],
            ..WhySettings::default()
        };
        let stop = AtomicBool::new(false);
        let grid = StudyMesh::new("grid", grid);
        let why = why(&grid, &settings, &stop, &mut |_| ()).expect("both can hold the mesh");
        assert_eq!(why.sentences, sentences(&why.rows));
        let mut rows = why.rows;
        // Both backends have the same figure for face_vertices as printed.
        let lines = [2.5, 6.0, 1.121, 1.122];
        for (row, lines) in rows.iter_mut().zip(lines) {
            row.reads.lines = lines;
        }
        let fewest = "Fewest cache lines per query: face-vertex for vertex_faces; face-vertex and \
                      half-edge for face_vertices.";
        let untimed = "No times were measured, so what limits them is not known.";
        assert_eq!(sentences(&rows), [fewest, untimed, "The counts are exact."]);

        rows[0].timed = timed(Bound::Work);
        rows[1].timed = timed(Bound::Bandwidth);
        rows[2].timed = timed(Bound::Work);
        rows[3].reads.sampled = true;
        let sentences = sentences(&rows);
        assert_eq!(
            sentences[1],
            "What limits the 3 times: work on nearby data in 2 and memory bandwidth in 1 \
             (half-edge)."
        );
        assert!(
            sentences[2].starts_with("The counts are exact, except in 1 of 4 rows (~)"),
            "{sentences:?}"
        );
        // One backend cannot be compared.
        let one = super::sentences(&rows[..1]);
        assert_eq!(one[0], "What limits the 1 time: work on nearby data in 1.");
        assert_eq!(super::sentences(&[]), [""; 0]);
    }
}

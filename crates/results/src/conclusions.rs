//! The conclusions of a document, and whether a second measurement confirms them.

use serde::Serialize;

use crate::document::Results;
use crate::finding::Finding;
use crate::rows::Standing;

/// A conclusion of a document: one backend alone is the fastest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Conclusion {
    /// The name of the command, such as `study`.
    pub kind: &'static str,
    /// The names of the meshes.
    pub meshes: Vec<String>,
    /// The operation of a study, or the workload of a pick.
    pub of: String,
    /// The backend that is the fastest.
    pub winner: String,
    /// What the second measurement says.
    pub fate: Fate,
}

/// What a second measurement says about a conclusion.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// The same backend alone is the fastest.
    Stands,
    /// Another backend alone is the fastest.
    Reversed(String),
    /// No backend alone is the fastest, or it was not measured.
    CannotTell,
}

/// Returns the conclusions of `before`, and what `after` says about them.
///
/// Findings belong together if they are of the same command and, by their content, of the same meshes and, in picks, of
/// the same workload. The names of the meshes may differ: files may have moved. O(findings² + rows).
pub fn conclusions(before: &Results, after: &Results) -> Vec<Conclusion> {
    let all = before.findings.iter().flat_map(|finding| {
        let again = after.findings.iter().find(|other| is_again(finding, other));
        let found = again.map_or_else(Vec::new, winners);
        winners(finding).into_iter().map(move |(of, winner)| {
            let now = found.iter().find(|(other, _)| *other == of);
            Conclusion {
                kind: finding.kind(),
                meshes: finding.meshes().iter().map(|m| m.name.clone()).collect(),
                fate: match now {
                    Some((_, now)) if *now == winner => Fate::Stands,
                    Some((_, now)) => Fate::Reversed(now.clone()),
                    None => Fate::CannotTell,
                },
                of,
                winner,
            }
        })
    });
    all.collect()
}

/// Returns whether `other` measured the same meshes again.
fn is_again(finding: &Finding, other: &Finding) -> bool {
    let meshes = |finding: &Finding| -> Vec<String> {
        finding
            .meshes()
            .iter()
            .map(|mesh| mesh.sha256.clone())
            .collect()
    };
    let same_workload = match (finding, other) {
        (Finding::Pick(a), Finding::Pick(b)) => a.workload == b.workload,
        _ => true,
    };
    finding.kind() == other.kind() && meshes(finding) == meshes(other) && same_workload
}

/// Returns the operations or the workload of which one backend alone is the fastest, with this backend.
fn winners(finding: &Finding) -> Vec<(String, String)> {
    match finding {
        Finding::Study(study) => {
            let best = study
                .results
                .iter()
                .filter(|row| row.standing == Some(Standing::Best));
            best.map(|row| (row.operation.clone(), row.backend.clone()))
                .collect()
        }
        Finding::Pick(pick) if !pick.preliminary => {
            let first: Vec<&str> = pick
                .ranking
                .iter()
                .filter(|ranked| ranked.tied_with_best)
                .map(|ranked| &*ranked.backend)
                .collect();
            match first[..] {
                [only] => vec![(pick.workload.name.clone(), only.to_owned())],
                _ => Vec::new(),
            }
        }
        _ => Vec::new(),
    }
}

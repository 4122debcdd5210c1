//! Predicts which backends are fast for a workload, without measuring time.

use std::sync::atomic::AtomicBool;

use sixfold::{QueryCost, Relation};
use sixfold_core::Counts;
use sixfold_measure::{ElementKind, StudyMesh, patch};
use sixfold_workload::{Action, Backend, Schedule, Workload};

use crate::labs::pick::{PickError, PickSettings, qualified};
use crate::labs::why::{WhySettings, why};
use sixfold_results::Excluded;

/// Maximum number of faces on which reads are counted. Counting takes less than a second up to this
/// size. On a larger mesh, reads are counted on a patch of about this many faces.
const MOST_FACES: usize = 100_000;

/// The predicted costs of the backends for a workload on one mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The backends that meet all requirements, sorted by the number of table rows that the queries
    /// of the workload read; for equal numbers, by the bytes that the queries read. Backends that
    /// scan all faces for some operation come last.
    pub candidates: Vec<Predicted>,
    /// The backends that do not meet the requirements, each with the reason.
    pub excluded: Vec<Excluded>,
    /// The number of faces of the patch on which reads were counted; `None` if they were counted on
    /// the whole mesh.
    pub patch_faces: Option<usize>,
}

/// The predicted cost of one backend.
#[derive(Clone, Debug, PartialEq)]
pub struct Predicted {
    /// The name of the backend.
    pub backend: String,
    /// The operations of the workload that scan all faces of the mesh for each element on this
    /// backend.
    pub scans: Vec<Action>,
    /// The mean number of table rows that the queries of one operation of the workload read. `None`
    /// if the workload has no queries, if it has edits or subdivision, which are not counted, or if
    /// some operation scans all faces.
    pub reads: Option<f64>,
    /// The mean number of bytes that these queries read, in the same cases.
    pub bytes: Option<f64>,
}

/// Predicts which backends are fast for a workload, without measuring time.
///
/// The prediction uses two properties of each backend: which queries scan all faces, and how many
/// table rows the queries read on this mesh, or on a patch of 100,000 faces. Workloads with edits or
/// subdivision are not predicted.
///
/// # Errors
///
/// Returns an error if the name of a backend is unknown or not unique, or if the mesh has no faces.
pub fn predict(
    study_mesh: &StudyMesh,
    settings: &PickSettings,
    stop: &AtomicBool,
) -> Result<Prediction, PickError> {
    predict_from(study_mesh, settings, MOST_FACES, stop)
}

/// Predicts from reads on at most about `most_faces` faces.
fn predict_from(
    study_mesh: &StudyMesh,
    settings: &PickSettings,
    most_faces: usize,
    stop: &AtomicBool,
) -> Result<Prediction, PickError> {
    let (qualifying, excluded) = qualified(study_mesh, settings)?;
    let polygons = &study_mesh.polygons;
    let counts = polygons.counts(study_mesh.facts.edges);
    let workload = &settings.workload;
    let local: Vec<Backend> = qualifying
        .iter()
        .filter(|backend| scanning_actions(workload, &backend.info.costs).is_empty())
        .copied()
        .collect();
    // The queries of a patch read as many rows as the queries of the mesh. The weights are those of
    // the whole mesh.
    let piece = (polygons.face_count() > most_faces)
        .then(|| StudyMesh::new(study_mesh.name.clone(), patch(polygons, most_faces)));
    let counted_mesh = piece.as_ref().unwrap_or(study_mesh);
    let reads = reads_by_backend(counted_mesh, &local, workload, &counts, stop);
    let mut candidates: Vec<Predicted> = qualifying
        .iter()
        .map(|backend| {
            let counted = reads.iter().find(|(name, _)| name == backend.name());
            Predicted {
                backend: backend.name().to_owned(),
                scans: scanning_actions(workload, &backend.info.costs),
                reads: counted.map(|(_, [reads, _])| *reads),
                bytes: counted.map(|(_, [_, bytes])| *bytes),
            }
        })
        .collect();
    candidates.sort_by(|a, b| {
        let costs = |p: &Predicted| [p.reads, p.bytes].map(|cost| cost.unwrap_or(f64::INFINITY));
        let ([reads_a, bytes_a], [reads_b, bytes_b]) = (costs(a), costs(b));
        let scans = a.scans.len().cmp(&b.scans.len());
        let reads = scans.then(reads_a.total_cmp(&reads_b));
        reads.then(bytes_a.total_cmp(&bytes_b))
    });
    Ok(Prediction {
        candidates,
        excluded,
        patch_faces: piece.map(|piece| piece.polygons.face_count()),
    })
}

/// Returns the actions of a workload that scan all faces for each element.
fn scanning_actions(workload: &Workload, costs: &[QueryCost; 9]) -> Vec<Action> {
    let scans = |action: &Action| {
        let mut relations = action.relations().into_iter();
        relations.any(|relation| costs[relation as usize] == QueryCost::Scan)
    };
    let actions = workload.mix.iter().map(|part| part.action);
    actions.filter(scans).collect()
}

/// Returns for each backend the number of table rows and of bytes that one operation of the mix reads.
/// Empty if the mix has no queries, or if it changes the connectivity.
fn reads_by_backend(
    study_mesh: &StudyMesh,
    backends: &[Backend],
    workload: &Workload,
    counts: &Counts,
    stop: &AtomicBool,
) -> Vec<(String, [f64; 2])> {
    let relations = workload.relations();
    let known = Backend::structures();
    let known = |backend: &&Backend| known.iter().any(|k| k.name() == backend.name());
    let (ours, extra): (Vec<&Backend>, Vec<&Backend>) = backends.iter().partition(known);
    let mut actions = workload.mix.iter().map(|part| part.action);
    let is_edited = actions.any(Action::changes_connectivity);
    if relations.is_empty() || backends.is_empty() || is_edited {
        return Vec::new();
    }
    let settings = WhySettings {
        backends: ours
            .iter()
            .map(|backend| backend.name().to_owned())
            .collect(),
        extra: extra.into_iter().copied().collect(),
        relations,
        timing: None,
    };
    let Ok(counted) = why(study_mesh, &settings, stop, &mut |_| ()) else {
        return Vec::new();
    };
    let weights = query_weights(workload, counts);
    let of_backend = |backend: &Backend| {
        let rows = counted.rows.iter().filter(|r| r.backend == backend.name());
        let sums = rows.fold([0.0; 2], |[reads, bytes], row| {
            let weight = weights[row.reads.relation as usize];
            [
                reads + weight * row.reads.reads,
                bytes + weight * row.reads.bytes,
            ]
        });
        (backend.name().to_owned(), sums)
    };
    backends.iter().map(of_backend).collect()
}

/// Returns for each relation the number of queries in one operation of the mix, as a mean.
fn query_weights(workload: &Workload, counts: &Counts) -> [f64; 9] {
    let schedule = Schedule::new(workload, counts);
    let mut weights = [0.0; 9];
    for (part, share) in schedule.parts.iter().zip(&schedule.shares) {
        for relation in part.action.relations() {
            let elements = match part.action {
                Action::Pass(_) => elements(relation, counts),
                _ => 1.0,
            };
            weights[relation as usize] += share * elements;
        }
    }
    weights
}

/// Returns the number of elements at which a relation is queried in a pass over the mesh.
fn elements(relation: Relation, counts: &Counts) -> f64 {
    let elements = match ElementKind::queried_by(relation) {
        ElementKind::Vertex => counts.vertices,
        ElementKind::Edge => counts.edges,
        ElementKind::Face => counts.faces,
    };
    elements as f64
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;
    use sixfold_measure::Operation;
    use sixfold_results::{Confidence, Policy};
    use sixfold_workload::built_in;

    use super::*;
    use crate::engine::effort::Effort;

    fn settings(workload: &str) -> PickSettings {
        PickSettings {
            workload: built_in(workload).expect("a built-in workload"),
            backends: Vec::new(),
            extra: Vec::new(),
            needs: Vec::new(),
            max_memory: None,
            effort: Effort::of_rounds(1),
            confidence: Confidence::default(),
            seed: 1,
            heap: Policy::Kept,
        }
    }

    fn predicted(workload: &str) -> Prediction {
        let mesh = StudyMesh::new("torus", shapes::triangle_torus(20, 20).expect("small"));
        predict(&mesh, &settings(workload), &AtomicBool::new(false)).expect("it has faces")
    }

    #[test]
    fn backends_that_scan_come_last_with_the_scanning_operations() {
        let prediction = predicted("smoothing");
        let scans: Vec<bool> = prediction
            .candidates
            .iter()
            .map(|p| !p.scans.is_empty())
            .collect();
        assert_eq!(scans, [false, false, false, false, true, true]);
        assert_eq!(prediction.excluded, []);
        let last = &prediction.candidates[5];
        assert!(
            last.scans.contains(&Action::Pass(Operation::VvSmooth)),
            "{last:?}"
        );
        assert_eq!(last.reads, None);
        let reads: Vec<f64> = prediction.candidates[..4]
            .iter()
            .map(|p| p.reads.expect("a small mesh"))
            .collect();
        assert!(reads.is_sorted(), "{reads:?}");
        // A pass over 400 vertices of valence 6 reads a row for each neighbour, and one for the
        // vertex.
        assert!(reads[0] >= 400.0 * 7.0, "{reads:?}");
        // Both read one row for each neighbour, but a row of the half-edge mesh is smaller.
        let order: Vec<&str> = (prediction.candidates.iter())
            .map(|p| p.backend.as_str())
            .take(2)
            .collect();
        assert_eq!(order, ["half-edge", "winged-edge"]);
        assert_eq!(reads[0], reads[1]);
        let [first, second] = [0, 1].map(|i| prediction.candidates[i].bytes);
        assert!(first < second, "{first:?} {second:?}");
        let edited = predicted("decimation");
        assert!(edited.candidates.iter().all(|p| p.reads.is_none()));
    }

    #[test]
    fn a_large_mesh_is_predicted_from_a_patch() {
        let mesh = StudyMesh::new("torus", shapes::triangle_torus(30, 30).expect("small"));
        let settings = settings("smoothing");
        let stop = AtomicBool::new(false);
        let predict = |most| predict_from(&mesh, &settings, most, &stop).expect("it has faces");
        let (whole, patch) = (predict(1800), predict(600));
        assert_eq!(whole.patch_faces, None);
        assert_eq!(patch.patch_faces, Some(600));
        for (a, b) in whole.candidates.iter().zip(&patch.candidates) {
            let [a_reads, b_reads] = [a.reads, b.reads];
            assert_eq!(a_reads.is_some(), b_reads.is_some(), "{a:?} {b:?}");
            // Vertices on the boundary of the patch have fewer neighbours.
            let ratio = b_reads.unwrap_or(1.0) / a_reads.unwrap_or(1.0);
            assert!((0.6..1.5).contains(&ratio), "{a:?} {b:?}");
        }
    }

    #[test]
    fn the_weights_are_the_queries_of_one_operation() {
        let mesh = shapes::triangle_torus(20, 20).expect("small");
        let counts = mesh.counts(1200);
        let mut workload = built_in("smoothing").expect("built in");
        workload
            .mix
            .retain(|part| part.action == Action::Pass(Operation::VvSmooth));
        let mut expected = [0.0; 9];
        expected[Relation::VertexVertices as usize] = 400.0;
        assert_eq!(query_weights(&workload, &counts), expected);
        workload.mix[0].action = Action::Relation(Relation::EdgeFaces);
        let mut expected = [0.0; 9];
        expected[Relation::EdgeFaces as usize] = 1.0;
        assert_eq!(query_weights(&workload, &counts), expected);
    }
}

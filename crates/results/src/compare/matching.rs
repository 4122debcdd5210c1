//! Finds the measurements that two documents have in common.

use std::collections::BTreeMap;

use super::{CompareError, Measurement};
use crate::document::Results;
use crate::figure::Figure;
use crate::finding::Finding;
use crate::numbers::counted;
use crate::rows::MeshReport;

/// The meshes that two documents have in common.
pub(super) struct CommonMeshes<'r> {
    before: Vec<&'r MeshReport>,
    after: Vec<&'r MeshReport>,
}

impl<'r> CommonMeshes<'r> {
    pub(super) fn new(before: &'r Results, after: &'r Results) -> Self {
        let all = |results: &'r Results| {
            let mut meshes: Vec<&MeshReport> = Vec::new();
            for mesh in results.findings.iter().flat_map(Finding::meshes) {
                if !meshes.contains(&mesh) {
                    meshes.push(mesh);
                }
            }
            meshes
        };
        Self {
            before: all(before),
            after: all(after),
        }
    }

    fn are_same(&self, a: &MeshReport, b: &MeshReport) -> bool {
        let single = self.before.len() == 1 && self.after.len() == 1;
        a.sha256 == b.sha256 || (a.facts == b.facts && (single || a.name == b.name))
    }

    /// Returns an error if both documents have meshes, but none in common.
    pub(super) fn check(&self) -> Result<(), CompareError> {
        let (Some(a), Some(b)) = (self.before.first(), self.after.first()) else {
            return Ok(());
        };
        let mut pairs = self
            .before
            .iter()
            .flat_map(|&a| self.after.iter().map(move |&b| (a, b)));
        if pairs.any(|(a, b)| self.are_same(a, b)) {
            return Ok(());
        }
        let described = |mesh: &MeshReport| {
            let vertices = counted(mesh.facts.vertices, "vertex", "vertices");
            let faces = counted(mesh.facts.faces, "face", "faces");
            format!("{} ({vertices}, {faces})", mesh.name)
        };
        Err(CompareError::OtherMesh {
            before: described(a),
            after: described(b),
        })
    }

    /// Returns the name of the mesh in `before`. If `before` does not have the mesh, returns
    /// the name of `mesh`.
    pub(super) fn name(&self, mesh: &'r MeshReport, is_second: bool) -> &'r str {
        let same = |other: &&&MeshReport| self.are_same(other, mesh);
        let first = self.before.iter().filter(|_| is_second).find(same);
        first.map_or(mesh.name.as_str(), |other| other.name.as_str())
    }
}

/// A figure of a document, and its finding.
pub(super) struct MeasuredFigure<'r> {
    pub(super) key: Measurement,
    pub(super) figure: Figure<'r>,
    pub(super) finding: &'r Finding,
}

/// The measured figures of a document.
pub(super) struct AllMeasured<'r> {
    pub(super) in_order: Vec<MeasuredFigure<'r>>,
    places: BTreeMap<Measurement, usize>,
}

impl<'r> AllMeasured<'r> {
    pub(super) fn get(&self, key: &Measurement) -> Option<&MeasuredFigure<'r>> {
        self.places.get(key).map(|&place| &self.in_order[place])
    }

    /// Returns the measurements that `other` does not have.
    pub(super) fn without(&self, other: &Self) -> Vec<Measurement> {
        let keys = self.in_order.iter().map(|measured| &measured.key);
        keys.filter(|key| other.get(key).is_none())
            .cloned()
            .collect()
    }
}

/// Collects the figures that were measured or counted. If two figures have the same key, keeps the
/// first.
pub(super) fn measurements<'r>(
    results: &'r Results,
    name: impl Fn(&'r MeshReport) -> &'r str,
) -> AllMeasured<'r> {
    let (mut in_order, mut places) = (Vec::new(), BTreeMap::new());
    for finding in &results.findings {
        for figure in finding.figures() {
            if !figure.is_measured() {
                continue;
            }
            let key = Measurement {
                mesh: figure.mesh.map_or("", &name).to_owned(),
                kind: finding.kind(),
                case: figure.row.case.clone(),
                operation: figure.row.operation.clone(),
                backend: figure.row.backend.clone(),
            };
            if !places.contains_key(&key) {
                places.insert(key.clone(), in_order.len());
                in_order.push(MeasuredFigure {
                    key,
                    figure,
                    finding,
                });
            }
        }
    }
    AllMeasured { in_order, places }
}

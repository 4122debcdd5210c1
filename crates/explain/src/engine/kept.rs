//! The mesh that an engine keeps, and the structures that were built from it.

use std::collections::BTreeMap;

use sixfold::{Relation, structure_infos};
use sixfold_core::EditByName;

use super::source::Sourced;
use crate::built_mesh::BuiltMesh;
use crate::edit::EditTrace;
use crate::error::ExplainError;
use crate::structure::Structure;
use crate::sweep::{Swept, swept};

/// Maximum number of entries in each list of an edit.
const MOST_ENTRIES: usize = 2_000;

/// A mesh, and the structures that were built from it so far.
pub(super) struct Kept {
    pub(super) sourced: Sourced,
    /// By the names of the structures. A structure that cannot hold the mesh has its error.
    built: BTreeMap<&'static str, Result<EditedMesh, ExplainError>>,
    /// The structures that refuse the mesh, but hold it with its polygons cut into triangles; `None` before it was asked.
    holding_triangles: Option<Vec<&'static str>>,
    /// The structures without probes, for sweeps.
    swept: BTreeMap<&'static str, Result<Box<dyn Swept>, ExplainError>>,
}

impl Kept {
    pub(super) fn new(sourced: Sourced) -> Self {
        Self {
            sourced,
            built: BTreeMap::new(),
            holding_triangles: None,
            swept: BTreeMap::new(),
        }
    }

    /// Returns whether the structure refuses the mesh, but holds it with its polygons cut into triangles. The first call
    /// takes the time to cut the polygons.
    pub(super) fn holds_only_triangles(&mut self, structure: &str) -> bool {
        let polygons = &self.sourced.polygons;
        let names = self.holding_triangles.get_or_insert_with(|| {
            if polygons.first_polygon().is_none() {
                return Vec::new();
            }
            let Ok(cut) = polygons.triangulated() else {
                return Vec::new();
            };
            let mut infos = structure_infos();
            infos.retain(|info| {
                let holds = |polygons| info.capabilities.check(polygons).is_ok();
                !holds(polygons) && holds(&cut.polygons)
            });
            infos.iter().map(|info| info.name).collect()
        });
        names.contains(&structure)
    }

    /// Frees the memory of the structures. They are built again when they are needed.
    pub(super) fn free_structures(&mut self) {
        self.built.clear();
        self.swept.clear();
    }

    /// Runs queries on a structure without a probe, and keeps the structure. Returns the number of results.
    ///
    /// The time of the queries, and for the first sweep the time to build the structure.
    pub(super) fn sweep(
        &mut self,
        structure: &Structure,
        relation: Relation,
        queries: usize,
    ) -> Result<usize, ExplainError> {
        let name = structure.name();
        let polygons = &self.sourced.polygons;
        let mesh = self.swept.entry(name).or_insert_with(|| {
            swept(name, polygons).unwrap_or(Err(ExplainError::NoSweeps { structure: name }))
        });
        match mesh {
            Ok(mesh) => Ok(mesh.sweep(relation, queries)),
            Err(error) => Err(error.clone()),
        }
    }

    /// Calls `answer` with a structure after `edits`, and keeps the structure.
    ///
    /// O(edits) and the time of the edits that the kept structure has not run yet. If it has run others,
    /// or there is none, also the time to build the structure.
    pub(super) fn with_built<T>(
        &mut self,
        structure: &Structure,
        edits: &[EditByName],
        answer: impl FnOnce(&mut EditedMesh) -> Result<T, ExplainError>,
    ) -> Result<T, ExplainError> {
        // The structure is taken out, so that one that panics is not kept.
        let built = match self.built.remove(structure.name()) {
            Some(Ok(edited)) if !edited.has_run_only(edits) => None,
            built => built,
        };
        let mut built = built.unwrap_or_else(|| {
            let built = structure.build(&self.sourced.polygons);
            built.map(EditedMesh::new)
        });
        let answered = match &mut built {
            Ok(edited) => edited.run_others(edits).and_then(|()| answer(edited)),
            Err(refused) => Err(refused.clone()),
        };
        self.built.insert(structure.name(), built);
        answered
    }
}

/// A structure, with the edits that it has run.
pub(super) struct EditedMesh {
    mesh: BuiltMesh,
    /// The accepted edits: a refused one changes nothing.
    edits: Vec<EditByName>,
}

impl EditedMesh {
    fn new(mesh: BuiltMesh) -> Self {
        Self {
            mesh,
            edits: Vec::new(),
        }
    }

    pub(super) fn mesh(&self) -> &BuiltMesh {
        &self.mesh
    }

    /// Returns whether `edits` begin with the edits that were run.
    fn has_run_only(&self, edits: &[EditByName]) -> bool {
        // As text, because the positions 0 and -0 are equal.
        let mut pairs = edits.iter().zip(&self.edits);
        edits.len() >= self.edits.len() && pairs.all(|(a, b)| a.to_string() == b.to_string())
    }

    /// Runs those of `edits` that were not run yet, up to the first one that is refused.
    fn run_others(&mut self, edits: &[EditByName]) -> Result<(), ExplainError> {
        for edit in &edits[self.edits.len()..] {
            self.mesh.apply_accepted(edit)?;
            self.edits.push(edit.clone());
        }
        Ok(())
    }

    /// Runs one more edit, and returns what it does.
    pub(super) fn edit(&mut self, edit: &EditByName) -> Result<EditTrace, ExplainError> {
        let trace = self.mesh.edit_briefly(edit, MOST_ENTRIES)?;
        if trace.refusal.is_none() {
            self.edits.push(edit.clone());
        }
        Ok(trace)
    }
}

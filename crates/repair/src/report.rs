//! The report of a repair: what each step did, and what it left.

use sixfold_core::{FaceId, PolygonMesh, VertexId};

use crate::outcome::{Left, StepCounts};
use crate::step::Step;
use crate::trace::ElementMap;

/// A repaired mesh, the maps of its elements, and the report of each step.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    /// The mesh after all steps.
    pub polygons: PolygonMesh,
    /// The vertices before and after.
    pub vertices: ElementMap<VertexId>,
    /// The faces before and after.
    pub faces: ElementMap<FaceId>,
    /// What each step did, in order.
    pub steps: Vec<StepReport>,
}

impl Repaired {
    /// Returns whether a step changed the mesh.
    pub fn is_changed(&self) -> bool {
        self.steps.iter().any(|report| report.counts.is_change())
    }
}

/// What one step did.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StepReport {
    /// The step with its options.
    pub step: Step,
    /// The numbers of changed elements.
    pub counts: StepCounts,
    /// The places that the step could not repair, in order.
    pub left: Vec<Left>,
}

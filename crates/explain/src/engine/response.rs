//! What a request is answered with.

use serde::Serialize;
use sixfold::Facts;
use sixfold::repair::{FaultKind, Place, Step, StepCounts, StepReport};

use super::refinement::Parent;
use super::welding::Welded;
use crate::built_mesh::Geometry;
use crate::edit::EditTrace;
use crate::error::Refused;
use crate::memory::Memory;
use crate::records::Records;
use crate::trace::Trace;
use crate::walk::Walk;

/// A response: its content, and what reading the mesh left out or changed.
#[derive(Serialize)]
pub(super) struct Response {
    #[serde(flatten)]
    pub(super) content: Content,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) notes: Vec<String>,
}

#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Content {
    Structures {
        answers: Vec<Answer>,
        refused: Vec<Refused>,
        /// Those of the refusing structures that hold the mesh if its polygons are cut into triangles.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        holding_triangles: Vec<&'static str>,
    },
    Facts {
        facts: Facts,
    },
    Verdicts {
        verdicts: Vec<Verdict>,
        faults: Vec<Found>,
    },
    Levels {
        levels: Vec<Geometry>,
    },
    Stencil {
        parents: Vec<Parent>,
    },
    Weld {
        weld: Welded,
    },
    Error {
        error: String,
    },
}

/// The answer of one structure.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Answer {
    Tables {
        backend: &'static str,
        records: Vec<Records>,
        /// The rows that an edit moved, and the names of their elements.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        moved: Vec<[String; 2]>,
    },
    Trace(Trace),
    Edit(EditTrace),
    Walk(Walk),
    Memory(Memory),
    Geometry {
        backend: &'static str,
        #[serde(flatten)]
        geometry: Geometry,
    },
    Sweep {
        backend: &'static str,
        results: usize,
    },
    Repair {
        backend: &'static str,
        steps: Vec<StepDone>,
        #[serde(flatten)]
        geometry: Geometry,
    },
}

/// What one step of a repair did.
#[derive(Serialize)]
pub(super) struct StepDone {
    step: Step,
    counts: StepCounts,
    /// What the step could not repair, in words.
    left: Vec<String>,
}

impl From<&StepReport> for StepDone {
    fn from(report: &StepReport) -> Self {
        Self {
            step: report.step,
            counts: report.counts,
            left: report.left.iter().map(ToString::to_string).collect(),
        }
    }
}

/// Whether a structure holds the mesh.
#[derive(Serialize)]
pub(super) struct Verdict {
    pub(super) backend: &'static str,
    pub(super) holds: bool,
    pub(super) reason: Option<String>,
    /// The kinds of faults for which the structure refuses the mesh.
    pub(super) faults: Vec<FaultKind>,
}

/// A fault of the mesh, with its repairs.
#[derive(Serialize)]
pub(super) struct Found {
    pub(super) kind: FaultKind,
    pub(super) title: &'static str,
    pub(super) count: usize,
    /// The first of the elements with the fault.
    pub(super) places: Vec<Place>,
    pub(super) repairs: Vec<Step>,
}

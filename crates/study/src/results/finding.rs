//! The findings of the labs. A lab is one kind of measurement, with its own command.

use serde::{Deserialize, Serialize};

use crate::labs::growth::GrowthReport;
use crate::labs::memory::Audit;
use crate::labs::neighbours::NeighboursReport;
use crate::labs::orders::OrdersReport;
use crate::labs::pick::PickReport;
use crate::labs::study::Report;
use crate::labs::why::Why;
use crate::results::figure::Figure;
use crate::results::read::ReadError;
use crate::results::rows::MeshReport;
use crate::results::run::Run;

/// The result of one measuring command. In JSON, the field `kind` has the name of the command.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Finding {
    /// `sixfold study`: the times of operations on one mesh.
    Study(Box<Report>),
    /// `sixfold orders`: one mesh with its elements in several orders.
    Orders(Box<OrdersReport>),
    /// `sixfold growth`: one shape in several sizes.
    Growth(Box<GrowthReport>),
    /// `sixfold why`: the memory that queries read, compared with the times of the queries.
    Why(Box<Why>),
    /// `sixfold memory`: the bytes of each backend, counted in three ways.
    Memory(Box<Audit>),
    /// `sixfold neighbours`: the times of spatial indices on one mesh.
    Neighbours(Box<NeighboursReport>),
    /// `sixfold pick`: the backends, ranked for a workload.
    Pick(Box<PickReport>),
}

/// The names of the commands that measure findings, in the order of [`Finding`].
pub(crate) const KINDS: [&str; 7] = [
    "study",
    "orders",
    "growth",
    "why",
    "memory",
    "neighbours",
    "pick",
];

/// The parts that the findings of all labs have.
pub(crate) struct Common<'f> {
    pub(crate) run: &'f Run,
    /// The measured meshes. The list is empty for a lab that makes its own meshes.
    pub(crate) meshes: &'f [MeshReport],
    pub(crate) sentences: &'f [String],
    pub(crate) warnings: &'f [String],
    /// Whether the measurement was stopped early.
    pub(crate) interrupted: bool,
}

/// The common interface of the findings of all labs.
pub(crate) trait LabFinding {
    /// Returns the parts that all findings have.
    fn common(&self) -> Common<'_>;
    /// Returns the run, so that it can be changed.
    fn run_mut(&mut self) -> &mut Run;
    /// Sets the meshes after reading. Returns an error if their number is wrong.
    fn set_meshes(&mut self, meshes: Vec<MeshReport>) -> Result<(), ReadError>;
    /// Counts the results that differ, for no known reason, from the results of other backends of
    /// Sixfold.
    fn mismatches(&self) -> usize;
    /// Returns the times and counts of bytes of the finding, for comparisons and CSV.
    fn figures(&self) -> Vec<Figure<'_>>;
    /// Returns an error for values that no measurement can produce.
    fn check(&self) -> Result<(), ReadError> {
        Ok(())
    }
}

impl Finding {
    fn lab(&self) -> &dyn LabFinding {
        match self {
            Self::Study(finding) => &**finding,
            Self::Orders(finding) => &**finding,
            Self::Growth(finding) => &**finding,
            Self::Why(finding) => &**finding,
            Self::Memory(finding) => &**finding,
            Self::Neighbours(finding) => &**finding,
            Self::Pick(finding) => &**finding,
        }
    }

    fn lab_mut(&mut self) -> &mut dyn LabFinding {
        match self {
            Self::Study(finding) => &mut **finding,
            Self::Orders(finding) => &mut **finding,
            Self::Growth(finding) => &mut **finding,
            Self::Why(finding) => &mut **finding,
            Self::Memory(finding) => &mut **finding,
            Self::Neighbours(finding) => &mut **finding,
            Self::Pick(finding) => &mut **finding,
        }
    }

    /// Returns the name of the command that measured this finding, such as `study`.
    pub const fn kind(&self) -> &'static str {
        KINDS[match self {
            Self::Study(_) => 0,
            Self::Orders(_) => 1,
            Self::Growth(_) => 2,
            Self::Why(_) => 3,
            Self::Memory(_) => 4,
            Self::Neighbours(_) => 5,
            Self::Pick(_) => 6,
        }]
    }

    /// Returns how the finding was measured.
    pub fn run(&self) -> &Run {
        self.lab().common().run
    }

    /// Returns the run, so that it can be changed. For example, the command line adds `command`.
    pub fn run_mut(&mut self) -> &mut Run {
        self.lab_mut().run_mut()
    }

    /// Returns the measured meshes. The list is empty for a lab that makes its own meshes.
    pub fn meshes(&self) -> &[MeshReport] {
        self.lab().common().meshes
    }

    /// Returns the sentences that describe the main results.
    pub fn sentences(&self) -> &[String] {
        self.lab().common().sentences
    }

    /// Returns sentences about possible faults of the measurement and their remedies.
    pub fn warnings(&self) -> &[String] {
        self.lab().common().warnings
    }

    /// Returns true if the measurement was stopped early. Some results may then be missing.
    pub fn is_interrupted(&self) -> bool {
        self.lab().common().interrupted
    }

    /// Counts the results that differ, for no known reason, from the results of other backends of
    /// Sixfold.
    pub fn mismatches(&self) -> usize {
        self.lab().mismatches()
    }

    /// Returns the times and counts of bytes of the finding: one figure for each mesh, case,
    /// operation and backend.
    pub fn figures(&self) -> Vec<Figure<'_>> {
        self.lab().figures()
    }

    /// Adds the run and the meshes to a finding that was read from a file, and checks its values.
    pub(crate) fn complete(&mut self, run: Run, meshes: Vec<MeshReport>) -> Result<(), ReadError> {
        let lab = self.lab_mut();
        *lab.run_mut() = run;
        lab.set_meshes(meshes)?;
        lab.check()
    }
}

macro_rules! from_lab {
    ($($lab:ty => $kind:ident),*) => {$(
        impl From<$lab> for Finding {
            fn from(finding: $lab) -> Self {
                Self::$kind(finding.into())
            }
        }
    )*};
}

from_lab!(
    Report => Study,
    OrdersReport => Orders,
    GrowthReport => Growth,
    Why => Why,
    Audit => Memory,
    NeighboursReport => Neighbours,
    PickReport => Pick
);

/// Returns the only mesh of a finding. Returns an error if the number of meshes is not 1.
pub(crate) fn only_mesh(meshes: Vec<MeshReport>) -> Result<MeshReport, ReadError> {
    let count = meshes.len();
    let only: Result<[MeshReport; 1], _> = meshes.try_into();
    only.map(|[mesh]| mesh).map_err(|_| ReadError::Malformed {
        cause: format!("a finding of one mesh has {count} meshes"),
    })
}

//! The findings of the labs. A lab is one kind of measurement, with its own command.

use serde::Serialize;

use crate::document::Results;
use crate::figure::Figure;
use crate::findings::growth::GrowthReport;
use crate::findings::memory::Audit;
use crate::findings::neighbours::NeighboursReport;
use crate::findings::orders::OrdersReport;
use crate::findings::pick::PickReport;
use crate::findings::study::Report;
use crate::findings::why::Why;
use crate::read::{ReadError, parse_json};
use crate::rows::{Agreement, MeshReport};
use crate::run::Run;

/// Defines [`Finding`] and what differs only in the lab: the conversions, the iterators of
/// [`Results`], and the access to the fields that the findings of all labs have. A lab is named with
/// its finding and the field of the mesh or meshes.
macro_rules! findings {
    ($(
        $(#[$about:meta])*
        $kind:ident($finding:ty, $meshes:ident) = $name:literal,
        $(#[$items_about:meta])*
        $items:ident;
    )+) => {
        /// The result of one measuring command. In JSON, the field `kind` has the name of the
        /// command.
        #[derive(Clone, Debug, Serialize)]
        #[serde(tag = "kind")]
        #[non_exhaustive]
        pub enum Finding {
            $($(#[$about])* #[serde(rename = $name)] $kind(Box<$finding>),)+
        }

        /// The names of the commands that measure findings, in the order of [`Finding`].
        pub(crate) const KINDS: [&str; [$($name),+].len()] = [$($name),+];

        impl Finding {
            /// Parses the JSON of a finding. `kind` is the value of its field `kind`, which is read
            /// first: a derived reader would keep a copy of all fields until it knows the kind.
            pub(crate) fn parse(kind: &str, text: &str) -> Result<Self, ReadError> {
                match kind {
                    $($name => parse_json::<$finding>(text).map(Self::from),)+
                    other => Err(ReadError::Malformed {
                        cause: format!("a finding has the unknown kind `{other}`"),
                    }),
                }
            }

            fn lab(&self) -> &dyn LabFinding {
                match self {
                    $(Self::$kind(finding) => &**finding,)+
                }
            }

            fn lab_mut(&mut self) -> &mut dyn LabFinding {
                match self {
                    $(Self::$kind(finding) => &mut **finding,)+
                }
            }

            /// Returns the name of the command that measured this finding, such as `study`.
            pub const fn kind(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $name,)+
                }
            }
        }

        $(impl $finding {
            /// Returns the rows of the finding with their meshes: one for each mesh, case, operation
            /// and backend.
            pub fn figures(&self) -> Vec<Figure<'_>> {
                LabFinding::figures(self)
            }
        }

        impl From<$finding> for Finding {
            fn from(finding: $finding) -> Self {
                Self::$kind(finding.into())
            }
        }

        impl CommonFields for $finding {
            fn common(&self) -> Common<'_> {
                Common {
                    run: &self.run,
                    meshes: self.$meshes.list(),
                    sentences: &self.sentences,
                    warnings: &self.warnings,
                    interrupted: self.interrupted,
                }
            }

            fn parts_mut(&mut self) -> (&mut Run, &mut dyn Meshes, &mut bool) {
                (&mut self.run, &mut self.$meshes, &mut self.interrupted)
            }
        })+

        impl Results {
            $($(#[$items_about])*
            pub fn $items(&self) -> impl Iterator<Item = &$finding> {
                self.findings.iter().filter_map(|finding| match finding {
                    Finding::$kind(finding) => Some(&**finding),
                    _ => None,
                })
            })+
        }

        $(impl TryFrom<Finding> for $finding {
            type Error = Finding;

            fn try_from(finding: Finding) -> Result<Self, Finding> {
                match finding {
                    Finding::$kind(finding) => Ok(*finding),
                    other => Err(other),
                }
            }
        })+
    };
}

findings! {
    /// `sixfold study`: the times of operations on one mesh.
    Study(Report, mesh) = "study",
    /// Iterates over the studies.
    studies;

    /// `sixfold orders`: one mesh with its elements in several orders.
    Orders(OrdersReport, mesh) = "orders",
    /// Iterates over the measurements of a mesh in several orders.
    orders;

    /// `sixfold growth`: one shape in several sizes.
    Growth(GrowthReport, meshes) = "growth",
    /// Iterates over the measurements of a shape in several sizes.
    growth;

    /// `sixfold why`: the memory that queries read, compared with the times of the queries.
    Why(Why, mesh) = "why",
    /// Iterates over the explanations of query times by the memory that the queries read.
    why;

    /// `sixfold memory`: the bytes of each backend, counted in three ways.
    Memory(Audit, mesh) = "memory",
    /// Iterates over the counts of the bytes of each backend.
    memory;

    /// `sixfold neighbours`: the times of spatial indices on one mesh.
    Neighbours(NeighboursReport, mesh) = "neighbours",
    /// Iterates over the measurements of spatial indices.
    neighbours;

    /// `sixfold pick`: the backends, ranked for a workload.
    Pick(PickReport, meshes) = "pick",
    /// Iterates over the rankings for workloads.
    picks;
}

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

/// The mesh or the meshes of a finding.
pub(crate) trait Meshes {
    fn list(&self) -> &[MeshReport];
    /// Sets the meshes. Returns an error if their number is wrong.
    fn set(&mut self, meshes: Vec<MeshReport>) -> Result<(), ReadError>;
}

impl Meshes for MeshReport {
    fn list(&self) -> &[MeshReport] {
        std::slice::from_ref(self)
    }

    fn set(&mut self, meshes: Vec<MeshReport>) -> Result<(), ReadError> {
        let count = meshes.len();
        let only: Result<[MeshReport; 1], _> = meshes.try_into();
        let [mesh] = only.map_err(|_| ReadError::Malformed {
            cause: format!("a finding of one mesh has {count} meshes"),
        })?;
        *self = mesh;
        Ok(())
    }
}

impl Meshes for Vec<MeshReport> {
    fn list(&self) -> &[MeshReport] {
        self
    }

    fn set(&mut self, meshes: Self) -> Result<(), ReadError> {
        *self = meshes;
        Ok(())
    }
}

/// The access to the fields that the findings of all labs have.
pub(crate) trait CommonFields {
    fn common(&self) -> Common<'_>;
    /// Returns the run, the meshes and whether the measurement was stopped early, so that they can be changed.
    fn parts_mut(&mut self) -> (&mut Run, &mut dyn Meshes, &mut bool);
}

/// What the finding of a lab adds.
pub(crate) trait LabFinding: CommonFields {
    /// Returns the rows of the finding, for comparisons and tables.
    fn figures(&self) -> Vec<Figure<'_>>;
    /// Counts the results that differ, for no known reason, from the results of other backends of
    /// Sixfold.
    fn mismatches(&self) -> usize {
        let figures = self.figures();
        let mismatch = |figure: &&Figure<'_>| figure.row.agreement == Agreement::Mismatch;
        figures.iter().filter(mismatch).count()
    }
    /// Returns an error for values that no measurement can produce.
    fn check(&self) -> Result<(), ReadError>;
}

impl Finding {
    /// Returns how the finding was measured.
    pub fn run(&self) -> &Run {
        self.lab().common().run
    }

    /// Returns the run, so that it can be changed. For example, the command line adds `command`.
    pub fn run_mut(&mut self) -> &mut Run {
        self.lab_mut().parts_mut().0
    }

    /// Returns the measured meshes. The list is empty for a lab that makes its own meshes.
    pub fn meshes(&self) -> &[MeshReport] {
        self.lab().common().meshes
    }

    /// Returns the sentences that describe the main results.
    pub fn sentences(&self) -> &[String] {
        self.lab().common().sentences
    }

    /// Replaces the measured meshes, for example by the same with pictures.
    ///
    /// # Errors
    ///
    /// Returns an error if the finding is of one mesh, and their number is another one.
    pub fn set_meshes(&mut self, meshes: Vec<MeshReport>) -> Result<(), ReadError> {
        self.lab_mut().parts_mut().1.set(meshes)
    }

    /// Notes that the measurement was stopped early.
    pub fn set_interrupted(&mut self) {
        *self.lab_mut().parts_mut().2 = true;
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

    /// Returns the rows of the finding with their meshes: one for each mesh, case, operation and
    /// backend.
    pub fn figures(&self) -> Vec<Figure<'_>> {
        self.lab().figures()
    }

    /// Adds the run and the meshes to a finding that was read from a file, and checks its values.
    pub(crate) fn complete(&mut self, run: Run, meshes: Vec<MeshReport>) -> Result<(), ReadError> {
        let lab = self.lab_mut();
        let (old_run, old_meshes, _) = lab.parts_mut();
        *old_run = run;
        old_meshes.set(meshes)?;
        lab.check()
    }
}

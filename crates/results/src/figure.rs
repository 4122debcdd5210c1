//! The rows of all labs in one form, for comparisons and tables.

use serde::Serialize;

use crate::findings::why::Reads;
use crate::launches::LaunchRows;
use crate::read::ReadError;
use crate::rows::{
    MeshReport, RefusalKind, ResultRow, Samples, check_control, check_results, check_samples,
};
use crate::run::Run;

/// One row of a finding with its mesh: a task on a backend, on a mesh and in a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure<'r> {
    /// The mesh; `None` if the lab made its own mesh.
    pub mesh: Option<&'r MeshReport>,
    /// The numbers of vertices, edges and faces of the measured mesh.
    pub elements_of_mesh: [usize; 3],
    /// The size of the backend in bytes; `None` if unknown.
    pub backend_bytes: Option<usize>,
    /// How the times or counts were obtained.
    pub status: Status,
    /// The times. `case`: in `orders`, the order; in `growth`, the shape, the order and the number of
    /// faces; in `pick`, the name of the workload; in `neighbours`, the query points. In a pick, the
    /// operation `mix` is the whole mix, `run` is a run of a program, and the others are the parts of
    /// the mix and `build`.
    pub row: ResultRow,
    /// The counts of bytes and reads.
    pub counted: Counted,
    /// The samples of the time; `None` for a row without samples.
    pub samples: Option<&'r Samples>,
}

/// Counts of `memory` and `why`. Other labs have none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Counted {
    /// The bytes that one run of an operation allocates.
    pub allocated_bytes: Option<usize>,
    /// The bytes of the backend by its layout formula; `None` if it has no formula.
    pub layout_bytes: Option<usize>,
    /// The bytes of the backend that the allocator counted.
    pub counted_bytes: Option<usize>,
    /// The peak of the bytes while the backend is built.
    pub peak_bytes: Option<usize>,
    /// The mean number of reads of a query, as in [`Reads::reads`].
    pub reads: Option<f64>,
    /// The mean number of bytes that a query reads.
    pub read_bytes: Option<f64>,
    /// The mean number of cache lines that a query reads.
    pub lines: Option<f64>,
    /// The mean number of cache lines per element that a small simulated cache fetches.
    pub fetched: Option<f64>,
    /// The mean number of jumps per element: fetches of a line that is not near a cached line.
    pub jumps: Option<f64>,
    /// The bytes per element that a pass over all elements moves from memory at least.
    pub moved_bytes: Option<f64>,
}

impl From<&Reads> for Counted {
    fn from(reads: &Reads) -> Self {
        Self {
            reads: Some(reads.reads),
            read_bytes: Some(reads.bytes),
            lines: Some(reads.lines),
            fetched: Some(reads.fetched),
            jumps: Some(reads.jumps),
            moved_bytes: Some(reads.moved_bytes),
            ..Self::default()
        }
    }
}

/// How a time or a count of bytes was obtained.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Whole runs were measured.
    Measured,
    /// Runs on some of the elements were measured and scaled to the whole mesh.
    Sampled,
    /// The time is an estimate, because a whole run would exceed the time limit.
    Estimated,
    /// Bytes or reads were counted. There is no time.
    Counted,
    /// There is no value, because the backend cannot do the operation on this mesh.
    Refused,
    /// There is no value, because the operation would take too long, or because the budget ended.
    #[default]
    NotRun,
}

impl From<RefusalKind> for Status {
    fn from(kind: RefusalKind) -> Self {
        match kind {
            RefusalKind::BudgetEnded => Self::NotRun,
            RefusalKind::Impossible => Self::Refused,
        }
    }
}

impl<'r> Figure<'r> {
    /// Returns a figure of a mesh, without samples.
    pub(crate) fn new(
        mesh: Option<&'r MeshReport>,
        backend_bytes: Option<usize>,
        status: Status,
        row: ResultRow,
    ) -> Self {
        let facts = mesh.map(|mesh| &mesh.facts);
        Self {
            mesh,
            elements_of_mesh: facts.map_or([0; 3], |f| [f.vertices, f.edges, f.faces]),
            backend_bytes,
            status,
            row,
            counted: Counted::default(),
            samples: None,
        }
    }

    /// Returns true if the time was measured, or if bytes or reads were counted.
    pub const fn is_measured(&self) -> bool {
        matches!(
            self.status,
            Status::Measured | Status::Sampled | Status::Counted
        )
    }

    /// Returns the times of all samples that count, in nanoseconds. See [`Samples::counted_ns`].
    pub fn counted_ns(&self) -> Vec<f64> {
        self.samples.map_or_else(Vec::new, Samples::counted_ns)
    }
}

/// The rows of a lab on one mesh, with what belongs to them.
pub(crate) struct Rows<'r> {
    pub(crate) run: &'r Run,
    pub(crate) rows: LaunchRows<'r>,
}

impl<'r> Rows<'r> {
    /// Returns the figures of the rows and refusals. `bytes` is the size of a backend.
    pub(crate) fn figures(
        &self,
        mesh: Option<&'r MeshReport>,
        bytes: impl Fn(&str) -> Option<usize>,
    ) -> Vec<Figure<'r>> {
        let unit = |operation: &str| {
            let info = self.run.operation(operation);
            info.map_or("", |info| info.unit.as_str())
        };
        let timed = self.rows.results.iter().map(|row| {
            let status = match (row.median_ns, row.sampled) {
                (None, _) => Status::Estimated,
                (Some(_), true) => Status::Sampled,
                (Some(_), false) => Status::Measured,
            };
            Figure {
                samples: samples_of(self.rows.samples, &row.case, &row.operation, &row.backend),
                ..Figure::new(mesh, bytes(&row.backend), status, row.clone())
            }
        });
        let refused = self.rows.refusals.iter().map(|refusal| {
            let row = ResultRow::new(
                &refusal.backend,
                &refusal.operation,
                unit(&refusal.operation),
            );
            Figure::new(mesh, bytes(&refusal.backend), refusal.kind.into(), row)
        });
        timed.chain(refused).collect()
    }

    /// Returns an error for values that no measurement can produce.
    pub(crate) fn check(&self) -> Result<(), ReadError> {
        check_samples(self.rows.samples)?;
        check_results(self.rows.results)?;
        check_control(self.rows.control)
    }
}

/// Returns the samples of an operation on a backend in a case, without the second measurement of the
/// control.
pub(crate) fn samples_of<'r>(
    samples: &'r [Samples],
    case: &str,
    operation: &str,
    backend: &str,
) -> Option<&'r Samples> {
    let of_it = |s: &&Samples| {
        !s.control && s.operation == operation && s.backend == backend && s.case == case
    };
    samples.iter().find(of_it)
}

#[cfg(test)]
mod tests {
    use sixfold_core::Relation;

    use super::*;

    #[test]
    fn the_columns_of_reads_are_those_of_the_counts() {
        let reads = Reads {
            relation: Relation::VertexFaces,
            elements: 7,
            queried: 7,
            sampled: false,
            answers: 8.0,
            listing_reads: 9.0,
            sweep_lines: 10,
            reads: 1.0,
            bytes: 2.0,
            lines: 3.0,
            fetched: 4.0,
            jumps: 5.0,
            moved_bytes: 6.0,
            tables: Vec::new(),
        };
        let expected = Counted {
            reads: Some(1.0),
            read_bytes: Some(2.0),
            lines: Some(3.0),
            fetched: Some(4.0),
            jumps: Some(5.0),
            moved_bytes: Some(6.0),
            ..Counted::default()
        };
        assert_eq!(Counted::from(&reads), expected);
    }

    #[test]
    fn estimates_and_refusals_are_not_measured() {
        let measured = |status| Figure::new(None, None, status, ResultRow::default()).is_measured();
        let all = [
            Status::Measured,
            Status::Sampled,
            Status::Counted,
            Status::Estimated,
            Status::Refused,
            Status::NotRun,
        ];
        assert_eq!(all.map(measured), [true, true, true, false, false, false]);
    }
}

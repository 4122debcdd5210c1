//! Single times and counts of bytes of findings, in one form for all labs.

use serde::Serialize;
use sixfold_workload::Reads;

use crate::results::rows::{
    Agreement, MeasuredTask, MeshReport, Refusal, RefusalKind, ResultRow, Samples, Standing,
};

/// One time or count of bytes in a finding: an operation on a backend, on a mesh and in a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure<'r> {
    /// The mesh; `None` if the lab made its own mesh.
    pub mesh: Option<&'r MeshReport>,
    /// The numbers of vertices, edges and faces of the measured mesh.
    pub elements_of_mesh: [usize; 3],
    /// What was measured besides the operation: in `orders`, the order; in `growth`, the shape, the
    /// order and the number of faces; in `pick`, the name of the workload. Empty in other labs.
    pub case: String,
    /// The size of the backend in bytes; `None` if unknown.
    pub backend_bytes: Option<usize>,
    /// The operation, the backend, and the time or the bytes.
    pub row: FigureRow<'r>,
    /// The samples of the time; `None` for a time or size without samples.
    pub samples: Option<&'r Samples>,
    /// Ratios of times up to this value are noise, as the control of the finding shows.
    pub noise: f64,
}

/// The time or the bytes of an operation on a backend, without the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureRow<'r> {
    /// The name of the operation. In a pick, `mix` is the whole mix, and the other names are the
    /// parts of the mix and `build`.
    pub operation: String,
    /// The name of the backend, such as `half-edge`.
    pub backend: &'r str,
    /// How the time or the count of bytes was obtained.
    pub status: Status,
    /// The median time of one run, or the estimated time, in nanoseconds. `None` if there is no
    /// time, see `status`.
    pub ns: Option<f64>,
    /// The bytes that one run allocates; `None` if they were not counted.
    pub allocated_bytes: Option<usize>,
    /// The smallest time of a sample, in nanoseconds.
    pub min_ns: Option<f64>,
    /// The 95 % confidence interval of `ns`.
    pub interval_ns: Option<[f64; 2]>,
    /// The number of elements that one run visits.
    pub elements: Option<u64>,
    /// The kind of the visited elements, such as `vertex`.
    pub unit: String,
    /// The time divided by the time of the fastest backend. In `orders`, the time divided by the
    /// time of the best order of the backend.
    pub ratio_to_best: Option<f64>,
    /// The 95 % confidence interval of `ratio_to_best`.
    pub ratio_interval: Option<[f64; 2]>,
    /// The comparison with the other backends. In `orders`, the comparison with the other orders on
    /// this backend.
    pub standing: Option<Standing>,
    /// The comparison of the checksum with the checksums of other backends. `None` if there is no
    /// time, and in `pick`, which compares all results of a backend at once.
    pub agreement: Option<Agreement>,
    /// The number of samples.
    pub samples: usize,
    /// The checksum of all results.
    pub checksum: Option<f64>,
    /// The number of elements on which the operation was run; `None` if it was run on all elements.
    pub sample_size: Option<usize>,
    /// The bytes of the backend in `memory`; `None` in other labs, and for an operation.
    pub size: Option<SizeBytes>,
    /// The reads of the queries in `why`; `None` in other labs.
    pub reads: Option<&'r Reads>,
}

/// The bytes of a backend, by formula and by allocator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeBytes {
    /// The bytes by the layout formula; `None` if the backend has no formula.
    pub layout: Option<usize>,
    /// The bytes that the allocator counted.
    pub counted: Option<usize>,
    /// The peak of the bytes while the backend is built.
    pub peak: Option<usize>,
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

impl<'r> FigureRow<'r> {
    /// Returns a row without a time.
    pub(crate) fn new(operation: String, backend: &'r str, status: Status) -> Self {
        Self {
            operation,
            backend,
            status,
            ..Self::default()
        }
    }

    /// Returns the row of an operation that was refused or not run.
    pub(crate) fn of_refusal(refusal: &'r Refusal) -> Self {
        let status = match refusal.kind {
            RefusalKind::BudgetEnded => Status::NotRun,
            RefusalKind::Impossible => Status::Refused,
        };
        Self::new(refusal.operation.name().into(), &refusal.backend, status)
    }

    /// Returns the row of a measured or estimated result.
    pub(crate) fn of_result<T: MeasuredTask>(row: &'r ResultRow<T>) -> Self {
        let status = match (row.median_ns, row.sampled) {
            (None, _) => Status::Estimated,
            (Some(_), true) => Status::Sampled,
            (Some(_), false) => Status::Measured,
        };
        let pair = |low: Option<f64>, high: Option<f64>| low.zip(high).map(|(l, h)| [l, h]);
        Self {
            ns: row.median_ns.or(row.estimated_ns),
            min_ns: row.min_ns,
            interval_ns: pair(row.ci_low_ns, row.ci_high_ns),
            elements: row.elements,
            unit: row.per.clone(),
            ratio_to_best: row.ratio_to_best,
            ratio_interval: pair(row.ratio_ci_low, row.ratio_ci_high),
            standing: row.standing,
            agreement: Some(row.agreement),
            samples: row.samples,
            checksum: row.checksum,
            sample_size: row.sample_size,
            ..Self::new(row.operation.name().into(), &row.backend, status)
        }
    }

    /// Returns true if the time was measured, or if bytes or reads were counted.
    pub const fn is_measured(&self) -> bool {
        matches!(
            self.status,
            Status::Measured | Status::Sampled | Status::Counted
        )
    }

    /// Returns the time per element in nanoseconds.
    pub fn ns_per_element(&self) -> Option<f64> {
        Some(self.ns? / self.elements.filter(|&count| count > 0)? as f64)
    }
}

impl<'r> Figure<'r> {
    /// Returns a figure of a mesh, without a case, without samples and without noise.
    pub(crate) fn new(
        mesh: Option<&'r MeshReport>,
        backend_bytes: Option<usize>,
        row: FigureRow<'r>,
    ) -> Self {
        let facts = mesh.map(|mesh| &mesh.facts);
        Self {
            mesh,
            elements_of_mesh: facts.map_or([0; 3], |f| [f.vertices, f.edges, f.faces]),
            case: String::new(),
            backend_bytes,
            row,
            samples: None,
            noise: 1.0,
        }
    }

    /// Returns the times of all samples that count, in nanoseconds. See [`Samples::counted_ns`].
    pub fn counted_ns(&self) -> Vec<f64> {
        self.samples.map_or_else(Vec::new, Samples::counted_ns)
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

/// Returns the figures of the rows and refusals of a mesh.
pub(crate) fn figures_of<'r, T: MeasuredTask>(
    mesh: Option<&'r MeshReport>,
    rows: &'r [ResultRow<T>],
    refusals: &'r [Refusal],
    samples: &'r [Samples],
    bytes: impl Fn(&str) -> Option<usize>,
    noise: impl Fn(T) -> f64,
) -> Vec<Figure<'r>> {
    let timed = rows.iter().map(|row| Figure {
        case: row.case.clone(),
        samples: samples_of(samples, &row.case, row.operation.name(), &row.backend),
        noise: noise(row.operation),
        ..Figure::new(mesh, bytes(&row.backend), FigureRow::of_result(row))
    });
    let refused = refusals.iter().map(|refusal| {
        let row = FigureRow::of_refusal(refusal);
        Figure::new(mesh, bytes(row.backend), row)
    });
    timed.chain(refused).collect()
}

//! The bytes of each backend, counted in three ways.

use serde::{Deserialize, Serialize};

use crate::figure::{Counted, Figure, Status};
use crate::finding::LabFinding;
use crate::read::ReadError;
use crate::rows::{BackendReport, MeshReport, ResultRow};
use crate::run::Run;

/// The name of the structure itself among the operations of the figures.
const STRUCTURE: &str = "structure";

/// The memory of each backend, counted by a formula, by the tables and by the allocator.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Audit {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hashes of the mesh. In JSON, the finding has the place of the mesh in
    /// `meshes`.
    #[serde(skip)]
    pub mesh: MeshReport,
    /// The backends, in the requested order.
    pub backends: Vec<BackendAudit>,
    /// Sentences about the results.
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the counting and their remedies. A count has none so far.
    pub warnings: Vec<String>,
    /// True if the counting was stopped early. A count that is stopped has no finding so far.
    pub interrupted: bool,
}

/// The memory of one backend, counted by a formula, by the tables and by the allocator.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct BackendAudit {
    /// The bytes by the layout formula, the bytes of the tables, and whether the backend can hold
    /// the mesh.
    #[serde(flatten)]
    pub backend: BackendReport,
    /// Size by the layout formula, in words of 4 bytes per vertex of this mesh. `None` if the
    /// backend cannot hold the mesh.
    pub layout_words_per_vertex: Option<f64>,
    /// Size by the layout formula for a very large closed triangle mesh, in words of 4 bytes per
    /// vertex. A very large closed triangle mesh has about 2 faces and 3 edges per vertex.
    pub closed_triangles_words_per_vertex: f64,
    /// Bytes that the allocator counted; `None` if the backend cannot hold the mesh.
    pub counted_bytes: Option<usize>,
    /// Bytes that the allocator counted, per vertex of the mesh.
    pub counted_bytes_per_vertex: Option<f64>,
    /// Peak memory while the backend is built, in bytes. The input polygons are not included.
    pub peak_bytes: Option<usize>,
    /// `peak_bytes` divided by `counted_bytes`.
    pub peak_to_counted: Option<f64>,
    /// True if the layout formula, the tables and the allocator give the same number of bytes.
    /// `None` if the backend cannot hold the mesh.
    pub agrees: Option<bool>,
    /// The bytes that operations allocate; empty if these bytes were not counted.
    pub operations: Vec<OperationBytes>,
}

/// The bytes that one run of an operation allocates on one backend.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct OperationBytes {
    /// The operation that allocates, such as `build`.
    pub operation: String,
    /// Bytes that the timed part of the operation requests from the allocator. `None` if the
    /// operation was not run.
    pub allocated_bytes: Option<usize>,
    /// Bytes of the result of the operation; `None` if the operation was not run.
    pub result_bytes: Option<usize>,
    /// Allocated bytes divided by the bytes of the result.
    pub allocated_to_result: Option<f64>,
    /// Why the operation was not run; `None` if the operation was run.
    pub reason: Option<String>,
    /// True if the operation was not run because it scans all faces for each element.
    pub scans: bool,
}

impl LabFinding for Audit {
    fn figures<'s>(&'s self) -> Vec<Figure<'s>> {
        let of_backend = |audited: &'s BackendAudit| {
            let backend = &audited.backend;
            let figure = |operation: &str, status, counted| {
                let row = ResultRow {
                    backend: backend.name.clone(),
                    operation: operation.to_owned(),
                    ..ResultRow::default()
                };
                Figure {
                    counted,
                    ..Figure::new(Some(&self.mesh), audited.counted_bytes, status, row)
                }
            };
            let operation = |counted: &OperationBytes| {
                let status = match (counted.allocated_bytes, counted.scans) {
                    (Some(_), _) => Status::Counted,
                    (None, true) => Status::NotRun,
                    (None, false) => Status::Refused,
                };
                let bytes = Counted {
                    allocated_bytes: counted.allocated_bytes,
                    ..Counted::default()
                };
                figure(&counted.operation, status, bytes)
            };
            let status = match backend.holds {
                true => Status::Counted,
                false => Status::Refused,
            };
            let bytes = Counted {
                layout_bytes: backend.layout_bytes.filter(|_| backend.holds),
                counted_bytes: audited.counted_bytes,
                peak_bytes: audited.peak_bytes,
                ..Counted::default()
            };
            let structure = figure(STRUCTURE, status, bytes);
            let operations = audited.operations.iter().map(operation);
            std::iter::once(structure)
                .chain(operations)
                .collect::<Vec<_>>()
        };
        self.backends.iter().flat_map(of_backend).collect()
    }

    fn check(&self) -> Result<(), ReadError> {
        Ok(())
    }
}

impl Audit {
    /// Describes each difference between the bytes of the layout formula, of the tables and of the
    /// allocator.
    pub fn faults(&self) -> Vec<String> {
        self.backends
            .iter()
            .flat_map(BackendAudit::faults)
            .collect()
    }
}

impl BackendAudit {
    fn faults(&self) -> Vec<String> {
        let BackendReport {
            name,
            layout_bytes,
            bytes,
            ..
        } = &self.backend;
        let (Some(layout), Some(tables), Some(counted)) =
            (*layout_bytes, *bytes, self.counted_bytes)
        else {
            return Vec::new();
        };
        let difference = |what: &str, is: usize, other: &str, than: usize| {
            let more = if is > than { "more" } else { "fewer" };
            let by = is.abs_diff(than);
            (by > 0)
                .then(|| format!("{name}: {what}, {by} bytes {more} than {other} ({than} bytes)"))
        };
        let tables_text = format!("its tables hold {tables} bytes");
        let heap_text = format!("the allocator counted {counted} bytes");
        let faults = [
            difference(&tables_text, tables, "its layout formula gives", layout),
            difference(&heap_text, counted, "its tables hold", tables),
        ];
        faults.into_iter().flatten().collect()
    }
}

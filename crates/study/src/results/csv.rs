//! Tables of results as CSV: one row for each time, and one row for each sample.

use std::io;

use csv::Writer;
use serde::Serialize;

use crate::results::document::Results;
use crate::results::figure::{Figure, Status};
use crate::results::rows::{Agreement, Standing};

/// One row of the table of times.
#[derive(Default, Serialize)]
struct TimeRow<'r> {
    mesh: &'r str,
    vertices: usize,
    edges: usize,
    faces: usize,
    closed: Option<bool>,
    largest_valence: Option<usize>,
    largest_face_degree: Option<usize>,
    kind: &'r str,
    case: &'r str,
    operation: &'r str,
    backend: &'r str,
    backend_bytes: Option<usize>,
    status: Status,
    unit: &'r str,
    elements: Option<u64>,
    allocated_bytes: Option<usize>,
    layout_bytes: Option<usize>,
    counted_bytes: Option<usize>,
    peak_bytes: Option<usize>,
    reads: Option<f64>,
    read_bytes: Option<f64>,
    lines: Option<f64>,
    fetched: Option<f64>,
    jumps: Option<f64>,
    moved_bytes: Option<f64>,
    ns: Option<f64>,
    ns_per_element: Option<f64>,
    min_ns: Option<f64>,
    ci_low_ns: Option<f64>,
    ci_high_ns: Option<f64>,
    ratio_to_best: Option<f64>,
    ratio_ci_low: Option<f64>,
    ratio_ci_high: Option<f64>,
    standing: Option<Standing>,
    agreement: Option<Agreement>,
    samples: usize,
}

/// One row of the table of samples.
#[derive(Default, Serialize)]
struct SampleRow<'r> {
    mesh: &'r str,
    kind: &'r str,
    case: &'r str,
    operation: &'r str,
    backend: &'r str,
    round: u32,
    cpu_ns: Option<f64>,
    wall_ns: f64,
    faults: Option<u64>,
    slowdown: Option<f64>,
}

impl Results {
    /// Writes the times as CSV: a header, and one row for each mesh, case, operation and backend of
    /// each finding.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_csv(&self, writer: impl io::Write) -> io::Result<()> {
        self.write_lines(writer, header::<TimeRow>()?, |lines, kind, figure| {
            lines.serialize(time_row(kind, figure))
        })
    }

    /// Writes the samples as CSV: a header, and one row for each sample. The samples of the second
    /// measurement of the control are left out.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_samples_csv(&self, writer: impl io::Write) -> io::Result<()> {
        self.write_lines(writer, header::<SampleRow>()?, |lines, kind, figure| {
            sample_rows(kind, figure).try_for_each(|row| lines.serialize(row))
        })
    }

    /// Writes the header, and the rows that `write` writes for each figure.
    fn write_lines<W: io::Write>(
        &self,
        mut writer: W,
        header: Vec<u8>,
        write: impl Fn(&mut Writer<W>, &str, &Figure<'_>) -> csv::Result<()>,
    ) -> io::Result<()> {
        writer.write_all(&header)?;
        let mut lines = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(writer);
        for finding in &self.findings {
            for figure in finding.figures() {
                write(&mut lines, finding.kind(), &figure).map_err(into_io_error)?;
            }
        }
        lines.flush()
    }
}

/// Returns the line with the names of the columns.
fn header<R: Default + Serialize>() -> io::Result<Vec<u8>> {
    let mut lines = Writer::from_writer(Vec::new());
    lines.serialize(R::default()).map_err(into_io_error)?;
    let mut header = lines.into_inner().map_err(|error| error.into_error())?;
    let end = header.iter().position(|&byte| byte == b'\n');
    header.truncate(end.map_or(header.len(), |end| end + 1));
    Ok(header)
}

fn mesh_name<'r>(figure: &Figure<'r>) -> &'r str {
    figure.mesh.map_or("", |mesh| mesh.name.as_str())
}

fn time_row<'r>(kind: &'r str, figure: &'r Figure<'_>) -> TimeRow<'r> {
    let Figure {
        mesh,
        elements_of_mesh: [vertices, edges, faces],
        case,
        backend_bytes,
        row,
        ..
    } = figure;
    let facts = mesh.map(|mesh| &mesh.facts);
    TimeRow {
        mesh: mesh_name(figure),
        vertices: *vertices,
        edges: *edges,
        faces: *faces,
        closed: facts.map(|facts| facts.closed),
        largest_valence: facts.and_then(|facts| Some(facts.valence.as_ref()?.max)),
        largest_face_degree: facts.and_then(|facts| Some(facts.face_degree.as_ref()?.max)),
        kind,
        case,
        operation: &row.operation,
        backend: row.backend,
        backend_bytes: *backend_bytes,
        status: row.status,
        unit: &row.unit,
        elements: row.elements,
        allocated_bytes: row.allocated_bytes,
        layout_bytes: row.size.and_then(|size| size.layout),
        counted_bytes: row.size.and_then(|size| size.counted),
        peak_bytes: row.size.and_then(|size| size.peak),
        reads: row.reads.map(|reads| reads.reads),
        read_bytes: row.reads.map(|reads| reads.bytes),
        lines: row.reads.map(|reads| reads.lines),
        fetched: row.reads.map(|reads| reads.fetched),
        jumps: row.reads.map(|reads| reads.jumps),
        moved_bytes: row.reads.map(|reads| reads.moved_bytes),
        ns: row.ns,
        ns_per_element: row.ns_per_element(),
        min_ns: row.min_ns,
        ci_low_ns: row.interval_ns.map(|[low, _]| low),
        ci_high_ns: row.interval_ns.map(|[_, high]| high),
        ratio_to_best: row.ratio_to_best,
        ratio_ci_low: row.ratio_interval.map(|[low, _]| low),
        ratio_ci_high: row.ratio_interval.map(|[_, high]| high),
        standing: row.standing,
        agreement: row.agreement,
        samples: row.samples,
    }
}

fn sample_rows<'r>(kind: &'r str, figure: &'r Figure<'_>) -> impl Iterator<Item = SampleRow<'r>> {
    figure.samples.into_iter().flat_map(move |samples| {
        (0..samples.wall_ns.len()).map(move |i| SampleRow {
            mesh: mesh_name(figure),
            kind,
            case: &figure.case,
            operation: &figure.row.operation,
            backend: figure.row.backend,
            round: samples.rounds[i],
            cpu_ns: samples.cpu_ns.as_ref().map(|all| all[i]),
            wall_ns: samples.wall_ns[i],
            faults: samples.faults.as_ref().map(|all| all[i]),
            slowdown: samples.slowdowns.get(i).copied(),
        })
    })
}

/// Returns the I/O error inside a CSV error, so that a closed pipe can be detected.
fn into_io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(cause) => cause,
        other => io::Error::other(format!("{other:?}")),
    }
}

//! Tables of results as CSV: one row for each time, and one row for each sample.

use std::io;

use csv::Writer;
use serde::Serialize;

use crate::document::Results;
use crate::figure::{Counted, Figure, Status};
use crate::rows::ResultRow;

/// The first columns of the table of times. The fields of [`ResultRow`] follow, then those of
/// [`BackendColumns`] and of [`Counted`].
#[derive(Default, Serialize)]
struct MeshColumns<'r> {
    mesh: &'r str,
    vertices: usize,
    edges: usize,
    faces: usize,
    closed: Option<bool>,
    largest_valence: Option<usize>,
    largest_face_degree: Option<usize>,
    kind: &'r str,
}

#[derive(Default, Serialize)]
struct BackendColumns {
    backend_bytes: Option<usize>,
    status: Status,
}

/// One row of the table of times.
type TimeRow<'r> = (MeshColumns<'r>, ResultRow, BackendColumns, Counted);

/// One row of the table of samples.
#[derive(Default, Serialize)]
struct SampleRow<'r> {
    mesh: &'r str,
    kind: &'r str,
    case: &'r str,
    operation: &'r str,
    backend: &'r str,
    launch: u32,
    round: Option<u32>,
    cpu_ns: Option<f64>,
    wall_ns: Option<f64>,
    faults: Option<u64>,
    slowdown: Option<f64>,
    first_run: bool,
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

    /// Writes the samples as CSV: a header, and one row for each sample. A launch that had only time for the first run of
    /// an operation has a row for this run. The samples of the second measurement of the control are left out.
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

/// Writes some rows of a finding as CSV, with the columns of [`Results::write_csv`]. `kind` is the name
/// of the command that measured the finding, as in [`Finding::kind`](crate::Finding::kind).
///
/// # Errors
///
/// Returns the errors of `writer`.
pub fn write_csv_rows<'r>(
    mut writer: impl io::Write,
    kind: &str,
    rows: impl IntoIterator<Item = Figure<'r>>,
) -> io::Result<()> {
    writer.write_all(&header::<TimeRow>()?)?;
    let mut lines = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(writer);
    for row in rows {
        let row = time_row(kind, &row);
        lines.serialize(row).map_err(into_io_error)?;
    }
    lines.flush()
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

fn time_row<'r>(kind: &'r str, figure: &Figure<'r>) -> TimeRow<'r> {
    let [vertices, edges, faces] = figure.elements_of_mesh;
    let facts = figure.mesh.map(|mesh| &mesh.facts);
    let mesh = MeshColumns {
        mesh: mesh_name(figure),
        vertices,
        edges,
        faces,
        closed: facts.map(|facts| facts.closed),
        largest_valence: facts.and_then(|facts| Some(facts.valence.as_ref()?.max)),
        largest_face_degree: facts.and_then(|facts| Some(facts.face_degree.as_ref()?.max)),
        kind,
    };
    let backend = BackendColumns {
        backend_bytes: figure.backend_bytes,
        status: figure.status,
    };
    let row = ResultRow {
        launch_ns: Vec::new(), // a cell holds one number; the samples have the launches
        ..figure.row.clone()
    };
    (mesh, row, backend, figure.counted)
}

fn sample_rows<'r>(kind: &'r str, figure: &'r Figure<'_>) -> impl Iterator<Item = SampleRow<'r>> {
    let row = move || SampleRow {
        mesh: mesh_name(figure),
        kind,
        case: &figure.row.case,
        operation: &figure.row.operation,
        backend: &figure.row.backend,
        ..SampleRow::default()
    };
    let sampled = figure.samples.into_iter().flat_map(move |samples| {
        (0..samples.wall_ns.len()).map(move |i| SampleRow {
            launch: samples.launches.get(i).copied().unwrap_or(0),
            round: Some(samples.rounds[i]),
            cpu_ns: samples.cpu_ns.as_ref().map(|all| all[i]),
            wall_ns: Some(samples.wall_ns[i]),
            faults: samples.faults.as_ref().map(|all| all[i]),
            slowdown: samples.slowdowns.get(i).copied(),
            ..row()
        })
    });
    let first_runs = first_runs(figure).map(move |(launch, ns)| SampleRow {
        launch,
        first_run: true,
        cpu_ns: Some(ns),
        ..row()
    });
    sampled.chain(first_runs)
}

/// Returns the times of the launches that had only time for the first run, with the numbers of the launches.
fn first_runs<'r>(figure: &'r Figure<'_>) -> impl Iterator<Item = (u32, f64)> + use<'r> {
    let row = &figure.row;
    let only = row
        .median_ns
        .filter(|_| row.warm_up_only && row.launch_ns.is_empty());
    let launches = (0..).zip(&row.launch_ns);
    let launches = launches.filter_map(|(launch, ns)| Some((launch, (*ns)?)));
    let has_samples = move |launch: u32| {
        let mut samples = figure.samples.into_iter();
        samples.any(|samples| match samples.launches.is_empty() {
            true => !samples.wall_ns.is_empty(),
            false => samples.launches.contains(&launch),
        })
    };
    let all = only.map(|ns| (0, ns)).into_iter().chain(launches);
    all.filter(move |(launch, _)| !has_samples(*launch))
}

/// Returns the I/O error inside a CSV error, so that a closed pipe can be detected.
pub(crate) fn into_io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(cause) => cause,
        other => io::Error::other(format!("{other:?}")),
    }
}

#[cfg(test)]
mod tests {
    use crate::Results;
    use crate::findings::study::Report;
    use crate::rows::{ResultRow, Samples};

    /// Launch 0 had only time for a first run, launch 1 had no time, and launch 2 has two samples.
    #[test]
    fn a_launch_without_samples_has_a_row_for_its_first_run() {
        let mut all = Results::default();
        all.add(
            Report {
                results: vec![
                    ResultRow {
                        median_ns: Some(7.0),
                        launch_ns: vec![Some(6.0), None, Some(8.0)],
                        ..ResultRow::new("half-edge", "build", "face")
                    },
                    ResultRow {
                        median_ns: Some(5.0),
                        warm_up_only: true,
                        ..ResultRow::new("winged-edge", "build", "face")
                    },
                ],
                samples: vec![Samples {
                    backend: "half-edge".into(),
                    operation: "build".into(),
                    launches: vec![2, 2],
                    rounds: vec![4, 5],
                    wall_ns: vec![8.0, 9.0],
                    ..Samples::default()
                }],
                ..Report::default()
            }
            .into(),
        );
        let mut text = Vec::new();
        all.write_samples_csv(&mut text).expect("memory");
        let text = String::from_utf8(text).expect("text");
        let rows: Vec<&str> = text
            .lines()
            .skip(1)
            .filter_map(|line| line.split_once("build,"))
            .map(|(_, row)| row)
            .collect();
        assert_eq!(
            rows,
            [
                "half-edge,2,4,,8.0,,,false",
                "half-edge,2,5,,9.0,,,false",
                "half-edge,0,,6.0,,,,true",
                "winged-edge,0,,5.0,,,,true",
            ]
        );
    }
}

//! Makes `reports/editing`: the time of edits on each structure.
//!
//! `cargo run --release -p sixfold-report --example editing_report -- reports/editing [LAUNCHES | --draw]`
//!
//! `--draw` only writes the text and the figure again, from the data in the folder.
//!
//! Every launch runs each edit and each workload on each structure and mesh, once. An edit is done at
//! many places of a fresh copy. The tables show medians of thread-CPU time over the launches.

mod common;

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use common::{Data, Row};
use serde::{Deserialize, Serialize};
use sixfold::{Edit, PolygonMesh, QueryCost, StructureInfo, shapes, structure_infos};
use sixfold_report::{Panel, panels};
use sixfold_study::{Backend, EditPass, Editor, MachineClock, Series, SingleEdit};

/// Side lengths of the tori: 1,058, 4,232, 16,200, 64,800, 259,200 and 1,036,800 triangles.
const SIDES: [usize; 6] = [23, 46, 90, 180, 360, 720];

/// Number of rounds of a launch. A round takes minutes.
const ROUNDS: usize = 1;

/// Name of the file with all samples.
const DATA: &str = "editing.json";

/// Number of places of an edit that does not scan.
const PLACES: usize = 4096;
/// Number of places of an edit that scans or that visits the whole mesh.
const PLACES_SCANNED: usize = 12;

/// Minimum number of faces of all copies of a mesh together.
const MIN_TOTAL_FACES: usize = 64_000;

/// Maximum number of faces for a workload of edits on a structure that scans.
const MAX_SCANNED_FACES: usize = 5_000;

/// Maximum number of faces at which every structure fits into the second-level cache.
const MAX_CACHED_FACES: usize = 20_000;

/// Conclusions that hold on every machine.
const CONCLUSIONS: &str = include_str!("common/editing.md");

/// An edit or a workload on a structure, and the number of faces of the mesh.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
struct Line {
    what: String,
    backend: String,
    faces: usize,
}

/// Times of the rounds in nanoseconds per edit or element.
type Samples = BTreeMap<Line, Vec<f64>>;

fn main() -> Result<(), Box<dyn Error>> {
    let measure_all = || {
        let mut samples = Samples::new();
        for side in SIDES {
            measure(&shapes::triangle_torus(side, side)?, &mut samples)?;
        }
        Ok(samples)
    };
    common::run(DATA, ROUNDS, measure_all, draw)
}

fn scans(info: &StructureInfo) -> bool {
    info.edits[Edit::CollapseEdge as usize] == Some(QueryCost::Scan)
}

fn measure(polygons: &PolygonMesh, samples: &mut Samples) -> Result<(), Box<dyn Error>> {
    let faces = polygons.face_count();
    let mut jobs: Vec<(Line, Box<dyn Editor>)> = Vec::new();
    let line = |what: &str, backend: &Backend| Line {
        what: what.into(),
        backend: backend.name().into(),
        faces,
    };
    for backend in Backend::structures() {
        for edit in Edit::ALL {
            let places = match backend.info.edits[edit as usize] {
                None => continue,
                Some(QueryCost::Scan) => PLACES_SCANNED,
                Some(_) => PLACES,
            };
            // The soup and the face set need a search to find the places.
            let places = if scans(&backend.info) {
                PLACES_SCANNED
            } else {
                places
            };
            let job = SingleEdit { edit, places };
            if let Some(editor) = job.prepare(&backend, polygons) {
                jobs.push((line(edit.name(), &backend), editor?));
            }
        }
        if faces <= MAX_SCANNED_FACES || !scans(&backend.info) {
            for pass in EditPass::ALL {
                if let Some(editor) = backend.prepare_pass(pass, polygons) {
                    jobs.push((line(pass.name(), &backend), editor?));
                }
            }
        }
    }
    let clock = MachineClock::start();
    for _ in 0..ROUNDS {
        for (line, editor) in &mut jobs {
            // A small mesh has few places. More runs reduce the error of the clock.
            let copies = (MIN_TOTAL_FACES / faces).max(1);
            let series = Series::with_runs(copies as u32, &clock).with_untimed(1);
            let time = editor.time(&series).scaled(1.0 / copies as f64);
            let edits = editor.result();
            if edits.refused > 0 && !EditPass::ALL.iter().any(|e| e.name() == line.what) {
                return Err(format!("{} on {}: {edits:?}", line.what, line.backend).into());
            }
            let ns = time.ns() / edits.elements.max(1) as f64;
            samples.entry(line.clone()).or_default().push(ns);
        }
    }
    Ok(())
}

/// Returns the numbers of faces and the times of an edit or a workload on a structure, sorted by the number of faces.
fn points(rows: &[Row<Line>], what: &str, backend: &str) -> Vec<(f64, f64)> {
    let sizes = rows
        .iter()
        .filter(|row| (&*row.what.what, &*row.what.backend) == (what, backend));
    sizes.map(|row| (row.what.faces as f64, row.ns())).collect()
}

/// Returns the exponent of growth: the slope of the line through the logarithms.
fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .map(|&(x, y)| (x.ln(), y.max(0.1).ln()))
        .collect();
    let n = logs.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / n;
    let (mx, my) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    let variance: f64 = logs.iter().map(|(x, _)| (x - mx).powi(2)).sum();
    (logs.len() > 1).then(|| covariance / variance)
}

fn time_text(ns: f64) -> String {
    match ns {
        ns if ns >= 1e6 => format!("{:.1} ms", ns / 1e6),
        ns if ns >= 1e4 => format!("{:.0} µs", ns / 1e3),
        ns if ns >= 1e3 => format!("{:.1} µs", ns / 1e3),
        ns => format!("{ns:.0} ns"),
    }
}

fn text(data: &Data<Line>) -> Result<String, std::fmt::Error> {
    let mut text = String::from("# Cost of edits on each structure, as the mesh grows\n\n");
    text += &data.introduction("editing_report", "reports/editing");
    let rows = &data.results;
    writeln!(
        text,
        " The meshes are tori of 1,058 to 1,036,800 triangles. A place is a face with its edges and vertices. Each edit is done at up to {PLACES} places of a new copy of the mesh ({PLACES_SCANNED} places if the structure scans all faces, and for `remove_isolated_vertices` and `compact`, which visit the whole mesh). The places are spread over the mesh, in no particular order. One untimed edit comes before the timed edits, because the first edit reallocates full tables. Every edit checks whether it is legal. No edit writes a log of its changes.\n\n![Time per edit over the faces of the mesh](growth.svg)\n"
    )?;
    writeln!(
        text,
        "\n## One edit\n\nEach cell has the time of one edit on a mesh of 16,200 faces, and two exponents of growth: from 1,058 to 16,200 faces (the structures fit into the cache), and from 16,200 to 1,036,800 faces (larger than the cache). The time of an edit is nearly proportional to the number of faces to the power of the exponent. An exponent of about 0 means that the time is constant. An exponent of about 1 means that the edit scans the whole mesh. The sign – means that the structure does not have the edit.\n"
    )?;
    // An edit that is newer than the data has no row.
    let measured = |edit: &Edit| rows.iter().any(|row| row.what.what == edit.name());
    let measured = Edit::ALL.into_iter().filter(measured).map(Edit::name);
    table(&mut text, rows, measured, |points| {
        let at = points
            .iter()
            .rev()
            .find(|p| p.0 <= MAX_CACHED_FACES as f64)?;
        let (in_cache, beyond): (Vec<_>, Vec<_>) =
            points.iter().partition(|p| p.0 <= MAX_CACHED_FACES as f64);
        let beyond: Vec<_> = in_cache
            .last()
            .into_iter()
            .chain(&beyond)
            .copied()
            .collect();
        let slope = |points: &[_]| exponent(points).map_or("–".into(), |e| format!("{e:+.2}"));
        Some(format!(
            "{} {} {}",
            time_text(at.1),
            slope(&in_cache),
            slope(&beyond)
        ))
    })?;
    writeln!(
        text,
        "\n## Whole workloads\n\nEach cell has two times and an exponent. The two times are for 1,058 faces and for the largest mesh, per face of the mesh (`flip_all`: per edge to be flipped). The exponent is the exponent of growth of the total time, for meshes of 16,200 faces or more; – where fewer were measured.\n"
    )?;
    table(
        &mut text,
        rows,
        EditPass::ALL.map(EditPass::name),
        |points| {
            let (first, last) = (points.first()?, points.last()?);
            let large: Vec<_> = points
                .iter()
                .filter(|p| p.0 > 10_000.0)
                .map(|p| (p.0, p.0 * p.1))
                .collect();
            let slope = exponent(&large).map_or("–".into(), |e| format!("{e:.2}"));
            Some(format!(
                "{} to {}, {slope}",
                time_text(first.1),
                time_text(last.1)
            ))
        },
    )?;
    text += "\n";
    text += CONCLUSIONS;
    Ok(text)
}

/// Writes a table with a row for each of `what` and a column for each structure.
fn table(
    text: &mut String,
    rows: &[Row<Line>],
    what: impl IntoIterator<Item = &'static str>,
    cell: impl Fn(&[(f64, f64)]) -> Option<String>,
) -> std::fmt::Result {
    let backends = structure_infos();
    let names: Vec<&str> = backends.iter().map(|backend| backend.name).collect();
    writeln!(
        text,
        "| | {} |\n|---|{}",
        names.join(" | "),
        "---|".repeat(names.len())
    )?;
    for what in what {
        write!(text, "| `{what}` |")?;
        for backend in &backends {
            let points = points(rows, what, backend.name);
            write!(text, " {} |", cell(&points).unwrap_or("–".into()))?;
        }
        text.push('\n');
    }
    Ok(())
}

/// Writes the text, and draws the time per edit over the number of faces.
fn draw(folder: &Path, data: &Data<Line>) -> Result<(), Box<dyn Error>> {
    fs::write(folder.join("README.md"), text(data)?)?;
    let shown = [
        Edit::FlipEdge,
        Edit::CollapseEdge,
        Edit::PokeFace,
        Edit::RemoveFace,
        Edit::SetPosition,
        Edit::Compact,
    ];
    let line =
        |edit: Edit, backend: &'static str| (backend, points(&data.results, edit.name(), backend));
    let panel = |edit: Edit| Panel {
        title: edit.name().into(),
        x_label: "faces of the mesh".into(),
        y_label: "ns per edit".into(),
        lines: structure_infos()
            .into_iter()
            .map(|backend| line(edit, backend.name))
            .collect(),
    };
    let title = "Time per edit over the faces of the mesh";
    let svg = panels(
        title,
        "Each panel is an edit; a line is a structure.",
        3,
        &shown.map(panel),
    );
    fs::write(folder.join("growth.svg"), svg)?;
    Ok(())
}

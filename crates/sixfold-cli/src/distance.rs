//! `sixfold distance`: the distance between the surfaces of two meshes.

use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment};
use serde::Serialize;
use sixfold::PolygonMesh;
use sixfold::glam::DVec3;
use sixfold::spatial::{Bounds, MeshDistance, OneSidedDistance, Sampling, mesh_distance};

use crate::arguments::Distance;
use crate::failure::Failure;
use crate::load;
use crate::mesh_files::shown;
use crate::output::{Output, check_outputs, is_stdout};
use crate::progress::{Spinner, exit_on_interrupt};
use crate::tables::table;
use crate::text::{TextOutput, coordinate, figure, hanging_indent, sanitize};

/// The document of `--json`.
#[derive(Serialize)]
struct Distances<'r> {
    distances: &'r [Row; 3],
}

/// The distances in one direction, or in both.
#[derive(Serialize)]
struct Row {
    from: String,
    to: String,
    mean: f64,
    root_mean_square: f64,
    largest: f64,
    /// The largest distance in per cent of the diagonal of the first mesh.
    largest_percent: f64,
    /// The point with the largest distance; `None` for both directions together.
    farthest: Option<[f64; 3]>,
}

/// Measures the distance and prints it.
pub(crate) fn run(arguments: &Distance) -> Result<ExitCode, Failure> {
    exit_on_interrupt();
    let outputs = [("--json", arguments.json.as_ref())];
    check_outputs(Some(&arguments.first), &outputs)?;
    check_outputs(Some(&arguments.second), &outputs)?;
    if is_stdout(&arguments.first) && is_stdout(&arguments.second) {
        return Err(Failure::usage(
            "both meshes are standard input, which can be read only once: name a file for one of them",
        ));
    }
    let json = Output::open_if(arguments.json.as_ref())?;
    let ([first, second], origin) =
        load::pair(&arguments.first, &arguments.second, arguments.read)?;
    let sampling = Sampling {
        samples: arguments.samples,
        seed: arguments.seed,
    };
    let spinner = Spinner::start(format!("comparing {}", shown(&arguments.first)));
    let distance = mesh_distance(&first, &second, sampling);
    spinner.clear();
    let distance = distance.map_err(Failure::usage)?;
    let diagonal = diagonal(&first);
    let rows = rows(arguments, &distance, diagonal, origin);
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    text.print_line(&rows_text(&rows, diagonal));
    text.finish_with_document(json, &Distances { distances: &rows })
}

/// Returns the distances. `origin` is the place of the origin in the files.
fn rows(
    arguments: &Distance,
    distance: &MeshDistance,
    diagonal: f64,
    origin: [f64; 3],
) -> [Row; 3] {
    let (first, second) = (shown(&arguments.first), shown(&arguments.second));
    let percent = |largest: f64| 100.0 * largest / diagonal;
    let one_sided = |from: &str, to: &str, side: &OneSidedDistance| Row {
        from: from.to_owned(),
        to: to.to_owned(),
        mean: side.mean,
        root_mean_square: side.root_mean_square,
        largest: side.largest,
        largest_percent: percent(side.largest),
        farthest: Some((side.farthest + DVec3::from(origin)).to_array()),
    };
    let forward = one_sided(&first, &second, &distance.forward);
    let backward = one_sided(&second, &first, &distance.backward);
    let both = Row {
        from: "both".to_owned(),
        to: "both".to_owned(),
        mean: distance.mean(),
        root_mean_square: distance.root_mean_square(),
        largest: distance.largest(),
        largest_percent: percent(distance.largest()),
        farthest: None,
    };
    [forward, backward, both]
}

/// Returns the length of the diagonal of the box around all faces.
fn diagonal(mesh: &PolygonMesh) -> f64 {
    let corners = mesh.faces().corners().iter().map(|&v| mesh.position(v));
    Bounds::from_points(corners).extent().length()
}

fn rows_text(rows: &[Row], size: f64) -> String {
    let header = [
        "from",
        "mean",
        "root mean square",
        "largest",
        "% of diagonal",
    ];
    let mut table = table(header.map(Cell::new).to_vec());
    let names = ["the first mesh", "the second mesh", "both"];
    for (name, row) in names.into_iter().zip(rows) {
        let figures = [
            row.mean,
            row.root_mean_square,
            row.largest,
            row.largest_percent,
        ];
        let figures =
            figures.map(|value| Cell::new(figure(value)).set_alignment(CellAlignment::Right));
        table.add_row([Cell::new(name)].into_iter().chain(figures));
    }
    let mut lines = vec![
        hanging_indent("first    ", &sanitize(&rows[0].from)),
        hanging_indent("second   ", &sanitize(&rows[1].from)),
        String::new(),
        table.to_string(),
        String::new(),
    ];
    for (name, row) in names.into_iter().zip(rows) {
        if let Some(at) = row.farthest.filter(|_| row.largest > 0.0) {
            let at = at.map(|x| coordinate(x, size)).join(" ");
            lines.push(format!("farthest point of {name}: {at}"));
        }
    }
    lines.join("\n")
}

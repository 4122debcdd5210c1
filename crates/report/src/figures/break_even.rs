//! From how much work on a structure pays for being built.

use kuva::plot::LinePlot;
use kuva::render::plots::Plot;
use study::numbers::{duration, grouped};
use study::{Operation, Report, ResultRow};

use crate::colours::of_column;
use crate::figure::{Figure, Table, drawn, laid_out};

/// What is there already: who has nothing else begins with this.
const GIVEN: &str = "indexed-face-set";
/// Runs up to ten to this power.
const DECADES: i32 = 4;

/// Time of building and then running one operation again and again, against how often.
pub(super) fn of_study(study: &Report, of: &str, command: &str) -> Option<Figure> {
    // The operation that asks most, of those that were measured.
    let asked = [
        Operation::AllQueries,
        Operation::VertexNormal,
        Operation::VvSmooth,
        Operation::Circulate,
    ];
    let many = |operation: &Operation| {
        study
            .rows(*operation)
            .filter(|row| row.median_ns.is_some())
            .count()
            > 1
    };
    let operation = asked.into_iter().find(many)?;
    let build = |row: &ResultRow| -> Option<f64> {
        if row.backend == GIVEN {
            return Some(0.0);
        }
        let mut builds = study.rows(Operation::Build);
        builds.find(|build| build.backend == row.backend)?.median_ns
    };
    let rows = study.rows(operation);
    let lines: Vec<(&str, f64, f64)> = rows
        .filter_map(|row| Some((row.backend.as_str(), build(row)?, row.median_ns?)))
        .collect();
    if lines.len() < 2 {
        return None;
    }
    let given = lines.iter().find(|(name, ..)| *name == GIVEN);
    let mut table = Table::new(["", "to build", "one run", "pays after"]);
    let mut plots = Vec::new();
    for &(name, build, run) in &lines {
        let counts = (0..=4 * DECADES).map(|quarter| 10_f64.powf(f64::from(quarter) / 4.0));
        let points = counts.map(|count| (count, (build + count * run) / 1e6));
        plots.push(Plot::Line(
            LinePlot::new()
                .with_data(points.collect::<Vec<(f64, f64)>>())
                .with_color(of_column(name))
                .with_stroke_width(2.0)
                .with_legend(name),
        ));
        let pays = match given {
            _ if name == GIVEN => "is there".into(),
            Some((_, _, slow)) if *slow > run => {
                let runs = (build / (slow - run)).ceil().max(1.0) as usize;
                format!(
                    "{} {}",
                    grouped(runs),
                    if runs == 1 { "run" } else { "runs" }
                )
            }
            Some(_) => "never".into(),
            None => "–".into(),
        };
        table.row(vec![name.into(), duration(build), duration(run), pays]);
    }
    let title = format!(
        "Building, and then {operation} again and again: {}",
        study.mesh.name
    );
    let layout = laid_out(&plots, 820.0, 440.0)
        .with_log_scale()
        .with_x_label(format!("runs of {operation}"))
        .with_y_label("milliseconds in all");
    Some(Figure {
        id: format!("{of}break-even"),
        svg: drawn(&title, plots, layout),
        title,
        caption: format!(
            "An {GIVEN} is there already; another structure is built first, and where its line goes below, it has paid \
             for that. `sixfold pick` measures this for the mix of a program."
        ),
        table,
        command: command.into(),
    })
}

//! Figures of the growth of times with the size of the mesh. On logarithmic axes, the slope of a
//! line is the exponent of growth.

use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::plots::Plot;
use sixfold_study::numbers::{duration, grouped};
use sixfold_study::{Fit, GrowthReport, Operation, ResultRow, SizeReport, Slope};

use super::{marked, per_unit};
use crate::colours::column_colour;
use crate::data::rows as data;
use crate::figure::{Figure, Table, base_layout, picture};

pub(super) fn from_growth(report: &GrowthReport, id: &str, command: &str) -> Vec<Figure> {
    let operations: Vec<Operation> = Operation::ALL
        .into_iter()
        .filter(|&operation| report.fits.iter().any(|fit| fit.operation == operation))
        .collect();
    let figures = operations
        .into_iter()
        .map(|operation| figure(report, operation, id, command));
    figures.collect()
}

fn figure(report: &GrowthReport, operation: Operation, id: &str, command: &str) -> Figure {
    let fits = report.fits.iter().filter(|fit| fit.operation == operation);
    let fits: Vec<&Fit> = fits.collect();
    let plots: Vec<Plot> = fits
        .iter()
        .filter_map(|fit| curve(&report.sizes, fit))
        .flatten()
        .collect();
    let (name, per) = (operation.name(), per_unit(operation.unit()));
    let title = format!("{name}: total time as the mesh grows");
    let layout = base_layout(&plots, 860.0, 440.0)
        .with_log_scale()
        .with_x_label("faces")
        .with_y_label("total time, ms");
    Figure {
        id: format!("{id}-{}", name.replace('_', "-")),
        picture: picture(&title, plots, layout),
        title,
        caption: format!(
            "Both axes are logarithmic, so a straight line is a power of the number of faces. The \
             number after each name is the exponent. At 1, the time per element is constant; at \
             2, each element takes a scan of all faces. Lower bounds (≥ in the table) are not drawn. \
             The table shows the time {per}, and the \
             slopes: for all sizes, for the sizes that fit into the last cache, and for the \
             larger sizes."
        ),
        table: times_and_slopes(&report.sizes, &fits),
        data: data::growth(report, operation),
        command: command.into(),
    }
}

/// Draws the measured times of one backend over the sizes, with a mark for each size. Returns `None`
/// if there are no measured times.
fn curve(sizes: &[SizeReport], fit: &Fit) -> Option<[Plot; 2]> {
    let (mut points, mut titles) = (Vec::new(), Vec::new());
    for size in sizes {
        let Some(ns) = find_row(size, fit).and_then(|row| row.median_ns) else {
            continue;
        };
        points.push((size.faces as f64, ns / 1e6));
        titles.push(format!(
            "{}, {} faces: {}",
            fit.backend,
            grouped(size.faces),
            duration(ns)
        ));
    }
    if points.is_empty() {
        return None;
    }
    let colour = column_colour(&fit.backend);
    let legend = match fit.all {
        Some(slope) => format!("{}: {:.2}", fit.backend, slope.exponent),
        None => fit.backend.clone(),
    };
    let line = LinePlot::new()
        .with_data(points.clone())
        .with_color(colour)
        .with_stroke_width(2.0)
        .with_legend(legend);
    let marks = ScatterPlot::new()
        .with_data(points)
        .with_color(colour)
        .with_size(4.0)
        .with_tooltip_labels(titles);
    Some([Plot::Line(line), Plot::Scatter(marks)])
}

/// Returns a table with a column for each backend: its times per element, then its slopes.
fn times_and_slopes(sizes: &[SizeReport], fits: &[&Fit]) -> Table {
    let names = fits.iter().map(|fit| fit.backend.as_str());
    let mut table = Table::new(["faces"].into_iter().chain(names));
    for size in sizes {
        let cell = |fit: &&Fit| {
            let each = find_row(size, fit).and_then(each_ns);
            each.map_or_else(|| "–".into(), |(ns, bound)| marked(duration(ns), bound))
        };
        let mut line = vec![grouped(size.faces)];
        line.extend(fits.iter().map(cell));
        table.row(line);
    }
    type Select = fn(&Fit) -> Option<Slope>;
    let slopes: [(&str, Select); 3] = [
        ("slope", |fit| fit.all),
        ("slope, in cache", |fit| fit.in_cache),
        ("slope, beyond", |fit| fit.beyond),
    ];
    for (name, select) in slopes {
        let cells: Vec<String> = fits.iter().map(|fit| slope_cell(select(fit))).collect();
        if cells.iter().any(|cell| cell != "–") {
            table.row([vec![name.into()], cells].concat());
        }
    }
    table
}

/// Formats an exponent with its standard error, if it has one.
fn slope_cell(slope: Option<Slope>) -> String {
    match slope {
        Some(Slope {
            exponent,
            standard_error: Some(error),
            ..
        }) => format!("{exponent:.2} ± {error:.2}"),
        Some(slope) => format!("{:.2}", slope.exponent),
        None => "–".into(),
    }
}

fn find_row<'s>(size: &'s SizeReport, fit: &Fit) -> Option<&'s ResultRow> {
    let mut rows = size.results.iter();
    rows.find(|row| row.operation == fit.operation && row.backend == fit.backend)
}

/// Returns the time per element, and whether it is a lower bound.
fn each_ns(row: &ResultRow) -> Option<(f64, bool)> {
    let ns = row.median_ns.or(row.estimated_ns)?;
    Some((ns / row.elements?.max(1) as f64, row.median_ns.is_none()))
}

//! Figures of the growth of times with the size of the mesh. On logarithmic axes, the slope of a
//! line is the exponent of growth.

use sixfold_results::numbers::{duration, grouped};
use sixfold_results::{CacheLimit, Fit, GrowthReport, OperationInfo, ResultRow, SizeReport, Slope};

use super::{marked, per_unit};
use crate::Picture;
use crate::axes::{ACROSS, Axes, COLUMNS, Curve, CurvePoint, LogScale, SIZE, UPWARDS};
use crate::canvas::{Canvas, Style};
use crate::colours::{BACKGROUND, FAINT_COLOUR, column_colour, column_shape};
use crate::data::rows as data;
use crate::figure::{Figure, Table, count_tick, duration_tick};

/// Draws a panel for each operation. All panels have the same axes.
pub(super) fn from_growth(report: &GrowthReport, id: &str, command: &str) -> Option<Figure> {
    let of = |operation: &OperationInfo| -> Vec<&Fit> {
        let fits = report.fits.iter();
        fits.filter(|fit| fit.operation == operation.name).collect()
    };
    let operations = report.run.operations.iter().filter(|o| !of(o).is_empty());
    let operations: Vec<&OperationInfo> = operations.collect();
    let curves = report
        .fits
        .iter()
        .flat_map(|fit| points(&report.sizes, fit));
    let curves: Vec<[f64; 2]> = curves.collect();
    let ends = |axis: usize| {
        let values = curves.iter().map(|point| point[axis]);
        values.fold([f64::INFINITY, 0.0], |[least, most], value| {
            [f64::min(least, value), f64::max(most, value)]
        })
    };
    let (x, y) = (ends(0), ends(1));
    if curves.is_empty() || x[0] >= x[1] || y[0] >= y[1] {
        return None;
    }
    let axes = Axes {
        x: LogScale {
            values: x,
            pixels: ACROSS,
        },
        y: LogScale {
            values: y,
            pixels: UPWARDS,
        },
        x_label: "faces",
        y_label: "total time",
        x_format: &count_tick,
        y_format: &duration_tick,
    };
    let mut table = None;
    let mut panels = Vec::new();
    for operation in &operations {
        let fits = of(operation);
        panels.push(panel(report, operation, &fits, &axes));
        add_times_and_slopes(&mut table, &report.sizes, operation, &fits);
    }
    let title = format!("Total time as the mesh grows: {}", report.shape);
    let largest = report.sizes.iter().map(|size| size.faces).max();
    let exceeded = last_cache(report).filter(|last| {
        let mut limits = report.cache_limits.iter();
        limits.any(|limit| limit.level == last.level && Some(limit.faces) <= largest)
    });
    let limit = exceeded.map_or(String::new(), |limit| {
        format!(
            " A ring marks the size from which a structure is larger than the last cache (L{}, {} MiB).",
            limit.level,
            grouped(limit.cache_bytes as usize >> 20)
        )
    });
    let slopes = match exceeded {
        Some(_) => {
            "the slopes for all sizes, for the sizes that fit into the last cache, and for the larger sizes"
        }
        None => "the slopes for all sizes, which fit into the last cache",
    };
    let slopes = match last_cache(report) {
        Some(_) => slopes,
        None => "the slopes",
    };
    Some(Figure {
        id: id.into(),
        picture: Picture::grid(&title, COLUMNS, panels),
        title,
        caption: format!(
            "The meshes are made by Sixfold (the shape {}), not read from a file. Both axes are logarithmic and the same in all panels, so a straight line is a power of the \
             number of faces. The number at each name is the exponent: at 1, the time per element \
             is constant; at 2, each element takes a scan of all faces.{limit} Lower bounds (≥ in the table) are \
             not drawn. An open point, or ~: measured on a sample of the elements. The table has the times per element, and {slopes}.",
            report.shape
        ),
        table: table.unwrap_or_default(),
        csv: data::growth(report),
        source: String::new(),
        command: command.into(),
    })
}

/// Returns the measured times of one backend, in nanoseconds, over the numbers of faces, and whether each was
/// measured on a sample of the elements.
fn measured(sizes: &[SizeReport], fit: &Fit) -> Vec<([f64; 2], bool)> {
    let point = |size: &SizeReport| {
        let row = find_row(size, fit)?;
        Some(([size.faces as f64, row.median_ns?], row.sampled))
    };
    sizes.iter().filter_map(point).collect()
}

/// Returns the points of [`measured`].
fn points(sizes: &[SizeReport], fit: &Fit) -> Vec<[f64; 2]> {
    let measured = measured(sizes, fit).into_iter();
    measured.map(|(point, _)| point).collect()
}

/// Returns the limit of a structure in the last cache.
fn last_cache(report: &GrowthReport) -> Option<&CacheLimit> {
    report.cache_limits.iter().max_by_key(|limit| limit.level)
}

fn panel(
    report: &GrowthReport,
    operation: &OperationInfo,
    fits: &[&Fit],
    axes: &Axes<'_>,
) -> Canvas {
    let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
    canvas.text([0.0, 14.0], &operation.name, Style::new(14).bold(true));
    axes.draw(&mut canvas);
    let curves = fits.iter().map(|fit| {
        let measured = measured(&report.sizes, fit).into_iter();
        let points = measured.map(|([faces, ns], is_sampled)| CurvePoint {
            at: [faces, ns],
            title: format!(
                "{}, {} faces: {}",
                fit.backend,
                grouped(faces as usize),
                from_sample(duration(ns), is_sampled)
            ),
            is_sampled,
        });
        Curve {
            name: match fit.all {
                Some(slope) => format!("{}: {:.2}", fit.backend, slope.exponent),
                None => fit.backend.clone(),
            },
            colour: column_colour(&fit.backend),
            shape: column_shape(&fit.backend),
            points: points.collect(),
        }
    });
    let drawn = axes.draw_curves(&mut canvas, curves.collect());
    let level = last_cache(report).map(|limit| limit.level);
    let limits = report.cache_limits.iter();
    for limit in limits.filter(|limit| Some(limit.level) == level) {
        let fit = fits.iter().find(|fit| fit.backend == limit.backend);
        let curve = fit.map(|fit| points(&report.sizes, fit));
        if let Some(point) = curve.and_then(|curve| between(&curve, limit.faces as f64)) {
            let place = axes.place(point);
            canvas.circle(place, 6.0, column_colour(&limit.backend));
            canvas.circle(place, 4.0, BACKGROUND);
        }
    }
    if drawn == 0 {
        canvas.text(
            [ACROSS[0] + 10.0, 80.0],
            "no measured times",
            Style::new(12).colour(FAINT_COLOUR),
        );
    }
    canvas
}

/// Returns the point of a curve at `x`, between its measured points; `None` beyond its ends.
fn between(points: &[[f64; 2]], x: f64) -> Option<[f64; 2]> {
    let pair = points
        .windows(2)
        .find(|pair| pair[0][0] <= x && x <= pair[1][0])?;
    let share = (x / pair[0][0]).ln() / (pair[1][0] / pair[0][0]).ln();
    Some([x, pair[0][1] * (pair[1][1] / pair[0][1]).powf(share)])
}

/// Adds the rows of an operation to a table with a column for each backend: its times per element, then
/// its slopes.
fn add_times_and_slopes(
    table: &mut Option<Table>,
    sizes: &[SizeReport],
    operation: &OperationInfo,
    fits: &[&Fit],
) {
    let names = fits.iter().map(|fit| fit.backend.as_str());
    let header = ["", "faces"].into_iter().chain(names);
    let table = table.get_or_insert_with(|| Table::new(header));
    let what = format!("{}, {}", &operation.name, per_unit(&operation.unit));
    for size in sizes {
        let cell = |fit: &&Fit| {
            let row = find_row(size, fit);
            let each = row.and_then(|row| Some((row, each_ns(row)?)));
            each.map_or_else(
                || "–".into(),
                |(row, (ns, bound))| marked(from_sample(duration(ns), row.sampled), bound),
            )
        };
        let mut line = vec![what.clone(), grouped(size.faces)];
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
            table.row([vec![operation.name.clone(), name.into()], cells].concat());
        }
    }
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

/// Marks a time that was measured on a sample of the elements.
fn from_sample(time: String, is_sampled: bool) -> String {
    match is_sampled {
        true => format!("~{time}"),
        false => time,
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

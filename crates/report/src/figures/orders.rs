//! A figure of the effect that the order of the elements in memory has on the times of each
//! structure.

use sixfold_results::numbers::{duration, figure as shown, shown_ratio, times};
use sixfold_results::{Comparison, OrdersReport, ResultRow};

use super::per_unit;
use crate::Picture;
use crate::axes::{COLUMNS, LogScale};
use crate::canvas::{Canvas, Style, text_width};
use crate::colours::{BACKGROUND, FAINT_COLOUR, order_mark};
use crate::data::rows as data;
use crate::figure::{Figure, Table};

/// Size of a panel, and the places of its parts.
const WIDTH: f64 = 364.0;
const HEAD: f64 = 46.0;
const ROW: f64 = 24.0;
const POINTS: [f64; 2] = [122.0, 236.0];
/// Height of a line of the names of the orders.
const LINE: f64 = 17.0;
/// The points of one structure are on lines of their own, so that they do not hide each other.
const APART: f64 = 4.0;

/// The times of one backend in all orders, relative to its best order.
struct Line<'r> {
    backend: &'r str,
    /// The kind of the visited elements.
    per: &'r str,
    /// The orders, in the order of the list.
    points: Vec<Option<Point>>,
}

/// The time of a backend in one order.
#[derive(Clone, Copy)]
struct Point {
    /// The time divided by that of the best order.
    ratio: f64,
    /// Time per element.
    ns: f64,
    /// Whether the time is from too few launches or samples to be ranked.
    is_unsure: bool,
}

/// Draws a panel for each operation. All panels have one scale.
pub(super) fn from_orders(report: &OrdersReport, id: &str, command: &str) -> Option<Figure> {
    let names: Vec<&str> = report.orders.iter().map(String::as_str).collect();
    let header = ["", "structure"].into_iter().chain(names.iter().copied());
    let confidence = report.run.settings.confidence.to_string();
    let mut table = Table::new(header.chain(["worst / best", &confidence]));
    let comparisons = report.comparisons.iter();
    let all: Vec<(&Comparison, Vec<Line<'_>>)> = comparisons
        .map(|comparison| (comparison, lines(report, comparison)))
        .filter(|(_, lines)| !lines.is_empty())
        .collect();
    let points = all
        .iter()
        .flat_map(|(_, lines)| lines)
        .flat_map(|line| &line.points);
    let points: Vec<Point> = points.flatten().copied().collect();
    let ratios = points.iter().map(|point| point.ratio);
    // The scale reaches at least ratio 1.5, so that noise does not fill the figure.
    let scale = LogScale {
        values: [1.0, ratios.fold(1.5, f64::max)],
        pixels: POINTS,
    };
    let rows = all.iter().map(|(_, lines)| lines.len()).max()?;
    let mut panels = Vec::new();
    for (comparison, lines) in &all {
        panels.push(panel(comparison, lines, &names, scale, rows));
        for line in lines {
            table.row(row(comparison, line));
        }
    }
    let title = format!(
        "Times in each order: {}",
        super::file_name(&report.mesh.name)
    );
    Some(Figure {
        id: id.into(),
        picture: Picture::grid(&title, COLUMNS, panels),
        title,
        caption: format!(
            "A point is the time of a structure in one order of the elements, divided by that of the best order of this structure, \
             on a logarithmic scale that is the same in all panels: on the right is slower. The text is the ratio of the slowest order, and \
             the time of the best order.{} The table has all times per element.",
            match points.iter().any(|point| point.is_unsure) {
                true => " Open points are times from too few launches or samples to be ranked.",
                false => "",
            }
        ),
        table,
        csv: data::orders(report),
        source: String::new(),
        command: command.into(),
    })
}

fn lines<'r>(report: &'r OrdersReport, comparison: &Comparison) -> Vec<Line<'r>> {
    let rows: Vec<&ResultRow> = report.rows(&comparison.operation).collect();
    let lines = rows.chunk_by(|a, b| a.backend == b.backend).map(|rows| {
        let times = rows.iter().filter_map(|row| row.ns_per_element);
        let best = times.fold(f64::INFINITY, f64::min);
        let points = report.orders.iter().map(|order| {
            let row = rows.iter().find(|row| row.case == *order);
            let row = row.filter(|row| row.ratio_to_best.is_some())?;
            let ns = row.ns_per_element?;
            Some(Point {
                ratio: shown_ratio(ns, best),
                ns,
                is_unsure: !row.has_enough_samples(),
            })
        });
        Line {
            backend: &rows[0].backend,
            per: &rows[0].per,
            points: points.collect(),
        }
    });
    lines.collect()
}

fn row(comparison: &Comparison, line: &Line<'_>) -> Vec<String> {
    let effect = comparison.orders.iter().find(|e| e.backend == line.backend);
    let factor = effect.map(|effect| effect.worst_to_best);
    let worst = line
        .points
        .iter()
        .flatten()
        .map(|point| point.ratio)
        .fold(1.0, f64::max);
    let interval = factor.and_then(|factor| factor.ci_low.zip(factor.ci_high));
    let operation = &comparison.operation;
    let mut cells = vec![
        format!("{operation}, {}", per_unit(line.per)),
        line.backend.to_owned(),
    ];
    let times = line.points.iter();
    cells.extend(times.map(|point| point.map_or_else(|| "–".into(), |point| duration(point.ns))));
    cells.push(factor.map_or_else(|| "–".into(), |_| shown(worst)));
    cells.push(interval.map_or_else(
        || "–".into(),
        |(low, high)| format!("{} to {}", shown(low), shown(high)),
    ));
    cells
}

fn panel(
    comparison: &Comparison,
    lines: &[Line<'_>],
    names: &[&str],
    scale: LogScale,
    rows: usize,
) -> Canvas {
    // The names of the orders, in as many lines as they need.
    let mut keys = Vec::new();
    let (mut x, mut y) = (0.0, 31.0);
    for name in names {
        let width = 26.0 + text_width(name, 12);
        if x > 0.0 && x + width > WIDTH {
            (x, y) = (0.0, y + LINE);
        }
        keys.push([x, y]);
        x += width;
    }
    let head = y - LINE + 2.0 + HEAD;
    let mut canvas = Canvas::new(WIDTH, head + ROW * rows as f64);
    let style = Style::new(14).bold(true);
    canvas.text([0.0, 14.0], &comparison.operation, style);
    for (place, (name, [x, y])) in names.iter().zip(keys).enumerate() {
        let (colour, shape) = order_mark(place);
        canvas.point(shape, [x + 4.0, y - 4.0], 4.0, colour);
        canvas.text([x + 11.0, y], name, Style::new(12).colour(FAINT_COLOUR));
    }
    let bottom = head + ROW * lines.len() as f64 - 6.0;
    let label = |tick: f64| format!("{tick} ×");
    let ends = [head - 4.0, bottom];
    scale.draw_ticks(&mut canvas, ends, head - 8.0, FAINT_COLOUR, &label);
    let per = per_unit(lines.first().map_or("", |line| line.per));
    for (number, line) in lines.iter().enumerate() {
        let y = head + ROW * number as f64 + 6.0;
        canvas.text(
            [POINTS[0] - 10.0, y + 4.0],
            line.backend,
            Style::new(12).end(),
        );
        let mut worst: f64 = 1.0;
        let mut best = f64::INFINITY;
        let middle = (line.points.len() as f64 - 1.0) / 2.0;
        let points = line.points.iter().enumerate();
        for (
            place,
            &Point {
                ratio,
                ns,
                is_unsure,
            },
        ) in points.filter_map(|(i, p)| Some((i, p.as_ref()?)))
        {
            worst = worst.max(ratio);
            best = best.min(ns);
            let title = format!(
                "{}, {}: {} × the time of its best order, {} {per}",
                line.backend,
                names[place],
                shown(ratio),
                duration(ns)
            );
            let at = [scale.place(ratio), y + APART * (place as f64 - middle)];
            let (colour, shape) = order_mark(place);
            canvas.mark(title, |canvas| {
                canvas.point(shape, at, 4.0, colour);
                if is_unsure {
                    canvas.point(shape, at, 2.4, BACKGROUND);
                }
            });
        }
        let text = match worst {
            _ if best.is_infinite() => "–".into(),
            _ if line.points.iter().flatten().count() == 1 => duration(best),
            1.0 => format!("all {}", duration(best)),
            worst => format!("{} of {}", times(worst), duration(best)),
        };
        canvas.text([POINTS[1] + 14.0, y + 4.0], &text, Style::new(12));
    }
    canvas
}

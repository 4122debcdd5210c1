//! A figure of the effect that the order of the elements in memory has on the times of each
//! structure.

use kuva::plot::BarPlot;
use kuva::render::plots::Plot;
use sixfold_study::numbers::{duration, figure as shown, shown_ratio};
use sixfold_study::{Comparison, OrdersReport, ResultRow};

use super::per_unit;
use crate::colours::table_colour;
use crate::data::rows as data;
use crate::figure::{Figure, MIN_BAR_LENGTH, Table, base_layout, picture, ratio_ticks};

pub(super) fn from_orders(report: &OrdersReport, id: &str, command: &str) -> Vec<Figure> {
    let figures = report
        .comparisons
        .iter()
        .filter_map(|comparison| figure(report, comparison, id, command));
    figures.collect()
}

fn figure(
    report: &OrdersReport,
    comparison: &Comparison,
    id: &str,
    command: &str,
) -> Option<Figure> {
    let operation = comparison.operation;
    let rows: Vec<&ResultRow> = report.rows(operation).collect();
    if rows.is_empty() {
        return None;
    }
    let names: Vec<&str> = report.orders.iter().map(|order| order.name()).collect();
    let header = [""].into_iter().chain(names.iter().copied());
    let mut table = Table::new(header.chain(["worst / best", "95 %"]));
    let (mut plot, mut titles) = (BarPlot::new().with_legend(names), Vec::new());
    let logs = rows.iter().filter_map(|row| row.ratio_to_best);
    // The axis reaches at least ratio 1.5, so that noise does not fill the figure.
    let max_log = logs.fold(1.5, f64::max).log10();
    let per = per_unit(operation.unit());
    for backend_rows in rows.chunk_by(|a, b| a.backend == b.backend) {
        let backend = &backend_rows[0].backend;
        let times = backend_rows.iter().filter_map(|row| row.ns_per_element);
        let best = times.clone().fold(f64::INFINITY, f64::min);
        let worst = times.fold(0.0, f64::max);
        let (mut bars, mut line) = (Vec::new(), vec![backend.clone()]);
        for (i, &order) in report.orders.iter().enumerate() {
            let row = backend_rows.iter().find(|row| row.case == order.name());
            let ratio = row.and_then(|row| row.ratio_to_best);
            let time = row.and_then(|row| row.ns_per_element);
            let ratio = ratio.and(time.map(|time| shown_ratio(time, best)));
            let time = time.map_or_else(|| "–".into(), duration);
            titles.push(match ratio {
                Some(ratio) => {
                    let ratio = shown(ratio);
                    format!(
                        "{backend}, {order}: {ratio} × the time of its best order, {time} {per}"
                    )
                }
                None => format!("{backend}, {order}: not measured"),
            });
            let length = ratio.map_or(0.0, |ratio| ratio.log10().max(MIN_BAR_LENGTH * max_log));
            bars.push((length, table_colour(i)));
            line.push(time);
        }
        let effect = comparison.orders.iter().find(|e| e.backend == *backend);
        let factor = effect.map(|effect| effect.worst_to_best);
        line.push(factor.map_or_else(|| "–".into(), |_| shown(shown_ratio(worst, best))));
        let interval = factor.and_then(|factor| factor.ci_low.zip(factor.ci_high));
        line.push(interval.map_or_else(
            || "–".into(),
            |(a, b)| format!("{} to {}", shown(a), shown(b)),
        ));
        table.row(line);
        plot = plot.with_group(backend.clone(), bars);
    }
    // Without `with_tooltips`, the SVG groups of the marks are not closed.
    let plot = plot.with_tooltips().with_tooltip_labels(titles);
    let plots = vec![Plot::Bar(plot)];
    let name = operation.name();
    let title = format!(
        "{name}: effect of the order in memory, {}",
        report.mesh.name
    );
    let layout = base_layout(&plots, 860.0, 360.0)
        .with_y_label("× the time of the best order")
        .with_y_axis_min(0.0)
        .with_y_axis_max(1.05 * max_log)
        .with_y_tick_format(ratio_ticks(max_log));
    Some(Figure {
        id: format!("{id}-{}", name.replace('_', "-")),
        picture: picture(&title, plots, layout),
        title,
        caption: format!(
            "The bars show the time of each structure in four orders of the same mesh, relative \
             to the best order of that structure. The axis is logarithmic and begins at 1. The \
             table shows the time {per}."
        ),
        table,
        data: data::orders(report, operation),
        command: command.into(),
    })
}

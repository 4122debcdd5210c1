//! Times of queries over the bytes that they move. A mark on the line of a memory speed can become
//! faster only by moving fewer bytes.

use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::plots::Plot;
use sixfold_study::numbers::{bytes, duration};
use sixfold_study::{Rung, Timed, Why, WhyRow};

use super::one;
use crate::colours::{INK, of_column};
use crate::figure::{Figure, Table, drawn, laid_out};

/// Draws all relations on all structures in one figure; `None` if nothing was measured.
pub(super) fn of_why(why: &Why, id: &str, command: &str) -> Option<Figure> {
    let rungs = why.memory.as_ref()?;
    let rows = why.rows.iter().filter_map(|row| Some((row, row.timed?)));
    let rows: Vec<(&WhyRow, Timed)> = rows
        .filter(|(row, _)| row.reads.moved_bytes > 0.0)
        .collect();
    let ends = rows.iter().map(|(row, _)| row.reads.moved_bytes);
    let [least, most] = ends.fold([f64::INFINITY, 0.0], |[least, most], bytes| {
        [f64::min(least, bytes), f64::max(most, bytes)]
    });
    if rows.is_empty() {
        return None;
    }
    let mut plots = Vec::new();
    // The fastest and the slowest buffer; all others are between them.
    for rung in [rungs.first(), rungs.last()].into_iter().flatten() {
        plots.push(line(rung, least, most));
    }
    for backend in &why.backends {
        let (mut points, mut titles) = (Vec::new(), Vec::new());
        for (row, timed) in rows.iter().filter(|(row, _)| row.backend == backend.name) {
            points.push((row.reads.moved_bytes, timed.ns_per_element));
            titles.push(format!(
                "{}, {}: {:.1} bytes, {} {}: {}",
                row.backend,
                row.reads.relation,
                row.reads.moved_bytes,
                duration(timed.ns_per_element),
                one(&row.per),
                timed.bound.name()
            ));
        }
        if points.is_empty() {
            continue;
        }
        plots.push(Plot::Scatter(
            ScatterPlot::new()
                .with_data(points)
                .with_color(of_column(&backend.name))
                .with_size(5.0)
                .with_legend(backend.name.clone())
                .with_tooltip_labels(titles),
        ));
    }
    let mut table = Table::new([
        "",
        "structure",
        "bytes",
        "jumps",
        "time",
        "to move the bytes",
        "to wait",
        "bound by",
    ]);
    for (row, timed) in &rows {
        table.row(vec![
            row.reads.relation.to_string(),
            row.backend.clone(),
            format!("{:.1}", row.reads.moved_bytes),
            format!("{:.2}", row.reads.jumps),
            duration(timed.ns_per_element),
            duration(timed.floor_ns),
            duration(timed.waits_ns),
            timed.bound.name().into(),
        ]);
    }
    let title = format!("Time against the bytes that must move: {}", why.mesh.name);
    let layout = laid_out(&plots, 860.0, 520.0)
        .with_log_scale()
        .with_x_label("bytes that must move per element")
        .with_y_label("time per element, ns");
    Some(Figure {
        id: id.into(),
        svg: drawn(&title, plots, layout),
        title,
        caption: "One mark for each relation on each structure. The lines show the time of this machine to read these \
             bytes in order, from the smallest and from the largest buffer. A mark near its line is bound by \
             bandwidth. A mark above it waits for reads that cannot be predicted, or is busy computing; the table \
             shows which."
            .into(),
        table,
        command: command.into(),
    })
}

/// Draws the time to read `least` to `most` bytes at the speed of `rung`.
fn line(rung: &Rung, least: f64, most: f64) -> Plot {
    let ends = [least, most].map(|bytes| (bytes, bytes / rung.gb_per_s));
    Plot::Line(
        LinePlot::new()
            .with_data(ends.to_vec())
            .with_color(INK)
            .with_stroke_width(1.0)
            .with_dashed()
            .with_legend(format!("{:.1} GB/s, {}", rung.gb_per_s, bytes(rung.bytes))),
    )
}

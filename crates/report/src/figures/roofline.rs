//! A figure that plots the time of each query against the bytes that the query moves from memory.
//! Lines show the speed of memory. If the mark of a query is on a line, the query can become faster
//! only by moving fewer bytes.

use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::plots::Plot;
use sixfold_study::numbers::{bytes, duration};
use sixfold_study::{BufferSpeed, Timed, Why, WhyRow};

use super::per_unit;
use crate::colours::{TEXT_COLOUR, column_colour};
use crate::data::rows as data;
use crate::figure::{Figure, Table, base_layout, picture};

type TimedRow<'a> = (&'a WhyRow, Timed);

/// Draws all relations on all structures. Returns `None` if nothing was measured.
pub(super) fn from_why(why: &Why, id: &str, command: &str) -> Option<Figure> {
    let buffers = why.memory.as_ref()?;
    let rows = why.rows.iter().filter_map(|row| Some((row, row.timed?)));
    let rows: Vec<TimedRow> = rows
        .filter(|(row, _)| row.reads.moved_bytes > 0.0)
        .collect();
    if rows.is_empty() {
        return None;
    }
    let ends = rows.iter().map(|(row, _)| row.reads.moved_bytes);
    let [min_bytes, max_bytes] = ends
        .fold([f64::INFINITY, 0.0], |[min_bytes, max_bytes], bytes| {
            [f64::min(min_bytes, bytes), f64::max(max_bytes, bytes)]
        });
    // The other buffers lie between these two.
    let buffers = [buffers.first(), buffers.last()].into_iter().flatten();
    let mut plots: Vec<Plot> = buffers
        .map(|buffer| line(buffer, min_bytes, max_bytes))
        .collect();
    plots.extend(
        why.backends
            .iter()
            .filter_map(|backend| marks(&rows, &backend.name)),
    );
    let title = format!("Time and bytes that must move: {}", why.mesh.name);
    let layout = base_layout(&plots, 860.0, 520.0)
        .with_log_scale()
        .with_x_label("bytes that must move per element")
        .with_y_label("time per element, ns");
    Some(Figure {
        id: id.into(),
        picture: picture(&title, plots, layout),
        title,
        caption: "Each mark is one relation on one structure. The two lines show the time in \
                  which this machine reads these bytes in order: one line for the smallest \
                  buffer, the other for the largest. Bandwidth limits a query near a line. A \
                  query above the lines waits for reads that cannot be predicted, or computes. \
                  The column `bound by` of the table shows the limit."
            .into(),
        table: table(&rows),
        data: data::roofline(why),
        command: command.into(),
    })
}

/// Draws a mark for each relation on the structure `backend`. Returns `None` without rows.
fn marks(rows: &[TimedRow], backend: &str) -> Option<Plot> {
    let (mut points, mut titles) = (Vec::new(), Vec::new());
    for (row, timed) in rows.iter().filter(|(row, _)| row.backend == backend) {
        points.push((row.reads.moved_bytes, timed.ns_per_element));
        titles.push(format!(
            "{}, {}: {:.1} bytes, {} {}: {}",
            row.backend,
            row.reads.relation,
            row.reads.moved_bytes,
            duration(timed.ns_per_element),
            per_unit(&row.per),
            timed.bound.name()
        ));
    }
    if points.is_empty() {
        return None;
    }
    Some(Plot::Scatter(
        ScatterPlot::new()
            .with_data(points)
            .with_color(column_colour(backend))
            .with_size(5.0)
            .with_legend(backend.to_owned())
            .with_tooltip_labels(titles),
    ))
}

fn table(rows: &[TimedRow]) -> Table {
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
    for (row, timed) in rows {
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
    table
}

/// Draws the time to read from `min_bytes` to `max_bytes` at the speed of `buffer`.
fn line(buffer: &BufferSpeed, min_bytes: f64, max_bytes: f64) -> Plot {
    let ends = [min_bytes, max_bytes].map(|bytes| (bytes, bytes / buffer.gb_per_s));
    Plot::Line(
        LinePlot::new()
            .with_data(ends.to_vec())
            .with_color(TEXT_COLOUR)
            .with_stroke_width(1.0)
            .with_dashed()
            .with_legend(format!(
                "{:.1} GB/s, {}",
                buffer.gb_per_s,
                bytes(buffer.bytes)
            )),
    )
}

//! A figure that plots the time of each query against the bytes of the cache lines that the query touches.
//! Lines show how fast a simple loop reads as many bytes in order. A query near a line hardly becomes faster
//! unless it touches fewer lines.

use sixfold_results::numbers::{bytes, duration, figure as shown, grouped};
use sixfold_results::{Bound, BufferSpeed, Timed, Why, WhyRow};

use super::{file_name, per_unit};
use crate::Picture;
use crate::axes::{ACROSS, Axes, COLUMNS, LogScale, SIZE, UPWARDS, spread};
use crate::canvas::{Canvas, Style, text_width};
use crate::colours::{BACKGROUND, FAINT_COLOUR, TEXT_COLOUR, column_colour};
use crate::data::rows as data;
use crate::figure::{Figure, Table, byte_tick, duration_tick};

type TimedRow<'a> = (&'a WhyRow, &'a Timed);

/// Draws a panel for each structure with all relations. All panels have the same axes. Returns `None` if
/// nothing was measured.
pub(super) fn from_why(why: &Why, id: &str, command: &str) -> Option<Figure> {
    let buffers = why.memory.as_ref()?;
    let rows = why
        .rows
        .iter()
        .filter_map(|row| Some((row, row.timed.as_ref()?)));
    let rows: Vec<TimedRow<'_>> = rows
        .filter(|(row, _)| row.reads.moved_bytes > 0.0)
        .collect();
    // The other buffers lie between these two.
    let buffers: Vec<&BufferSpeed> = [buffers.first(), buffers.last()]
        .into_iter()
        .flatten()
        .collect();
    let ends = |value: &dyn Fn(&TimedRow<'_>) -> f64| {
        let values = rows.iter().map(value);
        let [least, most] = values.fold([f64::INFINITY, 0.0], |[least, most], value| {
            [f64::min(least, value), f64::max(most, value)]
        });
        // At least a decade, so that a scale exists, and some space for the marks at the ends.
        [least / 1.5, most.max(10.0 * least) * 1.5]
    };
    if rows.is_empty() {
        return None;
    }
    let axes = Axes {
        x: LogScale {
            values: ends(&|(row, _)| row.reads.moved_bytes),
            pixels: ACROSS,
        },
        y: LogScale {
            values: ends(&|(_, timed)| timed.ns_per_element),
            pixels: UPWARDS,
        },
        x_label: "bytes of touched lines per element",
        y_label: "time per element",
        x_format: &byte_tick,
        y_format: &duration_tick,
    };
    let names = why.backends.iter().map(|backend| backend.name.as_str());
    let panels = names.filter_map(|name| {
        let own = rows.iter().filter(|(row, _)| row.backend == name);
        let own: Vec<&TimedRow<'_>> = own.collect();
        (!own.is_empty()).then(|| panel(name, &own, &buffers, &axes))
    });
    let panels: Vec<Canvas> = panels.collect();
    let title = format!(
        "Time and bytes of touched lines: {}",
        file_name(&why.mesh.name)
    );
    let speeds = buffers.iter().map(|buffer| {
        format!(
            "{:.1} GB/s in a buffer of {}",
            buffer.gb_per_s,
            bytes(buffer.bytes)
        )
    });
    let faster = rows.iter();
    let faster = faster.filter(|(_, timed)| timed.ns_per_element < timed.floor_ns);
    let faster = match faster.count() {
        0 => String::new(),
        count => format!(
            " {} faster: these are measured speeds, not limits.",
            match count {
                1 => format!("1 of {} queries is", grouped(rows.len())),
                count => format!("{} of {} queries are", grouped(count), grouped(rows.len())),
            }
        ),
    };
    Some(Figure {
        id: id.into(),
        picture: Picture::grid(&title, COLUMNS, panels),
        title,
        caption: format!(
            "Each point is one relation on one structure; all panels have the same axes. The dashed lines show the time in which \
             a simple loop on this machine reads as many bytes in order: {}.{faster} The shape of a point shows what limits the query. Square: bandwidth (near a \
             line). Ring: waiting for reads that cannot be predicted. Dot: work on data that is near. The table has the lines of one query alone, and \
             the bytes and jumps of queries at all elements: lines that are not cached, and those of them that are not near a cached one. \
             ~: from some of the queries. The times to move the bytes and to wait for the jumps are those of a buffer as large as what all \
             queries read.",
            speeds.collect::<Vec<_>>().join(", and ")
        ),
        table: table(&rows),
        csv: data::roofline(why),
        source: String::new(),
        command: command.into(),
    })
}

fn panel(name: &str, rows: &[&TimedRow<'_>], buffers: &[&BufferSpeed], axes: &Axes<'_>) -> Canvas {
    let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
    canvas.text([0.0, 14.0], name, Style::new(14).bold(true));
    axes.draw(&mut canvas);
    let roofs = buffers
        .iter()
        .filter_map(|buffer| Some((buffer, roof(buffer, axes)?)));
    let roofs: Vec<(&&BufferSpeed, [[f64; 2]; 2])> = roofs.collect();
    for (_, [start, end]) in &roofs {
        canvas.dashed(*start, *end, TEXT_COLOUR, 1.0);
    }
    // Above their lines near the ends, on fields of their own, so that no line goes through them.
    let heights: Vec<f64> = roofs.iter().map(|(_, [_, end])| end[1]).collect();
    let heights = spread(&heights, 16.0, [UPWARDS[1] + 16.0, UPWARDS[0]]);
    for ((buffer, [from, to]), y) in roofs.into_iter().zip(heights) {
        let x = to[0] + (y - to[1]) * (from[0] - to[0]) / (from[1] - to[1]);
        let text = format!("{:.0} GB/s", buffer.gb_per_s);
        let width = text_width(&text, 12) + 4.0;
        canvas.rect([x - width - 2.0, y - 15.0], [width, 14.0], BACKGROUND);
        let label = Style::new(12).end().colour(FAINT_COLOUR);
        canvas.text([x - 4.0, y - 4.0], &text, label);
    }
    let colour = column_colour(name);
    let places = rows
        .iter()
        .map(|(row, timed)| axes.place([row.reads.moved_bytes, timed.ns_per_element]));
    let places: Vec<[f64; 2]> = places.collect();
    let heights: Vec<f64> = places.iter().map(|[_, y]| *y).collect();
    let labels = spread(&heights, 13.0, [UPWARDS[1], UPWARDS[0]]);
    for (((row, timed), [x, y]), label) in rows.iter().zip(places).zip(labels) {
        let title = format!(
            "{}, {}: {}, {} {}: {}",
            row.backend,
            row.reads.relation,
            bytes(row.reads.moved_bytes.round() as usize),
            duration(timed.ns_per_element),
            per_unit(&row.per),
            timed.bound.name()
        );
        canvas.line([x + 3.0, y], [ACROSS[1] + 12.0, label], colour, 0.6);
        canvas.mark(title, |canvas| match timed.bound {
            Bound::Bandwidth => canvas.rect([x - 4.0, y - 4.0], [8.0, 8.0], colour),
            Bound::Latency => canvas.ring([x, y], 3.5, colour),
            _ => canvas.circle([x, y], 4.0, colour),
        });
        let relation = row.reads.relation.to_string();
        canvas.text([ACROSS[1] + 15.0, label + 4.0], &relation, Style::new(12));
    }
    canvas
}

/// Returns the ends of the line of the time to read bytes at the speed of `buffer`, as far as it is on the axes.
fn roof(buffer: &BufferSpeed, axes: &Axes<'_>) -> Option<[[f64; 2]; 2]> {
    let (x, y) = (axes.x.values, axes.y.values);
    let from = x[0].max(y[0] * buffer.gb_per_s);
    let to = x[1].min(y[1] * buffer.gb_per_s);
    let ends = [from, to].map(|bytes| axes.place([bytes, bytes / buffer.gb_per_s]));
    (from < to).then_some(ends)
}

fn table(rows: &[TimedRow]) -> Table {
    let mut table = Table::new([
        "",
        "structure",
        "cache lines",
        "bytes",
        "jumps",
        "time",
        "to move the bytes",
        "to wait",
        "bound by",
    ]);
    for (row, timed) in rows {
        let sign = if row.reads.sampled { "~ " } else { "" };
        table.row(vec![
            row.reads.relation.to_string(),
            row.backend.clone(),
            format!("{sign}{}", shown(row.reads.lines)),
            format!("{sign}{}", shown(row.reads.moved_bytes)),
            format!("{sign}{:.2}", row.reads.jumps),
            duration(timed.ns_per_element),
            duration(timed.floor_ns),
            duration(timed.waits_ns),
            timed.bound.name().into(),
        ]);
    }
    table
}

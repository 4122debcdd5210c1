//! The figure of the changes beyond chance: a row for each time, the largest change first.

use sixfold_results::Change;
use sixfold_results::numbers::{counted, grouped, times};

use super::ratio_axis::{self, FARTHEST};
use crate::Picture;
use crate::axes::LogScale;
use crate::canvas::{Canvas, Style, text_width};
use crate::changes::{Compared, Ranked, TABLE_ROWS, both_times};
use crate::colours::{FAINT_COLOUR, GRID_COLOUR, INTERVAL_COLOUR, column_colour};
use crate::data::rows;
use crate::figure::Figure;

/// Maximum number of rows in the picture.
const SHOWN: usize = 40;
/// Height of the axis above the rows, of a row, and of the labels below.
const HEAD: f64 = 44.0;
const ROW: f64 = 20.0;
const FOOT: f64 = 20.0;
/// Width of the ratios, and space between columns.
const PLOT: f64 = 300.0;
const GAP: f64 = 10.0;
/// Maximum number of letters of the name of an operation with its place, and of a backend.
const LETTERS: [usize; 2] = [44, 22];

/// Heading of the texts at the right.
const TEXTS: &str = "ratio, before → after";

/// A row of the picture.
struct Row<'c> {
    change: &'c Change,
    operation: String,
    backend: String,
    /// The ratio and both times.
    text: String,
}

/// Draws the changes of `ranked`, and after them the times of different work. Returns `None` if nothing
/// changed.
pub(crate) fn figure(
    ranked: &Ranked<'_>,
    both: [Compared<'_>; 2],
    command: &str,
) -> Option<Figure> {
    let all: Vec<&Change> = ranked.changed().collect();
    let shown = &all[..all.len().min(SHOWN)];
    let rows: Vec<Row<'_>> = shown.iter().map(|change| row(ranked, change)).collect();
    let first = shown.first().filter(|row| !row.other_checksum)?;
    let changed = all.iter().filter(|row| !row.other_checksum).count();
    let picture_label = format!(
        "{} beyond chance, the largest first: {}, {}",
        counted(changed, "change", "changes"),
        ranked.name(&first.measurement),
        times(ranked.value(first))
    );
    Some(Figure {
        id: "changes".into(),
        title: "Changes beyond chance, largest first".into(),
        caption: caption(ranked, &all, both),
        picture: Picture::single(&picture_label, scene(ranked, &rows)),
        table: ranked.times_table(all.iter().copied().take(TABLE_ROWS)),
        csv: rows::changes(shown.iter().copied()),
        source: String::new(),
        command: command.into(),
    })
}

fn caption(ranked: &Ranked<'_>, all: &[&Change], [before, after]: [Compared<'_>; 2]) -> String {
    let shown = &all[..all.len().min(SHOWN)];
    let relative = match ranked.changes.relative {
        true => format!(
            ", divided by the median of all ratios ({})",
            times(ranked.changes.divisor())
        ),
        false => String::new(),
    };
    let mut parts = vec![format!(
        "A dot is the time in {} divided by the time in {}{relative}, on a logarithmic axis. The grey band of a row is \
         its noise.",
        after.name, before.name
    )];
    let has_interval = |row: &&Change| ranked.interval(row).is_some();
    if shown.iter().any(has_interval) {
        parts.push(format!(
            "Lines are {} intervals.",
            ranked.changes.confidence
        ));
    }
    if !shown.iter().all(has_interval) {
        parts.push("An open ring has too few samples for an interval.".into());
    }
    if shown.iter().any(|row| row.other_checksum) {
        parts.push("A grey diamond is a time of different work (other checksum).".into());
    }
    let beyond = |row: &&Change| {
        let value = ranked.value(row);
        value.max(value.recip()) > FARTHEST
    };
    if shown.iter().any(beyond) {
        parts.push(format!(
            "Ratios beyond {} are at the ends.",
            times(FARTHEST)
        ));
    }
    let more = all.len().min(TABLE_ROWS) - shown.len();
    if more > 0 {
        parts.push(format!(
            "The picture has the first {} rows; {} more are in the table.",
            grouped(shown.len()),
            grouped(more)
        ));
    }
    if all.len() > TABLE_ROWS {
        parts.push(format!(
            "The JSON of the comparison has all {}.",
            grouped(all.len())
        ));
    }
    parts.join(" ")
}

fn row<'c>(ranked: &Ranked<'_>, change: &'c Change) -> Row<'c> {
    let ratio = times(ranked.value(change));
    let text = match change.other_checksum {
        true => format!("different work, {}", both_times(change)),
        false => format!("{ratio}, {}", both_times(change)),
    };
    Row {
        change,
        operation: cut(&ranked.operation(&change.measurement), LETTERS[0]),
        backend: cut(&change.measurement.backend, LETTERS[1]),
        text,
    }
}

/// Shortens a text to `most` letters.
pub(super) fn cut(text: &str, most: usize) -> String {
    match text.chars().count() > most {
        true => text.chars().take(most - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

/// Returns the width of the widest of `texts`.
pub(super) fn widest<'t>(texts: impl Iterator<Item = &'t str>) -> f64 {
    texts.map(|text| text_width(text, 12)).fold(0.0, f64::max)
}

fn scene(ranked: &Ranked<'_>, rows: &[Row<'_>]) -> Canvas {
    let names = widest(rows.iter().map(|row| &*row.operation));
    let backends = widest(rows.iter().map(|row| &*row.backend));
    let left = names + GAP + backends + GAP;
    let text_from = left + PLOT + GAP;
    let texts = rows.iter().map(|row| &*row.text);
    let width = text_from + widest(texts.chain([TEXTS]));
    let bottom = HEAD + ROW * rows.len() as f64;
    let mut canvas = Canvas::new(width, bottom + FOOT);
    let noise = ranked.changes.noise;
    let ends = rows.iter().flat_map(|row| {
        let ends = ranked.interval(row.change).into_iter().flatten();
        ends.chain([ranked.value(row.change), noise])
    });
    let scale = ratio_axis::scale(ends, [left, left + PLOT]);
    let [from, to] = [noise.recip(), noise].map(|end| scale.place(end));
    canvas.rect([from, HEAD], [to - from, bottom - HEAD], GRID_COLOUR);
    ratio_axis::draw(&mut canvas, scale, [HEAD, bottom]);
    let heading = Style::new(12).colour(FAINT_COLOUR);
    canvas.text([text_from, HEAD - 6.0], TEXTS, heading);
    for (number, row) in rows.iter().enumerate() {
        let y = HEAD + ROW * number as f64 + ROW / 2.0;
        let label = Style::new(12);
        canvas.text([names, y + 4.0], &row.operation, label.end());
        canvas.text([names + GAP, y + 4.0], &row.backend, label);
        mark(&mut canvas, ranked, row.change, scale, y);
        let style = match row.change.other_checksum {
            true => label.colour(FAINT_COLOUR),
            false => label,
        };
        canvas.text([text_from, y + 4.0], &row.text, style);
    }
    canvas
}

/// Draws the dot of a row with its interval.
fn mark(canvas: &mut Canvas, ranked: &Ranked<'_>, change: &Change, scale: LogScale, y: f64) {
    const RADIUS: f64 = 4.5;
    let x = scale.place(ranked.value(change));
    let colour = column_colour(&change.measurement.backend);
    let interval = ranked.interval(change);
    canvas.mark(ranked.mark_title(change), |canvas| {
        if let Some([low, high]) = interval {
            let [low, high] = [low, high].map(|end| scale.place(end));
            canvas.line([low, y], [high, y], INTERVAL_COLOUR, 1.5);
        }
        if change.other_checksum {
            let corners = [[x - 5.0, y], [x, y - 5.0], [x + 5.0, y], [x, y + 5.0]];
            canvas.filled(&corners, FAINT_COLOUR);
            return;
        }
        match interval {
            Some(_) => canvas.circle([x, y], RADIUS, colour),
            None => canvas.ring([x, y], RADIUS - 0.6, colour),
        }
    });
}

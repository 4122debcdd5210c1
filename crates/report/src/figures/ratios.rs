//! The figure of all ratios of a comparison: a line for each backend.

use sixfold_results::Change;
use sixfold_results::numbers::{counted, figure as shown, grouped, times};

use super::changes::{cut, widest};
use super::ratio_axis;
use crate::Picture;
use crate::axes::LogScale;
use crate::canvas::{Canvas, Style};
use crate::changes::{Compared, Ranked};
use crate::colours::{GRID_COLOUR, INTERVAL_COLOUR, column_colour};
use crate::data::rows;
use crate::figure::{Figure, Table};

/// Maximum number of single dots. Beyond it, only the quartiles are drawn.
const DOTS: usize = 800;
/// Height of the axis above the lines, of a line, and of the labels below.
const HEAD: f64 = 44.0;
const LINE: f64 = 46.0;
const FOOT: f64 = 20.0;
/// Width of the ratios, and space between columns.
const PLOT: f64 = 420.0;
const GAP: f64 = 10.0;
/// Radius of a dot, and places of dots above and below the middle of a line.
const RADIUS: f64 = 3.0;
const PLACES: [f64; 5] = [0.0, -6.5, 6.5, -13.0, 13.0];
/// Maximum number of letters of the name of a backend.
const LETTERS: usize = 24;

/// The ratios of one backend, in ascending order.
struct Line<'c> {
    backend: &'c str,
    rows: Vec<&'c Change>,
    values: Vec<f64>,
}

impl Line<'_> {
    fn quantile(&self, share: f64) -> f64 {
        let last = (self.values.len() - 1) as f64;
        self.values[(last * share).round() as usize]
    }
}

/// Draws the ratios of all times. Returns `None` if there are fewer than two.
pub(crate) fn figure(
    ranked: &Ranked<'_>,
    both: [Compared<'_>; 2],
    command: &str,
) -> Option<Figure> {
    let lines = lines(ranked);
    let count = lines.iter().map(|line| line.rows.len()).sum();
    if count < 2 {
        return None;
    }
    let has_dots = count <= DOTS;
    let mut table = Table::new([
        "backend",
        "times",
        "least",
        "a quarter below",
        "median",
        "a quarter above",
        "largest",
    ]);
    for line in &lines {
        let mut cells = vec![line.backend.to_owned(), grouped(line.rows.len())];
        cells.extend([0.0, 0.25, 0.5, 0.75, 1.0].map(|share| times(line.quantile(share))));
        table.row(cells);
    }
    let [before, after] = both;
    let dots = match has_dots {
        true => "A dot is one time",
        false => {
            "The thin line of a backend has all times, the thick line the middle half of them: a time"
        }
    };
    let relative = match ranked.changes.relative {
        true => ", divided by the median of all ratios",
        false => "",
    };
    let title = "All ratios by backend";
    Some(Figure {
        id: "ratios".into(),
        title: title.into(),
        caption: format!(
            "{dots}: the time in {} divided by the time in {}{relative}, on a logarithmic axis. Upright lines are medians. \
             Ratios in the grey band, up to {}, count as equal. Times of different work are left out.",
            after.name,
            before.name,
            times(ranked.changes.noise)
        ),
        picture: Picture::single(
            &format!("{title}: {}", counted(count, "ratio", "ratios")),
            scene(ranked, &lines, has_dots),
        ),
        table,
        csv: rows::changes(lines.iter().flat_map(|line| line.rows.iter().copied())),
        source: String::new(),
        command: command.into(),
    })
}

/// Returns the ratios of the same work for each backend, in the order of the comparison.
fn lines<'c>(ranked: &Ranked<'c>) -> Vec<Line<'c>> {
    let mut lines: Vec<Line<'c>> = Vec::new();
    let same_work = ranked.changes.rows.iter().filter(|row| !row.other_checksum);
    for row in same_work {
        let backend = &*row.measurement.backend;
        match lines.iter_mut().find(|line| line.backend == backend) {
            Some(line) => line.rows.push(row),
            None => lines.push(Line {
                backend,
                rows: vec![row],
                values: Vec::new(),
            }),
        }
    }
    for line in &mut lines {
        line.rows.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        line.values = line.rows.iter().map(|row| ranked.value(row)).collect();
    }
    lines
}

fn scene(ranked: &Ranked<'_>, lines: &[Line<'_>], has_dots: bool) -> Canvas {
    let backends: Vec<String> = lines
        .iter()
        .map(|line| cut(line.backend, LETTERS))
        .collect();
    let texts = lines.iter().map(|line| {
        let count = counted(line.rows.len(), "time", "times");
        format!("median {} × of {count}", shown(line.quantile(0.5)))
    });
    let texts: Vec<String> = texts.collect();
    let left = widest(backends.iter().map(String::as_str)) + GAP;
    let text_from = left + PLOT + GAP;
    let width = text_from + widest(texts.iter().map(String::as_str));
    let bottom = HEAD + LINE * lines.len() as f64;
    let mut canvas = Canvas::new(width, bottom + FOOT);
    let noise = ranked.changes.noise;
    let values = lines.iter().flat_map(|line| line.values.iter().copied());
    let scale = ratio_axis::scale(values.chain([noise]), [left, left + PLOT]);
    let [from, to] = [noise.recip(), noise].map(|end| scale.place(end));
    canvas.rect([from, HEAD], [to - from, bottom - HEAD], GRID_COLOUR);
    ratio_axis::draw(&mut canvas, scale, [HEAD, bottom]);
    for (number, line) in lines.iter().enumerate() {
        let y = HEAD + LINE * (number as f64 + 0.5);
        let label = Style::new(12);
        canvas.text([left - GAP, y + 4.0], &backends[number], label.end());
        canvas.text([text_from, y + 4.0], &texts[number], label);
        // The dots cover the line of the median.
        let x = scale.place(line.quantile(0.5));
        canvas.line(
            [x, y - LINE * 0.42],
            [x, y + LINE * 0.42],
            INTERVAL_COLOUR,
            2.0,
        );
        match has_dots {
            true => draw_dots(&mut canvas, ranked, line, scale, y),
            false => draw_quartiles(&mut canvas, line, scale, y),
        }
    }
    canvas
}

/// Draws a dot for each time. Dots that would cover one another move up or down, if there is space.
fn draw_dots(canvas: &mut Canvas, ranked: &Ranked<'_>, line: &Line<'_>, scale: LogScale, y: f64) {
    let colour = column_colour(line.backend);
    let mut last = [f64::NEG_INFINITY; PLACES.len()];
    for (row, value) in line.rows.iter().zip(&line.values) {
        let x = scale.place(*value);
        let free = last.iter().position(|last| x - last >= 2.0 * RADIUS);
        let place = free.unwrap_or_else(|| {
            let places = last.iter().enumerate();
            places
                .min_by(|a, b| a.1.total_cmp(b.1))
                .map_or(0, |(place, _)| place)
        });
        last[place] = x;
        let at = [x, y + PLACES[place]];
        canvas.mark(ranked.mark_title(row), |canvas| {
            canvas.circle(at, RADIUS, colour)
        });
    }
}

fn draw_quartiles(canvas: &mut Canvas, line: &Line<'_>, scale: LogScale, y: f64) {
    let colour = column_colour(line.backend);
    let ends = [0.0, 0.25, 0.75, 1.0].map(|share| scale.place(line.quantile(share)));
    let title = format!(
        "{}: half of {} between {} and {}",
        line.backend,
        counted(line.rows.len(), "time", "times"),
        times(line.quantile(0.25)),
        times(line.quantile(0.75))
    );
    canvas.mark(title, |canvas| {
        canvas.line([ends[0], y], [ends[3], y], colour, 2.0);
        canvas.rect(
            [ends[1], y - 8.0],
            [(ends[2] - ends[1]).max(1.0), 16.0],
            colour,
        );
    });
}

//! The heat map: all structures and operations in one figure, with their ratios.

use sixfold_results::Standing;
use sixfold_results::numbers::times;

use super::changes::cut;
use crate::Picture;
use crate::canvas::{Canvas, Style, text_width};
use crate::colours::{FAINT_COLOUR, GRID_COLOUR};
use crate::figure::Figure;
use crate::matrix::{Cell, Matrix, Source};

/// Maximum ratio with its own colour. Larger ratios have the colour of this ratio.
const MAX_RATIO: f64 = 1000.0;
/// Width of the names, width of a column, height of the head and of a row.
const NAMES: f64 = 170.0;
const COLUMN: f64 = 108.0;
const HEAD: f64 = 26.0;
/// With more columns, they are narrower.
const MOST_WIDE_COLUMNS: usize = 6;
const NARROW_COLUMN: f64 = 80.0;
const LINE: f64 = 14.0;
const ROW: f64 = 21.0;
/// The text on dark cells and on light cells, in both modes of the page.
const ON_DARK: &str = "#ffffff";
const ON_LIGHT: &str = "#000000";

/// The colours of the ratios from 1 to [`MAX_RATIO`], ten for each factor of 10: the colour map viridis of van der
/// Walt and Smith (2015).
const VIRIDIS: [&str; 31] = [
    "#440154", "#470d60", "#481a6c", "#482576", "#472f7d", "#443983", "#414487", "#3d4e8a",
    "#39568c", "#355f8d", "#31688e", "#2d718e", "#2a788e", "#27808e", "#23888e", "#21918c",
    "#1f988b", "#1fa088", "#22a884", "#2ab07f", "#35b779", "#42be71", "#54c568", "#67cc5c",
    "#7ad151", "#8ed645", "#a5db36", "#bddf26", "#d2e21b", "#e7e419", "#fde725",
];

/// The first colour on which black letters have more contrast than white ones. Every colour has a contrast of at least
/// 4.5 with the better one.
const FIRST_LIGHT: usize = 14;

/// Draws `matrix`. The figure has no picture without operations.
pub(super) fn figure(
    title: String,
    matrix: &Matrix,
    id_prefix: &str,
    command: &str,
) -> Option<Figure> {
    if matrix.lines.is_empty() {
        return None;
    }
    let column_width = match matrix.backends.len() <= MOST_WIDE_COLUMNS {
        true => COLUMN,
        false => NARROW_COLUMN,
    };
    let letters = (column_width / text_width("n", 12)) as usize;
    let names = matrix.backends.iter().map(|name| lines_of(name, letters));
    let names: Vec<Vec<String>> = names.collect();
    let most_lines = names.iter().map(Vec::len).max().unwrap_or(1);
    let head = HEAD + LINE * (most_lines - 1) as f64;
    let width = NAMES + column_width * matrix.backends.len() as f64;
    let mut canvas = Canvas::new(width, head + ROW * matrix.lines.len() as f64 + 4.0);
    for (column, name) in names.iter().enumerate() {
        let x = NAMES + column_width * (column as f64 + 0.5);
        for (above, text) in name.iter().rev().enumerate() {
            let y = head - 8.0 - LINE * above as f64;
            canvas.text([x, y], text, Style::new(12).middle());
        }
    }
    for (number, line) in matrix.lines.iter().enumerate() {
        let y = head + ROW * number as f64;
        canvas.text([NAMES - 8.0, y + 15.0], &line.name, Style::new(12).end());
        for (column, cell) in line.cells.iter().enumerate() {
            let x = NAMES + column_width * column as f64;
            draw_cell(&mut canvas, [x, y], column_width, cell, &line.name);
        }
    }
    Some(Figure {
        id: format!("{id_prefix}heat-map"),
        picture: Picture::single(&title, canvas),
        title,
        caption: caption(matrix),
        table: matrix.ratios(),
        csv: String::new(),
        source: String::new(),
        command: command.into(),
    })
}

/// Divides a name after its hyphens and spaces into lines of at most `letters`. Longer parts are cut.
fn lines_of(name: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in name.split_inclusive(['-', ' ', '_']) {
        let length = |text: &str| text.trim_end().chars().count();
        match lines.last_mut() {
            Some(line) if length(line) + length(part) <= letters => *line += part,
            _ => lines.push(part.to_owned()),
        }
    }
    let lines = lines.iter().map(|line| cut(line.trim_end(), letters));
    lines.collect()
}

/// Explains the cells that the figure has.
fn caption(matrix: &Matrix) -> String {
    let has = |test: &dyn Fn(&Cell) -> bool| {
        let mut cells = matrix.lines.iter().flat_map(|line| &line.cells);
        cells.any(test)
    };
    let means = has(&|cell| !cell.each.is_empty());
    let parts = [
        (true, match means {
            true => "The geometric mean over the meshes of the time, divided by that of the structure that is the fastest on average. Dark is fast.",
            false => "Time divided by that of the fastest structure of the row. Dark is fast.",
        }.to_owned()),
        (
            has(&|cell| cell.is_best() || cell.shares_first()),
            "The fastest, and those that share the first place, are bold.".into(),
        ),
        (
            has(&|cell| cell.standing == Some(Standing::Undecided)),
            "Hatched at the edges: perhaps the fastest, undecided.".into(),
        ),
        (
            has(&|cell| cell.ratio > Some(MAX_RATIO) && !cell.is_bound()),
            format!("All ratios of {} or more have one colour.", times(MAX_RATIO)),
        ),
        (
            has(&|cell| cell.source == Source::Sampled),
            "~: measured on some of the elements.".into(),
        ),
        (
            has(&|cell| cell.is_bound()),
            "≥ in a frame: a lower bound, because a run would exceed the budget.".into(),
        ),
        (
            has(&|cell| cell.ratio.is_none()),
            "– in a frame: not run, or not possible.".into(),
        ),
    ];
    let parts = parts
        .into_iter()
        .filter_map(|(has, text)| has.then_some(text));
    parts.collect::<Vec<_>>().join(" ")
}

/// Draws diagonal lines at both ends of a cell.
fn hatch(canvas: &mut Canvas, [x, y]: [f64; 2], [width, height]: [f64; 2], ink: &'static str) {
    const WIDTH: f64 = 9.0;
    const APART: f64 = 4.5;
    let count = ((WIDTH + height) / APART).ceil() as usize;
    let lines = [x, x + width - WIDTH].into_iter().flat_map(|left| {
        (1..count).map(move |number| {
            let across = APART * number as f64;
            // From the upper or right side to the left or lower side.
            let from = [left + across.min(WIDTH), y + (across - WIDTH).max(0.0)];
            let to = [left + (across - height).max(0.0), y + across.min(height)];
            [from, to]
        })
    });
    canvas.lines(lines, ink, 0.8);
}

fn draw_cell(canvas: &mut Canvas, [x, y]: [f64; 2], width: f64, cell: &Cell, operation: &str) {
    let (corner, size) = ([x + 1.0, y + 1.0], [width - 2.0, ROW - 2.0]);
    let text = cell.times_text();
    let measured = cell.ratio.filter(|_| !cell.is_bound());
    let what = match (cell.ratio, cell.source) {
        (Some(_), _) => text.clone(),
        (None, Source::Impossible) => "not possible".into(),
        (None, _) => "not measured".into(),
    };
    let lead = cell.is_best() || cell.shares_first();
    let label = Style::new(12).middle().bold(lead);
    let centre = [x + width / 2.0, y + 15.0];
    canvas.mark(
        format!("{operation} on {}: {what}", cell.backend),
        |canvas| {
            match measured {
                Some(ratio) => {
                    // The colour of a lower bound would rank it.
                    let share = ratio.clamp(1.0, MAX_RATIO).log10() / MAX_RATIO.log10();
                    let place = (share * (VIRIDIS.len() - 1) as f64).round() as usize;
                    canvas.rect(corner, size, VIRIDIS[place]);
                    let ink = if place < FIRST_LIGHT {
                        ON_DARK
                    } else {
                        ON_LIGHT
                    };
                    if cell.standing == Some(Standing::Undecided) {
                        hatch(canvas, corner, size, ink);
                    }
                    canvas.text(centre, &text, label.colour(ink));
                }
                None => {
                    canvas.frame(corner, size, GRID_COLOUR);
                    canvas.text(centre, &text, label.colour(FAINT_COLOUR));
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colours::contrast;

    #[test]
    fn names_are_divided_and_only_long_parts_are_cut() {
        assert_eq!(lines_of("half-edge", 16), ["half-edge"]);
        assert_eq!(lines_of("indexed-face-set", 16), ["indexed-face-set"]);
        assert_eq!(lines_of("indexed-face-set", 11), ["indexed-", "face-set"]);
        assert_eq!(
            lines_of("CGAL Surface_mesh", 11),
            ["CGAL", "Surface_", "mesh"]
        );
        assert_eq!(lines_of("日本語日本語", 4), ["日本語…"]);
        assert_eq!(lines_of("", 4), [""; 0]);
    }

    #[test]
    fn numbers_are_read_on_every_colour() {
        for (place, colour) in VIRIDIS.into_iter().enumerate() {
            let ink = if place < FIRST_LIGHT {
                ON_DARK
            } else {
                ON_LIGHT
            };
            assert!(contrast(ink, colour) >= 4.5, "{ink} on {colour}");
        }
    }
}

//! A figure with one stacked bar for each structure. The parts of a bar are the bytes of the tables
//! of the structure.

use sixfold_results::numbers::{bytes, figure as shown, grouped};
use sixfold_results::{BackendReport, Report};

use crate::Picture;
use crate::canvas::{Canvas, Style, text_width};
use crate::colours::{BACKGROUND, FAINT_COLOUR, table_colour};
use crate::data::rows as data;
use crate::figure::{Figure, Table};

/// Name of the table of positions. A structure with points instead of vertices has no such table.
const POSITIONS: &str = "positions";
/// Width of the figure, of the names, and of the longest bar.
const WIDTH: f64 = 760.0;
const NAMES: f64 = 130.0;
const LONGEST: f64 = 500.0;
/// Height of a bar, and of a bar with its formula.
const BAR: f64 = 20.0;
const ROW: f64 = 46.0;

/// One table of a structure.
struct Part {
    name: String,
    rows: usize,
    bytes: usize,
}

pub(super) fn from_study(study: &Report, id_prefix: &str, command: &str) -> Option<Figure> {
    let columns = study.backends.iter();
    let columns: Vec<&BackendReport> = columns.filter(|c| !c.tables.is_empty()).collect();
    let vertices = study.mesh.facts.vertices;
    let most = columns.iter().map(|column| total(column)).max()?;
    if vertices == 0 || most == 0 {
        return None;
    }
    let mut table = Table::new(["", "table", "rows", "bytes", "bytes per vertex"]);
    let mut canvas = Canvas::new(WIDTH, ROW * columns.len() as f64);
    for (number, column) in columns.iter().enumerate() {
        let (y, parts) = (ROW * number as f64, parts(column));
        for part in &parts {
            let [rows, bytes] = [part.rows, part.bytes].map(grouped);
            let each = shown(part.bytes as f64 / vertices as f64);
            table.row(vec![
                column.name.clone(),
                part.name.clone(),
                rows,
                bytes,
                each,
            ]);
        }
        let scale = LONGEST / most as f64;
        let name = Style::new(12).bold(true).end();
        canvas.text([NAMES - 10.0, y + 15.0], &column.name, name);
        let end = draw_parts(&mut canvas, &column.name, &parts, [y, scale], vertices);
        let all = total(column);
        let each = shown(all as f64 / vertices as f64);
        let text = format!("{each} ({})", bytes(all));
        canvas.text([end + 8.0, y + 15.0], &text, Style::new(12).bold(true));
        let small = Style::new(11).colour(FAINT_COLOUR);
        canvas.text([NAMES, y + BAR + 12.0], &formula(&parts), small);
    }
    let title = format!("Bytes per vertex: {}", super::file_name(&study.mesh.name));
    Some(Figure {
        id: format!("{id_prefix}memory"),
        picture: Picture::single(&title, canvas),
        title,
        caption: format!(
            "Bytes held, including spare capacity; the number at the end of a bar is for each of the {} \
             vertices. Positions come first, in one colour for all structures. Under each bar is its formula: \
             rows × bytes of a row.",
            grouped(vertices)
        ),
        table,
        csv: data::memory(study),
        source: String::new(),
        command: command.into(),
    })
}

fn total(column: &BackendReport) -> usize {
    column.tables.iter().map(|table| table.bytes).sum()
}

/// Returns the tables of a structure. Positions come first.
fn parts(column: &BackendReport) -> Vec<Part> {
    let mut tables: Vec<_> = column.tables.iter().collect();
    tables.sort_by_key(|part| part.table != POSITIONS);
    let parts = tables.into_iter().map(|table| Part {
        name: table.table.to_string(),
        rows: table.rows,
        bytes: table.bytes,
    });
    parts.collect()
}

/// Draws the parts of a bar, those that touch in colours that follow one another, and positions in the same colour for all
/// structures. `y` is the upper end of the bar, and `scale` the pixels of a byte.
/// Returns the end of the bar.
fn draw_parts(
    canvas: &mut Canvas,
    structure: &str,
    parts: &[Part],
    [y, scale]: [f64; 2],
    vertices: usize,
) -> f64 {
    let mut x = NAMES;
    let first = usize::from(parts.first().is_none_or(|part| part.name != POSITIONS));
    let drawn = parts.iter().filter(|part| part.bytes > 0);
    for (part, number) in drawn.zip(first..) {
        let width = part.bytes as f64 * scale;
        let each = part.bytes as f64 / vertices as f64;
        let title = format!("{structure}, {}: {each:.1} bytes per vertex", part.name);
        canvas.mark(title, |canvas| {
            canvas.rect([x, y], [width, BAR], table_colour(number))
        });
        if text_width(&part.name, 11) + 8.0 < width {
            let inside = Style::new(11).colour(BACKGROUND);
            canvas.text([x + 5.0, y + 14.0], &part.name, inside);
        }
        x += width;
        canvas.line([x, y], [x, y + BAR], BACKGROUND, 1.0);
    }
    x
}

/// Returns the bytes as a sum of rows × bytes of a row.
fn formula(parts: &[Part]) -> String {
    let parts = parts.iter().filter(|part| part.bytes > 0);
    let terms = parts.map(|part| match part.bytes.checked_rem(part.rows) {
        Some(0) => format!(
            "{} {} × {}",
            part.name,
            grouped(part.rows),
            part.bytes / part.rows
        ),
        // With spare capacity.
        _ => format!("{} {}", part.name, grouped(part.bytes)),
    });
    terms.collect::<Vec<_>>().join(" + ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Paint, Shape};
    use crate::colours::contrast;

    #[test]
    fn parts_that_touch_differ_in_grey() {
        let part = |name: &str, bytes| Part {
            name: name.into(),
            rows: 1,
            bytes,
        };
        // Positions have the first colour; a bar without them begins with the second.
        for first in [POSITIONS, "corners"] {
            let parts = [part(first, 1), part("a", 1), part("empty", 0), part("b", 1)];
            let mut canvas = Canvas::new(WIDTH, ROW);
            draw_parts(&mut canvas, "soup", &parts, [0.0, 9.0], 1);
            let marks = canvas.shapes.iter().filter_map(|shape| match shape {
                Shape::Mark { shapes, .. } => shapes.first(),
                _ => None,
            });
            let colours: Vec<&str> = marks
                .map(|shape| match shape {
                    Shape::Rect {
                        paint: Paint::Fill(colour),
                        ..
                    } => *colour,
                    other => panic!("{other:?}"),
                })
                .collect();
            assert_eq!(colours.len(), 3);
            assert_eq!(colours[0] == table_colour(0), first == POSITIONS);
            for pair in colours.windows(2) {
                assert!(contrast(pair[0], pair[1]) >= 1.25, "{colours:?}");
            }
        }
    }
}

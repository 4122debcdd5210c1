//! The figure of a history: how the ratio of each time to that in the first document went, with a panel for each
//! operation.

use sixfold_results::numbers::{counted, figure as shown, grouped, times};
use sixfold_results::{HistoryGroup, HistoryPoint, HistoryRow, Measurement};

use super::changes::cut;
use super::{file_name, ratio_axis};
use crate::Picture;
use crate::axes::{ACROSS, Axes, COLUMNS, Curve, CurvePoint, LogScale, SIZE, UPWARDS};
use crate::canvas::{Canvas, Style};
use crate::changes::verdict_text;
use crate::colours::{INTERVAL_COLOUR, column_colour, column_shape};
use crate::data::into_text;
use crate::figure::Figure;
use crate::history::table;

/// Maximum number of panels, and of documents in the picture: the last ones.
const PANELS: usize = 24;
const DOCUMENTS: usize = 200;
/// The axes reach at least to this ratio, so that noise does not fill a panel.
const LEAST_RATIO: f64 = 2.0;
/// Maximum number of letters of the title of a panel.
const LETTERS: usize = 42;

/// Draws the panels with the largest changes first. Returns `None` without rows.
pub(crate) fn figure(group: &HistoryGroup, id: &str, command: &str) -> Option<Figure> {
    let mut panels: Vec<(String, Vec<&HistoryRow>)> = Vec::new();
    for row in &group.rows {
        let title = title(&row.measurement);
        match panels.iter_mut().find(|(known, _)| *known == title) {
            Some((_, rows)) => rows.push(row),
            None => panels.push((title, vec![row])),
        }
    }
    let size = |rows: &[&HistoryRow]| {
        let changed = rows.iter().filter(|row| row.is_changed());
        changed.map(|row| row.largest_change()).fold(1.0, f64::max)
    };
    panels.sort_by(|(_, a), (_, b)| size(b).total_cmp(&size(a)));
    let all = panels.len();
    panels.truncate(PANELS);
    let hidden = group.documents.len().saturating_sub(DOCUMENTS);
    let ratios = panels.iter().flat_map(|(_, rows)| rows).flat_map(|row| {
        let points = row.points.iter().filter(|point| point.document > hidden);
        points.flat_map(|point| [Some(point.ratio), point.ci_low, point.ci_high])
    });
    let ratios = ratios.flatten().chain([LEAST_RATIO]);
    let axes = Axes {
        x: LogScale {
            // Half a step before the first document, and after the last one.
            values: [hidden as f64 + 0.49, group.documents.len() as f64 + 0.51].map(place),
            pixels: ACROSS,
        },
        y: ratio_axis::scale(ratios, UPWARDS),
        x_label: "document",
        y_label: "time ÷ time in the first document",
        x_format: &|place| (place.log10().round() + 1.0).to_string(),
        y_format: &|ratio| ratio.to_string(),
    };
    let drawn = panels
        .iter()
        .map(|(title, rows)| panel(group, title, rows, hidden, &axes));
    let drawn: Vec<Canvas> = drawn.collect();
    let title = "Times over the documents".to_owned();
    let more = match all - panels.len() {
        0 => String::new(),
        more => format!(" {} more operations are in the table.", grouped(more)),
    };
    let left_out = match hidden {
        0 => String::new(),
        hidden => format!(
            " The first {} are not drawn.",
            counted(hidden, "document", "documents")
        ),
    };
    let mut csv = Vec::new();
    group.write_csv(&mut csv).expect("memory can be written");
    (!drawn.is_empty()).then(|| Figure {
        id: id.into(),
        picture: Picture::grid(&title, COLUMNS, drawn),
        title,
        caption: format!(
            "Each dot is the time in a document divided by that in the first one, on a logarithmic axis; the numbers of \
             the documents are those of the table of documents. Upright lines are {} intervals. The number at each name is \
             the last ratio. Operations with the largest changes beyond chance come first.{more}{left_out}",
            group.confidence
        ),
        table: table(group),
        csv: into_text(csv),
        source: String::new(),
        command: command.into(),
    })
}

/// Returns the place of a document on a logarithmic axis on which documents have equal distances.
fn place(document: f64) -> f64 {
    10_f64.powf(document - 1.0)
}

/// Returns the operation and the place, such as `build, bunny.obj`.
fn title(measurement: &Measurement) -> String {
    let Measurement {
        mesh,
        kind,
        case,
        operation,
        ..
    } = measurement;
    let kind = if *kind == "study" { "" } else { kind };
    let parts = [operation, file_name(mesh), kind, case].into_iter();
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    cut(&parts.join(", "), LETTERS)
}

fn panel(
    group: &HistoryGroup,
    title: &str,
    rows: &[&HistoryRow],
    hidden: usize,
    axes: &Axes<'_>,
) -> Canvas {
    let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
    canvas.text([0.0, 14.0], title, Style::new(14).bold(true));
    axes.draw(&mut canvas);
    let points = |row: &'_ HistoryRow| -> Vec<HistoryPoint> {
        let points = row.points.iter().copied();
        points.filter(|point| point.document > hidden).collect()
    };
    for point in rows.iter().flat_map(|row| points(row)) {
        if let Some((low, high)) = point.ci_low.zip(point.ci_high) {
            let x = place(point.document as f64);
            let [from, to] = [low, high].map(|ratio| axes.place([x, ratio]));
            canvas.line(from, to, INTERVAL_COLOUR, 0.7);
        }
    }
    let curves = rows.iter().map(|row| {
        let backend = &row.measurement.backend;
        let marks = points(row).into_iter().map(|point| {
            let document = &group.documents[point.document - 1].name;
            CurvePoint {
                at: [place(point.document as f64), point.ratio],
                title: format!(
                    "{backend}, {document}: {}, {}",
                    times(point.ratio),
                    verdict_text(point.verdict, point.other_checksum)
                ),
                is_sampled: false,
            }
        });
        Curve {
            name: match row.last() {
                Some(last) => format!("{backend}: {}", shown(last.ratio)),
                None => backend.clone(),
            },
            colour: column_colour(backend),
            shape: column_shape(backend),
            points: marks.collect(),
        }
    });
    axes.draw_curves(&mut canvas, curves.collect());
    canvas
}

//! Rankings: a panel for each operation, with the time of each structure or external program relative
//! to the fastest. All panels have one scale.

use sixfold_results::numbers::{duration, grouped, shown_ratio, times};
use sixfold_results::{
    Confidence, EQUAL_UP_TO, FEWEST_MESHES, NeighboursReport, PickReport, Ranked, SpatialTask,
    Standing,
};

use super::per_unit;
use crate::Picture;
use crate::axes::{LogScale, scatter};
use crate::canvas::{Canvas, Style, text_width};
use crate::colours::{BACKGROUND, FAINT_COLOUR, INTERVAL_COLOUR, TEXT_COLOUR, column_colour};
use crate::data::rows;
use crate::figure::{Figure, Table};
use crate::matrix::{Cell, Matrix, Source};

/// Longest ratio that is drawn to scale: of a bar, and of a mean over meshes with its dots.
const LONGEST: f64 = 10.0;
const LONGEST_MEAN: f64 = 1000.0;
/// Shortest ratio of a mesh that is drawn to scale.
const SHORTEST_MEAN: f64 = 0.1;
/// Height of a bar.
const HEIGHT: f64 = 13.0;
/// Width and height of a panel without its bars, and height of a bar with its gap.
const WIDTH: f64 = 352.0;
const HEAD: f64 = 42.0;
const ROW: f64 = 21.0;
/// Height of the labels of the scale.
const FOOT: f64 = 14.0;
/// Places of the bars.
const BARS: [f64; 2] = [124.0, 256.0];
/// Dots are moved up and down by at most this, so that they do not hide each other.
const SCATTER: f64 = 9.0;

/// Draws all operations of a study or of a pool. `note` says what the ratios are.
pub(super) fn from_matrix(matrix: &Matrix, note: &str, command: &str) -> Option<Figure> {
    let panels = matrix.lines.iter().map(|line| Panel {
        title: &line.name,
        unit: &line.unit,
        cells: line.cells.clone(),
    });
    figure(
        "Rankings of all operations".into(),
        "rankings".into(),
        &panels.collect::<Vec<_>>(),
        note,
        matrix.confidence,
        command,
    )
}

pub(super) fn from_workload(report: &PickReport, id: &str, command: &str) -> Option<Figure> {
    let equal = |ranked: &Ranked| match ranked.ci_high {
        Some(most) if most <= EQUAL_UP_TO => Standing::Equal,
        _ => Standing::Undecided,
    };
    // The fastest is tied with itself.
    let others = report
        .ranking
        .iter()
        .filter(|row| row.tied_with_best && row.ratio_to_best != 1.0);
    let others: Vec<Standing> = others.map(equal).collect();
    let of_first = match others.contains(&Standing::Undecided) {
        true => Standing::Undecided,
        false => others.first().copied().unwrap_or(Standing::Best),
    };
    let cells = report.ranking.iter().map(|ranked| Cell {
        ratio: Some(ranked.ratio_to_best),
        interval: ranked
            .ci_low
            .zip(ranked.ci_high)
            .map(|(low, high)| [low, high]),
        ns: Some(ranked.ns_per_operation),
        standing: match (ranked.ratio_to_best, ranked.tied_with_best) {
            _ if ranked.estimated || report.preliminary => None,
            (1.0, _) => Some(of_first),
            (_, true) => Some(equal(ranked)),
            _ => Some(Standing::Slower),
        },
        ..Cell::new(
            &ranked.backend,
            match (ranked.estimated, ranked.sampled) {
                (true, _) => Source::Bound,
                (false, true) => Source::Sampled,
                (false, false) => Source::Measured,
            },
        )
    });
    let name = &report.workload.name;
    let panel = Panel {
        title: name,
        unit: "operation",
        cells: with_shown_ratios(cells.collect()),
    };
    let title = format!("Ranking for {name}");
    let confidence = report.run.settings.confidence;
    let figure = figure(title, id.into(), &[panel], "", confidence, command)?;
    Some(figure.with_csv(rows::pick(report)))
}

pub(super) fn from_neighbours(
    report: &NeighboursReport,
    id: &str,
    command: &str,
) -> Option<Figure> {
    let panels = SpatialTask::ALL.into_iter().filter_map(|task| {
        let cells = report.rows(task.name()).map(|row| Cell {
            ratio: row.ratio_to_best,
            interval: row
                .ratio_ci_low
                .zip(row.ratio_ci_high)
                .map(|(low, high)| [low, high]),
            ns: row.ns_per_element,
            standing: row.standing,
            ..Cell::new(
                &row.backend,
                match row.sample_size {
                    Some(_) => Source::Sampled,
                    None => Source::Measured,
                },
            )
        });
        let cells: Vec<Cell> = cells.filter(|cell| cell.ratio.is_some()).collect();
        (!cells.is_empty()).then(|| Panel {
            title: task.name(),
            unit: task.unit(),
            cells: with_shown_ratios(cells),
        })
    });
    let panels: Vec<Panel<'_>> = panels.collect();
    let title = "Rankings of all tasks".into();
    let confidence = report.run.settings.confidence;
    let figure = figure(title, id.into(), &panels, "", confidence, command)?;
    Some(figure.with_csv(rows::neighbours(report)))
}

/// Replaces the ratios by the quotients of the shown times, so that a reader who divides two times
/// gets the ratio.
fn with_shown_ratios(mut cells: Vec<Cell>) -> Vec<Cell> {
    let best = cells
        .iter()
        .find(|cell| cell.ratio == Some(1.0) && !cell.is_bound());
    if let Some(best) = best.and_then(|best| best.ns) {
        for cell in &mut cells {
            cell.ratio = cell.ns.map(|ns| shown_ratio(ns, best)).or(cell.ratio);
        }
    }
    cells
}

struct Panel<'a> {
    title: &'a str,
    unit: &'a str,
    cells: Vec<Cell>,
}

fn figure(
    title: String,
    id: String,
    panels: &[Panel<'_>],
    note: &str,
    confidence: Confidence,
    command: &str,
) -> Option<Figure> {
    let cells = panels.iter().flat_map(|panel| &panel.cells);
    let meshes = cells.map(|cell| cell.each.len()).max().unwrap_or(0);
    let interval = match meshes > 0 && meshes < FEWEST_MESHES {
        true => "least to largest".into(),
        false => confidence.to_string(),
    };
    let mut table = Table::new([
        "",
        "structure",
        "× the fastest",
        &*interval,
        "time",
        "per",
        "remark",
    ]);
    let mut scenes = Vec::new();
    let most = panels.iter().map(|panel| panel.cells.len()).max()?;
    // One scale for all panels. It reaches at least ratio 2, so that noise does not fill a panel.
    let ratios = panels.iter().flat_map(|panel| &panel.cells);
    let longest = ratios.filter_map(|cell| cell.ratio).fold(2.0, f64::max);
    let most_drawn = reach(panels.iter().flat_map(|panel| &panel.cells));
    // On a mesh, another one may be faster than the fastest on average.
    let each = panels
        .iter()
        .flat_map(|panel| &panel.cells)
        .flat_map(|cell| &cell.each);
    let shortest = each.copied().fold(1.0, f64::min);
    let scale = LogScale {
        values: [shortest.max(SHORTEST_MEAN), longest.min(most_drawn)],
        pixels: BARS,
    };
    for panel in panels {
        let mut cells: Vec<&Cell> = panel.cells.iter().collect();
        let rank = |cell: &Cell| (cell.ratio.is_none(), cell.is_bound());
        let ratio = |cell: &Cell| cell.ratio.unwrap_or(f64::INFINITY);
        cells.sort_by(|a, b| rank(a).cmp(&rank(b)).then(ratio(a).total_cmp(&ratio(b))));
        for cell in cells.iter().filter(|cell| cell.ratio.is_some()) {
            table.row(row(panel, cell));
        }
        scenes.push(scene(panel, &cells, scale, most));
    }
    if table.rows.len() < 2 {
        return None;
    }
    let columns = scenes.len().min(3);
    let cells: Vec<&Cell> = panels.iter().flat_map(|panel| &panel.cells).collect();
    let caption = caption(&cells, note, confidence);
    Some(Figure {
        id,
        picture: Picture::grid(&title, columns, scenes),
        title,
        caption,
        table,
        csv: String::new(),
        source: String::new(),
        command: command.into(),
    })
}

/// Formats a value of the scale: `1`, `1.5`, `20`.
fn tick_text(tick: f64) -> String {
    match tick.fract() == 0.0 {
        true => grouped(tick as usize),
        false => tick.to_string(),
    }
}

/// Returns the longest ratio that is drawn to scale.
fn reach<'c>(mut cells: impl Iterator<Item = &'c Cell>) -> f64 {
    match cells.any(|cell| !cell.each.is_empty()) {
        true => LONGEST_MEAN,
        false => LONGEST,
    }
}

/// Explains the marks that the figure has.
fn caption(cells: &[&Cell], note: &str, confidence: Confidence) -> String {
    let reach = reach(cells.iter().copied());
    let beyond = cells.iter().any(|cell| cell.ratio > Some(reach));
    let has = |test: fn(&Cell) -> bool| cells.iter().any(|cell| cell.ratio.is_some() && test(cell));
    let means = has(|cell| !cell.each.is_empty());
    let mark = match means {
        true => {
            "The upright line is the mean time divided by that of the fastest on average, on a logarithmic scale"
        }
        false => "A bar is the time divided by that of the fastest, on a logarithmic scale from 1",
    };
    let parts = [
        (true, format!("{mark}, which is the same in all panels: longer is slower.")),
        (!note.is_empty(), note.to_owned()),
        (means, "Each dot is one mesh.".into()),
        (
            beyond && means,
            format!("Marks at the end of the scale are beyond {}.", times(reach)),
        ),
        (
            beyond && !means,
            format!("A bar with a gap is longer than {}.", times(reach)),
        ),
        (has(has_line), format!("Thin lines are {confidence} intervals.")),
        (has(|cell| cell.is_best() || cell.shares_first()), "The fastest, and those that share the first place, are bold.".into()),
        (
            has(|cell| cell.standing == Some(Standing::Equal)),
            "=: equal to the fastest within 5 %.".into(),
        ),
        (
            has(|cell| cell.standing == Some(Standing::Undecided)),
            "?: undecided, perhaps the fastest.".into(),
        ),
        (
            has(|cell| cell.source == Source::Sampled),
            "~: measured on some of the elements.".into(),
        ),
        (
            has(Cell::is_bound),
            "≥ with an empty bar: a lower bound, which is not ranked, because a run would exceed the budget.".into(),
        ),
    ];
    let parts = parts
        .into_iter()
        .filter_map(|(has, text)| has.then_some(text));
    parts.collect::<Vec<_>>().join(" ")
}

fn row(panel: &Panel<'_>, cell: &Cell) -> Vec<String> {
    let first = cell
        .first_ns
        .map(|ns| format!("first run {}", duration(ns)));
    let notes = [Some(cell.note()).filter(|note| !note.is_empty()), first];
    let notes: Vec<String> = notes.into_iter().flatten().collect();
    vec![
        panel.title.to_owned(),
        cell.backend.clone(),
        cell.ratio_text(),
        cell.interval_text().unwrap_or_else(|| "–".into()),
        cell.time_text(),
        panel.unit.to_owned(),
        notes.join("; "),
    ]
}

/// Draws the bars of one operation. All panels of a figure are as tall as if they had `rows` bars.
fn scene(panel: &Panel<'_>, cells: &[&Cell], scale: LogScale, rows: usize) -> Canvas {
    let mut canvas = Canvas::new(WIDTH, HEAD + ROW * rows as f64 + FOOT);
    canvas.text([0.0, 14.0], panel.title, Style::new(14).bold(true));
    let best = cells.first().filter(|cell| cell.ratio.is_some());
    let best = best.map_or(String::new(), |best| {
        let what = if best.each.is_empty() {
            "fastest"
        } else {
            "fastest on average"
        };
        format!("{what}: {} {}", best.time_text(), per_unit(panel.unit))
    });
    let faint = Style::new(12).colour(FAINT_COLOUR);
    canvas.text([0.0, 31.0], &best, faint);
    let bottom = HEAD + ROW * cells.len() as f64 - 4.0;
    let label = |tick: f64| format!("{} ×", tick_text(tick));
    let ends = [HEAD - 4.0, bottom];
    scale.draw_ticks(&mut canvas, ends, bottom + 13.0, FAINT_COLOUR, &label);
    for (number, cell) in cells.iter().enumerate() {
        bar(
            &mut canvas,
            cell,
            scale,
            HEAD + ROW * number as f64,
            panel.unit,
        );
    }
    canvas
}

/// Draws a bar with its name and its ratio. `y` is the upper end of the bar.
fn bar(canvas: &mut Canvas, cell: &Cell, scale: LogScale, y: f64, unit: &str) {
    let (left, baseline) = (BARS[0], y + 11.0);
    let lead = cell.is_best() || cell.shares_first();
    let label = Style::new(12).bold(lead);
    canvas.text([left - 6.0, baseline], &cell.backend, label.end());
    let Some(ratio) = cell.ratio else {
        let why = match cell.source {
            Source::Impossible => "not possible",
            Source::NotRun => "not run",
            _ => "not compared",
        };
        canvas.text(
            [left + 4.0, baseline],
            why,
            Style::new(12).colour(FAINT_COLOUR),
        );
        return;
    };
    let end = match cell.each.is_empty() {
        true => scale.place(ratio).max(left + 2.0),
        false => scale.place(ratio),
    };
    let cut = ratio > scale.values[1];
    let colour = column_colour(&cell.backend);
    canvas.mark(mark_title(cell, unit), |canvas| {
        match (cell.is_bound(), cell.each.is_empty()) {
            (true, _) => canvas.frame([left, y], [end - left, HEIGHT], colour),
            (false, true) => canvas.rect([left, y], [end - left, HEIGHT], colour),
            (false, false) => canvas.rect([end - 1.5, y - 1.0], [3.0, HEIGHT + 2.0], TEXT_COLOUR),
        }
    });
    if !cell.each.is_empty() {
        spread(canvas, cell, scale, y);
    } else if cut {
        // A slanted gap near the end of the bar.
        let x = end - 14.0;
        let gap = [
            [x, y + HEIGHT + 1.0],
            [x + 5.0, y - 1.0],
            [x + 9.0, y - 1.0],
            [x + 4.0, y + HEIGHT + 1.0],
        ];
        canvas.filled(&gap, BACKGROUND);
    }
    let mut text_from = end;
    let interval = cell.interval.filter(|_| has_line(cell) && !cut);
    if let Some([low, high]) = interval {
        let [low, high] = [low, high].map(|ratio| scale.place(ratio));
        let middle = y + HEIGHT / 2.0;
        canvas.line([low, middle], [high, middle], INTERVAL_COLOUR, 1.0);
        text_from = text_from.max(high);
    }
    if !cell.each.is_empty() {
        text_from = BARS[1];
    }
    let text = match cell.times_text() {
        text if cell.standing == Some(Standing::Equal) => format!("{text} ="),
        text if cell.standing == Some(Standing::Undecided) => format!("{text} ?"),
        text => text,
    };
    debug_assert!(text_from + text_width(&text, 12) < WIDTH + 20.0, "{text}");
    canvas.text([text_from + 6.0, baseline], &text, label);
}

/// Returns whether a line shows the interval. Over few meshes, the dots of the meshes say more.
fn has_line(cell: &Cell) -> bool {
    cell.interval.is_some() && (cell.each.is_empty() || cell.each.len() >= FEWEST_MESHES)
}

/// Draws a dot for each mesh of a mean.
fn spread(canvas: &mut Canvas, cell: &Cell, scale: LogScale, y: f64) {
    let dots = cell.each.iter().enumerate().map(|(number, &ratio)| {
        let y = y + HEIGHT / 2.0 + SCATTER * scatter(number);
        [scale.place(ratio), y]
    });
    canvas.dots(dots, 2.4, column_colour(&cell.backend));
}

/// Returns the text that a browser shows for a bar.
fn mark_title(cell: &Cell, unit: &str) -> String {
    let interval = cell.interval_text().map(|text| format!(" ({text})"));
    let fastest = if cell.each.is_empty() {
        "the fastest"
    } else {
        "the fastest on average"
    };
    format!(
        "{}: {}{} × {fastest}, {} {}",
        cell.backend,
        cell.ratio_text(),
        interval.unwrap_or_default(),
        cell.time_text(),
        per_unit(unit)
    )
}

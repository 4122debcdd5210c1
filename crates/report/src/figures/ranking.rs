//! Ranked bars: for each operation, the time of each structure or external program relative to the
//! fastest.

use kuva::plot::BarPlot;
use kuva::render::plots::Plot;
use sixfold_study::numbers::{counted, duration, figure as shown, shown_ratio};
use sixfold_study::{
    FIRST_TIME_SHOWN, NeighboursReport, Operation, PickReport, Pool, Pooled, Report, ResultRow,
    Run, SpatialTask, Standing,
};

use super::{Row, marked, per_unit};
use crate::colours::{INTERVAL_COLOUR, column_colour};
use crate::data::{FigureData, rows as data};
use crate::figure::{Figure, MIN_BAR_LENGTH, Table, base_layout, picture, ratio_ticks};

pub(super) fn from_study(study: &Report, command: &str) -> Vec<Figure> {
    let figures = Operation::ALL.into_iter().filter_map(|operation| {
        let rows = study.rows(operation).filter_map(|row| {
            Some(Row {
                backend: &row.backend,
                ratio: study.shown_ratio(row)?,
                interval: row.ratio_ci_low.zip(row.ratio_ci_high).map(|(a, b)| [a, b]),
                bound: false,
                ns: row.ns_per_element,
                first_ns: first_time(row),
                note: match row.standing {
                    Some(Standing::Best) => "best".into(),
                    Some(Standing::Tied) => "tied for best".into(),
                    _ if row.sampled => "from a sample of the elements".into(),
                    _ => String::new(),
                },
            })
        });
        let per = study
            .rows(operation)
            .next()
            .map_or("element", |row| &row.per);
        let figure = operation_figure(operation, rows.collect(), per, command)?;
        Some(figure.with_data(data::ranking(study, operation)))
    });
    figures.collect()
}

/// Returns the time per element of a first run, if it differs from the time of later runs.
fn first_time(row: &ResultRow) -> Option<f64> {
    let ratio = row.first_ratio()?;
    let each = row.first_ns? / row.elements.filter(|&n| n > 0)? as f64;
    (ratio.max(ratio.recip()) > FIRST_TIME_SHOWN).then_some(each)
}

pub(super) fn pooled(pool: &Pool, runs: &[&Run], command: &str) -> Vec<Figure> {
    let figures = Operation::ALL.into_iter().filter_map(|operation| {
        let rows = pool.all().iter().filter(|row| row.operation == operation);
        let rows = rows.map(|row| Row {
            backend: &row.backend,
            ratio: row.ratio_to_best,
            interval: row.ci_low.zip(row.ci_high).map(|(a, b)| [a, b]),
            bound: row.estimated > 0,
            ns: row.ns_per_element,
            first_ns: None,
            note: format!(
                "mean over {}: single fastest on {}, tied for the fastest on {}, not run on {}",
                counted(row.meshes, "mesh", "meshes"),
                row.best,
                row.tied,
                row.estimated
            ),
        });
        let figure = operation_figure(operation, rows.collect(), operation.unit(), command)?;
        let shown = |row: &Pooled| row.operation == operation;
        Some(Figure {
            data: data::pooled(pool, runs.iter().copied(), shown),
            caption: "The scale is logarithmic and begins at 1, the time of the fastest. Each \
                      ratio is the geometric mean over the meshes of the time divided by the time \
                      of the fastest measured backend of the mesh. ≥ marks lower bounds, which are \
                      not ranked: a run would exceed the budget. The thin lines are the 95 % intervals of \
                      the means."
                .into(),
            ..figure
        })
    });
    figures.collect()
}

/// The remark on a lower bound.
const NOT_RUN: &str = "lower bound, not ranked: a full run would exceed the budget";

pub(super) fn from_workload(report: &PickReport, id: &str, command: &str) -> Option<Figure> {
    let rows = report.ranking.iter().map(|ranked| Row {
        backend: &ranked.backend,
        ratio: ranked.ratio_to_best,
        interval: ranked.ci_low.zip(ranked.ci_high).map(|(a, b)| [a, b]),
        bound: ranked.estimated,
        ns: Some(ranked.ns_per_operation),
        first_ns: None,
        note: match (ranked.tied_with_best, ranked.ratio_to_best) {
            _ if ranked.estimated => NOT_RUN.into(),
            (_, 1.0) => "best".into(),
            (true, _) => "tied for best".into(),
            _ if ranked.sampled => "from a sample of the elements".into(),
            _ => String::new(),
        },
    });
    let title = format!("{}: time relative to the fastest", report.workload.name);
    let rows = with_shown_ratios(rows.collect());
    let figure = figure(title, id.into(), rows, "operation", command)?;
    Some(figure.with_data(data::pick(report)))
}

pub(super) fn from_neighbours(
    report: &NeighboursReport,
    id: &str,
    command: &str,
) -> impl Iterator<Item = Figure> {
    SpatialTask::ALL.into_iter().filter_map(move |task| {
        let rows = report.rows(task).filter_map(|row| {
            Some(Row {
                backend: &row.backend,
                ratio: row.ratio_to_best?,
                interval: row.ratio_ci_low.zip(row.ratio_ci_high).map(|(a, b)| [a, b]),
                bound: false,
                ns: row.ns_per_element,
                first_ns: None,
                note: match row.standing {
                    Some(Standing::Best) => "best".into(),
                    Some(Standing::Tied) => "tied for best".into(),
                    _ if row.sample_size.is_some() => "from a sample of the queries".into(),
                    _ => String::new(),
                },
            })
        });
        let title = format!("{task}: time relative to the fastest");
        let id = format!("{id}-{}", task.name().replace('_', "-"));
        let rows = with_shown_ratios(rows.collect());
        let figure = figure(title, id, rows, task.unit(), command)?;
        Some(figure.with_data(data::neighbours(report, task)))
    })
}

fn operation_figure(
    operation: Operation,
    rows: Vec<Row<'_>>,
    per: &str,
    command: &str,
) -> Option<Figure> {
    let name = operation.name();
    let title = format!("{name}: time relative to the fastest");
    let id = format!("ranking-{}", name.replace('_', "-"));
    figure(title, id, rows, per, command)
}

/// Replaces the ratios by the quotients of the shown times, so that a reader who divides two times
/// gets the ratio.
fn with_shown_ratios(mut rows: Vec<Row<'_>>) -> Vec<Row<'_>> {
    let best = rows.iter().find(|row| row.ratio == 1.0 && !row.bound);
    if let Some(best) = best.and_then(|best| best.ns) {
        for row in &mut rows {
            row.ratio = row.ns.map_or(row.ratio, |ns| shown_ratio(ns, best));
        }
    }
    rows
}

/// Returns the cells of a row of the table. If `firsts` is true, the table has a column for the first
/// run.
fn cells(row: &Row<'_>, firsts: bool) -> Vec<String> {
    let missing = || "–".into();
    let mut cells = vec![
        row.backend.to_owned(),
        marked(shown(row.ratio), row.bound),
        row.interval.map_or_else(missing, interval_text),
        row.ns
            .map_or_else(missing, |ns| marked(duration(ns), row.bound)),
    ];
    cells.extend(firsts.then(|| row.first_ns.map_or_else(missing, duration)));
    cells.push(row.note.clone());
    cells
}

/// Returns the text that a browser shows for a bar.
fn bar_title(row: &Row<'_>, per: &str) -> String {
    let interval = row
        .interval
        .map(|ends| format!(" ({})", interval_text(ends)));
    let interval = interval.unwrap_or_default();
    let mark = |text| marked(text, row.bound);
    let time = row.ns.map_or_else(|| "–".into(), |ns| mark(duration(ns)));
    let (backend, ratio, unit) = (row.backend, mark(shown(row.ratio)), per_unit(per));
    format!("{backend}: {ratio}{interval} × the time of the fastest, {time} {unit}")
}

fn interval_text([low, high]: [f64; 2]) -> String {
    format!("{} to {}", shown(low), shown(high))
}

fn figure(
    title: String,
    id: String,
    mut rows: Vec<Row<'_>>,
    per: &str,
    command: &str,
) -> Option<Figure> {
    if rows.len() < 2 {
        return None;
    }
    rows.sort_by(|a, b| a.bound.cmp(&b.bound).then(a.ratio.total_cmp(&b.ratio)));
    let firsts = rows.iter().any(|row| row.first_ns.is_some());
    let mut header = vec![
        "".into(),
        "× the fastest".into(),
        "95 %".into(),
        per_unit(per),
    ];
    header.extend(firsts.then(|| "first run".into()));
    header.push(String::new());
    let mut table = Table::new(header);
    let (mut bars, mut whiskers, mut titles) = (Vec::new(), Vec::new(), Vec::new());
    for row in &rows {
        table.row(cells(row, firsts));
    }
    // The plot draws categories upwards, but the fastest backend belongs at the top.
    for row in rows.iter().rev() {
        let length = row.ratio.log10().max(0.0);
        let ends = row
            .interval
            .map_or([length; 2], |ends| ends.map(f64::log10));
        bars.push((row.backend.to_owned(), length, column_colour(row.backend)));
        whiskers.push(((length - ends[0]).max(0.0), (ends[1] - length).max(0.0)));
        titles.push(bar_title(row, per));
    }
    let max_log = bars
        .iter()
        .map(|(_, length, _)| *length)
        .fold(0.1, f64::max);
    for (_, length, _) in &mut bars {
        *length = length.max(MIN_BAR_LENGTH * max_log);
    }
    let height = 70.0 + 26.0 * bars.len() as f64;
    let plot = BarPlot::new()
        .with_colored_bars(bars)
        .with_horizontal(true)
        .with_width(0.7)
        .with_asymmetric_error(whiskers)
        .with_error_color(INTERVAL_COLOUR)
        .with_tooltip_labels(titles);
    let plots = vec![Plot::Bar(plot)];
    let layout = base_layout(&plots, 680.0, height)
        .with_x_axis_min(0.0)
        .with_x_axis_max(max_log * 1.08)
        .with_x_tick_format(ratio_ticks(max_log));
    Some(Figure {
        id,
        picture: picture(&title, plots, layout),
        title,
        caption: "The scale is logarithmic and begins at 1, the time of the fastest. The thin lines are the 95 % intervals of the \
                  ratios."
            .into(),
        table,
        data: FigureData::default(),
        command: command.into(),
    })
}

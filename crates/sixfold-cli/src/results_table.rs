//! The table of a study, with a row per operation and a column per backend.

use comfy_table::{Cell, LineStyle, Table, TableStyle};
use sixfold_results::{
    BackendReport, ControlRow, FIRST_TIME_SHOWN, OperationGroup, Report, ResultRow, Standing,
};
use sixfold_study::Operation;

use crate::signs::{Signs, right, signed};
use crate::tables::{stacked, unbroken};
use crate::text::hanging_indent;
use sixfold_results::numbers::figure;

/// The style of tables: two spaces between columns, and a line under the header.
pub(crate) const STYLE: TableStyle =
    TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// The units of work, with their letters in the table.
const UNITS: [(&str, &str); 5] = [
    ("vertex", "v"),
    ("edge", "e"),
    ("face", "f"),
    ("visit", "a"),
    ("new face", "n"),
];

/// Returns the table and its legend. If the terminal is too narrow, the backends are divided into
/// several tables below one another.
pub(crate) fn results_table(report: &Report, bold: bool) -> String {
    let columns: Vec<&BackendReport> = report.backends.iter().filter(|b| b.holds).collect();
    // Intervals fit into the table only if there are few columns.
    let intervals = columns.len() <= 4;
    let confidence = report.run.settings.confidence;
    let mut signs = Signs::new(bold).with_confidence(confidence);
    let table = stacked(&columns, |part| {
        table_of_backends(report, part, intervals, &mut signs)
    });
    let units = UNITS.iter().filter(|(unit, _)| {
        let mut rows = report.results.iter();
        rows.any(|row| row.per == *unit)
    });
    let meaning = |unit: &str| {
        let mut known = Operation::UNITS.iter();
        known
            .find(|(name, _)| *name == unit)
            .map(|(_, meaning)| *meaning)
    };
    let (long, short): (Vec<_>, Vec<_>) = units.partition(|(unit, _)| meaning(unit).is_some());
    let short: Vec<String> = short
        .iter()
        .map(|(unit, letter)| format!("{letter} {unit}"))
        .collect();
    if !short.is_empty() {
        signs.explain(&format!("per: {}", short.join(", ")));
    }
    for (unit, letter) in long {
        let meaning = meaning(unit).unwrap_or(unit);
        signs.explain(&format!("{letter}: {meaning}"));
    }
    if !report.results.is_empty() {
        signs.explain("`sixfold operations` says what each operation does");
        signs.explain("`sixfold pick` ranks the structures, and relation tables, for one program");
    }
    format!("{table}\n{}", signs.legend())
}

/// Returns the table of some of the backends.
fn table_of_backends(
    report: &Report,
    columns: &[&BackendReport],
    intervals: bool,
    signs: &mut Signs,
) -> String {
    let mut header = vec![Cell::new("ns"), Cell::new("per")];
    header.extend(columns.iter().map(|backend| {
        let mut name = match intervals {
            true => backend.name.clone(),
            false => backend.name.replace('-', "\n"),
        };
        if backend
            .external
            .as_ref()
            .is_some_and(|program| program.own_heap)
        {
            name += &format!(" ({})", signs.record('h'));
        }
        right(name)
    }));
    let mut table = unbroken(header, signs.is_bold());
    let first = report.backends.iter().find(|backend| backend.holds);
    let is_first = first.map(|b| &b.name) == columns.first().map(|b| &b.name);
    // Warnings and the table rows below which they are printed.
    let mut warnings: Vec<(usize, String)> = Vec::new();

    for operation in &report.run.operations {
        let rows: Vec<&ResultRow> = report.rows(&operation.name).collect();
        if rows.is_empty() {
            continue; // left_out_notes has the reasons
        }
        let of = |backend: &BackendReport| rows.iter().find(|row| row.backend == backend.name);
        let unit = UNITS.iter().find(|(unit, _)| *unit == operation.unit);
        let unit = unit.map_or(operation.unit.as_str(), |(_, letter)| letter);
        let mut line = vec![Cell::new(&operation.name), Cell::new(unit)];
        line.extend(columns.iter().map(|backend| {
            let text = match of(backend) {
                Some(row) => figure_of(row, intervals, signs),
                None => signs.record('–').into(),
            };
            signed(signs, text)
        }));
        table.add_row(line);
        let mut below = |name: &str, meaning: &str, figure: &dyn Fn(&ResultRow) -> Option<f64>| {
            let figures = columns
                .iter()
                .map(|backend| figure_below(figure, of(backend)?));
            let figures: Vec<Option<String>> = figures.collect();
            if rows.iter().any(|row| figure(row).is_some()) {
                signs.explain(meaning);
                let mut line = vec![Cell::new(format!("  {name}")), Cell::new("")];
                line.extend(
                    figures
                        .into_iter()
                        .map(|text| right(with_interval(text.unwrap_or_default(), "", intervals))),
                );
                table.add_row(line);
            }
        };
        below("ratio up to", &unsure(report), &largest_ratio);
        if operation.group == OperationGroup::Build {
            below("first time", FIRST_TIME, &first_time(&rows));
        }
        let row = table.row_count() - 1;
        let warning = noise_warning(report, &operation.name).filter(|_| is_first);
        warnings.extend(warning.map(|warning| (row, warning)));
    }
    add_bytes(&mut table, columns, intervals);
    for column in table.column_iter_mut().skip(1) {
        column.set_padding((1, 0));
    }
    let table_text = table.trim_fmt();
    // Each row has one line. The header may have several lines.
    let header = table_text.lines().count() - table.row_count();
    let mut lines: Vec<String> = Vec::new();
    for (number, line) in table_text.lines().enumerate() {
        lines.push(line.to_owned());
        let below = warnings.iter().filter(|(row, _)| header + row == number);
        lines.extend(below.map(|(_, warning)| hanging_indent("  ↑ ", warning)));
    }
    lines.join("\n")
}

const FIRST_TIME: &str = "first time: first run, in memory that was not used before";

/// Returns the time per element of first runs, for all backends if it differs from the usual time on
/// one of them.
fn first_time(rows: &[&ResultRow]) -> impl Fn(&ResultRow) -> Option<f64> + use<> {
    let differs = |row: &&ResultRow| {
        let ratio = row.first_ratio().unwrap_or(1.0);
        ratio.max(ratio.recip()) > FIRST_TIME_SHOWN
    };
    let is_shown = rows.iter().any(differs);
    move |row| {
        let elements = row.elements?.max(1) as f64;
        row.first_ns.filter(|_| is_shown).map(|ns| ns / elements)
    }
}

/// Explains what [`largest_ratio`] returns.
fn unsure(report: &Report) -> String {
    format!(
        "ratio up to: upper end of the {} interval (of this run) of the ratio to the fastest, for ? with a ratio \
         above 1.1",
        report.run.settings.confidence
    )
}

/// An undecided backend with a larger ratio is shown with the end of its interval.
const CLOSE: f64 = 1.1;

/// Returns the upper end of the interval of the ratio, if it is not decided whether the backend is the fastest, and the times are not close.
fn largest_ratio(row: &ResultRow) -> Option<f64> {
    let is_unsure = row.standing == Some(Standing::Undecided) && row.ratio_to_best? > CLOSE;
    row.ratio_ci_high.filter(|_| is_unsure)
}

fn figure_below(figure_of: &dyn Fn(&ResultRow) -> Option<f64>, row: &ResultRow) -> Option<String> {
    figure_of(row).map(figure)
}

/// Returns the warning below an operation if the two columns of the control differ.
fn noise_warning(report: &Report, operation: &str) -> Option<String> {
    let control = report.control.as_ref()?;
    let is_same = |row: &&ControlRow| row.operation == operation;
    let row = control.operations.iter().find(is_same)?;
    row.is_unsteady().then(|| {
        format!(
            "{} was measured twice here, and its two times differ by {:.0} %: smaller differences \
             in this row are not significant. Measure again with {}, or with --operations {} \
             only.",
            control.backend,
            100.0 * (row.difference() - 1.0),
            report.run.settings.more_samples(),
            row.operation
        )
    })
}

/// Adds the actual bytes per vertex, and the theoretical ones if they differ.
fn add_bytes(table: &mut Table, columns: &[&BackendReport], intervals: bool) {
    let figure = |bytes: Option<f64>| {
        let figure = bytes.map_or("–".into(), |bytes| format!("{bytes:.1}"));
        with_interval(figure, "", intervals)
    };
    let mut held = vec![Cell::new("bytes held"), Cell::new("v")];
    let bytes = columns.iter().map(|backend| backend.bytes_per_vertex);
    held.extend(bytes.map(|bytes| right(figure(bytes))));
    table.add_row(held);
    let differs = |backend: &&BackendReport| {
        let theory = backend.layout_bytes_per_vertex;
        theory.is_some() && figure(theory) != figure(backend.bytes_per_vertex)
    };
    if columns.iter().any(differs) {
        let mut theory = vec![Cell::new("bytes in theory"), Cell::new("v")];
        let bytes = columns
            .iter()
            .map(|backend| backend.layout_bytes_per_vertex);
        theory.extend(bytes.map(|bytes| right(figure(bytes))));
        table.add_row(theory);
    }
}

fn with_interval(figure: String, half_width: &str, intervals: bool) -> String {
    match intervals {
        true => format!("{figure} {half_width:>5}"),
        false => figure,
    }
}

/// Formats the time per element, with its interval if there is room.
fn figure_of(row: &ResultRow, intervals: bool, signs: &mut Signs) -> String {
    let text = signs.figure(row);
    match intervals {
        true => with_interval(text, &half_width(row, signs), true),
        false => text,
    }
}

/// Formats the half-width of the interval in percent of the time, as in `±3%`.
fn half_width(row: &ResultRow, signs: &mut Signs) -> String {
    let known = (row.median_ns, row.ci_low_ns, row.ci_high_ns);
    let (Some(median), Some(low), Some(high)) = known else {
        return String::new();
    };
    signs.record('±');
    let percent = 100.0 * (high - median).max(median - low) / median;
    match percent {
        p if p < 0.95 => format!("±.{:.0}%", (10.0 * p).max(1.0)),
        p if p < 999.0 => format!("±{p:.0}%"),
        _ => "±big".into(),
    }
}

#[cfg(test)]
mod tests;

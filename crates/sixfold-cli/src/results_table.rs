//! The table of a study, with a row per operation and a column per backend.

use comfy_table::{
    Attribute, Cell, CellAlignment, ContentArrangement, LineStyle, Table, TableStyle,
};
use sixfold_study::{
    Agreement, BackendReport, ControlRow, FIRST_TIME_SHOWN, Operation, Report, ResultRow, Standing,
};

use crate::tables::stacked;
use crate::text::{hanging_indent, width};
use sixfold_study::numbers::figure;

/// The style of tables: two spaces between columns, and a line under the header.
pub(crate) const STYLE: TableStyle =
    TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// Returns the table and its legend. In a narrow terminal, the backends are divided into several
/// tables below one another.
pub(crate) fn results_table(report: &Report, bold: bool) -> String {
    let columns: Vec<&BackendReport> = report.backends.iter().filter(|b| b.holds).collect();
    // Intervals fit into the table only if there are few columns.
    let intervals = columns.len() <= 4;
    let mut signs = Signs::default();
    let least = columns.iter().filter_map(|backend| backend.bytes).min();
    let least = least.filter(|_| columns.len() > 1);
    let smallest = columns.iter().filter(|b| b.bytes == least).count();
    let smallest = (least, smallest);
    let mut text = stacked(&columns, |part| {
        table_of_backends(report, part, intervals, smallest, bold, &mut signs)
    });
    for line in signs.legend() {
        text += "\n";
        text += &line;
    }
    text
}

/// Returns the table of some of the backends. `smallest` has the least bytes of all backends, and
/// the number of backends with these bytes.
fn table_of_backends(
    report: &Report,
    columns: &[&BackendReport],
    intervals: bool,
    smallest: (Option<usize>, usize),
    bold: bool,
    signs: &mut Signs,
) -> String {
    let mut table = Table::new();
    table
        .load_style(STYLE)
        .set_content_arrangement(ContentArrangement::Disabled);
    if bold {
        table.enforce_styling();
    } else {
        table.force_no_tty();
    }
    let is_first = {
        let first = report.backends.iter().find(|backend| backend.holds);
        first.map(|b| &b.name) == columns.first().map(|b| &b.name)
    };
    // Warnings and the table rows below which they are printed.
    let mut warnings: Vec<(usize, String)> = Vec::new();
    let mut header = vec![Cell::new("nanoseconds"), Cell::new("per")];
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
        Cell::new(name).set_alignment(CellAlignment::Right)
    }));
    table.set_header(header);

    for operation in Operation::ALL {
        let rows: Vec<&ResultRow> = report.rows(operation).collect();
        if rows.is_empty() {
            continue; // left_out_notes has the reasons
        }
        let mut line = vec![Cell::new(operation.name()), Cell::new(operation.unit())];
        for backend in columns {
            let row = rows.iter().find(|row| row.backend == backend.name);
            line.push(match row {
                Some(row) => cell(row, intervals, bold, signs),
                None => Cell::new("–  ").set_alignment(CellAlignment::Right),
            });
        }
        table.add_row(line);
        if let Some(line) = first_times(&rows, columns, intervals) {
            signs.first_times = true;
            table.add_row(line);
        }
        let row = table.row_count() - 1;
        let warning = noise_warning(report, operation).filter(|_| is_first);
        warnings.extend(warning.map(|warning| (row, warning)));
    }
    add_bytes(&mut table, columns, smallest, intervals, bold, signs);
    // With this padding, six backends fit into 100 columns of text.
    if let Some(names) = table.column_mut(0) {
        names.set_padding((0, 1));
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

/// Returns the row of first times below an operation. Returns `None` if no first time differs from
/// the median.
fn first_times(
    rows: &[&ResultRow],
    columns: &[&BackendReport],
    intervals: bool,
) -> Option<Vec<Cell>> {
    let differs = |row: &&&ResultRow| {
        let ratio = row.first_ratio().unwrap_or(1.0);
        ratio.max(ratio.recip()) > FIRST_TIME_SHOWN
    };
    rows.iter().find(differs)?;
    let mut line = vec![Cell::new("  first time"), Cell::new("")];
    line.extend(columns.iter().map(|backend| {
        let row = rows.iter().find(|row| row.backend == backend.name);
        let first = row.and_then(|row| Some(row.first_ns? / row.elements?.max(1) as f64));
        let text = first.map_or(String::new(), figure);
        marked_cell(with_interval(text, "", intervals), ' ', ' ', false)
    }));
    Some(line)
}

/// Returns the warning below an operation if the two columns of the control differ.
fn noise_warning(report: &Report, operation: Operation) -> Option<String> {
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

/// Adds two rows of bytes per vertex: the actual size of the tables, and the theoretical size.
fn add_bytes(
    table: &mut Table,
    columns: &[&BackendReport],
    (min_bytes, best_count): (Option<usize>, usize),
    intervals: bool,
    bold: bool,
    signs: &mut Signs,
) {
    let figure = |bytes: Option<f64>| {
        let figure = bytes.map_or("–".into(), |bytes| format!("{bytes:.1}"));
        with_interval(figure, "", intervals)
    };
    let mut table_bytes = vec![Cell::new("bytes held"), Cell::new("vertex")];
    let mut layout_bytes = vec![Cell::new("bytes in theory"), Cell::new("vertex")];
    for backend in columns {
        let is_best = min_bytes.is_some() && backend.bytes == min_bytes;
        let mark = match (is_best, best_count) {
            (false, _) => ' ',
            (true, 1) => signs.record('*'),
            (true, _) => signs.record('='),
        };
        table_bytes.push(marked_cell(
            figure(backend.bytes_per_vertex),
            mark,
            ' ',
            bold,
        ));
        layout_bytes.push(marked_cell(
            figure(backend.layout_bytes_per_vertex),
            ' ',
            ' ',
            bold,
        ));
    }
    table.add_row(table_bytes).add_row(layout_bytes);
}

fn with_interval(figure: String, half_width: &str, intervals: bool) -> String {
    match intervals {
        true => format!("{figure} {half_width:>5}"),
        false => figure,
    }
}

/// Returns the cell of a figure with its signs. The cell of the best figure can be bold.
fn marked_cell(figure: String, standing: char, note: char, bold: bool) -> Cell {
    let cell = Cell::new(format!("{figure} {standing}{note}")).set_alignment(CellAlignment::Right);
    if bold && standing == '*' {
        cell.add_attribute(Attribute::Bold)
    } else {
        cell
    }
}

fn cell(row: &ResultRow, intervals: bool, bold: bool, signs: &mut Signs) -> Cell {
    let standing = match row.standing {
        Some(Standing::Best) => signs.record('*'),
        Some(Standing::Tied) => signs.record('='),
        _ => ' ',
    };
    let note = match row.agreement {
        Agreement::Mismatch => signs.record('!'),
        Agreement::Merged => signs.record('m'),
        Agreement::OtherEdits => signs.record('e'),
        _ => ' ',
    };
    let Some(each) = row.ns_per_element else {
        let estimate = row.estimated_ns.zip(row.elements);
        let each = estimate.map(|(ns, elements)| ns / elements.max(1) as f64);
        let figure = each.map_or("–".into(), |each| {
            format!("{}{}", signs.record('?'), figure(each))
        });
        return marked_cell(with_interval(figure, "", intervals), standing, note, bold);
    };
    let mut text = figure(each);
    if row.sampled {
        text.insert(0, signs.record('~'));
    }
    if intervals {
        text = with_interval(text, &half_width(row, signs), intervals);
    }
    marked_cell(text, standing, note, bold)
}

/// Formats the half-width of the interval in percent of the median, as in `±3%`.
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

/// The signs that occur in the table. The legend explains only these signs.
#[derive(Default)]
struct Signs {
    used: Vec<char>,
    first_times: bool,
}

impl Signs {
    fn record(&mut self, sign: char) -> char {
        if !self.used.contains(&sign) {
            self.used.push(sign);
        }
        sign
    }

    fn legend(&self) -> Vec<String> {
        let meanings = [
            ('*', "best"),
            (
                '=',
                "tied with the best: differs by less than the noise (2 × with one or two \
                 samples)",
            ),
            (
                'h',
                "own heap: the allocator of this program does not keep freed pages",
            ),
            ('~', "measured on a sample of the elements"),
            ('?', "estimated, not run"),
            ('±', "95 % interval of the median"),
            ('m', "the backend merges vertices at one position"),
            (
                'e',
                "the backend refuses edits that others accept, so its times are not compared",
            ),
            ('!', "WRONG: the result differs from the other backends"),
        ];
        let used = meanings.iter().filter(|(sign, _)| self.used.contains(sign));
        let first_times = "first time: one run on new pages, with tables without spare capacity";
        let first_times = self.first_times.then(|| first_times.to_owned());
        let parts = used.map(|(sign, meaning)| format!("{sign} {meaning}"));
        // A legend line may end only between two signs.
        let mut lines: Vec<String> = Vec::new();
        for part in parts.chain(first_times) {
            match lines.last_mut() {
                Some(line) if line.chars().count() + 2 + part.chars().count() <= width() => {
                    *line += "; ";
                    *line += &part;
                }
                _ => lines.push(part),
            }
        }
        // A part can be wider than a narrow terminal.
        lines.iter().map(|line| hanging_indent("", line)).collect()
    }
}

#[cfg(test)]
mod tests;

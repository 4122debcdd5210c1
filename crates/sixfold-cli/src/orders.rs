//! `sixfold orders`: measures how the order of a mesh in memory affects each backend.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use comfy_table::{Attribute, Cell, CellAlignment, Table};
use sixfold::shapes::Order;
use sixfold_study::{
    Agreement, Comparison, DEFAULT_OPERATIONS, OrderRow, OrdersReport, Settings, Standing,
    StudyError, StudyMesh,
};

use crate::arguments::{ORDERS_EXAMPLES, Orders};
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::free_memory::check_free_memory;
use crate::left_out::refusal_notes;
use crate::load;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::study::{name_lists, print_end};
use crate::tables::styled;
use crate::text::{TextOutput, hanging_indent};
use sixfold_study::numbers::figure;

pub(crate) fn run(arguments: &Orders) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let mut session = Session::open(mesh, &arguments.files, arguments.memory.heap)?;
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, arguments.triangulate)?;
    let settings = Settings {
        backends: arguments.backends.clone(),
        operations: arguments.operations.clone(),
        effort: arguments.effort.effort(),
        seed: arguments.seed,
        heap: arguments.memory.heap,
        caches: arguments.memory.caches,
        ..Settings::default()
    };
    warn_of_debug_build();
    print_before_measuring(&study_mesh, &settings, &mut session.text);
    let report = measure(&study_mesh, &settings, &session.stop, &Bar::new())?;
    print(&report, &mut session.text);
    session.finish(&with_command(report, arguments.triangulate).into())
}

/// Measures the mesh in all orders, if there is enough free memory.
pub(crate) fn measure(
    study_mesh: &StudyMesh,
    settings: &Settings,
    stop: &AtomicBool,
    bar: &Bar,
) -> Result<OrdersReport, Failure> {
    let needed = sixfold_study::orders_bytes(study_mesh, settings).map_err(Failure::usage)?;
    check_free_memory(
        "the mesh in four orders on each backend",
        needed,
        "choose fewer --backends, or a smaller mesh",
    )?;
    let report = sixfold_study::orders(study_mesh, settings, stop, &mut |at| bar.show(at));
    bar.clear();
    report.map_err(|error| match error {
        StudyError::NoneHolds { .. } => Failure::unsupported(error),
        error => Failure::usage(error),
    })
}

/// Returns the help text after the options.
pub(crate) fn help() -> String {
    format!(
        "{ORDERS_EXAMPLES}\n\n{}\n{}",
        name_lists(),
        default_operations()
    )
}

pub(crate) fn default_operations() -> String {
    hanging_indent("By default:  ", &DEFAULT_OPERATIONS.join(", "))
}

fn print(report: &OrdersReport, text: &mut TextOutput) {
    for comparison in &report.comparisons {
        let rows: Vec<&OrderRow> = report.rows(comparison.operation).collect();
        if !rows.is_empty() {
            text.print_line("");
            text.print_line(&table(comparison, &rows, text.bold()));
        }
    }
    text.print_line("");
    text.print_line(&hanging_indent("", LEGEND));
    text.print_line("");
    let samples = report.results.iter().map(|row| row.row.samples);
    let (sentences, warnings) = (&report.sentences, &report.warnings);
    let notes = refusal_notes(&report.refusals);
    print_end(sentences, warnings, notes, &report.run, samples, text);
}

const LEGEND: &str = "Each cell has the ns per element, and the ratio to the best order of the \
    backend. * best order of the backend; = tied with the best order; ~ measured on a sample of \
    the elements; ? estimated, not run; m the backend merges vertices at one position; \
    e the backend refuses edits that other backends accept; ! WRONG: the result differs from the \
    other results. worst/best: time in the worst order, divided by the time in the best \
    order (– if the difference is within the noise).";

/// Returns the table with a row per backend and a column per order.
fn table(comparison: &Comparison, rows: &[&OrderRow], bold: bool) -> String {
    let operation = comparison.operation;
    let first = format!("{operation}\nns per {}", operation.unit());
    let orders = Order::ALL.map(|order| right(order.name().to_owned()));
    let mut header = vec![Cell::new(first)];
    header.extend(orders);
    header.push(right("worst/best".into()));
    let mut table: Table = styled(header, bold);
    for backend_rows in rows.chunk_by(|a, b| a.row.backend == b.row.backend) {
        let backend = &backend_rows[0].row.backend;
        let mut line = vec![Cell::new(backend)];
        for order in Order::ALL {
            let row = backend_rows.iter().find(|row| row.order == order);
            line.push(row.map_or_else(|| right("–".into()), |row| cell(row, bold)));
        }
        let effect = comparison.orders.iter().find(|e| e.backend == *backend);
        line.push(right(match effect {
            Some(effect) if effect.matters => format!("{:.2}×", effect.worst_to_best.ratio),
            _ => "–".into(),
        }));
        table.add_row(line);
    }
    table.trim_fmt()
}

fn right(text: String) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
}

/// Formats a cell such as `24.9 1.52× `: ns per element, the ratio to the best order, and a sign.
fn cell(OrderRow { row, .. }: &OrderRow, bold: bool) -> Cell {
    let time = match (row.ns_per_element, row.estimated_ns, row.elements) {
        (Some(each), ..) => Some((if row.sampled { "~" } else { "" }, each)),
        (None, Some(ns), Some(elements)) => Some(("?", ns / elements.max(1) as f64)),
        _ => None,
    };
    let Some((sign, each)) = time else {
        return right("–".into());
    };
    let ratio = row.ratio_to_best.map(|ratio| format!("{ratio:.2}×"));
    let standing = match row.standing {
        Some(Standing::Best) => '*',
        Some(Standing::Tied) => '=',
        _ => ' ',
    };
    let note = match row.agreement {
        Agreement::Mismatch => "!",
        Agreement::Merged => "m",
        Agreement::OtherEdits => "e",
        _ => "",
    };
    let (each, ratio) = (short_figure(each), ratio.unwrap_or_default());
    let cell = right(format!("{sign}{each} {ratio:>5}{standing}{note}"));
    match bold && standing == '*' {
        true => cell.add_attribute(Attribute::Bold),
        false => cell,
    }
}

/// Formats a figure in at most six characters.
pub(crate) fn short_figure(number: f64) -> String {
    match number {
        n if n >= 99_999.5 => format!("{n:.1e}"),
        n => figure(n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_figures_stay_short() {
        assert_eq!(
            [4.126, 41_234.5, 123_456.0].map(short_figure),
            ["4.13", "41,235", "1.2e5"]
        );
    }
}

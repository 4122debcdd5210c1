//! `sixfold neighbours`: measures searches for neighbours in space.

use std::process::ExitCode;

use comfy_table::{Attribute, Cell, CellAlignment};
use sixfold_study::{
    Agreement, NeighbourRow, NeighboursReport, NeighboursSettings, Policy, SpatialTask, Standing,
};

use crate::arguments::Neighbours;
use crate::facts_text::facts_text;
use crate::failure::Failure;
use crate::load;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::orders::short_figure;
use crate::progress::Bar;
use crate::study::print_end;
use crate::tables::styled;
use crate::text::{TextOutput, hanging_indent};

pub(crate) fn run(arguments: &Neighbours) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let settings = NeighboursSettings {
        indices: arguments.indices.clone(),
        points: arguments.points,
        effort: arguments.effort.effort(),
        seed: arguments.seed,
        heap: Policy::Kept,
    };
    let mut session = Session::open(mesh, &arguments.files, settings.heap)?;
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, false)?;
    warn_of_debug_build();
    session.text.print_line(&facts_text(&study_mesh.report()));
    let bar = Bar::new();
    let report = sixfold_study::neighbours(&study_mesh, &settings, &session.stop, &mut |at| {
        bar.show(at);
    });
    bar.clear();
    let report = report.map_err(Failure::usage)?;
    print(&report, &mut session.text);
    session.finish(&with_command(report, false).into())
}

fn print(report: &NeighboursReport, text: &mut TextOutput) {
    text.print_line("");
    text.print_line(&table(report, text.bold()));
    text.print_line("");
    text.print_line(&hanging_indent("", LEGEND));
    text.print_line("");
    let samples = report.results.iter().map(|row| row.samples);
    let (sentences, warnings) = (&report.sentences, &report.warnings);
    print_end(sentences, warnings, Vec::new(), &report.run, samples, text);
}

const LEGEND: &str = "* fastest; = tied with the fastest; ~ measured on some of the queries; \
    ! WRONG: the answers differ from the answers of another index. The last row has the size of \
    both indices together.";

/// Returns the table with a row per task and a column per index.
fn table(report: &NeighboursReport, bold: bool) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let mut header = vec![Cell::new("nanoseconds"), Cell::new("per")];
    let names = report
        .backends
        .iter()
        .map(|index| right(index.name.clone()));
    header.extend(names);
    let mut table = styled(header, bold);
    for task in SpatialTask::ALL {
        let mut line = vec![Cell::new(task), Cell::new(task.unit())];
        for index in &report.backends {
            let row = report.rows(task).find(|row| row.backend == index.name);
            let cell = right(row.map_or_else(|| "–".into(), figure_of));
            let is_best = row.is_some_and(|row| row.standing == Some(Standing::Best));
            line.push(match bold && is_best {
                true => cell.add_attribute(Attribute::Bold),
                false => cell,
            });
        }
        table.add_row(line);
    }
    let mut sizes = vec![Cell::new("size"), Cell::new("KiB")];
    let kib = |bytes: usize| short_figure((bytes as f64 / 1024.0).round());
    sizes.extend(report.backends.iter().map(|index| right(kib(index.bytes))));
    table.add_row(sizes);
    table.trim_fmt()
}

/// Formats the time per element, such as `~812  ` or `310 *`.
fn figure_of(row: &NeighbourRow) -> String {
    let sampled = row.sample_size.map_or("", |_| "~");
    let standing = match (row.agreement, row.standing) {
        (Agreement::Mismatch, _) => '!',
        (_, Some(Standing::Best)) => '*',
        (_, Some(Standing::Tied)) => '=',
        _ => ' ',
    };
    format!("{sampled}{} {standing}", short_figure(row.ns_per_element))
}

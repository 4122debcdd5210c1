//! `sixfold neighbours`: measures searches for neighbours in space.

use std::process::ExitCode;

use comfy_table::Cell;
use sixfold_results::numbers::figure;
use sixfold_results::{IndexReport, NeighboursReport, Policy, SpatialTask};
use sixfold_study::{NeighboursSettings, Progress};

use crate::arguments::Neighbours;
use crate::facts_text::facts_text;
use crate::failure::Failure;
use crate::launches::{self, Launching, Work};
use crate::load;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::signs::{Signs, right, signed};
use crate::study::print_end;
use crate::tables::{stacked, unbroken};
use crate::text::TextOutput;

pub(crate) fn run(arguments: &Neighbours) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let settings = NeighboursSettings {
        indices: arguments.indices.clone(),
        points: arguments.points,
        effort: arguments.effort.effort(),
        confidence: arguments.launching.confidence,
        seed: launches::seed(arguments.seed),
        heap: Policy::Kept,
    };
    let mut session = Session::open(mesh, &arguments.files, settings.heap)?;
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, false)?;
    let study_mesh = session.drawn(study_mesh);
    warn_of_debug_build();
    session.text.print_line(&facts_text(&study_mesh.report()));
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: mesh.into_iter().collect(),
        part: None,
        stop: &session.stop,
        pool: sixfold_study::pool_launches,
    };
    let faces = study_mesh.polygons.face_count();
    let work = Work::new(faces, SpatialTask::ALL.len(), &[]);
    let plan = launching.plan(settings.effort, work)?;
    let bar = Bar::new();
    let reports = Some(vec![study_mesh.report()]);
    let report = plan.measure(reports, &|done, what| bar.set(done, what), || {
        let mut show = |at: Progress<'_>| bar.show(at);
        let report = sixfold_study::neighbours(&study_mesh, &settings, &session.stop, &mut show);
        report.map_err(Failure::usage)
    });
    bar.clear();
    let report: NeighboursReport = report?;
    print(&report, &mut session.text);
    session.finish(
        with_command(report, false).into(),
        arguments.launching.keep_going,
    )
}

fn print(report: &NeighboursReport, text: &mut TextOutput) {
    text.print_line("");
    text.print_answer(&report.sentences, &report.warnings);
    text.print_line(&table(report, text.bold()));
    text.print_line("");
    let samples = report.results.iter().map(|row| row.samples);
    print_end(Vec::new(), &report.run, samples, text);
}

/// Returns the table with a row per task and a column per index, and its legend. If the terminal is too narrow, the
/// indices are divided into several tables below one another.
fn table(report: &NeighboursReport, bold: bool) -> String {
    let mut signs = Signs::new(bold);
    let indices: Vec<&IndexReport> = report.backends.iter().collect();
    let table = stacked(&indices, |part| table_of(report, part, &mut signs));
    signs.explain("size: both indices, of the vertices and of the triangles (1 kB = 1,000 bytes)");
    format!("{table}\n{}", signs.legend())
}

/// Returns the table of some of the indices.
fn table_of(report: &NeighboursReport, indices: &[&IndexReport], signs: &mut Signs) -> String {
    let mut header = vec![Cell::new("ns"), Cell::new("per")];
    header.extend(indices.iter().map(|index| right(&index.name)));
    let mut table = unbroken(header, signs.is_bold());
    for task in SpatialTask::ALL {
        let mut line = vec![Cell::new(task), Cell::new(task.unit())];
        for index in indices {
            let row = report
                .rows(task.name())
                .find(|row| row.backend == index.name);
            let text = row.map_or("–".into(), |row| signs.figure(row));
            line.push(signed(signs, text));
        }
        table.add_row(line);
    }
    let mut sizes = vec![Cell::new("size"), Cell::new("kB")];
    let kb = |bytes: usize| figure(bytes as f64 / 1000.0);
    sizes.extend(indices.iter().map(|index| right(kb(index.bytes))));
    table.add_row(sizes);
    for column in table.column_iter_mut().skip(1) {
        column.set_padding((1, 0));
    }
    table.trim_fmt()
}

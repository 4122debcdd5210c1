//! `sixfold orders`: measures how the order of a mesh in memory affects each backend.

use std::process::ExitCode;

use comfy_table::{Cell, Table};
use sixfold::shapes::Order;
use sixfold_results::{Comparison, OrdersReport, ResultRow};
use sixfold_study::{DEFAULT_OPERATIONS, Progress, Settings, StudyError, StudyMesh};

use crate::arguments::{ORDERS_EXAMPLES, Orders};
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::free_memory::check_free_memory;
use crate::launches::{self, Launching, Work, chosen};
use crate::left_out::refusal_notes;
use crate::load;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::signs::{Signs, right, signed};
use crate::study::{name_lists, print_end};
use crate::tables::styled;
use crate::text::{TextOutput, hanging_indent};
use sixfold_results::numbers::{figure, shown_ratio};

pub(crate) fn run(arguments: &Orders) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let mut session = Session::open(mesh, &arguments.files, arguments.memory.heap)?;
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, arguments.triangulate)?;
    let study_mesh = session.drawn(study_mesh);
    let settings = Settings {
        backends: arguments.backends.clone(),
        operations: arguments.operations.selected(),
        effort: arguments.effort.effort(),
        confidence: arguments.launching.confidence,
        seed: launches::seed(arguments.seed),
        heap: arguments.memory.heap,
        caches: arguments.memory.caches,
        ..Settings::default()
    };
    warn_of_debug_build();
    print_before_measuring(&study_mesh, &settings, &mut session.text);
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: mesh.into_iter().collect(),
        part: None,
        stop: &session.stop,
        pool: sixfold_study::pool_launches,
    };
    let report = measure(&study_mesh, &settings, &launching, &Bar::new())?;
    print(&report, &mut session.text);
    session.finish(
        with_command(report, arguments.triangulate).into(),
        arguments.launching.keep_going,
    )
}

/// Measures the mesh in all orders, if there is enough free memory: in this process, or in several launches.
pub(crate) fn measure(
    study_mesh: &StudyMesh,
    settings: &Settings,
    launching: &Launching<'_>,
    bar: &Bar,
) -> Result<OrdersReport, Failure> {
    let faces = study_mesh.polygons.face_count();
    let work = Work::new(
        faces,
        chosen(&settings.operations, DEFAULT_OPERATIONS.len()),
        &settings.backends,
    );
    let plan = launching.plan(settings.effort, work.times(Order::ALL.len()))?;
    let needed = sixfold_study::orders_bytes(study_mesh, settings).map_err(Failure::usage)?;
    check_free_memory(
        "the mesh in four orders on each backend",
        needed,
        "choose fewer --backends, or a smaller mesh",
    )?;
    let meshes = Some(vec![study_mesh.report()]);
    let report = plan.measure(meshes, &|done, what| bar.set(done, what), || {
        let mut show = |at: Progress<'_>| bar.show(at);
        let report = sixfold_study::orders(study_mesh, settings, launching.stop, &mut show);
        report.map_err(|error| match error {
            StudyError::NoneHolds { .. } => Failure::unsupported(error),
            error => Failure::usage(error),
        })
    });
    bar.clear();
    report
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
    text.print_line("");
    text.print_answer(&report.sentences, &report.warnings);
    let mut signs = Signs::new(text.bold());
    for comparison in &report.comparisons {
        let rows: Vec<&ResultRow> = report.rows(&comparison.operation).collect();
        if !rows.is_empty() {
            text.print_line(&table(comparison, &rows, &mut signs));
            text.print_line("");
        }
    }
    signs.explain("signs compare the orders of one structure");
    signs.explain("worst: ratio of the worst order to the best, – without a clear difference");
    text.print_line(&signs.legend());
    text.print_line("");
    let samples = report.results.iter().map(|row| row.samples);
    let notes = refusal_notes(&report.refusals);
    print_end(notes, &report.run, samples, text);
}

/// Returns the table with a row per structure and a column per order.
fn table(comparison: &Comparison, rows: &[&ResultRow], signs: &mut Signs) -> String {
    let first = format!("{}\nns per {}", comparison.operation, rows[0].per);
    let orders = Order::ALL.map(|order| right(order.name().replace('-', "-\n")));
    let mut header = vec![Cell::new(first)];
    header.extend(orders);
    header.push(right("worst"));
    let mut table: Table = styled(header, signs.is_bold());
    // With this padding, names and times of a million faces fit into 80 columns.
    for column in table.column_iter_mut().skip(1) {
        column.set_padding((1, 0));
    }
    for backend_rows in rows.chunk_by(|a, b| a.backend == b.backend) {
        let backend = &backend_rows[0].backend;
        let each: Vec<f64> = backend_rows
            .iter()
            .filter_map(|row| row.ns_per_element)
            .collect();
        let [best, worst] = [f64::min, f64::max].map(|of| each.iter().copied().reduce(of));
        let mut line = vec![Cell::new(backend)];
        for order in Order::ALL {
            let row = backend_rows.iter().find(|row| row.case == order.name());
            let text = row.map_or("–".into(), |row| signs.figure(row));
            line.push(signed(signs, text));
        }
        let effect = comparison.orders.iter().find(|e| e.backend == *backend);
        let matters = effect.is_some_and(|effect| effect.matters);
        let largest = worst.zip(best).filter(|_| matters);
        line.push(right(largest.map_or("–".into(), |(worst, best)| {
            figure(shown_ratio(worst, best))
        })));
        table.add_row(line);
    }
    table.trim_fmt()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use sixfold_results::Results;

    use super::*;

    /// The times of a scan over a million triangles are the longest figures.
    #[test]
    fn tables_of_a_million_faces_cut_no_name() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports/orders/orders.json");
        let text = fs::read_to_string(path).expect("the committed report");
        let results = Results::read_json(&text).expect("a document");
        let report = results.orders().next().expect("orders");
        assert_eq!(report.comparisons.len(), 6);
        for comparison in &report.comparisons {
            let rows: Vec<&ResultRow> = report.rows(&comparison.operation).collect();
            let table = table(comparison, &rows, &mut Signs::new(false));
            assert!(table.contains("indexed-face-set"), "{table}");
            let width = table.lines().map(|line| line.chars().count()).max();
            assert!(width.is_some_and(|width| width <= 80), "{table}");
        }
    }
}

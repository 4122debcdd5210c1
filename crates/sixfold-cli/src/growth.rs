//! `sixfold growth`: measures how times grow with the size of the mesh.

use std::process::ExitCode;

use comfy_table::Cell;
use sixfold_results::{Fit, GrowthReport, ResultRow, SizeReport, Slope};
use sixfold_study::{
    DEFAULT_OPERATIONS, GrowthError, GrowthSettings, Progress, SCALABLE_SHAPES, ScalableShape,
    Settings, StudyError,
};

use crate::arguments::{GROWTH_EXAMPLES, Growth};
use crate::failure::Failure;
use crate::free_memory::check_free_memory;
use crate::launches::{self, Launching, Work, chosen};
use crate::left_out::refusal_notes;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::orders::default_operations;
use crate::progress::Bar;
use crate::signs::{Signs, right, signed};
use crate::study::{name_lists, print_end};
use crate::tables::{stacked, styled, unbroken};
use crate::text::{TextOutput, hanging_indent};
use sixfold_results::numbers::{counted, grouped};

pub(crate) fn run(arguments: &Growth) -> Result<ExitCode, Failure> {
    let mut session = Session::open(None, &arguments.files, arguments.memory.heap)?;
    let settings = GrowthSettings {
        study: Settings {
            backends: arguments.backends.clone(),
            operations: arguments.operations.selected(),
            effort: arguments.effort.effort(),
            confidence: arguments.launching.confidence,
            seed: launches::seed(arguments.seed),
            heap: arguments.memory.heap,
            caches: arguments.memory.caches,
            ..Settings::default()
        },
        shape: arguments.shape.clone(),
        order: arguments.order,
        order_seed: arguments.seed,
        from: arguments.from,
        to: arguments.to,
        steps: arguments.steps,
    };
    warn_of_debug_build();
    check_memory(&settings)?;
    print_before_measuring(&settings, &mut session.text);
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: Vec::new(),
        part: None,
        stop: &session.stop,
        pool: sixfold_study::pool_launches,
    };
    let report = measure(&settings, &launching, &Bar::new())?;
    print(&report, &mut session.text);
    session.finish(
        with_command(report, false).into(),
        arguments.launching.keep_going,
    )
}

/// Prints what is known before the measurement: the shape, its sizes, and the backends that cannot
/// hold it. Prints nothing if an error follows.
fn print_before_measuring(settings: &GrowthSettings, text: &mut TextOutput) {
    let Ok((sizes, refused_by)) = sixfold_study::growth_plan(settings) else {
        return; // the measurement returns this error
    };
    let shape = format!("{}, in the order {}", settings.shape, settings.order);
    text.print_line(&hanging_indent("shape        ", &shape));
    let [first, last] = [sizes.first(), sizes.last()].map(|size| grouped(*size.unwrap_or(&0)));
    let steps = counted(sizes.len(), "size", "sizes");
    text.print_line(&hanging_indent(
        "sizes        ",
        &format!("{steps} from about {first} to {last} faces"),
    ));
    for refusal in &refused_by {
        let first = format!("{:<13}{} refuses: ", "", refusal.backend);
        text.print_line(&hanging_indent(&first, &refusal.reason));
    }
}

/// Returns an error if there is too little free memory for the largest size.
fn check_memory(settings: &GrowthSettings) -> Result<(), Failure> {
    let needed = sixfold_study::growth_bytes(settings).map_err(Failure::usage)?;
    let largest = counted(settings.to, "face", "faces");
    check_free_memory(
        &format!("a mesh of {largest} on each backend"),
        needed,
        "choose a smaller --to, or fewer --backends",
    )
}

/// Measures all sizes, if there is enough free memory for the largest size: in this process, or in several launches.
pub(crate) fn measure(
    settings: &GrowthSettings,
    launching: &Launching<'_>,
    bar: &Bar,
) -> Result<GrowthReport, Failure> {
    // A size that cannot be planned is refused by the measurement.
    let sizes = sixfold_study::growth_plan(settings).map_or_else(|_| Vec::new(), |plan| plan.0);
    let sum: usize = sizes.iter().sum();
    let work = Work::new(
        sum / sizes.len().max(1),
        chosen(&settings.study.operations, DEFAULT_OPERATIONS.len()),
        &settings.study.backends,
    );
    let plan = launching.plan(settings.study.effort, work.times(sizes.len()))?;
    check_memory(settings)?;
    let report = plan.measure(None, &|done, what| bar.set(done, what), || {
        let mut show = |at: Progress<'_>| bar.show(at);
        let report = sixfold_study::growth(settings, launching.stop, &mut show);
        report.map_err(|error| match error {
            GrowthError::Study(StudyError::NoneHolds { .. }) => Failure::unsupported(error),
            error => Failure::usage(error),
        })
    });
    bar.clear();
    report
}

/// Returns the help text after the options.
pub(crate) fn help() -> String {
    let width = SCALABLE_SHAPES.iter().map(|shape| shape.name.len()).max();
    let width = width.unwrap_or(0);
    let shape = |ScalableShape { name, summary, .. }: &ScalableShape| {
        format!("  {name:<width$}  {summary}")
    };
    let shapes: Vec<String> = SCALABLE_SHAPES.iter().map(shape).collect();
    let (shapes, names) = (shapes.join("\n"), name_lists());
    format!(
        "{GROWTH_EXAMPLES}\n\nShapes:\n{shapes}\n\n{names}\n{}",
        default_operations()
    )
}

/// Prints the results, which follow [`print_before_measuring`].
fn print(report: &GrowthReport, text: &mut TextOutput) {
    text.print_line("");
    text.print_answer(&report.sentences, &report.warnings);
    let mut signs = Signs::new(text.bold());
    let operations = report.sizes.first().map_or(&[][..], |size| &size.results);
    for rows in operations.chunk_by(|a, b| a.operation == b.operation) {
        text.print_line(&table(report, &rows[0], &mut signs));
        text.print_line("");
    }
    if !report.sizes.is_empty() {
        for part in LEGEND {
            signs.explain(part);
        }
        text.print_line(&signs.legend());
        text.print_line("");
    }
    if !report.cache_limits.is_empty() {
        text.print_line(&cache_table(report, text.bold()));
        text.print_line("");
    }
    let rows = report.sizes.iter().flat_map(|size| &size.results);
    let samples = rows.map(|row| row.samples);
    let notes = refusal_notes(report.sizes.iter().flat_map(|size| &size.refusals));
    print_end(notes, &report.run, samples, text);
}

const LEGEND: [&str; 4] = [
    "signs compare the structures at one size",
    "L1 to L3: smallest cache that can hold the structure, – if none can",
    "power: exponent p if the total time is proportional to F^p for F faces, ± standard error",
    "in cache, beyond: power for the sizes that fit into the last cache, and for the larger ones",
];

/// Returns the table of the operation of `measured`, with a row per size and fitted line, and a column per backend.
fn table(report: &GrowthReport, measured: &ResultRow, signs: &mut Signs) -> String {
    stacked(&report.backends, |backends| {
        table_of_backends(report, measured, backends, signs)
    })
}

/// Returns the table of some of the backends.
fn table_of_backends(
    report: &GrowthReport,
    measured: &ResultRow,
    backends: &[String],
    signs: &mut Signs,
) -> String {
    let ResultRow { operation, per, .. } = measured;
    let mut header = vec![Cell::new(format!("{operation}\nns per {per}"))];
    header.extend(backends.iter().map(|name| right(name.replace('-', "\n"))));
    let mut table = unbroken(header, signs.is_bold());
    for size in &report.sizes {
        let faces = counted(size.faces, "face", "faces");
        let mut line = vec![right(faces)];
        line.extend(backends.iter().map(|name| {
            let mut rows = size.results.iter();
            let row = rows.find(|r| r.backend == *name && r.operation == *operation);
            row.map_or_else(|| right("–"), |row| cell(size, row, signs))
        }));
        table.add_row(line);
    }
    let fit = |name: &String| {
        let is_same = |fit: &&Fit| fit.backend == *name && fit.operation == *operation;
        report.fits.iter().find(is_same)
    };
    for label in ["power", "in cache", "beyond"] {
        let slope = |fit: &Fit| match label {
            "power" => fit.all,
            "in cache" => fit.in_cache,
            _ => fit.beyond,
        };
        let slopes = backends.iter().map(|name| slope(fit(name)?));
        let slopes: Vec<Option<Slope>> = slopes.collect();
        if slopes.iter().all(Option::is_none) {
            continue;
        }
        let mut line = vec![right(label.to_owned())];
        line.extend(slopes.into_iter().map(|slope| right(power(slope))));
        table.add_row(line);
    }
    table.trim_fmt()
}

fn power(slope: Option<Slope>) -> String {
    match slope {
        None => "–    ".into(),
        Some(Slope {
            exponent,
            standard_error,
            ..
        }) => match standard_error {
            Some(error) => format!("{exponent:.2} ±{error:.2}"),
            None => format!("{exponent:.2}      "),
        },
    }
}

/// Returns a cell such as `*24.9 L2`: ns per element, and the cache that can hold the structure.
fn cell(size: &SizeReport, row: &ResultRow, signs: &mut Signs) -> Cell {
    let weight = size.backend_bytes.iter().find(|w| w.backend == row.backend);
    let cache = weight.and_then(|weight| weight.fits_in);
    let cache = cache.map_or(" –".into(), |level| format!("L{level}"));
    let text = format!("{} {cache}", signs.figure(row));
    signed(signs, text)
}

/// Returns the table of the face counts at which structures outgrow caches.
fn cache_table(report: &GrowthReport, bold: bool) -> String {
    let mut header = vec![Cell::new(
        "faces at which the\nstructure outgrows\nthe cache",
    )];
    header.extend(
        report
            .backends
            .iter()
            .map(|name| right(name.replace('-', "\n"))),
    );
    let mut table = styled(header, bold);
    for row in report.cache_limits.chunk_by(|a, b| a.level == b.level) {
        let kib = grouped(row[0].cache_bytes as usize >> 10);
        let mut line = vec![Cell::new(format!("L{}, {kib} KiB", row[0].level))];
        line.extend(row.iter().map(|end| right(grouped(end.faces))));
        table.add_row(line);
    }
    table.trim_fmt()
}

//! `sixfold growth`: measures how costs grow with the size of the mesh, and where the caches end.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use comfy_table::{Attribute, Cell, CellAlignment};
use sixfold_study::{
    Fit, GROWING, Growing, GrowthError, GrowthReport, GrowthSettings, Operation, ResultRow,
    Settings, SizeReport, Slope, Standing, StudyError,
};

use crate::arguments::{GROWTH_EXAMPLES, Growth};
use crate::failure::Failure;
use crate::free_memory::check_room;
use crate::measured::{ended, tell_of_debug_build, typed};
use crate::orders::{few, short};
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::study::{names, setting};
use crate::tables::styled;
use crate::text::{Text, hanging};
use sixfold_study::numbers::{counted, grouped};

/// Measures all sizes and shows the result. Text is printed first, so that it is not lost if a file
/// fails.
pub(crate) fn run(arguments: &Growth) -> Result<ExitCode, Failure> {
    check_places(None, &[("--json", arguments.json.as_ref())])?;
    let settings = GrowthSettings {
        study: Settings {
            backends: arguments.backends.clone(),
            operations: arguments.operations.clone(),
            budget: arguments.budget,
            seed: arguments.seed,
            heap: arguments.memory.heap,
            caches: arguments.memory.caches,
            ..Settings::default()
        },
        shape: arguments.shape.clone(),
        order: arguments.order,
        from: arguments.from,
        to: arguments.to,
        steps: arguments.steps,
    };
    let stop = interrupt_flag(arguments.memory.heap);
    let json = Output::open_if(arguments.json.as_ref())?;
    tell_of_debug_build();
    let report = measured(&settings, &stop)?;

    let mut text = Text::shown(!arguments.json.as_deref().is_some_and(is_stdout));
    print(&report, &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        done = done.and(output.finish(|writer| report.write_json(writer)));
    }
    ended(done, report.mismatches(), report.interrupted)
}

/// Measures all sizes, if enough memory is free for the largest.
pub(crate) fn measured(
    settings: &GrowthSettings,
    stop: &AtomicBool,
) -> Result<GrowthReport, Failure> {
    let needed = sixfold_study::growth_bytes(settings).map_err(Failure::usage)?;
    let largest = counted(settings.to, "face", "faces");
    check_room(
        &format!("a mesh of {largest} on each backend"),
        needed,
        "choose a smaller --to, or fewer --backends",
    )?;
    let bar = Bar::new();
    let report = sixfold_study::growth(settings, stop, &mut |at| bar.show(at));
    bar.clear();
    let mut report = report.map_err(|error| match error {
        GrowthError::Study(StudyError::NoneHolds { .. }) => Failure::unsupported(error),
        error => Failure::usage(error),
    })?;
    report.environment.command = Some(typed());
    Ok(report)
}

/// Returns the help text after the options: examples, the method, and the lists of names.
pub(crate) fn help() -> String {
    let width = GROWING.iter().map(|shape| shape.name.len()).max();
    let width = width.unwrap_or(0);
    let shape = |Growing { name, summary, .. }: &Growing| format!("  {name:<width$}  {summary}");
    let shapes: Vec<String> = GROWING.iter().map(shape).collect();
    let (shapes, names) = (shapes.join("\n"), names());
    format!(
        "{GROWTH_EXAMPLES}\n\nShapes:\n{shapes}\n\n{names}\n{}",
        few()
    )
}

fn print(report: &GrowthReport, text: &mut Text) {
    let (shape, order) = (&report.shape, report.order);
    text.say(&format!("shape        {shape}, in the order {order}"));
    for unheld in &report.unheld {
        let first = format!("{:<13}{} refuses: ", "", unheld.backend);
        text.say(&hanging(&first, &unheld.reason));
    }
    let operations = report.sizes.first().map_or(&[][..], |size| &size.results);
    for rows in operations.chunk_by(|a, b| a.operation == b.operation) {
        text.say("");
        text.say(&table(report, rows[0].operation, text.bold()));
    }
    if !report.sizes.is_empty() {
        text.say("");
        text.say(&hanging("", LEGEND));
    }
    if !report.cache_ends.is_empty() {
        text.say("");
        text.say(&cache_table(report, text.bold()));
    }
    let mut refusals: Vec<String> = Vec::new();
    for refusal in report.sizes.iter().flat_map(|size| &size.refusals) {
        let (operation, backend) = (refusal.operation, &refusal.backend);
        let said = format!("{operation} on {backend}: {}", refusal.reason);
        if !refusals.contains(&said) {
            text.say(&hanging("– ", &said));
            refusals.push(said);
        }
    }
    text.say("");
    for words in &report.words {
        text.say(&hanging("- ", words));
    }
    text.say("");
    let rows = report.sizes.iter().flat_map(|size| &size.results);
    let most = rows.map(|row| row.samples).max();
    let how = setting(&report.environment, most.unwrap_or(0));
    text.say(&hanging("", &how));
}

const LEGEND: &str = "ns per element, and the smallest cache that can hold the structure (–: none, \
    or unknown); * best at that size; = tied with the best; ~ from a sample of the elements; \
    ? estimated, not run. power: the total time grows as this power of the number of faces, \
    ± standard error; in cache, beyond: for sizes that fit into the last cache, and larger ones.";

/// Returns the table with a row per size and fitted line, and a column per backend.
fn table(report: &GrowthReport, operation: Operation, bold: bool) -> String {
    let mut header = vec![Cell::new(format!(
        "{operation}\nns per {}",
        operation.per()
    ))];
    header.extend(
        report
            .backends
            .iter()
            .map(|name| right(name.replace('-', "\n"))),
    );
    let mut table = styled(header, bold);
    for size in &report.sizes {
        let faces = counted(size.faces, "face", "faces");
        let mut line = vec![right(faces)];
        line.extend(report.backends.iter().map(|name| {
            let mut rows = size.results.iter();
            let row = rows.find(|r| r.backend == *name && r.operation == operation);
            row.map_or_else(|| right("–".into()), |row| cell(size, row, bold))
        }));
        table.add_row(line);
    }
    let fit = |name: &String| {
        let of_it = |fit: &&Fit| fit.backend == *name && fit.operation == operation;
        report.fits.iter().find(of_it)
    };
    for label in ["power", "in cache", "beyond"] {
        let slope = |fit: &Fit| match label {
            "power" => fit.all,
            "in cache" => fit.in_cache,
            _ => fit.beyond,
        };
        let slopes = report.backends.iter().map(|name| slope(fit(name)?));
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

fn right(text: String) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
}

/// Formats a cell as `24.9 L2*`: ns per element, the cache that can hold the structure, and a sign.
fn cell(size: &SizeReport, row: &ResultRow, bold: bool) -> Cell {
    let price = match (row.ns_per_element, row.estimated_ns, row.elements) {
        (Some(each), ..) => Some((if row.sampled { "~" } else { "" }, each)),
        (None, Some(ns), Some(elements)) => Some(("?", ns / elements.max(1) as f64)),
        _ => None,
    };
    let Some((sign, each)) = price else {
        return right("–".into());
    };
    let weight = size.weights.iter().find(|w| w.backend == row.backend);
    let cache = weight.and_then(|weight| weight.fits_in);
    let cache = cache.map_or(" –".into(), |level| format!("L{level}"));
    let standing = match row.standing {
        Some(Standing::Best) => '*',
        Some(Standing::Tied) => '=',
        _ => ' ',
    };
    let cell = right(format!("{sign}{} {cache}{standing}", short(each)));
    match bold && standing == '*' {
        true => cell.add_attribute(Attribute::Bold),
        false => cell,
    }
}

/// Returns the table of the number of faces at which each structure outgrows each cache.
fn cache_table(report: &GrowthReport, bold: bool) -> String {
    let mut header = vec![Cell::new("faces at which it\noutgrows a cache")];
    header.extend(
        report
            .backends
            .iter()
            .map(|name| right(name.replace('-', "\n"))),
    );
    let mut table = styled(header, bold);
    for row in report.cache_ends.chunk_by(|a, b| a.level == b.level) {
        let kib = grouped(row[0].cache_bytes as usize >> 10);
        let mut line = vec![Cell::new(format!("L{}, {kib} KiB", row[0].level))];
        line.extend(row.iter().map(|end| right(grouped(end.faces))));
        table.add_row(line);
    }
    table.trim_fmt()
}

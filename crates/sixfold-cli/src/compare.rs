//! `sixfold compare`: shows what changed between two studies.

use std::path::Path;
use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment};
use sixfold_study::{Change, Changes, CompareSettings, Report, Verdict, compare};

use crate::arguments::Compare;
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, check_not_overwritten, is_stdout};
use crate::tables::table;
use crate::text::{TextOutput, hanging_indent};
use sixfold_study::numbers::{duration, grouped};

/// The exit code of `--fail-if-slower` if a row is slower.
const SLOWER: u8 = 1;

pub(crate) fn run(arguments: &Compare) -> Result<ExitCode, Failure> {
    let Compare { before, after, .. } = arguments;
    for study in [before, after] {
        check_not_overwritten("the study", study, &[("--json", arguments.json.as_ref())])?;
    }
    let read = |path: &Path| load::read_results(&load::results_path(path), Report::read_json);
    let [before, after] = [read(before)?, read(after)?];
    let json = Output::open_if(arguments.json.as_ref())?;
    let settings = CompareSettings {
        relative: arguments.relative,
        drift: arguments.noise,
    };
    let changes = compare(&before, &after, settings).map_err(Failure::usage)?;
    if changes.rows.is_empty() {
        return Err(Failure::usage(format!(
            "{} and {} contain no operation that both measured on the same backend, so there is \
             nothing to compare: study both with the same --backends and --operations",
            arguments.before.display(),
            arguments.after.display()
        )));
    }
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    print(&changes, arguments.all, &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        done = done.and(output.finish(|writer| changes.write_json(writer)));
    }
    done?;
    let slower = changes.count(Verdict::Slower) > 0;
    Ok(match slower && arguments.fail_if_slower {
        true => ExitCode::from(SLOWER),
        false => ExitCode::SUCCESS,
    })
}

fn print(changes: &Changes, all: bool, text: &mut TextOutput) {
    for setting in &changes.environment {
        let first = format!("{:<13}", setting.what);
        let both = format!("{} → {}", setting.before, setting.after);
        text.print_line(&hanging_indent(&first, &both));
    }
    for (backend, before, after) in &changes.bytes {
        let (before, after) = (grouped(*before), grouped(*after));
        text.print_line(&format!("{backend:<13}{before} bytes → {after} bytes"));
    }
    let rows: Vec<&Change> = match all {
        true => changes.rows.iter().collect(),
        false => changes.changed().collect(),
    };
    if !rows.is_empty() {
        text.print_line(&changes_table(&rows));
    }
    for sentence in &changes.sentences {
        text.print_line(&hanging_indent("- ", sentence));
    }
    for (which, only) in [
        ("first", &changes.only_before),
        ("second", &changes.only_after),
    ] {
        if !only.is_empty() {
            let words = format!("Only in the {which} study: {}.", only.join(", "));
            text.print_line(&hanging_indent("- ", &words));
        }
    }
}

fn changes_table(rows: &[&Change]) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let header = ["operation", "backend"].map(Cell::new);
    let figures = ["before", "after", "ratio", "95 %"].map(|name| right(name.into()));
    let header = header.into_iter().chain(figures).chain([Cell::new("")]);
    let mut table = table(header.collect());
    for row in rows {
        let interval = row.ci_low.zip(row.ci_high);
        let interval = interval.map(|(low, high)| format!("{low:.2} to {high:.2}"));
        let verdict = match row.verdict {
            _ if row.other_checksum => "different checksum",
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
            Verdict::Same => "",
        };
        table.add_row([
            Cell::new(row.operation.name()),
            Cell::new(&row.backend),
            right(duration(row.before_ns)),
            right(duration(row.after_ns)),
            right(format!("{:.2}", row.ratio)),
            right(interval.unwrap_or_else(|| "–".into())),
            Cell::new(verdict),
        ]);
    }
    table.trim_fmt()
}

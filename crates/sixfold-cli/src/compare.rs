//! `sixfold compare`: shows what changed between two studies. `--report` writes these files:
//!
//! ```text
//! DIR/report.html                the page, which needs no other file
//! DIR/report.md, DIR/figures     the same in Markdown
//! DIR/changes.json               the changes, as --json writes them
//! DIR/sixfold-files.txt          the names of these files
//! ```

use std::path::{self, Path, PathBuf};
use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment};
use sixfold_report::{Compared, PaperFile, ReportPage};
use sixfold_results::{
    Change, Changes, CompareSettings, Measurement, MeasurementPart, Verdict, compare,
};

use crate::arguments::Compare;
use crate::failure::Failure;
use crate::listed_folder::ListedFolder;
use crate::load;
use crate::measure::command_line;
use crate::mesh_files::shown;
use crate::output::{Output, cannot_write, check_not_overwritten, check_outputs, is_stdout};
use crate::paper;
use crate::tables::table;
use crate::text::{TextOutput, hanging_indent};
use sixfold_results::numbers::{duration, grouped};

/// Maximum number of listed measurements that only one file has.
const SHOWN: usize = 8;

/// The exit codes of `--fail-if-slower` if a row is slower, and if none is but some cannot be told.
const SLOWER: u8 = 1;
const CANNOT_TELL: u8 = 3;

pub(crate) fn run(arguments: &Compare) -> Result<ExitCode, Failure> {
    let places = [&arguments.before, &arguments.after];
    let outputs = [
        ("--json", arguments.json.as_ref()),
        ("--report", arguments.report.as_ref()),
        ("--figures", arguments.figures.as_ref()),
    ];
    for place in places {
        check_not_overwritten("the results", place, &outputs)?;
        check_not_overwritten("the results", &load::results_path(place), &outputs)?;
    }
    check_outputs(None, &outputs)?;
    let read = |path: &Path| load::read_results(path);
    let [before, after] = [read(places[0])?, read(places[1])?];
    let json = Output::open_if(arguments.json.as_ref())?;
    let settings = CompareSettings {
        relative: arguments.relative,
        noise: arguments.noise,
    };
    let changes = compare(&before, &after, settings).map_err(Failure::usage)?;
    let report = ListedFolder::open_if(arguments.report.as_ref())?;
    let figures = ListedFolder::open_if(arguments.figures.as_ref())?;
    let mut text = TextOutput::new(!arguments.json.as_deref().is_some_and(is_stdout));
    print(&changes, arguments.all, &mut text);
    let mut drawn = Ok(());
    if report.is_some() || figures.is_some() {
        let names = names(places.map(|place| place.as_path()));
        let [before, after] = [(&names[0], &before), (&names[1], &after)]
            .map(|(name, results)| Compared { name, results });
        let page = ReportPage::from_changes(&changes, before, after, &command_line());
        if let Some(folder) = &report {
            drawn = write_report(folder, &page, &changes);
        }
        if let Some(folder) = &figures {
            drawn = drawn.and(paper::write(folder, page.figure_files()));
        }
    }
    if let (Ok(()), Some(folder)) = (&drawn, &arguments.report) {
        let page = folder.join("report.html");
        text.print_line(&hanging_indent("- ", &format!("Report: {}", shown(&page))));
    }
    let mut done = text.finish().and(drawn);
    if let Some(output) = json {
        done = done.and(output.finish(|writer| changes.write_json(writer)));
    }
    done?;
    let is_slower = changes.count(Verdict::Slower) > 0 || changes.slower_as_a_whole().is_some();
    let is_open = changes.count(Verdict::CannotTell) > 0;
    Ok(match arguments.fail_if_slower {
        true if is_slower => ExitCode::from(SLOWER),
        true if is_open => ExitCode::from(CANNOT_TELL),
        _ => ExitCode::SUCCESS,
    })
}

/// Writes the page with its figures, and `changes.json`.
fn write_report(
    folder: &ListedFolder,
    page: &ReportPage,
    changes: &Changes,
) -> Result<(), Failure> {
    let mut json = Vec::new();
    let written = changes.write_json(&mut json);
    written.map_err(|cause| cannot_write("changes.json", &cause))?;
    let mut files = page.files();
    files.push(PaperFile::new("changes.json", json));
    folder.write(files)
}

/// Returns the names of two files or folders, with as many folders above them as make the names
/// different.
fn names(places: [&Path; 2]) -> [String; 2] {
    let places = places.map(|place| path::absolute(place).unwrap_or_else(|_| place.to_owned()));
    let most = places.iter().map(|place| place.components().count()).max();
    let last = |count: usize| {
        places.each_ref().map(|place| {
            let parts = place.components().rev().take(count);
            let mut parts: Vec<_> = parts.map(|part| part.as_os_str()).collect();
            parts.reverse();
            shown(&parts.iter().collect::<PathBuf>())
        })
    };
    let different = (1..=most.unwrap_or(1)).map(last).find(|[a, b]| a != b);
    different.unwrap_or_else(|| last(1))
}

/// Prints the changes: differences of machine and settings, changed times or `all`, and sentences.
pub(crate) fn print(changes: &Changes, all: bool, text: &mut TextOutput) {
    for setting in &changes.environment {
        let first = format!("{:<13}", setting.what);
        let both = format!("{} → {}", setting.before, setting.after);
        text.print_line(&hanging_indent(&first, &both));
    }
    for change in &changes.bytes {
        let (before, after) = (grouped(change.before), grouped(change.after));
        let operation = change.operation.as_ref();
        let operation = operation.map_or(String::new(), |name| format!(" ({name})"));
        text.print_line(&format!(
            "{:<13}{before} bytes → {after} bytes{operation}",
            change.backend
        ));
    }
    let rows: Vec<&Change> = match all {
        true => changes.rows.iter().collect(),
        false => changes.changed().collect(),
    };
    if !rows.is_empty() {
        text.print_line(&changes_table(&rows));
        if rows.iter().any(|row| row.verdict == Verdict::CannotTell) {
            text.print_line("?: cannot be told from chance");
        }
        text.print_line("");
    }
    text.print_list("- ", &changes.sentences);
    for (which, only) in [
        ("first", &changes.only_before),
        ("second", &changes.only_after),
    ] {
        if !only.is_empty() {
            let parts = Measurement::differing_parts(only.iter());
            let name = |measurement| name(measurement, &parts);
            let mut names: Vec<String> = only.iter().take(SHOWN).map(name).collect();
            if only.len() > SHOWN {
                names.push(format!("and {} more", grouped(only.len() - SHOWN)));
            }
            let sentence = format!("Only in the {which} file: {}.", names.join(", "));
            text.print_line(&hanging_indent("- ", &sentence));
        }
    }
}

/// Returns the name of a measurement, such as `build on half-edge (orders, morton)`. Of its mesh, command
/// and case, it has those in `parts`.
fn name(measurement: &Measurement, parts: &[MeasurementPart]) -> String {
    let name = format!("{} on {}", measurement.operation, measurement.backend);
    let parts = parts.iter().map(|(_, of)| of(measurement));
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    match parts[..] {
        [] => name,
        _ => format!("{name} ({})", parts.join(", ")),
    }
}

fn changes_table(rows: &[&Change]) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let columns = Measurement::differing_parts(rows.iter().map(|row| &row.measurement));
    let names = columns.iter().map(|(name, _)| *name);
    let header = names.chain(["operation", "backend"]).map(Cell::new);
    let figures = ["before", "after", "ratio", "95 %"].map(|name| right(name.into()));
    let header = header.chain(figures).chain([Cell::new("")]);
    let mut table = table(header.collect());
    for row in rows {
        let interval = row.ci_low.zip(row.ci_high);
        let interval = interval.map(|(low, high)| format!("{low:.2}–{high:.2}"));
        let verdict = match row.verdict {
            _ if row.other_checksum => "different checksum",
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
            Verdict::Same => "",
            Verdict::CannotTell => "?",
        };
        let place = columns
            .iter()
            .map(|(_, of)| Cell::new(of(&row.measurement)));
        let figures = [
            Cell::new(&row.measurement.operation),
            Cell::new(&row.measurement.backend),
            right(duration(row.before_ns)),
            right(duration(row.after_ns)),
            right(format!("{:.2}", row.ratio)),
            right(interval.unwrap_or_else(|| "–".into())),
            Cell::new(verdict),
        ];
        table.add_row(place.chain(figures).collect::<Vec<Cell>>());
    }
    table.trim_fmt()
}

//! `sixfold compare`: shows what changed between two studies. `--report` writes these files:
//!
//! ```text
//! DIR/report.html                the page, which needs no other file
//! DIR/report.md, DIR/figures     the same in Markdown
//! DIR/changes.json               the changes, as --json writes them
//! DIR/sixfold-files.txt          the names of these files
//! ```

use std::io;
use std::path::{self, Path, PathBuf};
use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment};
use sixfold_report::{Compared, PaperFile, ReportPage};
use sixfold_results::{
    Change, Changes, Confidence, Measurement, MeasurementPart, Verdict, compare,
};

use crate::arguments::{ChangeArgs, Compare};
use crate::failure::Failure;
use crate::listed_folder::ListedFolder;
use crate::load;
use crate::measure::command_line;
use crate::mesh_files::shown;
use crate::output::{Output, cannot_write, check_not_overwritten, check_outputs, uses_stdout};
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
    let options = &arguments.changes;
    let outputs = options.outputs();
    for place in places {
        check_not_overwritten("the results", place, &outputs)?;
        check_not_overwritten("the results", &load::results_path(place), &outputs)?;
    }
    check_outputs(None, &outputs)?;
    let read = |path: &Path| load::read_results(path);
    let [before, after] = [read(places[0])?, read(places[1])?];
    let json = Output::open_if(options.json.as_ref())?;
    let changes = compare(&before, &after, options.settings()).map_err(Failure::usage)?;
    let pages = Pages::open(options)?;
    let mut text = TextOutput::new(!uses_stdout(&outputs));
    print(&changes, options.all, &mut text);
    let names = names(places.map(|place| place.as_path()));
    let drawn = pages.write(
        &mut text,
        || {
            let [before, after] = [(&names[0], &before), (&names[1], &after)]
                .map(|(name, results)| Compared { name, results });
            ReportPage::from_changes(&changes, before, after, &command_line())
        },
        "changes.json",
        |writer| changes.write_json(writer),
    );
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

/// The outputs that are drawn: those of --report, --figures and --markdown.
pub(crate) struct Pages<'a> {
    report: Option<(&'a PathBuf, ListedFolder)>,
    figures: Option<ListedFolder>,
    markdown: Option<Output>,
}

impl<'a> Pages<'a> {
    /// Opens the file, and opens or creates the folders.
    pub(crate) fn open(options: &'a ChangeArgs) -> Result<Self, Failure> {
        let report = ListedFolder::open_if(options.report.as_ref())?;
        Ok(Self {
            report: options.report.as_ref().zip(report),
            figures: ListedFolder::open_if(options.figures.as_ref())?,
            markdown: Output::open_if(options.markdown.as_ref())?,
        })
    }

    /// Writes the page that `draw` returns with its figures and with the file `json_name` of all data, and prints
    /// where it is. Draws nothing if nothing is asked for.
    pub(crate) fn write(
        self,
        text: &mut TextOutput,
        draw: impl FnOnce() -> ReportPage,
        json_name: &str,
        write_json: impl FnOnce(&mut Vec<u8>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        if self.report.is_none() && self.figures.is_none() && self.markdown.is_none() {
            return Ok(());
        }
        let page = draw();
        let mut drawn = Ok(());
        if let Some(output) = self.markdown {
            let tables = page.markdown_tables();
            drawn = output.finish(|writer| writer.write_all(tables.as_bytes()));
        }
        if let Some((path, folder)) = &self.report {
            let mut json = Vec::new();
            write_json(&mut json).map_err(|cause| cannot_write(json_name, &cause))?;
            let mut files = page.files();
            files.push(PaperFile::new(json_name, json));
            let written = folder.write(files);
            if written.is_ok() {
                let line = format!("Report: {}", shown(&path.join("report.html")));
                text.print_line(&hanging_indent("- ", &line));
            }
            drawn = drawn.and(written);
        }
        match &self.figures {
            Some(folder) => drawn.and(paper::write(folder, page.figure_files(None))),
            None => drawn,
        }
    }
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
        text.print_line(&changes_table(&rows, changes.confidence));
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

fn changes_table(rows: &[&Change], confidence: Confidence) -> String {
    let confidence = confidence.to_string();
    let figures = ["before", "after", "ratio", &confidence];
    let lines = rows.iter().map(|row| {
        let figures = [
            duration(row.before_ns),
            duration(row.after_ns),
            format!("{:.2}", row.ratio),
            interval(row.ci_low, row.ci_high),
        ];
        let verdict = match row.verdict {
            _ if row.other_checksum => "different checksum",
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
            Verdict::Same => "",
            Verdict::CannotTell => "?",
        };
        (&row.measurement, figures, verdict.to_owned())
    });
    measurements_table(&figures, "", lines.collect())
}

/// Returns an interval of ratios as text.
pub(crate) fn interval(low: Option<f64>, high: Option<f64>) -> String {
    let ends = low.zip(high);
    ends.map_or("–".into(), |(low, high)| format!("{low:.2}–{high:.2}"))
}

/// Returns a table of measurements with their `figures`, and the words `last`. Mesh, command and case have columns
/// if they differ.
pub(crate) fn measurements_table<const N: usize>(
    figures: &[&str; N],
    last: &str,
    lines: Vec<(&Measurement, [String; N], String)>,
) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let parts = Measurement::differing_parts(lines.iter().map(|(measurement, ..)| *measurement));
    let names = parts.iter().map(|(name, _)| *name);
    let header = names.chain(["operation", "backend"]).map(Cell::new);
    let heads = figures.map(|name| right(name.into()));
    let header = header.chain(heads).chain([Cell::new(last)]);
    let mut table = table(header.collect());
    for (measurement, figures, last) in lines {
        let place = parts.iter().map(|(_, of)| Cell::new(of(measurement)));
        let names = [&measurement.operation, &measurement.backend].map(Cell::new);
        let figures = figures.map(right);
        let cells = place.chain(names).chain(figures).chain([Cell::new(last)]);
        table.add_row(cells.collect::<Vec<Cell>>());
    }
    table.trim_fmt()
}

//! `sixfold history`: shows how times went over saved results. `--report` writes these files:
//!
//! ```text
//! DIR/report.html                the page, which needs no other file
//! DIR/report.md, DIR/figures     the same in Markdown
//! DIR/history.json               all data, as --json writes them
//! DIR/sixfold-files.txt          the names of these files
//! ```

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use sixfold_report::{Compared, ReportPage, date};
use sixfold_results::numbers::duration;
use sixfold_results::{History, HistoryGroup, HistoryPoint, HistoryRow, Results, Verdict};

use crate::arguments;
use crate::column_table::{Column, column_table};
use crate::compare::{Pages, interval, measurements_table};
use crate::failure::Failure;
use crate::load::{read_results, results_path};
use crate::measure::command_line;
use crate::mesh_files::shown;
use crate::output::{Output, check_not_overwritten, check_outputs, uses_stdout};
use crate::text::{TextOutput, hanging_indent, print_notice, sanitize};

/// Maximum number of documents whose signs a row shows.
const COURSE: usize = 12;

pub(crate) fn run(arguments: &arguments::History) -> Result<ExitCode, Failure> {
    let options = &arguments.changes;
    let mut outputs = options.outputs().to_vec();
    outputs.push(("--csv", arguments.csv.as_ref()));
    check_outputs(None, &outputs)?;
    let documents = read_documents(&arguments.results, &outputs)?;
    let named: Vec<(&str, &Results)> = documents.iter().map(|(name, r)| (&**name, r)).collect();
    let history = History::new(&named, options.settings());
    for alone in &history.alone {
        let (name, reason) = (&alone.name, &alone.reason);
        print_notice(&format!("note: {name} is left out: {reason}"));
    }
    if history.groups.is_empty() {
        return Err(Failure::usage(
            "no two documents have a measurement in common, so there is no history: measure the same mesh with the same \
             command again, and keep the results with --json or --save-baseline",
        ));
    }
    let files = [&options.json, &arguments.csv].map(|path| Output::open_if(path.as_ref()));
    let [json, csv] = files;
    let (json, csv) = (json?, csv?);
    let pages = Pages::open(options)?;
    let mut text = TextOutput::new(!uses_stdout(&outputs));
    for (number, group) in history.groups.iter().enumerate() {
        if number > 0 {
            text.print_line("");
        }
        print(group, options.all, &mut text);
    }
    let draw = || {
        let documents = named.iter();
        let documents = documents.map(|&(name, results)| Compared { name, results });
        ReportPage::from_history(&history, &documents.collect::<Vec<_>>(), &command_line())
    };
    let write_json = |writer: &mut Vec<u8>| history.write_json(writer);
    let drawn = pages.write(&mut text, draw, "history.json", write_json);
    let mut done = text.finish().and(drawn);
    if let Some(output) = json {
        done = done.and(output.finish(|writer| history.write_json(writer)));
    }
    if let Some(output) = csv {
        done = done.and(output.finish(|writer| history.write_csv(writer)));
    }
    done.map(|()| ExitCode::SUCCESS)
}

/// Reads the documents in `places`, with their names. One that cannot be read is noted and left out.
///
/// # Errors
///
/// Returns an error if none can be read, or if an output would overwrite one.
fn read_documents(
    places: &[PathBuf],
    outputs: &[(&str, Option<&PathBuf>)],
) -> Result<Vec<(String, Results)>, Failure> {
    let mut documents = Vec::new();
    let mut found = false;
    for place in places {
        for path in candidates(place)? {
            found = true;
            check_not_overwritten("the results", &path, outputs)?;
            check_not_overwritten("the results", &results_path(&path), outputs)?;
            // The names of files in the only folder are short.
            let inside = path.strip_prefix(place).ok().filter(|_| places.len() == 1);
            let name = match inside.filter(|name| *name != Path::new("")) {
                Some(name) => shown(name),
                None => shown(&path),
            };
            match read_results(&path) {
                Ok(results) => documents.push((name, results)),
                Err(failure) => {
                    print_notice(&format!("note: left out: {}", failure.message));
                }
            }
        }
    }
    match (documents.is_empty(), found) {
        (false, _) => Ok(documents),
        (true, true) => Err(Failure::usage(
            "none of the files can be read, for the reasons in the notes above: name a folder with files of --json",
        )),
        (true, false) => Err(Failure::usage(format!(
            "{}: no results in this folder: keep them with --json or --save-baseline",
            shown(&places[0])
        ))),
    }
}

/// Returns the places of documents in a folder, sorted: files that end in `.json`, and folders of `--report`. A file is
/// itself a candidate.
fn candidates(place: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !place.is_dir() {
        return Ok(vec![place.to_owned()]);
    }
    let cannot_list = |cause: std::io::Error| {
        let place = shown(place);
        Failure::usage(format!(
            "{place}: cannot be listed ({cause}): check the permissions"
        ))
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(place).map_err(cannot_list)? {
        let path = entry.map_err(cannot_list)?.path();
        let is_document = match path.is_dir() {
            true => results_path(&path).is_file(),
            false => path.extension().is_some_and(|ending| ending == "json"),
        };
        if is_document {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Prints the documents, the changed times or `all`, and the sentences.
fn print(group: &HistoryGroup, all: bool, text: &mut TextOutput) {
    text.print_line(&documents_table(group));
    let mut known = &Vec::new();
    for (number, document) in (1..).zip(&group.documents) {
        let new = document.environment.iter();
        for change in new.filter(|change| !known.contains(*change)) {
            let line = format!("{}: {} → {}", change.what, change.before, change.after);
            text.print_list("", [format!("document {number}: {}", sanitize(&line))]);
        }
        known = &document.environment;
    }
    text.print_line("");
    let rows = rows(group, all);
    if !rows.is_empty() {
        text.print_line(&rows_table(group, &rows));
        text.print_line(&hanging_indent("", LEGEND));
        text.print_line("");
    }
    text.print_list(
        "- ",
        group.sentences.iter().map(|sentence| sanitize(sentence)),
    );
}

fn documents_table(group: &HistoryGroup) -> String {
    let documents = || group.documents.iter();
    let numbers = (1..=group.documents.len()).map(|number| number.to_string());
    let overall = documents().map(|d| d.overall.map_or("–".into(), |all| format!("{all:.2}")));
    let columns = [
        Column::words("measured", documents().map(|d| date(d.unix_time))),
        Column::words("commit", documents().map(|d| sanitize(&d.commit))),
        Column::figures("all", overall),
        Column::words("results", documents().map(|d| sanitize(&d.name))),
    ];
    column_table(&Column::figures("", numbers), &columns)
}

/// Returns the rows to show: the changed ones, the earliest change first, then all others if `all` is set.
fn rows(group: &HistoryGroup, all: bool) -> Vec<&HistoryRow> {
    let rows = group.rows.iter();
    let mut rows: Vec<&HistoryRow> = rows.filter(|row| all || row.is_changed()).collect();
    rows.sort_by(|a, b| {
        let place = |row: &HistoryRow| (!row.is_changed(), row.since.unwrap_or(usize::MAX));
        let sizes = b.largest_change().total_cmp(&a.largest_change());
        place(a).cmp(&place(b)).then(sizes)
    });
    rows
}

fn rows_table(group: &HistoryGroup, rows: &[&HistoryRow]) -> String {
    let confidence = group.confidence.to_string();
    let figures = ["first", "ratio", &confidence];
    let lines = rows.iter().filter_map(|row| {
        let (first, last) = (row.points.first()?, row.last()?);
        let figures = [
            duration(first.median_ns),
            format!("{:.2}", last.ratio),
            interval(last.ci_low, last.ci_high),
        ];
        Some((&row.measurement, figures, course(group, row)))
    });
    measurements_table(&figures, "course", lines.collect())
}

const LEGEND: &str = "ratio: last time divided by the first. course: a sign for each document: = equal to the first, + \
                      slower, - faster, ? cannot be told, x different work, . not measured. all: median of the ratios \
                      of all times.";

/// Returns a sign for each of the last documents.
fn course(group: &HistoryGroup, row: &HistoryRow) -> String {
    let count = group.documents.len();
    let signs = (1..=count).map(|number| {
        let point = row.points.iter().find(|point| point.document == number);
        point.map_or('.', sign)
    });
    let hidden = count.saturating_sub(COURSE);
    let more = if hidden > 0 { "…" } else { "" };
    format!("{more}{}", signs.skip(hidden).collect::<String>())
}

fn sign(point: &HistoryPoint) -> char {
    match point.verdict {
        _ if point.other_checksum => 'x',
        Verdict::Same => '=',
        Verdict::Slower => '+',
        Verdict::Faster => '-',
        Verdict::CannotTell => '?',
    }
}

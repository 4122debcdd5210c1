//! The page of a history: how times went over several results.

use sixfold_results::numbers::{counted, duration, figure, grouped, times};
use sixfold_results::{
    Finding, History, HistoryDocument, HistoryGroup, HistoryPoint, HistoryRow, Measurement,
};

use crate::changes::{Compared, TABLE_ROWS, verdict_text};
use crate::data::date;
use crate::figure::{Table, TitledTable};
use crate::figures::{history as history_figure, machines};
use crate::{ReportPage, Section, source};

/// Maximum number of documents that have a column in the table of times: the last ones.
const COLUMNS: usize = 12;

impl ReportPage {
    /// Draws how times went over `documents`, of which `history` was made. `command` is the command that draws.
    pub fn from_history(history: &History, documents: &[Compared<'_>], command: &str) -> Self {
        let count: usize = history
            .groups
            .iter()
            .map(|group| group.documents.len())
            .sum();
        let machines = documents.iter().flat_map(|one| {
            let machines = machines(one.results).into_iter();
            machines.map(move |machine| format!("{}: {machine}", one.name))
        });
        let alone = history.alone.iter();
        let alone = alone.map(|alone| format!("{} is left out: {}", alone.name, alone.reason));
        let sections = (1..).zip(&history.groups);
        let sections = sections.map(|(number, group)| section(group, number, documents, command));
        Self {
            title: format!("History of {}", counted(count, "document", "documents")),
            facts: "Documents are in the order in which they were measured.".into(),
            answer: history
                .groups
                .iter()
                .filter_map(|group| group.sentences.first().cloned())
                .collect(),
            command: command.to_owned(),
            machines: machines.collect(),
            warnings: alone.collect(),
            labs: sections.collect(),
            ..Self::default()
        }
    }
}

/// Draws the documents of one group. `number` is its number, from 1.
fn section(
    group: &HistoryGroup,
    number: usize,
    documents: &[Compared<'_>],
    command: &str,
) -> Section {
    let id = format!("history-{number}");
    let mut figures = Vec::from_iter(history_figure::figure(group, &id, command));
    let all = group.documents.iter();
    let findings = all.flat_map(|one| documents[one.place].results.findings.iter());
    let source = source::line(&findings.collect::<Vec<&Finding>>());
    for figure in &mut figures {
        figure.source.clone_from(&source);
    }
    let [first, last] = [group.documents.first(), group.documents.last()];
    let name = |of: Option<&HistoryDocument>| of.map_or_else(String::new, |one| one.name.clone());
    Section {
        title: format!("{} to {}", name(first), name(last)),
        facts: counted(group.documents.len(), "document", "documents"),
        sentences: group.sentences.clone(),
        figures,
        tables: vec![documents_table(group, number)],
        ..Section::default()
    }
}

fn documents_table(group: &HistoryGroup, number: usize) -> TitledTable {
    let mut table = Table::new([
        "document",
        "measured",
        "commit",
        "all times",
        "results",
        "other than in the first",
    ]);
    for (number, document) in (1..).zip(&group.documents) {
        let differences = document.environment.iter();
        let differences = differences.map(|d| format!("{}: {} → {}", d.what, d.before, d.after));
        table.row(vec![
            number.to_string(),
            date(document.unix_time),
            document.commit.clone(),
            document.overall.map_or_else(|| "–".into(), times),
            document.name.clone(),
            differences.collect::<Vec<String>>().join("; "),
        ]);
    }
    TitledTable {
        title: match number {
            1 => "Documents".into(),
            number => format!("Documents, part {number}"),
        },
        caption:
            "`all times` is the median of the ratios of all times to those in the first document."
                .into(),
        table,
    }
}

/// Returns the table of all times: those that changed first, the largest change first.
pub(crate) fn table(group: &HistoryGroup) -> Table {
    let count = group.documents.len();
    let shown = count.saturating_sub(COLUMNS).max(1) + 1..=count;
    let parts = Measurement::differing_parts(group.rows.iter().map(|row| &row.measurement));
    let titles = parts.iter().map(|(title, _)| (*title).to_owned());
    let names = ["operation", "backend"].map(str::to_owned).into_iter();
    let columns = names
        .chain(titles)
        .chain(["time in the first".into(), "since".into()]);
    let mut table = Table::new(columns.chain(shown.clone().map(|number| format!("in {number}"))));
    let mut rows: Vec<&HistoryRow> = group.rows.iter().collect();
    rows.sort_by(|a, b| {
        let sizes = b.largest_change().total_cmp(&a.largest_change());
        b.is_changed().cmp(&a.is_changed()).then(sizes)
    });
    for row in rows.into_iter().take(TABLE_ROWS) {
        let Measurement {
            operation, backend, ..
        } = &row.measurement;
        let mut cells = vec![operation.clone(), backend.clone()];
        cells.extend(parts.iter().map(|(_, of)| of(&row.measurement).to_owned()));
        let first = row.points.first();
        cells.push(first.map_or_else(|| "–".into(), |point| duration(point.median_ns)));
        cells.push(row.since.map_or_else(|| "–".into(), grouped));
        cells.extend(shown.clone().map(|number| {
            let point = row.points.iter().find(|point| point.document == number);
            point.map_or_else(|| "–".into(), cell)
        }));
        table.row(cells);
    }
    table
}

/// Returns a ratio with its interval and its verdict.
fn cell(point: &HistoryPoint) -> String {
    let interval = point.ci_low.zip(point.ci_high);
    let interval = interval.map_or_else(String::new, |(low, high)| {
        format!(" ({} to {})", figure(low), figure(high))
    });
    let verdict = verdict_text(point.verdict, point.other_checksum);
    format!("{}{interval}, {verdict}", figure(point.ratio))
}

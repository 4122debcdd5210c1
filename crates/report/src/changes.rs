//! The page of a comparison: what changed between two results.

use std::collections::BTreeSet;

use sixfold_results::numbers::{counted, duration, figure, grouped, times};
use sixfold_results::{Change, Changes, Finding, Measurement, MeasurementPart, Results, Verdict};

use crate::figure::{Table, TitledTable};
use crate::figures::{changes as changes_figure, file_name, machine, machines, ratios};
use crate::{ReportPage, source};

/// Maximum number of rows of a table. The JSON of the comparison has all.
pub(crate) const TABLE_ROWS: usize = 1000;
/// Maximum number of names in a warning.
const NAMES: usize = 8;

/// One of two compared results, and its name on the page.
#[derive(Clone, Copy, Debug)]
pub struct Compared<'r> {
    /// The name of the file or folder, without the folders above it.
    pub name: &'r str,
    /// The results.
    pub results: &'r Results,
}

impl ReportPage {
    /// Draws what changed between two results. `command` is the command of the comparison.
    pub fn from_changes(
        changes: &Changes,
        before: Compared<'_>,
        after: Compared<'_>,
        command: &str,
    ) -> Self {
        let both = [before, after];
        let ranked = Ranked::new(changes);
        let command = with_recorded_commands(command, both);
        let figures = [
            changes_figure::figure(&ranked, both, &command),
            ratios::figure(&ranked, both, &command),
        ];
        let mut figures: Vec<_> = figures.into_iter().flatten().collect();
        let source = both.map(|one| {
            let findings: Vec<&Finding> = one.results.findings.iter().collect();
            let name = match &states(one)[..] {
                [] => one.name.to_owned(),
                states => format!("{} ({})", one.name, states.join(", ")),
            };
            format!("{name}: {}", source::line(&findings))
        });
        for figure in &mut figures {
            figure.source = source.join(" — ");
        }
        let machines = both.map(|one| {
            let machines = machines(one.results).into_iter();
            machines.map(move |machine| format!("{}: {machine}", one.name))
        });
        let differences = differences(changes, both);
        Self {
            title: format!("What changed: {} → {}", before.name, after.name),
            facts: match differences {
                Some(_) => String::new(),
                None => "The machine, the program and the settings are the same.".into(),
            },
            answer: answer(&ranked),
            command,
            machines: machines.into_iter().flatten().collect(),
            sentences: changes.sentences.clone(),
            warnings: warnings(&ranked, both),
            tables: differences.into_iter().collect(),
            figures,
            appendix: tables(&ranked, both),
            ..Self::default()
        }
    }
}

/// The rows of a comparison, the largest change first.
pub(crate) struct Ranked<'c> {
    pub(crate) changes: &'c Changes,
    /// Rows with different checksums follow the others.
    pub(crate) rows: Vec<&'c Change>,
    /// The parts of measurements that differ between the rows.
    parts: Vec<MeasurementPart>,
}

impl<'c> Ranked<'c> {
    fn new(changes: &'c Changes) -> Self {
        let divisor = changes.divisor();
        let mut rows: Vec<&Change> = changes.rows.iter().collect();
        let size = |row: &Change| (row.ratio / divisor).ln().abs();
        rows.sort_by(|a, b| {
            let places = a.other_checksum.cmp(&b.other_checksum);
            places.then(size(b).total_cmp(&size(a)))
        });
        let parts = Measurement::differing_parts(rows.iter().map(|row| &row.measurement));
        Self {
            changes,
            rows,
            parts,
        }
    }

    /// Iterates over the rows that changed, and those with different checksums.
    pub(crate) fn changed(&self) -> impl Iterator<Item = &'c Change> {
        let changed = |row: &&Change| row.verdict.is_change() || row.other_checksum;
        self.rows.iter().copied().filter(changed)
    }

    /// Counts the rows of the same work with the given verdict.
    fn count(&self, verdict: Verdict) -> usize {
        let same_work = self.rows.iter().filter(|row| !row.other_checksum);
        same_work.filter(|row| row.verdict == verdict).count()
    }

    /// Returns the ratio that is judged: relative to the median of all ratios if this was asked for.
    pub(crate) fn value(&self, row: &Change) -> f64 {
        row.ratio / self.changes.divisor()
    }

    /// Returns the interval of [`Self::value`].
    pub(crate) fn interval(&self, row: &Change) -> Option<[f64; 2]> {
        let (low, high) = row.ci_low.zip(row.ci_high)?;
        Some([low, high].map(|end| end / self.changes.divisor()))
    }

    /// Returns the parts of a measurement that differ: mesh, command and case.
    fn places(&self, measurement: &Measurement) -> Vec<String> {
        let parts = self.parts.iter().map(|(_, of)| file_name(of(measurement)));
        parts
            .filter(|part| !part.is_empty())
            .map(str::to_owned)
            .collect()
    }

    /// Returns the operation and the place, such as `build, bunny.obj`.
    pub(crate) fn operation(&self, measurement: &Measurement) -> String {
        let mut names = vec![measurement.operation.clone()];
        names.extend(self.places(measurement));
        names.join(", ")
    }

    /// Returns the name of a measurement, such as `build on half-edge (bunny.obj)`.
    pub(crate) fn name(&self, measurement: &Measurement) -> String {
        let name = format!("{} on {}", measurement.operation, measurement.backend);
        match &self.places(measurement)[..] {
            [] => name,
            places => format!("{name} ({})", places.join(", ")),
        }
    }

    /// Returns the text that a browser shows for a mark.
    pub(crate) fn mark_title(&self, row: &Change) -> String {
        let interval = self.interval(row);
        let interval = interval.map_or_else(String::new, |[low, high]| {
            format!(" ({} to {})", figure(low), figure(high))
        });
        format!(
            "{}: {}{interval}, {}; {}; {} and {} samples",
            self.name(&row.measurement),
            times(self.value(row)),
            both_times(row),
            verdict_text(row.verdict, row.other_checksum),
            grouped(row.before_samples),
            grouped(row.after_samples)
        )
    }

    /// Returns an empty table of measurements with further columns.
    fn table(&self, more: &[&str]) -> Table {
        let parts = self.parts.iter().map(|(title, _)| *title);
        let names = ["operation", "backend"].into_iter().chain(parts);
        Table::new(names.chain(more.iter().copied()))
    }

    fn cells(&self, measurement: &Measurement) -> Vec<String> {
        let parts = self.parts.iter().map(|(_, of)| of(measurement));
        let names = [&*measurement.operation, &*measurement.backend].into_iter();
        names.chain(parts).map(str::to_owned).collect()
    }

    /// Returns a table of times.
    pub(crate) fn times_table<'t>(&self, rows: impl Iterator<Item = &'t Change>) -> Table {
        let relative = self.changes.relative.then_some("÷ median");
        let mut columns = vec!["before", "after", "after ÷ before"];
        columns.extend(relative);
        let confidence = self.changes.confidence.to_string();
        columns.extend([&*confidence, "can tell", "samples", "verdict"]);
        let mut table = self.table(&columns);
        for row in rows {
            let mut cells = self.cells(&row.measurement);
            cells.extend([
                duration(row.before_ns),
                duration(row.after_ns),
                times(row.ratio),
            ]);
            cells.extend(relative.map(|_| times(self.value(row))));
            let interval = self.interval(row);
            cells.extend([
                interval.map_or_else(
                    || "–".into(),
                    |[low, high]| format!("{} to {}", figure(low), figure(high)),
                ),
                row.detectable.map_or_else(|| "–".into(), times),
                format!(
                    "{} and {}",
                    grouped(row.before_samples),
                    grouped(row.after_samples)
                ),
                verdict_text(row.verdict, row.other_checksum).to_owned(),
            ]);
            table.row(cells);
        }
        table
    }
}

/// Returns both times of a row: `1.20 ms → 1.74 ms`.
pub(crate) fn both_times(row: &Change) -> String {
    format!("{} → {}", duration(row.before_ns), duration(row.after_ns))
}

/// Returns the verdict in words.
pub(crate) fn verdict_text(verdict: Verdict, other_checksum: bool) -> &'static str {
    match verdict {
        _ if other_checksum => "different work",
        Verdict::Faster => "faster",
        Verdict::Slower => "slower",
        Verdict::Same => "equal",
        Verdict::CannotTell => "cannot tell",
    }
}

/// Adds the commands that measured the results, as comments.
fn with_recorded_commands(command: &str, both: [Compared<'_>; 2]) -> String {
    let mut lines = vec![command.to_owned()];
    for one in both {
        let runs = one.results.findings.iter().map(Finding::run);
        let commands: BTreeSet<&str> = runs.filter_map(|run| run.command.as_deref()).collect();
        let one_line = |text: &str| text.replace(['\n', '\r'], " ");
        lines.extend(
            commands
                .into_iter()
                .map(|measured| format!("# {}: {}", one_line(one.name), one_line(measured))),
        );
    }
    lines.join("\n")
}

/// Returns at most three sentences: how many times changed, the largest change, and the overall speed.
fn answer(ranked: &Ranked<'_>) -> Vec<String> {
    let changes = ranked.changes;
    let (slower, faster) = (ranked.count(Verdict::Slower), ranked.count(Verdict::Faster));
    let same = ranked.count(Verdict::Same);
    let open = ranked.count(Verdict::CannotTell);
    let different = ranked.rows.len() - slower - faster - same - open;
    let Some(overall) = changes.overall else {
        return changes.sentences.first().cloned().into_iter().collect();
    };
    let all = counted(ranked.rows.len(), "time", "times");
    let different = match different {
        0 => String::new(),
        n => format!("; {} of different work", are(n)),
    };
    let counts = match slower + faster {
        0 => format!(
            "No change found: of {all}, {} equal and {open} cannot be told{different}.",
            are(same)
        ),
        _ => format!(
            "Changes beyond chance: of {all}, {} slower and {} faster; {} equal and {open} cannot be told{different}.",
            are(slower),
            are(faster),
            are(same)
        ),
    };
    let largest = ranked.changed().find(|row| !row.other_checksum);
    let largest = largest.map(|row| {
        format!(
            "Largest change: {}, {} the time before ({}).",
            ranked.name(&row.measurement),
            times(ranked.value(row)),
            both_times(row)
        )
    });
    let judged = match changes.relative {
        true => "; each ratio is divided by this median before it is judged",
        false => "",
    };
    let overall = format!(
        "Overall: {} the times before (median of all ratios{judged}).",
        times(overall)
    );
    [Some(counts), largest, Some(overall)]
        .into_iter()
        .flatten()
        .collect()
}

/// Returns `1 is` or `3 are`.
fn are(count: usize) -> String {
    counted(count, "is", "are")
}

/// Returns what is unusual about the results as a whole: interrupted, partial or mixed.
fn states(one: Compared<'_>) -> Vec<&'static str> {
    let results = one.results;
    let partial = !results.failures.is_empty() || results.missing().next().is_some();
    let states = [
        (results.is_interrupted(), "interrupted"),
        (partial, "partial"),
        (machine_count(results) > 1, "mixed"),
    ];
    let states = states.into_iter().filter(|(is, _)| *is);
    states.map(|(_, state)| state).collect()
}

/// Counts the machines and programs that measured the results.
fn machine_count(results: &Results) -> usize {
    let runs = results.findings.iter().map(Finding::run);
    let machines: BTreeSet<String> = runs.map(|run| machine(&run.environment)).collect();
    machines.len()
}

/// Returns what the results lack, and what makes their comparison doubtful.
fn warnings(ranked: &Ranked<'_>, both: [Compared<'_>; 2]) -> Vec<String> {
    let mut warnings: Vec<String> = both.into_iter().flat_map(incomplete).collect();
    let changes = ranked.changes;
    let only = [&changes.only_before, &changes.only_after];
    for (one, only) in both.into_iter().zip(only) {
        warnings.extend(only_in(one, only));
    }
    let different = ranked.rows.iter().filter(|row| row.other_checksum);
    let different: Vec<String> = different.map(|row| ranked.name(&row.measurement)).collect();
    if !different.is_empty() {
        warnings.push(format!(
            "Different checksums: the two measurements did different work, so their times are not counted as changes: {}.",
            some_of(&different)
        ));
    }
    let few = ranked
        .rows
        .iter()
        .filter(|row| ranked.interval(row).is_none());
    let few = few.count();
    if few > 0 {
        warnings.push(format!(
            "Few samples: {} of {} have fewer than three samples in one of the files, so they have no interval, and only \
             a ratio above 2 or below 1/2 counts as a change.",
            grouped(few),
            counted(ranked.rows.len(), "time", "times")
        ));
    }
    for one in both {
        let own = one.results.findings.iter().flat_map(Finding::warnings);
        warnings.extend(own.map(|warning| format!("{}: {warning}", one.name)));
    }
    warnings
}

/// Says what one of the results lacks as a whole.
fn incomplete(one: Compared<'_>) -> Vec<String> {
    let Compared { name, results } = one;
    let mut warnings = Vec::new();
    if results.is_interrupted() {
        warnings.push(format!(
            "{name} was interrupted: some of its results are missing or have fewer samples."
        ));
    }
    let failures: Vec<&str> = results.failures.iter().map(|f| &*f.mesh).collect();
    if !failures.is_empty() {
        warnings.push(format!(
            "{name} is partial: it has no results of {}.",
            some_of(&failures)
        ));
    }
    let missing: Vec<&str> = results.missing().collect();
    if !missing.is_empty() {
        let meshes = counted(results.planned.len(), "mesh", "meshes");
        warnings.push(format!(
            "{name} is partial: {} of {meshes} not studied yet: {}.",
            grouped(missing.len()),
            some_of(&missing)
        ));
    }
    let machines = machine_count(results);
    if machines > 1 {
        warnings.push(format!(
            "{name} is mixed: its results are from {machines} machines or programs."
        ));
    }
    warnings
}

/// Says which measurements only one of the results has.
fn only_in(one: Compared<'_>, only: &[Measurement]) -> Option<String> {
    let meshes: BTreeSet<&str> = only.iter().map(|m| file_name(&m.mesh)).collect();
    let meshes: Vec<&str> = meshes.into_iter().filter(|mesh| !mesh.is_empty()).collect();
    let of = match &meshes[..] {
        [] => String::new(),
        meshes => format!(" of {}", some_of(meshes)),
    };
    (!only.is_empty()).then(|| {
        let count = counted(only.len(), "measurement", "measurements");
        format!("Only {} has {count}{of}, which a table lists.", one.name)
    })
}

/// Joins names, and says how many are left out.
fn some_of(names: &[impl AsRef<str>]) -> String {
    let shown: Vec<&str> = names.iter().take(NAMES).map(AsRef::as_ref).collect();
    match names.len() - shown.len() {
        0 => shown.join(", "),
        more => format!("{} and {} more", shown.join(", "), grouped(more)),
    }
}

fn differences(changes: &Changes, [before, after]: [Compared<'_>; 2]) -> Option<TitledTable> {
    let mut table = Table::new(["", before.name, after.name]);
    for change in &changes.environment {
        table.row(vec![
            change.what.to_owned(),
            change.before.clone(),
            change.after.clone(),
        ]);
    }
    (!table.rows.is_empty()).then(|| TitledTable {
        title: "Differences of machine, program and settings".into(),
        caption: "Everything else that is recorded is the same.".into(),
        table,
    })
}

/// Returns the tables after the figures: all times, bytes, fastest backends, and what only one has.
fn tables(ranked: &Ranked<'_>, [before, after]: [Compared<'_>; 2]) -> Vec<TitledTable> {
    let changes = ranked.changes;
    let mut tables = vec![times_table(ranked)];
    let mut bytes = Table::new([
        "backend",
        "mesh",
        "bytes of",
        "before",
        "after",
        "after ÷ before",
    ]);
    for change in changes.bytes.iter().take(TABLE_ROWS) {
        let ratio = change.after as f64 / change.before as f64;
        bytes.row(vec![
            change.backend.clone(),
            change.mesh.clone(),
            change
                .operation
                .clone()
                .unwrap_or_else(|| "the structure".into()),
            grouped(change.before),
            grouped(change.after),
            times(ratio),
        ]);
    }
    let all = changes.bytes.len();
    tables.push(titled(
        "Bytes that differ",
        "Counts of bytes are exact.",
        bytes,
        all,
    ));
    let mut winners = Table::new(["operation", "mesh", "fastest before", "fastest after"]);
    for winner in changes.winners.iter().take(TABLE_ROWS) {
        winners.row(vec![
            winner.operation.clone(),
            winner.mesh.clone(),
            winner.before.clone(),
            winner.after.clone(),
        ]);
    }
    let all = changes.winners.len();
    let about = "Operations of a study whose single fastest backend is another one.";
    tables.push(titled("New fastest backends", about, winners, all));
    let only = [(before, &changes.only_before), (after, &changes.only_after)];
    for (one, measurements) in only {
        let mut table = Table::new(["operation", "backend", "mesh", "command", "case"]);
        for m in measurements.iter().take(TABLE_ROWS) {
            let cells = [&*m.operation, &m.backend, &m.mesh, m.kind, &m.case];
            table.row(cells.map(str::to_owned).to_vec());
        }
        let title = format!("Only in {}", one.name);
        let about = "Measurements that the other file does not have, so they are not compared.";
        tables.push(titled(&title, about, table, measurements.len()));
    }
    tables.retain(|table| !table.table.rows.is_empty());
    tables
}

/// Returns the table of all times, the largest change first.
fn times_table(ranked: &Ranked<'_>) -> TitledTable {
    let about = "The largest change first; times of different work are last. A change counts if it is larger than \
                 chance explains. `can tell` is the smallest change that could be told from chance.";
    let rows = ranked.rows.iter().copied().take(TABLE_ROWS);
    let table = ranked.times_table(rows);
    titled("All compared times", about, table, ranked.rows.len())
}

/// Returns a table with a caption that says how many of `all` rows are left out.
fn titled(title: &str, about: &str, table: Table, all: usize) -> TitledTable {
    let more = match all - table.rows.len() {
        0 => String::new(),
        more => format!(" {} more are in the JSON of the comparison.", grouped(more)),
    };
    TitledTable {
        title: title.to_owned(),
        caption: format!("{about}{more}"),
        table,
    }
}

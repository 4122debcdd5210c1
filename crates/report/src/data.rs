//! The data of a figure as CSV, and how the data were measured.

pub(crate) mod rows;

use serde::Serialize;
use sixfold_study::numbers::grouped;
use sixfold_study::{Figure as TimeRow, Run, write_csv_rows};

use crate::figures::machine;

/// The data of a figure, and how they were measured.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FigureData {
    /// The data as CSV: a header, and one row for each mark. Numbers are plain decimals, and the names
    /// of the columns have the units. Figures of times have the columns of
    /// [`Results::write_csv`](sixfold_study::Results::write_csv).
    pub csv: String,
    /// Lines that state the number of samples, the date, the settings and the machine.
    pub measured: Vec<String>,
}

impl FigureData {
    /// Returns the data of a figure of times. `kind` is the name of the command that measured them.
    pub(crate) fn from_times<'r>(
        kind: &str,
        run: &Run,
        rows: impl IntoIterator<Item = TimeRow<'r>>,
    ) -> Self {
        let rows: Vec<TimeRow<'_>> = rows.into_iter().collect();
        let measured_rows = rows.iter().filter(|row| row.is_measured());
        let samples = measured_rows.map(|row| row.row.samples);
        let measured = measured([run], samples);
        let mut csv = Vec::new();
        write_csv_rows(&mut csv, kind, rows).expect("memory can be written");
        Self {
            csv: into_text(csv),
            measured,
        }
    }

    /// Returns the data of a figure with columns of its own. The fields of a row are the columns.
    /// `samples` has the number of samples of each time; empty if this number is unknown.
    pub(crate) fn from_rows<'r, R: Serialize>(
        runs: impl IntoIterator<Item = &'r Run>,
        samples: impl IntoIterator<Item = usize>,
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        let mut lines = csv::Writer::from_writer(Vec::new());
        for row in rows {
            lines.serialize(row).expect("the fields are plain values");
        }
        let csv = lines.into_inner().expect("memory can be written");
        Self {
            csv: into_text(csv),
            measured: measured(runs, samples),
        }
    }
}

fn into_text(csv: Vec<u8>) -> String {
    String::from_utf8(csv).expect("the fields are UTF-8")
}

/// Returns lines that state the number of samples, the date, the settings and the machine.
fn measured<'r>(
    runs: impl IntoIterator<Item = &'r Run>,
    samples: impl IntoIterator<Item = usize>,
) -> Vec<String> {
    let runs: Vec<&Run> = runs.into_iter().collect();
    let mut lines = Vec::new();
    let samples: Vec<usize> = samples.into_iter().filter(|&count| count > 0).collect();
    if let (Some(&fewest), Some(&most)) = (samples.iter().min(), samples.iter().max()) {
        lines.push(match fewest == most {
            true => format!("Samples of each time: {fewest}"),
            false => format!("Samples of each time: {fewest} to {}", grouped(most)),
        });
    }
    let times = runs.iter().map(|run| run.start.unix_time);
    let times: Vec<u64> = times.filter(|&time| time > 0).collect();
    if let (Some(&first), Some(&last)) = (times.iter().min(), times.iter().max()) {
        lines.push(format!("Measured: {}", dates(first, last)));
    }
    let distinct = |name: &str, text: &dyn Fn(&Run) -> String| {
        let mut texts: Vec<String> = Vec::new();
        for run in &runs {
            let text = text(run);
            if !texts.contains(&text) {
                texts.push(text);
            }
        }
        (!texts.is_empty()).then(|| format!("{name}: {}", texts.join(", ")))
    };
    lines.extend(distinct("Budget or rounds", &|run| {
        run.settings.effort_text()
    }));
    lines.extend(distinct("Seed", &|run| run.settings.seed.to_string()));
    lines.extend(distinct("Machine", &|run| machine(&run.environment)));
    lines
}

/// Formats a range of times in seconds since 1970: `2026-11-27`, or `2026-11-27 to 2026-11-28`.
pub(crate) fn dates(first: u64, last: u64) -> String {
    match (date(first), date(last)) {
        (first, last) if first == last => format!("{first} (UTC)"),
        (first, last) => format!("{first} to {last} (UTC)"),
    }
}

/// Formats a time in seconds since 1970 as a date of the Gregorian calendar: `2026-11-27`.
fn date(unix_time: u64) -> String {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut days = unix_time / 86_400;
    // 400 years have 146,097 days, so the loop has at most 400 steps.
    let mut year = 1970 + 400 * (days / 146_097);
    days %= 146_097;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (unix_time, expected) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_735_689_599, "2024-12-31"),
            (1_735_689_600, "2025-01-01"),
            (13_574_563_200, "2400-02-29"),
        ] {
            assert_eq!(date(unix_time), expected, "{unix_time}");
        }
        assert_eq!(dates(0, 86_399), "1970-01-01 (UTC)");
        assert_eq!(dates(0, 86_400), "1970-01-01 to 1970-01-02 (UTC)");
    }
}

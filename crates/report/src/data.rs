//! The data of a figure as CSV, for other programs.

pub(crate) mod rows;

use serde::Serialize;
use sixfold_results::{Figure as TimeRow, write_csv_rows};

/// Returns the data of a figure of times. `kind` is the name of the command that measured them.
fn times<'r>(kind: &str, rows: impl IntoIterator<Item = TimeRow<'r>>) -> String {
    let mut csv = Vec::new();
    write_csv_rows(&mut csv, kind, rows).expect("memory can be written");
    into_text(csv)
}

/// Returns the data of a figure with columns of its own. The fields of a row are the columns.
pub(crate) fn own_columns<R: Serialize>(rows: impl IntoIterator<Item = R>) -> String {
    let mut lines = csv::Writer::from_writer(Vec::new());
    for row in rows {
        lines.serialize(row).expect("the fields are plain values");
    }
    into_text(lines.into_inner().expect("memory can be written"))
}

/// Returns CSV in memory as text.
pub(crate) fn into_text(csv: Vec<u8>) -> String {
    String::from_utf8(csv).expect("the fields are UTF-8")
}

/// Formats a range of times in seconds since 1970: `2026-11-27`, or `2026-11-27 to 2026-11-28`.
pub(crate) fn dates(first: u64, last: u64) -> String {
    match (date(first), date(last)) {
        (first, last) if first == last => format!("{first} (UTC)"),
        (first, last) => format!("{first} to {last} (UTC)"),
    }
}

/// Formats a time in seconds since 1970 as a date of the Gregorian calendar: `2026-11-27`.
pub fn date(unix_time: u64) -> String {
    // The calendar repeats itself every 400 years. A year begins in March here, so the leap day is its last
    // day, and the months have the lengths 31 30 31 30 31, 31 30 31 30 31, 31 ….
    const DAYS: u64 = 400 * 365 + 97;
    let days = unix_time / 86_400 + 719_468; // since 1 March of the year 0
    let (cycle, day) = (days / DAYS, days % DAYS);
    let year = (day - day / 1460 + day / 36_524 - day / (DAYS - 1)) / 365;
    let day_of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * month + 2) / 5 + 1;
    let (month, next_year) = match month {
        0..10 => (month + 3, 0),
        _ => (month - 9, 1),
    };
    let year = 400 * cycle + year + next_year;
    format!("{year:04}-{month:02}-{day_of_month:02}")
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
        // The largest number is no time of a measurement, but a document may have it.
        assert_eq!(date(u64::MAX), "584554051223-11-09");
        assert_eq!(dates(0, 86_399), "1970-01-01 (UTC)");
        assert_eq!(dates(0, 86_400), "1970-01-01 to 1970-01-02 (UTC)");
    }
}

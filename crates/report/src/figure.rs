//! One figure with its table of numbers.

use sixfold_results::numbers::grouped;

use crate::Picture;

/// A figure, and a table of the numbers that the figure shows.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name of the figure in links and file names, such as `heat-map`.
    pub id: String,
    /// Title.
    pub title: String,
    /// Text that explains how to read the figure.
    pub caption: String,
    /// The picture.
    pub picture: Picture,
    /// The numbers of the figure, formatted.
    pub table: Table,
    /// The data of the figure as CSV, for other programs: a header, and one row for each mark. Numbers
    /// are plain decimals, and the names of the columns have the units. Figures of times have the columns
    /// of [`Results::write_csv`](sixfold_results::Results::write_csv).
    pub csv: String,
    /// How many samples, when, with which seed, on which machine; empty until the page is complete.
    pub source: String,
    /// The command that reproduces the figure.
    pub command: String,
}

impl Figure {
    /// Returns the picture as an SVG file, which follows the dark mode of the reader.
    pub fn svg(&self) -> String {
        self.picture.svg(&self.caption)
    }

    pub(crate) fn with_csv(self, csv: String) -> Self {
        Self { csv, ..self }
    }
}

/// A table of numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Column titles. The first column has the names of the rows.
    pub header: Vec<String>,
    /// The rows. Each row is as long as the header.
    pub rows: Vec<Vec<String>>,
    /// For each row, the part of the page that its first cell links to. Empty if there are no links.
    pub links: Vec<String>,
}

/// A table that stands on the page without a figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TitledTable {
    /// Title.
    pub title: String,
    /// Text that explains the columns.
    pub caption: String,
    /// The numbers.
    pub table: Table,
}

impl Table {
    pub(crate) fn new(header: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self {
            header: header.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
            links: Vec::new(),
        }
    }

    pub(crate) fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Adds a row whose first cell links to the part `target` of the page. All rows of the table must have
    /// links.
    pub(crate) fn linked_row(&mut self, cells: Vec<String>, target: String) {
        self.row(cells);
        self.links.push(target);
    }
}

/// Formats a power of ten of nanoseconds for an axis: `1 ns`, `100 µs`.
pub(crate) fn duration_tick(ns: f64) -> String {
    let units = [(1e9, "s"), (1e6, "ms"), (1e3, "µs")];
    let unit = units.into_iter().find(|(size, _)| ns >= 0.999 * size);
    let (size, unit) = unit.unwrap_or((1.0, "ns"));
    match ns / size {
        each if each >= 0.999 => format!("{} {unit}", grouped(each.round() as usize)),
        each => format!("{each} {unit}"),
    }
}

/// Formats a power of ten of bytes for an axis: `10 B`, `1 kB`.
pub(crate) fn byte_tick(bytes: f64) -> String {
    let units = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let unit = units.into_iter().find(|(size, _)| bytes >= 0.999 * size);
    let (size, unit) = unit.unwrap_or((1.0, "B"));
    format!("{} {unit}", grouped((bytes / size).round() as usize))
}

/// Formats a power of ten for an axis: `1`, `10,000`, `1 M`.
pub(crate) fn count_tick(count: f64) -> String {
    match count.round() {
        count if count < 1e6 => grouped(count as usize),
        count if count < 1e9 => format!("{} M", grouped((count / 1e6).round() as usize)),
        count => format!("{} G", grouped((count / 1e9).round() as usize)),
    }
}

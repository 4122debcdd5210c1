//! Tables that are given as columns of text. A table that is too wide becomes several tables.

use comfy_table::{Cell, CellAlignment};

use crate::tables::{stacked, unbroken};
use crate::text::width;
use sixfold_results::numbers::figure;

/// A column of a table: a heading, and a cell for each row.
pub(crate) struct Column {
    head: String,
    cells: Vec<String>,
    alignment: CellAlignment,
}

impl Column {
    /// Returns a column of words.
    pub(crate) fn words(head: &str, cells: impl IntoIterator<Item = String>) -> Self {
        Self {
            head: head.to_owned(),
            cells: cells.into_iter().collect(),
            alignment: CellAlignment::Left,
        }
    }

    /// Returns a column of figures.
    pub(crate) fn figures(head: &str, cells: impl IntoIterator<Item = String>) -> Self {
        Self {
            alignment: CellAlignment::Right,
            ..Self::words(head, cells)
        }
    }
}

/// Returns a table with the columns `names` and `columns`. If it is wider than the terminal, the
/// columns move closer together. If this is not sufficient, the columns are divided into several
/// tables below one another, each with `names`.
pub(crate) fn column_table(names: &Column, columns: &[Column]) -> String {
    let wide = part(names, columns, 1);
    let fits = wide.lines().all(|line| line.chars().count() <= width());
    match fits {
        true => wide,
        false => stacked(columns, |columns| part(names, columns, 0)),
    }
}

/// Returns a table of some columns, with `padding` spaces before each column, in addition to the
/// space of the style.
fn part(names: &Column, columns: &[Column], padding: u16) -> String {
    let all = || std::iter::once(names).chain(columns);
    let cell = |text: &String, column: &Column| Cell::new(text).set_alignment(column.alignment);
    let header = all().map(|column| cell(&column.head, column));
    let mut table = unbroken(header.collect(), false);
    for row in 0..names.cells.len() {
        let cells = all().map(|column| cell(&column.cells[row], column));
        table.add_row(cells.collect::<Vec<_>>());
    }
    for (i, _) in all().enumerate() {
        if let Some(column) = table.column_mut(i) {
            column.set_padding((if i == 0 { 0 } else { padding }, 0));
        }
    }
    table.trim_fmt()
}

/// Formats a number like [`figure`], but 0 as `0`, and smaller numbers than 0.0005 as `<.001`.
pub(crate) fn short_figure(number: f64) -> String {
    match number {
        0.0 => "0".into(),
        n if n < 0.000_5 => "<.001".into(),
        n => figure(n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_thousands_separators() {
        let numbers = [0.0, 0.0004, 0.0521, 7.0, 999.4, 999.6, 60_480.0, 3.63e6];
        let expected = [
            "0",
            "<.001",
            "0.0521",
            "7.00",
            "999",
            "1,000",
            "60,500",
            "3,630,000",
        ];
        assert_eq!(numbers.map(short_figure), expected);
    }

    #[test]
    fn a_wide_table_is_divided() {
        let cells = || ["1".repeat(width() / 3), "2".into()];
        let column = |head| Column::figures(head, cells());
        let names = Column::words("name", ["a", "b"].map(str::to_owned));
        let one = column_table(&names, &[column("x"), column("y")]);
        assert_eq!(one.lines().count(), 2 + 2, "{one}");
        let two = column_table(&names, &[column("x"), column("y"), column("z")]);
        assert_eq!(two.matches("name").count(), 2, "{two}");
        assert!(two.lines().all(|line| line.chars().count() <= width()));
    }
}

//! Tables that are given as columns of text. A table that is too wide becomes several tables.

use crate::command::text::width;
use sixfold_results::numbers::figure;

/// A column of a table: a heading, and a cell for each row.
pub struct Column {
    head: String,
    cells: Vec<String>,
    /// Whether the cells are at the right, as figures are.
    right: bool,
}

impl Column {
    /// Returns a column of words.
    pub fn words(head: &str, cells: impl IntoIterator<Item = String>) -> Self {
        Self {
            head: head.to_owned(),
            cells: cells.into_iter().collect(),
            right: false,
        }
    }

    /// Returns a column of figures.
    pub fn figures(head: &str, cells: impl IntoIterator<Item = String>) -> Self {
        Self {
            right: true,
            ..Self::words(head, cells)
        }
    }
}

/// Returns a table with the columns `names` and `columns`. If it is wider than the terminal, the
/// columns move closer together. If this is not sufficient, the columns are divided into several
/// tables below one another, each with `names`.
pub fn column_table(names: &Column, columns: &[Column]) -> String {
    let wide = part(names, columns, 1);
    let fits = wide.lines().all(|line| line.chars().count() <= width());
    match fits {
        true => wide,
        false => stacked(columns, |columns| part(names, columns, 0)),
    }
}

/// Returns a table of some columns, with `padding` spaces before each column, in addition to one space. Cells may have
/// several lines.
fn part(names: &Column, columns: &[Column], padding: usize) -> String {
    let all = || std::iter::once(names).chain(columns);
    let width = |column: &Column| {
        let cells = std::iter::once(&column.head).chain(&column.cells);
        let widths = cells.flat_map(|cell| cell.lines().map(|line| line.chars().count()));
        widths.max().unwrap_or(0)
    };
    let widths: Vec<usize> = all().map(width).collect();
    let gap = " ".repeat(1 + padding);
    let row = |cells: &[&str]| -> Vec<String> {
        let height = cells.iter().map(|cell| cell.lines().count()).max();
        let line = |number: usize| {
            let texts = cells
                .iter()
                .map(|cell| cell.lines().nth(number).unwrap_or(""));
            let padded = texts
                .zip(all())
                .zip(&widths)
                .map(|((text, column), &width)| match column.right {
                    true => format!("{text:>width$}"),
                    false => format!("{text:<width$}"),
                });
            padded.collect::<Vec<_>>().join(&gap).trim_end().to_owned()
        };
        (0..height.unwrap_or(0).max(1)).map(line).collect()
    };
    let heads: Vec<&str> = all().map(|column| &*column.head).collect();
    let mut lines = row(&heads);
    lines.push("─".repeat(widths.iter().sum::<usize>() + gap.len() * (widths.len() - 1)));
    for place in 0..names.cells.len() {
        let cells: Vec<&str> = all().map(|column| &*column.cells[place]).collect();
        lines.extend(row(&cells));
    }
    lines.join("\n")
}

/// Returns the table that `table` makes of all columns. If this table is wider than the terminal,
/// returns several tables below one another, each with some of the columns.
pub fn stacked<C>(columns: &[C], mut table: impl FnMut(&[C]) -> String) -> String {
    for parts in 1..=columns.len() {
        let size = columns.len().div_ceil(parts);
        let tables: Vec<String> = columns.chunks(size).map(&mut table).collect();
        let fits = |table: &String| table.lines().all(|line| visible_width(line) <= width());
        if size == 1 || tables.iter().all(fits) {
            return tables.join("\n\n");
        }
    }
    table(columns)
}

/// Returns the number of columns of a line, without escape sequences for bold text.
fn visible_width(line: &str) -> usize {
    let mut parts = line.split('\u{1b}');
    let first = parts.next().map_or(0, |part| part.chars().count());
    let after = |part: &str| {
        part.split_once('m')
            .map_or(0, |(_, text)| text.chars().count())
    };
    first + parts.map(after).sum::<usize>()
}

/// Formats a number like [`figure`], but 0 as `0`, and smaller numbers than 0.0005 as `<.001`.
pub fn short_figure(number: f64) -> String {
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

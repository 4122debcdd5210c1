//! Tables of words and figures.

use comfy_table::{Cell, ContentArrangement, Table};
use sixfold::structure_infos;

use crate::results_table::STYLE;
use crate::text::width;

/// Returns an empty table with `header`. Cells break only if the table is wider than the terminal.
pub(crate) fn table(header: Vec<Cell>) -> Table {
    let mut table = Table::new();
    table
        .load_style(STYLE)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(width() as u16)
        .force_no_tty()
        .set_header(header);
    table
}

/// Returns an empty table of figures with `header`. If `bold` is set, cells can be bold.
pub(crate) fn styled(header: Vec<Cell>, bold: bool) -> Table {
    let mut table = table(header);
    if bold {
        table.enforce_styling();
    }
    if let Some(names) = table.column_mut(0) {
        names.set_padding((0, 1));
    }
    table
}

/// Returns the table that `table` makes of all columns. If this table is wider than the terminal,
/// returns several tables below one another, each with some of the columns.
pub(crate) fn stacked<C>(columns: &[C], mut table: impl FnMut(&[C]) -> String) -> String {
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

/// Returns an empty table of figures with `header` whose cells never break. Use it with [`stacked`].
pub(crate) fn unbroken(header: Vec<Cell>, bold: bool) -> Table {
    let mut table = styled(header, bold);
    table.set_content_arrangement(ContentArrangement::Disabled);
    table
}

/// Returns an empty table with a column per backend. `rows` is the heading of the first column.
pub(crate) fn table_of_backends(rows: &str) -> Table {
    let backends = structure_infos();
    let names = backends.iter().map(|backend| backend.name);
    let broken = names.map(|name| Cell::new(name.replace('-', "\n")));
    let mut table = table([Cell::new(rows)].into_iter().chain(broken).collect());
    // With this padding, the longest names of edits fit into 80 columns of text.
    for column in table.column_iter_mut() {
        column.set_padding((0, 0));
    }
    table
}

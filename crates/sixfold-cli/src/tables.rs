//! Tables of words and figures.

use comfy_table::{Cell, ContentArrangement, Table};
use sixfold::structure_infos;

use crate::results_table::STYLE;
use crate::text::width;
pub(crate) use sixfold_measure::command::column_table::stacked;

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

//! Cells of tables with figures that have signs.

use comfy_table::{Attribute, Cell, CellAlignment};

pub(crate) use sixfold_measure::command::signs::Signs;

/// Returns a cell of `text`, which is bold if it is a figure of the best backend and `signs` are bold.
pub(crate) fn signed(signs: &Signs, text: String) -> Cell {
    let is_best = text.starts_with('*');
    let cell = right(text);
    match signs.is_bold() && is_best {
        true => cell.add_attribute(Attribute::Bold),
        false => cell,
    }
}

/// Returns a cell whose text is at the right.
pub(crate) fn right(text: impl Into<String>) -> Cell {
    Cell::new(text.into()).set_alignment(CellAlignment::Right)
}

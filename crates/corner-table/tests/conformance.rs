//! The corner table keeps every law of the trait.

conformance::suite!(corner_table::CornerTable);
conformance::refine_suite!(corner_table::CornerTable);
conformance::edit_suite!(corner_table::EditableCornerTable);

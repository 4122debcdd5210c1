//! The corner table keeps every law of the trait.

conformance::suite!(corner_table::CornerTable);

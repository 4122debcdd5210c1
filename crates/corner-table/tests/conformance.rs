//! The conformance tests for the corner table.

sixfold_conformance::suite!(sixfold_corner_table::CornerTable);
sixfold_conformance::refine_suite!(sixfold_corner_table::CornerTable);
sixfold_conformance::edit_suite!(sixfold_corner_table::EditableCornerTable);
sixfold_conformance::walk_suite!(
    sixfold_corner_table::CornerTable,
    sixfold_corner_table::EditableCornerTable
);

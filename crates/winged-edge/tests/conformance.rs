//! The laws of `conformance`, on this structure.

conformance::suite!(winged_edge::WingedEdgeMesh);
conformance::refine_suite!(winged_edge::WingedEdgeMesh);
conformance::edit_suite!(winged_edge::EditableWingedEdgeMesh);

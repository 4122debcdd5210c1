//! The conformance tests for the winged-edge mesh.

sixfold_conformance::suite!(sixfold_winged_edge::WingedEdgeMesh);
sixfold_conformance::refine_suite!(sixfold_winged_edge::WingedEdgeMesh);
sixfold_conformance::edit_suite!(sixfold_winged_edge::EditableWingedEdgeMesh);
sixfold_conformance::walk_suite!(
    sixfold_winged_edge::WingedEdgeMesh,
    sixfold_winged_edge::EditableWingedEdgeMesh
);

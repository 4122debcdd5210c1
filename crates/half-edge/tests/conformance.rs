//! The conformance tests for the half-edge mesh.

sixfold_conformance::suite!(sixfold_half_edge::HalfEdgeMesh);
sixfold_conformance::refine_suite!(sixfold_half_edge::HalfEdgeMesh);
sixfold_conformance::edit_suite!(sixfold_half_edge::EditableHalfEdgeMesh);
sixfold_conformance::walk_suite!(
    sixfold_half_edge::HalfEdgeMesh,
    sixfold_half_edge::EditableHalfEdgeMesh
);

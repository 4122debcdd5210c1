//! The laws of `conformance`, on this structure.

conformance::suite!(half_edge::HalfEdgeMesh);
conformance::refine_suite!(half_edge::HalfEdgeMesh);
conformance::edit_suite!(half_edge::EditableHalfEdgeMesh);

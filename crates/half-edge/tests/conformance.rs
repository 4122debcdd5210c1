//! The laws of `conformance`, on this structure.

conformance::suite!(half_edge::HalfEdgeMesh);

conformance::suite!(half_edge::HalfEdgeMesh);

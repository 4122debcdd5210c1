//! The laws of `conformance`, on this structure.

conformance::suite!(face_vertex::FaceVertexMesh);
conformance::refine_suite!(face_vertex::FaceVertexMesh);
conformance::edit_suite!(face_vertex::EditableFaceVertexMesh);

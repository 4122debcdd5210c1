//! The conformance tests for the face-vertex mesh.

sixfold_conformance::suite!(sixfold_face_vertex::FaceVertexMesh);
sixfold_conformance::refine_suite!(sixfold_face_vertex::FaceVertexMesh);
sixfold_conformance::edit_suite!(sixfold_face_vertex::EditableFaceVertexMesh);
sixfold_conformance::walk_suite!(
    sixfold_face_vertex::FaceVertexMesh,
    sixfold_face_vertex::EditableFaceVertexMesh
);

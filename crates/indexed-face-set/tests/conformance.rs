//! The conformance tests for the indexed face set.

sixfold_conformance::suite!(sixfold_indexed_face_set::IndexedFaceSet);
sixfold_conformance::edit_suite!(sixfold_indexed_face_set::EditableIndexedFaceSet);

//! The laws of `conformance`, on this structure.

conformance::suite!(indexed_face_set::IndexedFaceSet);
conformance::edit_suite!(indexed_face_set::EditableIndexedFaceSet);

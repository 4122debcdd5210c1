//! The proof, proved: the suite passes a sound structure, fails every flawed one, and its random
//! meshes are what they claim to be.

mod bites;
mod face_and_edge_lists;
mod flawed;
mod strategies;

/// A structure of one file, sound and slow.
mod sound {
    conformance::suite!(crate::face_and_edge_lists::FaceAndEdgeLists);
}

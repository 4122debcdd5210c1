//! Tests of the suite itself. The suite passes for a correct structure and fails for every flawed
//! structure. The random meshes have the documented properties.

mod detection;
mod face_and_edge_lists;
mod face_and_edge_walk;
mod flawed;
mod strategies;
mod triangulation;

/// The suite for a correct and slow structure.
mod correct {
    sixfold_conformance::suite!(crate::face_and_edge_lists::FaceAndEdgeLists);
    sixfold_conformance::walk_suite!(crate::face_and_edge_lists::FaceAndEdgeLists);
}

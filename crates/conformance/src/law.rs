//! The requirements on every structure, one function per law.
//!
//! A law builds the structure from a given mesh, and panics if the structure breaks the law. The
//! message contains the structure, the element and the relation. All laws except [`verdict`] skip
//! the meshes that the capabilities of the structure exclude; [`verdict`] tests that the structure
//! refuses them.
#![expect(
    clippy::missing_panics_doc,
    reason = "every law panics if it is broken"
)]

mod corner_cases;
mod cost;
mod edit;
mod edit_data;
mod element_names;
mod elements;
mod inverse_edits;
mod limits;
mod refine;
mod relations;
mod scripts;
mod structure;
mod walk;

pub use corner_cases::corner_cases;
pub use cost::{costs, memory, oriented_walk_costs};
pub use edit::{edit_costs, edits};
pub use edit_data::{ElementNumbers, data_follows_edits, numbers_follow_edits};
pub use element_names::{names_follow_edits, names_follow_edits_by};
pub(crate) use elements::check_numbers;
pub use elements::{elements, maps, missing_handles, names, numbers, positions};
pub use inverse_edits::inverse_edits;
pub use limits::{build_limits, edit_limits};
pub use refine::{refine, refine_in_parallel};
pub use relations::{
    boundary_loops, edge_edges, edge_faces, edge_vertices, face_edges, face_faces, face_vertices,
    folds, one_ring, predicates, symmetry, vertex_edges, vertex_faces, vertex_vertices,
};
pub use structure::{invariants, probed, round_trip, set_positions, verdict};
pub use walk::{oriented_walk, oriented_walk_after_edits};

/// Calls a macro with the name of every law: `for_each_law!(callback! { … })`.
///
/// The callback receives two lists and its own arguments: `[laws about a mesh] [laws about a
/// structure] …`. This macro is the only list of laws.
#[macro_export]
macro_rules! for_each_law {
    ($callback:ident! { $($arguments:tt)* }) => {
        $crate::$callback! {
            [
                vertex_vertices vertex_edges vertex_faces
                edge_vertices edge_edges edge_faces
                face_vertices face_edges face_faces
                symmetry one_ring predicates boundary_loops folds
                elements names positions maps numbers missing_handles
                verdict build_limits round_trip set_positions invariants probed
            ]
            [corner_cases costs memory]
            $($arguments)*
        }
    };
}

/// The names of all laws.
pub const NAMES: &[&str] = for_each_law!(names_of_laws! {});

/// The callback that makes [`NAMES`].
#[doc(hidden)]
#[macro_export]
macro_rules! names_of_laws {
    ([$($law:ident)+] [$($structural:ident)+]) => {
        &[$(stringify!($law),)+ $(stringify!($structural)),+]
    };
}

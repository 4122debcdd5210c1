//! Runs a workload as a mix: all operations in one loop, in the access order of the workload.
//!
//! The operations on single elements run in groups, which are called turns. A turn has 256
//! operations, or 64 operations if the mix contains edits. The number of operations of each kind in
//! a turn is in proportion to the weight of the kind. All structures visit the same elements. The
//! operations share the processor caches with one another and with the program's own data, as they do
//! in a program. Passes over the whole mesh run
//! between turns.

mod own_data;
mod places;
mod route;
mod route_handles;
mod runs;
mod schedule;
mod structure_mix;
mod table_mix;

use sixfold_measure::TimedBackend;

pub use places::EditPlaceError;
pub use route::Route;
pub use schedule::Schedule;
pub(crate) use structure_mix::{MixInput, prepare_edit_mix, prepare_query_mix};
pub use structure_mix::{MixRefusal, PreparedMix, prepare_mix};
pub use table_mix::tabulate;
pub(crate) use table_mix::tabulate_structure;

/// Why a backend of a mix refuses [`Task::Program`](sixfold_measure::Task::Program).
const NO_PROGRAM: &str = "the backend was prepared for a workload, not for a program";

/// A backend on which a mix can be run: a structure, or relation tables. A `MixBackend` also runs
/// the tasks [`Mix`](sixfold_measure::Task::Mix) and [`Part`](sixfold_measure::Task::Part) of its schedule. All tasks
/// of a `MixBackend` run on the same mesh.
pub trait MixBackend: TimedBackend {
    /// Returns the paths of the Rust types that a program must import to use this backend.
    fn type_paths(&self) -> Vec<&'static str>;

    /// Returns one value for each part of the mix. A part is a kind of operation. The value is true
    /// if one operation of this kind visits all faces of the mesh.
    fn scans(&self) -> Vec<bool>;

    /// Tries each edit of the mix at each face that was chosen for the edit. Returns a list for
    /// each edit, with one value for each chosen face. The value is true if the backend accepts the
    /// edit at this face.
    fn accepted_places(&mut self) -> Vec<Vec<bool>>;

    /// Discards the chosen faces whose value in `accepted` is false. `accepted` has the same form
    /// as the result of [`accepted_places`](Self::accepted_places).
    fn keep_places(&mut self, accepted: &[Vec<bool>]);
}

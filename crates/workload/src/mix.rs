//! Runs a workload as a mix: all operations in one loop, in the access order of the workload.
//!
//! Operations on elements are grouped into turns. A turn has 256 operations, or 64 if there are
//! edits. It runs each part of the mix in proportion to its weight. All structures visit the same
//! elements. The parts share caches as they do in a program. Passes over the whole mesh run between
//! turns.

mod passes;
mod places;
mod route;
mod route_handles;
mod schedule;
mod structure_mix;
mod table_mix;

use crate::clock::{Clock, Time};
use crate::operation::Operation;
use crate::series::Series;
use crate::timed_structure::{ElementSample, Run};

pub use places::EditPlaceError;
pub use route::Route;
pub use schedule::Schedule;
pub(crate) use structure_mix::{MixInput, prepare_edit_mix, prepare_query_mix};
pub use structure_mix::{MixRefusal, PreparedMix, prepare_mix};
pub use table_mix::tabulate;
pub(crate) use table_mix::tabulate_structure;

/// The time and the counts of some operations of a mix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixRun {
    /// The total time of the operations.
    pub time: Time,
    /// The number of operations.
    pub operations: u64,
    /// The number of results or of positions read. Two structures that visit the same elements have
    /// the same number.
    pub yielded: u64,
    /// The number of edits that were refused.
    pub refused: u64,
}

/// A backend that can run a mix: a structure or relation tables.
pub trait MixBackend {
    /// Returns the name of the backend.
    fn name(&self) -> &'static str;

    /// Returns the paths of the types that a program needs to use the backend.
    fn type_paths(&self) -> Vec<&'static str>;

    /// Returns the size of the tables in bytes.
    fn bytes(&self) -> usize;

    /// Returns the number of input vertices that were merged with other vertices.
    fn merged_vertices(&self) -> usize;

    /// Returns for each part whether one operation visits all faces of the mesh.
    fn scans(&self) -> Vec<bool>;

    /// Runs the element operations of `turns` turns, from turn `turn` on. If there are edits, runs
    /// the turns on `copies` copies. The copies are reset outside the timing.
    fn run(&mut self, turn: u64, turns: u64, copies: usize, clock: &dyn Clock) -> MixRun;

    /// Runs `operations` operations of one part alone, from operation `first` on. Edits start at
    /// the first place, on a reset copy.
    fn run_part(&mut self, part: usize, first: u64, operations: u64, clock: &dyn Clock) -> MixRun;

    /// Returns the number of operations of `part` that visit each element or place once.
    fn cycle_length(&self, part: usize) -> u64;

    /// Runs a pass over the whole mesh or over a sample.
    fn run_pass(
        &mut self,
        operation: Operation,
        sample: Option<ElementSample>,
        series: &Series<'_>,
    ) -> Run;

    /// Returns for each edit and each place whether the edit is accepted.
    fn accepted_places(&mut self) -> Vec<Vec<bool>>;

    /// Keeps only the places that are true in `accepted`.
    fn keep_places(&mut self, accepted: &[Vec<bool>]);

    /// Builds the backend as `series` describes. Returns the time of one build.
    fn build(&self, series: &Series<'_>) -> Time;
}

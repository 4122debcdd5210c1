//! Runs a workload as a mix: all its operations in one loop, in its access order.
//!
//! Operations on elements are grouped into turns of 256 operations, or 64 if there are edits. A
//! turn runs each part of the mix in proportion to its weight, on consecutive elements of a route
//! that is the same for all structures. The parts therefore share caches as they do in a program,
//! and switching between parts costs almost nothing. Passes over the whole mesh run between turns.

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
    /// The number of elements that the operations yielded, or of positions that they read. Two
    /// structures have the same number if both visit all elements, or the same route.
    pub yielded: u64,
    /// The number of edits that were refused.
    pub refused: u64,
}

/// A backend on which a mix can be run: a structure, or relation tables.
pub trait MixBackend {
    /// Returns the name that users write.
    fn name(&self) -> &'static str;

    /// Returns the paths of the types that a program needs to use this backend.
    fn type_paths(&self) -> Vec<&'static str>;

    /// Returns the bytes of its tables.
    fn bytes(&self) -> usize;

    /// Returns how many vertices of the input were merged with others.
    fn merged_vertices(&self) -> usize;

    /// Returns for each part of the mix whether it visits all faces of the mesh for one operation.
    fn scans(&self) -> Vec<bool>;

    /// Runs the element operations of `turns` turns, starting with turn `turn`. If there are edits,
    /// runs the turns `copies` times, each time on a copy that is reset outside the timing.
    fn run(&mut self, turn: u64, turns: u64, copies: usize, clock: &dyn Clock) -> MixRun;

    /// Runs `operations` operations of one part alone, from operation `first` of its route. Edits
    /// start at the first place, on a reset copy.
    fn run_part(&mut self, part: usize, first: u64, operations: u64, clock: &dyn Clock) -> MixRun;

    /// Returns the number of operations of `part` that visit each of its elements, or places, once.
    fn cycle_length(&self, part: usize) -> u64;

    /// Runs a pass over the whole mesh, or over a sample that represents it.
    fn run_pass(
        &mut self,
        operation: Operation,
        sample: Option<ElementSample>,
        series: &Series<'_>,
    ) -> Run;

    /// Returns for each edit of the schedule and each place whether the edit is accepted.
    fn accepted_places(&mut self) -> Vec<Vec<bool>>;

    /// Keeps only the places that are true in `accepted`. All structures get the same `accepted`.
    fn keep_places(&mut self, accepted: &[Vec<bool>]);

    /// Builds the backend from the polygons as often as `series` describes and returns the time of
    /// one build.
    fn build(&self, series: &Series<'_>) -> Time;
}

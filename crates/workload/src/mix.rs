//! A workload run as a mix: all its operations in one loop, in its order of elements.
//!
//! Operations on elements go in turns of 256, of 64 where there are edits: a turn asks each part of the mix in proportion to its
//! weight, of elements one after the other along a route that is the same for all structures. So the
//! parts share caches as they do in a program, and what chooses between them costs next to nothing.
//! Passes over the whole mesh take their place between turns.

mod bench;
mod passes;
mod places;
mod route;
mod script;
mod streams;
mod tables;

use crate::candidate::{Run, Sample};
use crate::clock::{Clock, Time};
use crate::operation::Operation;
use crate::series::Series;

pub use bench::{MixOutcome, MixRefusal, set_up};
pub use places::NoPlace;
pub use route::Route;
pub use script::Script;
pub use tables::tabulate;

/// What some operations of a mix came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixRun {
    /// The time of all of them.
    pub time: Time,
    /// How many operations there were.
    pub operations: u64,
    /// How many elements they yielded, or positions they read: the same for all structures that go
    /// through all elements, or along one route.
    pub yielded: u64,
    /// How many edits were refused.
    pub refused: u64,
}

/// A structure on which a mix can be run.
pub trait Mixer {
    /// What users call it.
    fn name(&self) -> &'static str;

    /// The bytes held.
    fn bytes(&self) -> usize;

    /// How many vertices of the input are no vertices of their own here.
    fn merged_vertices(&self) -> usize;

    /// By part of the mix: whether it looks at all faces.
    fn scans(&self) -> Vec<bool>;

    /// Runs the element operations of `turns` turns, from `turn` on. If there are edits, it does so
    /// `copies` times, each time on a copy that is put back while the clock stands still.
    fn run(&mut self, turn: u64, turns: u64, copies: usize, clock: &dyn Clock) -> MixRun;

    /// Runs `operations` operations of one part alone, from a place on its route; edits at fresh places.
    fn run_part(&mut self, part: usize, first: u64, operations: u64, clock: &dyn Clock) -> MixRun;

    /// How many operations of `part` go through each of its elements once, or are done at all places.
    fn cycle(&self, part: usize) -> u64;

    /// Runs a pass over the whole mesh, or over a sample that stands for it.
    fn run_pass(
        &mut self,
        operation: Operation,
        sample: Option<Sample>,
        series: &Series<'_>,
    ) -> Run;

    /// By edit of the script, and by place: whether it is accepted.
    fn accepted(&mut self) -> Vec<Vec<bool>>;

    /// Goes on with the places where `accepted` says so, which are the same for all structures.
    fn keep(&mut self, accepted: &[Vec<bool>]);

    /// Builds it from the polygons as often as `series` says; the time is that of one building.
    fn build(&self, series: &Series<'_>) -> Time;
}

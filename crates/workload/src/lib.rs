//! The work that is run on a structure and timed: queries, whole-mesh operations, edits,
//! subdivisions.
//!
//! [`Backend::of`] makes any representation measurable as a [`Subject`], which runs a [`Job`] and
//! returns its time and its result. This crate contains everything that is compiled once for each
//! structure. The crates above it measure and evaluate, without any mesh type.

mod allocation;
mod backend;
mod built_in;
mod caches;
mod candidate;
mod clock;
mod editing;
mod heap;
mod ledger;
mod memory_speed;
mod mix;
mod operation;
pub mod pages;
mod place;
mod reads;
mod refining;
mod sample;
mod series;
mod single_edit;
mod subdividing;
mod sweeps;
mod unknown;
mod workload;
mod workload_file;

pub use allocation::{Allocated, AllocationCounter, MOST_SCANNED_FACES, NotCounted};
pub use backend::{Backend, OnTheBench};
pub use built_in::{built_in, built_ins};
pub use caches::{Cache, caches, last_level};
pub use candidate::{Job, Outcome, Run, Sample, Subject};
pub use clock::{Clock, MachineClock, Time, timed};
pub use editing::{Editing, Editor, Edits};
pub use heap::{Heap, Weighed};
pub use ledger::{CACHE_LINES, LINE_BYTES, REACH};
pub use memory_speed::{MemorySpeed, Rung};
pub use mix::{MixOutcome, MixRefusal, MixRun, Mixer, NoPlace, Route, Script, set_up, tabulate};
pub use operation::{Kind, Operation, UnknownOperation};
pub use reads::{Counted, MOST_READS, Reads, SAMPLE, TableReads};
pub use refining::{Refiner, Refining, Way};
pub use sample::{Draw, Side};
pub use series::{LONG_ENOUGH_NS, Scrubber, Series, Start, exceeds_second_level};
pub use single_edit::SingleEdit;
pub use sweeps::field_sum;
pub use unknown::unknown;
pub use workload::{Access, Action, Amount, NoAmount, Part, UnknownAction, Workload};
pub use workload_file::WorkloadError;

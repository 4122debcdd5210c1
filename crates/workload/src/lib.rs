//! What is run on a structure and timed: operations, whole passes, edits, subdivisions.
//!
//! [`Backend::of`] puts any representation on the bench as a [`Subject`], which runs a [`Job`] and says
//! how long that took and what it found. Everything that is compiled once for each structure is in
//! this crate; who measures, and judges, is above it and knows no types of meshes.

mod backend;
mod candidate;
mod clock;
mod editing;
mod ledger;
mod memory_speed;
mod operation;
mod reads;
mod refining;
mod sample;
mod single_edit;
mod subdividing;
mod sweeps;

pub use backend::{Backend, OnTheBench};
pub use candidate::{Job, Outcome, Run, Sample, Subject};
pub use clock::{Clock, MachineClock, Time, timed};
pub use editing::{Editing, Editor, Edits};
pub use ledger::{CACHE_LINES, LINE_BYTES, REACH};
pub use memory_speed::{MemorySpeed, Rung};
pub use operation::{Kind, Operation, UnknownOperation};
pub use reads::{Counted, MOST_READS, Reads, SAMPLE, TableReads};
pub use refining::{Refiner, Refining, Way};
pub use sample::{Draw, Side};
pub use single_edit::SingleEdit;
pub use sweeps::field_sum;

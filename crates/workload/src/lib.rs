//! Runs mesh operations on a structure (a mesh data structure) and measures their times.
//!
//! [`Backend::new`] makes a [`Backend`] for any structure. [`Backend::prepare`] builds the
//! structure and returns a [`TimedBackend`](sixfold_measure::TimedBackend). A `TimedBackend` runs a [`Job`](sixfold_measure::Job) and returns the time
//! and the result. This crate contains all code that is compiled separately for each structure.
//!
//! The documentation of a function that runs while the clock runs begins with **Timed**.

mod allocation;
mod backend;
mod built_in;
mod draw;
mod edit_place;
mod heap;
mod mix;
mod operation;
mod passes;
mod read_probe;
mod reads;
mod recording;
mod single_edit;
pub mod spatial;
mod subdivision_job;
mod sweeps;
mod timed_structure;
mod traces;
mod workload;
mod workload_file;

pub use allocation::{Allocated, AllocationCounter, MAX_SCANNED_FACES, NotCounted};
pub use backend::{Backend, Prepared};
pub use built_in::{built_in, built_ins};
pub use draw::{Draw, Side};
pub use heap::{Heap, MeasuredMemory};
pub use mix::{
    EditPlaceError, MixBackend, MixRefusal, PreparedMix, Route, Schedule, prepare_mix, tabulate,
};
pub use operation::edit_pass::{Editor, Edits, PreparedEditor};
pub use read_probe::{CACHE_LINES, REACH};
pub use reads::{MAX_READS, ReadsObserver, SCAN_SAMPLE};
pub use recording::{Recording, Visits};
pub use single_edit::SingleEdit;
pub use subdivision_job::{PreparedRefiner, Refiner, SubdivisionJob, Way};
pub use traces::suite_of_trace;
pub use workload::{Access, Action, Amount, ParseAmountError, Part, Workload};
pub use workload_file::WorkloadError;

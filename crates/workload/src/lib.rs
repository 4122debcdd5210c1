//! Runs mesh operations on a structure (a mesh data structure) and measures their times.
//!
//! [`Backend::new`] makes a [`Backend`] for any structure. [`Backend::prepare`] builds the
//! structure and returns a [`TimedBackend`]. A `TimedBackend` runs a [`Job`] and returns the time
//! and the result. This crate contains all code that is compiled separately for each structure.
//!
//! The documentation of a function that runs while the clock runs begins with **Timed**.

mod allocation;
mod backend;
mod built_in;
mod caches;
mod clock;
mod compilation;
mod draw;
mod edit_place;
mod handle_lists;
mod heap;
mod job;
mod memory_speed;
mod mix;
mod operation;
pub mod pages;
mod passes;
mod program;
mod read_probe;
mod reads;
mod series;
mod single_edit;
pub mod spatial;
mod subdivision_job;
mod sweeps;
mod tables;
mod timed_structure;
mod trace;
mod workload;
mod workload_file;

pub use allocation::{Allocated, AllocationCounter, MAX_SCANNED_FACES, NotCounted};
pub use backend::{Backend, Prepared};
pub use built_in::{built_in, built_ins};
pub use caches::caches;
pub use clock::{Clock, MachineClock, timed};
pub use compilation::{COMPILATION, Compilation};
pub use draw::{Draw, Side};
pub use heap::{Heap, MeasuredMemory};
pub use job::{ElementSample, Job, Outcome, Task, TimedBackend, TimedRun};
pub use memory_speed::MemorySpeed;
pub use mix::{
    EditPlaceError, MixBackend, MixRefusal, PreparedMix, Route, Schedule, prepare_mix, tabulate,
};
pub use operation::edit_pass::{EditPass, Editor, Edits, PreparedEditor};
pub use operation::subdivision::patch;
pub use operation::{ElementKind, Operation};
pub use program::{
    Asked, Contestant, EditProgram, MovingProgram, Program, ProgramRefusal, Recorded, Recording,
    RefineProgram, Suite, SuiteProgram, Visits, WalkProgram,
};
pub use read_probe::{CACHE_LINES, LINE_BYTES, REACH};
pub use reads::{MAX_READS, ReadsObserver, SCAN_SAMPLE};
pub use series::{CacheFlusher, MIN_TIMED_NS, Series, Start, exceeds_second_level};
pub use single_edit::SingleEdit;
pub use subdivision_job::{PreparedRefiner, Refiner, SubdivisionJob, Way};
pub use trace::{Trace, TraceError};
pub use workload::{Access, Action, Amount, ParseAmountError, Part, Workload};
pub use workload_file::WorkloadError;

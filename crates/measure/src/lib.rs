//! Measures programs on every mesh data structure, and says which structure fits.
//!
//! A program is an algorithm that is generic over the mesh type: a [`Program`], or one of the other kinds. [`main`] makes a
//! command line of it, which measures the program on every structure that can hold the mesh, and ranks the structures:
//!
//! ```no_run
//! use std::process::ExitCode;
//!
//! use sixfold::MeshQuery;
//! use sixfold_measure::{Outcome, Program};
//!
//! /// Adds up the lengths of all edges.
//! struct TotalLength;
//!
//! impl Program for TotalLength {
//!     type Scratch<M: MeshQuery> = ();
//!
//!     fn name(&self) -> &str {
//!         "total-length"
//!     }
//!
//!     fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
//!         Ok(())
//!     }
//!
//!     fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
//!         let length = |e| {
//!             let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
//!             f64::from(a.distance(b))
//!         };
//!         let total = mesh.edges().map(length).sum();
//!         Outcome::new(total, mesh.edge_count() as u64)
//!     }
//! }
//!
//! fn main() -> ExitCode {
//!     sixfold_measure::main(TotalLength)
//! }
//! ```
//!
//! Without a command line, [`pick_for_programs`] measures and returns reports, and [`record_program`] writes down the calls
//! of a program as a [`Trace`].
//!
//! The crate is small, because programs of users depend on it: it has no reports and no operations of its own. It also has
//! what all measurements of Sixfold need: jobs, series of runs, clocks, pages and caches, and the engine that measures backends
//! in rounds.
//!
//! # Effect on the process
//!
//! [`pick_for_programs`], [`record_program`] and [`serve_program`] change the settings of malloc for the whole process while
//! they measure, see [`pages`](crate::pages#effect-on-the-process). They also set a panic hook, which does not print the panics of
//! programs, because these are results. All other panics go to the hook that was set before.
//!
//! The documentation of a function that runs while the clock runs begins with **Timed**.

mod caches;
mod clock;
#[doc(hidden)]
pub mod command;
mod compilation;
#[doc(hidden)]
pub mod engine;
#[doc(hidden)]
pub mod external;
mod handle_lists;
mod job;
#[doc(hidden)]
pub mod launches;
mod memory_speed;
mod operation;
pub mod pages;
#[doc(hidden)]
pub mod pick;
mod program;
#[doc(hidden)]
pub mod refusal;
mod series;
mod sink;
mod study_mesh;
mod tables;
mod trace;
mod usage;

pub use caches::caches;
pub use clock::{Clock, MachineClock, timed};
pub use compilation::{COMPILATION, Compilation};
pub use engine::effort::Effort;
pub use engine::heap::free_memory;
pub use external::isolated::{ChildTask, Isolation, serve_program};
pub use job::{ElementSample, Job, Outcome, Task, TimedBackend, TimedRun};
pub use memory_speed::MemorySpeed;
pub use operation::{Checksum, EditPass, ElementKind, Operation};
pub use pick::programs::{MeasureError, ProgramSettings, pick_for_programs};
pub use pick::recording::{RecordError, RecordedProgram, record_program};
pub use program::{
    Asked, Contestant, EditProgram, MovingProgram, Program, ProgramRefusal, Recorded,
    RefineProgram, Suite, SuiteProgram, WalkProgram,
};
pub use series::{CacheFlusher, MIN_TIMED_NS, Series, Start, exceeds_second_level};
pub use study_mesh::{StudyMesh, is_skewed, patch, sha256_of};
pub use trace::{Measured, Trace, TraceError};

// For the other crates of Sixfold that measure.
#[doc(hidden)]
pub use {
    caches::LINE_BYTES,
    handle_lists::HandleLists,
    operation::field_sum,
    program::{Form, ProgramKind, TapedRun, record_edit_trace, record_trace},
    series::{ReusedCopies, time_making},
    sink::Sink,
    tables::{TABLE_TYPE, TABLES, time_building},
    trace::{Call, EditReplay, Op, PlainReplay, TracedEdit},
};

use std::process::ExitCode;

/// Runs the command line of `programs`: a [`Program`], or a [`Suite`] of several programs.
///
/// The command line measures each program on each structure that can hold the meshes of the
/// arguments. The option `--help` describes the arguments.
pub fn main(programs: impl Into<Suite>) -> ExitCode {
    command::launches::note_start();
    command::exit_code(command::programs::run(programs.into()))
}

/// The example of the guide, which is compiled as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../reports/guide/your-own-program.md")]
struct GuideExamples;

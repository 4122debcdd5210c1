//! Measures which mesh data structure is fastest for a mesh and a workload, and makes reports.
//!
//! A backend is a mesh data structure or an external program that takes part in a measurement.
//! [`study()`] builds the requested backends, times [`Operation`]s on them, and returns a
//! [`Report`](sixfold_results::Report). The measurement consists of rounds. In each round, the backends take turns in random
//! order. [`study()`] also compares checksums of the results, because all backends must do the same
//! work. [`orders`] measures one mesh with its elements in several orders. [`growth`] measures one
//! shape in many sizes.
//!
//! [`inspect`] describes a mesh and the backends that can hold it. [`pick`] ranks the backends for
//! a workload. [`audit`] counts the bytes of each backend in three ways,
//! and reports differences between the three counts. [`why`] counts the bytes that queries read,
//! and compares the times of the queries with the speed of memory.
//!
//! The results are those of `sixfold-results`, which has the document, comparisons and means.
//!
//! # Effect on the process
//!
//! [`study()`], [`orders`], [`growth`], [`neighbours`], [`pick`], [`pick_for_programs`],
//! [`serve_program`] and [`BackendRunner`] change the settings of malloc for the whole process while
//! they measure, so that freed pages stay in the process ([`Policy::Kept`](sixfold_results::Policy::Kept)). The settings are
//! restored at the end; [`HeapGuard`] lists what is restored. Two measurements at the same time must
//! have the same [`Policy`](sixfold_results::Policy): the second one otherwise returns a [`HeapPolicyConflict`]. If memory
//! runs out in one of them, none keeps pages any longer, and all results have the reason.
//!
//! The file `reports/SCHEMA.md` explains the values in the document. This crate has no command line
//! and prints nothing. The measuring functions report the progress to a closure, and stop early
//! when a flag is set. The flag is not the return value of the closure, as in the algorithms,
//! because a signal handler sets it, and because it is also read where no progress is reported:
//! between the runs of a sample, and while an external program works.

mod engine;
mod external;
mod inspect;
mod labs;
mod launches;
mod refusal;
#[cfg(test)]
mod results_tests;
mod runner;
mod usage;

pub use engine::effort::Effort;
pub use engine::heap::free_memory;
pub use engine::measure::Progress;
pub use engine::run::start_run;
pub use external::isolated::{ChildTask, Isolation, serve_program};
pub use external::{EXTERNAL_TIMEOUT, External, ExternalError};
pub use inspect::{Inspection, StudyMesh, inspect, inspect_diagnosed, sha256_of};
pub use labs::growth::{
    GrowthError, GrowthSettings, SCALABLE_SHAPES, ScalableShape, growth, growth_bytes, growth_plan,
};
pub use labs::memory::{CROWDED, audit, count_allocations, none_holds};
pub use labs::neighbours::{NeighboursError, NeighboursSettings, neighbour_indices, neighbours};
pub use labs::orders::{DEFAULT_OPERATIONS, orders, orders_bytes};
pub use labs::pick::{
    PickError, PickSettings, Predicted, Prediction, ProgramSettings, RecordError, RecordedProgram,
    pick, pick_for_programs, predict, record_program,
};
pub use labs::study::{Settings, StudyError, study};
pub use labs::why::{Timing, WhySettings, why};
pub use launches::{LAUNCH_VARIABLE, pool_launches};
pub use runner::{BackendRun, BackendRunner};
pub use sixfold_workload::pages::{self, HeapGuard, HeapPolicyConflict};
pub use sixfold_workload::{
    Access, Action, Amount, EditPlaceError, Part, Workload, WorkloadError, built_in, built_ins,
};
pub use sixfold_workload::{
    Allocated, AllocationCounter, Backend, CacheFlusher, Clock, EditPass, Editor, Edits,
    ElementKind, Heap, MAX_SCANNED_FACES, MachineClock, MeasuredMemory, MemorySpeed, NotCounted,
    Operation, Refiner, Series, SingleEdit, Start, SubdivisionJob, Way, caches, timed,
};
pub use sixfold_workload::{
    Asked, EditProgram, MovingProgram, Outcome, Program, ProgramRefusal, Recorded, Recording,
    RefineProgram, Suite, SuiteProgram, Trace, TraceError, WalkProgram,
};

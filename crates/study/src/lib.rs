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
//! The engine that measures is that of `sixfold-measure`, which also measures programs of users. The results are those of
//! `sixfold-results`, which has the document, comparisons and means.
//!
//! # Effect on the process
//!
//! [`study()`], [`orders`], [`growth`], [`neighbours`], [`pick`], [`pick_for_programs`] and
//! [`BackendRunner`] change the settings of malloc for the whole process while
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

#[cfg(test)]
mod engine_cost;
mod external;
mod inspect;
mod labs;
mod launches;
#[cfg(test)]
mod results_tests;
mod runner;

// The measuring engine has the same paths here.
use sixfold_measure::{engine, refusal};

pub use external::{EXTERNAL_TIMEOUT, External, ExternalError};
pub use inspect::{Inspection, inspect, inspect_diagnosed};
pub use labs::growth::{
    GrowthError, GrowthSettings, SCALABLE_SHAPES, ScalableShape, growth, growth_bytes, growth_plan,
};
pub use labs::memory::{CROWDED, audit, count_allocations, none_holds};
pub use labs::neighbours::{NeighboursError, NeighboursSettings, neighbour_indices, neighbours};
pub use labs::orders::{DEFAULT_OPERATIONS, orders, orders_bytes};
pub use labs::pick::{
    PickError, PickSettings, Predicted, Prediction, TraceWorkloadError, pick, predict,
    workload_of_trace,
};
pub use labs::study::{Settings, StudyError, study};
pub use labs::why::{Timing, WhySettings, why};
pub use launches::pool_launches;
pub use runner::{BackendRun, BackendRunner};
pub use sixfold_measure::engine::measure::Progress;
pub use sixfold_measure::engine::run::start_run;
pub use sixfold_measure::launches::LAUNCH_VARIABLE;
pub use sixfold_measure::pages::{self, HeapGuard, HeapPolicyConflict};
pub use sixfold_measure::{
    CacheFlusher, Clock, EditPass, ElementKind, MachineClock, MemorySpeed, Operation, Series,
    Start, caches, timed,
};
pub use sixfold_measure::{
    Effort, ProgramSettings, StudyMesh, free_memory, pick_for_programs, sha256_of,
};
pub use sixfold_measure::{Outcome, Trace, TraceError};
pub use sixfold_workload::Recording;
pub use sixfold_workload::{
    Access, Action, Amount, EditPlaceError, Part, Workload, WorkloadError, built_in, built_ins,
    suite_of_trace,
};
pub use sixfold_workload::{
    Allocated, AllocationCounter, Backend, Editor, Edits, Heap, MAX_SCANNED_FACES, MeasuredMemory,
    NotCounted, Refiner, SingleEdit, SubdivisionJob, Way,
};

/// Writes the commit from which this crate was compiled into all results of this process. Commands call it at their start.
pub fn note_commit() {
    if let Some(commit) = option_env!("STUDY_COMMIT") {
        sixfold_measure::engine::run::set_commit(commit);
    }
}

//! Measures which mesh data structure is fastest for a mesh and a workload, and makes reports.
//!
//! A backend is a mesh data structure or an external program that takes part in a measurement.
//! [`study()`] builds the requested backends, times [`Operation`]s on them, and returns a
//! [`Report`]. The measurement consists of rounds. In each round, the backends take turns in random
//! order. [`study()`] also compares checksums of the results, because all backends must do the same
//! work. [`orders`] measures one mesh with its elements in several orders. [`growth`] measures one
//! shape in many sizes.
//!
//! [`inspect`] describes a mesh and the backends that can hold it. [`pick`] ranks the backends for
//! a workload. [`compare`] compares two studies. A [`Collection`] holds the studies of many meshes
//! and computes means over the meshes. [`audit`] counts the bytes of each backend in three ways,
//! and reports differences between the three counts. [`why`] counts the bytes that queries read,
//! and compares the times of the queries with the speed of memory.
//!
//! The file `reports/SCHEMA.md` explains the values in the results. This crate has no command line
//! and prints nothing. The measuring functions report the progress to a closure, and stop early
//! when a flag is set.

mod agreement;
mod audit;
mod budget;
mod collection;
mod compare;
mod control;
mod disturbance;
mod environment;
mod external;
mod growth;
mod heap;
mod inspect;
mod labs;
mod measure;
mod methods;
pub mod numbers;
mod orders;
mod pick;
mod plan;
mod ranking;
mod read;
mod refusal;
mod report;
mod runner;
mod sanitize;
mod sentences;
#[cfg(test)]
mod simulated_machine;
mod slope;
mod statistics;
mod study;
mod timer;
mod trial;
mod warnings;
mod why;

pub use audit::{Audit, BackendAudit, OperationBytes, audit, count_allocations};
pub use budget::Budget;
pub use collection::{
    Collection, Failed, FailureKind, Group, Holding, MergeError, Overall, Pool, Pooled, Purpose,
    SecondStudy, SharedSettings,
};
pub use compare::{
    Change, Changes, CompareError, CompareSettings, DRIFT, NewWinner, SettingChange, Verdict,
    compare,
};
pub use environment::Environment;
pub use external::{EXTERNAL_TIMEOUT, External, ExternalError, ExternalReport};
pub use growth::{
    BackendBytes, BackendRefusal, CacheLimit, Fit, GrowthError, GrowthReport, GrowthSettings,
    SCALABLE_SHAPES, ScalableShape, SizeReport, growth, growth_bytes,
};
pub use heap::{CacheState, CachesReport, free_memory};
pub use inspect::{StudyMesh, inspect, inspect_diagnosed};
pub use labs::Labs;
pub use measure::Progress;
pub use orders::{
    Comparison, DEFAULT_OPERATIONS, Factor, Larger, OrderEffect, OrderRow, OrdersError,
    OrdersReport, StructureEffect, orders, orders_bytes,
};
pub use pick::{
    BreakEven, Choice, EQUAL_UP_TO, Excluded, MeshRanking, Need, PartCost, PickError, PickReport,
    PickSettings, Predicted, Prediction, Ranked, TurningPoint, UnknownNeed, pick, predict,
};
pub use read::{ReadError, Results};
pub use report::{
    Agreement, BackendReport, Control, ControlRow, FIRST_TIME_SHOWN, Inspection, MeshReport,
    RawSamples, Refusal, Report, ResultRow, SCHEMA, Standing,
};
pub use runner::{BackendRun, BackendRunner};
pub use sanitize::sanitize;
pub use sixfold_workload::pages::{self, HeapReport, Policy, UnknownPolicy};
pub use sixfold_workload::{
    Access, Action, Amount, EditPlaceError, Part, Workload, WorkloadError, built_in, built_ins,
};
pub use sixfold_workload::{
    Allocated, AllocationCounter, Backend, BufferSpeed, Cache, CacheFlusher, Clock, EditPass,
    Editor, Edits, ElementKind, Heap, MAX_SCANNED_FACES, MachineClock, MeasuredMemory, MemorySpeed,
    NotCounted, Operation, Reads, Refiner, Series, SingleEdit, Start, SubdivisionJob, TableReads,
    Time, UnknownOperation, Way, caches, timed, unknown,
};
pub use slope::Slope;
pub use statistics::UNSEEN_DRIFT;
pub use study::{Settings, StudyError, study};
pub use timer::Timer;
pub use why::{Bound, Model, Timed, Timing, Why, WhyRow, WhySettings, why};

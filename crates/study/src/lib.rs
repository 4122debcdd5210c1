//! Workloads, interleaved measurement and reports: which structure fits this mesh and this work?
//!
//! [`study()`] builds every requested backend and runs the [`Operation`]s on them in interleaved
//! rounds. It compares checksums to prove that all backends did the same work, and returns a
//! [`Report`]. [`orders`] does this for one mesh in several orders. [`growth`] does this for one
//! shape in many sizes.
//!
//! [`inspect`] describes a mesh and the backends that can hold it. [`pick`] ranks the backends for
//! a workload. [`compare`] compares two studies. A [`Collection`] pools the studies of many meshes.
//! [`audit`] counts the bytes of each backend in three ways, which must agree. [`why`] counts the
//! bytes that relations read, and compares their times with the speed of memory.
//!
//! `reports/SCHEMA.md` explains the figures. This crate has no command line and prints nothing. It
//! reports progress to a closure and stops when a flag is set.

mod agreement;
mod audit;
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
mod warnings;
mod why;

pub use audit::{Audit, BackendAudit, OperationBytes, audit, count_allocations};
pub use collection::{
    Collection, Failed, FailureKind, MergeError, Pooled, SecondStudy, SharedSettings,
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
pub use inspect::{StudyMesh, inspect};
pub use labs::Labs;
pub use measure::Progress;
pub use orders::{
    Comparison, DEFAULT_OPERATIONS, Factor, Larger, OrderEffect, OrderRow, OrdersError,
    OrdersReport, StructureEffect, orders, orders_bytes,
};
pub use pick::{
    BreakEven, Excluded, MeshRanking, Need, PartCost, PickError, PickReport, PickSettings, Ranked,
    UnknownNeed, pick,
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
    Access, Action, Amount, EditPlaceError, Workload, WorkloadError, built_in, built_ins,
};
pub use sixfold_workload::{
    Allocated, AllocationCounter, Backend, BufferSpeed, Cache, CacheFlusher, Clock, EditPass,
    Editor, Edits, ElementKind, Heap, MAX_SCANNED_FACES, MachineClock, MeasuredMemory, MemorySpeed,
    NotCounted, Operation, Reads, Refiner, Series, SingleEdit, Start, SubdivisionJob, TableReads,
    Time, UnknownOperation, Way, caches, timed, unknown,
};
pub use slope::Slope;
pub use study::{Settings, StudyError, study};
pub use timer::Timer;
pub use why::{Bound, Model, Timed, Timing, Why, WhyRow, WhySettings, why};

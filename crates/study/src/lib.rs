//! Workloads, interleaved measurement and reports: which structure fits this mesh and this work?
//!
//! [`study()`] builds every requested backend, runs the [`Operation`]s on them in interleaved
//! rounds until the budget is spent, compares checksums to prove that all did the same work, and
//! returns a [`Report`]. [`orders`] does this for one mesh in several orders, [`growth`] for one
//! shape in many sizes. [`inspect`] describes a mesh and the backends that can hold it, and
//! measures nothing. [`pick`] ranks the backends for a workload. [`compare`] compares two studies.
//! A [`Collection`] pools the studies of many meshes. [`audit`] counts the bytes of each backend in
//! three ways, which must agree. [`why`] counts the bytes that relations read, and compares their
//! times with the speed of memory.
//!
//! `reports/SCHEMA.md` explains the figures. This crate has no command line and prints nothing: it
//! reports progress to a closure and stops when a flag is set.

mod agreement;
mod audit;
mod collection;
mod compare;
mod control;
#[cfg(test)]
mod disturbed;
mod environment;
mod external;
mod gauge;
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
mod read;
mod report;
mod slope;
mod solo;
mod standing;
mod statistics;
mod study;
mod tame;
mod timer;
mod warnings;
mod why;
mod words;

pub use audit::{Audit, Audited, OperationBytes, audit, count_allocations};
pub use collection::{Asked, Collection, Failed, MergeError, Pooled, SecondStudy};
pub use compare::{
    Change, Changes, CompareError, Comparing, DRIFT, NewWinner, Setting, Verdict, compare,
};
pub use environment::Environment;
pub use external::{External, ExternalError, ExternalReport, PATIENCE};
pub use growth::{
    CacheEnd, Fit, GROWING, Growing, GrowthError, GrowthReport, GrowthSettings, SizeReport, Unheld,
    Weight, growth, growth_bytes,
};
pub use heap::{CacheState, CachesReport, free_memory};
pub use inspect::{Specimen, inspect};
pub use labs::Labs;
pub use measure::Progress;
pub use orders::{
    Comparison, FEW_OPERATIONS, Factor, Larger, OrderEffect, OrderRow, OrdersError, OrdersReport,
    StructureEffect, orders, orders_bytes,
};
pub use pick::{
    Answer, BreakEven, Excluded, Need, OnMesh, PartCost, PickError, Question, Ranked, UnknownNeed,
    pick,
};
pub use read::{ReadError, Results};
pub use report::{
    Agreement, BackendReport, Control, ControlRow, FIRST_TIME_SHOWN, Inspection, MeshReport,
    RawSamples, Refusal, Report, ResultRow, SCHEMA, Standing,
};
pub use sixfold_workload::pages::{self, HeapReport, Policy, UnknownPolicy};
pub use sixfold_workload::{
    Access, Action, Amount, NoPlace, Workload, WorkloadError, built_in, built_ins,
};
pub use sixfold_workload::{
    Allocated, AllocationCounter, Backend, Cache, Clock, Editing, Editor, Edits, Heap, Kind,
    MOST_SCANNED_FACES, MachineClock, MemorySpeed, NotCounted, Operation, Reads, Refiner, Refining,
    Rung, Scrubber, Series, SingleEdit, Start, TableReads, Time, UnknownOperation, Way, Weighed,
    caches, timed, unknown,
};
pub use slope::Slope;
pub use solo::{Solo, SoloRun};
pub use study::{Settings, StudyError, study};
pub use tame::tame;
pub use timer::Timer;
pub use why::{Bound, Model, Timed, Timing, Why, WhyRow, WhySettings, why};

//! Workloads, interleaved measurement and reports: which structure fits this mesh and this work?
//!
//! [`study`] builds every backend asked for, runs the [`Operation`]s on them in interleaved rounds
//! until the budget is spent, proves by checksum that all did the same work, and gives a [`Report`].
//! [`orders`] does so for one mesh in several orders, and [`growth`] for one shape in many sizes.
//! [`inspect`] says what a mesh is and which backends can hold it, and measures nothing. [`pick`]
//! answers for a workload. [`compare`] holds two studies against each other, and a [`Collection`] pools
//! those of many meshes. [`audit`] counts the bytes of each in three ways, which must agree. [`why`]
//! counts what the relations read, and holds their times against the speed of memory.
//!
//! What a reader of the figures should know is in `reports/SCHEMA.md`. This crate knows no
//! command line and prints nothing: progress goes to a closure, and a flag stops it.

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
pub use slope::Slope;
pub use solo::{Solo, SoloRun};
pub use study::{Settings, StudyError, study};
pub use tame::tame;
pub use timer::Timer;
pub use why::{Bound, Model, Timed, Timing, Why, WhyRow, WhySettings, why};
pub use workload::pages::{self, HeapReport, Policy, UnknownPolicy};
pub use workload::{Access, Action, Amount, NoPlace, Workload, WorkloadError, built_in, built_ins};
pub use workload::{
    Allocated, AllocationCounter, Backend, Cache, Clock, Editing, Editor, Edits, Heap, Kind,
    MOST_SCANNED_FACES, MachineClock, MemorySpeed, NotCounted, Operation, Reads, Refiner, Refining,
    Rung, Scrubber, Series, SingleEdit, Start, TableReads, Time, UnknownOperation, Way, Weighed,
    caches, timed, unknown,
};

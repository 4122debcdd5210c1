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
//! a workload. [`audit`] counts the bytes of each backend in three ways,
//! and reports differences between the three counts. [`why`] counts the bytes that queries read,
//! and compares the times of the queries with the speed of memory.
//!
//! [`Results`] is the document with the findings of these measurements. It is read and written as
//! JSON, written as CSV, and merged with other documents. [`compare`] compares two documents. A
//! [`Pool`] has the means over the studies of many meshes.
//!
//! # Effect on the process
//!
//! [`study()`], [`orders`], [`growth`], [`neighbours`], [`pick`], [`pick_for_programs`],
//! [`serve_program`] and [`BackendRunner`] change the settings of malloc for the whole process while
//! they measure, so that freed pages stay in the process ([`Policy::Kept`]). The settings are
//! restored at the end; [`HeapGuard`] lists what is restored. Two measurements at the same time must
//! have the same [`Policy`]: the second one otherwise returns a [`HeapPolicyConflict`]. If memory
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
pub mod packages;
mod refusal;
mod results;
mod runner;

pub use engine::effort::Effort;
pub use engine::heap::{CacheState, CachesReport, free_memory};
pub use engine::measure::Progress;
pub use engine::ranking::FEWEST_OF_A_WINNER;
pub use engine::statistics::{UNSEEN_DRIFT, median_and_deviation};
pub use engine::timer::Timer;
pub use external::isolated::{ChildTask, Isolation, serve_program};
pub use external::{EXTERNAL_TIMEOUT, External, ExternalError, ExternalReport};
pub use inspect::{Inspection, StudyMesh, inspect, inspect_diagnosed, sha256_of};
pub use labs::Slope;
pub use labs::growth::{
    BackendBytes, CacheLimit, Fit, GrowthError, GrowthReport, GrowthSettings, SCALABLE_SHAPES,
    ScalableShape, SizeReport, growth, growth_bytes, growth_plan,
};
pub use labs::memory::{Audit, BackendAudit, OperationBytes, audit, count_allocations};
pub use labs::neighbours::{
    Cheapest, CheapestIndices, IndexReport, NeighboursError, NeighboursReport, NeighboursSettings,
    QueryPoints, SpatialTask, neighbour_indices, neighbours,
};
pub use labs::orders::{
    Comparison, DEFAULT_OPERATIONS, Factor, Larger, OrderEffect, OrdersReport, StructureEffect,
    orders, orders_bytes,
};
pub use labs::pick::{
    AskedCount, BreakEven, Choice, EQUAL_UP_TO, Excluded, MeshRanking, Need, PartCost, PickError,
    PickReport, PickSettings, Predicted, Prediction, ProgramReport, ProgramSettings, Ranked,
    RecordError, RecordedProgram, TurningPoint, pick, pick_for_programs, predict, record_program,
};
pub use labs::study::{Report, Settings, StudyError, study};
pub use labs::why::{Bound, Model, Timed, Timing, Why, WhyRow, WhySettings, why};
pub use results::compare::{
    BytesChange, Change, Changes, CompareError, CompareSettings, DRIFT, Measurement,
    MeasurementPart, NewWinner, SettingChange, Verdict, compare,
};
pub use results::csv::write_csv_rows;
pub use results::document::{Failed, FailureKind, Results, SCHEMA};
pub use results::environment::Environment;
pub use results::figure::{Counted, Figure, Status};
pub use results::finding::Finding;
pub use results::merge::MergeError;
pub use results::pool::{Group, Holding, Overall, Pool, Pooled, Purpose, leaders, overall};
pub use results::quotient::{Quotient, mean_quotients};
pub use results::read::ReadError;
pub use results::rows::{
    Agreement, BackendRefusal, BackendReport, Control, ControlRow, FIRST_TIME_SHOWN, MeasuredTask,
    MeshReport, Refusal, RefusalKind, ResultRow, Samples, Standing,
};
pub use results::run::{Run, RunSettings, Start as RunStart};
pub use runner::{BackendRun, BackendRunner};
pub use sixfold::TableBytes;
pub use sixfold_workload::pages::{self, HeapGuard, HeapPolicyConflict, HeapReport, Policy};
pub use sixfold_workload::{
    Access, Action, Amount, EditPlaceError, OwnBytes, OwnData, Part, Workload, WorkloadError,
    built_in, built_ins,
};
pub use sixfold_workload::{
    Allocated, AllocationCounter, Backend, BufferSpeed, Cache, CacheFlusher, Clock, EditPass,
    Editor, Edits, ElementKind, Heap, MAX_SCANNED_FACES, MachineClock, MeasuredMemory, MemorySpeed,
    NotCounted, Operation, Reads, Refiner, Series, SingleEdit, Start, SubdivisionJob, TableReads,
    Time, Way, caches, timed,
};
pub use sixfold_workload::{
    Asked, EditProgram, MovingProgram, Outcome, Program, ProgramRefusal, Recorded, Recording,
    RefineProgram, Suite, SuiteProgram, Trace, TraceError, WalkProgram,
};

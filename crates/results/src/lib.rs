//! The results of measurements as one document, and the words that describe them.
//!
//! [`Results`] is the document with the findings of all measuring commands. It is read and written as
//! JSON, written as CSV, and merged with other documents. [`compare`] compares two documents, and a
//! [`History`] several. A [`Pool`] has the means over the studies of many meshes.
//!
//! This crate does not measure, and it has no list of the operations, the structures or the programs
//! that can be measured: a document says what was measured ([`OperationInfo`]). The file
//! `reports/SCHEMA.md` explains the values in the document.

mod compare;
mod conclusions;
mod confidence;
mod corrected;
#[cfg(feature = "csv")]
mod csv;
mod document;
mod environment;
mod figure;
mod finding;
mod findings;
mod folders;
mod history;
mod json;
pub mod launches;
mod merge;
pub mod numbers;
mod operation;
mod pool;
mod quotient;
pub mod ranking;
mod read;
mod rows;
mod run;
mod sanitize;
#[cfg(test)]
mod simulated;
pub mod statistics;
mod time;
mod timer;

pub use compare::{
    BytesChange, Change, Changes, CompareError, CompareSettings, FALSE_ALARM, Measurement,
    MeasurementPart, NewWinner, SettingChange, Verdict, compare, differences,
};
pub use conclusions::{Conclusion, Fate, conclusions};
pub use confidence::{Confidence, NotAConfidence};
pub use corrected::corrected_times;
#[cfg(feature = "csv")]
pub use csv::write_csv_rows;
pub use document::{Failed, FailureKind, Results, SCHEMA};
pub use environment::{
    Cache, CacheState, CachesReport, ClockKind, Environment, HeapReport, Policy, last_level_bytes,
};
pub use figure::{Counted, Figure, Status};
pub use finding::Finding;
pub use findings::growth::{BackendBytes, CacheLimit, Fit, GrowthReport, SizeReport};
pub use findings::memory::{Audit, BackendAudit, OperationBytes};
pub use findings::neighbours::{Cheapest, CheapestIndices, IndexReport, NeighboursReport};
pub use findings::orders::{
    Comparison, Factor, Larger, OrderEffect, OrdersReport, StructureEffect,
};
pub use findings::pick::{
    Amount, AskedCount, BreakEven, Choice, EQUAL_UP_TO, Excluded, MIX, MeshRanking, Need, OnMesh,
    OwnBytes, OwnData, PartCost, PickReport, ProgramReport, RUN, Ranked, TurningPoint,
    WorkloadPart, WorkloadReport,
};
pub use findings::slope::Slope;
pub use findings::spatial_task::{QueryPoints, SpatialTask};
pub use findings::study::{Report, describe_noise};
pub use findings::why::{Bound, BufferSpeed, Model, Reads, TableReads, Timed, Why, WhyRow};
pub use history::{History, HistoryDocument, HistoryGroup, HistoryPoint, HistoryRow, LoneDocument};
pub use json::write_json;
pub use merge::MergeError;
pub use operation::{OperationGroup, OperationInfo, Purpose};
pub use pool::{
    FEWEST_MESHES, Group, Holding, Overall, Pool, Pooled, leaders, mean_quotients, next_best,
    next_row, not_ranked, operations, overall,
};
pub use quotient::Quotient;
pub use read::ReadError;
pub use rows::{
    Agreement, BackendRefusal, BackendReport, Control, ControlRow, ExternalReport,
    FIRST_TIME_SHOWN, MeshReport, Refusal, RefusalKind, ResultRow, Samples, Standing, noise,
};
pub use run::{Run, RunSettings, Start};
pub use sanitize::sanitize;
pub use time::Time;
pub use timer::Timer;

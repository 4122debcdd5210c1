//! Workloads, interleaved measurement and reports: which structure fits this mesh and this work?
//!
//! [`study`] builds every backend asked for, runs the [`Operation`]s on them in interleaved rounds
//! until the budget is spent, proves by checksum that all did the same work, and gives a [`Report`].
//! [`inspect`] says what a mesh is and which backends can hold it, and measures nothing. [`why`] counts
//! what the relations read, and holds their times against the speed of memory.
//!
//! What a reader of the figures should know is in `reports/SCHEMA.md`. This crate knows no
//! command line and prints nothing: progress goes to a closure, and a flag stops it.

mod agreement;
mod control;
mod environment;
mod inspect;
mod measure;
mod methods;
mod plan;
mod report;
mod solo;
mod standing;
mod statistics;
mod study;
mod why;
mod words;

pub use environment::Environment;
pub use inspect::{Specimen, inspect};
pub use measure::Progress;
pub use report::{
    Agreement, BackendReport, Control, ControlRow, Inspection, MeshReport, Refusal, Report,
    ResultRow, SCHEMA, Standing,
};
pub use solo::{Solo, SoloRun};
pub use study::{Settings, StudyError, study};
pub use why::{Bound, Model, Timed, Timing, Why, WhyRow, WhySettings, why};
pub use workload::{
    Backend, Clock, Editing, Editor, Edits, Kind, MachineClock, MemorySpeed, Operation, Reads,
    Refiner, Refining, Rung, SingleEdit, TableReads, Time, UnknownOperation, Way,
};

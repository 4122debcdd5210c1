//! Workloads, interleaved measurement and reports: which structure fits this mesh and this work?
//!
//! [`study`] builds every backend asked for, runs the [`Operation`]s on them in interleaved rounds
//! until the budget is spent, proves by checksum that all did the same work, and gives a [`Report`].
//! [`orders`] does so for one mesh in several orders, and [`growth`] for one shape in many sizes.
//! [`inspect`] says what a mesh is and which backends can hold it, and measures nothing.
//!
//! What a reader of the figures should know is in `reports/SCHEMA.md`. This crate knows no
//! command line and prints nothing: progress goes to a closure, and a flag stops it.

mod agreement;
mod caches;
mod control;
mod environment;
mod growth;
mod inspect;
mod measure;
mod methods;
mod orders;
mod plan;
mod report;
mod slope;
mod solo;
mod standing;
mod statistics;
mod study;
mod words;

pub use caches::{Cache, caches};
pub use environment::Environment;
pub use growth::{
    CacheEnd, Fit, GROWING, Growing, GrowthError, GrowthReport, GrowthSettings, SizeReport, Unheld,
    Weight, growth, growth_bytes,
};
pub use inspect::{Specimen, inspect};
pub use measure::Progress;
pub use orders::{
    Comparison, FEW_OPERATIONS, Factor, Larger, OrderEffect, OrderRow, OrdersError, OrdersReport,
    StructureEffect, orders, orders_bytes,
};
pub use report::{
    Agreement, BackendReport, Control, ControlRow, Inspection, MeshReport, Refusal, Report,
    ResultRow, SCHEMA, Standing,
};
pub use slope::Slope;
pub use solo::{Solo, SoloRun};
pub use study::{Settings, StudyError, study};
pub use workload::{
    Backend, Clock, Editing, Editor, Edits, Kind, MachineClock, Operation, Refiner, Refining,
    SingleEdit, Time, UnknownOperation, Way,
};

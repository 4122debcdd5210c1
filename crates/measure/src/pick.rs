//! Ranks backends for a program or a workload, chooses one, and says why.

pub mod break_even;
mod choice;
pub mod kinds;
mod launches;
pub mod measurement;
pub mod pooled;
pub mod programs;
pub mod reasons;
pub mod recording;
pub mod tasks;

pub use break_even::MeasuredMix;
pub use choice::position;
pub use launches::pool_picks;
pub use measurement::{
    Candidate, MeasuredBackend, MeshOutcome, PickMeasurement, over_memory_limit,
};
pub use pooled::{Question, pooled};
pub use tasks::{TaskPlan, program_entry, with_own_time};

//! The measuring engine: built backends are measured in interleaved rounds, and the samples are
//! judged.

pub mod agreement;
pub mod bench;
pub mod control;
pub mod disturbance;
pub mod effort;
pub mod heap;
pub mod machine;
pub mod measure;
pub mod plan;
pub mod plan_by_count;
pub mod rows;
pub mod run;
#[cfg(any(test, feature = "simulated"))]
pub mod simulated_machine;
pub mod timer;
pub mod warnings;

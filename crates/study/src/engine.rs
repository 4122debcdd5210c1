//! The measuring engine: built backends are measured in interleaved rounds, and the samples are
//! judged.

pub(crate) mod agreement;
pub(crate) mod bench;
pub(crate) mod control;
#[cfg(test)]
mod cost;
pub(crate) mod disturbance;
pub(crate) mod effort;
pub(crate) mod heap;
pub(crate) mod machine;
pub(crate) mod measure;
pub(crate) mod plan;
pub(crate) mod plan_by_count;
pub(crate) mod rows;
pub(crate) mod run;
#[cfg(test)]
pub(crate) mod simulated_machine;
pub(crate) mod timer;
pub(crate) mod warnings;

//! Tests of the public functions of the crate.

mod counts;
mod implicit;
mod orders;
mod refusals;

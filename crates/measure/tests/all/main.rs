//! Tests of the public functions of the crate, on this machine.

mod programs;
mod usage;

//! Tests that run on each structure. They are here, so that the unit tests need not compile what the
//! library has compiled for each structure.

mod edits;
mod mix;
mod samples;
mod subdivision;

//! Tests of `sixfold-results` with the results of simulated measurements.

mod compare;
mod document;
mod pool;

//! Traces on all structures.

use sixfold_measure::{Suite, Trace};

/// Makes a program of a trace, which runs on every structure that supports its calls.
pub fn suite_of_trace(trace: Trace) -> Suite {
    sixfold_measure::suite_of_trace!(trace)
}

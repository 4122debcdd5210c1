//! The results of measurements, and the words that describe them.

pub mod numbers;
mod sanitize;

pub use sanitize::sanitize;

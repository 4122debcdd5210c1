//! Tests that run on every structure.

mod conversions;
mod examples;

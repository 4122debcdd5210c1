//! Empty library; the benchmarks are in `main.rs`.

#![no_main]
//! Reads the input as a file whose name ends in `off`.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sixfold_fuzz::read("a.off", bytes));

#![no_main]
//! Reads the input as a crease file of a cube.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sixfold_fuzz::read_creases(bytes));

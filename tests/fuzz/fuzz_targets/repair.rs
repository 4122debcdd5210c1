#![no_main]
//! Repairs a small mesh that the input describes.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sixfold_fuzz::repair_mesh(bytes));

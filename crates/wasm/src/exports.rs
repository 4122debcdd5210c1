//! The functions that the host calls.

#![expect(
    unsafe_code,
    reason = "an exported name must not be that of another function; no other code exports names"
)]

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::blocks::Blocks;

static BLOCKS: Mutex<Blocks> = Mutex::new(Blocks::new());

fn blocks() -> MutexGuard<'static, Blocks> {
    BLOCKS.lock().unwrap_or_else(PoisonError::into_inner)
}

#[unsafe(no_mangle)]
extern "C" fn reserve(length: u32) -> usize {
    blocks().reserve(length)
}

#[unsafe(no_mangle)]
extern "C" fn call(address: usize) -> usize {
    blocks().call(address)
}

#[unsafe(no_mangle)]
extern "C" fn release(address: usize) {
    blocks().release(address);
}

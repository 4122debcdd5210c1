//! The functions that the host calls.

#![expect(
    unsafe_code,
    reason = "an exported name must not be that of another function; no other code exports names"
)]

use std::cell::RefCell;

use crate::blocks::Blocks;

// A module has one thread.
thread_local! {
    static BLOCKS: RefCell<Blocks> = const { RefCell::new(Blocks::new()) };
}

#[unsafe(no_mangle)]
extern "C" fn reserve(length: u32) -> usize {
    BLOCKS.with_borrow_mut(|blocks| blocks.reserve(length))
}

#[unsafe(no_mangle)]
extern "C" fn call(address: usize) -> usize {
    BLOCKS.with_borrow_mut(|blocks| blocks.call(address))
}

#[unsafe(no_mangle)]
extern "C" fn release(address: usize) {
    BLOCKS.with_borrow_mut(|blocks| drop(blocks.release(address)));
}

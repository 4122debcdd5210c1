//! How much memory is free, before something is made that needs more.

use crate::failure::Failure;
use ::study::free_memory;
use ::study::numbers::bytes;

/// Refuses `what` if it takes more than the memory that is free; `instead` says what to do then.
pub(crate) fn check_room(what: &str, needed: u64, instead: &str) -> Result<(), Failure> {
    match free_memory() {
        Some(free) if needed > free => Err(Failure::unsupported(format!(
            "{what} takes some {}, and {} are free: {instead}",
            bytes(usize::try_from(needed).unwrap_or(usize::MAX)),
            bytes(free as usize)
        ))),
        _ => Ok(()),
    }
}

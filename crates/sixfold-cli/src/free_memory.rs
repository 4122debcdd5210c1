//! Checks the free memory before large results are made.

use crate::failure::Failure;
use sixfold_study::free_memory;
use sixfold_study::numbers::bytes;

/// Returns an error if `what` needs more than the free memory. `instead` is the recommended
/// alternative.
pub(crate) fn check_free_memory(what: &str, needed: u64, instead: &str) -> Result<(), Failure> {
    match free_memory() {
        Some(free) if needed > free => Err(Failure::unsupported(format!(
            "{what} needs about {}, but only {} are free: {instead}",
            bytes(usize::try_from(needed).unwrap_or(usize::MAX)),
            bytes(free as usize)
        ))),
        _ => Ok(()),
    }
}

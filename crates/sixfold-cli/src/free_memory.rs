//! How much memory is free, before something is made that needs more.

use sysinfo::{MemoryRefreshKind, System};

use crate::failure::Failure;
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

/// Bytes of memory that programs can still have, where the system tells.
fn free_memory() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    let free = system.available_memory();
    let allowed = system.cgroup_limits().map(|limits| limits.free_memory);
    let free = allowed.map_or(free, |allowed| free.min(allowed));
    (free > 0).then_some(free)
}

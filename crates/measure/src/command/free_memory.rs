//! Free memory, and the memory of this process.

use crate::command::failure::Failure;
use crate::free_memory;
use sixfold_results::numbers::bytes;

/// Returns an error if `what` needs more than the free memory. `instead` is the recommended
/// alternative.
pub fn check_free_memory(what: &str, needed: u64, instead: &str) -> Result<(), Failure> {
    match free_memory() {
        Some(free) if needed > free => Err(Failure::unsupported(format!(
            "{what} needs about {}, but only {} are free: {instead}",
            bytes(usize::try_from(needed).unwrap_or(usize::MAX)),
            bytes(free as usize)
        ))),
        _ => Ok(()),
    }
}

/// Returns the resident memory of this process in bytes; `None` if the platform does not tell it.
pub fn used_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn touched_memory_is_used() {
        const BYTES: usize = 64 << 20;
        let before = used_memory().expect("Linux tells it");
        let block = std::hint::black_box(vec![1_u8; BYTES]);
        let used = used_memory().expect("Linux tells it") - before;
        assert!(used > BYTES as u64 / 2, "{used}");
        drop(block);
    }
}

//! The heap that a study measures on: its policy, and memory that must not run out.

use serde::{Deserialize, Serialize};
use sysinfo::{MemoryRefreshKind, System};
use workload::pages::{self, HeapReport, Policy};
use workload::{Scrubber, Start};

use crate::numbers::bytes;

/// What is left free at least, as a part of all memory.
const LEAST_FREE: f64 = 0.05;
/// Keeping pages may double what a study holds: freed blocks of one size do not always fit another.
const KEPT: u64 = 2;
/// What is touched beyond the pages in use, as a part of them: blocks may lie elsewhere the next time.
const RESERVE: u64 = 4;

/// Whether the caches hold the mesh when a sample begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CacheState {
    /// As the runs just before have left them.
    #[default]
    Warm,
    /// They hold other data, and a sample is one run.
    Cold,
}

impl CacheState {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Warm, Self::Cold];

    /// What users call it: `warm`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Warm => "warm",
            Self::Cold => "cold",
        }
    }
}

/// What is done to the caches before each sample.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct CachesReport {
    /// Whether they hold the mesh.
    pub state: CacheState,
    /// Bytes written before each sample; 0 if warm.
    pub written_bytes: usize,
    /// The last cache level whose content that replaces, where the platform tells.
    pub defeats_level: Option<u8>,
}

/// The memory of the measurements, from the first sample to the last.
pub(crate) struct Memory {
    /// What is in force.
    pub(crate) heap: HeapReport,
    scrubber: Option<Scrubber>,
}

impl Memory {
    /// Puts `policy` into force, unless keeping pages could use up the free memory: `needed` is about
    /// how many bytes the measurements hold at once.
    pub(crate) fn start(policy: Policy, state: CacheState, needed: u64) -> Self {
        let heap = match too_little(needed, free_memory()).filter(|_| policy == Policy::Kept) {
            None => pages::put_in_force(policy),
            reason => HeapReport {
                reason,
                ..pages::put_in_force(Policy::System)
            },
        };
        Self {
            heap,
            scrubber: (state == CacheState::Cold).then(Scrubber::new),
        }
    }

    /// What a timed stretch finds.
    pub(crate) fn start_of_runs(&self) -> Start<'_> {
        match &self.scrubber {
            Some(scrubber) => Start::Cold(scrubber),
            None => Start::Warm,
        }
    }

    /// Whether samples are of cold caches.
    pub(crate) fn is_cold(&self) -> bool {
        self.scrubber.is_some()
    }

    /// Whether freed pages stay, so that no sample should have a page fault.
    pub(crate) fn keeps_pages(&self) -> bool {
        self.heap.policy == Policy::Kept
    }

    /// Touches the pages of freed blocks, and a quarter of what is resident, if they are kept and there is room:
    /// what is allocated from then on finds its pages there.
    pub(crate) fn reserve(&self) {
        self.reserve_for(pages::resident_bytes().unwrap_or(0) / RESERVE);
    }

    /// Touches a block of `bytes`, or less if there is little room, and the pages of freed blocks.
    pub(crate) fn reserve_for(&self, bytes: u64) {
        if let Some(free) = free_memory().filter(|_| self.keeps_pages()) {
            let most = free.saturating_sub(least_free()) / RESERVE;
            pages::reserve(usize::try_from(bytes.min(most)).unwrap_or(0));
        }
    }

    /// Whether `bytes` more leave enough memory free, as far as the platform tells.
    pub(crate) fn has_room_for(&self, bytes: u64) -> bool {
        free_memory().is_none_or(|free| free > least_free().saturating_add(bytes))
    }

    /// Returns the pages of freed blocks, if they are kept: until [`Memory::reserve`] what is allocated
    /// finds fresh ones.
    pub(crate) fn give_back(&self) {
        if self.keeps_pages() {
            pages::give_back();
        }
    }

    /// Stops keeping pages where memory runs out; whatever is measured from then on is on the system's heap.
    pub(crate) fn watch(&mut self) {
        if !self.keeps_pages() {
            return;
        }
        if let Some(free) = free_memory().filter(|&free| free < least_free()) {
            self.heap = pages::put_in_force(Policy::System);
            self.heap.reason = Some(format!(
                "only {} of memory were free while pages were kept, so the later samples are on the system's heap",
                shown(free)
            ));
        }
    }

    /// What is done to the caches.
    pub(crate) fn caches(&self) -> CachesReport {
        let scrubber = self.scrubber.as_ref();
        CachesReport {
            state: match scrubber {
                Some(_) => CacheState::Cold,
                None => CacheState::Warm,
            },
            written_bytes: scrubber.map_or(0, Scrubber::bytes),
            defeats_level: scrubber.and_then(Scrubber::level),
        }
    }
}

/// Why pages cannot be kept, if they cannot: what is needed may not fit into what is free.
fn too_little(needed: u64, free: Option<u64>) -> Option<String> {
    let kept = needed.saturating_mul(KEPT);
    let free = free.filter(|&free| kept > free)?;
    let [kept, free] = [kept, free].map(shown);
    Some(format!(
        "keeping freed pages could take {kept}, and {free} are free"
    ))
}

fn shown(amount: u64) -> String {
    bytes(usize::try_from(amount).unwrap_or(usize::MAX))
}

/// Bytes that must stay free.
fn least_free() -> u64 {
    let mut system = System::new();
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    let limits = system.cgroup_limits().map(|limits| limits.total_memory);
    let all = limits.map_or(system.total_memory(), |limit| {
        limit.min(system.total_memory())
    });
    (all as f64 * LEAST_FREE) as u64
}

/// Bytes of memory that this program can still have, where the system tells: the least of what is
/// free, what its control group allows and what its address space has room for.
pub fn free_memory() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    // 0 where the system does not tell.
    let free = Some(system.available_memory()).filter(|&free| free > 0);
    // Files that the group has read count as used there, and yet are given up when memory is needed.
    let group = system.cgroup_limits();
    let group = group.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    let rooms = [free, group, pages::address_space_left()];
    rooms.into_iter().flatten().min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_not_kept_where_memory_could_run_out() {
        let reason = too_little(3 << 30, Some(5 << 30)).expect("6 GiB do not fit into 5");
        assert!(
            reason.contains("could take 6.44 GB") && reason.contains("5.37 GB are free"),
            "{reason}"
        );
        assert_eq!(too_little(2 << 30, Some(5 << 30)), None);
        assert_eq!(too_little(u64::MAX, None), None, "nothing is known");
        assert!(too_little(u64::MAX, Some(1 << 40)).is_some());
    }

    #[test]
    fn cold_caches_are_filled_with_other_data() {
        let memory = Memory::start(Policy::Kept, CacheState::Cold, 0);
        assert!(memory.is_cold() && memory.caches().written_bytes > 0);
        let memory = Memory::start(Policy::Kept, CacheState::Warm, 0);
        assert!(!memory.is_cold() && memory.caches().written_bytes == 0);
    }
}

//! The heap of the measurements, and protection against running out of memory.

use crate::pages::{self, HeapGuard, HeapPolicyConflict};
use crate::{CacheFlusher, Start};
use sixfold_results::{CacheState, CachesReport, HeapReport, Policy};
use sysinfo::{MemoryRefreshKind, System};

use sixfold_results::numbers::bytes;

/// Part of all memory that must stay free.
const MIN_FREE: f64 = 0.05;
/// Maximum factor by which keeping pages increases the memory of a study. The memory grows because
/// a freed block may not fit a later request.
const KEPT_FACTOR: u64 = 2;
/// Divisor of the resident memory that gives the number of bytes to touch in advance.
const RESERVE_PART: u64 = 4;

/// The heap of a measurement. The heap policy ends when this value is dropped.
pub struct Memory {
    /// The policy of this process; `None` on a simulated machine, which has no pages.
    guard: Option<HeapGuard>,
    flusher: Option<CacheFlusher>,
}

impl Memory {
    /// Applies the heap policy to the whole process. If keeping pages could use up the free memory,
    /// no measurement in this process keeps pages from now on. `needed` is the approximate peak
    /// memory of the measurements in bytes.
    ///
    /// # Errors
    ///
    /// Returns an error if another policy is active in this process.
    pub fn start(
        policy: Policy,
        state: CacheState,
        needed: u64,
    ) -> Result<Self, HeapPolicyConflict> {
        let guard = HeapGuard::acquire(policy)?;
        if let Some(reason) = shortage_reason(needed, free_memory()) {
            guard.stop_keeping(reason);
        }
        Ok(Self {
            guard: Some(guard),
            flusher: (state == CacheState::Cold).then(CacheFlusher::new),
        })
    }

    /// Returns the memory of a simulated machine. The heap of this process stays as it is.
    #[cfg(any(test, feature = "simulated"))]
    pub fn simulated(state: CacheState) -> Self {
        Self {
            guard: None,
            flusher: (state == CacheState::Cold).then(CacheFlusher::new),
        }
    }

    /// Returns the active policy. If keeping pages was stopped since the start, the report has the
    /// reason.
    pub fn heap(&self) -> HeapReport {
        let simulated = || HeapReport {
            policy: Policy::Kept,
            reason: None,
            allocator: "none".into(),
            page_bytes: None,
            transparent_huge_pages: None,
            counts_faults: false,
        };
        self.guard
            .as_ref()
            .map_or_else(simulated, HeapGuard::report)
    }

    pub fn start_of_runs(&self) -> Start<'_> {
        match &self.flusher {
            Some(flusher) => Start::Cold(flusher),
            None => Start::Warm,
        }
    }

    pub fn is_cold(&self) -> bool {
        self.flusher.is_some()
    }

    /// Returns whether freed pages are kept. Samples then have no page faults.
    pub fn keeps_pages(&self) -> bool {
        self.guard.as_ref().is_some_and(HeapGuard::keeps_pages)
    }

    /// Touches the pages of freed blocks, so that later allocations cause no page faults. Also
    /// touches a quarter of the resident memory as a reserve. Does nothing if pages are not kept.
    pub fn reserve(&self) {
        self.reserve_for(pages::resident_bytes().unwrap_or(0) / RESERVE_PART);
    }

    /// Touches the pages of freed blocks and a block of `bytes`. The block is smaller if there is
    /// little memory.
    pub fn reserve_for(&self, bytes: u64) {
        if let Some(bytes) = self.reservable(bytes) {
            pages::reserve(bytes);
        }
    }

    /// Touches the same pages as [`reserve_for`](Self::reserve_for), in random order.
    pub fn reserve_in_random_order(&self, bytes: u64) {
        if let Some(bytes) = self.reservable(bytes) {
            pages::reserve_in_random_order(bytes);
        }
    }

    /// Returns `bytes`, or less if there is little memory. Returns `None` if pages are not kept.
    fn reservable(&self, bytes: u64) -> Option<usize> {
        let room = self.keeps_pages().then(Room::now)?;
        Some(usize::try_from(room.reservable(bytes)?).unwrap_or(0))
    }

    /// Returns whether enough memory stays free after an allocation of `bytes`. Returns true if the
    /// free memory is unknown.
    pub fn has_room_for(&self, bytes: u64) -> bool {
        self.guard.is_none() || Room::now().holds(bytes)
    }

    /// Returns whether a run can have fresh pages. A simulated machine decides by itself what such a
    /// run costs.
    pub fn can_release_pages(&self) -> bool {
        self.guard.is_none() || pages::can_release_pages()
    }

    /// Returns the pages of freed blocks to the kernel. Allocations then get fresh pages until
    /// [`Memory::reserve`] is called.
    pub fn release_pages(&self) {
        if self.keeps_pages() {
            pages::release_pages();
        }
    }

    /// Stops keeping pages in the whole process if memory runs out.
    pub fn check_free_memory(&self) {
        let Some(guard) = self.guard.as_ref().filter(|guard| guard.keeps_pages()) else {
            return;
        };
        if let Some(free) = Room::now().shortage() {
            guard.stop_keeping(format!(
                "only {} of memory were free while pages were kept, so later samples use the system's heap",
                shown(free)
            ));
        }
    }

    pub fn caches(&self) -> CachesReport {
        let flusher = self.flusher.as_ref();
        CachesReport {
            state: match flusher {
                Some(_) => CacheState::Cold,
                None => CacheState::Warm,
            },
            written_bytes: flusher.map_or(0, CacheFlusher::bytes),
            defeats_level: flusher.and_then(CacheFlusher::level),
        }
    }
}

/// Returns the reason why pages cannot be kept, if the needed memory may exceed the free memory.
fn shortage_reason(needed: u64, free: Option<u64>) -> Option<String> {
    let kept = needed.saturating_mul(KEPT_FACTOR);
    let free = free.filter(|&free| kept > free)?;
    let [kept, free] = [kept, free].map(shown);
    Some(format!(
        "keeping freed pages could take {kept} of memory, but only {free} are free"
    ))
}

fn shown(amount: u64) -> String {
    bytes(usize::try_from(amount).unwrap_or(usize::MAX))
}

/// The memory that this program can still allocate (`None` if unknown), and the bytes of it that must
/// stay free.
#[derive(Clone, Copy)]
struct Room {
    free: Option<u64>,
    least: u64,
}

impl Room {
    fn now() -> Self {
        Self {
            free: free_memory(),
            least: min_free_bytes(),
        }
    }

    /// Returns whether enough memory stays free after an allocation of `bytes`.
    fn holds(self, bytes: u64) -> bool {
        let needed = self.least.saturating_add(bytes);
        self.free.is_none_or(|free| free > needed)
    }

    /// Returns `bytes`, or a quarter of what need not stay free if this is less.
    fn reservable(self, bytes: u64) -> Option<u64> {
        let most = self.free?.saturating_sub(self.least) / RESERVE_PART;
        Some(bytes.min(most))
    }

    /// Returns the free bytes if they are fewer than must stay free.
    fn shortage(self) -> Option<u64> {
        self.free.filter(|&free| free < self.least)
    }
}

fn min_free_bytes() -> u64 {
    let mut system = System::new();
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    let limits = system.cgroup_limits().map(|limits| limits.total_memory);
    let all = limits.map_or(system.total_memory(), |limit| {
        limit.min(system.total_memory())
    });
    (all as f64 * MIN_FREE) as u64
}

/// Returns the bytes that this program can still allocate; `None` if unknown. The result is the
/// minimum of three values: the free memory, the memory that the control group still allows, and
/// the free part of the address space.
pub fn free_memory() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    // The value 0 means unknown.
    let free = Some(system.available_memory()).filter(|&free| free > 0);
    // `rss` leaves out cached files, which the kernel drops when it needs memory.
    let group = system.cgroup_limits();
    let group = group.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    let limits = [free, group, pages::address_space_left()];
    limits.into_iter().flatten().min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_not_kept_if_memory_could_run_out() {
        let reason = shortage_reason(3 << 30, Some(5 << 30)).expect("6 GiB do not fit into 5");
        assert!(
            reason.contains("could take 6.44 GB") && reason.contains("5.37 GB are free"),
            "{reason}"
        );
        assert_eq!(shortage_reason(2 << 30, Some(5 << 30)), None);
        assert_eq!(shortage_reason(u64::MAX, None), None, "nothing is known");
        assert!(shortage_reason(u64::MAX, Some(1 << 40)).is_some());
    }

    #[test]
    fn a_part_of_the_memory_stays_free() {
        let room = |free| Room { free, least: 100 };
        assert!(room(Some(151)).holds(50) && !room(Some(150)).holds(50));
        assert!(room(None).holds(u64::MAX) && !room(Some(u64::MAX)).holds(u64::MAX));
        assert_eq!(room(Some(140)).reservable(8), Some(8));
        assert_eq!(room(Some(140)).reservable(11), Some(10), "a quarter of 40");
        assert_eq!(room(Some(99)).reservable(11), Some(0));
        assert_eq!(room(None).reservable(11), None);
        assert_eq!(room(Some(99)).shortage(), Some(99));
        assert_eq!([room(Some(100)), room(None)].map(Room::shortage), [None; 2]);
    }

    #[test]
    fn cold_caches_are_filled_with_other_data() {
        let start = |state| Memory::start(Policy::Kept, state, 0).expect("the same policy");
        let memory = start(CacheState::Cold);
        assert!(memory.is_cold() && memory.caches().written_bytes > 0);
        let memory = start(CacheState::Warm);
        assert!(!memory.is_cold() && memory.caches().written_bytes == 0);
    }
}

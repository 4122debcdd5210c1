//! The allocator of the program: the system allocator with counters.

use std::alloc::System;

use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use sixfold_study::{AllocationCounter, Heap};
use stats_alloc::StatsAlloc;

/// Counts allocations and forwards every request to the system.
static LIVE: StatsAlloc<System> = StatsAlloc::system();

/// Counts the peak of allocated bytes.
#[global_allocator]
static PEAK: PeakMemAlloc<&StatsAlloc<System>> = PeakMemAlloc::new(&LIVE);

/// The counters of the allocator for all threads together.
pub(crate) struct Counters;

impl Heap for Counters {
    fn live(&self) -> usize {
        let stats = LIVE.stats();
        // The growth of a block is included in `bytes_allocated`, its shrinkage in
        // `bytes_deallocated`.
        stats
            .bytes_allocated
            .saturating_sub(stats.bytes_deallocated)
    }

    fn restart_peak(&self) {
        PEAK.reset_peak_memory();
    }

    fn peak(&self) -> usize {
        PEAK.get_peak_memory()
    }
}

impl AllocationCounter for Counters {
    fn allocated(&self) -> usize {
        LIVE.stats().bytes_allocated
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Mutex, PoisonError};

    use super::*;

    const BYTES: usize = 256 << 20;

    /// Each test holds this lock, because the counters count the whole process.
    static COUNTERS: Mutex<()> = Mutex::new(());

    /// The tolerance is large, so that allocations of other tests do not matter.
    fn about(figure: usize, expected: usize) -> bool {
        figure.abs_diff(expected) < BYTES / 8
    }

    #[test]
    fn blocks_are_counted_when_they_are_allocated_grow_shrink_and_are_freed() {
        let _counters = COUNTERS.lock().unwrap_or_else(PoisonError::into_inner);
        let before = Counters.live();
        Counters.restart_peak();
        let live = || Counters.live().saturating_sub(before);
        let mut block = Vec::<u8>::with_capacity(1);
        assert!(about(live(), 0) && about(Counters.peak(), 0));
        block.reserve_exact(BYTES);
        assert!(about(live(), BYTES), "{}", live());
        block.shrink_to(BYTES / 2);
        assert!(about(live(), BYTES / 2), "{}", live());
        drop(block);
        assert!(about(live(), 0), "{}", live());
        let zeros = vec![0_u8; BYTES / 2];
        assert!(about(live(), BYTES / 2), "{}", live());
        drop(zeros);
        assert!(about(Counters.peak(), BYTES), "{}", Counters.peak());
        Counters.restart_peak();
        assert!(about(Counters.peak(), 0), "{}", Counters.peak());
    }

    #[test]
    fn freed_blocks_stay_counted_and_growth_counts_once() {
        let _counters = COUNTERS.lock().unwrap_or_else(PoisonError::into_inner);
        let before = Counters.allocated();
        let allocated = || Counters.allocated() - before;
        drop(Vec::<u8>::with_capacity(BYTES));
        assert!(about(allocated(), BYTES), "{}", allocated());
        let mut block = Vec::<u8>::with_capacity(BYTES / 2);
        assert!(about(allocated(), BYTES / 2 * 3), "{}", allocated());
        block.reserve_exact(BYTES);
        assert!(about(allocated(), 2 * BYTES), "{}", allocated());
    }
}

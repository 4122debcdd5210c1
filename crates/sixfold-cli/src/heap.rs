//! The allocator of the program: the system's, with counters.

use std::alloc::System;

use ::study::Heap;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use stats_alloc::StatsAlloc;

/// Counts what there is; hands everything on to the system, as it was asked for.
static LIVE: StatsAlloc<System> = StatsAlloc::system();

/// Counts how much there has been at once.
#[global_allocator]
static PEAK: PeakMemAlloc<&StatsAlloc<System>> = PeakMemAlloc::new(&LIVE);

/// The counters of the allocator, over all threads.
pub(crate) struct Counters;

impl Heap for Counters {
    fn live(&self) -> usize {
        let stats = LIVE.stats();
        let live = stats.bytes_allocated - stats.bytes_deallocated;
        live.wrapping_add_signed(stats.bytes_reallocated)
    }

    fn restart_peak(&self) {
        PEAK.reset_peak_memory();
    }

    fn peak(&self) -> usize {
        PEAK.get_peak_memory()
    }
}

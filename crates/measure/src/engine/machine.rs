//! The machine on which a lab measures.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use crate::engine::disturbance::{ReferenceWork, reference_work};
use crate::engine::heap::Memory;
use crate::pages::HeapPolicyConflict;
use crate::{Clock, MachineClock, MemorySpeed, TimedBackend};
use sixfold_core::Counts;
use sixfold_results::{CacheState, Policy};

/// What a lab takes from the machine on which it runs. In tests, this is a simulated machine.
pub trait Machine: Sync {
    /// Returns the clock of all times, limits and samples of a lab.
    fn clock(&self) -> &dyn Clock;

    /// Returns the backend that is measured in the place of `built`, which was just built from a
    /// mesh with `counts`.
    fn host<'b>(
        &self,
        built: Box<dyn TimedBackend + 'b>,
        counts: &Counts,
    ) -> Box<dyn TimedBackend + 'b>;

    /// Starts the heap and the caches of a measurement, as [`Memory::start`] does.
    fn start_memory(
        &self,
        policy: Policy,
        state: CacheState,
        needed: u64,
    ) -> Result<Memory, HeapPolicyConflict>;

    /// Returns the work whose time shows whether other programs disturb the machine.
    fn reference_work(&self) -> ReferenceWork<'_>;

    /// Measures the speed of memory as [`MemorySpeed::measure`] does.
    fn memory_speed(&self, limit: Duration, stop: &AtomicBool) -> Option<MemorySpeed>;
}

/// This machine.
impl Machine for MachineClock {
    fn clock(&self) -> &dyn Clock {
        self
    }

    fn host<'b>(
        &self,
        built: Box<dyn TimedBackend + 'b>,
        _: &Counts,
    ) -> Box<dyn TimedBackend + 'b> {
        built
    }

    fn start_memory(
        &self,
        policy: Policy,
        state: CacheState,
        needed: u64,
    ) -> Result<Memory, HeapPolicyConflict> {
        Memory::start(policy, state, needed)
    }

    fn reference_work(&self) -> ReferenceWork<'_> {
        reference_work()
    }

    fn memory_speed(&self, limit: Duration, stop: &AtomicBool) -> Option<MemorySpeed> {
        MemorySpeed::measure(limit, self, stop)
    }
}

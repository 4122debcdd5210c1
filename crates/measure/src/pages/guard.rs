//! The guard that applies a heap policy to the whole process and restores the allocator.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::{
    counts_faults, faults, page_bytes, pages_of, platform, transparent_huge_pages, untouched_block,
};
use sixfold_results::{HeapReport, Policy};

/// Size of the block that tests whether pages are kept, in bytes.
const PROBE_BYTES: usize = 16 << 20;
/// Maximum number of page faults of the test block if pages are kept.
const MAX_PROBE_FAULTS: u64 = 64;

/// Whether the allocator keeps pages.
static KEEPING: AtomicBool = AtomicBool::new(false);

/// The guards of this process.
static GUARDS: Mutex<Guards> = Mutex::new(Guards {
    policy: Policy::System,
    count: 0,
    stops: 0,
    reason: String::new(),
});

struct Guards {
    /// The policy that all guards requested.
    policy: Policy,
    count: usize,
    /// Number of calls of [`HeapGuard::stop_keeping`] since the start of the process.
    stops: usize,
    /// The reason that the last of these calls gave.
    reason: String,
}

fn guards() -> MutexGuard<'static, Guards> {
    GUARDS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The error if a measurement requests another heap policy than an active one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[error(
    "the heap policy `{requested}` was requested while the policy `{active}` is active in this \
     process: request `{active}`, or wait until the other measurement has ended"
)]
pub struct HeapPolicyConflict {
    /// The policy that was requested.
    pub requested: Policy,
    /// The policy of the guards that exist.
    pub active: Policy,
}

/// A heap policy that applies to the whole process while the guard exists.
///
/// Several guards can exist at the same time if they request the same policy. When the last guard
/// is dropped, the allocator returns the kept pages to the kernel and gets its settings back. A
/// guard with [`Policy::System`] changes no setting.
///
/// # Settings that are restored
///
/// The GNU C library cannot report its settings. Therefore the last guard sets these values:
///
/// | setting | value |
/// |---|---|
/// | `M_MMAP_MAX` | 65,536 (the default) |
/// | `M_TOP_PAD` | 128 KiB (the default) |
/// | `M_ARENA_MAX` | 8 heaps for each processor, on 32 bits 2 (the default) |
/// | `M_MMAP_THRESHOLD` | 32 MiB: the value that the library reaches by itself after it freed a block of this size |
/// | `M_TRIM_THRESHOLD` | 64 MiB: likewise |
///
/// The differences to the settings before the first guard are:
///
/// - The library no longer adapts the two thresholds.
/// - Other values from `GLIBC_TUNABLES`, from variables such as `MALLOC_TOP_PAD_`, or from earlier
///   calls of `mallopt` are lost. A program that needs them calls `mallopt` again.
/// - The library reads `M_ARENA_MAX` only once, when a new thread first allocates after the value
///   was set. If this happens while pages are kept, all threads share one heap until the process
///   ends. If it happens later, the threads of later measurements have heaps of their own, which
///   keep no blocks above 64 MiB. The main thread always has the heap that keeps all blocks.
///
/// # Examples
///
/// ```standalone_crate
/// use sixfold_results::Policy;
/// use sixfold_measure::pages::HeapGuard;
///
/// let guard = HeapGuard::acquire(Policy::Kept)?;
/// let error = HeapGuard::acquire(Policy::System).unwrap_err();
/// assert_eq!(error.active, Policy::Kept);
/// drop(guard);
/// HeapGuard::acquire(Policy::System)?;
/// # Ok::<(), sixfold_measure::pages::HeapPolicyConflict>(())
/// ```
#[derive(Debug)]
#[must_use = "the policy ends when the guard is dropped"]
pub struct HeapGuard {
    /// The state when the guard was acquired.
    report: HeapReport,
    /// The value of [`Guards::stops`] when the guard was acquired.
    stops: usize,
}

impl HeapGuard {
    /// Applies the policy `requested` to the whole process. [`Policy::Kept`] becomes active only if
    /// the allocator supports the policy and a test block confirms that pages are kept;
    /// [`report`](Self::report) returns the active policy.
    ///
    /// If pages were kept but another guard has [stopped](Self::stop_keeping) this, they are kept
    /// again. The report of the other guard still names the reason.
    ///
    /// # Errors
    ///
    /// Returns an error if a guard with another policy exists.
    pub fn acquire(requested: Policy) -> Result<Self, HeapPolicyConflict> {
        let mut guards = guards();
        if guards.count > 0 && guards.policy != requested {
            return Err(HeapPolicyConflict {
                requested,
                active: guards.policy,
            });
        }
        guards.policy = requested;
        guards.count += 1;
        let reason = match requested {
            Policy::System => None,
            Policy::Kept if is_keeping() => None,
            Policy::Kept => keep().err(),
        };
        let policy = match is_keeping() {
            true => Policy::Kept,
            false => Policy::System,
        };
        Ok(Self {
            report: HeapReport {
                policy,
                reason,
                allocator: platform::allocator(),
                page_bytes: page_bytes(),
                transparent_huge_pages: transparent_huge_pages(),
                counts_faults: counts_faults(),
            },
            stops: guards.stops,
        })
    }

    /// Returns the state of the heap since the guard was acquired. If keeping pages was stopped in
    /// this time, by this guard or another, the policy is [`Policy::System`] with the reason.
    pub fn report(&self) -> HeapReport {
        let mut report = self.report.clone();
        let guards = guards();
        if report.policy == Policy::Kept && guards.stops > self.stops {
            report.policy = Policy::System;
            report.reason = Some(guards.reason.clone());
        }
        report
    }

    /// Returns whether pages have been kept since the guard was acquired.
    pub fn keeps_pages(&self) -> bool {
        self.report.policy == Policy::Kept && guards().stops == self.stops
    }

    /// Stops keeping pages in the whole process, because of `reason`, and returns the kept pages to
    /// the kernel. All guards then [report](Self::report) the reason, because the memory that runs
    /// out is the memory of all. Does nothing if no pages are kept.
    pub fn stop_keeping(&self, reason: String) {
        let mut guards = guards();
        if is_keeping() {
            guards.stops += 1;
            guards.reason = reason;
            stop_keeping();
        }
    }

    /// Applies the policy until the process ends, and returns the state of the heap. This is for
    /// the `main` function of programs that only measure.
    pub fn hold_until_exit(self) -> HeapReport {
        let report = self.report();
        std::mem::forget(self);
        report
    }
}

impl Drop for HeapGuard {
    fn drop(&mut self) {
        let mut guards = guards();
        guards.count -= 1;
        if guards.count == 0 {
            stop_keeping();
        }
    }
}

/// Returns whether the allocator keeps pages.
pub(super) fn is_keeping() -> bool {
    KEEPING.load(Ordering::Relaxed)
}

fn keep() -> Result<(), String> {
    if !platform::is_glibc_allocator() {
        return Err(
            "keeping pages needs the glibc allocator, but this program uses another allocator"
                .into(),
        );
    }
    KEEPING.store(true, Ordering::Relaxed);
    if !platform::keep() {
        stop_keeping();
        return Err("the allocator refused to keep pages".into());
    }
    // Allocate and free a block twice. By default, the pages are returned in between.
    let allocate = || {
        let mut block = untouched_block(PROBE_BYTES).unwrap_or_default();
        pages_of(&mut block).for_each(|page| {
            page[0].write(1);
        });
        black_box(block);
    };
    allocate();
    let before = faults();
    allocate();
    match (before, faults()) {
        (Some(before), Some(after)) if after - before > MAX_PROBE_FAULTS => {
            stop_keeping();
            Err(
                "the allocator accepted the option to keep pages, but returned pages to the system"
                    .into(),
            )
        }
        _ => Ok(()),
    }
}

/// Undoes [`keep`] and returns the kept pages to the kernel.
fn stop_keeping() {
    if KEEPING.swap(false, Ordering::Relaxed) {
        platform::restore();
        platform::release_pages();
    }
}

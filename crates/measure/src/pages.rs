//! Controls what the allocator does with freed pages during a measurement.
//!
//! An allocator returns large freed blocks to the kernel or keeps them. The choice depends on the
//! previous work of the program. If a returned page is used again, the processor raises a page
//! fault. Page faults can take longer than the measured operation. Therefore each measurement sets
//! a [`Policy`](sixfold_results::Policy) for freed pages. [`Policy::Kept`](sixfold_results::Policy::Kept) keeps freed pages in the process, so that timed
//! runs after a warm-up have no page faults. [`release_pages`] returns the freed pages to the
//! kernel, to measure a first run.
//!
//! # Effect on the process
//!
//! A policy applies to the whole process, also to threads that measure nothing. A [`HeapGuard`]
//! holds the policy, and all measurements of this crate and of `sixfold-study` acquire a guard. When
//! the last guard is dropped, malloc gets [its settings](HeapGuard#settings-that-are-restored)
//! back. While a guard exists, a guard with another policy is refused ([`HeapPolicyConflict`]).
//!
//! [`Policy::Kept`](sixfold_results::Policy::Kept) is implemented for the GNU C library with `mallopt`. With this policy, the
//! allocator maps no block separately, never shrinks the heap, and uses one heap for all threads. A
//! program must acquire the guard before it starts its first thread, because the C library reads
//! the number of heaps only once. If a thread has its own heap, pages of this heap stay in the
//! process, and [`release_pages`] returns only some of these pages.
//!
//! On other platforms, and with other allocators, the active policy is [`Policy::System`](sixfold_results::Policy::System).
//! [`HeapGuard::report`] returns the active policy.

mod guard;

use std::hint::black_box;
use std::mem::MaybeUninit;
use std::sync::atomic::{AtomicU64, Ordering};

pub use guard::{HeapGuard, HeapPolicyConflict};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;

/// Minimum page size of all platforms, in bytes.
const MIN_PAGE_BYTES: usize = 4096;
/// Size of the first blocks that are allocated to find freed blocks, in bytes.
const MAX_BLOCK_BYTES: usize = 1 << 20;

/// Touches the pages of all freed blocks, and the pages of one new block of `bytes` bytes. Later
/// allocations can then use these pages without page faults. Does nothing if freed pages are not
/// kept.
///
/// At most 4 GiB of freed blocks are touched, because the C library counts their bytes modulo 2³².
///
/// # Complexity
///
/// O(`bytes` + bytes of freed blocks), plus one walk over the list of freed blocks per MiB.
pub fn reserve(bytes: usize) {
    touch_free_pages(bytes, |_| {});
}

/// Touches the same pages as [`reserve`], but in random order. The kernel then assigns physical
/// pages to large tables in random order. The physical pages determine the cache sets that a table
/// uses, so the cache sets do not depend on earlier work.
pub fn reserve_in_random_order(bytes: usize) {
    /// Number of calls. It is the seed, so that each call has a different order.
    static CALLS: AtomicU64 = AtomicU64::new(0);
    let mut random = ChaCha8Rng::seed_from_u64(CALLS.fetch_add(1, Ordering::Relaxed));
    touch_free_pages(bytes, |pages| pages.shuffle(&mut random));
}

/// An unused page of memory.
type FreePage<'b> = &'b mut [MaybeUninit<u8>];

/// Touches the pages of a block of `bytes` and of all freed blocks, after `arrange` has sorted the
/// pages. Does nothing if freed pages are not kept.
fn touch_free_pages(bytes: usize, arrange: impl FnOnce(&mut [FreePage<'_>])) {
    if !guard::is_keeping() {
        return;
    }
    let mapped = platform::mapped_bytes();
    let block = untouched_block(bytes);
    // A full heap of a thread cannot grow: the block is then mapped, and its pages are not kept.
    let block = block.filter(|_| platform::mapped_bytes() == mapped);
    let free_bytes = platform::free_bytes();
    let mut blocks = free_blocks(free_bytes, platform::heap_bytes);
    blocks.extend(block);
    touch(&mut blocks, arrange);
}

/// Allocates blocks of `free_bytes` in total at most, as long as the heap does not grow. All blocks
/// exist at the same time, so that no memory is part of two blocks. The blocks become smaller and
/// smaller, because small blocks fit anywhere.
fn free_blocks(free_bytes: usize, heap_bytes: impl Fn() -> Option<u32>) -> Vec<Vec<u8>> {
    let mut blocks = Vec::new();
    let mut left = free_bytes;
    let mut size = MAX_BLOCK_BYTES;
    let mut heap = heap_bytes();
    while size >= MIN_PAGE_BYTES && heap.is_some() {
        let block = (size <= left).then(|| untouched_block(size)).flatten();
        let now = heap_bytes();
        match block {
            Some(block) if now == heap => {
                blocks.push(block);
                left -= size;
            }
            _ => size /= 2,
        }
        heap = now;
    }
    blocks
}

/// Touches all pages of `blocks` after `arrange` has sorted the pages.
fn touch(blocks: &mut [Vec<u8>], arrange: impl FnOnce(&mut [FreePage<'_>])) {
    let mut pages: Vec<_> = blocks.iter_mut().flat_map(pages_of).collect();
    arrange(&mut pages);
    for page in pages {
        page[0].write(1);
    }
    black_box(blocks);
}

fn pages_of(block: &mut Vec<u8>) -> impl Iterator<Item = FreePage<'_>> {
    block.spare_capacity_mut().chunks_mut(MIN_PAGE_BYTES)
}

/// Allocates `bytes` without touching them. Returns `None` if there is too little memory.
fn untouched_block(bytes: usize) -> Option<Vec<u8>> {
    let mut block: Vec<u8> = Vec::new();
    block.try_reserve_exact(bytes).ok()?;
    Some(block)
}

/// Returns the pages of all freed blocks to the kernel, if the allocator supports this.
pub fn release_pages() {
    platform::release_pages();
}

/// Returns true if the allocator supports [`release_pages`].
pub fn can_release_pages() -> bool {
    platform::is_glibc_allocator()
}

/// Returns the bytes of this process that are in main memory, if known.
pub fn resident_bytes() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = pages.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(pages * page_bytes()?)
}

/// Returns the number of bytes by which the address space can still grow; `None` if there is no
/// known limit.
#[cfg(unix)]
pub fn address_space_left() -> Option<u64> {
    use nix::sys::resource::{RLIM_INFINITY, Resource, getrlimit};
    let (limit, _) = getrlimit(Resource::RLIMIT_AS).ok()?;
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = pages.split_ascii_whitespace().next()?.parse().ok()?;
    let used = pages * page_bytes()?;
    (limit != RLIM_INFINITY).then(|| limit.saturating_sub(used))
}

/// Returns the number of bytes by which the address space can still grow; `None` if there is no
/// known limit.
#[cfg(not(unix))]
pub fn address_space_left() -> Option<u64> {
    None
}

/// Returns the number of page faults of the current thread that needed no disk read; `None` if page
/// faults are not counted.
#[cfg(any(target_os = "linux", target_os = "android"))]
pub fn faults() -> Option<u64> {
    use nix::sys::resource::{UsageWho, getrusage};
    let usage = getrusage(UsageWho::RUSAGE_THREAD).ok()?;
    u64::try_from(usage.minor_page_faults()).ok()
}

/// Returns the number of page faults of the current thread that needed no disk read; `None` if page
/// faults are not counted.
#[cfg(not(any(target_os = "linux", target_os = "android")))]
pub fn faults() -> Option<u64> {
    None
}

/// Returns true if page faults are counted. Some sandboxes do not count page faults.
pub fn counts_faults() -> bool {
    use std::sync::OnceLock;
    static COUNTS: OnceLock<bool> = OnceLock::new();
    *COUNTS.get_or_init(|| {
        let before = faults();
        // The stack of a new thread causes page faults even if the heap keeps its pages.
        let after = std::thread::spawn(|| {
            std::hint::black_box([1_u8; 1 << 16]);
            faults()
        });
        let after = after.join().ok().flatten();
        before.is_some() && after.is_some_and(|faults| faults > 0)
    })
}

#[cfg(unix)]
fn page_bytes() -> Option<u64> {
    let bytes = nix::unistd::sysconf(nix::unistd::SysconfVar::PAGE_SIZE).ok()??;
    u64::try_from(bytes).ok()
}

#[cfg(not(unix))]
fn page_bytes() -> Option<u64> {
    None
}

/// Returns the active mode, which Linux marks with brackets.
fn transparent_huge_pages() -> Option<String> {
    let modes = std::fs::read_to_string("/sys/kernel/mm/transparent_hugepage/enabled").ok()?;
    bracketed(&modes).map(str::to_owned)
}

fn bracketed(modes: &str) -> Option<&str> {
    let (_, from) = modes.split_once('[')?;
    Some(from.split_once(']')?.0)
}

/// Calls to the GNU C library. This is the only file of the workspace with unsafe code. The calls
/// control the allocator or read its counts. They take and return plain numbers.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
mod platform {
    use std::ffi::CStr;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// Size of a test block in bytes. The size is unusual, so that other threads are unlikely to
    /// allocate it.
    const TEST_BLOCK_BYTES: usize = (1 << 20) + 4096 * 3;
    /// Maximum number of attempts to find the test block in the counts of the allocator.
    const ATTEMPTS: usize = 1000;
    /// Minimum growth of the heap, in bytes.
    const STEP: libc::c_int = 1 << 20;
    /// Maximum number of heaps for each processor, by default.
    const HEAPS_PER_CORE: usize = if cfg!(target_pointer_width = "32") {
        2
    } else {
        8
    };

    /// Sets the options of `Policy::Kept`. Returns whether the allocator
    /// accepts them.
    pub(super) fn keep() -> bool {
        let options = [
            (libc::M_ARENA_MAX, 1),
            (libc::M_MMAP_MAX, 0),
            (libc::M_TRIM_THRESHOLD, -1), // as unsigned: the largest number
            (libc::M_TOP_PAD, STEP),
        ];
        set(&options)
    }

    /// Sets the defaults, and the thresholds that glibc reaches by itself after large blocks were
    /// freed. After this call, glibc no longer adapts the thresholds.
    pub(super) fn restore() {
        let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
        let heaps = libc::c_int::try_from(cores * HEAPS_PER_CORE).unwrap_or(libc::c_int::MAX);
        let options = [
            (libc::M_ARENA_MAX, heaps),
            (libc::M_MMAP_MAX, 65536),
            (libc::M_MMAP_THRESHOLD, 32 << 20),
            (libc::M_TRIM_THRESHOLD, 64 << 20),
            (libc::M_TOP_PAD, 128 << 10),
        ];
        set(&options);
    }

    fn set(options: &[(libc::c_int, libc::c_int)]) -> bool {
        options.iter().all(|&(option, value)| {
            // SAFETY: `mallopt` may be called at any time from any thread (it takes the lock of the
            // main heap) and reads only its two numbers.
            unsafe { libc::mallopt(option, value) == 1 }
        })
    }

    pub(super) fn release_pages() {
        // SAFETY: `malloc_trim` may be called at any time from any thread; it takes the locks of
        // all heaps, and returns only pages that lie within freed blocks.
        unsafe { libc::malloc_trim(0) };
    }

    /// Returns the counts of the allocator modulo 2³². Older systems do not have `mallinfo2`.
    fn info() -> libc::mallinfo {
        // SAFETY: `mallinfo` may be called at any time from any thread, and returns plain numbers.
        unsafe { libc::mallinfo() }
    }

    /// Returns the size of the heap and of the mapped blocks in bytes, modulo 2³².
    pub(super) fn heap_bytes() -> Option<u32> {
        let info = info();
        Some(info.arena.wrapping_add(info.hblkhd).cast_unsigned())
    }

    /// Returns the size of the blocks that are mapped separately in bytes, modulo 2³².
    pub(super) fn mapped_bytes() -> u32 {
        info().hblkhd.cast_unsigned()
    }

    /// Returns the number of bytes in freed blocks of the heap, modulo 2³².
    pub(super) fn free_bytes() -> usize {
        info().fordblks.cast_unsigned() as usize
    }

    /// Returns the number of allocated bytes, modulo 2³².
    fn used() -> u32 {
        let info = info();
        info.uordblks.wrapping_add(info.hblkhd).cast_unsigned()
    }

    /// Returns whether Rust allocates from the GNU C library. If so, the counts include a test
    /// block. Many attempts can be needed, because other threads may allocate at the same time.
    /// Found once, the allocator stays the same.
    pub(super) fn is_glibc_allocator() -> bool {
        static FOUND: AtomicBool = AtomicBool::new(false);
        let is_counted = || {
            let before = used();
            let block: Vec<u8> = Vec::with_capacity(TEST_BLOCK_BYTES);
            let grown = used().wrapping_sub(before) as usize;
            std::hint::black_box(&block);
            (TEST_BLOCK_BYTES..2 * TEST_BLOCK_BYTES).contains(&grown)
        };
        if !FOUND.load(Ordering::Relaxed) && (0..ATTEMPTS).any(|_| is_counted()) {
            FOUND.store(true, Ordering::Relaxed);
        }
        FOUND.load(Ordering::Relaxed)
    }

    pub(super) fn allocator() -> String {
        // SAFETY: `gnu_get_libc_version` returns a static string that ends with a zero byte.
        let version = unsafe { CStr::from_ptr(libc::gnu_get_libc_version()) };
        match is_glibc_allocator() {
            true => format!("glibc {}", version.to_string_lossy()),
            false => "of the program".into(),
        }
    }
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
mod platform {
    pub(super) fn keep() -> bool {
        false
    }

    pub(super) fn restore() {}

    pub(super) fn release_pages() {}

    pub(super) fn heap_bytes() -> Option<u32> {
        None
    }

    pub(super) fn mapped_bytes() -> u32 {
        0
    }

    pub(super) fn free_bytes() -> usize {
        0
    }

    pub(super) fn is_glibc_allocator() -> bool {
        false
    }

    pub(super) fn allocator() -> String {
        format!("of {}", std::env::consts::OS)
    }
}

#[cfg(test)]
mod tests {
    use sixfold_results::Policy;

    use super::*;

    #[test]
    fn names_parse_to_their_policies() {
        for policy in Policy::ALL {
            assert_eq!(policy.name().parse(), Ok(policy));
        }
        let error = "keep".parse::<Policy>().unwrap_err().to_string();
        assert!(error.contains("`keep`") && error.contains("`kept`"));
    }

    #[test]
    fn every_page_of_a_block_is_touched_once_in_the_arranged_order() {
        let mut blocks: Vec<_> = untouched_block(64 * MIN_PAGE_BYTES).into_iter().collect();
        let mut touched = 0;
        touch(&mut blocks, |pages| {
            touched = pages.len();
            let mut starts: Vec<_> = pages.iter().map(|page| page.as_ptr()).collect();
            starts.sort_unstable();
            starts.dedup();
            assert_eq!(starts.len(), touched, "no page twice");
            pages.reverse();
        });
        assert_eq!(touched, blocks[0].capacity().div_ceil(MIN_PAGE_BYTES));
        assert!(touched >= 64, "{touched}");
    }

    #[test]
    fn blocks_end_at_the_free_bytes_of_a_heap_that_never_grows() {
        // By default, glibc maps such blocks, so that they leave the size of the heap unchanged.
        let taken = |free_bytes| {
            let blocks = free_blocks(free_bytes, || Some(1 << 20));
            blocks.iter().map(Vec::capacity).sum::<usize>()
        };
        let free_bytes = 5 * MAX_BLOCK_BYTES + 3 * MIN_PAGE_BYTES;
        assert_eq!(taken(free_bytes), free_bytes);
        assert_eq!(taken(MIN_PAGE_BYTES - 1), 0);
        assert_eq!(free_blocks(free_bytes, || None).len(), 0, "an unknown heap");
    }

    #[test]
    fn blocks_end_when_the_heap_grows() {
        let sizes = std::cell::Cell::new(0);
        let growing = || {
            sizes.set(sizes.get() + 1);
            Some(sizes.get())
        };
        assert_eq!(free_blocks(usize::MAX, growing).len(), 0);
    }

    #[test]
    fn the_active_mode_is_in_brackets() {
        assert_eq!(bracketed("always [madvise] never\n"), Some("madvise"));
        assert_eq!(bracketed("never"), None);
    }
}

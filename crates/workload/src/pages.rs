//! What the program's allocator does with freed pages while times are measured.
//!
//! An allocator returns large freed blocks to the kernel, or keeps them, depending on what ran before.
//! Each page that was returned costs a page fault and is cleared again when it is next used, which can
//! take longer than the operation that is measured. So the policy is a part of the experiment:
//! [`Policy::Kept`] makes freed pages stay with the process, so that after a warm-up no sample pays for
//! one; [`give_back`] returns them on purpose, for the cost of a first time.
//!
//! `Kept` is implemented for the GNU C library, by `mallopt`: no block is mapped by itself, the heap is
//! never trimmed, and all threads share one heap, so that a block that one thread freed serves another.
//! The last holds only if the policy is put in force before the program starts its first thread: glibc
//! reads the number of heaps once. Threads that have a heap of their own keep its pages, too, but
//! [`give_back`] returns only a part of them.
//! Elsewhere, and in programs whose allocator is another one, the policy in force is
//! [`Policy::System`], and [`put_in_force`] says so.

use std::fmt;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

/// What happens to freed pages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Policy {
    /// They stay with the process: what allocates again finds them, already touched.
    #[default]
    Kept,
    /// Whatever the platform's allocator does.
    System,
}

impl Policy {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Kept, Self::System];

    /// What users call it: `kept`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::System => "system",
        }
    }
}

impl fmt::Display for Policy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no policy has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no heap policy `{name}`: choose `kept` or `system`")]
pub struct UnknownPolicy {
    /// The name.
    pub name: String,
}

impl FromStr for Policy {
    type Err = UnknownPolicy;

    fn from_str(name: &str) -> Result<Self, UnknownPolicy> {
        let mut all = Self::ALL.into_iter();
        all.find(|policy| policy.name() == name)
            .ok_or_else(|| UnknownPolicy { name: name.into() })
    }
}

/// The heap that a program measures on.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct HeapReport {
    /// The policy in force.
    pub policy: Policy,
    /// Why it is not the one that was asked for.
    #[serde(default)]
    pub reason: Option<String>,
    /// The allocator with its version, where the platform tells: `glibc 2.36`.
    pub allocator: String,
    /// Bytes of a page, where the platform tells.
    pub page_bytes: Option<u64>,
    /// The mode of transparent huge pages, where the platform has them: `madvise`.
    pub transparent_huge_pages: Option<String>,
    /// Whether page faults are counted.
    pub counts_faults: bool,
}

/// Puts `asked` into force for the whole program, and says what is in force: `Kept` only where the
/// allocator of the program can be told, and a probe shows that it obeys.
pub fn put_in_force(asked: Policy) -> HeapReport {
    let reason = match asked {
        Policy::System => {
            stop_keeping();
            None
        }
        Policy::Kept => keep().err(),
    };
    HeapReport {
        policy: match (asked, &reason) {
            (Policy::Kept, None) => Policy::Kept,
            _ => Policy::System,
        },
        reason,
        allocator: platform::allocator(),
        page_bytes: page_bytes(),
        transparent_huge_pages: transparent_huge_pages(),
        counts_faults: counts_faults(),
    }
}

/// Makes freed pages stay with the process.
fn keep() -> Result<(), String> {
    if !platform::is_ours() {
        return Err("this program has an allocator of its own, or the platform's cannot be told to keep pages".into());
    }
    KEEPING.store(true, Ordering::Relaxed);
    if !platform::keep() {
        stop_keeping();
        return Err("the allocator refused to keep pages".into());
    }
    // A block that would be returned otherwise: used, freed, and used again.
    let block = || drop(touched_block(PROBE_BYTES));
    block();
    let before = faults();
    block();
    match (before, faults()) {
        (Some(before), Some(after)) if after - before > MOST_PROBE_FAULTS => {
            stop_keeping();
            Err("the allocator was told to keep pages, and returned them".into())
        }
        _ => Ok(()),
    }
}

/// Whether pages were kept at some time: only then there is something to undo.
static KEEPING: AtomicBool = AtomicBool::new(false);

/// Undoes [`keep`], and returns what was kept.
fn stop_keeping() {
    if KEEPING.swap(false, Ordering::Relaxed) {
        platform::restore();
        platform::give_back();
    }
}

/// The block that shows whether pages are kept.
const PROBE_BYTES: usize = 16 << 20;
/// It has thousands of pages; a few others may fault meanwhile.
const MOST_PROBE_FAULTS: u64 = 64;
/// No platform has smaller pages.
const LEAST_PAGE: usize = 4096;
/// Freed blocks are looked for in steps of this size, halved until none is left.
const LARGEST_FREED: usize = 1 << 20;

/// Touches `bytes` in one block and the pages of all freed blocks, so that what is allocated later finds
/// its pages there: those that [`give_back`] returned are taken from the kernel again. Of no use unless
/// pages are kept. O(`bytes` + bytes of freed blocks), and a walk over the list of freed blocks for each
/// MiB of them.
pub fn reserve(bytes: usize) {
    let block = touched_block(bytes);
    // All at once, so that no two are the same; larger ones first, for the small ones fit anywhere.
    let mut blocks = Vec::new();
    let mut size = LARGEST_FREED;
    let mut heap = platform::heap_bytes();
    while size >= LEAST_PAGE && heap.is_some() {
        let block = touched_block(size);
        let now = platform::heap_bytes();
        match block {
            Some(block) if now == heap => blocks.push(block),
            _ => size /= 2,
        }
        heap = now;
    }
    drop((block, blocks));
}

/// Allocates `bytes` and writes to each page; `None` where there is too little memory.
fn touched_block(bytes: usize) -> Option<Vec<u8>> {
    let mut block: Vec<u8> = Vec::new();
    block.try_reserve_exact(bytes).ok()?;
    for page in block.spare_capacity_mut().chunks_mut(LEAST_PAGE) {
        page[0].write(1);
    }
    Some(std::hint::black_box(block))
}

/// Returns the pages of all freed blocks to the kernel, so that what allocates next pays for fresh
/// ones. Nothing where the allocator cannot be asked to.
pub fn give_back() {
    platform::give_back();
}

/// Whether [`give_back`] can: whether the allocator is one that it knows.
pub fn can_give_back() -> bool {
    platform::is_ours()
}

/// Bytes of this process that are in memory, where the platform tells.
pub fn resident_bytes() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = pages.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(pages * page_bytes()?)
}

/// Bytes that the address space of this process may still grow by, where it has a limit.
#[cfg(unix)]
pub fn address_space_left() -> Option<u64> {
    use nix::sys::resource::{RLIM_INFINITY, Resource, getrlimit};
    let (limit, _) = getrlimit(Resource::RLIMIT_AS).ok()?;
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = pages.split_ascii_whitespace().next()?.parse().ok()?;
    let used = pages * page_bytes()?;
    (limit != RLIM_INFINITY).then(|| limit.saturating_sub(used))
}

/// Bytes that the address space of this process may still grow by, where it has a limit.
#[cfg(not(unix))]
pub fn address_space_left() -> Option<u64> {
    None
}

/// Page faults of this thread so far that needed no disk; `None` where the platform does not count them.
#[cfg(any(target_os = "linux", target_os = "android"))]
pub fn faults() -> Option<u64> {
    use nix::sys::resource::{UsageWho, getrusage};
    let usage = getrusage(UsageWho::RUSAGE_THREAD).ok()?;
    u64::try_from(usage.minor_page_faults()).ok()
}

/// Page faults of this thread so far that needed no disk; `None` where the platform does not count them.
#[cfg(not(any(target_os = "linux", target_os = "android")))]
pub fn faults() -> Option<u64> {
    None
}

/// Whether page faults are counted: some sandboxes answer, and always with the same number.
pub fn counts_faults() -> bool {
    use std::sync::OnceLock;
    static COUNTS: OnceLock<bool> = OnceLock::new();
    *COUNTS.get_or_init(|| {
        let before = faults();
        // A new thread has a new stack, whatever the heap keeps.
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

/// The mode in force, which Linux marks by brackets.
fn transparent_huge_pages() -> Option<String> {
    let modes = std::fs::read_to_string("/sys/kernel/mm/transparent_hugepage/enabled").ok()?;
    bracketed(&modes).map(str::to_owned)
}

fn bracketed(modes: &str) -> Option<&str> {
    let (_, from) = modes.split_once('[')?;
    Some(from.split_once(']')?.0)
}

/// The GNU C library. The only file of the workspace with unsafe code: calls to options of the
/// allocator, which take and return plain numbers.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
mod platform {
    use std::ffi::CStr;

    /// A block that no other thread allocates by chance between two looks.
    const WITNESS: usize = (1 << 20) + 4096 * 3;
    /// How often the allocator is looked at before it is taken for another one.
    const LOOKS: usize = 16;
    /// The heap grows by at least this much at a time.
    const STEP: libc::c_int = 1 << 20;

    /// Tells the allocator to map no block by itself, never to trim its heap, and to have one heap for
    /// all threads.
    pub(super) fn keep() -> bool {
        let options = [
            (libc::M_ARENA_MAX, 1),
            (libc::M_MMAP_MAX, 0),
            (libc::M_TRIM_THRESHOLD, -1), // as unsigned: the largest number there is
            (libc::M_TOP_PAD, STEP),
        ];
        set(&options)
    }

    /// The values that glibc comes to in a program that has freed large blocks: its thresholds, once set, no
    /// longer adapt themselves. All threads still share one heap.
    pub(super) fn restore() {
        let options = [
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
            // main heap) and reads nothing but its two numbers.
            unsafe { libc::mallopt(option, value) == 1 }
        })
    }

    pub(super) fn give_back() {
        // SAFETY: `malloc_trim` may be called at any time from any thread; it takes the locks of all
        // heaps, and returns only pages that lie within freed blocks.
        unsafe { libc::malloc_trim(0) };
    }

    /// The figures are modulo 2³²: `mallinfo2` counts further, and older systems lack it.
    fn info() -> libc::mallinfo {
        // SAFETY: `mallinfo` may be called at any time from any thread, and returns plain numbers.
        unsafe { libc::mallinfo() }
    }

    /// Bytes that the heap has grown to.
    pub(super) fn heap_bytes() -> Option<u32> {
        Some(info().arena.cast_unsigned())
    }

    /// Bytes that are allocated.
    fn used() -> u32 {
        let info = info();
        info.uordblks.wrapping_add(info.hblkhd).cast_unsigned()
    }

    /// Whether what Rust allocates comes from the GNU C library: its own count shows it. Other threads may
    /// allocate meanwhile, so that one look out of a few has to show it.
    pub(super) fn is_ours() -> bool {
        let shows = || {
            let before = used();
            let block: Vec<u8> = Vec::with_capacity(WITNESS);
            let grown = used().wrapping_sub(before) as usize;
            std::hint::black_box(&block);
            (WITNESS..2 * WITNESS).contains(&grown)
        };
        (0..LOOKS).any(|_| shows())
    }

    pub(super) fn allocator() -> String {
        // SAFETY: `gnu_get_libc_version` returns a static string that ends with a zero byte.
        let version = unsafe { CStr::from_ptr(libc::gnu_get_libc_version()) };
        match is_ours() {
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

    pub(super) fn give_back() {}

    pub(super) fn heap_bytes() -> Option<u32> {
        None
    }

    pub(super) fn is_ours() -> bool {
        false
    }

    pub(super) fn allocator() -> String {
        format!("of {}", std::env::consts::OS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn policies_are_found_by_name() {
        for policy in Policy::ALL {
            assert_eq!(policy.name().parse(), Ok(policy));
        }
        let error = "keep".parse::<Policy>().unwrap_err().to_string();
        assert!(error.contains("`keep`") && error.contains("`kept`"));
    }

    #[test]
    fn the_mode_in_force_is_in_brackets() {
        assert_eq!(bracketed("always [madvise] never\n"), Some("madvise"));
        assert_eq!(bracketed("never"), None);
    }
}

//! The program and the machine that measured.

use serde::{Deserialize, Serialize};

use crate::numbers::bytes;

/// The program and the machine of a measurement.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Environment {
    /// Version of Sixfold.
    pub sixfold: String,
    /// Git commit of the program, with `-dirty` if files were changed after the commit. `None` if
    /// the program was built outside a repository.
    pub commit: Option<String>,
    /// Version of the Rust compiler.
    pub rustc: String,
    /// Build profile: `release`, `dist` (with link-time optimisation) or `debug`.
    pub profile: String,
    /// Optimisation level of the timed code: `0` to `3`, `s` or `z`.
    pub opt_level: String,
    /// Additional flags of the Rust compiler.
    pub rustflags: String,
    /// The cargo features with which `sixfold-workload` was built. Empty if it was built without features.
    pub features: Vec<String>,
    /// Target triple of the build.
    pub target: String,
    /// Operating system.
    pub os: String,
    /// Release of the kernel; `None` if unknown.
    pub kernel: Option<String>,
    /// Architecture of the processor.
    pub arch: String,
    /// Model of the processor; `None` if unknown.
    pub cpu_model: Option<String>,
    /// Number of threads that can run at the same time.
    pub cores: Option<usize>,
    /// Caches of the first processor core; empty if unknown.
    pub caches: Vec<Cache>,
    /// Size of the main memory, in bytes; `None` if unknown.
    pub memory_bytes: Option<u64>,
    /// Frequency governor of the processor, such as `performance`; `None` if unknown.
    pub governor: Option<String>,
    /// True if the processor may exceed its nominal frequency for a short time; `None` if unknown.
    pub boost: Option<bool>,
    /// Clock that measured the times.
    pub clock: ClockKind,
    /// The allocator, and what happens to freed memory pages; `None` if nothing was timed.
    pub heap: Option<HeapReport>,
    /// How the caches were prepared before each sample; `None` if nothing was timed.
    pub cache_state: Option<CachesReport>,
}

impl Environment {
    /// Returns phrases that describe the settings of the heap and of the caches.
    pub fn memory_phrases(&self) -> Vec<String> {
        let mut phrases = Vec::new();
        if let Some(heap) = &self.heap {
            let pages = match heap.policy {
                Policy::Kept => "freed pages kept",
                Policy::System => "system heap",
            };
            phrases.push(format!("{pages} ({})", heap.allocator));
        }
        let caches = self.cache_state.as_ref();
        if let Some(caches) = caches.filter(|caches| caches.state == CacheState::Cold) {
            let level = caches.defeats_level.map_or(String::new(), |level| {
                format!(", twice the size of the level-{level} cache")
            });
            let written = bytes(caches.written_bytes);
            phrases.push(format!(
                "cold caches ({written} written before each sample{level})"
            ));
        }
        phrases
    }

    /// Returns the names of the heap policy and of the cache state. Times with different settings
    /// cannot be compared.
    pub fn memory_settings(&self) -> [&'static str; 2] {
        let heap = self
            .heap
            .as_ref()
            .map_or(Policy::System, |heap| heap.policy);
        let caches = self
            .cache_state
            .as_ref()
            .map_or(CacheState::Warm, |c| c.state);
        [heap.name(), caches.name()]
    }
}

sixfold_core::named! {
    /// A clock that measures times.
    #[derive(Default)]
    pub enum ClockKind: "clock" {
        /// The processor time of the measuring thread.
        ThreadCpu = "thread-cpu",
        /// The elapsed time.
        #[default]
        Wall = "wall",
    }
}

impl ClockKind {
    /// Returns what the clock measures, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::ThreadCpu => "processor time of the thread",
            Self::Wall => "wall time",
        }
    }
}

sixfold_core::named! {
    /// A rule for the memory pages of freed blocks.
    #[derive(Default)]
    pub enum Policy: "heap policy" {
        /// Freed pages stay in the process. Later allocations use the freed pages again, without
        /// page faults.
        #[default]
        Kept = "kept",
        /// The allocator decides by its own rules which freed pages it keeps.
        System = "system",
    }
}

/// The state of the heap during a measurement.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct HeapReport {
    /// The active policy. It can differ from the requested policy.
    pub policy: Policy,
    /// The reason why the requested policy is not active; `None` if the requested policy is active.
    pub reason: Option<String>,
    /// The name and version of the allocator, such as `glibc 2.36`.
    pub allocator: String,
    /// Size of a memory page in bytes, if known.
    pub page_bytes: Option<u64>,
    /// The mode of transparent huge pages, if known: `always`, `madvise` or `never`.
    pub transparent_huge_pages: Option<String>,
    /// True if page faults are counted.
    pub counts_faults: bool,
}

sixfold_core::named! {
    /// The state of the processor caches when a sample (a timed series of runs) begins.
    #[derive(Default)]
    pub enum CacheState: "cache state" {
        /// The caches keep the data of the previous runs.
        #[default]
        Warm = "warm",
        /// The caches hold other data than the mesh. With cold caches, only one run is timed at
        /// once.
        Cold = "cold",
    }
}

/// How the processor caches are prepared before each timed sample.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct CachesReport {
    /// The state of the caches when a sample begins.
    pub state: CacheState,
    /// Number of bytes that are written before each sample to replace the content of the caches; 0
    /// if the caches are warm.
    pub written_bytes: usize,
    /// Highest cache level whose content is replaced. `None` if the caches are warm or the level is
    /// unknown.
    pub defeats_level: Option<u8>,
}

/// A cache of a processor.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Cache {
    /// The level of the cache. The cache of level 1 is the nearest to the processor.
    pub level: u8,
    /// The content of the cache: `data`, `instruction`, or `unified` for data and instructions.
    pub kind: String,
    /// The size of the cache in bytes.
    pub bytes: u64,
    /// The number of processors that share the cache, if known.
    pub shared_by: Option<usize>,
}

impl Cache {
    /// Returns true if the cache holds data.
    pub fn holds_data(&self) -> bool {
        self.kind != "instruction"
    }
}

/// Returns the size of the last-level data cache in bytes, if known.
pub fn last_level_bytes(caches: &[Cache]) -> Option<u64> {
    let data = caches.iter().filter(|cache| cache.holds_data());
    data.max_by_key(|cache| cache.level)
        .map(|cache| cache.bytes)
}

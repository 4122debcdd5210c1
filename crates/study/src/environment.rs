//! The machine and the program that a report is of.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};
use workload::MachineClock;

use crate::heap::{CacheState, CachesReport, Memory};
use crate::numbers::bytes;
use workload::pages::{HeapReport, Policy};
use workload::{Cache, caches};

/// What else a figure depends on.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Environment {
    /// What was typed, where a program tells: it makes the figures again.
    #[serde(default)]
    pub command: Option<String>,
    /// The version of Sixfold.
    pub sixfold: String,
    /// The commit that the program was built from, `-dirty` where files differed from it; `None` where
    /// it was not built from a repository.
    pub commit: Option<String>,
    /// The compiler.
    pub rustc: String,
    /// The build profile: `release`.
    pub profile: String,
    /// The optimisation level: `3`.
    pub opt_level: String,
    /// Further flags of the compiler.
    pub rustflags: String,
    /// What the program was built for.
    pub target: String,
    /// The operating system.
    pub os: String,
    /// The release of its kernel, where the platform tells.
    pub kernel: Option<String>,
    /// The architecture.
    pub arch: String,
    /// The processor, where the platform tells.
    pub cpu_model: Option<String>,
    /// How many threads it can run at once.
    pub cores: Option<usize>,
    /// The caches of its first core; empty where the platform does not tell.
    pub caches: Vec<Cache>,
    /// Bytes of memory, where the platform tells.
    pub memory_bytes: Option<u64>,
    /// What decides the frequency of the processor, where the platform tells: `performance`.
    pub governor: Option<String>,
    /// Whether the processor may run faster than its nominal frequency for a while, where the platform
    /// tells.
    pub boost: Option<bool>,
    /// Runnable threads over the last minute when the study began, where the platform tells.
    pub load_average: Option<f64>,
    /// The clock that the figures are of: `thread-cpu` or `wall`.
    pub clock: String,
    /// The heap that operations allocate from; `None` in results of older versions, which measured on
    /// the system's.
    #[serde(default)]
    pub heap: Option<HeapReport>,
    /// What was done to the caches before each sample; `None` in results of older versions: nothing.
    #[serde(default)]
    pub cache_state: Option<CachesReport>,
    /// Seconds since 1970 when the study began.
    pub unix_time: u64,
    /// What decided samples and orders.
    pub seed: u64,
    /// How long the study was to take, in seconds.
    pub budget_s: f64,
}

impl Environment {
    /// This machine, now.
    pub fn here(seed: u64, budget_s: f64) -> Self {
        let what = RefreshKind::nothing()
            .with_cpu(CpuRefreshKind::nothing())
            .with_memory(MemoryRefreshKind::nothing().with_ram());
        let system = System::new_with_specifics(what);
        let cpu = system
            .cpus()
            .first()
            .map(|cpu| cpu.brand().trim().to_owned());
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            command: None,
            sixfold: env!("CARGO_PKG_VERSION").into(),
            commit: option_env!("STUDY_COMMIT").map(str::to_owned),
            rustc: env!("STUDY_RUSTC").into(),
            profile: env!("STUDY_PROFILE").into(),
            opt_level: env!("STUDY_OPT_LEVEL").into(),
            rustflags: env!("STUDY_RUSTFLAGS").into(),
            target: env!("STUDY_TARGET").into(),
            os: std::env::consts::OS.into(),
            kernel: System::kernel_version(),
            arch: std::env::consts::ARCH.into(),
            cpu_model: cpu.filter(|model| !model.is_empty()),
            cores: std::thread::available_parallelism().ok().map(Into::into),
            caches: caches(),
            memory_bytes: Some(system.total_memory()).filter(|&bytes| bytes > 0),
            governor: line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
            boost: boost(),
            load_average: cfg!(unix).then(|| System::load_average().one),
            clock: MachineClock::name().into(),
            heap: None,
            cache_state: None,
            unix_time: since.map_or(0, |time| time.as_secs()),
            seed,
            budget_s,
        }
    }

    /// The same, with the heap and the caches of the measurements.
    pub(crate) fn with_memory(self, memory: &Memory) -> Self {
        Self {
            heap: Some(memory.heap.clone()),
            cache_state: Some(memory.caches()),
            ..self
        }
    }

    /// The heap and the caches in words, for a line that says how it was measured.
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
                format!(", twice the level-{level} cache")
            });
            let written = bytes(caches.written_bytes);
            phrases.push(format!(
                "cold caches ({written} written before each sample{level})"
            ));
        }
        phrases
    }

    /// The heap policy and the cache state in force, as two words: figures of different ones are not to
    /// be mixed.
    pub fn memory_words(&self) -> [&'static str; 2] {
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

/// Whether the processor may go beyond its nominal frequency, as the drivers of Linux tell it.
fn boost() -> Option<bool> {
    let of_acpi = line("/sys/devices/system/cpu/cpufreq/boost").map(|text| text == "1");
    let of_intel = || line("/sys/devices/system/cpu/intel_pstate/no_turbo").map(|text| text == "0");
    of_acpi.or_else(of_intel)
}

/// What stands in a file of one line that Linux keeps.
fn line(path: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    Some(text.trim().to_owned())
}

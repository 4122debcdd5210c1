//! Description of the program and the machine that measured.

use std::fs;

use serde::{Deserialize, Serialize};
use sixfold_workload::MachineClock;
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

use crate::engine::heap::{CacheState, CachesReport, Memory};
use sixfold_results::numbers::bytes;
use sixfold_workload::pages::{HeapReport, Policy};
use sixfold_workload::{Cache, caches};

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
    /// Optimisation level: `0` to `3`, `s` or `z`.
    pub opt_level: String,
    /// Additional flags of the Rust compiler.
    pub rustflags: String,
    /// The cargo features with which `sixfold-study` was built. Empty if it was built without features.
    #[serde(default)]
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
    /// Clock that measured the times: `thread-cpu` (processor time of the thread) or `wall`
    /// (elapsed time).
    pub clock: String,
    /// The allocator, and what happens to freed memory pages; `None` if nothing was timed.
    pub heap: Option<HeapReport>,
    /// How the caches were prepared before each sample; `None` if nothing was timed.
    pub cache_state: Option<CachesReport>,
}

impl Environment {
    /// Describes the program and the machine.
    pub(crate) fn detect() -> Self {
        let what = RefreshKind::nothing()
            .with_cpu(CpuRefreshKind::nothing())
            .with_memory(MemoryRefreshKind::nothing().with_ram());
        let system = System::new_with_specifics(what);
        let cpu = system
            .cpus()
            .first()
            .map(|cpu| cpu.brand().trim().to_owned());
        Self {
            sixfold: env!("CARGO_PKG_VERSION").into(),
            commit: option_env!("STUDY_COMMIT").map(str::to_owned),
            rustc: env!("STUDY_RUSTC").into(),
            profile: env!("STUDY_PROFILE").into(),
            opt_level: env!("STUDY_OPT_LEVEL").into(),
            rustflags: env!("STUDY_RUSTFLAGS").into(),
            features: env!("STUDY_FEATURES")
                .split_terminator(',')
                .map(str::to_owned)
                .collect(),
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
            clock: MachineClock::name().into(),
            heap: None,
            cache_state: None,
        }
    }

    pub(crate) fn with_memory(self, memory: &Memory) -> Self {
        Self {
            heap: Some(memory.heap()),
            cache_state: Some(memory.caches()),
            ..self
        }
    }

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

/// Reads from Linux whether the processor may exceed its nominal frequency.
fn boost() -> Option<bool> {
    let of_acpi = line("/sys/devices/system/cpu/cpufreq/boost").map(|text| text == "1");
    let of_intel = || line("/sys/devices/system/cpu/intel_pstate/no_turbo").map(|text| text == "0");
    of_acpi.or_else(of_intel)
}

fn line(path: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    Some(text.trim().to_owned())
}

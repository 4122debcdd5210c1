//! The machine and the program that a report is of.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use workload::MachineClock;

/// What else a figure depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Environment {
    /// The version of Sixfold.
    pub sixfold: String,
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
    /// The architecture.
    pub arch: String,
    /// The processor, where the platform tells.
    pub cpu_model: Option<String>,
    /// How many threads it can run at once.
    pub cores: Option<usize>,
    /// Bytes of memory, where the platform tells.
    pub memory_bytes: Option<u64>,
    /// Runnable threads over the last minute when the study began, where the platform tells.
    pub load_average: Option<f64>,
    /// The clock that the figures are of: `thread-cpu` or `wall`.
    pub clock: String,
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
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            sixfold: env!("CARGO_PKG_VERSION").into(),
            rustc: env!("STUDY_RUSTC").into(),
            profile: env!("STUDY_PROFILE").into(),
            opt_level: env!("STUDY_OPT_LEVEL").into(),
            rustflags: env!("STUDY_RUSTFLAGS").into(),
            target: env!("STUDY_TARGET").into(),
            os: std::env::consts::OS.into(),
            arch: std::env::consts::ARCH.into(),
            cpu_model: field("/proc/cpuinfo", "model name"),
            cores: std::thread::available_parallelism().ok().map(Into::into),
            memory_bytes: field("/proc/meminfo", "MemTotal").and_then(|text| {
                let kibibytes: u64 = text.strip_suffix(" kB")?.parse().ok()?;
                Some(kibibytes * 1024)
            }),
            load_average: fs::read_to_string("/proc/loadavg")
                .ok()
                .and_then(|text| text.split(' ').next()?.parse().ok()),
            clock: MachineClock::name().into(),
            unix_time: since.map_or(0, |time| time.as_secs()),
            seed,
            budget_s,
        }
    }
}

/// The value of the first line `key : value` of a file that Linux keeps.
fn field(path: &str, key: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    let (_, value) = line.split_once(':')?;
    Some(value.trim().to_owned())
}

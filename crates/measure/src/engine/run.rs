//! What is known about a measurement when it begins: the machine, the program and the time.

use std::fs;
use std::sync::OnceLock;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::{COMPILATION, MachineClock, Operation, caches};
use sixfold_results::{Environment, Run, RunSettings, Start};
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

/// The commit of Sixfold that was compiled, if this package does not know it.
static COMMIT: OnceLock<&'static str> = OnceLock::new();

/// Sets the commit of all measurements of this process. A second commit is ignored.
pub fn set_commit(commit: &'static str) {
    _ = COMMIT.set(commit);
}

/// Describes a measurement that begins now.
pub fn start_run(settings: RunSettings) -> Run {
    Run {
        command: None,
        settings,
        environment: environment(),
        operations: Operation::ALL.map(Operation::info).into(),
        start: start(),
        ..Run::default()
    }
}

/// Returns the current time and load.
fn start() -> Start {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    Start {
        unix_time: since.map_or(0, |time| time.as_secs()),
        load_average: cfg!(unix).then(|| System::load_average().one),
    }
}

/// Describes the program and the machine.
fn environment() -> Environment {
    let what = RefreshKind::nothing()
        .with_cpu(CpuRefreshKind::nothing())
        .with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(what);
    let cpu = system
        .cpus()
        .first()
        .map(|cpu| cpu.brand().trim().to_owned());
    let commit = COMMIT.get().copied().or(option_env!("MEASURE_COMMIT"));
    Environment {
        sixfold: env!("CARGO_PKG_VERSION").into(),
        commit: commit.map(str::to_owned),
        rustc: COMPILATION.rustc.into(),
        profile: COMPILATION.profile.into(),
        opt_level: COMPILATION.opt_level.into(),
        rustflags: COMPILATION.rustflags.into(),
        features: (COMPILATION.features)
            .split_terminator(',')
            .map(str::to_owned)
            .collect(),
        target: COMPILATION.target.into(),
        os: std::env::consts::OS.into(),
        kernel: System::kernel_version(),
        arch: std::env::consts::ARCH.into(),
        cpu_model: cpu.filter(|model| !model.is_empty()),
        cores: std::thread::available_parallelism().ok().map(Into::into),
        caches: caches(),
        memory_bytes: Some(system.total_memory()).filter(|&bytes| bytes > 0),
        governor: line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
        boost: boost(),
        clock: MachineClock::kind(),
        heap: None,
        cache_state: None,
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

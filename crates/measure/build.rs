//! Records the compiler and its flags for `compilation.rs`.

use std::env;
use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

fn main() {
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(rustc).arg("--version").output().ok();
    let version = version.and_then(|output| String::from_utf8(output.stdout).ok());
    let version = version.map_or("unknown".into(), |text| text.trim().to_owned());
    println!("cargo::rustc-env=MEASURE_RUSTC={version}");
    println!("cargo::rustc-env=MEASURE_PROFILE={}", profile());
    let target = env::var("TARGET").unwrap_or_else(|_| "unknown".into());
    println!("cargo::rustc-env=MEASURE_TARGET={target}");
    // Cargo separates the flags by the character U+001F.
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    println!(
        "cargo::rustc-env=MEASURE_RUSTFLAGS={}",
        flags.replace('\u{1f}', " ")
    );
    // In the workspace of Sixfold, this package would be compiled again after each commit.
    if env::var_os("SIXFOLD_WORKSPACE").is_none()
        && let Some(commit) = git(&["describe", "--always", "--dirty", "--abbrev=12"])
    {
        println!("cargo::rustc-env=MEASURE_COMMIT={commit}");
        if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"])
            && Path::new(&log).exists()
        {
            println!("cargo::rerun-if-changed={log}");
        }
    }
    println!("cargo::rerun-if-env-changed=SIXFOLD_WORKSPACE");
    // Cargo sets `CARGO_FEATURE_NAME` for each feature of this package that is on.
    let features = env::vars().filter_map(|(name, _)| {
        let feature = name.strip_prefix("CARGO_FEATURE_")?;
        // Tests of this workspace turn it on; it changes no timed code.
        let is_for_tests = feature == "SIMULATED";
        (!is_for_tests).then(|| feature.to_lowercase().replace('_', "-"))
    });
    let mut features: Vec<String> = features.collect();
    features.sort();
    println!("cargo::rustc-env=MEASURE_FEATURES={}", features.join(","));
    println!("cargo::rerun-if-changed=build.rs");
}

/// Returns the name of the profile: `release`, `dist` or `debug`. Cargo does not pass the name to
/// build scripts, but each profile has its own output folder.
fn profile() -> String {
    let inherits = env::var("PROFILE").unwrap_or_else(|_| "unknown".into());
    let out = env::var("OUT_DIR").unwrap_or_default();
    // `…/target/dist/build/sixfold-measure-0123456789abcdef/out`
    let folder = Path::new(&out).ancestors().nth(3);
    let name = folder.and_then(Path::file_name).and_then(OsStr::to_str);
    name.map_or(inherits, str::to_owned)
}

/// Returns the output of git on one line; `None` without git or a repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let text = text.trim();
    (output.status.success() && !text.is_empty()).then(|| text.to_owned())
}

//! Passes the version and the flags of the compiler on to the programs, which report them.

use std::env;
use std::process::Command;

fn main() {
    let rustc = env::var_os("RUSTC").expect("cargo names the compiler");
    let output = Command::new(rustc).arg("--version").output();
    let version = output.expect("the compiler can be started").stdout;
    let version = String::from_utf8_lossy(&version);
    // Without the commit and the date of the compiler.
    let version = version.split(" (").next().unwrap_or_default().trim();
    let optimised = env::var("OPT_LEVEL").unwrap_or_default();
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    let flags = flags.replace('\x1f', " ");
    // Link-time optimisation is set in the profile of this workspace.
    let described = format!("{version} -O{optimised}, link-time optimisation, {flags}");
    println!(
        "cargo::rustc-env=COMPILER={}",
        described.trim_end_matches([',', ' '])
    );
    println!("cargo::rerun-if-changed=build.rs");
}

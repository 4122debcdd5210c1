//! Tells the report by which compiler and with which flags it was built.

use std::env;
use std::process::Command;

fn main() {
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(rustc).arg("--version").output().ok();
    let version = version.and_then(|output| String::from_utf8(output.stdout).ok());
    let version = version.map_or("unknown".into(), |text| text.trim().to_owned());
    println!("cargo::rustc-env=STUDY_RUSTC={version}");
    for name in ["PROFILE", "OPT_LEVEL", "TARGET"] {
        let value = env::var(name).unwrap_or_else(|_| "unknown".into());
        println!("cargo::rustc-env=STUDY_{name}={value}");
    }
    // Cargo parts the flags by an unprintable character.
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    println!(
        "cargo::rustc-env=STUDY_RUSTFLAGS={}",
        flags.replace('\u{1f}', " ")
    );
    println!("cargo::rerun-if-changed=build.rs");
}

//! Records the optimisation level of the structures, for programs that measure them: a build script sees only the level of
//! its own package, and the packages that measure have another one.

fn main() {
    let level = std::env::var("OPT_LEVEL").unwrap_or_else(|_| "unknown".into());
    println!("cargo::rustc-env=CORE_OPT_LEVEL={level}");
    println!("cargo::rerun-if-changed=build.rs");
}

//! How the timed code was compiled.

/// How the structures and this crate were compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Compilation {
    /// Version of the Rust compiler.
    pub rustc: &'static str,
    /// Build profile, such as `release`.
    pub profile: &'static str,
    /// Optimisation level of the structures: `0` to `3`, `s` or `z`. Other crates of a program can have
    /// another level.
    pub opt_level: &'static str,
    /// Additional flags of the Rust compiler, separated by spaces.
    pub rustflags: &'static str,
    /// The cargo features of the crate `sixfold-measure`, separated by commas.
    pub features: &'static str,
    /// Target triple.
    pub target: &'static str,
}

/// How the structures and this crate were compiled.
pub const COMPILATION: Compilation = Compilation {
    rustc: env!("MEASURE_RUSTC"),
    profile: env!("MEASURE_PROFILE"),
    opt_level: sixfold_core::OPT_LEVEL,
    rustflags: env!("MEASURE_RUSTFLAGS"),
    features: env!("MEASURE_FEATURES"),
    target: env!("MEASURE_TARGET"),
};

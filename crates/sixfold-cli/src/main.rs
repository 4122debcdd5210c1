//! The `sixfold` command. The crate documentation is in `lib.rs`.

mod heap;

use std::process::ExitCode;

fn main() -> ExitCode {
    sixfold_cli::sixfold(&heap::Counters)
}

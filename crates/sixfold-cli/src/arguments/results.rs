//! The files with results that all measuring commands and `sixfold merge` can write.

use std::path::PathBuf;

use clap::Args;

/// The files to write; `-` is standard output.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ResultFiles {
    /// Write all results as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write the figures as CSV, one per row (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Write the time of each sample as CSV, one per row (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) samples_csv: Option<PathBuf>,
}

impl ResultFiles {
    /// Returns the options with their paths.
    pub(crate) fn options(&self) -> [(&'static str, Option<&PathBuf>); 3] {
        [
            ("--json", self.json.as_ref()),
            ("--csv", self.csv.as_ref()),
            ("--samples-csv", self.samples_csv.as_ref()),
        ]
    }
}

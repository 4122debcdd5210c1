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
    /// Write the answer and all tables as Markdown (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) markdown: Option<PathBuf>,
    /// Keep KEY=VALUE in the results; may be repeated
    #[arg(long = "tag", value_name = "KEY=VALUE", value_parser = tag)]
    pub(crate) tags: Vec<(String, String)>,
    /// Keep the results as the baseline NAME, in the folder .sixfold
    #[arg(long, value_name = "NAME", value_parser = baseline_name)]
    pub(crate) save_baseline: Option<String>,
    /// Compare the results with the baseline NAME, as `sixfold compare` does
    #[arg(long, value_name = "NAME", value_parser = baseline_name)]
    pub(crate) baseline: Option<String>,
}

/// Parses the name of a baseline, which is the name of a file.
fn baseline_name(text: &str) -> Result<String, String> {
    let fits = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    match !text.is_empty() && !text.starts_with('.') && text.chars().all(fits) {
        true => Ok(text.to_owned()),
        false => Err("write letters, digits, hyphens, underscores and dots".into()),
    }
}

use sixfold_measure::command::arguments::tag;

impl ResultFiles {
    /// Returns the options with their paths.
    pub(crate) fn options(&self) -> [(&'static str, Option<&PathBuf>); 4] {
        [
            ("--json", self.json.as_ref()),
            ("--csv", self.csv.as_ref()),
            ("--samples-csv", self.samples_csv.as_ref()),
            ("--markdown", self.markdown.as_ref()),
        ]
    }
}

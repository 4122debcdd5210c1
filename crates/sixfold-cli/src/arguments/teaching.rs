//! Arguments of the commands that show how structures work.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;

use super::{ReadFiles, backend};

const TABLES_EXAMPLES: &str = "Examples:
  sixfold tables                                        a cube in a half-edge mesh
  sixfold tables cube.obj --backend half-edge
  sixfold tables cube.obj --all                         all structures
  sixfold tables bunny.obj --rows 100..110              eleven rows of a large mesh
  sixfold tables cube.obj --backend corner-table --markdown -    for slides

A row of a table is named by a letter and a number: v vertex, e edge, h half-edge, f face, c corner,
p place in a list. The fields have the names of textbooks. A field with a * is not stored: it follows
from the number of the row, or from other fields.

Exit codes: 0 success; 2 wrong usage or unusable input; 3 the structure cannot hold the mesh.";

/// Show the tables of a data structure, row by row.
///
/// The rows are read from the structure itself. Without a mesh, the command shows a cube.
#[derive(Debug, Args)]
#[command(after_help = TABLES_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Tables {
    /// The mesh (- for standard input); without it, a cube
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// Show these data structures, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend, default_value = "half-edge")]
    pub(crate) backend: Vec<String>,
    /// Show all data structures, side by side where the terminal is wide enough
    #[arg(long, conflicts_with = "backend")]
    pub(crate) all: bool,
    /// Show only these rows of each table, the last one included
    #[arg(long, value_name = "FROM..TO", value_parser = rows)]
    pub(crate) rows: Option<Range<usize>>,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Write the tables as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write one line for each field as CSV (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Write the tables as Markdown (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) markdown: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

/// Parses `3..7`: the rows 3 to 7.
fn rows(text: &str) -> Result<Range<usize>, String> {
    let ends = text.split_once("..").and_then(|(from, to)| {
        let ends = [from, to].map(|end| end.trim().parse::<usize>().ok());
        ends[0].zip(ends[1])
    });
    match ends {
        Some((from, to)) if from <= to => Ok(from..to.saturating_add(1)),
        Some((from, to)) => Err(format!(
            "row {from} comes after row {to}: write {to}..{from}"
        )),
        None => Err("write the first and the last row, such as 100..110".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_row_is_included() {
        assert_eq!(rows("3..7"), Ok(3..8));
        assert_eq!(rows("0 .. 0"), Ok(0..1));
        let reversed = rows("7..3").expect_err("reversed");
        assert_eq!(reversed, "row 7 comes after row 3: write 3..7");
        for text in ["", "3", "..", "3..", "-1..4", "a..b", "3...5"] {
            assert!(rows(text).is_err(), "{text}");
        }
        let last = rows(&format!("0..{}", usize::MAX)).expect("a range");
        assert_eq!(last.end, usize::MAX);
    }
}

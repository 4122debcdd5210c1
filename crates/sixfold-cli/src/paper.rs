//! The folder of `--figures`, with the files for a paper.
//!
//! ```text
//! DIR/ID.svg, ID.pdf             each figure with its letters; no PDF if the font lacks a letter
//! DIR/ID.csv, ID.txt             the data and the caption of the figure
//! DIR/results.tex, results.md    tables
//! DIR/methods.md                 how the results were measured
//! DIR/sixfold-files.txt          the names of these files
//! ```

use sixfold_report::{PaperFiles, ReportPage};
use sixfold_results::Results;

use crate::failure::Failure;
use crate::listed_folder::ListedFolder;
use crate::text::print_notice;

/// Writes the files for a paper on `results` if `--figures` is given, `mm` wide. A figure without a recorded
/// command shows `command`.
pub(crate) fn write_if(
    folder: Option<&ListedFolder>,
    results: &Results,
    command: &str,
    mm: Option<f64>,
) -> Result<(), Failure> {
    let Some(folder) = folder else {
        return Ok(());
    };
    let results = results.without_folders();
    write(
        folder,
        ReportPage::new(&results, command).paper(&results, mm),
    )
}

/// Writes drawn figures, and prints a notice for each figure without a PDF file.
pub(crate) fn write(folder: &ListedFolder, paper: PaperFiles) -> Result<(), Failure> {
    folder.write(paper.files)?;
    for missing in paper.missing {
        print_notice(&format!("note: {missing}"));
    }
    for wider in paper.wider {
        print_notice(&format!(
            "note: {} is {:.0} mm wide: narrower, its letters would be smaller than 7 points",
            wider.id, wider.mm
        ));
    }
    Ok(())
}

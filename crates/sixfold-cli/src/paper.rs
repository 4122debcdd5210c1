//! The folder of `--figures`, with the files for a paper.
//!
//! ```text
//! DIR/ID.svg, ID.pdf             each figure
//! DIR/ID.csv, ID.txt             the data and the caption of the figure
//! DIR/results.tex, results.md    tables
//! DIR/methods.md                 how the results were measured
//! DIR/sixfold-files.txt          the names of these files
//! ```

use sixfold_report::{PaperFile, PdfError, ReportPage};
use sixfold_study::Results;

use crate::failure::Failure;
use crate::listed_folder::ListedFolder;
use crate::text::print_notice;

/// Writes the files for a paper on `results` if `--figures` is given. A figure without a recorded
/// command shows `command`.
pub(crate) fn write_if(
    folder: Option<&ListedFolder>,
    results: &Results,
    command: &str,
) -> Result<(), Failure> {
    let Some(folder) = folder else {
        return Ok(());
    };
    write(folder, ReportPage::new(results, command).paper(results))
}

/// Writes drawn figures, and says if this program cannot write PDF files.
pub(crate) fn write(
    folder: &ListedFolder,
    files: Result<Vec<PaperFile>, PdfError>,
) -> Result<(), Failure> {
    folder.write(files.map_err(Failure::usage)?)?;
    if cfg!(not(feature = "pdf")) {
        print_notice("note: no PDF files: this program was built without the feature `pdf`");
    }
    Ok(())
}

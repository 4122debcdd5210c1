//! The files for a paper: each figure as SVG and PDF, with its data and its caption; tables for LaTeX
//! and Markdown; and a description of the methods.

pub(crate) mod methods;
mod tables;
mod tex;

use std::fmt::Write as _;

use sixfold_study::Results;

use crate::{Figure, PdfError, ReportPage};

/// A file for a paper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaperFile {
    /// The name of the file, such as `heat-map.pdf`.
    pub name: String,
    /// The content of the file.
    pub bytes: Vec<u8>,
}

impl PaperFile {
    fn new(name: impl Into<String>, content: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            bytes: content.into(),
        }
    }
}

impl ReportPage {
    /// Returns the files for a paper. `results` are the results that the page shows.
    ///
    /// Each figure has four files: `ID.svg`, `ID.pdf`, `ID.csv` (the data, see
    /// [`Figure::csv`]) and `ID.txt` (the caption), where ID is the `id` of the
    /// figure. Without the feature `pdf`, the PDF files are left out. `results.tex` and `results.md`
    /// have the same tables, and `methods.md` describes how the results were measured.
    ///
    /// # Errors
    ///
    /// Returns an error if a figure cannot be drawn as PDF.
    pub fn paper(&self, results: &Results) -> Result<Vec<PaperFile>, PdfError> {
        let mut files = Vec::new();
        for figure in self.all_figures() {
            let id = &figure.id;
            files.push(PaperFile::new(format!("{id}.svg"), figure.picture.svg()));
            #[cfg(feature = "pdf")]
            files.push(PaperFile::new(format!("{id}.pdf"), figure.picture.pdf()?));
            files.push(PaperFile::new(format!("{id}.csv"), &*figure.csv));
            files.push(PaperFile::new(format!("{id}.txt"), caption(figure)));
        }
        let tables = tables::tables(results);
        files.push(PaperFile::new("results.tex", tex::document(&tables)));
        files.push(PaperFile::new("results.md", tables::markdown(&tables)));
        files.push(PaperFile::new("methods.md", methods::methods(results)));
        Ok(files)
    }
}

/// Returns the caption of a figure as text.
fn caption(figure: &Figure) -> String {
    let Figure {
        id, title, caption, ..
    } = figure;
    let mut text = format!("{title}.\n\n{caption}\n\nData: {id}.csv\n");
    let _ = writeln!(text, "Measured: {}", figure.source);
    let _ = writeln!(text, "Command: {}", figure.command);
    text
}

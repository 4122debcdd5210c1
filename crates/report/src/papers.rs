//! The files for a paper: each figure as SVG and PDF, with its data and its caption; tables for LaTeX
//! and Markdown; and a description of the methods.

pub(crate) mod methods;
mod tables;
mod tex;

use std::fmt::Write as _;

use sixfold_study::Results;

use crate::{Figure, PdfError, ReportPage};

/// A file for a paper, or of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaperFile {
    /// The name of the file, such as `heat-map.pdf` or `figures/heat-map.svg`.
    pub name: String,
    /// The content of the file.
    pub bytes: Vec<u8>,
}

impl PaperFile {
    /// Returns a file with `content`.
    pub fn new(name: impl Into<String>, content: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            bytes: content.into(),
        }
    }
}

impl ReportPage {
    /// Returns the files for a paper. `results` are the results that the page shows.
    ///
    /// Each figure has four files (see [`Self::figure_files`]): `ID.svg`, `ID.pdf`, `ID.csv` (the data, see
    /// [`Figure::csv`]) and `ID.txt` (the caption), where ID is the `id` of the
    /// figure. Without the feature `pdf`, the PDF files are left out. `results.tex` and `results.md`
    /// have the same tables, and `methods.md` describes how the results were measured.
    ///
    /// # Errors
    ///
    /// Returns an error if a figure cannot be drawn as PDF.
    pub fn paper(&self, results: &Results) -> Result<Vec<PaperFile>, PdfError> {
        let mut files = self.figure_files()?;
        let tables = tables::tables(results);
        files.push(PaperFile::new("results.tex", tex::document(&tables)));
        files.push(PaperFile::new("results.md", tables::markdown(&tables)));
        files.push(PaperFile::new("methods.md", methods::methods(results)));
        Ok(files)
    }

    /// Returns the files of each figure for a paper: `ID.svg`, `ID.pdf`, `ID.csv` and `ID.txt`.
    ///
    /// # Errors
    ///
    /// Returns an error if a figure cannot be drawn as PDF.
    pub fn figure_files(&self) -> Result<Vec<PaperFile>, PdfError> {
        let mut files = Vec::new();
        for figure in self.all_figures() {
            let id = &figure.id;
            files.push(PaperFile::new(format!("{id}.svg"), figure.picture.svg()));
            #[cfg(feature = "pdf")]
            files.push(PaperFile::new(format!("{id}.pdf"), figure.picture.pdf()?));
            files.push(PaperFile::new(format!("{id}.csv"), &*figure.csv));
            files.push(PaperFile::new(format!("{id}.txt"), caption(figure)));
        }
        Ok(files)
    }
}

impl ReportPage {
    /// Returns the files of the page: `report.html`, `report.md` and `figures/ID.svg`.
    pub fn files(&self) -> Vec<PaperFile> {
        let pages = [
            PaperFile::new("report.html", self.html()),
            PaperFile::new("report.md", self.markdown()),
        ];
        let figures = self.all_figures().map(|figure| {
            let name = format!("figures/{}.svg", figure.id);
            PaperFile::new(name, figure.picture.svg())
        });
        pages.into_iter().chain(figures).collect()
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

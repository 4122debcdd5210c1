//! The files for a paper: each figure as SVG and PDF, with its data and its caption; tables for LaTeX
//! and Markdown; and a description of the methods.

pub(crate) mod methods;
mod tables;
mod tex;

use std::fmt::Write as _;

use sixfold_results::Results;
use thiserror::Error;

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

/// The files for a paper, and the figures without a PDF file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PaperFiles {
    /// The files.
    pub files: Vec<PaperFile>,
    /// The PDF files that are missing.
    pub missing: Vec<NoPdf>,
}

/// A figure has no PDF file. Its other files are complete.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{id}.pdf is not written: {cause}; {id}.svg has the figure")]
#[non_exhaustive]
pub struct NoPdf {
    /// The id of the figure.
    pub id: String,
    /// Why the picture cannot be written as PDF.
    #[source]
    pub cause: PdfError,
}

impl ReportPage {
    /// Returns the files for a paper. `results` are the results that the page shows.
    ///
    /// Each figure has four files (see [`Self::figure_files`]): `ID.svg`, `ID.pdf`, `ID.csv` (the data, see
    /// [`Figure::csv`]) and `ID.txt` (the caption), where ID is the `id` of the
    /// figure. `results.tex` and `results.md` have the same tables, and `methods.md` describes how the results
    /// were measured.
    pub fn paper(&self, results: &Results) -> PaperFiles {
        let mut paper = self.figure_files();
        let tables = tables::tables(results);
        paper.files.extend([
            PaperFile::new("results.tex", tex::document(&tables)),
            PaperFile::new("results.md", tables::markdown(&tables)),
            PaperFile::new("methods.md", methods::methods(results)),
        ]);
        paper
    }

    /// Returns the files of each figure for a paper: `ID.svg`, `ID.pdf`, `ID.csv` and `ID.txt`. The PDF file is
    /// left out if the font of PDF files does not have all letters of the picture.
    pub fn figure_files(&self) -> PaperFiles {
        let mut paper = PaperFiles::default();
        for figure in self.all_figures() {
            let id = &figure.id;
            let files = &mut paper.files;
            let svg = figure.light_svg();
            files.push(PaperFile::new(format!("{id}.svg"), svg));
            match figure.picture.pdf() {
                Ok(pdf) => files.push(PaperFile::new(format!("{id}.pdf"), pdf)),
                Err(cause) => paper.missing.push(NoPdf {
                    id: id.clone(),
                    cause,
                }),
            }
            files.push(PaperFile::new(format!("{id}.csv"), &*figure.csv));
            files.push(PaperFile::new(format!("{id}.txt"), caption(figure)));
        }
        paper
    }

    /// Returns the files of the page: `report.html`, `report.md` and `figures/ID.svg`.
    pub fn files(&self) -> Vec<PaperFile> {
        let pages = [
            PaperFile::new("report.html", self.html()),
            PaperFile::new("report.md", self.markdown()),
        ];
        let figures = self.all_figures().map(|figure| {
            let name = format!("figures/{}.svg", figure.id);
            PaperFile::new(name, figure.svg())
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

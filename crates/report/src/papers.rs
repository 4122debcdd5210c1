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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PaperFiles {
    /// The files.
    pub files: Vec<PaperFile>,
    /// The PDF files that are missing.
    pub missing: Vec<NoPdf>,
    /// The figures that are wider than asked for, because their letters would be too small.
    pub wider: Vec<Wider>,
}

/// A figure is wider than asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Wider {
    /// The id of the figure.
    pub id: String,
    /// The width of its files in millimetres.
    pub mm: f64,
}

/// Points of a millimetre.
const POINTS_OF_MM: f64 = 72.0 / 25.4;

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
    pub fn paper(&self, results: &Results, mm: Option<f64>) -> PaperFiles {
        let mut paper = self.figure_files(mm);
        let tables = tables::tables(results);
        paper.files.extend([
            PaperFile::new("results.tex", tex::document(&tables)),
            PaperFile::new("results.md", tables::markdown(&tables)),
            PaperFile::new("methods.md", methods::methods(results)),
        ]);
        paper
    }

    /// Returns the files of each figure for a paper: `ID.svg`, `ID.pdf`, `ID.csv` and `ID.txt`. Letters are outlines in SVG
    /// files and an embedded font in PDF files. If the font does not have all letters of the picture, then the texts with other
    /// letters stay text in the SVG file, and the PDF file is left out.
    ///
    /// With a width in millimetres, the panels of a figure are arranged for this width, and the figure is divided into
    /// files that are at most a page high, `ID-1.svg` and so on. No letter is smaller than 7 points: a figure that cannot
    /// be read at this width is wider.
    pub fn figure_files(&self, mm: Option<f64>) -> PaperFiles {
        let mut paper = PaperFiles::default();
        for figure in self.all_figures() {
            let Figure { id, picture, .. } = figure;
            let width = mm.map(|mm| mm * POINTS_OF_MM);
            let sheets = width.map_or_else(|| vec![picture.whole()], |width| picture.sheets(width));
            let widest = sheets.iter().map(|sheet| sheet.points()[0]);
            let widest = widest.fold(0.0, f64::max);
            if width.is_some_and(|width| widest > width + 0.5) {
                paper.wider.push(Wider {
                    id: id.clone(),
                    mm: widest / POINTS_OF_MM,
                });
            }
            for (number, sheet) in sheets.iter().enumerate() {
                let name = match sheets.len() {
                    1 => id.clone(),
                    _ => format!("{id}-{}", number + 1),
                };
                let svg = picture.paper_svg(sheet, &figure.caption);
                paper.files.push(PaperFile::new(format!("{name}.svg"), svg));
                match picture.pdf(sheet) {
                    Ok(pdf) => paper.files.push(PaperFile::new(format!("{name}.pdf"), pdf)),
                    Err(cause) => paper.missing.push(NoPdf { id: name, cause }),
                }
            }
            let files = &mut paper.files;
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

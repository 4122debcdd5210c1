//! Reports on studies: one self-contained HTML page, or Markdown with figures.
//!
//! A *lab* is an additional measurement besides the study: the effect of the element order, the
//! growth of times with the mesh size, the memory reads of queries, or a workload.
//! [`ReportPage::new`] draws the figures of a [`Results`]. Each figure has a
//! table of numbers and the command that reproduces the figure. Browsers show the name and the
//! value of a data point when the pointer is over the data point.
//!
//! [`ReportPage::html`] returns one file that needs no network. The page supports light and dark
//! mode, printing and small screens. [`ReportPage::markdown`] returns Markdown for a repository,
//! which links to separate SVG files. [`ReportPage::paper`] returns the files for a paper: each figure
//! as SVG and PDF with its data and its caption, tables for LaTeX and Markdown, and a description of the
//! methods.
//!
//! [`ReportPage::from_changes`] draws what changed between two results, and [`ReportPage::from_history`] how times went
//! over several.

mod axes;
mod canvas;
mod changes;
mod colours;
mod data;
mod figure;
mod figures;
mod font;
mod history;
mod html;
mod markdown;
mod matrix;
mod panels;
mod papers;
mod pdf;
mod picture;
mod source;
mod summary;
mod svg;

use matrix::Matrix;
use sixfold_results::Results;

pub use changes::Compared;
pub use colours::structure_colours;
pub use data::date;
pub use figure::{Figure, Table, TitledTable};
pub use figures::machine;
pub use html::GENERATOR;
pub use panels::{Panel, panels};
pub use papers::{NoPdf, PaperFile, PaperFiles, Wider};
pub use pdf::PdfError;
pub use picture::Picture;
pub use summary::{Drawing, Rank, Summary, SummaryColumn, SummaryFigure, SummaryRow};

/// A report on studies and additional measurements.
#[derive(Clone, Debug, Default)]
pub struct ReportPage {
    /// Title.
    pub title: String,
    /// The facts of the mesh in one line; empty without a study of one mesh.
    pub facts: String,
    /// The picture of the mesh; `None` if the document has no picture.
    pub picture: Option<MeshPicture>,
    /// How the studies were measured, in one line: samples, budget, date, machine, version.
    pub measured: String,
    /// The answer: a sentence for each kind of work, and how sure it is.
    pub answer: Vec<String>,
    /// Sentences that follow the table of the first screen: what would change the answer.
    pub conditions: Vec<String>,
    /// The structures by kind of work; `None` without a study.
    pub summary: Option<Summary>,
    /// The file with all results as JSON, in the folder of the page; `None` if there is no such file.
    pub data: Option<String>,
    /// The command that reproduces the report.
    pub command: String,
    /// Descriptions of the machines, one line each.
    pub machines: Vec<String>,
    /// How the results were measured, as paragraphs for a paper.
    pub methods: Vec<String>,
    /// Further sentences on the results.
    pub sentences: Vec<String>,
    /// Possible faults of the measurement, with remedies.
    pub warnings: Vec<String>,
    /// Tables that belong to the answer: the answer by size and kind of mesh, or the differences of the
    /// machines and settings of two compared results.
    pub tables: Vec<TitledTable>,
    /// Figures about all meshes together. If there is only one mesh, the figures are about this
    /// mesh.
    pub figures: Vec<Figure>,
    /// Figures that show the numbers of others in another way. They follow the figures, folded.
    pub folded: Vec<Figure>,
    /// Tables that follow the figures, with all numbers.
    pub appendix: Vec<TitledTable>,
    /// All operations on all backends.
    pub(crate) operations: Matrix,
    /// Sections for additional measurements: orders of elements, growth, reads of queries, memory,
    /// workloads.
    pub labs: Vec<Section>,
    /// The meshes with their sizes and the fastest structures. Each row links to the section of the mesh.
    /// Empty if there is only one mesh.
    pub overview: Table,
    /// One section for each mesh; empty if there is only one mesh.
    pub meshes: Vec<Section>,
    /// Meshes that could not be studied: the name of each mesh, and the reason.
    pub failures: Vec<(String, String)>,
    /// Names of the meshes that are not studied yet.
    pub missing: Vec<String>,
}

/// Stands above [`Section::code`].
pub(crate) const HOW_TO_USE: &str = "To use it in your package:";

/// A picture of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshPicture {
    /// A PNG file in Base64.
    pub png: String,
    /// What the picture shows.
    pub label: String,
}

/// The part of a report about one mesh or one additional measurement.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Name of the section in links; empty for a lab.
    pub id: String,
    /// Title.
    pub title: String,
    /// A description of the mesh or of the measurement, in one line.
    pub facts: String,
    /// The structures by kind of work; `None` for a lab.
    pub summary: Option<Summary>,
    /// Sentences that state the main results.
    pub sentences: Vec<String>,
    /// Lines of commands and code that use the result.
    pub code: Vec<String>,
    /// The figures of the section.
    pub figures: Vec<Figure>,
    /// The tables of the section, which follow the figures.
    pub tables: Vec<TitledTable>,
}

impl ReportPage {
    /// Draws the figures of `collection`. If the command that made a result is unknown, the figure
    /// of this result shows `command`.
    pub fn new(results: &Results, command: &str) -> Self {
        figures::page(results, command)
    }

    /// Iterates over all figures in the order of the page.
    pub fn all_figures(&self) -> impl Iterator<Item = &Figure> {
        let sections = self.labs.iter().chain(&self.meshes);
        let section_figures = sections.flat_map(|section| &section.figures);
        let own = self.figures.iter().chain(&self.folded);
        own.chain(section_figures)
    }
}

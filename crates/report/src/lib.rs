//! Reports on studies: one self-contained HTML page, or Markdown with figures.
//!
//! [`ReportPage::new`] draws the figures of a [`Collection`] and of its labs. Each figure has a
//! table of its numbers, and the command that reproduces it. [`ReportPage::html`] returns one file
//! that needs no network. The page supports light and dark mode, printing and small screens.
//! [`ReportPage::markdown`] returns a text for a repository; the figures are SVG files beside the
//! text. Each mark of a figure has a title with its name and value. A browser shows the title under
//! the pointer, and programs can read it.

mod colours;
mod figure;
mod figures;
mod html;
mod markdown;
mod panels;

use sixfold_study::Collection;

pub use figure::{Figure, Table};
pub use panels::{Panel, panels};

/// A report, before it is written as HTML or Markdown.
#[derive(Clone, Debug)]
pub struct ReportPage {
    /// Title.
    pub title: String,
    /// The command that reproduces the report.
    pub command: String,
    /// Descriptions of the different machines, one line each.
    pub machines: Vec<String>,
    /// Sentences on the figures.
    pub sentences: Vec<String>,
    /// Possible problems, with advice.
    pub warnings: Vec<String>,
    /// Figures over all meshes, or of the only mesh.
    pub figures: Vec<Figure>,
    /// Results of the labs: orders, growth, reads of queries, workloads.
    pub labs: Vec<Section>,
    /// A section for each mesh if there are several.
    pub meshes: Vec<Section>,
    /// Meshes that could not be studied, with the reasons.
    pub failures: Vec<(String, String)>,
    /// Meshes that are not studied yet.
    pub missing: Vec<String>,
}

/// The part of a report on one mesh or one lab.
#[derive(Clone, Debug)]
pub struct Section {
    /// Title.
    pub title: String,
    /// Facts about the mesh or the lab, in one line.
    pub facts: String,
    /// Sentences on the figures.
    pub sentences: Vec<String>,
    /// Its figures.
    pub figures: Vec<Figure>,
}

impl ReportPage {
    /// Draws `collection`. `command` is used for results that do not record their own command.
    pub fn new(collection: &Collection, command: &str) -> Self {
        figures::page(collection, command)
    }

    /// Iterates over all figures, in the order of the page.
    pub fn all_figures(&self) -> impl Iterator<Item = &Figure> {
        let sections = self.labs.iter().chain(&self.meshes);
        let section_figures = sections.flat_map(|section| &section.figures);
        self.figures.iter().chain(section_figures)
    }
}

//! Reports on studies: one self-contained HTML page, or Markdown with figures.
//!
//! [`ReportPage::new`] draws the figures of a [`Collection`] and of its labs. Each figure has a
//! table of numbers and the command that reproduces the figure. Each mark of a figure has a title
//! with its name and value, which browsers show under the pointer.
//!
//! [`ReportPage::html`] returns one file that needs no network. The page supports light and dark
//! mode, printing and small screens. [`ReportPage::markdown`] returns a text for a repository. Its
//! figures are separate SVG files.

mod colours;
mod figure;
mod figures;
mod html;
mod markdown;
mod panels;

use sixfold_study::Collection;

pub use figure::{Figure, Table};
pub use panels::{Panel, panels};

/// A report on studies and labs.
#[derive(Clone, Debug)]
pub struct ReportPage {
    /// Title.
    pub title: String,
    /// The command that reproduces the report.
    pub command: String,
    /// Descriptions of the machines, one line each.
    pub machines: Vec<String>,
    /// Sentences about the figures.
    pub sentences: Vec<String>,
    /// Possible problems, with advice.
    pub warnings: Vec<String>,
    /// Figures over all meshes, or of the only mesh.
    pub figures: Vec<Figure>,
    /// Sections for the labs: orders, growth, reads of queries, workloads.
    pub labs: Vec<Section>,
    /// Sections for the meshes; empty if there is only one mesh.
    pub meshes: Vec<Section>,
    /// Meshes that could not be studied, with the reasons.
    pub failures: Vec<(String, String)>,
    /// Meshes that are not studied yet.
    pub missing: Vec<String>,
}

/// The part of a report about one mesh or one lab.
#[derive(Clone, Debug)]
pub struct Section {
    /// Title.
    pub title: String,
    /// Facts about the mesh or the lab, in one line.
    pub facts: String,
    /// Sentences about the figures.
    pub sentences: Vec<String>,
    /// The figures of the section.
    pub figures: Vec<Figure>,
}

impl ReportPage {
    /// Draws `collection`. Results without a recorded command show `command`.
    pub fn new(collection: &Collection, command: &str) -> Self {
        figures::page(collection, command)
    }

    /// Iterates over all figures in the order of the page.
    pub fn all_figures(&self) -> impl Iterator<Item = &Figure> {
        let sections = self.labs.iter().chain(&self.meshes);
        let section_figures = sections.flat_map(|section| &section.figures);
        self.figures.iter().chain(section_figures)
    }
}

//! Studies as something to publish: one page of HTML that stands alone, or Markdown with figures.
//!
//! [`Page::of`] draws the figures of a [`Collection`] and of its labs; each has its numbers in a table
//! under it, and the command that makes it again. [`Page::html`] is one file that opens without a network, in light and dark, on paper and on
//! a telephone; [`Page::markdown`] is for a repository, with the figures beside it as SVG files. The
//! marks of a figure carry what they stand for as their titles: people see it when they point at one,
//! programs read it.

mod colours;
mod figure;
mod figures;
mod html;
mod markdown;
mod panels;

use study::Collection;

pub use figure::{Figure, Table};
pub use panels::{Panel, panels};

/// A report, ready to be written.
#[derive(Clone, Debug)]
pub struct Page {
    /// What it is called.
    pub title: String,
    /// The command that makes it again.
    pub command: String,
    /// The machine, in a line; one for each that differs.
    pub machines: Vec<String>,
    /// What the figures show, in sentences.
    pub words: Vec<String>,
    /// What may be wrong with it, and what helps.
    pub warnings: Vec<String>,
    /// Over all meshes, or of the one there is.
    pub figures: Vec<Figure>,
    /// What else was measured: orders, sizes, what queries read, workloads.
    pub labs: Vec<Section>,
    /// Mesh by mesh, where there are several.
    pub meshes: Vec<Section>,
    /// Meshes that could not be studied, and why.
    pub failures: Vec<(String, String)>,
    /// Meshes that are still to be done.
    pub missing: Vec<String>,
}

/// What a report says of one of several meshes, or of one measurement.
#[derive(Clone, Debug)]
pub struct Section {
    /// What it is of.
    pub title: String,
    /// What that is, in a line.
    pub facts: String,
    /// What the figures show.
    pub words: Vec<String>,
    /// Its figures.
    pub figures: Vec<Figure>,
}

impl Page {
    /// Draws `collection`, which `command` makes where the results themselves do not say so.
    pub fn of(collection: &Collection, command: &str) -> Self {
        figures::page(collection, command)
    }

    /// All figures, in the order of the page.
    pub fn all_figures(&self) -> impl Iterator<Item = &Figure> {
        let sections = self.labs.iter().chain(&self.meshes);
        let of_sections = sections.flat_map(|section| &section.figures);
        self.figures.iter().chain(of_sections)
    }
}

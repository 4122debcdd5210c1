//! The picture of a figure: one or more panels, which the page places side by side and a file
//! contains as a grid.

use std::sync::Arc;

use maud::{Markup, PreEscaped, html};

use crate::canvas::Canvas;
use crate::colours::dark_rules;
use crate::svg::Words;
use crate::{PdfError, pdf, svg};

/// Space between panels in a file, in pixels.
const GAP: f64 = 12.0;

/// The picture of a figure. A clone shares its panels.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Text for screen readers.
    label: String,
    panels: Arc<[Canvas]>,
    /// Panels in each row of the file.
    columns: usize,
}

impl Picture {
    /// Returns a picture with one panel.
    pub(crate) fn single(label: &str, panel: Canvas) -> Self {
        Self::grid(label, 1, vec![panel])
    }

    /// Returns a picture with `columns` panels in each row.
    pub(crate) fn grid(label: &str, columns: usize, panels: Vec<Canvas>) -> Self {
        Self {
            label: label.to_owned(),
            panels: panels.into(),
            columns,
        }
    }

    /// Returns the picture as an SVG file, which follows the dark mode of the reader. `description` says what the picture
    /// shows.
    pub(crate) fn svg(&self, description: &str) -> String {
        let style = format!(
            "<style>svg{{max-width:100%;height:auto}}@media (prefers-color-scheme:dark){{{}}}</style>",
            dark_rules()
        );
        svg::element(
            self.size(),
            &self.placed(),
            Some(self.words(description)),
            &style,
        )
    }

    /// Returns the picture as an SVG file in the colours of the light mode, for paper.
    pub(crate) fn light_svg(&self, description: &str) -> String {
        svg::element(
            self.size(),
            &self.placed(),
            Some(self.words(description)),
            "",
        )
    }

    fn words<'w>(&'w self, description: &'w str) -> Words<'w> {
        Words {
            title: &self.label,
            description,
        }
    }

    /// Returns the picture as a PDF file of one page, in the colours of the light mode. One pixel is one
    /// point. The text is text, in a font that the file contains.
    ///
    /// # Errors
    ///
    /// Returns an error if the font does not have all letters of the picture.
    pub fn pdf(&self) -> Result<Vec<u8>, PdfError> {
        pdf::file(self.size(), &self.placed(), &self.label)
    }

    pub(crate) fn panel_count(&self) -> usize {
        self.panels.len()
    }

    /// Returns the width of the widest panel in pixels.
    pub(crate) fn width(&self) -> f64 {
        self.largest(0)
    }

    /// Returns the panels as SVG elements without style rules, for a page that has these rules. Screen readers read the
    /// words of the first.
    pub(crate) fn markup(&self, description: &str) -> Markup {
        html! {
            @for (number, panel) in self.panels.iter().enumerate() {
                @let words = (number == 0).then(|| self.words(description));
                (PreEscaped(svg::element(panel.size, &[([0.0, 0.0], panel)], words, "")))
            }
        }
    }

    /// Returns the largest width (axis 0) or height (axis 1) of a panel.
    fn largest(&self, axis: usize) -> f64 {
        let sizes = self.panels.iter().map(|panel| panel.size[axis]);
        sizes.fold(0.0, f64::max)
    }

    /// Returns the width and the height of the grid.
    fn size(&self) -> [f64; 2] {
        let counts = [self.columns, self.panels.len().div_ceil(self.columns)];
        [0, 1].map(|axis| counts[axis] as f64 * (self.largest(axis) + GAP) - GAP)
    }

    /// Returns the panels with their places in the grid.
    fn placed(&self) -> Vec<([f64; 2], &Canvas)> {
        let cell = [0, 1].map(|axis| self.largest(axis) + GAP);
        let panels = self.panels.iter().enumerate();
        let placed = panels.map(|(number, panel)| {
            let (column, row) = (number % self.columns, number / self.columns);
            ([column as f64 * cell[0], row as f64 * cell[1]], panel)
        });
        placed.collect()
    }
}

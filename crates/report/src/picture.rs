//! The picture of a figure: one or more panels, which the page places side by side and a file
//! contains as a grid.

use std::ops::Range;
use std::sync::Arc;

use maud::{Markup, PreEscaped, html};

use crate::canvas::{Canvas, Shape};
use crate::colours::dark_rules;
use crate::svg::{Letters, Words};
use crate::{PdfError, pdf, svg};

/// Space between panels in a file, in pixels.
const GAP: f64 = 12.0;

/// The smallest height of letters on paper, in points.
const SMALLEST: f64 = 7.0;
/// The largest height of a sheet in points: a page of A4 with its caption.
const TALLEST: f64 = 680.0;

/// A part of a picture: a file for paper.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sheet {
    /// The panels of the sheet.
    panels: Range<usize>,
    /// Panels in each row.
    columns: usize,
    /// Width and height in pixels.
    size: [f64; 2],
    /// Points for each pixel.
    scale: f64,
    /// Whether the sheet was made for a width.
    is_fitted: bool,
}

impl Sheet {
    /// Returns the width and the height in points.
    pub(crate) fn points(&self) -> [f64; 2] {
        self.size.map(|length| length * self.scale)
    }
}

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
        let sheet = self.whole();
        let words = Some(self.words(description));
        let panels = self.placed(&sheet);
        svg::element(sheet.size, None, &panels, words, &style, Letters::Text)
    }

    /// Returns a sheet as an SVG file for paper: in the colours of the light mode, with the outlines of its letters.
    pub(crate) fn paper_svg(&self, sheet: &Sheet, description: &str) -> String {
        let words = Some(self.words(description));
        let scale = sheet.is_fitted.then_some(sheet.scale);
        let panels = self.placed(sheet);
        svg::element(sheet.size, scale, &panels, words, "", Letters::Outlines)
    }

    /// Returns the picture as one sheet, on which a pixel is a point.
    pub(crate) fn whole(&self) -> Sheet {
        self.sheet(0..self.panels.len(), self.columns, None)
    }

    /// Divides the picture into sheets of `width` points, with as many panels side by side as can be read, and at most
    /// [`TALLEST`] points high. A sheet whose letters would be smaller than [`SMALLEST`] points is wider.
    pub(crate) fn sheets(&self, width: f64) -> Vec<Sheet> {
        let least = self.smallest_text().max(1.0);
        let [across, down] = [0, 1].map(|axis| self.largest(axis) + GAP);
        let most = width * least / SMALLEST;
        let columns = ((most + GAP) / across).floor().max(1.0) as usize;
        let columns = columns.min(self.panels.len()).max(1);
        let layout = columns as f64 * across - GAP;
        let scale = (width / layout).max(SMALLEST / least).min(1.0);
        let rows = ((TALLEST / scale + GAP) / down).floor().max(1.0) as usize;
        let starts = (0..self.panels.len()).step_by((rows * columns).max(1));
        let sheet = |start: usize| {
            let end = self.panels.len().min(start + rows * columns);
            self.sheet(start..end, columns, Some(scale))
        };
        starts.map(sheet).collect()
    }

    fn sheet(&self, panels: Range<usize>, columns: usize, scale: Option<f64>) -> Sheet {
        let counts = [columns, panels.len().div_ceil(columns)];
        Sheet {
            size: [0, 1].map(|axis| counts[axis] as f64 * (self.largest(axis) + GAP) - GAP),
            panels,
            columns,
            scale: scale.unwrap_or(1.0),
            is_fitted: scale.is_some(),
        }
    }

    /// Returns the height of the smallest letters.
    fn smallest_text(&self) -> f64 {
        let sizes = self.panels.iter().map(|panel| smallest_text(&panel.shapes));
        sizes.fold(f64::INFINITY, f64::min)
    }

    fn words<'w>(&'w self, description: &'w str) -> Words<'w> {
        Words {
            title: &self.label,
            description,
        }
    }

    /// Returns a sheet as a PDF file of one page, in the colours of the light mode. The text is text, in a font that the file
    /// contains.
    ///
    /// # Errors
    ///
    /// Returns an error if the font does not have all letters of the picture.
    pub(crate) fn pdf(&self, sheet: &Sheet) -> Result<Vec<u8>, PdfError> {
        pdf::file(sheet.size, sheet.scale, &self.placed(sheet), &self.label)
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
                @let panels = [([0.0, 0.0], panel)];
                (PreEscaped(svg::element(panel.size, None, &panels, words, "", Letters::Text)))
            }
        }
    }

    /// Returns the largest width (axis 0) or height (axis 1) of a panel.
    fn largest(&self, axis: usize) -> f64 {
        let sizes = self.panels.iter().map(|panel| panel.size[axis]);
        sizes.fold(0.0, f64::max)
    }

    /// Returns the panels of a sheet with their places.
    fn placed(&self, sheet: &Sheet) -> Vec<([f64; 2], &Canvas)> {
        let cell = [0, 1].map(|axis| self.largest(axis) + GAP);
        let panels = self.panels[sheet.panels.clone()].iter().enumerate();
        let placed = panels.map(|(number, panel)| {
            let (column, row) = (number % sheet.columns, number / sheet.columns);
            ([column as f64 * cell[0], row as f64 * cell[1]], panel)
        });
        placed.collect()
    }
}

/// Returns the height of the smallest letters of `shapes`.
fn smallest_text(shapes: &[Shape]) -> f64 {
    let sizes = shapes.iter().map(|shape| match shape {
        Shape::Text { style, .. } => f64::from(style.size),
        Shape::Mark { shapes, .. } => smallest_text(shapes),
        _ => f64::INFINITY,
    });
    sizes.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Style;

    /// Returns a picture of `count` panels of the given size with letters of 12 pixels.
    fn picture(count: usize, size: [f64; 2]) -> Picture {
        let mut panel = Canvas::new(size[0], size[1]);
        panel.mark("mark".into(), |canvas| {
            canvas.text([0.0, 12.0], "text", Style::new(12));
        });
        Picture::grid("panels", 2, vec![panel; count])
    }

    #[test]
    fn letters_are_at_least_seven_points_high_on_paper() {
        for (count, panel) in [(1, 400.0), (7, 352.0), (6, 440.0), (1, 900.0), (28, 120.0)] {
            let picture = picture(count, [panel, 300.0]);
            for width in [241.0, 504.0] {
                let sheets = picture.sheets(width);
                let shown: usize = sheets.iter().map(|sheet| sheet.panels.len()).sum();
                assert_eq!(shown, count);
                for sheet in &sheets {
                    let [across, down] = sheet.points();
                    assert!(12.0 * sheet.scale >= SMALLEST - 1e-9, "{sheet:?}");
                    assert!(down <= TALLEST + 1e-9, "{sheet:?}");
                    // Only one panel that cannot be read at this width is wider.
                    assert!(across <= width + 1e-9 || sheet.columns == 1, "{sheet:?}");
                    assert!(across <= width + 1e-9 || panel * SMALLEST / 12.0 > width);
                }
            }
        }
    }

    #[test]
    fn a_picture_has_as_many_panels_side_by_side_as_can_be_read() {
        // At 7/12 of their size, 352 pixels are 205 points, and two with their gap 418.
        let picture = picture(6, [352.0, 300.0]);
        assert_eq!(picture.sheets(504.0)[0].columns, 2);
        assert_eq!(picture.sheets(241.0)[0].columns, 1);
        assert_eq!(picture.sheets(3000.0)[0].scale, 1.0);
    }
}

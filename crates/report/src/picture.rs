//! The picture of a figure: one or more panels, which the page places side by side and a file
//! contains as a grid.

use std::sync::Arc;

use kuva::backend::svg::SvgBackend;
use kuva::render::render::{Primitive, Scene};
use maud::{Markup, PreEscaped, html};
use thiserror::Error;

use crate::colours::dark_rules;

/// Space between panels in a file, in pixels.
const GAP: f64 = 12.0;

/// The font of PDF files. It is part of the library for charts, so a file does not depend on the fonts of
/// the system.
#[cfg(feature = "pdf")]
const PDF_FONT: &str = "DejaVu Sans";

/// The picture of a figure cannot be written as a PDF file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the picture cannot be drawn as PDF ({cause}): use the SVG file")]
pub struct PdfError {
    /// The message of the library for PDF files.
    cause: String,
}

/// The picture of a figure. A clone shares its panels.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Text for screen readers.
    label: String,
    panels: Arc<[Scene]>,
    /// Panels in each row of the file.
    columns: usize,
}

impl Picture {
    /// Returns a picture with one panel.
    pub(crate) fn single(label: &str, panel: Scene) -> Self {
        Self::grid(label, 1, vec![panel])
    }

    /// Returns a picture with `columns` panels in each row.
    pub(crate) fn grid(label: &str, columns: usize, panels: Vec<Scene>) -> Self {
        Self {
            label: label.to_owned(),
            panels: panels.into(),
            columns,
        }
    }

    /// Returns the picture as an SVG file, which follows the dark mode of the reader.
    pub fn svg(&self) -> String {
        let style = format!(
            "<style>svg{{max-width:100%;height:auto}}@media (prefers-color-scheme:dark){{{}}}</style>",
            dark_rules()
        );
        match &self.panels[..] {
            [panel] => element(panel, &self.label, &style),
            panels => element(&joined(panels, self.columns), &self.label, &style),
        }
    }

    /// Returns the picture as a PDF file of one page, in the colours of the light mode. One pixel is one
    /// point. The text is text, in a font that the file contains.
    ///
    /// # Errors
    ///
    /// Returns an error if the library for PDF files cannot draw the picture.
    #[cfg(feature = "pdf")]
    pub fn pdf(&self) -> Result<Vec<u8>, PdfError> {
        let mut scene = joined(&self.panels, self.columns);
        scene.font_family = Some(PDF_FONT.into());
        let file = kuva::backend::pdf::PdfBackend::new().render_scene(&scene);
        file.map_err(|cause| PdfError { cause })
    }

    pub(crate) fn panel_count(&self) -> usize {
        self.panels.len()
    }

    /// Returns the width of the widest panel in pixels.
    pub(crate) fn width(&self) -> f64 {
        self.panels
            .iter()
            .map(|panel| panel.width)
            .fold(0.0, f64::max)
    }

    /// Returns the panels as SVG elements without style rules, for a page that has these rules.
    pub(crate) fn markup(&self) -> Markup {
        html! {
            @for (number, panel) in self.panels.iter().enumerate() {
                @let label = if number == 0 { self.label.as_str() } else { "" };
                (PreEscaped(element(panel, label, "")))
            }
        }
    }
}

/// Returns `scene` as an SVG element that scales to the page. Without a label, screen readers skip the
/// element.
fn element(scene: &Scene, label: &str, style: &str) -> String {
    let svg = SvgBackend::new().render_scene(scene);
    let Some((head, body)) = svg.split_once('>') else {
        return svg;
    };
    // The style of the library only highlights marks, which the page does itself.
    let body = match (body.split_once("<style>"), body.split_once("</style>")) {
        (Some((before, _)), Some((_, after))) => format!("{before}{after}"),
        _ => body.to_owned(),
    };
    let (width, height) = (scene.width, scene.height);
    let role = match label {
        "" => "aria-hidden=\"true\"".to_owned(),
        label => format!(
            "role=\"img\" aria-label=\"{}\"",
            html! { (label) }.into_string()
        ),
    };
    format!("{head} viewBox=\"0 0 {width} {height}\" {role}>{style}{body}")
}

/// Returns one scene with all panels in rows of `columns`.
fn joined(panels: &[Scene], columns: usize) -> Scene {
    let cell = |size: fn(&Scene) -> f64| panels.iter().map(size).fold(0.0, f64::max) + GAP;
    let (width, height) = (cell(|panel| panel.width), cell(|panel| panel.height));
    let rows = panels.len().div_ceil(columns) as f64;
    let mut all = Scene::new(columns as f64 * width - GAP, rows * height - GAP);
    if let Some(first) = panels.first() {
        all.background_color.clone_from(&first.background_color);
        all.text_color.clone_from(&first.text_color);
        all.font_family.clone_from(&first.font_family);
    }
    for (number, panel) in panels.iter().enumerate() {
        let (row, column) = (number / columns, number % columns);
        let (x, y) = (column as f64 * width, row as f64 * height);
        all.add(Primitive::GroupStart {
            transform: Some(format!("translate({x} {y})")),
            title: None,
            extra_attrs: None,
        });
        for primitive in &panel.elements {
            all.add(primitive.clone());
        }
        all.add(Primitive::GroupEnd);
        all.defs.extend(panel.defs.iter().cloned());
    }
    all
}

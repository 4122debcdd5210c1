//! One figure, and the numbers under it.

use std::sync::Arc;

use kuva::backend::svg::SvgBackend;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::{Scene, render_multiple};
use kuva::{Theme, TickFormat};
use study::numbers::times;

use crate::colours::{GRID, INK, PAPER, dark_rules};

/// A figure with its numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// A name for links and files: `heat-map`.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// How to read it.
    pub caption: String,
    /// The picture, as an element that can stand in a page or in a file.
    pub svg: String,
    /// What its marks stand for.
    pub table: Table,
    /// The command that makes it again.
    pub command: String,
}

/// Numbers in rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Over the columns; the first names the rows.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(header: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self {
            header: header.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
        }
    }

    pub(crate) fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }
}

/// The length of a bar for the fastest, whose ratio has the logarithm 0: a part of the longest.
pub(crate) const LEAST: f64 = 0.02;

/// Logarithms of ratios on an axis up to `most`, as the ratios that they are of.
pub(crate) fn ratios(most: f64) -> TickFormat {
    let close = most < 0.5;
    TickFormat::Custom(Arc::new(move |log: f64| match 10_f64.powf(log) {
        ratio if close => format!("{ratio:.2} ×"),
        ratio => times(ratio),
    }))
}

/// A layout in our colours and letters.
pub(crate) fn laid_out(plots: &[Plot], width: f64, height: f64) -> Layout {
    let theme = Theme {
        background: PAPER.into(),
        axis_color: INK.into(),
        grid_color: GRID.into(),
        tick_color: INK.into(),
        text_color: INK.into(),
        legend_bg: PAPER.into(),
        legend_border: GRID.into(),
        colorbar_border: INK.into(),
        font_family: Some("system-ui, sans-serif".into()),
        ..Theme::light()
    };
    Layout::auto_from_plots(plots)
        .with_theme(theme)
        .with_width(width)
        .with_height(height)
        .with_label_size(13)
        .with_tick_size(12)
        .with_body_size(12)
}

/// The picture of `plots`.
pub(crate) fn drawn(title: &str, plots: Vec<Plot>, layout: Layout) -> String {
    finished(title, &render_multiple(plots, layout))
}

/// `scene` as wide as its place, dark where the page is, with a title for who does not see it.
pub(crate) fn finished(title: &str, scene: &Scene) -> String {
    let svg = SvgBackend::new().render_scene(scene);
    let Some((head, body)) = svg.split_once('>') else {
        return svg;
    };
    let size = |name: &str| -> Option<&str> {
        let after = head.split_once(&format!(" {name}=\""))?.1;
        Some(after.split_once('"')?.0)
    };
    let (width, height) = (size("width").unwrap_or("0"), size("height").unwrap_or("0"));
    let title = maud::html! { (title) }.into_string();
    let dark = dark_rules();
    format!(
        "{head} viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\"><style>\
         svg{{max-width:100%;height:auto}}@media (prefers-color-scheme:dark){{{dark}}}</style>{body}"
    )
}

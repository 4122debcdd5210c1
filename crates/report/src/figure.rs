//! One figure with its table of numbers.

use std::sync::Arc;

use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;
use kuva::{Theme, TickFormat};
use sixfold_study::numbers::times;

use crate::Picture;
use crate::colours::{BACKGROUND, GRID_COLOUR, TEXT_COLOUR};
use crate::data::FigureData;

/// A figure, and a table of the numbers that the figure shows.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name of the figure in links and file names, such as `heat-map`.
    pub id: String,
    /// Title.
    pub title: String,
    /// Text that explains how to read the figure.
    pub caption: String,
    /// The picture.
    pub picture: Picture,
    /// The numbers of the figure, formatted.
    pub table: Table,
    /// The data of the figure for other programs.
    pub data: FigureData,
    /// The command that reproduces the figure.
    pub command: String,
}

impl Figure {
    /// Adds the data for other programs.
    pub(crate) fn with_data(self, data: FigureData) -> Self {
        Self { data, ..self }
    }
}

/// A table of numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Column titles. The first column has the names of the rows.
    pub header: Vec<String>,
    /// The rows. Each row is as long as the header.
    pub rows: Vec<Vec<String>>,
}

/// A table that stands on the page without a figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TitledTable {
    /// Title.
    pub title: String,
    /// Text that explains the columns.
    pub caption: String,
    /// The numbers.
    pub table: Table,
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

/// Minimum length of a bar, as a part of the axis. The bar of ratio 1 would have length 0.
pub(crate) const MIN_BAR_LENGTH: f64 = 0.02;

/// Returns a format that shows logarithms as ratios, for an axis up to `max_log`.
pub(crate) fn ratio_ticks(max_log: f64) -> TickFormat {
    let close = max_log < 0.5;
    TickFormat::Custom(Arc::new(move |log: f64| match 10_f64.powf(log) {
        ratio if close => format!("{ratio:.2} ×"),
        ratio => times(ratio),
    }))
}

/// Returns a layout of the given size with the colours and fonts of the report.
pub(crate) fn base_layout(plots: &[Plot], width: f64, height: f64) -> Layout {
    let theme = Theme {
        background: BACKGROUND.into(),
        axis_color: TEXT_COLOUR.into(),
        grid_color: GRID_COLOUR.into(),
        tick_color: TEXT_COLOUR.into(),
        text_color: TEXT_COLOUR.into(),
        legend_bg: BACKGROUND.into(),
        legend_border: GRID_COLOUR.into(),
        colorbar_border: TEXT_COLOUR.into(),
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

pub(crate) fn picture(label: &str, plots: Vec<Plot>, layout: Layout) -> Picture {
    Picture::single(label, render_multiple(plots, layout))
}

//! Several small line charts in one SVG figure.

use kuva::Theme;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::figure::Figure as Grid;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;

use crate::Picture;
use crate::colours::{BACKGROUND, GRID_COLOUR, TEXT_COLOUR, column_colour};

/// Width and height of one panel.
const SIZE: [f64; 2] = [400.0, 320.0];

/// One small line chart with logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Label of the horizontal axis.
    pub x_label: String,
    /// Label of the vertical axis.
    pub y_label: String,
    /// The name of each structure, and its points (x, y). A structure without points is not drawn.
    pub lines: Vec<(&'static str, Vec<(f64, f64)>)>,
}

/// Draws `panels` as one SVG with a common legend. The SVG has `columns` panels side by side in
/// each row.
pub fn panels(title: &str, columns: usize, panels: &[Panel]) -> String {
    let rows = panels.len().div_ceil(columns);
    let (mut plots, mut layouts) = (Vec::new(), Vec::new());
    for panel in panels {
        let lines = panel.lines.iter().filter(|(_, points)| !points.is_empty());
        let drawn: Vec<Plot> = lines
            .flat_map(|(name, points)| line(name, points))
            .collect();
        let layout = base_layout(&drawn, SIZE[0], SIZE[1])
            .with_title(panel.title.clone())
            .with_title_size(14)
            .with_x_label(panel.x_label.clone())
            .with_y_label(panel.y_label.clone())
            .with_log_scale();
        plots.push(drawn);
        layouts.push(layout);
    }
    let grid = Grid::new(rows, columns)
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(SIZE[0], SIZE[1])
        .with_shared_legend_bottom();
    Picture::single(title, grid.render()).svg()
}

fn line(name: &str, points: &[(f64, f64)]) -> [Plot; 2] {
    let colour = column_colour(name);
    let line = LinePlot::new()
        .with_data(points.to_vec())
        .with_color(colour)
        .with_stroke_width(2.0)
        .with_legend(name);
    let titles = points
        .iter()
        .map(|(x, y)| format!("{name}: {x:.0}, {y:.3}"));
    let dots = ScatterPlot::new()
        .with_data(points.to_vec())
        .with_color(colour)
        .with_size(3.0)
        .with_tooltip_labels(titles);
    [Plot::Line(line), Plot::Scatter(dots)]
}

/// Returns a layout of the given size with the colours and fonts of the report.
fn base_layout(plots: &[Plot], width: f64, height: f64) -> Layout {
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

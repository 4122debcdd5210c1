//! Several small figures of lines in one picture.

use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::figure::Figure as Grid;
use kuva::render::plots::Plot;

use crate::colours::of_column;
use crate::figure::{finished, laid_out};

/// The size of one.
const SIZE: [f64; 2] = [400.0, 320.0];

/// One small figure, both axes logarithmic.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// What is along.
    pub x_label: String,
    /// What is up.
    pub y_label: String,
    /// The points of each structure; one without any is left out.
    pub lines: Vec<(&'static str, Vec<(f64, f64)>)>,
}

/// `panels` in rows of so many, as SVG; one legend for all.
pub fn panels(title: &str, columns: usize, panels: &[Panel]) -> String {
    let rows = panels.len().div_ceil(columns);
    let (mut plots, mut layouts) = (Vec::new(), Vec::new());
    for panel in panels {
        let lines = panel.lines.iter().filter(|(_, points)| !points.is_empty());
        let drawn: Vec<Plot> = lines
            .flat_map(|(name, points)| line(name, points))
            .collect();
        let layout = laid_out(&drawn, SIZE[0], SIZE[1])
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
    finished(title, &grid.render())
}

/// A line through points, and the points.
fn line(name: &str, points: &[(f64, f64)]) -> [Plot; 2] {
    let colour = of_column(name);
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

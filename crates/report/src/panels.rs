//! Several small line charts in one SVG figure.

use crate::Picture;
use crate::axes::{ACROSS, Axes, Curve, CurvePoint, LogScale, SIZE, UPWARDS};
use crate::canvas::{Canvas, Style};
use crate::colours::{column_colour, column_shape};
use crate::figure::count_tick;

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

/// Draws `panels` as one SVG. The SVG has `columns` panels side by side in each row. All panels have the same
/// axes, which contain all points with positive coordinates. `description` says what the picture shows.
pub fn panels(title: &str, description: &str, columns: usize, panels: &[Panel]) -> String {
    let [x, y] = [0, 1].map(|axis| {
        let points = panels.iter().flat_map(|panel| &panel.lines);
        let points = points.flat_map(|(_, points)| points);
        let values = points.map(|&(x, y)| [x, y][axis]);
        let [least, most] = { values.filter(|&value| value > 0.0) }
            .fold([f64::INFINITY, 0.0], |[least, most], value| {
                [value.min(least), value.max(most)]
            });
        // A scale needs some length.
        match least < most {
            true => [least, most],
            false => [1.0, 10.0],
        }
    });
    let drawn = panels.iter().map(|panel| draw(panel, x, y)).collect();
    Picture::grid(title, columns, drawn).svg(description)
}

/// Draws a panel. `x` and `y` have the least and the largest value of an axis.
fn draw(panel: &Panel, x: [f64; 2], y: [f64; 2]) -> Canvas {
    let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
    canvas.text([0.0, 14.0], &panel.title, Style::new(14).bold(true));
    let axes = Axes {
        x: LogScale {
            values: x,
            pixels: ACROSS,
        },
        y: LogScale {
            values: y,
            pixels: UPWARDS,
        },
        x_label: &panel.x_label,
        y_label: &panel.y_label,
        x_format: &count_tick,
        y_format: &|value| match value {
            value if value < 1.0 => format!("{value}"),
            value => count_tick(value),
        },
    };
    axes.draw(&mut canvas);
    let curves = panel.lines.iter().map(|(name, points)| {
        let point = |&(x, y): &(f64, f64)| CurvePoint {
            at: [x, y],
            title: format!("{name}: {x:.0}, {y:.3}"),
            is_sampled: false,
        };
        Curve {
            name: (*name).into(),
            colour: column_colour(name),
            shape: column_shape(name),
            points: points.iter().map(point).collect(),
        }
    });
    axes.draw_curves(&mut canvas, curves.collect());
    canvas
}

//! Drawing of panels: texts and shapes in the colours of the report, and logarithmic axes.
//!
//! The plots of the chart library have legends and scales of their own. The figures of the report
//! have labels at their marks and one scale for all panels, so they are drawn from the shapes of the
//! library.

use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

use crate::colours::{BACKGROUND, GRID_COLOUR, TEXT_COLOUR};

/// Width of a letter, as a part of the height of the text. Labels are placed with this estimate,
/// because the font of the reader is unknown.
const LETTER: f64 = 0.56;

/// Returns the width of `text` at `size` pixels, about.
pub(crate) fn text_width(text: &str, size: u32) -> f64 {
    text.chars().count() as f64 * f64::from(size) * LETTER
}

/// A picture that is being drawn.
pub(crate) struct Canvas(Scene);

/// How a text is placed and drawn.
#[derive(Clone, Copy)]
pub(crate) struct Style<'a> {
    pub(crate) size: u32,
    pub(crate) anchor: TextAnchor,
    pub(crate) bold: bool,
    pub(crate) colour: &'a str,
}

impl<'a> Style<'a> {
    pub(crate) const fn new(size: u32) -> Self {
        Self {
            size,
            anchor: TextAnchor::Start,
            bold: false,
            colour: TEXT_COLOUR,
        }
    }

    pub(crate) const fn bold(self, bold: bool) -> Self {
        Self { bold, ..self }
    }

    pub(crate) const fn colour(self, colour: &'a str) -> Self {
        Self { colour, ..self }
    }

    pub(crate) const fn end(self) -> Self {
        Self {
            anchor: TextAnchor::End,
            ..self
        }
    }

    pub(crate) const fn middle(self) -> Self {
        Self {
            anchor: TextAnchor::Middle,
            ..self
        }
    }
}

impl Canvas {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        let mut scene = Scene::new(width, height);
        scene.background_color = Some(BACKGROUND.into());
        scene.text_color = Some(TEXT_COLOUR.into());
        scene.font_family = Some("system-ui, sans-serif".into());
        Self(scene)
    }

    pub(crate) fn finish(self) -> Scene {
        self.0
    }

    pub(crate) fn text(&mut self, [x, y]: [f64; 2], text: &str, style: Style<'_>) {
        self.0.add(Primitive::Text {
            x,
            y,
            content: text.to_owned(),
            size: style.size,
            anchor: style.anchor,
            rotate: None,
            bold: style.bold,
            color: Some(style.colour.into()),
        });
    }

    /// Draws a rectangle from its upper left corner.
    pub(crate) fn rect(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], fill: &str) {
        self.0.add(Primitive::Rect {
            x,
            y,
            width,
            height,
            fill: fill.into(),
            stroke: None,
            stroke_width: None,
            opacity: None,
        });
    }

    /// Draws the border of a rectangle, without a filling.
    pub(crate) fn frame(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], stroke: &str) {
        self.0.add(Primitive::Rect {
            x,
            y,
            width,
            height,
            fill: "none".into(),
            stroke: Some(stroke.into()),
            stroke_width: Some(1.0),
            opacity: None,
        });
    }

    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: &str, width: f64) {
        self.stroke(&[from, to], stroke, width, None);
    }

    pub(crate) fn dashed(&mut self, from: [f64; 2], to: [f64; 2], stroke: &str, width: f64) {
        self.stroke(&[from, to], stroke, width, Some("4 3"));
    }

    pub(crate) fn polyline(&mut self, points: &[[f64; 2]], stroke: &str, width: f64) {
        self.stroke(points, stroke, width, None);
    }

    fn stroke(&mut self, points: &[[f64; 2]], stroke: &str, width: f64, dashes: Option<&str>) {
        self.0.add(Primitive::PolyLine {
            points: points.iter().map(|&[x, y]| (x, y)).collect(),
            stroke: stroke.into(),
            stroke_width: width,
            stroke_dasharray: dashes.map(str::to_owned),
        });
    }

    pub(crate) fn circle(&mut self, [cx, cy]: [f64; 2], r: f64, fill: &str) {
        self.0.add(Primitive::Circle {
            cx,
            cy,
            r,
            fill: fill.into(),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    /// Draws a circle without a filling.
    pub(crate) fn ring(&mut self, [cx, cy]: [f64; 2], r: f64, stroke: &str) {
        self.0.add(Primitive::Circle {
            cx,
            cy,
            r,
            fill: "none".into(),
            fill_opacity: None,
            stroke: Some(stroke.into()),
            stroke_width: Some(1.2),
        });
    }

    /// Draws squares of `size` about the given points, as one shape.
    pub(crate) fn dots(&mut self, points: impl Iterator<Item = [f64; 2]>, size: f64, fill: &str) {
        let half = size / 2.0;
        let dot =
            |[x, y]: [f64; 2]| format!("M{:.1} {:.1}h{size}v{size}h-{size}Z", x - half, y - half);
        self.path(points.map(dot).collect(), fill);
    }

    /// Draws a closed outline.
    pub(crate) fn filled(&mut self, points: &[[f64; 2]], fill: &str) {
        let mut d = String::new();
        for (number, [x, y]) in points.iter().enumerate() {
            let step = if number == 0 { 'M' } else { 'L' };
            d += &format!("{step}{x:.1} {y:.1}");
        }
        self.path(d + "Z", fill);
    }

    fn path(&mut self, d: String, fill: &str) {
        self.0.add(Primitive::Path(Box::new(PathData {
            d,
            fill: Some(fill.into()),
            stroke: "none".into(),
            stroke_width: 0.0,
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    /// Draws a mark: shapes with a title, which browsers show when the pointer is over them.
    pub(crate) fn mark(&mut self, title: String, draw: impl FnOnce(&mut Self)) {
        self.0.add(Primitive::GroupStart {
            transform: None,
            title: Some(title),
            extra_attrs: None,
        });
        draw(self);
        self.0.add(Primitive::GroupEnd);
    }
}

/// A logarithmic scale from values to pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LogScale {
    /// The least and the largest value.
    pub(crate) values: [f64; 2],
    /// Their places.
    pub(crate) pixels: [f64; 2],
}

impl LogScale {
    /// Returns the place of `value`. Values outside of the scale are placed at its ends.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let [low, high] = self.values;
        let [from, to] = self.pixels;
        let share = (value.clamp(low, high) / low).ln() / (high / low).ln();
        from + share * (to - from)
    }

    /// Returns round values in the scale: the powers of ten, or also twice and five times these if
    /// the scale has fewer than two decades. At most about eight.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.values;
        let decades = (high / low).log10();
        let factors: &[f64] = if decades < 2.0 {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        let every = (decades / 8.0).ceil().max(1.0) as i32;
        let first = low.log10().floor() as i32;
        let last = high.log10().ceil() as i32;
        let powers = (first..=last).filter(|power| power.rem_euclid(every) == 0);
        let ticks = powers.flat_map(|power| factors.iter().map(move |f| f * 10_f64.powi(power)));
        let inside = |tick: &f64| (low * 0.999..=high * 1.001).contains(tick);
        ticks.filter(inside).collect()
    }
}

/// Two logarithmic axes of a chart, with grid lines and labels.
pub(crate) struct Axes<'a> {
    pub(crate) x: LogScale,
    pub(crate) y: LogScale,
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    /// Format of the values on each axis.
    pub(crate) x_format: &'a dyn Fn(f64) -> String,
    pub(crate) y_format: &'a dyn Fn(f64) -> String,
}

impl Axes<'_> {
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.place(x), self.y.place(y)]
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let ([left, right], [bottom, top]) = (self.x.pixels, self.y.pixels);
        let small = Style::new(11);
        let mut free_from = f64::NEG_INFINITY;
        for tick in self.x.ticks() {
            let x = self.x.place(tick);
            canvas.line([x, top], [x, bottom], GRID_COLOUR, 1.0);
            let label = (self.x_format)(tick);
            let half = text_width(&label, 11) / 2.0;
            if x - half > free_from {
                canvas.text([x, bottom + 16.0], &label, small.middle());
                free_from = x + half + 4.0;
            }
        }
        for tick in self.y.ticks() {
            let y = self.y.place(tick);
            canvas.line([left, y], [right, y], GRID_COLOUR, 1.0);
            canvas.text([left - 6.0, y + 4.0], &(self.y_format)(tick), small.end());
        }
        canvas.line([left, bottom], [right, bottom], TEXT_COLOUR, 1.0);
        let middle = (left + right) / 2.0;
        canvas.text(
            [middle, bottom + 36.0],
            self.x_label,
            Style::new(12).middle(),
        );
        // Above the axis, so that it is read without turning the head.
        canvas.text([left, top - 10.0], self.y_label, Style::new(12));
    }
}

/// Returns how far the dot with this number is moved up or down, as a part of the height of its row: from -0.5
/// to 0.5. The multiples of the golden ratio spread evenly.
pub(crate) fn scatter(number: usize) -> f64 {
    (number as f64 * 0.618_034).fract() - 0.5
}

/// Moves `places` apart so that two are at least `apart` pixels from each other and all are between
/// the ends, in the same order. Returns the new places.
pub(crate) fn spread(places: &[f64], apart: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
    let mut spread = places.to_vec();
    let mut least = low;
    for &i in &order {
        spread[i] = spread[i].max(least);
        least = spread[i] + apart;
    }
    let mut most = high;
    for &i in order.iter().rev() {
        spread[i] = spread[i].min(most);
        most = spread[i] - apart;
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_apart_and_keep_their_order() {
        assert_eq!(
            spread(&[10.0, 50.0, 12.0], 12.0, [0.0, 100.0]),
            [10.0, 50.0, 22.0]
        );
        // At the lower end of the chart, they move up.
        assert_eq!(
            spread(&[98.0, 99.0, 10.0], 12.0, [0.0, 100.0]),
            [88.0, 100.0, 10.0]
        );
        assert!(spread(&[], 12.0, [0.0, 1.0]).is_empty());
    }

    #[test]
    fn a_scale_places_its_ends_and_its_ticks() {
        let scale = LogScale {
            values: [1.0, 1000.0],
            pixels: [10.0, 40.0],
        };
        let places = [0.1, 1.0, 10.0, 1000.0, 5000.0].map(|value| scale.place(value).round());
        assert_eq!(places, [10.0, 10.0, 20.0, 40.0, 40.0]);
        assert_eq!(scale.ticks(), [1.0, 10.0, 100.0, 1000.0]);
        let close = LogScale {
            values: [0.9, 21.0],
            ..scale
        };
        assert_eq!(close.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0]);
        let wide = LogScale {
            values: [1.0, 1e16],
            ..scale
        };
        assert_eq!(wide.ticks().len(), 9);
    }
}

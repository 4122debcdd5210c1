//! Logarithmic axes, the curves of a chart, and places of dots and labels.

use crate::canvas::{Canvas, PointShape, Style, text_width};
use crate::colours::{BACKGROUND, GRID_COLOUR, TEXT_COLOUR};

/// Size of a panel with two axes, and their places: three panels fit beside each other on the page, and the names of
/// curves are at their right.
pub(crate) const SIZE: [f64; 2] = [356.0, 270.0];
pub(crate) const ACROSS: [f64; 2] = [66.0, 202.0];
pub(crate) const UPWARDS: [f64; 2] = [228.0, 44.0];
/// Columns of a picture of such panels.
pub(crate) const COLUMNS: usize = 3;

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

    /// Draws an upright line from `top` to `bottom` at each tick of a horizontal scale, and its label with the base line
    /// `labels`. From the right, labels without room are left out.
    pub(crate) fn draw_ticks(
        &self,
        canvas: &mut Canvas,
        [top, bottom]: [f64; 2],
        labels: f64,
        colour: &'static str,
        format: &dyn Fn(f64) -> String,
    ) {
        let mut free_until = f64::INFINITY;
        for tick in self.ticks().into_iter().rev() {
            let x = self.place(tick);
            canvas.line([x, top], [x, bottom], GRID_COLOUR, 1.0);
            let label = format(tick);
            let half = text_width(&label, 12) / 2.0;
            if x + half < free_until {
                canvas.text([x, labels], &label, Style::new(12).middle().colour(colour));
                free_until = x - half - 8.0;
            }
        }
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

/// A line of a chart, with a mark at each of its points.
pub(crate) struct Curve {
    /// The text beside the last point.
    pub(crate) name: String,
    pub(crate) colour: &'static str,
    pub(crate) shape: PointShape,
    pub(crate) points: Vec<CurvePoint>,
}

/// A point of a curve.
pub(crate) struct CurvePoint {
    pub(crate) at: [f64; 2],
    /// The title of its mark.
    pub(crate) title: String,
    /// Whether the mark is open: the value was measured only on a sample.
    pub(crate) is_sampled: bool,
}

impl Axes<'_> {
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.place(x), self.y.place(y)]
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let ([left, right], [bottom, top]) = (self.x.pixels, self.y.pixels);
        let small = Style::new(12);
        let labels = bottom + 16.0;
        let x = &self.x;
        x.draw_ticks(canvas, [top, bottom], labels, TEXT_COLOUR, self.x_format);
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

    /// Draws `curves`, and their names at the right of the axes. Returns the number of the drawn curves: a
    /// curve without points is not drawn.
    pub(crate) fn draw_curves(&self, canvas: &mut Canvas, curves: Vec<Curve>) -> usize {
        let right = self.x.pixels[1];
        let [bottom, top] = self.y.pixels;
        let mut names = Vec::new();
        for curve in curves {
            let places = curve.points.iter().map(|point| self.place(point.at));
            let places: Vec<[f64; 2]> = places.collect();
            canvas.polyline(&places, curve.colour, 1.5);
            for (point, &place) in curve.points.into_iter().zip(&places) {
                canvas.mark(point.title, |canvas| {
                    canvas.point(curve.shape, place, 3.0, curve.colour);
                    if point.is_sampled {
                        canvas.point(curve.shape, place, 1.6, BACKGROUND);
                    }
                });
            }
            if let Some(&[_, height]) = places.last() {
                names.push((curve.name, height, curve.colour, curve.shape));
            }
        }
        // At the height of the end of the curve, with the shape of its points in the place of a line that would lead there.
        let heights: Vec<f64> = names.iter().map(|(_, height, ..)| *height).collect();
        let labels = spread(&heights, 15.0, [top, bottom]);
        for ((name, _, colour, shape), &label) in names.iter().zip(&labels) {
            canvas.point(*shape, [right + 10.0, label], 3.5, colour);
            canvas.text([right + 18.0, label + 4.0], name, Style::new(12));
        }
        names.len()
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
    use crate::canvas::Shape;

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
    fn the_points_and_the_name_of_a_curve_have_its_shape() {
        let scale = |pixels| LogScale {
            values: [1.0, 100.0],
            pixels,
        };
        let axes = Axes {
            x: scale([0.0, 100.0]),
            y: scale([100.0, 0.0]),
            x_label: "",
            y_label: "",
            x_format: &|_| String::new(),
            y_format: &|_| String::new(),
        };
        for shape in PointShape::ALL {
            let point = |at| CurvePoint {
                at,
                title: String::new(),
                is_sampled: false,
            };
            let curve = Curve {
                name: "name".into(),
                colour: TEXT_COLOUR,
                shape,
                points: vec![point([1.0, 1.0]), point([100.0, 10.0])],
            };
            let mut drawn = Canvas::new(200.0, 100.0);
            axes.draw_curves(&mut drawn, vec![curve]);
            let mut expected = Canvas::new(200.0, 100.0);
            expected.polyline(&[[0.0, 100.0], [100.0, 50.0]], TEXT_COLOUR, 1.5);
            for at in [[0.0, 100.0], [100.0, 50.0]] {
                expected.mark(String::new(), |canvas| {
                    canvas.point(shape, at, 3.0, TEXT_COLOUR);
                });
            }
            expected.point(shape, [110.0, 50.0], 3.5, TEXT_COLOUR);
            expected.text([118.0, 54.0], "name", Style::new(12));
            assert_eq!(format!("{drawn:?}"), format!("{expected:?}"));
        }
    }

    #[test]
    fn labels_of_ticks_without_room_are_left_out_from_the_right() {
        let scale = LogScale {
            values: [1.0, 1000.0],
            pixels: [0.0, 120.0],
        };
        let mut canvas = Canvas::new(120.0, 20.0);
        let label = |tick: f64| format!("{tick} ×");
        scale.draw_ticks(&mut canvas, [0.0, 10.0], 18.0, TEXT_COLOUR, &label);
        let texts = canvas.shapes.iter().filter_map(|shape| match shape {
            Shape::Text { text, .. } => Some(text.as_str()),
            _ => None,
        });
        // 1,000 × is about 40 pixels wide, 100 × is 40 pixels to its left.
        assert_eq!(texts.collect::<Vec<_>>(), ["1000 ×", "10 ×", "1 ×"]);
        assert_eq!(canvas.shapes.len(), 4 + 3);
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
        let two_decades = LogScale {
            values: [1.0, 100.0],
            ..scale
        };
        assert_eq!(two_decades.ticks(), [1.0, 10.0, 100.0]);
        let wide = LogScale {
            values: [1.0, 1e16],
            ..scale
        };
        assert_eq!(wide.ticks().len(), 9);
    }
}

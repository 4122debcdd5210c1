//! Drawing of pictures: texts and shapes in the colours of the report.
//!
//! [`svg`](crate::svg) and [`pdf`](crate::pdf) write the shapes. Both use the same numbers: one unit is one
//! pixel of SVG and one point of PDF.

use std::mem;

use crate::colours::TEXT_COLOUR;

/// Width of a letter, as a part of the height of the text. Labels are placed with this estimate,
/// because the font of the reader is unknown.
const LETTER: f64 = 0.56;

/// Returns the width of `text` at `size` pixels, about.
pub(crate) fn text_width(text: &str, size: u32) -> f64 {
    text.chars().count() as f64 * f64::from(size) * LETTER
}

/// A picture that is being drawn.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    /// Width and height.
    pub(crate) size: [f64; 2],
    /// The shapes. A shape covers the shapes before it.
    pub(crate) shapes: Vec<Shape>,
}

/// A shape. Coordinates go right and down; colours are `#rrggbb`.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// A rectangle, from its upper left corner.
    Rect {
        corner: [f64; 2],
        size: [f64; 2],
        paint: Paint,
    },
    Circle {
        centre: [f64; 2],
        radius: f64,
        paint: Paint,
    },
    /// Parts of straight lines from point to point. A part is closed if it is filled.
    Path {
        parts: Vec<Vec<[f64; 2]>>,
        paint: Paint,
    },
    /// Squares of one size and colour, from their upper left corners.
    Squares {
        corners: Vec<[f64; 2]>,
        size: f64,
        fill: &'static str,
    },
    Text {
        /// The place of the anchor, on the base line.
        at: [f64; 2],
        text: String,
        style: Style,
    },
    /// Shapes with a title, which browsers show when the pointer is over them.
    Mark { title: String, shapes: Vec<Shape> },
}

/// How a shape is painted.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Paint {
    Fill(&'static str),
    Stroke {
        colour: &'static str,
        width: f64,
        dashed: bool,
    },
}

/// Lengths of the dashes of a line and of the gaps between them.
pub(crate) const DASHES: [f64; 2] = [4.0, 3.0];

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PointShape {
    Circle,
    Square,
    Up,
    Diamond,
    Down,
    Cross,
    Saltire,
    Right,
    Left,
    Star,
    Tall,
    Wide,
    Hourglass,
    Bowtie,
    Roof,
    Valley,
    Tee,
}

impl PointShape {
    pub(crate) const ALL: [Self; 17] = [
        Self::Circle,
        Self::Square,
        Self::Up,
        Self::Diamond,
        Self::Down,
        Self::Cross,
        Self::Saltire,
        Self::Right,
        Self::Left,
        Self::Star,
        Self::Tall,
        Self::Wide,
        Self::Hourglass,
        Self::Bowtie,
        Self::Roof,
        Self::Valley,
        Self::Tee,
    ];

    /// Returns the corners of the shape about the origin, for a circle of radius 1; none for a circle.
    fn corners(self) -> &'static [[f64; 2]] {
        match self {
            Self::Circle => &[],
            Self::Square => &[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]],
            Self::Up => &[[0.0, -1.1], [1.2, 1.1], [-1.2, 1.1]],
            Self::Diamond => &[[0.0, -1.35], [1.35, 0.0], [0.0, 1.35], [-1.35, 0.0]],
            Self::Down => &[[0.0, 1.1], [1.2, -1.1], [-1.2, -1.1]],
            Self::Cross => &[
                [-0.4, -1.2],
                [0.4, -1.2],
                [0.4, -0.4],
                [1.2, -0.4],
                [1.2, 0.4],
                [0.4, 0.4],
                [0.4, 1.2],
                [-0.4, 1.2],
                [-0.4, 0.4],
                [-1.2, 0.4],
                [-1.2, -0.4],
                [-0.4, -0.4],
            ],
            Self::Saltire => &[
                [0.57, -1.13],
                [1.13, -0.57],
                [0.57, 0.0],
                [1.13, 0.57],
                [0.57, 1.13],
                [0.0, 0.57],
                [-0.57, 1.13],
                [-1.13, 0.57],
                [-0.57, 0.0],
                [-1.13, -0.57],
                [-0.57, -1.13],
                [0.0, -0.57],
            ],
            Self::Right => &[[-1.1, -1.2], [1.1, 0.0], [-1.1, 1.2]],
            Self::Left => &[[1.1, -1.2], [-1.1, 0.0], [1.1, 1.2]],
            Self::Star => &[
                [0.0, -1.5],
                [0.35, -0.49],
                [1.43, -0.46],
                [0.57, 0.19],
                [0.88, 1.21],
                [0.0, 0.6],
                [-0.88, 1.21],
                [-0.57, 0.19],
                [-1.43, -0.46],
                [-0.35, -0.49],
            ],
            Self::Tall => &[[-0.5, -1.4], [0.5, -1.4], [0.5, 1.4], [-0.5, 1.4]],
            Self::Wide => &[[-1.4, -0.5], [1.4, -0.5], [1.4, 0.5], [-1.4, 0.5]],
            Self::Hourglass => &[
                [-1.1, -1.2],
                [1.1, -1.2],
                [0.25, 0.0],
                [1.1, 1.2],
                [-1.1, 1.2],
                [-0.25, 0.0],
            ],
            Self::Bowtie => &[
                [-1.2, -1.1],
                [-1.2, 1.1],
                [0.0, 0.25],
                [1.2, 1.1],
                [1.2, -1.1],
                [0.0, -0.25],
            ],
            Self::Roof => &[
                [-1.3, 0.3],
                [0.0, -1.1],
                [1.3, 0.3],
                [1.3, 1.2],
                [0.0, -0.2],
                [-1.3, 1.2],
            ],
            Self::Valley => &[
                [-1.3, -0.3],
                [0.0, 1.1],
                [1.3, -0.3],
                [1.3, -1.2],
                [0.0, 0.2],
                [-1.3, -1.2],
            ],
            Self::Tee => &[
                [-1.2, -1.1],
                [1.2, -1.1],
                [1.2, -0.4],
                [0.4, -0.4],
                [0.4, 1.2],
                [-0.4, 1.2],
                [-0.4, -0.4],
                [-1.2, -0.4],
            ],
        }
    }
}

/// How a text is placed and drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    pub(crate) size: u32,
    pub(crate) anchor: Anchor,
    pub(crate) bold: bool,
    pub(crate) colour: &'static str,
}

/// The part of a text that is at its place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Style {
    pub(crate) const fn new(size: u32) -> Self {
        Self {
            size,
            anchor: Anchor::Start,
            bold: false,
            colour: TEXT_COLOUR,
        }
    }

    pub(crate) const fn bold(self, bold: bool) -> Self {
        Self { bold, ..self }
    }

    pub(crate) const fn colour(self, colour: &'static str) -> Self {
        Self { colour, ..self }
    }

    pub(crate) const fn end(self) -> Self {
        Self {
            anchor: Anchor::End,
            ..self
        }
    }

    pub(crate) const fn middle(self) -> Self {
        Self {
            anchor: Anchor::Middle,
            ..self
        }
    }
}

impl Canvas {
    pub(crate) const fn new(width: f64, height: f64) -> Self {
        Self {
            size: [width, height],
            shapes: Vec::new(),
        }
    }

    pub(crate) fn text(&mut self, at: [f64; 2], text: &str, style: Style) {
        let text = text.to_owned();
        self.shapes.push(Shape::Text { at, text, style });
    }

    /// Draws a rectangle from its upper left corner.
    pub(crate) fn rect(&mut self, corner: [f64; 2], size: [f64; 2], fill: &'static str) {
        let paint = Paint::Fill(fill);
        self.shapes.push(Shape::Rect {
            corner,
            size,
            paint,
        });
    }

    /// Draws the border of a rectangle, without a filling.
    pub(crate) fn frame(&mut self, corner: [f64; 2], size: [f64; 2], stroke: &'static str) {
        let paint = solid(stroke, 1.0);
        self.shapes.push(Shape::Rect {
            corner,
            size,
            paint,
        });
    }

    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: &'static str, width: f64) {
        self.polyline(&[from, to], stroke, width);
    }

    pub(crate) fn dashed(
        &mut self,
        from: [f64; 2],
        to: [f64; 2],
        stroke: &'static str,
        width: f64,
    ) {
        let paint = Paint::Stroke {
            colour: stroke,
            width,
            dashed: true,
        };
        self.path(&[from, to], paint);
    }

    pub(crate) fn polyline(&mut self, points: &[[f64; 2]], stroke: &'static str, width: f64) {
        self.path(points, solid(stroke, width));
    }

    /// Draws lines that are one shape.
    pub(crate) fn lines(
        &mut self,
        lines: impl Iterator<Item = [[f64; 2]; 2]>,
        stroke: &'static str,
        width: f64,
    ) {
        let parts = lines.map(|line| line.to_vec()).collect();
        let paint = solid(stroke, width);
        self.shapes.push(Shape::Path { parts, paint });
    }

    /// Draws a closed outline.
    pub(crate) fn filled(&mut self, points: &[[f64; 2]], fill: &'static str) {
        self.path(points, Paint::Fill(fill));
    }

    fn path(&mut self, points: &[[f64; 2]], paint: Paint) {
        if !points.is_empty() {
            let parts = vec![points.to_vec()];
            self.shapes.push(Shape::Path { parts, paint });
        }
    }

    pub(crate) fn circle(&mut self, centre: [f64; 2], radius: f64, fill: &'static str) {
        let paint = Paint::Fill(fill);
        self.shapes.push(Shape::Circle {
            centre,
            radius,
            paint,
        });
    }

    /// Draws a point of the size of a circle of `radius`.
    pub(crate) fn point(
        &mut self,
        shape: PointShape,
        [x, y]: [f64; 2],
        radius: f64,
        fill: &'static str,
    ) {
        let corners = shape.corners().iter();
        let corners: Vec<[f64; 2]> = corners
            .map(|[right, down]| [x + radius * right, y + radius * down])
            .collect();
        match corners.is_empty() {
            true => self.circle([x, y], radius, fill),
            false => self.filled(&corners, fill),
        }
    }

    /// Draws a circle without a filling.
    pub(crate) fn ring(&mut self, centre: [f64; 2], radius: f64, stroke: &'static str) {
        let paint = solid(stroke, 1.2);
        self.shapes.push(Shape::Circle {
            centre,
            radius,
            paint,
        });
    }

    /// Draws squares of `size` about the given points, as one shape.
    pub(crate) fn dots(
        &mut self,
        points: impl Iterator<Item = [f64; 2]>,
        size: f64,
        fill: &'static str,
    ) {
        let corners = points.map(|point| point.map(|middle| middle - size / 2.0));
        self.shapes.push(Shape::Squares {
            corners: corners.collect(),
            size,
            fill,
        });
    }

    /// Draws a mark: shapes with a title, which browsers show when the pointer is over them.
    pub(crate) fn mark(&mut self, title: String, draw: impl FnOnce(&mut Self)) {
        let before = mem::take(&mut self.shapes);
        draw(self);
        let shapes = mem::replace(&mut self.shapes, before);
        self.shapes.push(Shape::Mark { title, shapes });
    }
}

/// Returns the paint of a line without dashes.
const fn solid(colour: &'static str, width: f64) -> Paint {
    Paint::Stroke {
        colour,
        width,
        dashed: false,
    }
}

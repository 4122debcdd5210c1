//! Writing pictures as SVG.

mod outlines;

use std::fmt::{self, Display, Formatter, Write};

use maud::Escaper;

use self::outlines::Outlines;
use crate::canvas::{Anchor, Canvas, DASHES, Paint, Shape, Style};
use crate::colours::{BACKGROUND, TEXT_COLOUR};

/// Height of the texts that do not name theirs.
const USUAL_SIZE: u32 = 12;

/// What a picture shows, for screen readers and search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Words<'w> {
    pub(crate) title: &'w str,
    pub(crate) description: &'w str,
}

/// How the letters of an SVG file are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Letters {
    /// As text in the font of the reader, which can be searched and copied: for pages.
    Text,
    /// As outlines, which look the same everywhere: for paper.
    Outlines,
}

/// Returns an SVG element of the given size with `panels`, each moved to its place. `style` has the style
/// rules of the element. With a scale, a pixel of the picture is that many points of paper. Without words, screen readers skip the element.
pub(crate) fn element(
    [width, height]: [f64; 2],
    scale: Option<f64>,
    panels: &[([f64; 2], &Canvas)],
    words: Option<Words<'_>>,
    style: &str,
    letters: Letters,
) -> String {
    let mut body = Body {
        svg: String::new(),
        outlines: (letters == Letters::Outlines).then(Outlines::new),
    };
    for (place, panel) in panels {
        body.panel(*place, panel);
    }
    let mut svg = String::new();
    let [across, down] = [width, height].map(|length| Number(length * scale.unwrap_or(1.0)));
    let unit = if scale.is_some() { "pt" } else { "" };
    let [width, height] = [width, height].map(Number);
    let namespace = match letters {
        Letters::Text => "",
        Letters::Outlines => outlines::NAMESPACE,
    };
    write(
        &mut svg,
        format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\"{namespace} width=\"{across}{unit}\" height=\"{down}{unit}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"system-ui, sans-serif\" font-size=\"{USUAL_SIZE}\" fill=\"{TEXT_COLOUR}\" "
        ),
    );
    match words {
        None => svg += "aria-hidden=\"true\">",
        Some(Words { title, description }) => {
            svg += "role=\"img\" aria-label=\"";
            write_escaped(&mut svg, title);
            svg += "\"><title>";
            write_escaped(&mut svg, title);
            svg += "</title><desc>";
            write_escaped(&mut svg, description);
            svg += "</desc>";
        }
    }
    svg += style;
    if let Some(outlines) = &body.outlines {
        outlines.write_definitions(&mut svg);
    }
    write(
        &mut svg,
        format_args!("<rect width=\"100%\" height=\"100%\" fill=\"{BACKGROUND}\"/>"),
    );
    svg + &body.svg + "</svg>"
}

/// The shapes of an SVG element.
struct Body {
    svg: String,
    /// The outlines of the letters; `None` if letters are text.
    outlines: Option<Outlines>,
}

impl Body {
    fn panel(&mut self, place: [f64; 2], panel: &Canvas) {
        if place == [0.0, 0.0] {
            return self.shapes(&panel.shapes);
        }
        let [x, y] = place.map(Number);
        write(
            &mut self.svg,
            format_args!("<g transform=\"translate({x} {y})\">"),
        );
        self.shapes(&panel.shapes);
        self.svg += "</g>";
    }

    fn shapes(&mut self, shapes: &[Shape]) {
        for shape in shapes {
            self.shape(shape);
        }
    }

    fn shape(&mut self, shape: &Shape) {
        let svg = &mut self.svg;
        match shape {
            Shape::Rect {
                corner,
                size,
                paint,
            } => {
                let ([x, y], [width, height]) = (corner.map(Number), size.map(Number));
                write(
                    svg,
                    format_args!(
                        "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {paint}/>"
                    ),
                );
            }
            Shape::Circle {
                centre,
                radius,
                paint,
            } => {
                let ([x, y], radius) = (centre.map(Number), Number(*radius));
                write(
                    svg,
                    format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {paint}/>"),
                );
            }
            Shape::Path { parts, paint } => {
                *svg += "<path d=\"";
                for part in parts {
                    for (number, point) in part.iter().enumerate() {
                        // Lines follow a start without a letter.
                        let step = ["M", "L", " "][number.min(2)];
                        let [x, y] = point.map(Number);
                        write(svg, format_args!("{step}{x} {y}"));
                    }
                    if matches!(paint, Paint::Fill(_)) {
                        svg.push('Z');
                    }
                }
                write(svg, format_args!("\" {paint}/>"));
            }
            Shape::Squares {
                corners,
                size,
                fill,
            } => {
                *svg += "<path d=\"";
                for [x, y] in corners {
                    // One decimal: there can be many thousands of them.
                    write(svg, format_args!("M{x:.1} {y:.1}h{size}v{size}h-{size}Z"));
                }
                write(svg, format_args!("\" fill=\"{fill}\"/>"));
            }
            Shape::Text { at, text, style } => {
                let outlines = self.outlines.as_mut();
                if outlines.is_some_and(|outlines| outlines.write_text(svg, *at, text, *style)) {
                    return;
                }
                let [x, y] = at.map(Number);
                write(svg, format_args!("<text x=\"{x}\" y=\"{y}\"{style}>"));
                write_escaped(svg, text);
                *svg += "</text>";
            }
            Shape::Mark { title, shapes } => {
                *svg += "<g><title>";
                write_escaped(svg, title);
                *svg += "</title>";
                self.shapes(shapes);
                self.svg += "</g>";
            }
        }
    }
}

fn write(svg: &mut String, text: fmt::Arguments<'_>) {
    svg.write_fmt(text).expect("a string can grow");
}

fn write_escaped(svg: &mut String, text: &str) {
    Escaper::new(svg)
        .write_str(text)
        .expect("a string can grow");
}

/// A number with at most two decimals.
struct Number(f64);

impl Display for Number {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // The sum is 0 if the number is -0.
        let rounded = (self.0 * 100.0).round() / 100.0 + 0.0;
        write!(f, "{rounded}")
    }
}

impl Display for Paint {
    /// Writes the attributes of a shape.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Fill(colour) => write!(f, "fill=\"{colour}\""),
            Self::Stroke {
                colour,
                width,
                dashed,
            } => {
                write!(f, "fill=\"none\" stroke=\"{colour}\"")?;
                if width != 1.0 {
                    let width = Number(width);
                    write!(f, " stroke-width=\"{width}\"")?;
                }
                if dashed {
                    let [dash, gap] = DASHES;
                    write!(f, " stroke-dasharray=\"{dash} {gap}\"")?;
                }
                Ok(())
            }
        }
    }
}

impl Display for Style {
    /// Writes the attributes of a text. The attributes that a text has without them are left out.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.size != USUAL_SIZE {
            write!(f, " font-size=\"{}\"", self.size)?;
        }
        match self.anchor {
            Anchor::Start => {}
            Anchor::Middle => write!(f, " text-anchor=\"middle\"")?,
            Anchor::End => write!(f, " text-anchor=\"end\"")?,
        }
        if self.bold {
            write!(f, " font-weight=\"bold\"")?;
        }
        match self.colour {
            TEXT_COLOUR => Ok(()),
            colour => write!(f, " fill=\"{colour}\""),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_written_with_at_most_two_decimals() {
        let mut canvas = Canvas::new(40.0, 30.5);
        canvas.mark("<&>".into(), |canvas| {
            canvas.rect([1.0 / 3.0, -0.001], [3.0, 4.0], "#ff0080");
            canvas.dashed([5.0, 6.0], [7.0, 8.126], "#000000", 0.5);
        });
        canvas.filled(&[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]], "#000000");
        canvas.dots([[5.0, 5.0]].into_iter(), 2.4, "#000000");
        canvas.ring([1.0, 2.0], 3.0, "#000000");
        let style = Style::new(11).end().bold(true);
        canvas.text([1.0, 2.0], "a < b", style);
        canvas.text([1.0, 2.0], "c", Style::new(USUAL_SIZE).colour("#66686c"));
        let lines = [[[0.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]]];
        canvas.lines(lines.into_iter(), "#000000", 1.0);
        let panels = [([0.0, 0.0], &canvas), ([52.0, 0.0], &canvas)];
        let words = Words {
            title: "\"title\"",
            description: "<what>",
        };
        let svg = element(
            [92.0, 30.5],
            None,
            &panels,
            Some(words),
            "<style></style>",
            Letters::Text,
        );
        let shapes = "<g><title>&lt;&amp;&gt;</title>\
            <rect x=\"0.33\" y=\"0\" width=\"3\" height=\"4\" fill=\"#ff0080\"/>\
            <path d=\"M5 6L7 8.13\" fill=\"none\" stroke=\"#000000\" stroke-width=\"0.5\" stroke-dasharray=\"4 3\"/></g>\
            <path d=\"M1 1L2 1 2 2Z\" fill=\"#000000\"/>\
            <path d=\"M3.8 3.8h2.4v2.4h-2.4Z\" fill=\"#000000\"/>\
            <circle cx=\"1\" cy=\"2\" r=\"3\" fill=\"none\" stroke=\"#000000\" stroke-width=\"1.2\"/>\
            <text x=\"1\" y=\"2\" font-size=\"11\" text-anchor=\"end\" font-weight=\"bold\">a &lt; b</text>\
            <text x=\"1\" y=\"2\" fill=\"#66686c\">c</text>\
            <path d=\"M0 0L1 1M2 0L3 1\" fill=\"none\" stroke=\"#000000\"/>";
        let head = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"92\" height=\"30.5\" viewBox=\"0 0 92 30.5\" \
            font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"#17181a\" role=\"img\" aria-label=\"&quot;title&quot;\">\
            <title>&quot;title&quot;</title><desc>&lt;what&gt;</desc><style></style><rect width=\"100%\" height=\"100%\" fill=\"#fdfdfc\"/>";
        let expected = format!("{head}{shapes}<g transform=\"translate(52 0)\">{shapes}</g></svg>");
        assert_eq!(svg, expected);
        let hidden = element([1.0, 1.0], None, &[], None, "", Letters::Text);
        assert!(hidden.contains(" aria-hidden=\"true\">"), "{hidden}");
    }
}

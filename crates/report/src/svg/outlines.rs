//! The letters of SVG files as outlines: each glyph once, and a reference to it for each letter.
//!
//! ```text
//! <defs><path id="r41" d="M342 -632l-134 363…"/>…</defs>            A of the regular font; b41 is that of the bold font
//! <g aria-label="AB" transform="translate(5 14) scale(.012)">      a text of 12 pixels; lengths are in 1/1000 of them
//!     <use xlink:href="#r41"/><use xlink:href="#r42" x="684"/></g>
//! ```
//!
//! The names of the glyphs are the same in all files, so files can be put into one page.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use ttf_parser::OutlineBuilder;

use super::{Number, write, write_escaped};
use crate::canvas::{Anchor, Style};
use crate::colours::TEXT_COLOUR;
use crate::font::Font;

/// The namespace of references. `href` alone is newer, and some programs for drawing and typesetting do not read it.
pub(super) const NAMESPACE: &str = " xmlns:xlink=\"http://www.w3.org/1999/xlink\"";

/// The outlines of the letters of a file.
pub(super) struct Outlines {
    /// The regular and the bold font.
    fonts: [Font; 2],
    /// The outline of each letter that was written, and whether the letter is bold.
    paths: BTreeMap<(bool, char), String>,
}

impl Outlines {
    pub(super) fn new() -> Self {
        Self {
            fonts: [Font::regular(), Font::bold()],
            paths: BTreeMap::new(),
        }
    }

    /// Writes a text with its anchor at `at`. Returns whether the font has all its letters; if not, nothing is
    /// written, because the widths of the other letters are unknown.
    pub(super) fn write_text(
        &mut self,
        svg: &mut String,
        at: [f64; 2],
        text: &str,
        style: Style,
    ) -> bool {
        let font = &self.fonts[usize::from(style.bold)];
        let glyphs: Option<Vec<u16>> = text.chars().map(|letter| font.glyph(letter)).collect();
        let Some(glyphs) = glyphs else {
            return false;
        };
        let advances: Vec<f32> = glyphs.iter().map(|&glyph| font.advance(glyph)).collect();
        let width = f64::from(advances.iter().sum::<f32>()) * f64::from(style.size) / 1000.0;
        let start = match style.anchor {
            Anchor::Start => at[0],
            Anchor::Middle => at[0] - width / 2.0,
            Anchor::End => at[0] - width,
        };
        *svg += "<g aria-label=\"";
        write_escaped(svg, text);
        let ([x, y], size) = ([start, at[1]].map(Number), style.size);
        write(
            svg,
            format_args!("\" transform=\"translate({x} {y}) scale(.{size:03})\""),
        );
        match style.colour {
            TEXT_COLOUR => *svg += ">",
            colour => write(svg, format_args!(" fill=\"{colour}\">")),
        }
        let mut x = 0.0;
        for ((letter, glyph), advance) in text.chars().zip(glyphs).zip(advances) {
            let path = self.paths.entry((style.bold, letter));
            let path = path.or_insert_with(|| path_data(font, glyph));
            if !path.is_empty() {
                let name = Name(style.bold, letter);
                write(svg, format_args!("<use xlink:href=\"#{name}\""));
                if x != 0.0 {
                    write(svg, format_args!(" x=\"{x}\""));
                }
                *svg += "/>";
            }
            x += advance;
        }
        *svg += "</g>";
        true
    }

    /// Writes the outlines of all letters.
    pub(super) fn write_definitions(&self, svg: &mut String) {
        *svg += "<defs>";
        for (&(bold, letter), path) in self.paths.iter().filter(|(_, path)| !path.is_empty()) {
            let name = Name(bold, letter);
            write(svg, format_args!("<path id=\"{name}\" d=\"{path}\"/>"));
        }
        *svg += "</defs>";
    }
}

/// The name of a glyph: its font and the number of its letter.
struct Name(bool, char);

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let font = if self.0 { 'b' } else { 'r' };
        write!(f, "{font}{:x}", u32::from(self.1))
    }
}

/// Returns the outline of a glyph as data of a path; empty for a space.
fn path_data(font: &Font, glyph: u16) -> String {
    let mut path = PathData {
        font,
        at: [0, 0],
        data: String::new(),
    };
    font.outline(glyph, &mut path);
    path.data
}

/// Data of a path in 1/1000 of the size of the text, with coordinates that go down. After the first point of a
/// part, they are relative to the last point, which is shorter.
struct PathData<'f> {
    font: &'f Font,
    at: [i32; 2],
    data: String,
}

impl PathData<'_> {
    fn point(&self, x: f32, y: f32) -> [i32; 2] {
        [x, -y].map(|length| self.font.scaled(length) as i32)
    }

    /// Writes `command` with points relative to the last point, and moves to the last of them.
    fn relative(&mut self, command: char, points: &[[i32; 2]]) {
        self.data.push(command);
        for (number, [x, y]) in points.iter().enumerate() {
            let [right, down] = [x - self.at[0], y - self.at[1]];
            self.number(right, number > 0);
            self.number(down, true);
        }
        self.at = points[points.len() - 1];
    }

    /// Writes a number. A sign separates it from the number before.
    fn number(&mut self, number: i32, follows_number: bool) {
        if follows_number && number >= 0 {
            self.data.push(' ');
        }
        let _ = write!(self.data, "{number}");
    }
}

impl OutlineBuilder for PathData<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let to = self.point(x, y);
        self.at = [0, 0];
        self.relative('M', &[to]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.point(x, y);
        match (to[0] == self.at[0], to[1] == self.at[1]) {
            (_, true) => {
                let _ = write!(self.data, "h{}", to[0] - self.at[0]);
            }
            (true, _) => {
                let _ = write!(self.data, "v{}", to[1] - self.at[1]);
            }
            _ => return self.relative('l', &[to]),
        }
        self.at = to;
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let points = [self.point(x1, y1), self.point(x, y)];
        self.relative('q', &points);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let points = [self.point(x1, y1), self.point(x2, y2), self.point(x, y)];
        self.relative('c', &points);
    }

    fn close(&mut self) {
        self.data.push('z');
    }
}

#[cfg(test)]
mod tests {
    use crate::canvas::{Canvas, Style};
    use crate::svg::{Letters, element};

    /// Returns a file with the texts, each with its anchor at the given place.
    fn written(texts: &[([f64; 2], &str, Style)]) -> String {
        let mut canvas = Canvas::new(200.0, 100.0);
        for (at, text, style) in texts {
            canvas.text(*at, text, *style);
        }
        let panels = [([0.0, 0.0], &canvas)];
        element(canvas.size, None, &panels, None, "", Letters::Outlines)
    }

    /// A is 1401 units wide, and 1585 if it is bold, of 2048.
    #[test]
    fn letters_have_the_places_of_the_pdf_file() {
        let style = Style::new(10);
        for (style, place, letter) in [
            (style, "100", "r41"),
            (style.middle(), "96.58", "r41"),
            (style.end(), "93.16", "r41"),
            (style.end().bold(true), "92.26", "b41"),
        ] {
            let svg = written(&[([100.0, 50.0], "A", style)]);
            let text = format!(
                "<g aria-label=\"A\" transform=\"translate({place} 50) scale(.010)\"><use xlink:href=\"#{letter}\"/></g>"
            );
            assert!(svg.contains(&text), "{text}: {svg}");
        }
    }

    #[test]
    fn each_letter_is_drawn_once_and_moves_the_next() {
        let colour = Style::new(12).colour("#66686c");
        let svg = written(&[
            ([5.0, 20.0], "l <l", colour),
            ([5.0, 40.0], "l", Style::new(11).bold(true)),
        ]);
        // l is 569 units wide, a space 651, < 1716. The outline of l is a rectangle from (193, 0) to (377, 1556).
        let text = "<g aria-label=\"l &lt;l\" transform=\"translate(5 20) scale(.012)\" fill=\"#66686c\">\
            <use xlink:href=\"#r6c\"/><use xlink:href=\"#r3c\" x=\"596\"/><use xlink:href=\"#r6c\" x=\"1434\"/></g>";
        assert!(svg.contains(text), "{svg}");
        let outline = "<path id=\"r6c\" d=\"M94-760h90v760h-90v-760z\"/>";
        assert_eq!(svg.matches(outline).count(), 1, "{svg}");
        let ids: Vec<&str> = svg.split(" id=\"").skip(1).map(|rest| &rest[..3]).collect();
        assert_eq!(ids, ["r3c", "r6c", "b6c"]);
        assert!(!svg.contains("<text"), "{svg}");
    }

    #[test]
    fn a_text_with_a_missing_letter_stays_text() {
        let svg = written(&[
            ([5.0, 20.0], "網 A", Style::new(12).middle()),
            ([5.0, 40.0], "A", Style::new(12)),
        ]);
        let text = "<text x=\"5\" y=\"20\" text-anchor=\"middle\">網 A</text>";
        assert!(svg.contains(text), "{svg}");
        assert_eq!(svg.matches("<use ").count(), 1, "{svg}");
    }
}

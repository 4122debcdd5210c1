//! Writing pictures as PDF: a file of one page, with the letters of its texts as an embedded font.

use std::collections::{BTreeMap, BTreeSet};

use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use subsetter::GlyphRemapper;
use thiserror::Error;

use crate::canvas::{Anchor, Canvas, DASHES, Paint, Shape, Style};
use crate::colours::BACKGROUND;
use crate::font::{CAP_HEIGHT, Font};

/// The picture of a figure cannot be written as a PDF file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PdfError {
    /// The font of PDF files has no glyphs for some letters.
    #[error("the font of PDF files, DejaVu Sans, has no {}", listed(.letters))]
    MissingLetters {
        /// The letters, sorted.
        letters: Vec<char>,
    },
}

/// Lists letters with their numbers: `中 (U+4E2D), 文 (U+6587)`. Letters that are invisible have only the number.
fn listed(letters: &[char]) -> String {
    let letters = letters.iter().map(|&letter| {
        let number = format!("U+{:04X}", u32::from(letter));
        match letter.escape_debug().count() {
            1 if !letter.is_whitespace() => format!("{letter} ({number})"),
            _ => number,
        }
    });
    letters.collect::<Vec<_>>().join(", ")
}

/// Strength of the compression. Higher levels take more time, and save little.
const COMPRESSION: u8 = 6;

/// A circle is drawn as four curves. This is the distance of their control points from their ends, as a
/// part of the radius.
const CURVE: f32 = 0.552_285;

/// Returns a PDF file of one page of the given size with `panels`, each moved to its place. A pixel is `scale` points.
///
/// # Errors
///
/// Returns an error if the font has no glyph for a letter of a text.
pub(crate) fn file(
    [width, height]: [f64; 2],
    scale: f64,
    panels: &[([f64; 2], &Canvas)],
    title: &str,
) -> Result<Vec<u8>, PdfError> {
    let mut page = Page {
        content: Content::new(),
        fonts: [Font::regular(), Font::bold()].map(PageFont::new),
        missing: BTreeSet::new(),
    };
    // From here, coordinates go down, as in the shapes.
    let scale = scale as f32;
    let flip = [scale, 0.0, 0.0, -scale, 0.0, height as f32 * scale];
    page.content.transform(flip);
    page.set_fill(BACKGROUND);
    page.content.rect(0.0, 0.0, width as f32, height as f32);
    page.content.fill_nonzero();
    for ([x, y], panel) in panels {
        page.content.save_state();
        let shift = [1.0, 0.0, 0.0, 1.0, rounded(*x), rounded(*y)];
        page.content.transform(shift);
        page.draw(&panel.shapes);
        page.content.restore_state();
    }
    if !page.missing.is_empty() {
        let letters = page.missing.into_iter().collect();
        return Err(PdfError::MissingLetters { letters });
    }
    Ok(page.into_file([width as f32 * scale, height as f32 * scale], title))
}

/// A page that is being drawn.
struct Page {
    content: Content,
    /// The regular and the bold font.
    fonts: [PageFont; 2],
    /// Letters that are missing in the fonts.
    missing: BTreeSet<char>,
}

/// A font, with the letters of the page.
struct PageFont {
    font: Font,
    /// The glyphs of the embedded font.
    glyphs: GlyphRemapper,
    /// The letter and the width of each glyph of the embedded font.
    letters: BTreeMap<u16, (char, f32)>,
}

impl PageFont {
    fn new(font: Font) -> Self {
        Self {
            font,
            glyphs: GlyphRemapper::new(),
            letters: BTreeMap::new(),
        }
    }
}

impl Page {
    fn draw(&mut self, shapes: &[Shape]) {
        for shape in shapes {
            match shape {
                Shape::Rect {
                    corner,
                    size,
                    paint,
                } => {
                    let ([x, y], [width, height]) = (corner.map(rounded), size.map(rounded));
                    self.content.rect(x, y, width, height);
                    self.paint(*paint);
                }
                Shape::Circle {
                    centre,
                    radius,
                    paint,
                } => {
                    self.circle(centre.map(rounded), rounded(*radius));
                    self.paint(*paint);
                }
                Shape::Path { parts, paint } => {
                    for (number, point) in parts.iter().flat_map(|part| part.iter().enumerate()) {
                        let [x, y] = point.map(rounded);
                        match number {
                            0 => self.content.move_to(x, y),
                            _ => self.content.line_to(x, y),
                        };
                    }
                    self.paint(*paint);
                }
                Shape::Squares {
                    corners,
                    size,
                    fill,
                } => {
                    let size = rounded(*size);
                    for corner in corners {
                        let [x, y] = corner.map(rounded);
                        self.content.rect(x, y, size, size);
                    }
                    self.paint(Paint::Fill(fill));
                }
                Shape::Text { at, text, style } => self.text(at.map(rounded), text, *style),
                Shape::Mark { shapes, .. } => self.draw(shapes),
            }
        }
    }

    fn circle(&mut self, [x, y]: [f32; 2], r: f32) {
        let c = r * CURVE;
        let content = &mut self.content;
        content.move_to(x + r, y);
        content.cubic_to(x + r, y + c, x + c, y + r, x, y + r);
        content.cubic_to(x - c, y + r, x - r, y + c, x - r, y);
        content.cubic_to(x - r, y - c, x - c, y - r, x, y - r);
        content.cubic_to(x + c, y - r, x + r, y - c, x + r, y);
        content.close_path();
    }

    /// Paints the shape that was added last.
    fn paint(&mut self, paint: Paint) {
        match paint {
            Paint::Fill(colour) => {
                self.set_fill(colour);
                self.content.fill_nonzero();
            }
            Paint::Stroke {
                colour,
                width,
                dashed,
            } => {
                let dashes = if dashed { &DASHES[..] } else { &[] };
                let [r, g, b] = rgb(colour);
                self.content
                    .set_stroke_rgb(r, g, b)
                    .set_line_width(width as f32)
                    .set_dash_pattern(dashes.iter().map(|&length| length as f32), 0.0)
                    .stroke();
            }
        }
    }

    fn set_fill(&mut self, colour: &str) {
        let [r, g, b] = rgb(colour);
        self.content.set_fill_rgb(r, g, b);
    }

    fn text(&mut self, [x, y]: [f32; 2], text: &str, style: Style) {
        let used = &mut self.fonts[usize::from(style.bold)];
        let (mut codes, mut width) = (Vec::new(), 0.0);
        for letter in text.chars() {
            let Some(glyph) = used.font.glyph(letter) else {
                self.missing.insert(letter);
                continue;
            };
            let code = used.glyphs.remap(glyph);
            let advance = used.font.advance(glyph);
            used.letters.insert(code, (letter, advance));
            codes.extend(code.to_be_bytes());
            width += advance * style.size as f32 / 1000.0;
        }
        let start = match style.anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        let name = Name(used.font.name.as_bytes());
        self.set_fill(style.colour);
        self.content
            .begin_text()
            .set_font(name, style.size as f32)
            .set_text_matrix([1.0, 0.0, 0.0, -1.0, rounded(f64::from(start)), y])
            .show(Str(&codes))
            .end_text();
    }

    fn into_file(self, [width, height]: [f32; 2], title: &str) -> Vec<u8> {
        let mut pdf = Pdf::new();
        let mut last = Ref::new(1);
        let [catalog, pages, page, content, info] = std::array::from_fn(|_| last.bump());
        pdf.catalog(catalog).pages(pages);
        pdf.document_info(info).title(TextStr(title));
        pdf.pages(pages).kids([page]).count(1);
        let mut fonts = Vec::new();
        for used in self.fonts.iter().filter(|used| !used.letters.is_empty()) {
            fonts.push((used.font.name, embed(&mut pdf, used, &mut last)));
        }
        let mut dictionary = pdf.page(page);
        dictionary
            .parent(pages)
            .media_box(Rect::new(0.0, 0.0, width, height))
            .contents(content);
        let mut resources = dictionary.resources();
        let mut names = resources.fonts();
        for (name, font) in fonts {
            names.pair(Name(name.as_bytes()), font);
        }
        names.finish();
        resources.finish();
        dictionary.finish();
        stream(&mut pdf, content, &self.content.finish());
        pdf.finish()
    }
}

/// Writes the letters of a font. Returns the reference to the font.
fn embed(pdf: &mut Pdf, used: &PageFont, last: &mut Ref) -> Ref {
    let PageFont {
        font,
        glyphs,
        letters,
    } = used;
    let [composite, cid_font, descriptor, data, unicode] = std::array::from_fn(|_| last.bump());
    let name = format!("{}+{}", tag(letters), font.name);
    let name = Name(name.as_bytes());
    let system = SystemInfo {
        registry: Str(b"Adobe"),
        ordering: Str(b"Identity"),
        supplement: 0,
    };
    pdf.type0_font(composite)
        .base_font(name)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(cid_font)
        .to_unicode(unicode);
    let mut cid = pdf.cid_font(cid_font);
    cid.subtype(CidFontType::Type2)
        .base_font(name)
        .system_info(system)
        .font_descriptor(descriptor)
        .cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = cid.widths();
    for (&code, &(_, width)) in letters {
        widths.consecutive(code, [width]);
    }
    widths.finish();
    cid.finish();
    let [left, bottom, right, top] = font.bounds();
    let [ascent, descent] = font.ascent_and_descent();
    pdf.font_descriptor(descriptor)
        .name(name)
        .flags(FontFlags::SYMBOLIC)
        .bbox(Rect::new(left, bottom, right, top))
        .italic_angle(0.0)
        .ascent(ascent)
        .descent(descent)
        .cap_height(CAP_HEIGHT)
        .stem_v(font.stem_width)
        .font_file2(data);
    let mut map = UnicodeCmap::new(Name(b"Letters"), system);
    for (&code, &(letter, _)) in letters {
        map.pair(code, letter);
    }
    stream(pdf, unicode, &map.finish());
    let subset = subsetter::subset(font.file, 0, glyphs).expect("the font has no faults");
    stream(pdf, data, &subset);
    composite
}

/// Returns six letters that differ between fonts with different letters. Programs that join PDF files
/// take fonts of one name for one font.
fn tag(letters: &BTreeMap<u16, (char, f32)>) -> String {
    let letters = letters.values().map(|(letter, _)| u64::from(*letter));
    let mut number = letters.fold(0_u64, |number, letter| {
        number.wrapping_mul(0x100_0000_01b3) ^ letter
    });
    let digits = (0..6).map(|_| {
        let digit = (number % 26) as u8;
        number /= 26;
        char::from(b'A' + digit)
    });
    digits.collect()
}

/// Writes `data`, compressed.
fn stream(pdf: &mut Pdf, id: Ref, data: &[u8]) {
    let packed = compress_to_vec_zlib(data, COMPRESSION);
    pdf.stream(id, &packed).filter(Filter::FlateDecode);
}

/// Rounds to two decimals, which are less than a printer shows.
fn rounded(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0) as f32
}

/// Returns the parts of a colour `#rrggbb`, from 0 to 1, with three decimals.
fn rgb(colour: &str) -> [f32; 3] {
    [1, 3, 5].map(|at| {
        let part = u8::from_str_radix(&colour[at..at + 2], 16).expect("colours are #rrggbb");
        (f32::from(part) / 255.0 * 1000.0).round() / 1000.0
    })
}

#[cfg(test)]
mod tests {
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    use super::*;
    use crate::colours::TEXT_COLOUR;

    fn canvas(text: &str, style: Style) -> Canvas {
        let mut canvas = Canvas::new(200.0, 100.0);
        canvas.text([100.0, 50.0], text, style);
        canvas
    }

    fn written(canvas: &Canvas) -> Vec<u8> {
        let panels = [([0.0, 0.0], canvas)];
        file(canvas.size, 1.0, &panels, "title χ").expect("a file")
    }

    /// Returns the streams of a file that are text: the content of the page, and the maps of letters.
    fn streams(pdf: &[u8]) -> Vec<String> {
        const BEGIN: &[u8] = b"\nstream\n";
        let begins = (0..pdf.len()).filter(|&at| pdf[at..].starts_with(BEGIN));
        let streams = begins.map(|at| {
            let packed = &pdf[at + BEGIN.len()..];
            decompress_to_vec_zlib(packed).expect("compressed data")
        });
        streams
            .filter_map(|bytes| String::from_utf8(bytes).ok())
            .collect()
    }

    #[test]
    fn letters_can_be_found_again() {
        let mut canvas = canvas("≥ Aχ", Style::new(12));
        canvas.text([0.0, 20.0], "A×", Style::new(12).bold(true));
        let pdf = written(&canvas);
        let streams = streams(&pdf);
        let maps = streams.iter().filter(|text| text.contains("beginbfchar"));
        let maps: Vec<&str> = maps.map(String::as_str).collect();
        let [regular, bold] = maps[..] else {
            panic!("{streams:?}");
        };
        // Glyphs are numbered in the order of their first letters.
        let entries = "<0001> <2265>\n<0002> <0020>\n<0003> <0041>\n<0004> <03C7>\n";
        assert!(regular.contains(entries), "{regular}");
        assert!(bold.contains("<0001> <0041>\n<0002> <00D7>\n"), "{bold}");
        for name in [&b"+DejaVuSans\n"[..], b"+DejaVuSans-Bold\n"] {
            assert!(pdf.windows(name.len()).any(|part| part == name));
        }
        assert_eq!(pdf, written(&canvas));
    }

    #[test]
    fn a_font_without_letters_is_left_out() {
        let pdf = written(&canvas("A", Style::new(12)));
        let bold = b"DejaVuSans-Bold";
        assert!(!pdf.windows(bold.len()).any(|part| part == bold));
    }

    #[test]
    fn texts_begin_left_of_their_anchors() {
        // A is 1401 units wide, of 2048.
        for (style, expected) in [
            (Style::new(10), "100"),
            (Style::new(10).middle(), "96.58"),
            (Style::new(10).end(), "93.16"),
        ] {
            let pdf = written(&canvas("A", style));
            let content = streams(&pdf).concat();
            let matrix = format!("1 0 0 -1 {expected} 50 Tm");
            assert!(content.contains(&matrix), "{matrix}: {content}");
        }
    }

    #[test]
    fn shapes_have_their_places_and_colours() {
        let mut canvas = Canvas::new(40.0, 30.0);
        canvas.mark("a title".into(), |canvas| {
            canvas.rect([1.0, 2.0], [3.0, 4.0], "#ff0080");
            canvas.dashed([5.0, 6.0], [7.0, 8.0], TEXT_COLOUR, 0.5);
        });
        canvas.filled(&[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]], "#000000");
        canvas.circle([30.0, 20.0], 4.0, "#000000");
        canvas.dots([[8.0, 9.0]].into_iter(), 2.0, "#000000");
        let panels = [([10.0, 20.0], &canvas)];
        let pdf = file([50.0, 60.0], 1.0, &panels, "").expect("a file");
        let content = streams(&pdf).concat();
        for part in [
            "1 0 0 -1 0 60 cm\n",
            "q\n1 0 0 1 10 20 cm\n1 2 3 4 re\n1 0 0.502 rg\nf\n",
            "5 6 m\n7 8 l\n0.09 0.094 0.102 RG\n0.5 w\n[4 3] 0 d\nS\n",
            "1 1 m\n2 1 l\n2 2 l\n0 0 0 rg\nf\n",
            // Control points are 4 · 0.552285 from the ends of each quarter.
            "34 20 m\n34 22.20914 32.20914 24 30 24 c\n27.79086 24 26 22.20914 26 20 c\n\
             26 17.79086 27.79086 16 30 16 c\n32.20914 16 34 17.79086 34 20 c\nh\n0 0 0 rg\nf\n",
            "7 8 2 2 re\n0 0 0 rg\nf\nQ",
        ] {
            assert!(content.contains(part), "{part}: {content}");
        }
        let size = b"/MediaBox [0 0 50 60]";
        assert!(pdf.windows(size.len()).any(|part| part == size));
    }

    #[test]
    fn missing_letters_are_named_once_and_sorted() {
        let error = |text| {
            let canvas = canvas(text, Style::new(12));
            file(canvas.size, 1.0, &[([0.0, 0.0], &canvas)], "").expect_err("missing letters")
        };
        let letters = vec!['中', '文', '🦀'];
        assert_eq!(error("文🦀 a 中文"), PdfError::MissingLetters { letters });
        let message = error("א\t\u{200d}").to_string();
        let names = "DejaVu Sans, has no U+0009, א (U+05D0), U+200D";
        assert!(message.ends_with(names), "{message}");
    }
}

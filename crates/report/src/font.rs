//! The fonts of the files for a paper: the glyph of each letter, its width and its outline.
//!
//! The files in the folder `fonts` have only letters that need no shaping, so each letter is one glyph. Lengths are in 1/1000 of the
//! size of the text, the unit of PDF, rounded to whole numbers: at 12 pixels, less than a hundredth of a pixel.

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Height of the capital letters of both fonts.
pub(crate) const CAP_HEIGHT: f32 = 729.0;

/// A font.
pub(crate) struct Font {
    /// The PostScript name.
    pub(crate) name: &'static str,
    /// Width of vertical stems.
    pub(crate) stem_width: f32,
    /// The whole file.
    pub(crate) file: &'static [u8],
    face: Face<'static>,
}

impl Font {
    /// Returns DejaVu Sans.
    pub(crate) fn regular() -> Self {
        let file = include_bytes!("../fonts/DejaVuSans.ttf");
        Self::new("DejaVuSans", 90.0, file)
    }

    /// Returns DejaVu Sans Bold.
    pub(crate) fn bold() -> Self {
        let file = include_bytes!("../fonts/DejaVuSans-Bold.ttf");
        Self::new("DejaVuSans-Bold", 180.0, file)
    }

    fn new(name: &'static str, stem_width: f32, file: &'static [u8]) -> Self {
        let face = Face::parse(file, 0).expect("the font has no faults");
        Self {
            name,
            stem_width,
            file,
            face,
        }
    }

    /// Returns the glyph of `letter`; `None` if the font does not have the letter.
    pub(crate) fn glyph(&self, letter: char) -> Option<u16> {
        // Glyph 0 stands for missing letters; the end mark of the table of letters, U+FFFF, has it.
        let glyph = self.face.glyph_index(letter)?.0;
        (glyph != 0).then_some(glyph)
    }

    /// Returns the width of a glyph.
    pub(crate) fn advance(&self, glyph: u16) -> f32 {
        let units = self.face.glyph_hor_advance(GlyphId(glyph));
        self.scaled(f32::from(units.expect("a glyph of the font")))
    }

    /// Draws the outline of a glyph in the units of the file, with coordinates that go up; nothing for a space.
    pub(crate) fn outline(&self, glyph: u16, to: &mut impl OutlineBuilder) {
        self.face.outline_glyph(GlyphId(glyph), to);
    }

    /// Returns the left, bottom, right and top end of all glyphs.
    pub(crate) fn bounds(&self) -> [f32; 4] {
        let bounds = self.face.global_bounding_box();
        [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max]
            .map(|end| self.scaled(f32::from(end)))
    }

    /// Returns the height above the base line, and the height below as a negative number.
    pub(crate) fn ascent_and_descent(&self) -> [f32; 2] {
        [self.face.ascender(), self.face.descender()].map(|end| self.scaled(f32::from(end)))
    }

    /// Converts a length in the units of the file.
    pub(crate) fn scaled(&self, length: f32) -> f32 {
        (length * 1000.0 / f32::from(self.face.units_per_em())).round()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected numbers are those of fontTools.
    #[test]
    fn letters_have_glyphs_and_widths() {
        let widths = |font: Font| {
            let width = |letter| font.advance(font.glyph(letter).expect("a glyph"));
            ['A', 'i', '×', '≥', '∞', '→', 'χ', 'µ', 'ж', ' '].map(width)
        };
        let scaled = |units: [u16; 10]| units.map(|units| (f32::from(units) / 2.048).round());
        assert_eq!(
            widths(Font::regular()),
            scaled([1401, 569, 1716, 1716, 1706, 1716, 1183, 1303, 1845, 651])
        );
        assert_eq!(
            widths(Font::bold()),
            scaled([1585, 702, 1716, 1716, 1706, 1716, 1321, 1507, 2038, 713])
        );
    }

    /// Letters that stand in other orders or shapes than they are stored are not in the font.
    #[test]
    fn letters_of_other_scripts_are_missing() {
        for font in [Font::regular(), Font::bold()] {
            for letter in ['中', '🦀', 'ب', 'א', '\n', '\u{200d}', '\u{ffff}'] {
                assert_eq!(font.glyph(letter), None, "{letter:?}");
            }
            // Two letters with one glyph would be one letter for a search.
            let glyphs = ('\0'..='\u{ffff}').filter_map(|letter| font.glyph(letter));
            let mut glyphs: Vec<u16> = glyphs.collect();
            let count = glyphs.len();
            assert!(count > 3000, "{count}");
            glyphs.sort_unstable();
            glyphs.dedup();
            assert_eq!(glyphs.len(), count);
        }
    }
}

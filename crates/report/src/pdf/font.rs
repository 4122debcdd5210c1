//! The fonts of PDF files: the glyph of each letter, and its width.
//!
//! Only what the two files in the folder `fonts` have is read: TrueType, with a table of letters of format 4.
//! Lengths are in 1/1000 of the size of the text, the unit of PDF.

/// Height of the capital letters of both fonts.
pub(super) const CAP_HEIGHT: f32 = 729.0;

/// A font.
pub(super) struct Font {
    /// The PostScript name.
    pub(super) name: &'static str,
    /// Width of vertical stems.
    pub(super) stem_width: f32,
    /// The whole file.
    pub(super) file: &'static [u8],
    /// Font header.
    head: Bytes,
    /// Header of the widths.
    hhea: Bytes,
    /// Widths of glyphs.
    hmtx: Bytes,
    /// The glyphs of letters: ranges of letters (format 4).
    letters: Bytes,
}

impl Font {
    /// Returns DejaVu Sans.
    pub(super) fn regular() -> Self {
        let file = include_bytes!("../../fonts/DejaVuSans.ttf");
        Self::new("DejaVuSans", 90.0, file)
    }

    /// Returns DejaVu Sans Bold.
    pub(super) fn bold() -> Self {
        let file = include_bytes!("../../fonts/DejaVuSans-Bold.ttf");
        Self::new("DejaVuSans-Bold", 180.0, file)
    }

    fn new(name: &'static str, stem_width: f32, file: &'static [u8]) -> Self {
        let [head, hhea, hmtx, cmap] =
            [b"head", b"hhea", b"hmtx", b"cmap"].map(|tag| Bytes(file).table(tag));
        // The entry of an encoding is the platform, the encoding, and the offset of the letters.
        let letters = Bytes(&cmap.0[cmap.u32(4 + 4)..]);
        assert_eq!(letters.u16(0), 4, "the format of the letters of {name}");
        Self {
            name,
            stem_width,
            file,
            head,
            hhea,
            hmtx,
            letters,
        }
    }

    /// Returns the glyph of `letter`; `None` if the font does not have the letter.
    pub(super) fn glyph(&self, letter: char) -> Option<u16> {
        let letter = u16::try_from(u32::from(letter)).ok()?;
        let table = self.letters;
        // Arrays with an entry for each range: ends, two bytes of padding, starts, steps, offsets of lists.
        let length = usize::from(table.u16(6));
        let ends = 14;
        let starts = ends + length + 2;
        let (steps, lists) = (starts + length, starts + 2 * length);
        let range = (0..length)
            .step_by(2)
            .find(|range| letter <= table.u16(ends + range))?;
        let past_start = letter.checked_sub(table.u16(starts + range))?;
        let step = table.u16(steps + range);
        let glyph = match usize::from(table.u16(lists + range)) {
            0 => letter.wrapping_add(step),
            // The offset is relative to its own place.
            list => match table.u16(lists + range + list + 2 * usize::from(past_start)) {
                0 => 0,
                glyph => glyph.wrapping_add(step),
            },
        };
        (glyph != 0).then_some(glyph)
    }

    /// Returns the width of a glyph.
    pub(super) fn advance(&self, glyph: u16) -> f32 {
        // All glyphs from the last on have its width.
        let last = self.hhea.u16(34) - 1;
        self.scaled(self.hmtx.u16(4 * usize::from(glyph.min(last))) as i16)
    }

    /// Returns the left, bottom, right and top end of all glyphs.
    pub(super) fn bounds(&self) -> [f32; 4] {
        [36, 38, 40, 42].map(|at| self.scaled(self.head.u16(at) as i16))
    }

    /// Returns the height above the base line, and the height below as a negative number.
    pub(super) fn ascent_and_descent(&self) -> [f32; 2] {
        [4, 6].map(|at| self.scaled(self.hhea.u16(at) as i16))
    }

    fn scaled(&self, length: i16) -> f32 {
        let units = self.head.u16(18);
        (f32::from(length) * 1000.0 / f32::from(units)).round()
    }
}

/// A part of a font file. Numbers are big-endian.
#[derive(Clone, Copy)]
struct Bytes(&'static [u8]);

impl Bytes {
    fn u16(self, at: usize) -> u16 {
        u16::from_be_bytes([self.0[at], self.0[at + 1]])
    }

    fn u32(self, at: usize) -> usize {
        usize::from(self.u16(at)) << 16 | usize::from(self.u16(at + 2))
    }

    /// Returns the table with the name `tag`.
    fn table(self, tag: &[u8; 4]) -> Self {
        let count = usize::from(self.u16(4));
        let entries = (0..count).map(|number| 12 + 16 * number);
        let entry = { entries }
            .find(|&entry| self.0[entry..].starts_with(tag))
            .expect("the font has the table");
        Self(&self.0[self.u32(entry + 8)..][..self.u32(entry + 12)])
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

    /// The table of widths ends before the last glyphs, which have the width of its last row.
    #[test]
    fn glyphs_after_the_table_of_widths_have_its_last_width() {
        for font in [Font::regular(), Font::bold()] {
            let rows = font.hhea.u16(34);
            let last = font.advance(rows - 1);
            assert_eq!(
                [rows, rows + 1, u16::MAX].map(|glyph| font.advance(glyph)),
                [last; 3]
            );
        }
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

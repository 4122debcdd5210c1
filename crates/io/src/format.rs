//! The formats, and how a file's format is recognised.

use std::path::Path;

use crate::byte_source::words;
use crate::off_keyword::OffKeyword;

sixfold_core::named! {
    /// A file format. Formats with a text form and a binary form have one entry for each.
    #[non_exhaustive]
    pub enum Format: "format", shown by title {
        /// Wavefront OBJ.
        Obj = "obj",
        /// STL with little-endian binary facets.
        Stl = "stl",
        /// STL as text.
        StlAscii = "stl-ascii",
        /// PLY with little-endian binary data.
        Ply = "ply",
        /// PLY with big-endian binary data.
        PlyBigEndian = "ply-big-endian",
        /// PLY as text.
        PlyAscii = "ply-ascii",
        /// Geomview OFF as text.
        Off = "off",
        /// glTF 2.0 in JSON.
        Gltf = "gltf",
        /// glTF 2.0 in one binary file.
        Glb = "glb",
    }
}

impl Format {
    /// The endings of file names, without the dot, in lower case.
    pub const EXTENSIONS: [&str; 6] = ["obj", "stl", "ply", "off", "gltf", "glb"];

    /// Returns the name for readers: `ASCII STL`.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Stl => "binary STL",
            Self::StlAscii => "ASCII STL",
            Self::Ply => "binary PLY",
            Self::PlyBigEndian => "big-endian PLY",
            Self::PlyAscii => "ASCII PLY",
            Self::Off => "OFF",
            Self::Gltf => "glTF",
            Self::Glb => "binary glTF",
        }
    }

    /// Returns the usual ending of a file name, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Stl | Self::StlAscii => "stl",
            Self::Ply | Self::PlyBigEndian | Self::PlyAscii => "ply",
            Self::Off => "off",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
        }
    }

    /// Returns the format for a file with the name `path`; `None` if the ending is missing or
    /// unknown. For STL and PLY it is the binary form (little-endian).
    ///
    /// # Examples
    ///
    /// ```
    /// use sixfold_io::Format;
    ///
    /// assert_eq!(Format::from_path("parts/wheel.STL"), Some(Format::Stl));
    /// assert_eq!(Format::from_path("wheel.step"), None);
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let extension = path.as_ref().extension()?.to_str()?.to_ascii_lowercase();
        Self::EXTENSIONS
            .contains(&extension.as_str())
            .then(|| extension.parse().ok())?
    }

    /// Returns the title with its article, for messages: `an OBJ file`.
    pub(crate) fn with_article(self) -> String {
        let article = match self {
            Self::Obj | Self::StlAscii | Self::PlyAscii | Self::Off => "an",
            _ => "a",
        };
        format!("{article} {self} file")
    }

    /// Returns whether the format is text that has lines.
    pub(crate) const fn is_text(self) -> bool {
        matches!(
            self,
            Self::Obj | Self::StlAscii | Self::PlyAscii | Self::Off
        )
    }

    pub(crate) const fn is_stl(self) -> bool {
        matches!(self, Self::Stl | Self::StlAscii)
    }

    /// Returns whether faces can have more than three corners.
    pub(crate) const fn holds_polygons(self) -> bool {
        !self.is_stl() && !matches!(self, Self::Gltf | Self::Glb)
    }

    /// Returns the number of the first vertex, as the format and its messages count.
    pub(crate) const fn first_vertex(self) -> usize {
        match self {
            Self::Obj => 1,
            _ => 0,
        }
    }
}

/// Bytes of a file that are searched for its format.
pub(crate) const DETECTION_BYTES: usize = 1 << 14;

/// Bytes of a binary STL before its first facet, and bytes of a facet.
pub(crate) const STL_HEADER: usize = 84;
pub(crate) const STL_FACET: usize = 50;

/// Returns the format of a file that begins with `start` and has `size` bytes, if it is known.
/// `None` if the content has no sign of any format.
///
/// For PLY, the form may be another one; the header says which.
pub(crate) fn detect(start: &[u8], size: Option<u64>) -> Option<Format> {
    let text = start.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(start);
    if start.starts_with(b"glTF") {
        return Some(Format::Glb);
    }
    if text.starts_with(b"ply") && text.get(3).is_some_and(u8::is_ascii_whitespace) {
        return Some(Format::Ply);
    }
    if is_binary_off(text) {
        return Some(Format::Off);
    }
    if is_utf16(start) {
        return None;
    }
    if is_binary_stl(start, size) {
        return Some(Format::Stl);
    }
    if is_ascii_stl(text) {
        return Some(Format::StlAscii);
    }
    if text.trim_ascii_start().first() == Some(&b'{') {
        return Some(Format::Gltf);
    }
    text_format(text)
}

/// Returns whether the first line is that of a binary OFF file, such as `OFF BINARY`.
fn is_binary_off(start: &[u8]) -> bool {
    let line = start.split(|byte| matches!(byte, b'\n' | b'\r')).next();
    let mut words = words(line.unwrap_or_default());
    let is_keyword = words
        .next()
        .is_some_and(|word| OffKeyword::parse(word).is_some());
    is_keyword
        && words
            .next()
            .is_some_and(|word| word.eq_ignore_ascii_case(b"binary"))
}

/// Returns whether the bytes are a text in UTF-16: a byte order mark, and ASCII characters.
fn is_utf16(start: &[u8]) -> bool {
    let is_ascii = |at: usize| start.get(at).is_some_and(u8::is_ascii_graphic);
    match start {
        [0xFF, 0xFE, _, 0, ..] => is_ascii(2),
        [0xFE, 0xFF, 0, ..] => is_ascii(3),
        _ => false,
    }
}

/// Returns whether the bytes can be a binary STL. If the size is not known, or the file is cut off,
/// the numbers of the first facet decide.
fn is_binary_stl(start: &[u8], size: Option<u64>) -> bool {
    let Some(&[a, b, c, d]) = start.get(STL_HEADER - 4..STL_HEADER) else {
        return false;
    };
    let facets = u64::from(u32::from_le_bytes([a, b, c, d]));
    if size == Some(STL_HEADER as u64 + STL_FACET as u64 * facets) {
        return true;
    }
    let Some(facet) = start.get(STL_HEADER..STL_HEADER + 48) else {
        return false;
    };
    let numbers = facet.as_chunks::<4>().0.iter();
    let mut numbers = numbers.map(|&bytes| f32::from_le_bytes(bytes));
    // A text has no zero bytes; a binary STL has them in its count or in a coordinate. Some programs
    // write no count, and normals that are not numbers.
    start[..STL_HEADER + 48].contains(&0)
        && (facets > 0 || facet.iter().any(|&byte| byte != 0))
        && numbers
            .by_ref()
            .take(3)
            .all(|x| x.is_nan() || x.abs() <= 1.01)
        && numbers.all(|x| x.abs() <= 1e15)
}

/// Returns whether the corners of a facet of a binary STL have a plausible size.
pub(crate) fn has_plausible_corners(facet: &[u8; STL_FACET]) -> bool {
    let corners = facet[12..48].as_chunks::<4>().0.iter();
    let mut corners = corners.map(|&bytes| f32::from_le_bytes(bytes));
    corners.all(|x| x.abs() <= 1e15)
}

/// Returns whether a text is an ASCII STL: it begins with `solid`, or it has lines before it, such as
/// comments, and the line after `solid` is one of STL. Zero bytes may follow the text.
fn is_ascii_stl(text: &[u8]) -> bool {
    let padding = text.iter().rev().take_while(|byte| **byte == 0).count();
    let text = &text[..text.len() - padding];
    if text.contains(&0) || (padding > 0 && !is_text(text)) {
        return false;
    }
    let start = text.trim_ascii_start().get(..5);
    if start.is_some_and(|start| start.eq_ignore_ascii_case(b"solid")) {
        return true;
    }
    let mut keywords = text
        .split(|byte| matches!(byte, b'\n' | b'\r'))
        .filter_map(|line| words(line).next())
        .filter(|word| !is_stl_comment(word));
    let is_one_of = |word: &[u8], names: &[&str]| {
        let mut names = names.iter();
        names.any(|name| word.eq_ignore_ascii_case(name.as_bytes()))
    };
    let next = ["facet", "color", "colour", "endsolid", "end"];
    keywords.any(|word| is_one_of(word, &["solid"]))
        && keywords.next().is_some_and(|word| is_one_of(word, &next))
}

/// Returns whether a comment of ASCII STL begins with `word`. The format has no comments, but some
/// programs write them.
pub(crate) fn is_stl_comment(word: &[u8]) -> bool {
    let signs: [&[u8]; 3] = [b"#", b";", b"//"];
    signs.iter().any(|sign| word.starts_with(sign))
}

/// Returns whether the start of a stream, whose size is not known, can be that of a binary STL: it is
/// not text, its number of facets needs at least the bytes that are there, and the corners of all
/// these facets are plausible. Normals of any length are allowed.
pub(crate) fn may_be_binary_stl(start: &[u8]) -> bool {
    let Some((header, rest)) = start.split_at_checked(STL_HEADER) else {
        return false;
    };
    let &[.., a, b, c, d] = header else {
        return false;
    };
    let facets = u32::from_le_bytes([a, b, c, d]) as usize;
    let records = rest.as_chunks::<STL_FACET>().0;
    start.contains(&0)
        && !records.is_empty()
        && facets >= rest.len() / STL_FACET
        && records.iter().all(has_plausible_corners)
}

/// Returns whether the start of a file is text, and not white space only.
pub(crate) fn is_text(start: &[u8]) -> bool {
    let is_control = |byte: &u8| byte.is_ascii_control() && !matches!(byte, b'\t'..=b'\r');
    !start.trim_ascii().is_empty() && !start.iter().any(is_control)
}

/// Returns the format of a text that begins with `text`.
fn text_format(text: &[u8]) -> Option<Format> {
    let mut first = true;
    for line in text.split(|byte| matches!(byte, b'\n' | b'\r')) {
        let mut words = words(line);
        let Some(keyword) = words.next().filter(|word| word[0] != b'#') else {
            continue;
        };
        if first && OffKeyword::parse(keyword).is_some() {
            return Some(Format::Off);
        }
        first = false;
        let values = words.count();
        match keyword {
            b"v" if values >= 3 => return Some(Format::Obj),
            b"vn" | b"vt" | b"f" | b"o" | b"g" | b"usemtl" | b"mtllib" if values >= 1 => {
                return Some(Format::Obj);
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_endings_are_read_back() {
        for format in Format::ALL {
            assert_eq!(format.name().parse(), Ok(format));
            let path = format!("a.{}", format.extension().to_uppercase());
            let found = Format::from_path(&path).expect("an ending");
            assert_eq!(found.extension(), format.extension());
        }
        let error = "step".parse::<Format>().expect_err("unknown");
        assert!(
            error
                .to_string()
                .starts_with("no format is called `step`: choose from obj, stl,")
        );
        assert_eq!(Format::from_path("stl"), None);
        assert_eq!(Format::from_path("a.stl-ascii"), None);
    }

    #[test]
    fn binary_off_and_utf_16_are_not_taken_for_binary_stl() {
        // A count and coordinates of zeros, as of a binary STL.
        let mut bytes = b"OFF BINARY\n".to_vec();
        bytes.extend(3_u32.to_be_bytes());
        bytes.resize(200, 0);
        bytes[90] = 1;
        assert_eq!(detect(&bytes, Some(200)), Some(Format::Off));
        bytes[4] = b'T';
        assert_eq!(detect(&bytes, Some(200)), Some(Format::Stl));
        for is_little in [true, false] {
            let text = "\u{feff}# a\nv 0 0 0\n".repeat(20);
            let units = text.encode_utf16();
            let bytes = units.map(|unit| match is_little {
                true => unit.to_le_bytes(),
                false => unit.to_be_bytes(),
            });
            let bytes: Vec<u8> = bytes.flatten().collect();
            assert_eq!(detect(&bytes, Some(bytes.len() as u64)), None);
        }
    }

    #[test]
    fn the_content_decides() {
        for (text, format) in [
            ("glTF\x02\0\0\0", Format::Glb),
            ("ply\nformat ascii 1.0\n", Format::Ply),
            ("\u{feff}ply\r\n", Format::Ply),
            (" \n{\"asset\":{}}", Format::Gltf),
            ("solid a\nfacet normal 0 0 0\n", Format::StlAscii),
            ("SOLID\n", Format::StlAscii),
            ("# a\n\nOFF\n", Format::Off),
            ("STCN4nOFF 1 2 3", Format::Off),
            ("NCSTOFF\n", Format::Off),
            ("off 3 1 0\n", Format::Off),
            ("# a\nmtllib b\n", Format::Obj),
            ("x\nv 1 2 3\n", Format::Obj),
        ] {
            assert_eq!(detect(text.as_bytes(), None), Some(format), "{text}");
        }
        for text in [
            "",
            "plywood",
            "CCOFF",
            "SOFF",
            "v",
            "hello world\n",
            "\u{89}PNG\r\n\0\0",
        ] {
            assert_eq!(detect(text.as_bytes(), None), None, "{text}");
        }
    }

    #[test]
    fn the_size_of_a_binary_stl_decides_against_its_header() {
        let mut bytes = b"solid of an exporter".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(2_u32.to_le_bytes());
        bytes.resize(STL_HEADER + 2 * STL_FACET, b'z');
        assert_eq!(detect(&bytes, Some(184)), Some(Format::Stl));
        assert_eq!(
            detect(&bytes, Some(185)),
            None,
            "the coordinates are not plausible"
        );
        bytes[84..132].fill(0);
        assert_eq!(detect(&bytes, None), Some(Format::Stl));
        assert_eq!(detect(&bytes[..100], None), None);
    }
}

//! The first word of an OFF file.

/// The first word of a file, `OFF`, and its prefixes, which say what a vertex has.
///
/// Geomview writes the prefixes in the order `ST`, `C`, `N`, `4`, `n`, and the values of a vertex in
/// the order position, normal, colour, texture coordinates. Other programs write the prefixes in
/// other orders; the order of the values stays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct OffKeyword {
    /// `ST`: two texture coordinates.
    pub(crate) texture: bool,
    /// `C`: a colour.
    pub(crate) colour: bool,
    /// `N`: a normal.
    pub(crate) normal: bool,
    /// `4`: a fourth coordinate, by which the others are divided.
    pub(crate) homogeneous: bool,
    /// `n`: the number of coordinates follows the keyword.
    pub(crate) any_dimension: bool,
}

impl OffKeyword {
    /// Parses a keyword and returns it with the digits that follow it without a blank, as in `OFF4 4
    /// 0`; `None` if `word` is not a keyword. Each prefix may occur once, in any order. Only `N` and
    /// `n` depend on upper and lower case.
    pub(crate) fn parse(word: &[u8]) -> Option<(Self, &[u8])> {
        let digits = word.iter().rev().take_while(|byte| byte.is_ascii_digit());
        let (word, digits) = word.split_at(word.len() - digits.count());
        let (mut rest, off) = word.split_at_checked(word.len().checked_sub(3)?)?;
        if !off.eq_ignore_ascii_case(b"OFF") {
            return None;
        }
        let mut keyword = Self::default();
        while let [first, after @ ..] = rest {
            let (flag, after) = match (first, after) {
                (b'S' | b's', [b'T' | b't', after @ ..]) => (&mut keyword.texture, after),
                (b'C' | b'c', _) => (&mut keyword.colour, after),
                (b'N', _) => (&mut keyword.normal, after),
                (b'4', _) => (&mut keyword.homogeneous, after),
                (b'n', _) => (&mut keyword.any_dimension, after),
                _ => return None,
            };
            if std::mem::replace(flag, true) {
                return None;
            }
            rest = after;
        }
        Some((keyword, digits))
    }
}

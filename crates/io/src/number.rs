//! Numbers in text.

/// A coordinate in the precision of the file and in 32 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coordinate {
    pub(crate) wide: f64,
    /// The 32-bit number nearest to the number in the file.
    pub(crate) narrow: f32,
}

impl From<f32> for Coordinate {
    fn from(narrow: f32) -> Self {
        let wide = f64::from(narrow);
        Self { wide, narrow }
    }
}

impl From<f64> for Coordinate {
    fn from(wide: f64) -> Self {
        let narrow = wide as f32;
        Self { wide, narrow }
    }
}

/// Parses a decimal number; `None` if `word` is not a number.
pub(crate) fn parse_coordinate(word: &[u8]) -> Option<Coordinate> {
    let text = str::from_utf8(word).ok()?;
    let wide: f64 = text.parse().ok()?;
    // Rounding twice gives the nearest number, unless the first result is exactly between two
    // 32-bit numbers. Subnormal 32-bit numbers have fewer digits, so their middles differ.
    let between = wide.to_bits() & ((1 << 29) - 1) == 1 << 28;
    let tiny = wide.abs() < f64::from(f32::MIN_POSITIVE) && wide != 0.0;
    let narrow = if between || tiny {
        text.parse().ok()?
    } else {
        wide as f32
    };
    Some(Coordinate { wide, narrow })
}

/// Parses a whole number; `None` if `word` is not one, or is outside the range of `T`.
pub(crate) fn parse_whole<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_between_two_neighbours_are_rounded_once() {
        // 2²⁴ + 1 is between two 32-bit numbers; a digit beyond 64 bits decides.
        let above = "16777217.0000000000000000000000001";
        let found = parse_coordinate(above.as_bytes()).expect("a number");
        assert_eq!(found.narrow, 16_777_218.0);
        assert_eq!(
            f64::from(above.parse::<f64>().expect("a number") as f32),
            16_777_216.0
        );
    }

    proptest! {
        #[test]
        fn the_nearest_number_is_found(bits in any::<u32>(), digits in "[0-9]{0,20}") {
            let value = f32::from_bits(bits);
            prop_assume!(value.is_finite());
            for text in [format!("{value:e}"), format!("{value}"), format!("{}{digits}", value.trunc())] {
                let found = parse_coordinate(text.as_bytes()).expect("a number");
                let expected: f32 = text.parse().expect("a number");
                prop_assert_eq!(found.narrow.to_bits(), expected.to_bits(), "{}", text);
            }
        }
    }
}

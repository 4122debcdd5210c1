//! Parses a sharpness.

/// Parses a sharpness: a number that is 0 or greater, or `inf`.
pub(crate) fn sharpness(word: &str) -> Option<f32> {
    let number = word.parse().ok();
    // Converts -0 to 0.
    number
        .filter(|&number: &f32| number >= 0.0)
        .map(|number| number + 0.0)
}

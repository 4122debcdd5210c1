//! A sharpness as text.

/// The sharpness that `word` says: a number from 0, or `inf`.
pub(crate) fn sharpness(word: &str) -> Option<f32> {
    let number = word.parse().ok();
    // Zero may be written as -0, and has no sign here.
    number
        .filter(|&number: &f32| number >= 0.0)
        .map(|number| number + 0.0)
}

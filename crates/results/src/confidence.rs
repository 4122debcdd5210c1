//! The confidence of intervals.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::statistics::student_at;

/// The part of all intervals that contain the true value, from 0.5 to 0.999.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Deserialize, Serialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct Confidence(f64);

// The number is never NaN.
impl Eq for Confidence {}

/// The reason why a number or a text is not a [`Confidence`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("write a part from 0.5 to 0.999 or a percentage from 50% to 99.9%, such as 0.95 or 95%")]
pub struct NotAConfidence;

/// Digits after the point that count, as a factor: 99.9% and 0.999 are the same.
const DIGITS: f64 = 1e6;

impl Confidence {
    /// Returns whether this is the default, which documents leave out.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the quantile of Student's distribution that is the half-width of an interval; infinity for 0 degrees of
    /// freedom.
    pub(crate) fn student(self, freedom: f64) -> f64 {
        student_at(f64::midpoint(1.0, self.0), freedom)
    }

    /// Returns the quantile of the normal distribution that is the half-width of an interval, to six digits.
    pub(crate) fn normal(self) -> f64 {
        let quantile = Normal::standard().inverse_cdf(f64::midpoint(1.0, self.0));
        (DIGITS * quantile).round() / DIGITS
    }
}

impl Default for Confidence {
    fn default() -> Self {
        Self(0.95)
    }
}

impl TryFrom<f64> for Confidence {
    type Error = NotAConfidence;

    fn try_from(part: f64) -> Result<Self, NotAConfidence> {
        let part = (DIGITS * part).round() / DIGITS;
        match (0.5..=0.999).contains(&part) {
            true => Ok(Self(part)),
            false => Err(NotAConfidence),
        }
    }
}

impl From<Confidence> for f64 {
    fn from(confidence: Confidence) -> Self {
        confidence.0
    }
}

impl FromStr for Confidence {
    type Err = NotAConfidence;

    /// Parses a part of 1, such as `0.99`, or a percentage, such as `99%`.
    fn from_str(text: &str) -> Result<Self, NotAConfidence> {
        let (number, all) = match text.trim().strip_suffix('%') {
            Some(percentage) => (percentage.trim_end(), 100.0),
            None => (text.trim(), 1.0),
        };
        let number: f64 = number.parse().map_err(|_| NotAConfidence)?;
        Self::try_from(number / all)
    }
}

impl fmt::Display for Confidence {
    /// Writes a percentage, such as `95 %`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!(
            "{} %",
            (DIGITS * self.0).round() / (DIGITS / 100.0)
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_and_a_percentage_are_the_same() {
        let parsed = |text: &str| text.parse::<Confidence>();
        for (part, percentage, shown) in [
            ("0.5", "50%", "50 %"),
            ("0.95", " 95 % ", "95 %"),
            ("0.975", "97.5%", "97.5 %"),
            ("0.999", "99.9%", "99.9 %"),
        ] {
            let confidence = parsed(part).expect("allowed");
            assert_eq!(parsed(percentage), Ok(confidence));
            assert_eq!(confidence.to_string(), shown);
        }
        assert!(parsed("95%").expect("allowed").is_default());
        for text in [
            "0", "1", "95", "0.49", "100%", "99.95%", "nan", "inf", "-0.95", "abc", "%", "",
        ] {
            assert_eq!(parsed(text), Err(NotAConfidence), "{text}");
        }
    }

    #[test]
    fn documents_have_a_number() {
        let text = serde_json::to_string(&Confidence(0.99)).expect("a number");
        assert_eq!(text, "0.99");
        assert_eq!(serde_json::from_str(&text).ok(), Some(Confidence(0.99)));
        assert!(serde_json::from_str::<Confidence>("95").is_err());
    }

    #[test]
    fn quantiles_are_those_of_tables() {
        let known = [(1.0, 12.7062), (2.0, 4.3027), (5.0, 2.5706), (20.0, 2.0860)];
        for (freedom, quantile) in known {
            let found = Confidence::default().student(freedom);
            assert!((found / quantile - 1.0).abs() < 1e-4, "{freedom}: {found}");
            assert_eq!(found, student_at(0.975, freedom));
        }
        assert_eq!(Confidence::default().student(0.0), f64::INFINITY);
        assert!((Confidence(0.99).student(5.0) / 4.0321 - 1.0).abs() < 1e-4);
        assert_eq!(Confidence::default().normal(), 1.959_964);
        assert_eq!(Confidence(0.8).normal(), 1.281_552);
    }
}

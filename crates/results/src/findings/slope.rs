//! The growth of a time with the size of the mesh, as a power law.

use serde::{Deserialize, Serialize};

/// A fitted power law: the time is proportional to the size of the mesh raised to `exponent`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Slope {
    /// The exponent of the power law.
    pub exponent: f64,
    /// The standard error of the exponent; `None` with fewer than three sizes.
    pub standard_error: Option<f64>,
    /// The number of sizes to which the power law is fitted.
    pub sizes: usize,
}

impl Slope {
    /// Fits a line to the logarithms of (size, time) by least squares. Leaves out points without a
    /// logarithm. Returns `None` with fewer than two sizes.
    pub fn fit(points: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let valid = points.into_iter().filter(|&(size, time)| {
            let has_log = |x: f64| x > 0.0 && x.is_finite();
            has_log(size) && has_log(time)
        });
        let logs: Vec<(f64, f64)> = valid.map(|(size, time)| (size.ln(), time.ln())).collect();
        let count = logs.len() as f64;
        let (sum_x, sum_y) = logs
            .iter()
            .fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
        let (mean_x, mean_y) = (sum_x / count, sum_y / count);
        let spread: f64 = logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
        if logs.len() < 2 || spread < 1e-12 {
            return None;
        }
        let common = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y));
        let exponent = common.sum::<f64>() / spread;
        let off = |(x, y): &(f64, f64)| y - mean_y - exponent * (x - mean_x);
        let residual: f64 = logs.iter().map(|point| off(point).powi(2)).sum();
        let error = (residual / (count - 2.0) / spread).sqrt();
        Some(Self {
            exponent,
            standard_error: (logs.len() > 2).then_some(error),
            sizes: logs.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_powers_are_found_to_the_last_digits() {
        for exponent in [0.0, 0.5, 1.0, 1.37, 2.0] {
            let sizes = [1e3, 3e3, 1e4, 5e4, 1e6];
            let slope =
                Slope::fit(sizes.map(|n: f64| (n, 7.0 * n.powf(exponent)))).expect("a line");
            assert!((slope.exponent - exponent).abs() < 1e-12, "{slope:?}");
            assert!(
                slope.standard_error.expect("five points") < 1e-7,
                "{slope:?}"
            );
            assert_eq!(slope.sizes, 5);
        }
    }

    #[test]
    fn a_bend_changes_the_slopes_of_the_parts_and_the_error_of_the_whole() {
        // The time is linear up to 1e5, and then grows with the power 1.5.
        let time = |n: f64| {
            if n <= 1e5 {
                n
            } else {
                1e5 * (n / 1e5).powf(1.5)
            }
        };
        let points = [1e3, 1e4, 1e5, 1e6, 1e7].map(|n| (n, time(n)));
        let exponent = |points: &[(f64, f64)]| {
            let slope = Slope::fit(points.iter().copied()).expect("a line");
            (slope.exponent, slope.standard_error.expect("three points"))
        };
        let (small, large, all) = (
            exponent(&points[..3]),
            exponent(&points[2..]),
            exponent(&points),
        );
        assert!((small.0 - 1.0).abs() < 1e-9 && small.1 < 1e-7, "{small:?}");
        assert!((large.0 - 1.5).abs() < 1e-9 && large.1 < 1e-7, "{large:?}");
        assert!(1.1 < all.0 && all.0 < 1.4 && all.1 > 0.02, "{all:?}");
    }

    /// The textbook line has slope 0.6. The sum of squared residuals is 2.4 and the spread is 10,
    /// so the error is √(2.4 / 3 / 10).
    #[test]
    fn the_standard_error_agrees_with_the_textbook() {
        let points = [(1.0, 2.0), (2.0, 4.0), (3.0, 5.0), (4.0, 4.0), (5.0, 5.0)];
        let slope =
            Slope::fit(points.map(|(x, y): (f64, f64)| (x.exp(), y.exp()))).expect("a line");
        assert!((slope.exponent - 0.6).abs() < 1e-12);
        assert!((slope.standard_error.expect("five") - 0.08_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn too_few_points_give_no_slope_or_no_error() {
        assert_eq!(Slope::fit([]), None);
        assert_eq!(Slope::fit([(5.0, 1.0)]), None);
        assert_eq!(Slope::fit([(5.0, 1.0), (5.0, 2.0)]), None);
        let two =
            Slope::fit([(1.0, 1.0), (10.0, 100.0), (0.0, 3.0), (7.0, f64::NAN)]).expect("two");
        assert!((two.exponent - 2.0).abs() < 1e-12);
        assert_eq!((two.standard_error, two.sizes), (None, 2));
    }
}

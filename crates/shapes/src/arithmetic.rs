//! Sine, cosine and exponential function, computed with + − × ÷ only.
//!
//! The trigonometric functions of different platforms differ in the last bits, but IEEE arithmetic
//! is the same on every platform. So a shape has the same coordinates on every machine.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, LN_2, LOG2_E};

/// Returns cosine and sine of `k / n` of a full turn; exact at quarter turns. `n` must not be 0.
///
/// Integer arithmetic reduces the turn to one of eight mirrored octants. So mirrored points have
/// the same bits, except for sign and order.
pub(crate) fn unit_circle(k: usize, n: usize) -> [f64; 2] {
    let eighths = 8 * (k % n);
    let (octant, rest) = (eighths / n, eighths % n);
    let part = if octant % 2 == 0 { rest } else { n - rest };
    let [c, s] = match part == n {
        true => [FRAC_1_SQRT_2; 2],
        false => small_angle(FRAC_PI_4 * (part as f64 / n as f64)),
    };
    match octant {
        0 => [c, s],
        1 => [s, c],
        2 => [-s, c],
        3 => [-c, s],
        4 => [-c, -s],
        5 => [-s, -c],
        6 => [s, -c],
        _ => [c, -s],
    }
}

/// Returns cosine and sine of an angle of at most π/4.
fn small_angle(angle: f64) -> [f64; 2] {
    let square = angle * angle;
    let (mut cosine, mut sine) = (1.0, 1.0);
    for i in (1..=10).rev() {
        let i = f64::from(2 * i);
        cosine = 1.0 - cosine * square / (i * (i - 1.0));
        sine = 1.0 - sine * square / (i * (i + 1.0));
    }
    [cosine, sine * angle]
}

/// Returns exp(−`x`) for `x` ≥ 0, or 0 for `x` above 700.
pub(crate) fn exp_minus(x: f64) -> f64 {
    if x > 700.0 {
        return 0.0;
    }
    let halvings = (x * LOG2_E).round();
    let rest = halvings * LN_2 - x;
    let mut power = 1.0;
    for i in (1..=14).rev() {
        power = 1.0 + power * rest / f64::from(i);
    }
    // The exponent bits of 2^−halvings; 700 · log2 e is below 1023.
    power * f64::from_bits((1023 - halvings as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_agrees_with_the_platform_and_is_exact_at_the_quarters() {
        assert_eq!(unit_circle(0, 7), [1.0, 0.0]);
        assert_eq!(unit_circle(1, 4), [0.0, 1.0]);
        assert_eq!(unit_circle(9, 3), [1.0, 0.0]);
        for n in 1..100 {
            for k in 0..2 * n {
                let [c, s] = unit_circle(k, n);
                let angle = std::f64::consts::TAU * k as f64 / n as f64;
                assert!((c - angle.cos()).abs() < 4e-15, "cos of {k}/{n}");
                assert!((s - angle.sin()).abs() < 4e-15, "sin of {k}/{n}");
                let [mirrored, opposite] = unit_circle(2 * n - k, n);
                assert_eq!([c, s], [mirrored, -opposite], "{k}/{n}");
            }
        }
    }

    #[test]
    fn neighbours_differ_on_the_finest_circle() {
        let n = crate::error::MAX_SEGMENTS;
        let point = |k| unit_circle(k, n).map(|x| x as f32);
        for k in 0..n {
            assert_ne!(point(k), point(k + 1), "{k}/{n}");
        }
    }

    #[test]
    fn the_exponential_agrees_with_the_platform() {
        for i in 0..=7000 {
            let x = f64::from(i) / 10.0;
            let relative = exp_minus(x) / (-x).exp() - 1.0;
            assert!(relative.abs() < 1e-13, "exp(-{x}) is off by {relative}");
        }
        assert_eq!(exp_minus(701.0), 0.0);
        assert_eq!(exp_minus(f64::INFINITY), 0.0);
    }
}

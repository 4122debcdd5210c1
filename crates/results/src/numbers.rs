//! Formats numbers, sizes and times for display.

/// Formats a number with thousands separators: `1,234,567`.
pub fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Rounds a number to three significant digits: the digits that [`figure`] shows.
pub fn rounded(number: f64) -> f64 {
    to_three_digits(number, f64::round)
}

/// Rounds a lower bound down to three significant digits.
pub fn rounded_down(bound: f64) -> f64 {
    to_three_digits(bound, f64::floor)
}

fn to_three_digits(number: f64, to_whole: fn(f64) -> f64) -> f64 {
    if number == 0.0 || !number.is_finite() {
        return number;
    }
    let unit = 10_f64.powi(number.abs().log10().floor() as i32 - 2);
    // 99.96 becomes 100.0, and has then one digit fewer after the point. The quotient of 15.9 and 12.0
    // is 1.325 on paper, but a little less in binary.
    let digits = to_whole(number / unit + 1e-9);
    match unit < 1.0 {
        true => digits / unit.recip().round(),
        false => digits * unit,
    }
}

/// Returns the quotient of two times as they are shown: a reader who divides the shown times gets
/// this ratio.
pub fn shown_ratio(time: f64, other: f64) -> f64 {
    rounded(time) / rounded(other)
}

/// Formats a number with three significant digits: `0.0412`, `0.412`, `4.12`, `41.2`, `412`,
/// `41,200`.
pub fn figure(number: f64) -> String {
    let rounded = rounded(number);
    match rounded {
        n if !n.is_finite() => "–".into(),
        0.0 => "0".into(),
        n if n < 1.0 => {
            let zeros = -(n.abs().log10().floor() as i32 + 1);
            format!("{n:.*}", (zeros + 3).max(0) as usize)
        }
        n if n < 10.0 => format!("{n:.2}"),
        n if n < 100.0 => format!("{n:.1}"),
        n => grouped(n as usize),
    }
}

/// Formats a count that is only roughly known, with two significant digits: `7`, `480`, `72,000`.
pub fn approximate(number: f64) -> String {
    let digits = number.abs().max(1.0).log10().floor() as i32;
    let unit = 10_f64.powi((digits - 1).max(0));
    grouped(((number / unit).round() * unit) as usize)
}

/// Formats a number with a noun in the singular or plural: `1 edge`, `3 edges`.
pub fn counted(number: usize, singular: &str, plural: &str) -> String {
    let word = if number == 1 { singular } else { plural };
    format!("{} {word}", grouped(number))
}

/// Joins names: `a`, `a and b`, `a, b and c`.
pub fn list<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> String {
    let names: Vec<N> = names.into_iter().collect();
    let Some((last, first)) = names.split_last() else {
        return String::new();
    };
    let first: Vec<&str> = first.iter().map(AsRef::as_ref).collect();
    match first.is_empty() {
        true => last.as_ref().to_owned(),
        false => format!("{} and {}", first.join(", "), last.as_ref()),
    }
}

/// Formats a number of bytes with a suitable decimal unit, such as `1.50 kB` (1 kB = 1,000 bytes).
pub fn bytes(number: usize) -> String {
    match rounded(number as f64) {
        _ if number < 1000 => counted(number, "byte", "bytes"),
        n if n < 1e6 => format!("{} kB", figure(n / 1e3)),
        n if n < 1e9 => format!("{} MB", figure(n / 1e6)),
        n => format!("{} GB", figure(n / 1e9)),
    }
}

/// Formats a time in nanoseconds with a suitable unit, such as `2.34 ms`.
pub fn duration(ns: f64) -> String {
    match rounded(ns) {
        ns if ns < 1e3 => format!("{} ns", figure(ns)),
        ns if ns < 1e6 => format!("{} µs", figure(ns / 1e3)),
        ns if ns < 1e9 => format!("{} ms", figure(ns / 1e6)),
        ns => format!("{} s", figure(ns / 1e9)),
    }
}

/// Formats a ratio with a multiplication sign: `1.04 ×`, `12.3 ×`, `2,100 ×`.
pub fn times(ratio: f64) -> String {
    format!("{} ×", figure(ratio))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_separated() {
        let numbers = [0, 12, 123, 1234, 123_456, 1_234_567].map(grouped);
        assert_eq!(numbers, ["0", "12", "123", "1,234", "123,456", "1,234,567"]);
    }

    #[test]
    fn three_digits_are_significant() {
        let shown = [
            (0.0, "0"),
            (0.000_051_26, "0.0000513"),
            (0.05, "0.0500"),
            (0.0999_96, "0.100"),
            (0.9994, "0.999"),
            (0.9996, "1.00"),
            (9.994, "9.99"),
            (9.996, "10.0"),
            (99.94, "99.9"),
            (99.96, "100"),
            (999.6, "1,000"),
            (41_234.5, "41,200"),
            (1_239_999.0, "1,240,000"),
            (f64::NAN, "–"),
            (f64::INFINITY, "–"),
        ];
        for (number, expected) in shown {
            assert_eq!(figure(number), expected, "{number}");
        }
        assert_eq!(figure(rounded_down(139.9)), "139");
        assert_eq!(figure(rounded_down(0.0419)), "0.0419");
        assert_eq!(rounded_down(0.0), 0.0);
        assert_eq!(duration(2_340_000.0), "2.34 ms");
        assert_eq!(duration(999.7), "1.00 µs");
        assert_eq!(bytes(999_700), "1.00 MB");
        assert_eq!(times(18_130.0), "18,100 ×");
        let rough = [0.4, 7.2, 71.6, 99.6, 484.0, 71_781.0, 9_960.0].map(approximate);
        assert_eq!(rough, ["0", "7", "72", "100", "480", "72,000", "10,000"]);
    }

    #[test]
    fn the_quotient_of_shown_times_is_the_shown_ratio() {
        for (a, b) in [
            (205.4, 123.5),
            (1.2345e6, 7.7777),
            (0.0417, 0.3333),
            (3.0, 3.0),
            (15.9, 12.0),
        ] {
            let parsed = |text: String| text.replace(',', "").parse::<f64>().expect("a number");
            let [a_shown, b_shown] = [a, b].map(|time| parsed(figure(time)));
            assert_eq!([a_shown, b_shown], [a, b].map(rounded));
            assert_eq!(figure(shown_ratio(a, b)), figure(a_shown / b_shown));
        }
        assert_eq!(figure(shown_ratio(15.9, 12.0)), "1.33", "as on paper");
    }
}

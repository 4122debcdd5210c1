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

/// Formats a number with three digits, or as a whole number if the number is 100 or larger:
/// `0.412`, `4.12`, `41.2`, `412`, `41,235`.
pub fn figure(number: f64) -> String {
    match number {
        n if !n.is_finite() => "–".into(),
        n if n < 0.9995 => format!("{n:.3}"),
        n if n < 9.995 => format!("{n:.2}"),
        n if n < 99.95 => format!("{n:.1}"),
        n => grouped(n.round() as usize),
    }
}

/// Formats a number with a noun in the singular or plural: `1 edge`, `3 edges`.
pub fn counted(number: usize, singular: &str, plural: &str) -> String {
    let word = if number == 1 { singular } else { plural };
    format!("{} {word}", grouped(number))
}

/// Joins names: `a`, `a and b`, `a, b and c`.
pub(crate) fn list<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> String {
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
    match number as f64 {
        n if n < 1e3 => counted(number, "byte", "bytes"),
        n if n < 1e6 => format!("{} kB", figure(n / 1e3)),
        n if n < 1e9 => format!("{} MB", figure(n / 1e6)),
        n => format!("{} GB", figure(n / 1e9)),
    }
}

/// Formats a time in nanoseconds with a suitable unit, such as `2.34 ms`.
pub fn duration(ns: f64) -> String {
    match ns {
        ns if ns < 1e3 => format!("{} ns", figure(ns)),
        ns if ns < 1e6 => format!("{} µs", figure(ns / 1e3)),
        ns if ns < 1e9 => format!("{} ms", figure(ns / 1e6)),
        ns => format!("{} s", figure(ns / 1e9)),
    }
}

/// Formats a ratio with a multiplication sign: `1.4 ×`, `2,100 ×`.
pub fn times(ratio: f64) -> String {
    match ratio {
        r if r < 1.095 => format!("{r:.2} ×"),
        r if r < 9.95 => format!("{r:.1} ×"),
        r => format!("{} ×", grouped(r.round() as usize)),
    }
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
        let figures = [
            0.0, 0.05, 0.9994, 0.9996, 9.994, 9.996, 99.94, 99.96, 41234.5,
        ]
        .map(figure);
        let expected = [
            "0.000", "0.050", "0.999", "1.00", "9.99", "10.0", "99.9", "100", "41,235",
        ];
        assert_eq!(figures, expected);
        assert_eq!(duration(2_340_000.0), "2.34 ms");
    }
}

//! Text of somebody else: names of files, words of other programs.

/// `text` on one line, without the characters that steer a terminal or turn the direction of writing:
/// escapes stand for them, `\u{1b}`.
pub fn tame(text: &str) -> String {
    let steers = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let mut tamed = String::with_capacity(text.len());
    for c in text.chars() {
        match steers(c) {
            true => tamed.extend(c.escape_default()),
            false => tamed.push(c),
        }
    }
    tamed
}

#[cfg(test)]
mod tests {
    use super::tame;

    #[test]
    fn what_steers_a_terminal_is_escaped() {
        assert_eq!(tame("a\u{1b}[2Jb\nc\u{202e}"), "a\\u{1b}[2Jb\\nc\\u{202e}");
        assert_eq!(tame("Hügel – 山.obj"), "Hügel – 山.obj");
    }
}

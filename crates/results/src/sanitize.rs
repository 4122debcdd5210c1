//! Makes text from outside safe to print.

/// Returns `text` on one line. Replaces characters that control a terminal or change the writing
/// direction by escapes such as `\u{1b}`.
pub fn sanitize(text: &str) -> String {
    let is_unsafe = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match is_unsafe(c) {
            true => safe.extend(c.escape_default()),
            false => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::sanitize;

    #[test]
    fn terminal_control_characters_are_escaped() {
        assert_eq!(
            sanitize("a\u{1b}[2Jb\nc\u{202e}"),
            "a\\u{1b}[2Jb\\nc\\u{202e}"
        );
        assert_eq!(sanitize("Hügel – 山.obj"), "Hügel – 山.obj");
    }
}

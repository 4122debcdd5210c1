//! Words of a shell.

use std::path::Path;

use sixfold_results::sanitize;

/// Returns a path as a word of a command that users can copy into a shell: with quotes if it needs
/// them, and with `./` if it begins like an option.
pub(crate) fn shell_word(path: &Path) -> String {
    let shown = path.display().to_string();
    let word = match shown.starts_with('-') && shown != "-" {
        true => format!("./{shown}"),
        false => shown,
    };
    match shlex::try_quote(&word) {
        Ok(quoted) => sanitize(&quoted),
        Err(_) => sanitize(&word),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_words_of_a_shell() {
        for (path, word) in [
            ("a.obj", "a.obj"),
            ("-", "-"),
            ("-dash.obj", "./-dash.obj"),
            ("my part.obj", "'my part.obj'"),
            ("- a.obj", "'./- a.obj'"),
        ] {
            assert_eq!(shell_word(Path::new(path)), word);
        }
    }
}

//! The error message for an unknown name.

use strsim::jaro_winkler;

/// Minimum Jaro–Winkler similarity of a suggested name to the unknown name.
const MIN_SIMILARITY: f64 = 0.8;

/// Returns a message such as “no operation is called `boundry` (did you mean `boundary`?): choose
/// from …”.
pub fn unknown(kind: &str, name: &str, known: &[&str]) -> String {
    let alike = |other: &&&str| jaro_winkler(name, other);
    let nearest = known.iter().max_by(|a, b| alike(a).total_cmp(&alike(b)));
    let meant = match nearest.filter(|other| alike(other) > MIN_SIMILARITY) {
        Some(other) => format!(" (did you mean `{other}`?)"),
        None => String::new(),
    };
    let known = known.join(", ");
    format!("no {kind} is called `{name}`{meant}: choose from {known}")
}

#[cfg(test)]
mod tests {
    use super::unknown;

    #[test]
    fn similar_names_are_suggested_and_other_names_are_not() {
        let known = ["vertex_faces", "boundary", "build"];
        let message = |name: &str| unknown("operation", name, &known);
        assert_eq!(
            message("boundry"),
            "no operation is called `boundry` (did you mean `boundary`?): choose from \
             vertex_faces, boundary, build"
        );
        assert!(message("vertex-faces").contains("did you mean `vertex_faces`?"));
        assert!(message("zebra").starts_with("no operation is called `zebra`: choose from"));
    }
}

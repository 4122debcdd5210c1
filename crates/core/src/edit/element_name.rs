//! Names of the elements of a mesh: `v3`, `v0-v1` and `f2`.

use std::fmt;
use std::str::FromStr;

/// The name of an element. The numbers are those of the mesh file, from 0; elements that edits make have
/// the next numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementName {
    /// A vertex: `v3`.
    Vertex(u32),
    /// An edge, by its ends: `v0-v1`.
    Edge([u32; 2]),
    /// A face: `f2`.
    Face(u32),
}

/// The error for a text that is not the name of an element.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` names no element: write v3 for a vertex, v0-v1 for an edge, f2 for a face")]
#[non_exhaustive]
pub struct NoElementName {
    /// The text.
    pub text: String,
}

impl ElementName {
    /// Returns `vertex`, `edge` or `face`.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Vertex(_) => "vertex",
            Self::Edge(_) => "edge",
            Self::Face(_) => "face",
        }
    }
}

impl fmt::Display for ElementName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => write!(f, "v{v}"),
            Self::Edge([a, b]) => write!(f, "v{a}-v{b}"),
            Self::Face(face) => write!(f, "f{face}"),
        }
    }
}

impl FromStr for ElementName {
    type Err = NoElementName;

    fn from_str(text: &str) -> Result<Self, NoElementName> {
        let number = |text: &str, letter| text.strip_prefix(letter)?.parse().ok();
        let edge = || {
            let (a, b) = text.split_once('-')?;
            Some(Self::Edge([number(a, 'v')?, number(b, 'v')?]))
        };
        let vertex = || number(text, 'v').map(Self::Vertex);
        let face = || number(text, 'f').map(Self::Face);
        let element = vertex().or_else(face).or_else(edge);
        element.ok_or_else(|| NoElementName { text: text.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for text in ["v0", "v12", "f3", "v1-v0", "v4294967295"] {
            let name: ElementName = text.parse().expect("a name");
            assert_eq!(name.to_string(), text);
        }
        for text in [
            "",
            "v",
            "3",
            "e4",
            "v-1",
            "v1-",
            "v1-f2",
            "v1-v2-v3",
            "v4294967296",
            "f1-f2",
        ] {
            let error = text.parse::<ElementName>().expect_err(text);
            assert!(error.to_string().contains("v0-v1"), "{error}");
        }
    }
}

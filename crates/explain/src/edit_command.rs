//! Edits as text: `flip_edge v0-v1`.

use std::fmt;
use std::str::FromStr;

use sixfold::{Edit, Point};
use sixfold_core::ElementName;

use crate::error::ExplainError;

/// An edit, with its arguments by name. Without a position, an edit that needs one takes the middle of
/// the edge, of the face, or, for `split_vertex`, of the vertex and its neighbours `left` and `right`.
///
/// As text, the arguments are separated by spaces, and a position is written `0.5,1,0`:
///
/// | edit | arguments |
/// |---|---|
/// | `set_position` | vertex, position |
/// | `add_vertex` | position |
/// | `add_face` | three or more vertices |
/// | `remove_face`, `poke_face` | face, and for `poke_face` a position |
/// | `remove_vertex` | vertex |
/// | `remove_isolated_vertices`, `compact` | none |
/// | `split_edge`, `bisect_edge` | edge, position |
/// | `split_face` | face, two of its vertices |
/// | `dissolve_edge`, `flip_edge` | edge |
/// | `collapse_edge` | edge, the end that stays, position |
/// | `split_vertex` | vertex, left vertex, right vertex (`none` at a boundary), position |
#[derive(Clone, Debug, PartialEq)]
pub struct EditCommand {
    /// The kind of the edit.
    pub edit: Edit,
    /// The elements, in the order of the table; `None` for `none`.
    pub elements: Vec<Option<ElementName>>,
    /// The position.
    pub at: Option<Point>,
}

impl fmt::Display for EditCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.edit)?;
        for element in &self.elements {
            match element {
                Some(element) => write!(f, " {element}")?,
                None => f.write_str(" none")?,
            }
        }
        match self.at {
            Some(Point { x, y, z }) => write!(f, " {x},{y},{z}"),
            None => Ok(()),
        }
    }
}

/// What an edit takes: its elements (`v`, `e`, `f`, or `n` for a vertex or `none`; `*` for more of the
/// last), and whether a position follows.
fn parameters(edit: Edit) -> (&'static str, bool) {
    match edit {
        Edit::SetPosition => ("v", true),
        Edit::AddVertex => ("", true),
        Edit::AddFace => ("vvv*", false),
        Edit::RemoveFace => ("f", false),
        Edit::RemoveVertex => ("v", false),
        Edit::RemoveIsolatedVertices | Edit::Compact => ("", false),
        Edit::SplitEdge | Edit::BisectEdge => ("e", true),
        Edit::PokeFace => ("f", true),
        Edit::SplitFace => ("fvv", false),
        Edit::DissolveEdge | Edit::FlipEdge => ("e", false),
        Edit::CollapseEdge => ("ev", true),
        Edit::SplitVertex => ("vnn", true),
    }
}

impl FromStr for EditCommand {
    type Err = ExplainError;

    fn from_str(text: &str) -> Result<Self, ExplainError> {
        let mut words = text.split_whitespace();
        let name = words.next().unwrap_or_default();
        let edit: Edit = name.parse().map_err(|error| ExplainError::BadEdit {
            reason: format!("{error}"),
        })?;
        let mut elements = Vec::new();
        let mut at = None;
        for word in words {
            match word.contains(',') {
                true => at = Some(position(word)?),
                false if word == "none" => elements.push(None),
                false => elements.push(Some(word.parse()?)),
            }
        }
        let command = Self { edit, elements, at };
        command.check().map(|()| command)
    }
}

impl EditCommand {
    /// Returns whether both edits always do the same. Unlike with `==`, the position 0 is not that of -0.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let bits = |edit: &Self| edit.at.map(|at| at.to_array().map(f32::to_bits));
        self == other && bits(self) == bits(other)
    }

    /// Checks that the edit has the elements and the position that its kind takes.
    pub(crate) fn check(&self) -> Result<(), ExplainError> {
        let (letters, takes_position) = parameters(self.edit);
        let needs_position = matches!(self.edit, Edit::SetPosition | Edit::AddVertex);
        let position_fits = match self.at {
            Some(_) => takes_position,
            None => !needs_position,
        };
        match self.fits(letters) && position_fits {
            true => Ok(()),
            false => Err(ExplainError::BadEdit {
                reason: format!("`{self}`: write {}", example(self.edit)),
            }),
        }
    }

    /// Returns whether the elements are of the kinds that `letters` name.
    fn fits(&self, letters: &str) -> bool {
        let (letters, more) = match letters.strip_suffix('*') {
            Some(letters) => (letters, true),
            None => (letters, false),
        };
        let kinds = letters
            .chars()
            .chain(letters.chars().last().into_iter().cycle());
        let fits = |(element, kind): (&Option<ElementName>, char)| match element {
            None => kind == 'n',
            Some(ElementName::Vertex(_)) => kind == 'v' || kind == 'n',
            Some(ElementName::Edge(_)) => kind == 'e',
            Some(ElementName::Face(_)) => kind == 'f',
        };
        let (count, wanted) = (self.elements.len(), letters.len());
        let counts = count == wanted || (more && count > wanted);
        counts && self.elements.iter().zip(kinds).all(fits)
    }
}

/// Returns an edit as it is written.
fn example(edit: Edit) -> &'static str {
    match edit {
        Edit::SetPosition => "set_position v0 0.5,1,0",
        Edit::AddVertex => "add_vertex 0.5,1,0",
        Edit::AddFace => "add_face v0 v1 v2",
        Edit::RemoveFace => "remove_face f0",
        Edit::RemoveVertex => "remove_vertex v0",
        Edit::RemoveIsolatedVertices => "remove_isolated_vertices",
        Edit::SplitEdge => "split_edge v0-v1, or split_edge v0-v1 0.5,1,0",
        Edit::BisectEdge => "bisect_edge v0-v1, or bisect_edge v0-v1 0.5,1,0",
        Edit::PokeFace => "poke_face f0, or poke_face f0 0.5,1,0",
        Edit::SplitFace => "split_face f0 v0 v2",
        Edit::DissolveEdge => "dissolve_edge v0-v1",
        Edit::FlipEdge => "flip_edge v0-v1",
        Edit::CollapseEdge => "collapse_edge v0-v1 v0, or collapse_edge v0-v1 v0 0.5,1,0",
        Edit::SplitVertex => "split_vertex v0 v1 v2, or split_vertex v0 v1 none 0.5,1,0",
        Edit::Compact => "compact",
    }
}

/// Parses `0.5,1,0`.
fn position(text: &str) -> Result<Point, ExplainError> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => {
            Ok(Point::new(x, y, z))
        }
        _ => Err(ExplainError::BadEdit {
            reason: format!("`{text}` is no position: write 0.5,1,0"),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_read_and_written() {
        for edit in Edit::ALL {
            let examples = example(edit).split(", or ");
            for text in examples {
                let command: EditCommand = text.parse().expect(text);
                assert_eq!(command.edit, edit);
                assert_eq!(command.to_string(), text);
            }
        }
        let corners: EditCommand = "add_face v0 v1 v2 v3 v4".parse().expect("five corners");
        assert_eq!(corners.elements.len(), 5);
    }

    #[test]
    fn each_wrong_edit_says_what_to_write() {
        for text in [
            "",
            "flip",
            "flip_edge",
            "flip_edge v0",
            "flip_edge v0-v1 v1",
            "flip_edge v0-v1 0,0,0",
            "add_face v0 v1",
            "add_face v0 v1 none",
            "add_vertex",
            "add_vertex 0,0",
            "add_vertex 0,0,nan",
            "set_position v0",
            "collapse_edge v0-v1 f0",
            "split_vertex v0 v1",
            "compact v0",
            "split_face f0 v0 v1 v2",
        ] {
            let error = text.parse::<EditCommand>().expect_err(text).to_string();
            assert!(
                error.contains("write") || error.contains("choose"),
                "{text}: {error}"
            );
        }
    }
}

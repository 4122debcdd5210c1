//! Edits of elements that are identified by their numbers in the model.

use sixfold_core::{EditArgument, EditCall, Point};

/// An edit, and the elements to which it applies. Vertices and faces are given by their numbers in
/// the [`Model`](super::Model), and edges by the numbers of their two ends.
pub type Action = EditCall<usize, [usize; 2], usize>;

/// Returns the position among the arguments of an action.
pub(super) fn position(action: &Action) -> Option<Point> {
    action.find_argument(|argument| match argument {
        EditArgument::Position(&at) | EditArgument::NewPosition(&at) => Some(at),
        _ => None,
    })
}

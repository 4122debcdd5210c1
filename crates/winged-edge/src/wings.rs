//! Two wings in one word: the edges along the left and the right side of an edge.

use std::fmt;
use std::hint::select_unpredictable;

use sixfold_core::{EdgeId, RowId};

/// One of the two sides of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Side {
    right: bool,
}

impl Side {
    pub(crate) const LEFT: Self = Self { right: false };
    pub(crate) const RIGHT: Self = Self { right: true };

    #[inline(always)]
    pub(crate) fn right_if(right: bool) -> Self {
        Self { right }
    }

    #[inline(always)]
    pub(crate) fn is_right(self) -> bool {
        self.right
    }

    /// Returns 0 for left, 1 for right.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        usize::from(self.right)
    }

    #[inline(always)]
    pub(crate) fn other(self) -> Self {
        Self { right: !self.right }
    }
}

/// A left and a right wing in one word. The left wing is in the lower half.
///
/// The next step of a walk waits for the wing, so the selection must be fast. One load reads both
/// wings, while the values for the side test are loaded. The test then selects between two
/// registers. Times of one-ring sweeps over 82,000 triangles, in ns per vertex, in order and
/// shuffled:
///
/// - this word: 11 and 22
/// - two fields, indexed by the side: 13 and 24
/// - two fields and a selection: 16 and 28
/// - a branch: 10 and 36
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wings(u64);

impl Wings {
    /// No wing is linked yet.
    pub(crate) const BLANK: Self = Self(0);

    #[inline(always)]
    pub(crate) fn new([left, right]: [EdgeId; 2]) -> Self {
        Self(u64::from(left.row()) | u64::from(right.row()) << 32)
    }

    #[inline(always)]
    pub(crate) fn on(self, side: Side) -> EdgeId {
        let swapped = self.0.rotate_left(32);
        EdgeId::new(select_unpredictable(side.right, swapped, self.0) as u32)
    }

    /// Returns the left wing and the right wing.
    #[inline(always)]
    pub(crate) fn both(self) -> [EdgeId; 2] {
        [self.on(Side::LEFT), self.on(Side::RIGHT)]
    }

    /// Links a blank side. Takes one instruction; `set` takes four.
    #[inline(always)]
    pub(crate) fn link(&mut self, side: Side, wing: EdgeId) {
        debug_assert_eq!(self.on(side).row(), 0, "the side is already linked");
        self.0 |= u64::from(wing.row()) << (u32::from(side.right) << 5);
    }

    /// Overwrites the wing of a side.
    #[inline(always)]
    pub(crate) fn set(&mut self, side: Side, wing: EdgeId) {
        // After a write of half a word, the next load of the whole word would wait.
        let shift = u32::from(side.right) << 5;
        let other = self.0 & !(u64::from(u32::MAX) << shift);
        self.0 = other | u64::from(wing.row()) << shift;
    }
}

impl fmt::Debug for Wings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.both().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_side_has_its_own_wing() {
        for (left, right) in [(0, 1), (u32::MAX - 1, 0), (7, u32::MAX - 1)] {
            let [left, right] = [left, right].map(EdgeId::new);
            let mut wings = Wings::BLANK;
            wings.link(Side::RIGHT, right);
            assert_eq!(wings.both(), [EdgeId::new(0), right]);
            wings.link(Side::LEFT, left);
            assert_eq!(wings.both(), [left, right]);
            assert_eq!(Wings::new([left, right]), wings);
            let mut swapped = Wings::new([right, left]);
            swapped.set(Side::RIGHT, right);
            swapped.set(Side::LEFT, left);
            assert_eq!(swapped, wings);
            assert_eq!(wings.on(Side::RIGHT.other()), left);
        }
    }
}

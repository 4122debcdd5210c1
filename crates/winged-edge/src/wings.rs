//! Two wings in one word: the edges on the left and on the right of an edge, ahead or behind.

use std::fmt;
use std::hint::select_unpredictable;

use mesh_core::{EdgeId, RowId};

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

    /// 0 for left, 1 for right.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        usize::from(self.right)
    }

    #[inline(always)]
    pub(crate) fn other(self) -> Self {
        Self { right: !self.right }
    }
}

/// A left and a right wing in the two halves of one word, the left in the lower.
///
/// The next step of a walk waits for its wing, so the selection must be quick. One load brings both,
/// at once with what the side test compares, and the test then selects between two registers. Two
/// fields and a selection would read the same in source; but the compiler makes of it a selection
/// between two addresses and a load that waits for it. Ring sweeps over 82,000 triangles, ns a
/// vertex in order and shuffled: this 11 and 22, two fields indexed by the side 13 and 24, two
/// fields and a selection 16 and 28, a branch 10 and 36.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wings(u64);

impl Wings {
    /// Nothing linked on either side.
    pub(crate) const BLANK: Self = Self(0);

    /// The left wing, and the right one.
    #[inline(always)]
    pub(crate) fn of([left, right]: [EdgeId; 2]) -> Self {
        Self(u64::from(left.row()) | u64::from(right.row()) << 32)
    }

    #[inline(always)]
    pub(crate) fn on(self, side: Side) -> EdgeId {
        let turned = self.0.rotate_left(32);
        EdgeId::new(select_unpredictable(side.right, turned, self.0) as u32)
    }

    /// The left one, then the right one.
    #[inline(always)]
    pub(crate) fn both(self) -> [EdgeId; 2] {
        [self.on(Side::LEFT), self.on(Side::RIGHT)]
    }

    /// Links a side that is blank: one instruction, where writing over any value takes four.
    #[inline(always)]
    pub(crate) fn link(&mut self, side: Side, wing: EdgeId) {
        debug_assert_eq!(self.on(side).row(), 0, "the side is linked already");
        self.0 |= u64::from(wing.row()) << (u32::from(side.right) << 5);
    }

    /// Writes over a side, whatever it holds.
    #[inline(always)]
    pub(crate) fn put(&mut self, side: Side, wing: EdgeId) {
        // All in a register: to write the half alone would keep the next load of the whole waiting.
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
    fn each_side_holds_what_it_is_given() {
        for (left, right) in [(0, 1), (u32::MAX - 1, 0), (7, u32::MAX - 1)] {
            let [left, right] = [left, right].map(EdgeId::new);
            let mut wings = Wings::BLANK;
            wings.link(Side::RIGHT, right);
            assert_eq!(wings.both(), [EdgeId::new(0), right]);
            wings.link(Side::LEFT, left);
            assert_eq!(wings.both(), [left, right]);
            assert_eq!(Wings::of([left, right]), wings);
            let mut turned = Wings::of([right, left]);
            turned.put(Side::RIGHT, right);
            turned.put(Side::LEFT, left);
            assert_eq!(turned, wings);
            assert_eq!(wings.on(Side::RIGHT.other()), left);
        }
    }
}

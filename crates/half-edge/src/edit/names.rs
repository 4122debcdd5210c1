//! Names to look others up in.

use mesh_core::{Few, Lookup, RowId};

/// A few names, kept in place, which answer whether another is one of them.
///
/// 64 bits say no for most that are not; only what they let pass is compared. From the 17th name on
/// they go to a sorted list, so that a vertex of valence 100,000 costs O(valence log valence).
pub(super) struct Names<H> {
    filter: u64,
    names: Few<H>,
}

impl<H: RowId> Names<H> {
    #[inline]
    pub(super) fn none() -> Self {
        Self {
            filter: 0,
            names: Few::new(),
        }
    }

    /// Adds `name`; before the first question all must be there, and [`sort`](Self::sort) called.
    #[inline]
    pub(super) fn push(&mut self, name: H) {
        self.filter |= bit(name);
        self.names.push(name);
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// All of them, in no order.
    pub(super) fn iter(&self) -> impl Iterator<Item = &H> {
        self.names.iter()
    }

    #[inline]
    pub(super) fn sort(&mut self) {
        self.names.order();
    }

    #[inline]
    pub(super) fn has(&self, name: H) -> bool {
        self.filter & bit(name) != 0 && self.names.has(name)
    }
}

/// The bit of a name: names that follow each other have different ones.
#[inline]
fn bit<H: RowId>(name: H) -> u64 {
    1 << (name.row().wrapping_mul(0x9e37_79b9) >> 26)
}

#[cfg(test)]
mod tests {
    use mesh_core::VertexId;

    use super::*;

    #[test]
    fn what_was_pushed_is_found_however_many() {
        for len in [0, 1, 15, 16, 17, 40, 300] {
            let mut names = Names::none();
            for i in (0..len).rev() {
                names.push(VertexId::new(3 * i));
            }
            names.sort();
            for v in 0..3 * len + 3 {
                let is_one = v % 3 == 0 && v < 3 * len;
                assert_eq!(names.has(VertexId::new(v)), is_one, "v{v} among {len}");
            }
        }
    }
}

//! A set of handles for lookups.

use sixfold_core::{Few, Lookup, RowId};

/// A set of handles, stored in place while it is small.
///
/// A filter of 64 bits rejects most handles that are not in the set; only the others are compared.
/// From the 17th handle on, the handles are in a sorted list, so that a vertex of valence 100,000
/// costs O(valence log valence).
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

    /// Adds `name`. After the last one, call [`sort`](Self::sort) before the first
    /// [`has`](Self::has).
    #[inline]
    pub(super) fn push(&mut self, name: H) {
        self.filter |= bit(name);
        self.names.push(name);
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Iterates over the handles, in no particular order.
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

/// Returns the filter bit of a handle; consecutive handles have different bits.
#[inline]
fn bit<H: RowId>(name: H) -> u64 {
    1 << (name.row().wrapping_mul(0x9e37_79b9) >> 26)
}

#[cfg(test)]
mod tests {
    use sixfold_core::VertexId;

    use super::*;

    #[test]
    fn pushed_handles_are_found_at_every_length() {
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

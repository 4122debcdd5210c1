//! A set of handles for lookups.

use sixfold_core::{Lookup, RowId, ShortVec};

/// A set of handles, stored in place while it is small.
///
/// A filter of 64 bits rejects most handles that are not in the set. More than 16 handles are
/// stored in a sorted list, so a vertex of valence n costs O(n log n).
pub(super) struct HandleSet<H> {
    filter: u64,
    handles: ShortVec<H>,
}

impl<H: RowId> HandleSet<H> {
    #[inline]
    pub(super) fn new() -> Self {
        Self {
            filter: 0,
            handles: ShortVec::new(),
        }
    }

    /// Adds `handle`. Call [`sort`](Self::sort) after the last `push` and before the first
    /// [`contains`](Self::contains).
    #[inline]
    pub(super) fn push(&mut self, handle: H) {
        self.filter |= bit(handle);
        self.handles.push(handle);
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.handles.is_empty()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &H> {
        self.handles.iter()
    }

    #[inline]
    pub(super) fn sort(&mut self) {
        self.handles.sort_for_lookup();
    }

    #[inline]
    pub(super) fn contains(&self, handle: H) -> bool {
        self.filter & bit(handle) != 0 && self.handles.has(handle)
    }
}

/// Returns the filter bit of a handle.
#[inline]
fn bit<H: RowId>(handle: H) -> u64 {
    1 << (handle.row().wrapping_mul(0x9e37_79b9) >> 26)
}

#[cfg(test)]
mod tests {
    use sixfold_core::VertexId;

    use super::*;

    #[test]
    fn pushed_handles_are_found_at_every_length() {
        for len in [0, 1, 15, 16, 17, 40, 300] {
            let mut set = HandleSet::new();
            for i in (0..len).rev() {
                set.push(VertexId::new(3 * i));
            }
            set.sort();
            for v in 0..3 * len + 3 {
                let is_member = v % 3 == 0 && v < 3 * len;
                assert_eq!(
                    set.contains(VertexId::new(v)),
                    is_member,
                    "v{v} among {len}"
                );
            }
        }
    }
}

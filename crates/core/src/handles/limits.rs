//! The maximum numbers of elements. Handles have 32 bits, and some tables use a part of these bits.

use crate::handles::row_id::MAX_ROWS;

/// Maximum number of corners of a structure that pairs the two sides of each edge: half-edge,
/// winged-edge and corner table. The number of a corner and one bit for a direction share 32 bits.
pub const MAX_CORNERS: usize = MAX_ROWS / 2;

/// Maximum number of edges of these structures. The number of an edge and two bits for the
/// directions share 32 bits.
pub const MAX_EDGES: usize = MAX_ROWS / 4;

/// Returns `limit`, or a lower limit within `with_lower_limits`. Structures check the numbers of
/// elements of builds, refinements and edits with this function; polygon meshes do not.
#[inline(always)]
pub(crate) fn current(limit: usize) -> usize {
    #[cfg(feature = "lower-limits")]
    let limit = lower::scaled(limit);
    limit
}

#[cfg(feature = "lower-limits")]
pub use lower::with_lower_limits;

#[cfg(feature = "lower-limits")]
mod lower {
    use std::cell::Cell;

    use super::MAX_ROWS;

    thread_local! {
        static ROWS: Cell<usize> = const { Cell::new(MAX_ROWS) };
    }

    /// For tests: calls `run`. On this thread and during the call, builds, refinements and edits
    /// allow only `rows` rows instead of [`MAX_ROWS`], and all other limits on the number of
    /// elements shrink in proportion.
    ///
    /// A test can thus reach these limits with a small mesh. The crate must be compiled with the
    /// feature `lower-limits`.
    pub fn with_lower_limits<T>(rows: usize, run: impl FnOnce() -> T) -> T {
        /// Restores the limits, also if `run` panics.
        struct Restore(usize);
        impl Drop for Restore {
            fn drop(&mut self) {
                ROWS.set(self.0);
            }
        }
        let _restore = Restore(ROWS.replace(rows));
        run()
    }

    pub(super) fn scaled(limit: usize) -> usize {
        match ROWS.get() {
            MAX_ROWS => limit,
            rows => (limit as u128 * rows as u128 / MAX_ROWS as u128) as usize,
        }
    }
}

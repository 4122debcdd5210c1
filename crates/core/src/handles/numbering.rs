//! Numbers of elements, for matrices and index buffers.

use std::fmt;
use std::ops::Index;

use crate::handles::handle::{Handle, HandleMap};
use crate::handles::row_id::row;

/// The entry of a handle without a number. No element has this number.
const NO_NUMBER: u32 = u32::MAX;

/// Elements of one kind, numbered from 0 without gaps.
///
/// Matrices and index buffers need numbers from 0 without gaps. A handle may be coordinates, a pair
/// of vertices, or a row of a table with gaps (rows of deleted elements).
/// [`MeshQuery::vertex_numbers`], [`edge_numbers`] and [`face_numbers`] number all elements in the
/// order in which the mesh lists them. [`Numbers::new`] numbers a selection of elements, for
/// example only the free vertices of a system with a fixed boundary.
///
/// An edit of the mesh does not update the numbers. The numbers are valid until the next edit.
///
/// [`MeshQuery::vertex_numbers`]: crate::MeshQuery::vertex_numbers
/// [`edge_numbers`]: crate::MeshQuery::edge_numbers
/// [`face_numbers`]: crate::MeshQuery::face_numbers
///
/// # Examples
///
/// ```
/// use sixfold_core::MeshQuery;
///
/// /// Returns the row and the column of every non-zero entry of the adjacency matrix.
/// fn entries<M: MeshQuery>(mesh: &M) -> Vec<[u32; 2]> {
///     let numbers = mesh.vertex_numbers();
///     let ends = mesh.edges().map(|e| mesh.edge_vertices(e).map(|v| numbers[v]));
///     ends.flat_map(|[a, b]| [[a, b], [b, a]]).collect()
/// }
/// ```
#[derive(Clone)]
pub struct Numbers<H: Handle> {
    handles: Vec<H>,
    numbers: H::Map<u32>,
}

impl<H: Handle> Numbers<H> {
    /// Numbers `handles` in their order; each handle must occur once. If handles are rows, `rows`
    /// must be larger than every row; for example, pass [`MeshQuery::vertex_rows`]. O(rows +
    /// handles) expected.
    ///
    /// ```
    /// use sixfold_core::{MeshQuery, Numbers};
    ///
    /// /// Numbers the vertices that are not on the boundary.
    /// fn inner<M: MeshQuery>(mesh: &M) -> Numbers<M::Vertex> {
    ///     let vertices = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v));
    ///     Numbers::new(mesh.vertex_rows(), vertices)
    /// }
    /// ```
    ///
    /// # Panics
    ///
    /// Panics if there are more handles than [`MAX_ROWS`](crate::MAX_ROWS), or if a handle is a row
    /// that is not below `rows`.
    ///
    /// [`MeshQuery::vertex_rows`]: crate::MeshQuery::vertex_rows
    pub fn new(rows: usize, handles: impl Iterator<Item = H>) -> Self {
        let handles: Vec<H> = handles.collect();
        let mut numbers: H::Map<u32> = HandleMap::filled(rows, NO_NUMBER);
        numbers.reserve(handles.len());
        for (number, &handle) in handles.iter().enumerate() {
            numbers[handle] = row(number);
        }
        Self { handles, numbers }
    }

    /// Returns how many elements are numbered; O(1).
    pub fn len(&self) -> usize {
        self.handles.len()
    }

    /// Returns true if no element is numbered; O(1).
    pub fn is_empty(&self) -> bool {
        self.handles.is_empty()
    }

    /// Returns the number of `handle`, or `None` if `handle` has no number; O(1) expected.
    ///
    /// # Panics
    ///
    /// Panics if `handle` is a row that is not below the `rows` of [`new`](Self::new).
    #[inline]
    pub fn get(&self, handle: H) -> Option<u32> {
        Some(self.numbers[handle]).filter(|&number| number != NO_NUMBER)
    }

    /// Returns the handle that has the number `number`; O(1).
    ///
    /// # Panics
    ///
    /// Panics if `number` is not less than [`len`](Self::len).
    #[inline]
    pub fn handle(&self, number: u32) -> H {
        self.handles[number as usize]
    }

    /// Returns all handles in the order of their numbers.
    pub fn handles(&self) -> &[H] {
        &self.handles
    }
}

/// Returns the number of a handle; O(1) expected. Panics if the handle has no number.
impl<H: Handle> Index<H> for Numbers<H> {
    type Output = u32;

    #[inline]
    #[track_caller]
    fn index(&self, handle: H) -> &u32 {
        let number = &self.numbers[handle];
        if *number == NO_NUMBER {
            no_number(handle);
        }
        number
    }
}

#[cold]
#[inline(never)]
#[track_caller]
fn no_number<H: fmt::Debug>(handle: H) -> ! {
    panic!("no number for {handle:?}: it is not one of the numbered elements")
}

impl<H: Handle> fmt::Debug for Numbers<H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map()
            .entries(self.handles.iter().enumerate())
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handles::pair::Pair;
    use crate::handles::row_id::VertexId;

    #[test]
    fn numbers_of_rows_and_of_pairs_have_no_gaps() {
        let v = VertexId::new;
        let rows = Numbers::new(9, [v(8), v(3), v(5)].into_iter());
        assert_eq!([rows[v(8)], rows[v(3)], rows[v(5)]], [0, 1, 2]);
        assert_eq!(
            (rows.handle(1), rows.get(v(4)), rows.len()),
            (v(3), None, 3)
        );
        let e = |a, b| Pair::new(v(a), v(b));
        let pairs = Numbers::new(0, [e(4, 2), e(1, 2)].into_iter());
        assert_eq!(pairs.get(e(2, 1)), Some(1));
        assert_eq!(pairs.get(e(1, 4)), None);
        assert_eq!(format!("{rows:?}"), "{0: v8, 1: v3, 2: v5}");
        assert!(Numbers::new(3, std::iter::empty::<VertexId>()).is_empty());
    }

    #[test]
    #[should_panic(expected = "no number for v2: it is not one of the numbered elements")]
    fn a_handle_without_a_number_panics_with_its_name() {
        let numbers = Numbers::new(3, [VertexId::new(0)].into_iter());
        let _ = numbers[VertexId::new(2)];
    }
}

//! The table of one relation: a row of items for each element.

use std::marker::PhantomData;
use std::ops::Range;

use sixfold_core::{Relation, RowId};

/// One relation of a whole mesh: a row of elements of kind `B` for each element of kind `A`.
///
/// The rows are in the order in which the structure lists the elements. The items of a row are in
/// the order in which the query yields them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RelationTable<A, B> {
    /// Index of the first item of each row, then the number of items. Empty if `stride` is not 0.
    offsets: Vec<u32>,
    /// The length of all rows, or 0 if the lengths differ.
    stride: usize,
    rows: usize,
    items: Vec<B>,
    element_kind: PhantomData<A>,
}

/// The rows of a table that is built.
pub(crate) struct Rows<B> {
    pub(crate) items: Vec<B>,
    offsets: Vec<u32>,
}

impl<B> Rows<B> {
    /// Ends a row with the last item; `None` if an offset cannot address it.
    #[inline]
    pub(crate) fn end_row(&mut self) -> Option<()> {
        let end = u32::try_from(self.items.len()).ok()?;
        self.offsets.push(end);
        Some(())
    }
}

/// The reason why the table of a relation could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum TabulationError {
    /// The relation has more items than a 32-bit offset can address.
    #[error(
        "the table of {relation} would have more than {} items: query the structure instead, or \
         split the mesh",
        u32::MAX
    )]
    TooManyItems { relation: Relation },
}

impl<A: RowId, B: RowId> RelationTable<A, B> {
    /// Builds the table. `rows` appends the items of each row, and then calls [`Rows::end_row`].
    pub(crate) fn collect(
        relation: Relation,
        rows: impl FnOnce(&mut Rows<B>) -> Option<()>,
    ) -> Result<Self, TabulationError> {
        let mut collected = Rows {
            items: Vec::new(),
            offsets: vec![0],
        };
        let fits = rows(&mut collected);
        fits.ok_or(TabulationError::TooManyItems { relation })?;
        Ok(Self::from_rows(collected))
    }

    fn from_rows(
        Rows {
            mut items,
            mut offsets,
        }: Rows<B>,
    ) -> Self {
        let rows = offsets.len() - 1;
        let length = |row: &[u32]| row[1] - row[0];
        let mut lengths = offsets.windows(2).map(length);
        let first = lengths.next().unwrap_or(0);
        let mut stride = 0;
        if first > 0 && lengths.all(|length| length == first) {
            stride = first as usize;
            offsets = Vec::new();
        }
        items.shrink_to_fit();
        offsets.shrink_to_fit();
        Self {
            offsets,
            stride,
            rows,
            items,
            element_kind: PhantomData,
        }
    }

    /// Returns the number of rows.
    #[inline]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Returns whether the table has no rows.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Returns the row of `element`. O(1).
    ///
    /// # Panics
    ///
    /// Panics if the table has no row for `element`.
    #[inline]
    pub fn row(&self, element: A) -> &[B] {
        &self.items[self.range(element.row() as usize)]
    }

    /// Yields each element of kind `A` with its row, in order.
    pub fn iter(&self) -> impl Iterator<Item = (A, &[B])> {
        let row = |row: usize| {
            (
                A::from_row(sixfold_core::row(row)),
                &self.items[self.range(row)],
            )
        };
        (0..self.rows).map(row)
    }

    /// Returns the items of all rows, row after row.
    pub fn items(&self) -> &[B] {
        &self.items
    }

    /// Returns the number of bytes allocated, including unused capacity.
    pub fn bytes(&self) -> usize {
        self.offsets.capacity() * size_of::<u32>() + self.items.capacity() * size_of::<B>()
    }

    #[inline]
    fn range(&self, row: usize) -> Range<usize> {
        if self.stride > 0 {
            return row * self.stride..(row + 1) * self.stride;
        }
        self.offsets[row] as usize..self.offsets[row + 1] as usize
    }
}

//! One relation as rows of items, end to end.

use std::marker::PhantomData;
use std::ops::Range;

use mesh_core::{Relation, RowId};

/// One relation of a whole mesh: for each element of kind `A` a row of elements of kind `B`.
///
/// Rows are in the order in which the structure names its elements, items in the order in which it
/// yields them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RelationTable<A, B> {
    /// Where each row begins, and where the last one ends; empty where all are equally long.
    offsets: Vec<u32>,
    /// How long all rows are, where they are.
    stride: usize,
    rows: usize,
    items: Vec<B>,
    asked_of: PhantomData<A>,
}

/// Why a relation could not be tabulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum TabulationError {
    /// Offsets have 32 bits.
    #[error(
        "{relation} yields more than {} items: ask the structure, or split the mesh",
        u32::MAX
    )]
    TooManyItems { relation: Relation },
}

impl<A: RowId, B: RowId> RelationTable<A, B> {
    /// Puts the rows that `ask` adds to its list one after the other.
    pub(crate) fn collect<E>(
        relation: Relation,
        elements: impl Iterator<Item = E>,
        mut ask: impl FnMut(E, &mut Vec<B>),
    ) -> Result<Self, TabulationError> {
        let mut items = Vec::new();
        let mut offsets = vec![0];
        for element in elements {
            ask(element, &mut items);
            let end = u32::try_from(items.len());
            offsets.push(end.map_err(|_| TabulationError::TooManyItems { relation })?);
        }
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
        Ok(Self {
            offsets,
            stride,
            rows,
            items,
            asked_of: PhantomData,
        })
    }

    /// How many rows there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// What `element` has; O(1).
    ///
    /// # Panics
    ///
    /// If the table has no such row.
    #[inline]
    pub fn of(&self, element: A) -> &[B] {
        &self.items[self.range(element.row() as usize)]
    }

    /// All rows, in order.
    pub fn iter(&self) -> impl Iterator<Item = (A, &[B])> {
        let row = |row: usize| {
            (
                A::from_row(mesh_core::row(row)),
                &self.items[self.range(row)],
            )
        };
        (0..self.rows).map(row)
    }

    /// All rows end to end.
    pub fn items(&self) -> &[B] {
        &self.items
    }

    /// The bytes held, capacity included.
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

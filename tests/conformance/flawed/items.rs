//! An iterator with the flaws of `fold`.

use std::marker::PhantomData;

use super::{Flaw, FlawKind};

/// The items of a query, with an optional flaw of `fold`.
pub(super) struct Items<F, T> {
    items: Vec<T>,
    taken: usize,
    flaw: PhantomData<F>,
}

impl<F: Flaw, T: Copy> Items<F, T> {
    pub(super) fn new(items: impl Iterator<Item = T>) -> Self {
        Self {
            items: items.collect(),
            taken: 0,
            flaw: PhantomData,
        }
    }
}

impl<F: Flaw, T: Copy> Iterator for Items<F, T> {
    type Item = T;

    fn next(&mut self) -> Option<T> {
        let item = self.items.get(self.taken).copied()?;
        self.taken += 1;
        Some(item)
    }

    fn fold<B, G: FnMut(B, T) -> B>(self, init: B, f: G) -> B {
        let rest = &self.items[self.taken..];
        let items = match (F::KIND, rest) {
            (FlawKind::FoldEndsEarly | FlawKind::SideFoldEndsEarly, [but_last @ .., _]) => but_last,
            (FlawKind::FoldStartsAgain, _) => &self.items,
            _ => rest,
        };
        items.iter().copied().fold(init, f)
    }
}

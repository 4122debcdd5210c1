//! Walks that several queries share.

use std::ops::Range;
use std::vec;

use rustc_hash::FxHashSet;
use sixfold_core::{Editing, FaceId, IteratorExt, Pair, Probe, VertexId};

use crate::mesh::FaceVertexMesh;

/// Maximum number of handles that a result stores inline.
const FEW: usize = 32;

/// Maximum number of sides of a face without a hash set for repeated neighbours.
const FEW_SIDES: usize = 8;

/// Returns the vertices before and after `v` in a face.
///
/// # Panics
///
/// Panics if `v` is missing from a face of more than three corners.
#[inline]
pub(crate) fn neighbours_in(face: &[VertexId], v: VertexId) -> [VertexId; 2] {
    if let &[a, b, c] = face {
        // No branch, because the place of `v` is unpredictable.
        let before = if v == b {
            a
        } else if v == a {
            c
        } else {
            b
        };
        let after = if v == b {
            c
        } else if v == a {
            b
        } else {
            a
        };
        return [before, after];
    }
    let at = face.iter().position(|&corner| corner == v);
    let at = at.expect("I3: a face in the fan of a vertex contains it");
    let last = face.len() - 1;
    let before = if at == 0 { last } else { at - 1 };
    let after = if at == last { 0 } else { at + 1 };
    [face[before], face[after]]
}

/// Returns whether a face has a side between `v` and `other`. The face contains `v`.
#[inline]
pub(crate) fn has_side_between(face: &[VertexId], v: VertexId, other: VertexId) -> bool {
    match face {
        // In a triangle, any two corners are adjacent.
        &[a, b, c] => (a == other) | (b == other) | (c == other),
        face => polygon_has_side_between(face, v, other),
    }
}

/// A function of its own, so that the test of a triangle is small enough to be inlined.
#[inline(never)]
fn polygon_has_side_between(face: &[VertexId], v: VertexId, other: VertexId) -> bool {
    neighbours_in(face, v).contains(&other)
}

/// Moves the distinct items to the front. Returns the number of distinct items.
///
/// Compares each item with all distinct items before it, without a branch. A branch misprediction
/// would cost more than these comparisons.
#[inline]
fn keep_distinct<T: Copy + PartialEq>(items: &mut [T]) -> usize {
    let mut kept = 0;
    for i in 0..items.len() {
        let item = items[i];
        let known = items[..kept]
            .iter()
            .fold(false, |known, &x| known | (x == item));
        items[kept] = item;
        kept += usize::from(!known);
    }
    kept
}

/// Handles, aligned to cache lines. Without this alignment, VV takes 43 to 64 ns per vertex,
/// depending on the place on the stack.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Few<H>([H; FEW]);

/// An item for each of several distinct handles. Few handles are stored inline, many in a vector.
pub(crate) struct FewOrMany<H, F> {
    few: Few<H>,
    /// The part of `few` that is not returned yet.
    rest: Range<usize>,
    many: vec::IntoIter<H>,
    item: F,
}

impl<H: Copy + PartialEq, F> FewOrMany<H, F> {
    /// Returns no handles; `unused` is any handle.
    #[inline]
    fn new(unused: H, item: F) -> Self {
        Self {
            few: Few([unused; FEW]),
            rest: 0..0,
            many: Vec::new().into_iter(),
            item,
        }
    }

    /// Returns whether `handle` is not returned yet.
    #[inline]
    pub(crate) fn has(&self, handle: H) -> bool {
        self.few.0[self.rest.clone()].contains(&handle) || self.many.as_slice().contains(&handle)
    }
}

impl<H: Copy, T, F: FnMut(H) -> T> Iterator for FewOrMany<H, F> {
    type Item = T;

    #[inline]
    fn next(&mut self) -> Option<T> {
        let handle = match self.rest.next() {
            Some(i) => self.few.0[i],
            None => self.many.next()?,
        };
        Some((self.item)(handle))
    }

    #[inline(always)]
    fn fold<B, G: FnMut(B, T) -> B>(mut self, init: B, mut visit: G) -> B {
        let mut folded = init;
        for &handle in &self.few.0[self.rest] {
            folded = visit(folded, (self.item)(handle));
        }
        for handle in self.many {
            folded = visit(folded, (self.item)(handle));
        }
        folded
    }
}

impl<P: Probe, E: Editing> FaceVertexMesh<E, P> {
    /// Returns `item` of each vertex adjacent to `v`.
    ///
    /// Compares the vertices of a small fan in place. Uses a hash set for a large fan, so that the
    /// time stays linear.
    #[inline(always)] // A call would return the iterator in memory: VV takes 1.2 times the time.
    pub(crate) fn ring<T, F: FnMut(VertexId) -> T>(
        &self,
        v: VertexId,
        item: F,
    ) -> FewOrMany<VertexId, F> {
        let fan = self.fan(v);
        let mut ring = FewOrMany::new(v, item);
        if 2 * fan.len() > FEW {
            ring.many = self.many_neighbours(fan, v).into_iter();
            return ring;
        }
        // Filling `ring.few` in place takes 1.2 times the time.
        let mut few = Few([v; FEW]);
        for (pair, &f) in few.0.as_chunks_mut().0.iter_mut().zip(fan) {
            *pair = neighbours_in(self.known_face(f), v);
        }
        ring.rest.end = keep_distinct(&mut few.0[..2 * fan.len()]);
        ring.few = few;
        ring
    }

    #[inline]
    pub(crate) fn spokes(
        &self,
        v: VertexId,
    ) -> FewOrMany<VertexId, impl FnMut(VertexId) -> Pair<VertexId> + use<P, E>> {
        self.ring(v, move |other| Pair::new(v, other))
    }

    /// Returns the vertices adjacent to `v`, each once. The fan of `v` may have any length.
    #[inline(never)]
    fn many_neighbours(&self, fan: &[FaceId], v: VertexId) -> Vec<VertexId> {
        let neighbours = fan
            .iter()
            .flat_map(|&f| neighbours_in(self.known_face(f), v));
        neighbours.distinct().collect()
    }

    #[inline]
    pub(crate) fn sides(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        let face = self.face(f);
        Pair::sides(face.len(), |i| face[i])
    }

    /// Returns the end of `e` with fewer faces, the faces at this end, and the other end.
    #[inline]
    pub(crate) fn shorter_fan(&self, e: Pair<VertexId>) -> (VertexId, &[FaceId], VertexId) {
        let [a, b] = e.ends();
        let [at_a, at_b] = [a, b].map(|v| *self.fans.read(v.index()));
        if at_a.len <= at_b.len {
            (a, self.places(a, at_a), b)
        } else {
            (b, self.places(b, at_b), a)
        }
    }

    /// Returns the faces at the edge `e`.
    #[inline]
    pub(crate) fn faces_along(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceId> {
        let (v, fan, other) = self.shorter_fan(e);
        let fan = fan.iter().map_inline(|&f| f);
        fan.filter_inline(move |&f| has_side_between(self.known_face(f), v, other))
    }

    /// Returns the faces that share a side with `f`, each once.
    #[inline]
    pub(crate) fn faces_around(&self, f: FaceId) -> impl Iterator<Item = FaceId> + use<P, E> {
        let mut around = FewOrMany::new(f, |g| g);
        match self.few_faces_around(f, &mut around.few) {
            Some(count) => around.rest.end = count,
            None => around.many = self.many_faces_around(f).into_iter(),
        }
        around
    }

    /// Writes the faces that share a side with `f` to `few`, each once. Returns the number of
    /// faces, or `None` if `few` has too few places or `f` has many sides.
    #[inline]
    fn few_faces_around(&self, f: FaceId, few: &mut Few<FaceId>) -> Option<usize> {
        if self.face(f).len() > FEW_SIDES {
            return None;
        }
        let mut found = 0;
        for side in self.sides(f) {
            for g in self.faces_along(side) {
                *few.0.get_mut(found)? = g;
                found += usize::from(g != f);
            }
        }
        Some(keep_distinct(&mut few.0[..found]))
    }

    /// Returns the faces that share a side with `f`, each once.
    #[inline(never)]
    fn many_faces_around(&self, f: FaceId) -> Vec<FaceId> {
        let mut known = FxHashSet::from_iter([f]);
        let mut faces = Vec::new();
        for side in self.sides(f) {
            let (v, fan, other) = self.shorter_fan(side);
            for &g in fan {
                if !known.contains(&g) && has_side_between(self.known_face(g), v, other) {
                    known.insert(g);
                    faces.push(g);
                }
            }
        }
        faces
    }
}

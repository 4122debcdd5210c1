//! Walks that several queries share.

use mesh_core::{Editing, FaceId, IteratorExt, Pair, Probe, VertexId};
use rustc_hash::FxHashSet;

use crate::mesh::AnyFaceVertexMesh;

/// How many handles an answer holds in place.
const FEW: usize = 32;

/// For how many sides of a face repeated neighbours are looked through anew rather than remembered.
const FEW_SIDES: usize = 8;

/// The vertices before and after `v` in a face that has it.
///
/// # Panics
///
/// If the face lacks `v`, which I3 rules out.
#[inline]
pub(crate) fn beside(face: &[VertexId], v: VertexId) -> [VertexId; 2] {
    if let &[a, b, c] = face {
        // Two selections each and no branch: where `v` stands is not to be foreseen.
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
    let at = at.expect("I3: a face in the fan of a vertex names it");
    let last = face.len() - 1;
    let before = if at == 0 { last } else { at - 1 };
    let after = if at == last { 0 } else { at + 1 };
    [face[before], face[after]]
}

/// Whether a face that has `v` runs between `v` and `other`.
#[inline]
pub(crate) fn runs_between(face: &[VertexId], v: VertexId, other: VertexId) -> bool {
    match face {
        // Any two corners of a triangle follow each other.
        &[a, b, c] => (a == other) | (b == other) | (c == other),
        face => beside(face, v).contains(&other),
    }
}

/// Keeps the first of equal items in front; how many there are.
///
/// Every item is compared with all before it, without a branch: which of them are new follows no
/// pattern, and a wrong guess costs more than comparing a whole ring.
#[inline]
fn keep_distinct<T: Copy + PartialEq>(items: &mut [T]) -> usize {
    let mut new = [true; FEW];
    for i in 1..items.len() {
        let item = items[i];
        new[i] = !items[..i]
            .iter()
            .fold(false, |known, &x| known | (x == item));
    }
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

/// The vertices beside a vertex, each once: a few in place, or any number of them.
pub(crate) struct Ring {
    few: [VertexId; FEW],
    /// How many of `few` there are.
    found: usize,
    many: Vec<VertexId>,
}

impl Ring {
    /// Whether `v` is one of them.
    #[inline]
    pub(crate) fn has(&self, v: VertexId) -> bool {
        self.few[..self.found].contains(&v) || self.many.contains(&v)
    }

    /// All of them.
    #[inline]
    pub(crate) fn into_vertices(self) -> impl Iterator<Item = VertexId> {
        self.few.into_iter().take(self.found).chain(self.many)
    }
}

impl<P: Probe, E: Editing> AnyFaceVertexMesh<P, E> {
    /// The vertices beside `v` in its faces, each once.
    ///
    /// A small fan is answered in place; a large one through a hash set, so that a vertex of
    /// valence 100,000 stays linear.
    #[inline]
    pub(crate) fn ring(&self, v: VertexId) -> Ring {
        let fan = self.fan(v);
        let beside = |f: &FaceId| beside(self.known_face(*f), v);
        let mut few = [v; FEW];
        let (mut found, mut many) = (0, Vec::new());
        if 2 * fan.len() <= FEW {
            for (pair, f) in few.as_chunks_mut().0.iter_mut().zip(fan) {
                *pair = beside(f);
            }
            found = keep_distinct(&mut few[..2 * fan.len()]);
        } else {
            many = fan.iter().flat_map(beside).distinct().collect();
        }
        Ring { few, found, many }
    }

    /// The sides of `f`, in order.
    #[inline]
    pub(crate) fn sides(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        let face = self.face(f);
        Pair::sides(face.len(), |i| face[i])
    }

    /// The end of `e` with fewer faces, those faces, and the other end.
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

    /// The faces along the edge `e`, found from the end with the shorter fan.
    #[inline]
    pub(crate) fn faces_along(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceId> {
        let (v, fan, other) = self.shorter_fan(e);
        let fan = fan.iter().copied();
        fan.filter(move |&f| runs_between(self.known_face(f), v, other))
    }

    /// The faces that share a side with `f`, each once; those of a few sides are found in place.
    #[inline]
    pub(crate) fn faces_around(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        let mut few = [f; FEW];
        let (mut found, mut many) = (0, Vec::new());
        let mut fits = self.face(f).len() <= FEW_SIDES;
        let few_sides = self.sides(f).take(if fits { FEW_SIDES } else { 0 });
        'sides: for side in few_sides {
            for g in self.faces_along(side) {
                if found == FEW {
                    fits = false;
                    break 'sides;
                }
                few[found] = g;
                found += usize::from(g != f);
            }
        }
        if fits {
            found = keep_distinct(&mut few[..found]);
        } else {
            found = 0;
            many = self.many_faces_around(f);
        }
        few.into_iter().take(found).chain(many)
    }

    /// The same for any number of sides; a face that is known is not looked through again.
    #[inline(never)]
    fn many_faces_around(&self, f: FaceId) -> Vec<FaceId> {
        let mut known = FxHashSet::from_iter([f]);
        let mut faces = Vec::new();
        for side in self.sides(f) {
            let (v, fan, other) = self.shorter_fan(side);
            for &g in fan {
                if !known.contains(&g) && runs_between(self.known_face(g), v, other) {
                    known.insert(g);
                    faces.push(g);
                }
            }
        }
        faces
    }
}

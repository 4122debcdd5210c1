//! Walks that several queries share.

use rustc_hash::FxHashSet;
use sixfold_core::{Editing, FaceId, IteratorExt, Pair, Probe, VertexId};

use crate::mesh::FaceVertexMesh;

/// Maximum number of handles that a result stores inline.
const FEW: usize = 32;

/// Maximum number of sides for which comparisons find repeated neighbours; above, a hash set does.
const FEW_SIDES: usize = 8;

/// Returns the vertices before and after `v` in a face that contains `v`.
///
/// # Panics
///
/// Panics if `v` is missing from a face of more than three corners, which I3 rules out.
#[inline]
pub(crate) fn neighbours_in(face: &[VertexId], v: VertexId) -> [VertexId; 2] {
    if let &[a, b, c] = face {
        // Two selections each and no branch, because the place of `v` is unpredictable.
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

/// Returns whether a face that contains `v` has a side between `v` and `other`.
#[inline]
pub(crate) fn has_side_between(face: &[VertexId], v: VertexId, other: VertexId) -> bool {
    match face {
        // Any two corners of a triangle are adjacent.
        &[a, b, c] => (a == other) | (b == other) | (c == other),
        face => neighbours_in(face, v).contains(&other),
    }
}

/// Moves the first of each group of equal items to the front; returns the number of distinct items.
///
/// Compares each item with all distinct items before it, without a branch. Which items are new is
/// unpredictable, and a branch misprediction costs more than the comparison with a whole ring.
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

/// The vertices adjacent to a vertex, each once: stored inline if they are few, else in a vector.
pub(crate) struct Ring {
    few: [VertexId; FEW],
    /// Number of vertices in `few`.
    found: usize,
    many: Vec<VertexId>,
}

impl Ring {
    /// Returns whether `v` is one of the vertices.
    #[inline]
    pub(crate) fn has(&self, v: VertexId) -> bool {
        self.few[..self.found].contains(&v) || self.many.contains(&v)
    }

    /// Returns all vertices.
    #[inline]
    pub(crate) fn into_vertices(self) -> impl Iterator<Item = VertexId> {
        self.few.into_iter().take(self.found).chain(self.many)
    }
}

impl<P: Probe, E: Editing> FaceVertexMesh<E, P> {
    /// Returns the vertices adjacent to `v` in its faces, each once.
    ///
    /// Compares the vertices of a small fan in place; uses a hash set for a large fan, so that the
    /// time stays linear even for a vertex of valence 100,000.
    #[inline]
    pub(crate) fn ring(&self, v: VertexId) -> Ring {
        let fan = self.fan(v);
        let neighbours = |f: &FaceId| neighbours_in(self.known_face(*f), v);
        let mut few = [v; FEW];
        let (mut found, mut many) = (0, Vec::new());
        if 2 * fan.len() <= FEW {
            for (pair, f) in few.as_chunks_mut().0.iter_mut().zip(fan) {
                *pair = neighbours(f);
            }
            found = keep_distinct(&mut few[..2 * fan.len()]);
        } else {
            many = fan.iter().flat_map(neighbours).distinct().collect();
        }
        Ring { few, found, many }
    }

    /// Returns the sides of `f`, in order.
    #[inline]
    pub(crate) fn sides(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        let face = self.face(f);
        Pair::sides(face.len(), |i| face[i])
    }

    /// Returns the end of `e` with fewer faces, those faces, and the other end.
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

    /// Returns the faces at the edge `e`, from the end with the shorter fan.
    #[inline]
    pub(crate) fn faces_along(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceId> {
        let (v, fan, other) = self.shorter_fan(e);
        let fan = fan.iter().copied();
        fan.filter(move |&f| has_side_between(self.known_face(f), v, other))
    }

    /// Returns the faces that share a side with `f`, each once; allocates only for many sides.
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

    /// Returns the same for any number of sides; a face that was found is not searched again.
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

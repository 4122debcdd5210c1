//! Operations that keep an oriented manifold an oriented manifold.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::draft::Draft;

/// One operation. Its numbers, taken modulo the number of elements, select the elements. If the
/// operation is impossible there, nothing happens.
#[derive(Clone, Debug)]
pub(super) enum Surgery {
    /// Removes a face, unless it is the last one; a vertex that then has two fans is duplicated.
    RemoveFace(usize),
    /// Inserts a vertex into an edge, in each of its faces.
    SplitEdge(usize),
    /// Replaces a face by triangles around a new vertex in its middle.
    PokeFace(usize),
    /// Cuts a face in two along a diagonal.
    SplitFace(usize, usize, usize),
    /// Merges the two faces at an edge.
    DissolveEdge(usize),
    /// Attaches a triangle to a boundary edge.
    AddEar(usize),
    /// Closes a boundary loop with one face.
    FillHole(usize),
    /// Removes two faces of equal degree and joins their boundaries with a tube of quads. This
    /// raises the genus by one, or reduces the number of components by one.
    Tube(usize, usize),
}

/// Generates any operation.
pub(super) fn surgery() -> impl Strategy<Value = Surgery> {
    let at = || (0..1000_usize).boxed();
    prop_oneof![
        at().prop_map(Surgery::RemoveFace),
        at().prop_map(Surgery::SplitEdge),
        at().prop_map(Surgery::PokeFace),
        (at(), at(), at()).prop_map(|(f, i, j)| Surgery::SplitFace(f, i, j)),
        at().prop_map(Surgery::DissolveEdge),
        at().prop_map(Surgery::AddEar),
        at().prop_map(Surgery::FillHole),
        (at(), at()).prop_map(|(f, g)| Surgery::Tube(f, g)),
    ]
}

impl Surgery {
    /// Applies the operation to `draft`, which has at least one face before and after.
    pub(super) fn operate(self, draft: &mut Draft) {
        match self {
            Self::RemoveFace(f) => remove_face(draft, f),
            Self::SplitEdge(side) => split_edge(draft, side),
            Self::PokeFace(f) => poke_face(draft, f),
            Self::SplitFace(f, i, j) => split_face(draft, f, i, j),
            Self::DissolveEdge(side) => dissolve_edge(draft, side),
            Self::AddEar(side) => add_ear(draft, side),
            Self::FillHole(side) => fill_hole(draft, side),
            Self::Tube(f, g) => tube(draft, f, g),
        }
    }
}

/// Returns the item at `number` modulo the number of items.
fn pick<T: Clone>(items: &[T], number: usize) -> Option<T> {
    items.get(number.checked_rem(items.len())?).cloned()
}

fn remove_face(draft: &mut Draft, f: usize) {
    if draft.faces.len() > 1 {
        draft.faces.remove(f % draft.faces.len());
        draft.separate_fans();
    }
}

fn split_edge(draft: &mut Draft, side: usize) {
    let Some((a, b, _)) = pick(&draft.sides(), side) else {
        return;
    };
    let middle = draft.vertex();
    for face in &mut draft.faces {
        let degree = face.len();
        let here = (0..degree).find(|&i| {
            let (from, to) = (face[i], face[(i + 1) % degree]);
            (from, to) == (a, b) || (from, to) == (b, a)
        });
        if let Some(i) = here {
            face.insert(i + 1, middle);
        }
    }
}

fn poke_face(draft: &mut Draft, f: usize) {
    let f = f % draft.faces.len();
    let middle = draft.vertex();
    let face = draft.faces.swap_remove(f);
    let next = face.iter().cycle().skip(1);
    let fan = face.iter().zip(next).map(|(&a, &b)| vec![a, b, middle]);
    draft.faces.extend(fan);
}

/// Pokes every face that is not a triangle.
pub(super) fn triangulate(draft: &mut Draft) {
    while let Some(f) = draft.faces.iter().position(|face| face.len() > 3) {
        poke_face(draft, f);
    }
}

/// ```text
///   j ─── ·      splits a face of four or more corners into two,
///   │  ╲  │      unless i–j is an edge already
///   · ─── i
/// ```
fn split_face(draft: &mut Draft, f: usize, i: usize, j: usize) {
    let f = f % draft.faces.len();
    let mut face = draft.faces[f].clone();
    let degree = face.len();
    if degree < 4 {
        return;
    }
    face.rotate_left(i % degree);
    let j = 2 + j % (degree - 3);
    if draft.ring(face[0]).contains(&face[j]) {
        return;
    }
    let mut second = face.split_off(j);
    second.push(face[0]);
    face.push(second[0]);
    draft.faces[f] = face;
    draft.faces.push(second);
}

/// Merges two faces only if the edge is all that they share. Otherwise the merged face would use a
/// vertex twice.
fn dissolve_edge(draft: &mut Draft, side: usize) {
    let owner = draft.face_of_side();
    let shared = owner.iter().filter_map(|(&(a, b), &f)| {
        let g = *owner.get(&(b, a))?;
        let common = draft.faces[f].iter().filter(|v| draft.faces[g].contains(v));
        (a < b && f != g && common.count() == 2).then_some((a, b, f, g))
    });
    let Some((a, b, f, g)) = pick(&shared.collect::<Vec<_>>(), side) else {
        return;
    };
    // From b around f to a, then from a around g, without its ends.
    let from = |face: &[u32], start: u32| {
        let at = face.iter().position(|&v| v == start).unwrap_or(0);
        [&face[at..], &face[..at]].concat()
    };
    let mut merged = from(&draft.faces[f], b);
    let other = from(&draft.faces[g], a);
    merged.extend(other.into_iter().filter(|&v| v != a && v != b));
    draft.faces[f] = merged;
    draft.faces.remove(g);
}

fn add_ear(draft: &mut Draft, side: usize) {
    let open: Vec<(u32, u32)> = holes(draft).into_iter().collect();
    if let Some((from, to)) = pick(&open, side) {
        let tip = draft.vertex();
        draft.faces.push(vec![from, to, tip]);
    }
}

fn fill_hole(draft: &mut Draft, side: usize) {
    let open = holes(draft);
    let starts: Vec<u32> = open.keys().copied().collect();
    let Some(start) = pick(&starts, side) else {
        return;
    };
    let around = std::iter::successors(Some(start), |at| {
        open.get(at).copied().filter(|&next| next != start)
    });
    draft.faces.push(around.collect());
}

/// Returns the sides that a face in each hole would have, by their start: the boundary in opposite
/// direction. At most one of them starts at each vertex, because the mesh is manifold.
fn holes(draft: &Draft) -> BTreeMap<u32, u32> {
    let owner = draft.face_of_side();
    let open = owner.keys().filter(|&&(a, b)| !owner.contains_key(&(b, a)));
    open.map(|&(a, b)| (b, a)).collect()
}

/// ```text
///   a1 ── c1 ── b1     a ring c of new vertices in the middle, so that no edge of the tube can
///   │     │     │      exist already; b runs in the opposite direction, as seen from here
///   a0 ── c0 ── b0
/// ```
fn tube(draft: &mut Draft, f: usize, g: usize) {
    let f = f % draft.faces.len();
    let degree = draft.faces[f].len();
    let mates = (0..draft.faces.len()).filter(|&g| g != f && draft.faces[g].len() == degree);
    let Some(g) = pick(&mates.collect::<Vec<_>>(), g) else {
        return;
    };
    let a = draft.faces[f].clone();
    let mut b = draft.faces[g].clone();
    b.reverse();
    // A vertex of both faces must not be joined to itself: a–c and c–b would be the same edge.
    let meets = |b: &[u32]| a.iter().zip(b).any(|(a, b)| a == b);
    for _ in 0..degree {
        if meets(&b) {
            b.rotate_left(1);
        }
    }
    if meets(&b) {
        return;
    }
    draft.faces.remove(f.max(g));
    draft.faces.remove(f.min(g));
    let c: Vec<u32> = (0..degree).map(|_| draft.vertex()).collect();
    for i in 0..degree {
        let j = (i + 1) % degree;
        draft.faces.push(vec![a[i], a[j], c[j], c[i]]);
        draft.faces.push(vec![c[i], c[j], b[j], b[i]]);
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use sixfold_core::Capabilities;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// The first operation that breaks the mesh is shown.
        #[test]
        fn every_step_keeps_an_oriented_manifold(steps in collection::vec(surgery(), 0..20)) {
            let mut draft = Draft::of(&[sixfold_shapes::tetrahedron(), sixfold_shapes::cube()]);
            for step in steps {
                step.clone().operate(&mut draft);
                let verdict = crate::verdict(&Capabilities::ORIENTED_MANIFOLDS, &draft.clone().finish(0));
                prop_assert_eq!(verdict, Ok(()), "{:?}", step);
            }
        }
    }
}

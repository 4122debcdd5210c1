//! Operations that change an oriented manifold into another oriented manifold.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::builder::MeshBuilder;

/// One operation. Its numbers, modulo the number of elements, select the elements. An operation
/// that is impossible at these elements does nothing.
#[derive(Clone, Debug)]
pub(super) enum Operation {
    /// Removes a face, except the last face. A vertex that then has two fans is duplicated.
    RemoveFace(usize),
    /// Inserts a vertex into an edge, and into each face at the edge.
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

pub(super) fn operation() -> impl Strategy<Value = Operation> {
    let at = || (0..1000_usize).boxed();
    prop_oneof![
        at().prop_map(Operation::RemoveFace),
        at().prop_map(Operation::SplitEdge),
        at().prop_map(Operation::PokeFace),
        (at(), at(), at()).prop_map(|(f, i, j)| Operation::SplitFace(f, i, j)),
        at().prop_map(Operation::DissolveEdge),
        at().prop_map(Operation::AddEar),
        at().prop_map(Operation::FillHole),
        (at(), at()).prop_map(|(f, g)| Operation::Tube(f, g)),
    ]
}

impl Operation {
    /// Applies the operation to `builder`, which must have at least one face.
    pub(super) fn apply(self, builder: &mut MeshBuilder) {
        match self {
            Self::RemoveFace(f) => remove_face(builder, f),
            Self::SplitEdge(side) => split_edge(builder, side),
            Self::PokeFace(f) => poke_face(builder, f),
            Self::SplitFace(f, i, j) => split_face(builder, f, i, j),
            Self::DissolveEdge(side) => dissolve_edge(builder, side),
            Self::AddEar(side) => add_ear(builder, side),
            Self::FillHole(side) => fill_hole(builder, side),
            Self::Tube(f, g) => tube(builder, f, g),
        }
    }
}

fn pick<T: Clone>(items: &[T], number: usize) -> Option<T> {
    items.get(number.checked_rem(items.len())?).cloned()
}

fn remove_face(builder: &mut MeshBuilder, f: usize) {
    if builder.faces.len() > 1 {
        builder.faces.remove(f % builder.faces.len());
        builder.separate_fans();
    }
}

fn split_edge(builder: &mut MeshBuilder, side: usize) {
    let Some((a, b, _)) = pick(&builder.sides(), side) else {
        return;
    };
    let middle = builder.add_vertex();
    for face in &mut builder.faces {
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

fn poke_face(builder: &mut MeshBuilder, f: usize) {
    let f = f % builder.faces.len();
    let middle = builder.add_vertex();
    let face = builder.faces.swap_remove(f);
    let next = face.iter().cycle().skip(1);
    let fan = face.iter().zip(next).map(|(&a, &b)| vec![a, b, middle]);
    builder.faces.extend(fan);
}

pub(super) fn triangulate(builder: &mut MeshBuilder) {
    while let Some(f) = builder.faces.iter().position(|face| face.len() > 3) {
        poke_face(builder, f);
    }
}

/// ```text
///   j ─── ·      splits a face of four or more corners into two,
///   │  ╲  │      unless i–j is an edge already
///   · ─── i
/// ```
fn split_face(builder: &mut MeshBuilder, f: usize, i: usize, j: usize) {
    let f = f % builder.faces.len();
    let mut face = builder.faces[f].clone();
    let degree = face.len();
    if degree < 4 {
        return;
    }
    face.rotate_left(i % degree);
    let j = 2 + j % (degree - 3);
    if builder.neighbours(face[0]).contains(&face[j]) {
        return;
    }
    let mut second = face.split_off(j);
    second.push(face[0]);
    face.push(second[0]);
    builder.faces[f] = face;
    builder.faces.push(second);
}

/// Merges two faces that share only an edge and its ends.
fn dissolve_edge(builder: &mut MeshBuilder, side: usize) {
    let face_of_side = builder.face_by_side();
    let shared = face_of_side.iter().filter_map(|(&(a, b), &f)| {
        let g = *face_of_side.get(&(b, a))?;
        let common = builder.faces[f]
            .iter()
            .filter(|v| builder.faces[g].contains(v));
        (a < b && f != g && common.count() == 2).then_some((a, b, f, g))
    });
    let Some((a, b, f, g)) = pick(&shared.collect::<Vec<_>>(), side) else {
        return;
    };
    let from = |face: &[u32], start: u32| {
        let at = face.iter().position(|&v| v == start).unwrap_or(0);
        [&face[at..], &face[..at]].concat()
    };
    let mut merged = from(&builder.faces[f], b);
    let other = from(&builder.faces[g], a);
    merged.extend(other.into_iter().filter(|&v| v != a && v != b));
    builder.faces[f] = merged;
    builder.faces.remove(g);
}

fn add_ear(builder: &mut MeshBuilder, side: usize) {
    let open: Vec<(u32, u32)> = holes(builder).into_iter().collect();
    if let Some((from, to)) = pick(&open, side) {
        let apex = builder.add_vertex();
        builder.faces.push(vec![from, to, apex]);
    }
}

fn fill_hole(builder: &mut MeshBuilder, side: usize) {
    let open = holes(builder);
    let starts: Vec<u32> = open.keys().copied().collect();
    let Some(start) = pick(&starts, side) else {
        return;
    };
    let around = std::iter::successors(Some(start), |at| {
        open.get(at).copied().filter(|&next| next != start)
    });
    builder.faces.push(around.collect());
}

/// Returns the boundary edges in the direction opposite to their faces, as a map from start to end.
/// In a manifold, at most one such edge starts at each vertex.
fn holes(builder: &MeshBuilder) -> BTreeMap<u32, u32> {
    let face_of_side = builder.face_by_side();
    let open = face_of_side
        .keys()
        .filter(|&&(a, b)| !face_of_side.contains_key(&(b, a)));
    open.map(|&(a, b)| (b, a)).collect()
}

/// ```text
///   a1 ── c1 ── b1     a ring c of new vertices in the middle, so that no edge of the tube can
///   │     │     │      exist already; b runs in the opposite direction, as seen from here
///   a0 ── c0 ── b0
/// ```
fn tube(builder: &mut MeshBuilder, f: usize, g: usize) {
    let f = f % builder.faces.len();
    let degree = builder.faces[f].len();
    let candidates =
        (0..builder.faces.len()).filter(|&g| g != f && builder.faces[g].len() == degree);
    let Some(g) = pick(&candidates.collect::<Vec<_>>(), g) else {
        return;
    };
    let a = builder.faces[f].clone();
    let mut b = builder.faces[g].clone();
    b.reverse();
    // A vertex of both faces must not be joined to itself.
    let coincide = |b: &[u32]| a.iter().zip(b).any(|(a, b)| a == b);
    for _ in 0..degree {
        if coincide(&b) {
            b.rotate_left(1);
        }
    }
    if coincide(&b) {
        return;
    }
    builder.faces.remove(f.max(g));
    builder.faces.remove(f.min(g));
    let c: Vec<u32> = (0..degree).map(|_| builder.add_vertex()).collect();
    for i in 0..degree {
        let j = (i + 1) % degree;
        builder.faces.push(vec![a[i], a[j], c[j], c[i]]);
        builder.faces.push(vec![c[i], c[j], b[j], b[i]]);
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use sixfold_core::Capabilities;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn every_step_keeps_an_oriented_manifold(steps in collection::vec(operation(), 0..20)) {
            let mut builder = MeshBuilder::from_meshes(&[sixfold_shapes::tetrahedron(), sixfold_shapes::cube()]);
            for step in steps {
                step.clone().apply(&mut builder);
                let result = crate::expected_check(&Capabilities::ORIENTED_MANIFOLDS, &builder.clone().build(0));
                prop_assert_eq!(result, Ok(()), "{:?}", step);
            }
        }
    }
}

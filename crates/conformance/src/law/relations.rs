//! The nine relations, their symmetry, and the ring.

use std::collections::BTreeSet;

use mesh_core::{PolygonMesh, Relation, Representation};

use crate::element::Element;
use crate::subject::Subject;

/// VV(v) holds the other end of each edge at `v`, once, and not `v`.
pub fn vertex_vertices<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::VertexVertices);
}

/// VE(v) holds each edge that ends at `v`, once.
pub fn vertex_edges<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::VertexEdges);
}

/// VF(v) holds each face with a corner at `v`, once.
pub fn vertex_faces<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::VertexFaces);
}

/// EV(e) is the two ends of `e`.
pub fn edge_vertices<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::EdgeVertices);
}

/// EE(e) holds each edge that shares an end with `e`, once, and not `e`.
pub fn edge_edges<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::EdgeEdges);
}

/// EF(e) holds each face along `e`, once.
pub fn edge_faces<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::EdgeFaces);
}

/// FF(f) holds each face that shares an edge with `f`, once, and not `f`.
pub fn face_faces<M: Representation>(polygons: &PolygonMesh) {
    is_the_set::<M>(polygons, Relation::FaceFaces);
}

/// FV(f) runs around `f` as the input gives it, from any start.
pub fn face_vertices<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::of(polygons) else {
        return;
    };
    for f in subject.oracle.domain(Relation::FaceVertices) {
        let got = subject.ask(Relation::FaceVertices, f);
        let expected = subject.oracle.answer(Relation::FaceVertices, f);
        assert!(
            is_rotation(&got, expected),
            "{}: face_vertices of {f} is {got:?}, not a rotation of {expected:?}",
            M::NAME
        );
    }
}

/// FE(f) runs along with FV(f): side `i` joins corners `i` and `i + 1`.
pub fn face_edges<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::of(polygons) else {
        return;
    };
    for f in subject.oracle.domain(Relation::FaceEdges) {
        let corners = subject.ask(Relation::FaceVertices, f);
        let next = corners.iter().cycle().skip(1);
        let expected: Vec<Element> = corners
            .iter()
            .zip(next)
            .map(|(&a, &b)| joining(a, b))
            .collect();
        let got = subject.ask(Relation::FaceEdges, f);
        assert_eq!(
            got,
            expected,
            "{}: face_edges of {f}, whose corners are {corners:?}",
            M::NAME
        );
    }
}

/// Incidence is mutual, and so is adjacency: `f ∈ VF(v)` exactly when `v ∈ FV(f)`, and so on.
pub fn symmetry<M: Representation>(polygons: &PolygonMesh) {
    use Relation::*;
    let Some(subject) = Subject::<M>::of(polygons) else {
        return;
    };
    let pairs = |relation| -> BTreeSet<(Element, Element)> {
        let asked = subject.oracle.domain(relation).into_iter();
        let paired = asked.flat_map(|of| {
            let answer = subject.ask(relation, of).into_iter();
            answer.map(move |item| (of, item))
        });
        paired.collect()
    };
    for (there, back) in [
        (VertexFaces, FaceVertices),
        (VertexEdges, EdgeVertices),
        (EdgeFaces, FaceEdges),
        (VertexVertices, VertexVertices),
        (EdgeEdges, EdgeEdges),
        (FaceFaces, FaceFaces),
    ] {
        let (there_pairs, back_pairs) = (pairs(there), pairs(back));
        for &(of, item) in &there_pairs {
            assert!(
                back_pairs.contains(&(item, of)),
                "{}: {there} of {of} has {item}, but {back} of {item} lacks {of}",
                M::NAME
            );
        }
        for &(of, item) in &back_pairs {
            assert!(
                there_pairs.contains(&(item, of)),
                "{}: {back} of {of} has {item}, but {there} of {item} lacks {of}",
                M::NAME
            );
        }
    }
}

/// `one_ring` runs counter-clockwise, from boundary to boundary where there is one, and is there
/// exactly where the faces form one consistently oriented fan.
pub fn one_ring<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::of(polygons) else {
        return;
    };
    for v in subject.oracle.vertices() {
        let got = subject.names.ring(&subject.mesh, v);
        let expected = subject.oracle.one_ring(v);
        let agree = match (&got, &expected) {
            (Some(got), Some((ring, true))) => is_rotation(got, ring),
            (Some(got), Some((ring, false))) => got == ring,
            (got, expected) => got.is_none() && expected.is_none(),
        };
        assert!(
            agree,
            "{}: one_ring of {v} is {got:?}, not {expected:?} (ring, closed)",
            M::NAME
        );
    }
}

fn is_the_set<M: Representation>(polygons: &PolygonMesh, relation: Relation) {
    let Some(subject) = Subject::<M>::of(polygons) else {
        return;
    };
    for element in subject.oracle.domain(relation) {
        agree(&subject, relation, element);
    }
}

/// `relation` of `element` is the set that the oracle gives, each item once.
pub(crate) fn agree<M: Representation>(subject: &Subject<M>, relation: Relation, element: Element) {
    let name = M::NAME;
    let mut got = subject.ask(relation, element);
    let expected = subject.oracle.answer(relation, element);
    got.sort();
    if let Some(twice) = got.windows(2).find(|pair| pair[0] == pair[1]) {
        panic!("{name}: {relation} of {element} yields {} twice", twice[0]);
    }
    assert!(
        !got.contains(&element),
        "{name}: {relation} of {element} yields {element} itself"
    );
    assert_eq!(got, expected, "{name}: {relation} of {element}");
}

/// The edge between two vertices.
fn joining(a: Element, b: Element) -> Element {
    match (a, b) {
        (Element::Vertex(a), Element::Vertex(b)) => Element::edge(a, b),
        _ => unreachable!("corners are vertices"),
    }
}

/// Whether `a` is `b` from another start.
pub(crate) fn is_rotation<T: PartialEq>(a: &[T], b: &[T]) -> bool {
    let turned = |start: usize| b[start..].iter().chain(&b[..start]);
    a.len() == b.len() && (a.is_empty() || (0..b.len()).any(|start| turned(start).eq(a)))
}

#[cfg(test)]
mod tests {
    use super::is_rotation;

    #[test]
    fn a_rotation_keeps_length_and_direction() {
        assert!(is_rotation::<u8>(&[], &[]));
        assert!(is_rotation(&[2, 3, 1], &[1, 2, 3]));
        assert!(!is_rotation(&[3, 2, 1], &[1, 2, 3]));
        assert!(!is_rotation(&[1, 2], &[1, 2, 1]));
    }
}

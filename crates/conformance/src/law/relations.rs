//! Laws about the nine relations, their symmetry, and the one-ring.

use std::collections::BTreeSet;

use sixfold_core::{FaceId, Facts, PolygonMesh, Relation, Representation, VertexId};

use crate::boundary::check_boundary;
use crate::element::Element;
use crate::folds::check_folds;
use crate::oracle::Oracle;
use crate::subject::{HandleMap, Subject};

/// VV(v) contains the other end of each edge at `v` once, and not `v` itself.
pub fn vertex_vertices<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::VertexVertices);
}

/// VE(v) contains each edge that ends at `v` once.
pub fn vertex_edges<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::VertexEdges);
}

/// VF(v) contains each face with a corner at `v` once.
pub fn vertex_faces<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::VertexFaces);
}

/// EV(e) contains the two ends of `e`.
pub fn edge_vertices<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::EdgeVertices);
}

/// EE(e) contains each edge that shares an end with `e` once, and not `e` itself.
pub fn edge_edges<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::EdgeEdges);
}

/// EF(e) contains each face along `e` once.
pub fn edge_faces<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::EdgeFaces);
}

/// FF(f) contains each face that shares an edge with `f` once, and not `f` itself.
pub fn face_faces<M: Representation>(polygons: &PolygonMesh) {
    check_sets::<M>(polygons, Relation::FaceFaces);
}

/// FV(f) contains the corners of `f` in the cyclic order of the input, starting at any corner.
pub fn face_vertices<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    for f in subject.oracle.domain(Relation::FaceVertices) {
        let got = subject.query(Relation::FaceVertices, f);
        let expected = subject.oracle.answer(Relation::FaceVertices, f);
        assert!(
            is_rotation(&got, expected),
            "{}: face_vertices of {f} is {got:?}, expected a rotation of {expected:?}",
            M::NAME
        );
    }
}

/// FE(f) has the order of FV(f): side `i` joins corners `i` and `i + 1`.
pub fn face_edges<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    for f in subject.oracle.domain(Relation::FaceEdges) {
        let corners = subject.query(Relation::FaceVertices, f);
        let next = corners.iter().cycle().skip(1);
        let expected: Vec<Element> = corners
            .iter()
            .zip(next)
            .map(|(&a, &b)| edge_between(a, b))
            .collect();
        let got = subject.query(Relation::FaceEdges, f);
        assert_eq!(
            got,
            expected,
            "{}: face_edges of {f}, whose corners are {corners:?}",
            M::NAME
        );
    }
}

/// The relations are symmetric: for example, `f ∈ VF(v)` if and only if `v ∈ FV(f)`.
pub fn symmetry<M: Representation>(polygons: &PolygonMesh) {
    use Relation::*;
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let pairs = |relation| -> BTreeSet<(Element, Element)> {
        let elements = subject.oracle.domain(relation).into_iter();
        let paired = elements.flat_map(|of| {
            let answer = subject.query(relation, of).into_iter();
            answer.map(move |item| (of, item))
        });
        paired.collect()
    };
    for (relation, inverse) in [
        (VertexFaces, FaceVertices),
        (VertexEdges, EdgeVertices),
        (EdgeFaces, FaceEdges),
        (VertexVertices, VertexVertices),
        (EdgeEdges, EdgeEdges),
        (FaceFaces, FaceFaces),
    ] {
        let (related, inverse_related) = (pairs(relation), pairs(inverse));
        for &(of, item) in &related {
            assert!(
                inverse_related.contains(&(item, of)),
                "{}: {relation} of {of} has {item}, but {inverse} of {item} does not have {of}",
                M::NAME
            );
        }
        for &(of, item) in &inverse_related {
            assert!(
                related.contains(&(item, of)),
                "{}: {inverse} of {of} has {item}, but {relation} of {item} does not have {of}",
                M::NAME
            );
        }
    }
}

/// `one_ring` runs counter-clockwise around a vertex. At a boundary vertex, `one_ring` starts and
/// ends at the boundary. A one-ring exists if and only if the faces at the vertex form one
/// consistently oriented fan.
pub fn one_ring<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    for v in subject.oracle.vertices() {
        let got = subject.handles.ring(&subject.mesh, v);
        let expected = subject.oracle.one_ring(v);
        let agree = match (&got, &expected) {
            (Some(got), Some((ring, true))) => is_rotation(got, ring),
            (Some(got), Some((ring, false))) => got == ring,
            (got, expected) => got.is_none() && expected.is_none(),
        };
        assert!(
            agree,
            "{}: one_ring of {v} is {got:?}, expected {expected:?} (ring, closed)",
            M::NAME
        );
        let with_faces = subject.handles.ring_with_faces(&subject.mesh, v);
        let ring = with_faces.as_ref().map(|ring| ring.iter().map(|&(w, _)| w));
        assert_eq!(
            ring.map(Iterator::collect::<Vec<_>>),
            got,
            "{}: one_ring_with_faces of {v}",
            M::NAME
        );
        let with_faces = with_faces.unwrap_or_default();
        for (i, &(w, face)) in with_faces.iter().enumerate() {
            let has_side = |f: &FaceId| {
                let corners = subject.oracle.corners(*f);
                let next = corners.iter().cycle().skip(1);
                corners.iter().zip(next).any(|ends| ends == (&v, &w))
            };
            let expected = subject.oracle.faces().find(has_side);
            let context = format!("{}: the face after {w} around {v}", M::NAME);
            assert_eq!(face, expected, "{context}");
            assert!(face.is_some() || i + 1 == with_faces.len(), "{context}");
        }
    }
}

/// The results of `valence`, `degree`, the boundary tests, the `contains_…` methods, and the
/// searches for shared elements agree with the relations.
/// Searches for elements that do not exist return `None`.
pub fn predicates<M: Representation>(polygons: &PolygonMesh) {
    let Some(Subject {
        mesh,
        oracle,
        handles,
        ..
    }) = Subject::<M>::from_polygons(polygons)
    else {
        return;
    };
    let name = M::NAME;
    let size = |relation, element| oracle.answer(relation, element).len();
    let is_boundary = |edge: &Element| size(Relation::EdgeFaces, *edge) == 1;
    for v in oracle.vertices() {
        let (handle, element) = (handles.vertex(v), Element::Vertex(v));
        let edges = oracle.answer(Relation::VertexEdges, element);
        assert_eq!(mesh.valence(handle), edges.len(), "{name}: valence of {v}");
        let expected = edges.iter().any(is_boundary);
        let got = mesh.is_boundary_vertex(handle);
        assert_eq!(got, expected, "{name}: is_boundary_vertex of {v}");
        assert!(
            mesh.contains_vertex(handle),
            "{name}: contains_vertex of {v}"
        );
    }
    for edge in oracle.edges() {
        let handle = handles.edge(edge);
        let got = mesh.is_boundary_edge(handle);
        assert_eq!(
            got,
            is_boundary(&edge),
            "{name}: is_boundary_edge of {edge}"
        );
        assert!(
            mesh.contains_edge(handle),
            "{name}: contains_edge of {edge}"
        );
        let opposite = mesh.opposite_vertices(handle).map(|v| handles.vertex_id(v));
        let mut opposite: Vec<VertexId> = opposite.collect();
        opposite.sort_unstable();
        let ends = oracle.answer(Relation::EdgeVertices, edge);
        let mut expected = Vec::new();
        for &f in oracle.answer(Relation::EdgeFaces, edge) {
            let corners = oracle.answer(Relation::FaceVertices, f);
            let third = corners.iter().filter(|v| !ends.contains(v));
            expected.extend(
                third
                    .filter(|_| corners.len() == 3)
                    .filter_map(|v| match v {
                        Element::Vertex(v) => Some(*v),
                        _ => None,
                    }),
            );
        }
        expected.sort_unstable();
        assert_eq!(opposite, expected, "{name}: opposite_vertices of {edge}");
    }
    for f in oracle.faces() {
        let edges = oracle.answer(Relation::FaceEdges, Element::Face(f));
        let got = mesh.is_boundary_face(handles.face(f));
        let expected = edges.iter().any(is_boundary);
        assert_eq!(got, expected, "{name}: is_boundary_face of {f}");
        for g in oracle.faces() {
            let shared = mesh.common_edge(handles.face(f), handles.face(g));
            let shared = shared.map(|e| handles.edge_id(e));
            let others = oracle.answer(Relation::FaceEdges, Element::Face(g));
            let is_common = |e: &Element| f != g && edges.contains(e) && others.contains(e);
            assert_eq!(
                shared.is_some(),
                edges.iter().any(is_common),
                "{name}: common_edge of {f} and {g} is {shared:?}"
            );
            assert!(
                shared.is_none_or(|e| is_common(&e)),
                "{name}: common_edge of {f} and {g} is {shared:?}"
            );
        }
        let (handle, corners) = (handles.face(f), oracle.corners(f));
        assert_eq!(mesh.degree(handle), corners.len(), "{name}: degree of {f}");
        assert!(mesh.contains_face(handle), "{name}: contains_face of {f}");
        for (i, &a) in corners.iter().enumerate() {
            let [b, c] = [1, 2].map(|step| corners[(i + step) % corners.len()]);
            let [va, vb, vc] = [a, b, c].map(|v| handles.vertex(v));
            let shared = mesh.common_face(va, vc).map(|face| handles.face_id(face));
            let holds = |face: FaceId| [a, c].iter().all(|v| oracle.corners(face).contains(v));
            assert!(
                shared.is_some_and(holds),
                "{name}: common_face of {a} and {c} is {shared:?}"
            );
            let side = mesh.edge_between(va, vb).map(|e| handles.edge_id(e));
            assert_eq!(
                side,
                Some(Element::edge(a, b)),
                "{name}: edge_between of {a} and {b}"
            );
            let opposite = mesh.opposite_vertex(handle, handles.edge(Element::edge(a, b)));
            let expected = (corners.len() == 3).then_some(vc);
            assert_eq!(
                opposite, expected,
                "{name}: opposite_vertex of {f} and {a}–{b}"
            );
        }
    }
    absent_elements(&mesh, &oracle, &handles);
}

/// `edge_between` and `common_face` return `None` for vertices that share no edge or no face, and
/// `opposite_vertex` returns `None` for an edge that is not a side of the face.
fn absent_elements<M: Representation>(mesh: &M, oracle: &Oracle, handles: &HandleMap<M>) {
    let name = M::NAME;
    for a in oracle.vertices() {
        let at = |relation| oracle.answer(relation, Element::Vertex(a));
        let va = handles.vertex(a);
        let adjacent = at(Relation::VertexVertices);
        let apart = |b: &VertexId| *b != a && !adjacent.contains(&Element::Vertex(*b));
        for b in oracle.vertices().find(apart).into_iter().chain([a]) {
            let edge = mesh.edge_between(va, handles.vertex(b));
            let edge = edge.map(|e| handles.edge_id(e));
            assert_eq!(edge, None, "{name}: edge_between of {a} and {b}");
        }
        let faces = || oracle.faces().filter(|&f| oracle.corners(f).contains(&a));
        let shares = |b: &VertexId| faces().any(|f| oracle.corners(f).contains(b));
        if let Some(b) = oracle.vertices().find(|b| *b != a && !shares(b)) {
            let face = mesh.common_face(va, handles.vertex(b));
            let face = face.map(|f| handles.face_id(f));
            assert_eq!(face, None, "{name}: common_face of {a} and {b}");
        }
        for f in faces() {
            let sides = oracle.answer(Relation::FaceEdges, Element::Face(f));
            for edge in at(Relation::VertexEdges) {
                if !sides.contains(edge) {
                    let vertex = mesh.opposite_vertex(handles.face(f), handles.edge(*edge));
                    assert_eq!(vertex, None, "{name}: opposite_vertex of {f} and {edge}");
                }
            }
        }
    }
}

/// `boundary_edges`, `boundary_loops` and `edge_face_counts` agree with the faces. The number of
/// boundary loops agrees with [`Facts`].
pub fn boundary_loops<M: Representation>(polygons: &PolygonMesh) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let mesh = &subject.mesh;
    check_boundary(mesh, M::NAME);
    let counts = mesh.edge_face_counts();
    for edge in subject.oracle.edges() {
        let expected = subject.oracle.answer(Relation::EdgeFaces, edge).len();
        let got = counts[subject.handles.edge(edge)];
        assert_eq!(
            usize::from(got),
            expected.min(255),
            "{}: edge_face_counts of {edge}",
            M::NAME
        );
    }
    if let Some(count) = Facts::from_polygons(&subject.input).boundary_loops {
        let loops = mesh.boundary_loops();
        assert_eq!(loops.len(), count, "{}: number of boundary_loops", M::NAME);
        assert!(
            loops.iter().all(|chain| chain.is_closed()),
            "{}: boundary_loops of a mesh with manifold edges are {loops:?}, expected closed loops",
            M::NAME
        );
    }
}

/// Each iterator yields the same items by `next` and by `fold`. After some calls of `next`, `fold`
/// yields the remaining items.
pub fn folds<M: Representation>(polygons: &PolygonMesh) {
    if let Some(subject) = Subject::<M>::from_polygons(polygons) {
        check_folds(&subject.mesh, M::NAME);
    }
}

fn check_sets<M: Representation>(polygons: &PolygonMesh, relation: Relation) {
    let Some(subject) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    for element in subject.oracle.domain(relation) {
        check_relation(&subject, relation, element);
    }
}

/// Checks that `relation` of `element` yields each item of the oracle's set once.
pub(crate) fn check_relation<M: Representation>(
    subject: &Subject<M>,
    relation: Relation,
    element: Element,
) {
    let name = M::NAME;
    let mut got = subject.query(relation, element);
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

fn edge_between(a: Element, b: Element) -> Element {
    match (a, b) {
        (Element::Vertex(a), Element::Vertex(b)) => Element::edge(a, b),
        _ => unreachable!("corners are vertices"),
    }
}

pub(crate) fn is_rotation<T: PartialEq>(a: &[T], b: &[T]) -> bool {
    let rotated = |start: usize| b[start..].iter().chain(&b[..start]);
    a.len() == b.len() && (a.is_empty() || (0..b.len()).any(|start| rotated(start).eq(a)))
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

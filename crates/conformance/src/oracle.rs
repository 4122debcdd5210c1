//! All expected answers, computed from the input faces only.

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::{FaceId, PolygonMesh, Relation, VertexId};

use crate::element::Element;

/// The expected answer of each query, computed by brute force from lists of corners.
///
/// The code is slow and simple on purpose. The oracle takes the relation FV from the input, and
/// computes FE from FV. For the other seven relations, the oracle collects the edges and corners of
/// the faces in ordered sets. The oracle uses no structure and no incidence code of `sixfold-core`.
#[derive(Clone, Debug)]
pub struct Oracle {
    vertices: usize,
    faces: Vec<Vec<VertexId>>,
    edges: BTreeSet<Element>,
    answers: BTreeMap<(Relation, Element), Vec<Element>>,
}

impl Oracle {
    /// Computes all nine relations of `polygons`.
    pub fn new(polygons: &PolygonMesh) -> Self {
        let faces: Vec<Vec<VertexId>> = polygons
            .faces()
            .iter()
            .map(|(_, corners)| corners.to_vec())
            .collect();
        let vertices = polygons.vertex_count();
        let (mut sets, mut sides_of_faces) = (Sets::new(), Sets::new());
        let mut answers = BTreeMap::new();
        let mut edges = BTreeSet::new();
        for (f, corners) in (0..).map(FaceId::new).zip(&faces) {
            let face = Element::Face(f);
            let sides = sides_of(corners);
            for &v in corners {
                add(&mut sets, Relation::VertexFaces, Element::Vertex(v), face);
            }
            for &(a, b) in &sides {
                let edge = Element::edge(a, b);
                edges.insert(edge);
                add(&mut sides_of_faces, Relation::FaceEdges, face, edge);
                add(&mut sets, Relation::EdgeFaces, edge, face);
                for (end, other) in [(a, b), (b, a)] {
                    let (end, other) = (Element::Vertex(end), Element::Vertex(other));
                    add(&mut sets, Relation::EdgeVertices, edge, end);
                    add(&mut sets, Relation::VertexEdges, end, edge);
                    add(&mut sets, Relation::VertexVertices, end, other);
                }
            }
            let corners: Vec<Element> = corners.iter().map(|&v| Element::Vertex(v)).collect();
            answers.insert((Relation::FaceVertices, face), corners);
            let sides: Vec<Element> = sides.iter().map(|&(a, b)| Element::edge(a, b)).collect();
            answers.insert((Relation::FaceEdges, face), sides);
        }
        let (ends, across) = (Relation::VertexEdges, Relation::EdgeFaces);
        let edge_edges = compose(&sets, &sets, Relation::EdgeVertices, ends);
        let face_faces = compose(&sides_of_faces, &sets, Relation::FaceEdges, across);
        for (relation, sets_of) in [
            (Relation::EdgeEdges, edge_edges),
            (Relation::FaceFaces, face_faces),
        ] {
            sets.extend(sets_of.into_iter().map(|(of, set)| ((relation, of), set)));
        }
        answers.extend(
            sets.into_iter()
                .map(|(key, set)| (key, set.into_iter().collect())),
        );
        Self {
            vertices,
            faces,
            edges,
            answers,
        }
    }

    /// Iterates over all vertices, including isolated vertices.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + Clone {
        (0..self.vertices as u32).map(VertexId::new)
    }

    /// Iterates over all edges.
    pub fn edges(&self) -> impl Iterator<Item = Element> + Clone {
        self.edges.iter().copied()
    }

    /// Iterates over all faces.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + Clone {
        (0..self.faces.len() as u32).map(FaceId::new)
    }

    /// Returns the corners of `f`, in the order of the input.
    ///
    /// # Panics
    ///
    /// Panics if the face does not exist.
    pub fn corners(&self, f: FaceId) -> &[VertexId] {
        &self.faces[f.index()]
    }

    /// Returns all elements for which `relation` can be queried.
    pub fn domain(&self, relation: Relation) -> Vec<Element> {
        use Relation::*;
        match relation {
            VertexVertices | VertexEdges | VertexFaces => {
                self.vertices().map(Element::Vertex).collect()
            }
            EdgeVertices | EdgeEdges | EdgeFaces => self.edges().collect(),
            FaceVertices | FaceEdges | FaceFaces => self.faces().map(Element::Face).collect(),
        }
    }

    /// Returns the answer of `relation` for `element`. The answers of FV and FE have the order of
    /// the input, and the answers of the other relations are sorted.
    pub fn answer(&self, relation: Relation, element: Element) -> &[Element] {
        let answer = self.answers.get(&(relation, element));
        answer.map_or(&[], Vec::as_slice)
    }

    /// Returns true if `v` is an end of a boundary edge.
    pub fn is_boundary(&self, v: VertexId) -> bool {
        let edges = self.answer(Relation::VertexEdges, Element::Vertex(v));
        edges
            .iter()
            .any(|&edge| self.answer(Relation::EdgeFaces, edge).len() == 1)
    }

    /// Returns the one-ring of `v`, counter-clockwise, and whether the ring is closed. Returns
    /// `None` if the faces at `v` do not form one oriented fan.
    ///
    /// A closed ring starts at its lowest vertex. An isolated vertex has an empty, open ring.
    pub fn one_ring(&self, v: VertexId) -> Option<(Vec<VertexId>, bool)> {
        let mut steps = BTreeMap::new();
        let mut targets = BTreeSet::new();
        for corners in self.faces.iter().filter(|corners| corners.contains(&v)) {
            let degree = corners.len();
            let at = corners.iter().position(|&corner| corner == v)?;
            let (after, before) = (
                corners[(at + 1) % degree],
                corners[(at + degree - 1) % degree],
            );
            let repeated = steps.insert(after, before).is_some();
            if repeated || !targets.insert(before) {
                return None;
            }
        }
        let boundary_start = steps.keys().find(|from| !targets.contains(from));
        let closed = boundary_start.is_none() && !steps.is_empty();
        let Some(&start) = boundary_start.or(steps.keys().next()) else {
            return Some((Vec::new(), false));
        };
        let mut ring = vec![start];
        let mut at = start;
        while let Some(next) = steps.remove(&at) {
            at = next;
            if at != start {
                ring.push(at);
            }
        }
        steps.is_empty().then_some((ring, closed))
    }
}

type Sets = BTreeMap<(Relation, Element), BTreeSet<Element>>;

fn add(sets: &mut Sets, relation: Relation, of: Element, item: Element) {
    sets.entry((relation, of)).or_default().insert(item);
}

/// Applies `first` and then `second` to each element, and removes the element from the result.
fn compose(
    from: &Sets,
    sets: &Sets,
    first: Relation,
    second: Relation,
) -> Vec<(Element, BTreeSet<Element>)> {
    let starts = from.iter().filter(|((relation, _), _)| *relation == first);
    let joined = starts.map(|(&(_, element), between)| {
        let reached = between.iter().flat_map(|&item| &sets[&(second, item)]);
        let others = reached.copied().filter(|&other| other != element);
        (element, others.collect())
    });
    joined.collect()
}

pub(crate) fn sides_of(corners: &[VertexId]) -> Vec<(VertexId, VertexId)> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().copied().zip(next.copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold_core::Point;

    #[test]
    fn two_triangles_by_hand() {
        //   v3 ─── v2
        //    │  f1╱ │
        //    │  ╱f0 │
        //   v0 ─── v1
        let square = [Point::ZERO, Point::X, Point::ONE, Point::Y];
        let mesh = PolygonMesh::new(square, [[0, 1, 2], [2, 3, 0]]).expect("valid");
        let oracle = Oracle::new(&mesh);
        let v = VertexId::new;
        let shown = |relation, element| {
            let shown: Vec<String> = oracle
                .answer(relation, element)
                .iter()
                .map(ToString::to_string)
                .collect();
            shown.join(" ")
        };
        let (v0, f0) = (Element::Vertex(v(0)), Element::Face(FaceId::new(0)));
        let diagonal = Element::edge(v(2), v(0));
        assert_eq!(shown(Relation::VertexVertices, v0), "v1 v2 v3");
        assert_eq!(shown(Relation::VertexEdges, v0), "v0–v1 v0–v2 v0–v3");
        assert_eq!(shown(Relation::VertexFaces, v0), "f0 f1");
        assert_eq!(shown(Relation::EdgeVertices, diagonal), "v0 v2");
        assert_eq!(
            shown(Relation::EdgeEdges, diagonal),
            "v0–v1 v0–v3 v1–v2 v2–v3"
        );
        assert_eq!(shown(Relation::EdgeFaces, diagonal), "f0 f1");
        assert_eq!(shown(Relation::FaceVertices, f0), "v0 v1 v2");
        assert_eq!(shown(Relation::FaceEdges, f0), "v0–v1 v1–v2 v0–v2");
        assert_eq!(shown(Relation::FaceFaces, f0), "f1");
        assert_eq!(oracle.one_ring(v(0)), Some((vec![v(1), v(2), v(3)], false)));
        assert_eq!(oracle.edges().count(), 5);
    }
}

//! Computes the facts of a small mesh by their definitions in TRUTH.md.

use std::collections::{BTreeMap, BTreeSet};

use sixfold::{Distribution, FaceId, Facts, PolygonMesh, Relation, VertexId};
use sixfold_conformance::{Element, Oracle};

/// Returns the expected result of [`Facts::from_polygons`].
pub(crate) fn facts(polygons: &PolygonMesh) -> Facts {
    let oracle = Oracle::new(polygons);
    let mesh = Incidence::new(&oracle);
    let faces: Vec<FaceId> = oracle.faces().collect();
    let edges: Vec<Element> = oracle.edges().collect();
    let vertices: Vec<VertexId> = oracle.vertices().collect();
    let valence = |v: VertexId| {
        oracle
            .answer(Relation::VertexEdges, Element::Vertex(v))
            .len()
    };
    let used: Vec<VertexId> = vertices
        .iter()
        .copied()
        .filter(|&v| valence(v) > 0)
        .collect();
    let edges_of = |has_count: fn(usize) -> bool| {
        let chosen = edges.iter().copied();
        chosen
            .filter(|&e| has_count(mesh.faces_on(e).len()))
            .collect::<Vec<_>>()
    };
    let boundary = edges_of(|faces| faces == 1);
    let non_manifold = edges_of(|faces| faces > 2);
    let touches = |v: VertexId, e: &Element| matches!(e, Element::Edge(a, b) if *a == v || *b == v);
    let not_manifold =
        |v: &VertexId| mesh.fans[v].len() > 1 || non_manifold.iter().any(|e| touches(*v, e));
    let inconsistent = edges.iter().filter(|&&e| mesh.is_inconsistent(e)).count();
    let any = !faces.is_empty();
    let components = mesh.components();
    let orientable = mesh.is_orientable(&components);
    let loops = non_manifold.is_empty().then(|| mesh.loops(&boundary));
    let genus = loops.as_ref().filter(|_| any && orientable).map(|loops| {
        let genera = components
            .iter()
            .map(|component| mesh.genus(component, loops));
        genera.sum()
    });
    let sets: BTreeSet<BTreeSet<VertexId>> = faces
        .iter()
        .map(|&f| oracle.corners(f).iter().copied().collect())
        .collect();
    Facts {
        vertices: vertices.len(),
        edges: edges.len(),
        faces: faces.len(),
        euler_characteristic: used.len() as i64 - edges.len() as i64 + faces.len() as i64,
        components: components.len(),
        boundary_edges: boundary.len(),
        boundary_loops: loops.map(|loops| loops.len()),
        non_manifold_edges: non_manifold.len(),
        non_manifold_vertices: used.iter().filter(|v| not_manifold(v)).count(),
        inconsistent_edges: inconsistent,
        consistently_oriented: any.then_some(inconsistent == 0),
        orientable: any.then_some(orientable),
        closed: any && boundary.is_empty(),
        genus,
        isolated_vertices: vertices.len() - used.len(),
        duplicate_faces: faces.len() - sets.len(),
        degenerate_faces: 0,
        valence: spread(used.iter().map(|&v| valence(v)).collect()),
        face_degree: spread(faces.iter().map(|&f| oracle.corners(f).len()).collect()),
    }
}

/// The faces at the edges and vertices of a mesh.
struct Incidence<'a> {
    oracle: &'a Oracle,
    /// The fans at each vertex. Faces that share an edge at the vertex are in one fan.
    fans: BTreeMap<VertexId, Vec<Vec<FaceId>>>,
}

impl<'a> Incidence<'a> {
    fn new(oracle: &'a Oracle) -> Self {
        let mut mesh = Self {
            oracle,
            fans: BTreeMap::new(),
        };
        mesh.fans = oracle.vertices().map(|v| (v, mesh.fans_at(v))).collect();
        mesh
    }

    fn faces_on(&self, e: Element) -> Vec<FaceId> {
        faces_of(self.oracle.answer(Relation::EdgeFaces, e))
    }

    fn fans_at(&self, v: VertexId) -> Vec<Vec<FaceId>> {
        let vertex = Element::Vertex(v);
        let faces = faces_of(self.oracle.answer(Relation::VertexFaces, vertex));
        let edges = self.oracle.answer(Relation::VertexEdges, vertex);
        let along: Vec<Vec<FaceId>> = edges.iter().map(|&e| self.faces_on(e)).collect();
        classes(&faces, |f, g| {
            let mut along = along.iter();
            along.any(|faces| faces.contains(&f) && faces.contains(&g))
        })
    }

    /// Returns the connected components: faces that share an edge are in one component.
    fn components(&self) -> Vec<Vec<FaceId>> {
        let faces: Vec<FaceId> = self.oracle.faces().collect();
        classes(&faces, |f, g| {
            let across = self.oracle.answer(Relation::FaceFaces, Element::Face(f));
            across.contains(&Element::Face(g))
        })
    }

    /// Returns whether `f` runs along the edge from the lower vertex to the higher vertex.
    fn runs_upwards(&self, f: FaceId, edge: Element) -> bool {
        let corners = self.oracle.corners(f);
        (0..corners.len()).any(|i| {
            let next = corners[(i + 1) % corners.len()];
            Element::Edge(corners[i], next) == edge
        })
    }

    /// Returns whether `e` has exactly two faces that run along `e` in the same direction.
    fn is_inconsistent(&self, e: Element) -> bool {
        match self.faces_on(e)[..] {
            [f, g] => self.runs_upwards(f, e) == self.runs_upwards(g, e),
            _ => false,
        }
    }

    fn is_orientable(&self, components: &[Vec<FaceId>]) -> bool {
        let pairs: Vec<([FaceId; 2], bool)> = self
            .oracle
            .edges()
            .filter_map(|e| match self.faces_on(e)[..] {
                [f, g] => Some(([f, g], self.is_inconsistent(e))),
                _ => None,
            })
            .collect();
        let mut is_reversed: BTreeMap<FaceId, bool> = BTreeMap::new();
        for &start in components.iter().flatten() {
            // No step has reached this face, so the face is not flipped.
            is_reversed.entry(start).or_insert(false);
            let mut changed = true;
            while changed {
                changed = false;
                for &([f, g], differ) in &pairs {
                    for (f, g) in [(f, g), (g, f)] {
                        if let Some(&reversed) = is_reversed.get(&f)
                            && !is_reversed.contains_key(&g)
                        {
                            is_reversed.insert(g, reversed ^ differ);
                            changed = true;
                        }
                    }
                }
            }
        }
        pairs
            .iter()
            .all(|&([f, g], differ)| is_reversed[&f] ^ is_reversed[&g] == differ)
    }

    /// Returns the boundary edges in groups. Edges that meet in one fan are in one group.
    fn loops(&self, boundary: &[Element]) -> Vec<Vec<Element>> {
        classes(boundary, |e, g| {
            let (Element::Edge(a, b), Element::Edge(c, d)) = (e, g) else {
                return false;
            };
            let ends = [a, b].into_iter().filter(|v| [c, d].contains(v));
            ends.into_iter().any(|v| {
                let contains_both =
                    |fan: &Vec<FaceId>| [e, g].iter().all(|&e| fan.contains(&self.faces_on(e)[0]));
                self.fans[&v].iter().any(contains_both)
            })
        })
    }

    /// Returns the genus of an orientable component. A vertex counts once for each of its fans.
    fn genus(&self, component: &[FaceId], loops: &[Vec<Element>]) -> i64 {
        let inside = |f: &FaceId| component.contains(f);
        let fans = self.oracle.vertices().flat_map(|v| &self.fans[&v]);
        let fans = fans.filter(|fan| inside(&fan[0])).count() as i64;
        let edges = self
            .oracle
            .edges()
            .filter(|&e| inside(&self.faces_on(e)[0]))
            .count() as i64;
        let loops = loops
            .iter()
            .filter(|l| inside(&self.faces_on(l[0])[0]))
            .count() as i64;
        let double_genus = 2 - (fans - edges + component.len() as i64) - loops;
        assert_eq!(double_genus % 2, 0, "the genus must be an integer");
        double_genus / 2
    }
}

fn faces_of(elements: &[Element]) -> Vec<FaceId> {
    let faces = elements.iter().filter_map(|element| match element {
        Element::Face(f) => Some(*f),
        _ => None,
    });
    faces.collect()
}

/// Returns the connected components of the relation `linked`.
fn classes<T: Copy + PartialEq>(items: &[T], linked: impl Fn(T, T) -> bool) -> Vec<Vec<T>> {
    let mut rest = items.to_vec();
    let mut classes = Vec::new();
    while let Some(start) = rest.pop() {
        let mut class = vec![start];
        let mut next = 0;
        while let Some(&at) = class.get(next) {
            let (near, far): (Vec<T>, Vec<T>) = rest.iter().partition(|&&item| linked(at, item));
            class.extend(near);
            rest = far;
            next += 1;
        }
        classes.push(class);
    }
    classes
}

fn spread(values: Vec<usize>) -> Option<Distribution> {
    let mut hist = BTreeMap::new();
    for &value in &values {
        *hist.entry(value).or_insert(0) += 1;
    }
    Some(Distribution {
        min: *values.iter().min()?,
        max: *values.iter().max()?,
        mean: values.iter().sum::<usize>() as f64 / values.len() as f64,
        hist: (hist.len() <= 64).then_some(hist),
    })
}

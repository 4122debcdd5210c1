//! A mesh under test: the structure, the oracle, and maps between handles and input numbers.

use std::collections::BTreeMap;
use std::fmt::Debug;

use sixfold_core::{FaceId, MeshQuery, PolygonMesh, Relation, Representation, VertexId};

use crate::element::Element;
use crate::oracle::Oracle;
use crate::weld::{weld_numbers, welded};

/// A structure built from polygons, and its expected answers.
pub(crate) struct Subject<M: Representation> {
    pub(crate) mesh: M,
    /// The input, welded if the structure identifies vertices by their coordinates.
    pub(crate) input: PolygonMesh,
    pub(crate) oracle: Oracle,
    pub(crate) names: Names<M>,
}

impl<M: Representation> Subject<M> {
    /// Builds `M` from `polygons`; `None` if its capabilities exclude them.
    ///
    /// An error for a mesh that the capabilities include is a failure of the test.
    pub(crate) fn of(polygons: &PolygonMesh) -> Option<Self> {
        M::CAPABILITIES.check(polygons).ok()?;
        let mesh = M::from_polygons(polygons);
        let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a supported mesh: {e}", M::NAME));
        Some(Self::built(mesh, polygons))
    }

    /// Wraps `mesh`, which should hold `polygons`.
    pub(crate) fn built(mesh: M, polygons: &PolygonMesh) -> Self {
        let input = held::<M>(polygons);
        Self {
            oracle: Oracle::of(&input),
            names: Names::of(&mesh, polygons, &input),
            mesh,
            input,
        }
    }

    /// Queries `relation` of `element`.
    pub(crate) fn ask(&self, relation: Relation, element: Element) -> Vec<Element> {
        self.names.ask(&self.mesh, relation, element)
    }
}

/// Returns the mesh that `M` holds after it was built from `polygons`, which its capabilities
/// include.
pub(crate) fn held<M: Representation>(polygons: &PolygonMesh) -> PolygonMesh {
    if M::CAPABILITIES.coincident_vertices {
        return polygons.clone();
    }
    welded(polygons).expect("the capabilities exclude faces with two corners at one point")
}

/// Maps from the elements of the input to the handles of the structure, and back.
pub(crate) struct Names<M: MeshQuery> {
    vertices: BTreeMap<VertexId, M::Vertex>,
    edges: BTreeMap<Element, M::Edge>,
    faces: BTreeMap<FaceId, M::Face>,
    vertex_ids: BTreeMap<M::Vertex, VertexId>,
    edge_ids: BTreeMap<M::Edge, Element>,
    face_ids: BTreeMap<M::Face, FaceId>,
}

impl<M: Representation> Names<M> {
    fn of(mesh: &M, polygons: &PolygonMesh, input: &PolygonMesh) -> Self {
        let numbers = if M::CAPABILITIES.coincident_vertices {
            polygons
                .vertices()
                .map(|v| (v, v.index() as u32))
                .collect::<BTreeMap<_, _>>()
        } else {
            weld_numbers(polygons)
        };
        let named =
            |(v, number): (&VertexId, &u32)| (VertexId::new(*number), M::vertex_name(polygons, *v));
        let vertices: BTreeMap<_, _> = numbers.iter().map(named).collect();
        let faces = input.faces().iter().map(|(f, _)| f);
        let faces: BTreeMap<_, _> = faces.map(|f| (f, M::face_name(polygons, f))).collect();
        let mut names = Self {
            vertex_ids: vertices.iter().map(|(&v, &name)| (name, v)).collect(),
            face_ids: faces.iter().map(|(&f, &name)| (name, f)).collect(),
            vertices,
            faces,
            edges: BTreeMap::new(),
            edge_ids: BTreeMap::new(),
        };
        for e in mesh.edges() {
            let ends = mesh.edge_vertices(e).map(|v| names.vertex_id(v));
            let edge = Element::edge(ends[0], ends[1]);
            names.edges.entry(edge).or_insert(e);
            names.edge_ids.insert(e, edge);
        }
        names
    }

    /// Returns the handle of `v`.
    pub(crate) fn vertex(&self, v: VertexId) -> M::Vertex {
        known(self.vertices.get(&v), M::NAME, v)
    }

    /// Returns the handle of `edge`.
    pub(crate) fn edge(&self, edge: Element) -> M::Edge {
        known(self.edges.get(&edge), M::NAME, edge)
    }

    /// Returns the handle of `f`.
    pub(crate) fn face(&self, f: FaceId) -> M::Face {
        known(self.faces.get(&f), M::NAME, f)
    }

    /// Returns the vertex of the input with the handle `name`.
    pub(crate) fn vertex_id(&self, name: M::Vertex) -> VertexId {
        known(self.vertex_ids.get(&name), M::NAME, name)
    }

    /// Returns the edge of the input with the handle `name`.
    pub(crate) fn edge_id(&self, name: M::Edge) -> Element {
        known(self.edge_ids.get(&name), M::NAME, name)
    }

    /// Returns the face of the input with the handle `name`.
    pub(crate) fn face_id(&self, name: M::Face) -> FaceId {
        known(self.face_ids.get(&name), M::NAME, name)
    }

    /// Queries `relation` of `element`, and converts the answer to input numbers, in the order of
    /// the structure.
    ///
    /// The answer is empty if `relation` does not apply to this kind of element.
    pub(crate) fn ask<Q>(&self, mesh: &Q, relation: Relation, element: Element) -> Vec<Element>
    where
        Q: MeshQuery<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
    {
        let vertex = |v| Element::Vertex(self.vertex_id(v));
        let edge = |e| self.edge_id(e);
        let face = |f| Element::Face(self.face_id(f));
        match (relation, element) {
            (Relation::VertexVertices, Element::Vertex(v)) => {
                mesh.vertex_vertices(self.vertex(v)).map(vertex).collect()
            }
            (Relation::VertexEdges, Element::Vertex(v)) => {
                mesh.vertex_edges(self.vertex(v)).map(edge).collect()
            }
            (Relation::VertexFaces, Element::Vertex(v)) => {
                mesh.vertex_faces(self.vertex(v)).map(face).collect()
            }
            (Relation::EdgeVertices, Element::Edge(..)) => {
                let ends = mesh.edge_vertices(self.edge(element));
                ends.map(vertex).to_vec()
            }
            (Relation::EdgeEdges, Element::Edge(..)) => {
                mesh.edge_edges(self.edge(element)).map(edge).collect()
            }
            (Relation::EdgeFaces, Element::Edge(..)) => {
                mesh.edge_faces(self.edge(element)).map(face).collect()
            }
            (Relation::FaceVertices, Element::Face(f)) => {
                mesh.face_vertices(self.face(f)).map(vertex).collect()
            }
            (Relation::FaceEdges, Element::Face(f)) => {
                mesh.face_edges(self.face(f)).map(edge).collect()
            }
            (Relation::FaceFaces, Element::Face(f)) => {
                mesh.face_faces(self.face(f)).map(face).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Returns the one-ring of `v`, converted to input numbers.
    pub(crate) fn ring<Q>(&self, mesh: &Q, v: VertexId) -> Option<Vec<VertexId>>
    where
        Q: MeshQuery<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
    {
        let ring = mesh.one_ring(self.vertex(v))?;
        Some(ring.map(|u| self.vertex_id(u)).collect())
    }
}

fn known<T: Copy>(entry: Option<&T>, structure: &str, name: impl Debug) -> T {
    match entry {
        Some(&entry) => entry,
        None => panic!("{structure} and the input do not share an element {name:?}"),
    }
}

//! A mesh under test: the structure, the oracle, and maps between handles and the numbers of the
//! input.

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
    pub(crate) handles: HandleMap<M>,
}

impl<M: Representation> Subject<M> {
    /// Builds `M` from `polygons`. Returns `None` if the capabilities of `M` exclude this mesh.
    pub(crate) fn from_polygons(polygons: &PolygonMesh) -> Option<Self> {
        M::CAPABILITIES.check(polygons).ok()?;
        let mesh = M::from_polygons(polygons);
        let mesh = mesh.unwrap_or_else(|e| panic!("{} refuses a supported mesh: {e}", M::NAME));
        Some(Self::from_mesh(mesh, polygons))
    }

    pub(crate) fn from_mesh(mesh: M, polygons: &PolygonMesh) -> Self {
        let input = stored_mesh::<M>(polygons);
        Self {
            oracle: Oracle::new(&input),
            handles: HandleMap::new(&mesh, polygons, &input),
            mesh,
            input,
        }
    }

    pub(crate) fn query(&self, relation: Relation, element: Element) -> Vec<Element> {
        self.handles.query(&self.mesh, relation, element)
    }
}

/// Returns the polygons that `M` stores for `polygons`. The capabilities of `M` must include
/// `polygons`.
pub(crate) fn stored_mesh<M: Representation>(polygons: &PolygonMesh) -> PolygonMesh {
    if M::CAPABILITIES.coincident_vertices {
        return polygons.clone();
    }
    welded(polygons).expect("the capabilities exclude faces with two corners at one point")
}

/// Maps from the elements of the input to the handles of the structure, and back.
pub(crate) struct HandleMap<M: MeshQuery> {
    vertices: BTreeMap<VertexId, M::Vertex>,
    edges: BTreeMap<Element, M::Edge>,
    faces: BTreeMap<FaceId, M::Face>,
    vertex_ids: BTreeMap<M::Vertex, VertexId>,
    edge_ids: BTreeMap<M::Edge, Element>,
    face_ids: BTreeMap<M::Face, FaceId>,
}

impl<M: Representation> HandleMap<M> {
    fn new(mesh: &M, polygons: &PolygonMesh, input: &PolygonMesh) -> Self {
        let numbers = if M::CAPABILITIES.coincident_vertices {
            polygons
                .vertices()
                .map(|v| (v, v.index() as u32))
                .collect::<BTreeMap<_, _>>()
        } else {
            weld_numbers(polygons)
        };
        let pair = |(v, number): (&VertexId, &u32)| {
            (VertexId::new(*number), M::vertex_handle(polygons, *v))
        };
        let vertices: BTreeMap<_, _> = numbers.iter().map(pair).collect();
        let faces = input.faces().iter().map(|(f, _)| f);
        let faces: BTreeMap<_, _> = faces.map(|f| (f, M::face_handle(polygons, f))).collect();
        let mut maps = Self {
            vertex_ids: vertices.iter().map(|(&v, &handle)| (handle, v)).collect(),
            face_ids: faces.iter().map(|(&f, &handle)| (handle, f)).collect(),
            vertices,
            faces,
            edges: BTreeMap::new(),
            edge_ids: BTreeMap::new(),
        };
        for e in mesh.edges() {
            let ends = mesh.edge_vertices(e).map(|v| maps.vertex_id(v));
            let edge = Element::edge(ends[0], ends[1]);
            maps.edges.entry(edge).or_insert(e);
            maps.edge_ids.insert(e, edge);
        }
        maps
    }

    pub(crate) fn vertex(&self, v: VertexId) -> M::Vertex {
        lookup(self.vertices.get(&v), M::NAME, v)
    }

    pub(crate) fn edge(&self, edge: Element) -> M::Edge {
        lookup(self.edges.get(&edge), M::NAME, edge)
    }

    pub(crate) fn face(&self, f: FaceId) -> M::Face {
        lookup(self.faces.get(&f), M::NAME, f)
    }

    pub(crate) fn vertex_id(&self, handle: M::Vertex) -> VertexId {
        lookup(self.vertex_ids.get(&handle), M::NAME, handle)
    }

    pub(crate) fn edge_id(&self, handle: M::Edge) -> Element {
        lookup(self.edge_ids.get(&handle), M::NAME, handle)
    }

    pub(crate) fn face_id(&self, handle: M::Face) -> FaceId {
        lookup(self.face_ids.get(&handle), M::NAME, handle)
    }

    /// Queries `relation` of `element`, and converts the answer to input numbers. The answer keeps
    /// the order of the structure.
    pub(crate) fn query<Q>(&self, mesh: &Q, relation: Relation, element: Element) -> Vec<Element>
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

    pub(crate) fn ring<Q>(&self, mesh: &Q, v: VertexId) -> Option<Vec<VertexId>>
    where
        Q: MeshQuery<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
    {
        let ring = mesh.one_ring(self.vertex(v))?;
        Some(ring.map(|u| self.vertex_id(u)).collect())
    }

    pub(crate) fn ring_with_faces<Q>(
        &self,
        mesh: &Q,
        v: VertexId,
    ) -> Option<Vec<(VertexId, Option<FaceId>)>>
    where
        Q: MeshQuery<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face>,
    {
        let ring = mesh.one_ring_with_faces(self.vertex(v))?;
        let ids =
            |(u, f): (M::Vertex, Option<M::Face>)| (self.vertex_id(u), f.map(|f| self.face_id(f)));
        Some(ring.map(ids).collect())
    }
}

fn lookup<T: Copy>(entry: Option<&T>, structure: &str, key: impl Debug) -> T {
    match entry {
        Some(&entry) => entry,
        None => panic!("{structure} and the input do not share an element {key:?}"),
    }
}

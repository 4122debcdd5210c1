//! Names of the elements of a mesh: `v3`, `v0-v1` and `f2`.

use std::collections::HashMap;
use std::fmt;
use std::str::FromStr;

use sixfold::{MeshQuery, PolygonMesh, Representation};
use sixfold_core::{Described, Element, FaceId, VertexId, row};

use crate::structure::ExplainError;

/// The name of an element: the numbers are those of the mesh file, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementName {
    /// A vertex: `v3`.
    Vertex(u32),
    /// An edge, by its ends: `v0-v1`.
    Edge([u32; 2]),
    /// A face: `f2`.
    Face(u32),
}

impl ElementName {
    /// Returns `vertex`, `edge` or `face`.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Vertex(_) => "vertex",
            Self::Edge(_) => "edge",
            Self::Face(_) => "face",
        }
    }
}

impl fmt::Display for ElementName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => write!(f, "v{v}"),
            Self::Edge([a, b]) => write!(f, "v{a}-v{b}"),
            Self::Face(face) => write!(f, "f{face}"),
        }
    }
}

impl FromStr for ElementName {
    type Err = ExplainError;

    fn from_str(text: &str) -> Result<Self, ExplainError> {
        let number = |text: &str, letter| text.strip_prefix(letter)?.parse().ok();
        let edge = || {
            let (a, b) = text.split_once('-')?;
            Some(Self::Edge([number(a, 'v')?, number(b, 'v')?]))
        };
        let vertex = || number(text, 'v').map(Self::Vertex);
        let face = || number(text, 'f').map(Self::Face);
        let element = vertex().or_else(face).or_else(edge);
        element.ok_or_else(|| ExplainError::BadName { name: text.into() })
    }
}

/// A structure that was built from a mesh, with the names of its elements.
pub(crate) struct Named<'p, M: MeshQuery> {
    pub(crate) polygons: &'p PolygonMesh,
    pub(crate) mesh: M,
    vertices: HashMap<M::Vertex, u32>,
    faces: HashMap<M::Face, u32>,
}

impl<'p, M: Representation + Described> Named<'p, M> {
    pub(crate) fn new(polygons: &'p PolygonMesh) -> Result<Self, ExplainError> {
        let mesh = M::from_polygons(polygons).map_err(|refusal| ExplainError::Refused {
            structure: M::NAME,
            refusal,
        })?;
        let vertices = (0..row(polygons.vertex_count())).rev();
        let faces = 0..row(polygons.face_count());
        Ok(Self {
            polygons,
            mesh,
            vertices: vertices
                .map(|v| (M::vertex_handle(polygons, VertexId::new(v)), v))
                .collect(),
            faces: faces
                .map(|f| (M::face_handle(polygons, FaceId::new(f)), f))
                .collect(),
        })
    }

    fn missing(name: ElementName) -> ExplainError {
        ExplainError::NoSuchElement {
            structure: M::NAME,
            name,
        }
    }

    fn vertex(&self, name: ElementName, v: u32) -> Result<M::Vertex, ExplainError> {
        if v as usize >= self.polygons.vertex_count() {
            return Err(Self::missing(name));
        }
        let handle = M::vertex_handle(self.polygons, VertexId::new(v));
        match self.mesh.contains_vertex(handle) {
            true => Ok(handle),
            false => Err(Self::missing(name)),
        }
    }

    /// Returns the handle of an element of the mesh.
    pub(crate) fn handle(&self, name: ElementName) -> Result<Element<M>, ExplainError> {
        match name {
            ElementName::Vertex(v) => self.vertex(name, v).map(Element::Vertex),
            ElementName::Edge([a, b]) => {
                let [a, b] = [self.vertex(name, a)?, self.vertex(name, b)?];
                let edge = self.mesh.edge_between(a, b);
                edge.map(Element::Edge).ok_or_else(|| Self::missing(name))
            }
            ElementName::Face(f) if (f as usize) < self.polygons.face_count() => {
                Ok(Element::Face(M::face_handle(self.polygons, FaceId::new(f))))
            }
            ElementName::Face(_) => Err(Self::missing(name)),
        }
    }

    /// Returns the name of an element: of an edge also its row, such as `e4 = v0-v1`.
    pub(crate) fn name(&self, element: Element<M>) -> String {
        match element {
            Element::Vertex(v) => ElementName::Vertex(self.vertices[&v]).to_string(),
            Element::Face(f) => ElementName::Face(self.faces[&f]).to_string(),
            Element::Edge(e) => {
                let ends = self.mesh.edge_vertices(e).map(|v| self.vertices[&v]);
                let [a, b] = ends;
                let pair = ElementName::Edge([a.min(b), a.max(b)]);
                let rows = self.mesh.rows_of(element);
                match rows.first().filter(|row| row.letter != "v") {
                    Some(row) => format!("{row} = {pair}"),
                    None => pair.to_string(),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for text in ["v0", "v12", "f3", "v1-v0", "v4294967295"] {
            let name: ElementName = text.parse().expect("a name");
            assert_eq!(name.to_string(), text);
        }
        for text in [
            "",
            "v",
            "3",
            "e4",
            "v-1",
            "v1-",
            "v1-f2",
            "v1-v2-v3",
            "v4294967296",
            "f1-f2",
        ] {
            let error = text.parse::<ElementName>().expect_err(text);
            assert!(error.to_string().contains("v0-v1"), "{error}");
        }
    }
}

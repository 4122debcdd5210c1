//! A structure that was built from a mesh, with the names of its elements and a probe.

use std::collections::HashMap;

use sixfold::{PolygonMesh, Representation};
use sixfold_core::{
    Described, Element, ElementName, ElementNames, Field, Measured, MemoryFootprint, RecordTable,
    RowName, Traced,
};

use crate::error::ExplainError;

/// A structure that was built from a mesh. A probe records all reads, also those of descriptions, so the
/// log is emptied before a query and after each description.
pub(crate) struct NamedMesh<P: Described> {
    /// The name of the structure.
    pub(crate) structure: &'static str,
    pub(crate) mesh: P,
    pub(crate) probe: Traced,
    /// The tables before edits.
    pub(crate) memory: MemoryFootprint,
    /// The bytes of a row, by the name of the table.
    pub(crate) row_bytes: HashMap<String, usize>,
    pub(crate) names: ElementNames<P::Vertex, P::Face>,
    /// True if an edit has given an element another handle.
    pub(crate) has_moved: bool,
}

/// The tables of a mesh of any type. What needs no more is compiled once, and not for each structure.
pub(crate) trait RecordSource {
    /// Calls [`Described::tables`].
    fn record_tables(&self) -> Vec<RecordTable>;

    /// Calls [`Described::record`], with all fields.
    fn fields(&self, table: &str, row: usize) -> Option<Vec<Field>>;

    /// Calls [`Described::record`], without fields that are found by walks.
    fn own_fields(&self, table: &str, row: usize) -> Option<Vec<Field>>;
}

impl<P: Described> RecordSource for P {
    fn record_tables(&self) -> Vec<RecordTable> {
        self.tables()
    }

    fn fields(&self, table: &str, row: usize) -> Option<Vec<Field>> {
        self.record(table, row, true)
    }

    fn own_fields(&self, table: &str, row: usize) -> Option<Vec<Field>> {
        self.record(table, row, false)
    }
}

/// Builds the structure `M` from `polygons`. O(corners).
pub(crate) fn named_mesh<M>(
    polygons: &PolygonMesh,
) -> Result<NamedMesh<M::Probed<Traced>>, ExplainError>
where
    M: Representation + Measured,
    M::Probed<Traced>: Described,
{
    let mesh = M::from_polygons(polygons).map_err(|refusal| ExplainError::Refused {
        structure: M::NAME,
        room: M::Probed::<Traced>::no_room(&refusal),
        refusal,
    })?;
    let memory = mesh.memory();
    let tables = memory.tables.iter();
    let row_bytes = tables.map(|table| (table.table.to_string(), table.row_bytes));
    let row_bytes = row_bytes.collect();
    let probe = Traced::default();
    Ok(NamedMesh {
        structure: M::NAME,
        mesh: mesh.probed(probe.clone()),
        probe,
        memory,
        row_bytes,
        names: ElementNames::new::<M>(polygons),
        has_moved: false,
    })
}

impl<P: Described> NamedMesh<P> {
    pub(crate) fn missing(&self, name: ElementName) -> ExplainError {
        ExplainError::NoSuchElement {
            structure: self.structure,
            name,
        }
    }

    /// Returns the handle of an element.
    pub(crate) fn handle(&self, name: ElementName) -> Result<Element<P>, ExplainError> {
        match name {
            ElementName::Vertex(_) => self.vertex(name).map(Element::Vertex),
            ElementName::Edge(_) => self.edge(name).map(Element::Edge),
            ElementName::Face(_) => self.face(name).map(Element::Face),
        }
    }

    pub(crate) fn vertex(&self, name: ElementName) -> Result<P::Vertex, ExplainError> {
        let handle = match name {
            ElementName::Vertex(v) => self.names.vertex(v),
            _ => None,
        };
        handle.ok_or_else(|| self.missing(name))
    }

    pub(crate) fn edge(&self, name: ElementName) -> Result<P::Edge, ExplainError> {
        let ElementName::Edge(ends) = name else {
            return Err(self.missing(name));
        };
        let [a, b] = ends.map(|v| self.names.vertex(v).ok_or_else(|| self.missing(name)));
        let edge = self.mesh.edge_between(a?, b?);
        edge.ok_or_else(|| self.missing(name))
    }

    pub(crate) fn face(&self, name: ElementName) -> Result<P::Face, ExplainError> {
        let handle = match name {
            ElementName::Face(f) => self.names.face(f),
            _ => None,
        };
        handle.ok_or_else(|| self.missing(name))
    }

    /// Returns the rows of vertices and faces whose elements have other numbers: the name of the row, and the
    /// name of the element. An element with several names has the lowest.
    pub(crate) fn moved_rows(&self) -> Vec<[String; 2]> {
        if !self.has_moved {
            return Vec::new();
        }
        let mut moved = Vec::new();
        let mut add = |letter: char, number: usize, rows: Vec<RowName>| {
            let rows = rows
                .into_iter()
                .filter(|name| name.letter.starts_with(letter));
            let rows = rows.filter(|name| name.row as usize != number);
            moved.extend(rows.map(|name| [name.to_string(), format!("{letter}{number}")]));
        };
        for (number, handle) in self.names.vertices().iter().enumerate() {
            if let &Some(v) = handle {
                add('v', number, self.mesh.rows_of(Element::Vertex(v)));
            }
        }
        for (number, handle) in self.names.faces().iter().enumerate() {
            if let &Some(f) = handle {
                add('f', number, self.mesh.rows_of(Element::Face(f)));
            }
        }
        moved
    }

    /// Returns the number of a vertex of the mesh.
    pub(crate) fn vertex_number(&self, v: P::Vertex) -> u32 {
        let number = self.names.vertex_number(v);
        number.expect("all vertices of the mesh have names")
    }

    /// Returns the name of an element: of an edge also its row, such as `e4 = v0-v1`.
    pub(crate) fn name(&self, element: Element<P>) -> String {
        match element {
            Element::Vertex(v) => format!("v{}", self.vertex_number(v)),
            Element::Face(f) => {
                let number = self.names.face_number(f);
                format!("f{}", number.expect("all faces of the mesh have names"))
            }
            Element::Edge(e) => {
                let [a, b] = (self.mesh.edge_vertices(e)).map(|v| self.vertex_number(v));
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

//! A structure that was built from a mesh, with the names of its elements and a probe.

use std::collections::HashMap;

use rustc_hash::{FxHashMap, FxHashSet};
use sixfold::{Changes, PolygonMesh, Representation};
use sixfold_core::{
    Described, Element, FaceId, Field, Handle, Measured, RecordTable, RowName, Traced, VertexId,
    row,
};
use smallvec::SmallVec;

use crate::element::ElementName;
use crate::error::ExplainError;

/// A structure that was built from a mesh. A probe records all reads, also those of descriptions, so the
/// log is emptied before a query and after each description.
pub(crate) struct NamedMesh<P: Described> {
    /// The name of the structure.
    pub(crate) structure: &'static str,
    pub(crate) mesh: P,
    pub(crate) probe: Traced,
    /// The bytes of a row, by the name of the table.
    pub(crate) row_bytes: HashMap<String, usize>,
    pub(crate) vertices: Names<P::Vertex>,
    pub(crate) faces: Names<P::Face>,
}

/// The tables of a mesh of any type. What needs no more is compiled once, and not for each structure.
pub(crate) trait RecordSource {
    /// Calls [`Described::tables`].
    fn record_tables(&self) -> Vec<RecordTable>;

    /// Calls [`Described::record`].
    fn fields(&self, table: &str, row: usize) -> Option<Vec<Field>>;
}

impl<P: Described> RecordSource for P {
    fn record_tables(&self) -> Vec<RecordTable> {
        self.tables()
    }

    fn fields(&self, table: &str, row: usize) -> Option<Vec<Field>> {
        self.record(table, row)
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
        refusal,
    })?;
    let vertices = (0..row(polygons.vertex_count())).map(VertexId::new);
    let vertices = vertices.map(|v| M::vertex_handle(polygons, v));
    // A soup has no vertex without a face.
    let held: FxHashSet<M::Vertex> = mesh.vertices().collect();
    let vertices = Names::new(vertices.map(|v| held.contains(&v).then_some(v)));
    let faces = (0..row(polygons.face_count())).map(FaceId::new);
    let faces = Names::new(faces.map(|f| Some(M::face_handle(polygons, f))));
    let tables = mesh.memory().tables.into_iter();
    let row_bytes = tables.map(|table| (table.table.into_owned(), table.row_bytes));
    let row_bytes = row_bytes.collect();
    let probe = Traced::default();
    Ok(NamedMesh {
        structure: M::NAME,
        mesh: mesh.probed(probe.clone()),
        probe,
        row_bytes,
        vertices,
        faces,
    })
}

impl<P: Described> NamedMesh<P> {
    fn missing(&self, name: ElementName) -> ExplainError {
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
            ElementName::Vertex(v) => self.vertices.handle(v),
            _ => None,
        };
        handle.ok_or_else(|| self.missing(name))
    }

    pub(crate) fn edge(&self, name: ElementName) -> Result<P::Edge, ExplainError> {
        let ElementName::Edge(ends) = name else {
            return Err(self.missing(name));
        };
        let [a, b] = ends.map(|v| self.vertices.handle(v).ok_or_else(|| self.missing(name)));
        let edge = self.mesh.edge_between(a?, b?);
        edge.ok_or_else(|| self.missing(name))
    }

    pub(crate) fn face(&self, name: ElementName) -> Result<P::Face, ExplainError> {
        let handle = match name {
            ElementName::Face(f) => self.faces.handle(f),
            _ => None,
        };
        handle.ok_or_else(|| self.missing(name))
    }

    /// Returns the rows of vertices and faces whose elements have other numbers: the name of the row, and the
    /// name of the element. An element with several names has the lowest.
    pub(crate) fn moved_rows(&self) -> Vec<[String; 2]> {
        if !self.vertices.has_moved && !self.faces.has_moved {
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
        for (number, handle) in self.vertices.handles().iter().enumerate() {
            if let &Some(v) = handle {
                add('v', number, self.mesh.rows_of(Element::Vertex(v)));
            }
        }
        for (number, handle) in self.faces.handles().iter().enumerate() {
            if let &Some(f) = handle {
                add('f', number, self.mesh.rows_of(Element::Face(f)));
            }
        }
        moved
    }

    /// Returns the name of an element: of an edge also its row, such as `e4 = v0-v1`.
    pub(crate) fn name(&self, element: Element<P>) -> String {
        match element {
            Element::Vertex(v) => format!("v{}", self.vertices.number(v)),
            Element::Face(f) => format!("f{}", self.faces.number(f)),
            Element::Edge(e) => {
                let [a, b] = (self.mesh.edge_vertices(e)).map(|v| self.vertices.number(v));
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

/// The handles of the elements of one kind, by number: first those of the mesh, then new ones in the
/// order in which they are made.
pub(crate) struct Names<H> {
    /// `None` if the element was deleted, or if the structure does not have it.
    handles: Vec<Option<H>>,
    /// The numbers of a handle. Vertices of a soup at one position have one handle.
    numbers: FxHashMap<H, SmallVec<[u32; 1]>>,
    /// True if an edit has given an element another handle.
    has_moved: bool,
}

impl<H: Handle> Names<H> {
    fn new(handles: impl Iterator<Item = Option<H>>) -> Self {
        let mut names = Self {
            handles: Vec::new(),
            numbers: FxHashMap::default(),
            has_moved: false,
        };
        handles.for_each(|handle| names.push(handle));
        names
    }

    fn push(&mut self, handle: Option<H>) {
        if let Some(handle) = handle {
            let number = row(self.handles.len());
            self.numbers.entry(handle).or_default().push(number);
        }
        self.handles.push(handle);
    }

    fn handle(&self, number: u32) -> Option<H> {
        self.handles.get(number as usize).copied().flatten()
    }

    /// Returns all handles in the order of the numbers.
    pub(crate) fn handles(&self) -> &[Option<H>] {
        &self.handles
    }

    /// Returns the number of an element of the mesh: the lowest, if it has several.
    pub(crate) fn number(&self, handle: H) -> u32 {
        self.numbers[&handle][0]
    }

    /// Gives the numbers of `old` the handle `new`; `None` if the element was deleted. Returns the
    /// numbers.
    fn replace(&mut self, old: H, new: Option<H>) -> SmallVec<[u32; 1]> {
        let numbers = self.numbers.remove(&old).unwrap_or_default();
        for &number in &numbers {
            self.handles[number as usize] = new;
        }
        numbers
    }

    /// Follows the changes of one edit. Returns the names of new, deleted and renamed elements.
    pub(crate) fn follow(&mut self, letter: char, changes: &Changes<H>) -> Followed {
        let name = |number: u32| format!("{letter}{number}");
        let mut followed = Followed::default();
        for &removed in &changes.removed {
            let numbers = self.replace(removed, None);
            followed.removed.extend(numbers.into_iter().map(name));
        }
        // An element can get the old handle of another, so all old ones are replaced first.
        let renamed = changes.renamed.iter().filter(|[old, new]| old != new);
        let renamed: Vec<_> = renamed
            .map(|&[old, new]| (old, new, self.replace(old, Some(new))))
            .collect();
        self.has_moved |= !renamed.is_empty();
        for (old, new, numbers) in renamed {
            let [old_row, new_row] = [old, new].map(|handle| format!("{handle:?}"));
            let names = numbers.iter().map(|&number| name(number));
            let rows = names.map(|name| [name, old_row.clone(), new_row.clone()]);
            followed.renamed.extend(rows);
            let known = self.numbers.entry(new).or_default();
            known.extend(numbers);
            known.sort_unstable();
        }
        for &created in &changes.created {
            followed.created.push(name(row(self.handles.len())));
            self.push(Some(created));
        }
        followed
    }
}

/// The names of elements that an edit changed.
#[derive(Default)]
pub(crate) struct Followed {
    pub(crate) created: Vec<String>,
    pub(crate) removed: Vec<String>,
    /// The name of the element, and its handle before and after.
    pub(crate) renamed: Vec<[String; 3]>,
}

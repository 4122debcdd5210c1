//! A structure that was built from a mesh, whatever its type.

use std::collections::BTreeSet;
use std::iter;
use std::ops::Range;

use serde::Serialize;
use sixfold::{MeshEdit, PolygonMesh, Relation};
use sixfold_core::{Described, EditByName, ElementName, VertexId};

use crate::edit::EditTrace;
use crate::error::ExplainError;
use crate::memory::Memory;
use crate::named_mesh::NamedMesh;
use crate::records::{Records, RowsOf, records, row_name};
use crate::trace::{Query, Trace, trace};
use crate::walk::{Walk, walk};

/// A structure that was built from a mesh ([`Structure::build`](crate::Structure::build)).
pub struct BuiltMesh(Form);

/// A mesh of any type.
enum Form {
    Fixed(Box<dyn Shown>),
    Editable(Box<dyn Edited>),
}

/// The vertices and faces of a mesh by the numbers of their names. A number whose element was deleted, or
/// which the structure does not have, has `None`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Geometry {
    /// The positions of the vertices.
    pub vertices: Vec<Option<[f32; 3]>>,
    /// The numbers of the corners of the faces.
    pub faces: Vec<Option<Vec<u32>>>,
}

impl Geometry {
    /// Returns the vertices and faces of a mesh. O(corners).
    pub fn from_polygons(polygons: &PolygonMesh) -> Self {
        let positions = polygons.positions().iter();
        let faces = polygons.faces().iter();
        let corners = |face: &[VertexId]| face.iter().map(|v| v.index() as u32).collect();
        Self {
            vertices: positions
                .map(|position| Some(position.to_array()))
                .collect(),
            faces: faces.map(|(_, face)| Some(corners(face))).collect(),
        }
    }
}

impl BuiltMesh {
    /// Returns the records in the rows `rows`, for each kind of element. O(records in `rows`).
    pub fn records(&self, rows: Range<usize>) -> Vec<Records> {
        self.shown()
            .records(&|_, total| (rows.start..rows.end.min(total)).collect())
    }

    /// Returns the records of the rows with these names, such as `h5`, for each kind of element in the
    /// order of the rows. A name that is not that of a row of the structure is ignored.
    /// O(k log k) for k names.
    pub fn named_records<'n>(&self, names: impl IntoIterator<Item = &'n str>) -> Vec<Records> {
        let names: BTreeSet<(&str, u32)> = names.into_iter().filter_map(row_name).collect();
        self.shown().records(&|letter, total| {
            let of_letter = names.range((letter, 0)..=(letter, u32::MAX));
            let rows = of_letter.map(|&(_, row)| row as usize);
            rows.take_while(|&row| row < total).collect()
        })
    }

    /// Returns the rows of vertices and faces that have another number than their element, because an edit
    /// moved them: the name of the row, and the name of the element. O(elements) if an edit moved a row.
    pub fn moved_rows(&self) -> Vec<[String; 2]> {
        self.shown().moved_rows()
    }

    /// Returns those of [`moved_rows`](Self::moved_rows) whose names are in `records`.
    pub(crate) fn moved_rows_in(&self, records: &[Records]) -> Vec<[String; 2]> {
        let mut moved = self.moved_rows();
        if !moved.is_empty() {
            let rows = records.iter().flat_map(|table| &table.rows);
            let names = rows.flat_map(|row| iter::once(&row.name).chain(&row.fields));
            let names: BTreeSet<&String> = names.collect();
            moved.retain(|[row, _]| names.contains(row));
        }
        moved
    }

    /// Runs one query, and returns its reads and results.
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::NoSuchElement`] if the mesh does not have the element, and
    /// [`ExplainError::WrongKind`] if the relation starts from another kind of element.
    pub fn trace(&self, relation: Relation, element: ElementName) -> Result<Trace, ExplainError> {
        self.shown().trace(relation, element)
    }

    /// Runs a walk in the words of the structure: the names of its fields. Compares the results with the
    /// relation `expected`.
    ///
    /// ```text
    /// h = leaving(v3); repeat { yield target(h); h = next(twin(h)) }
    /// ```
    ///
    /// A loop ends when its variable has the first value again. A step that has no answer, such as the
    /// opposite of a corner at a boundary, ends the walk ([`Walk::stopped`]).
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::BadWalk`] or [`ExplainError::UnknownWord`] for a text that is not a walk on
    /// this structure.
    pub fn walk(&self, walk: &str, expected: Option<Query>) -> Result<Walk, ExplainError> {
        self.shown().walk(walk, expected)
    }

    /// Runs one edit, and returns what it reads and writes. A refused edit changes nothing. O(size of the
    /// mesh), because all rows are compared.
    ///
    /// # Errors
    ///
    /// Returns [`ExplainError::NoSuchElement`] if the edit names an element that does not exist,
    /// [`ExplainError::BadEdit`] if it lacks one, and [`ExplainError::NoEdits`] if the structure was not
    /// given with its edits ([`Structure::with_edits`](crate::Structure::with_edits)). Returns
    /// [`ExplainError::TooManyAccesses`] if the edit makes more than 8 million reads and writes; the mesh is
    /// then unchanged.
    pub fn edit(&mut self, edit: &EditByName) -> Result<EditTrace, ExplainError> {
        self.edited()?.edit(edit, usize::MAX)
    }

    /// Runs one edit, like [`edit`](Self::edit), and returns what it does with at most `most` entries in each list.
    ///
    /// # Errors
    ///
    /// The errors of [`edit`](Self::edit).
    pub fn edit_briefly(
        &mut self,
        edit: &EditByName,
        most: usize,
    ) -> Result<EditTrace, ExplainError> {
        self.edited()?.edit(edit, most)
    }

    /// Runs one edit, like [`edit`](Self::edit), in the time of the edit. Returns the rule that the edit
    /// breaks, if the structure refuses it.
    ///
    /// # Errors
    ///
    /// The errors of [`edit`](Self::edit).
    pub fn apply(&mut self, edit: &EditByName) -> Result<Option<String>, ExplainError> {
        self.edited()?.apply(edit)
    }

    /// Runs one edit, like [`apply`](Self::apply). A refused edit is an error.
    pub(crate) fn apply_accepted(&mut self, edit: &EditByName) -> Result<(), ExplainError> {
        let reason = match self.apply(edit) {
            Ok(None) => return Ok(()),
            Ok(Some(refusal)) => refusal,
            Err(error @ ExplainError::NoSuchElement { .. }) => error.to_string(),
            Err(error) => return Err(error),
        };
        Err(ExplainError::RefusedEdit {
            structure: self.shown().structure(),
            edit: edit.to_string(),
            reason,
        })
    }

    /// Returns the bytes of the tables as they were before edits.
    pub fn memory(&self) -> Memory {
        self.shown().memory()
    }

    /// Returns the vertices and faces by the numbers of their names. O(corners).
    pub fn geometry(&self) -> Geometry {
        self.shown().geometry()
    }
}

impl BuiltMesh {
    pub(crate) fn fixed<P: Described + 'static>(named: NamedMesh<P>) -> Self {
        Self(Form::Fixed(Box::new(named)))
    }

    pub(crate) fn editable<P: MeshEdit + Described + Clone + 'static>(named: NamedMesh<P>) -> Self {
        Self(Form::Editable(Box::new(named)))
    }

    fn shown(&self) -> &dyn Shown {
        match &self.0 {
            Form::Fixed(mesh) => &**mesh,
            Form::Editable(mesh) => &**mesh,
        }
    }

    fn edited(&mut self) -> Result<&mut dyn Edited, ExplainError> {
        match &mut self.0 {
            Form::Editable(mesh) => Ok(&mut **mesh),
            Form::Fixed(mesh) => Err(ExplainError::NoEdits {
                structure: mesh.structure(),
            }),
        }
    }
}

/// What is shown of a mesh of any type.
trait Shown {
    fn structure(&self) -> &'static str;
    fn records(&self, rows: RowsOf<'_>) -> Vec<Records>;
    fn moved_rows(&self) -> Vec<[String; 2]>;
    fn trace(&self, relation: Relation, element: ElementName) -> Result<Trace, ExplainError>;
    fn walk(&self, walk: &str, expected: Option<Query>) -> Result<Walk, ExplainError>;
    fn geometry(&self) -> Geometry;
    fn memory(&self) -> Memory;
}

/// The edits of a mesh of any editable type.
trait Edited: Shown {
    fn edit(&mut self, edit: &EditByName, most: usize) -> Result<EditTrace, ExplainError>;
    fn apply(&mut self, edit: &EditByName) -> Result<Option<String>, ExplainError>;
}

impl<P: Described> Shown for NamedMesh<P> {
    fn structure(&self) -> &'static str {
        self.structure
    }

    fn records(&self, rows: RowsOf<'_>) -> Vec<Records> {
        let records = records(&self.mesh, rows);
        self.probe.take();
        records
    }

    fn moved_rows(&self) -> Vec<[String; 2]> {
        let moved = NamedMesh::moved_rows(self);
        self.probe.take();
        moved
    }

    fn trace(&self, relation: Relation, element: ElementName) -> Result<Trace, ExplainError> {
        trace(self, relation, element)
    }

    fn walk(&self, source: &str, expected: Option<Query>) -> Result<Walk, ExplainError> {
        walk(self, source, expected)
    }

    fn geometry(&self) -> Geometry {
        let position = |v| self.mesh.position(v).to_array();
        let corners = |f| {
            let corners = self.mesh.face_vertices(f);
            corners.map(|v| self.vertex_number(v)).collect()
        };
        let (vertices, faces) = (self.names.vertices(), self.names.faces());
        let geometry = Geometry {
            vertices: vertices.iter().map(|v| v.map(position)).collect(),
            faces: faces.iter().map(|f| f.map(corners)).collect(),
        };
        self.probe.take();
        geometry
    }

    fn memory(&self) -> Memory {
        let memory = Memory::new(self.structure, &self.memory, &self.mesh.tables());
        self.probe.take();
        memory
    }
}

impl<P: MeshEdit + Described + Clone> Edited for NamedMesh<P> {
    fn edit(&mut self, edit: &EditByName, most: usize) -> Result<EditTrace, ExplainError> {
        self.run_shown(edit, most)
    }

    fn apply(&mut self, edit: &EditByName) -> Result<Option<String>, ExplainError> {
        self.run(edit)
    }
}

//! What an edit reads and writes: the rows before and after.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use serde::Serialize;
use sixfold::{Changes, Edit, EditRecord, MeshEdit, MeshQuery, Point, PolygonMesh, Refusal};
use sixfold_core::{
    AccessKind, Column, Described, FaceId, Handle, Measured, RecordTable, Representation, Traced,
    VertexId, row,
};

use crate::edit_command::EditCommand;
use crate::element::ElementName;
use crate::records::{Records, records};
use crate::structure::ExplainError;

/// One edit on one structure: the rows that it reads, writes, makes and deletes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct EditTrace {
    /// The name of the structure.
    #[serde(rename = "backend")]
    pub structure: &'static str,
    /// The edit, as text.
    pub edit: String,
    /// The rule that the edit breaks, if the structure refuses it. Then nothing is changed.
    pub refusal: Option<String>,
    /// The numbers of elements before the edit.
    pub before: Elements,
    /// The numbers of elements after the edit.
    pub after: Elements,
    /// The number of reads of rows.
    pub reads: usize,
    /// The number of writes of rows.
    pub writes: usize,
    /// The rows that the edit reads or changes, by table and row.
    pub rows: Vec<RowChange>,
    /// The names of elements that the edit made.
    pub created: Vec<String>,
    /// The names of elements that the edit deleted.
    pub removed: Vec<String>,
    /// The elements whose rows have other numbers after the edit: the name of the element, and the rows
    /// before and after.
    pub renamed: Vec<[String; 3]>,
}

/// The numbers of elements of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Elements {
    /// The number of vertices.
    pub vertices: usize,
    /// The number of edges.
    pub edges: usize,
    /// The number of faces.
    pub faces: usize,
}

impl Elements {
    /// Returns the Euler characteristic: V − E + F.
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }
}

/// A row before and after an edit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RowChange {
    /// The name of the table.
    pub table: &'static str,
    /// The name of the row, such as `h5`.
    pub row: String,
    /// The names of the stored columns.
    pub columns: Vec<&'static str>,
    /// The stored fields before the edit; `None` if there was no element in the row.
    pub before: Option<Vec<String>>,
    /// The stored fields after the edit; `None` if there is no element in the row.
    pub after: Option<Vec<String>>,
    /// True if the edit reads the row.
    #[serde(rename = "read")]
    pub is_read: bool,
    /// True if the edit writes the row.
    #[serde(rename = "written")]
    pub is_written: bool,
}

impl RowChange {
    /// Returns whether the fields differ before and after the edit.
    pub fn is_changed(&self) -> bool {
        self.before != self.after
    }
}

/// A structure that is edited, with the names of its elements.
struct Edited<M: Representation + Measured + MeshEdit>
where
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face> + Described,
{
    mesh: M::Probed<Traced>,
    probe: Traced,
    vertices: Names<M::Vertex>,
    faces: Names<M::Face>,
}

/// The handles of elements by number: first those of the mesh, then new ones in the order in which they
/// are made. The handle of a deleted element is `None`.
struct Names<H> {
    handles: Vec<Option<H>>,
}

impl<H: Handle> Names<H> {
    fn number(&self, handle: H) -> Option<usize> {
        self.handles.iter().position(|&known| known == Some(handle))
    }

    fn handle(&self, number: u32) -> Option<H> {
        self.handles.get(number as usize).copied().flatten()
    }

    /// Follows the changes of one edit. Returns the names of new, deleted and renamed elements.
    fn follow(&mut self, letter: char, changes: &Changes<H>) -> Followed {
        let name = |number: usize| format!("{letter}{number}");
        let mut followed = Followed::default();
        for &removed in &changes.removed {
            if let Some(number) = self.number(removed) {
                self.handles[number] = None;
                followed.removed.push(name(number));
            }
        }
        let renamed: Vec<_> = (changes.renamed.iter())
            .filter(|[old, new]| old != new)
            .filter_map(|&[old, new]| Some((self.number(old)?, old, new)))
            .collect();
        for (number, old, new) in renamed {
            self.handles[number] = Some(new);
            followed
                .renamed
                .push([name(number), format!("{old:?}"), format!("{new:?}")]);
        }
        for &created in &changes.created {
            followed.created.push(name(self.handles.len()));
            self.handles.push(Some(created));
        }
        followed
    }
}

#[derive(Default)]
struct Followed {
    created: Vec<String>,
    removed: Vec<String>,
    renamed: Vec<[String; 3]>,
}

/// The stored fields of all rows, by the name of the table and the number of the row.
type Rows = BTreeMap<(&'static str, usize), Vec<String>>;

/// Returns the stored columns of a table, each with its place.
fn stored(table: &RecordTable) -> impl Iterator<Item = (usize, &'static Column)> + use<> {
    let columns = table.columns.iter().enumerate();
    columns.filter(|(_, column)| !column.is_derived)
}

/// Runs edits one after the other on the structure `M`, and returns what each of them does.
pub(crate) fn edit<M>(
    polygons: &PolygonMesh,
    edits: &[EditCommand],
) -> Result<Vec<EditTrace>, ExplainError>
where
    M: Representation + Measured + MeshEdit,
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face> + Described,
{
    let mut edited = Edited::<M>::new(polygons)?;
    edits.iter().map(|command| edited.run(command)).collect()
}

/// Returns the records of the structure `M` after edits.
pub(crate) fn edited_records<M>(
    polygons: &PolygonMesh,
    edits: &[EditCommand],
    rows: &Range<usize>,
) -> Result<Vec<Records>, ExplainError>
where
    M: Representation + Measured + MeshEdit,
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face> + Described,
{
    let mut edited = Edited::<M>::new(polygons)?;
    for command in edits {
        edited.run(command)?;
    }
    Ok(records(&edited.mesh, rows))
}

impl<M> Edited<M>
where
    M: Representation + Measured + MeshEdit,
    M::Probed<Traced>: MeshEdit<Vertex = M::Vertex, Edge = M::Edge, Face = M::Face> + Described,
{
    fn new(polygons: &PolygonMesh) -> Result<Self, ExplainError> {
        let mesh = M::from_polygons(polygons).map_err(|refusal| ExplainError::Refused {
            structure: M::NAME,
            refusal,
        })?;
        let vertices = (0..row(polygons.vertex_count())).map(VertexId::new);
        let vertices = vertices.map(|v| M::vertex_handle(polygons, v));
        let vertices = vertices
            .map(|v| mesh.contains_vertex(v).then_some(v))
            .collect();
        let faces = (0..row(polygons.face_count())).map(FaceId::new);
        let faces = faces.map(|f| Some(M::face_handle(polygons, f))).collect();
        let probe = Traced::default();
        Ok(Self {
            mesh: mesh.probed(probe.clone()),
            probe,
            vertices: Names { handles: vertices },
            faces: Names { handles: faces },
        })
    }

    /// Runs one edit.
    fn run(&mut self, command: &EditCommand) -> Result<EditTrace, ExplainError> {
        command.check()?;
        // An edit can add tables, for example if the faces no longer have the same degree.
        let mut tables = self.mesh.tables();
        let (before, elements) = (self.rows(), self.elements());
        let mut record = EditRecord::new();
        let refusal = self.apply(command, &mut record)?;
        let accesses = self.probe.take();
        let after = self.rows();
        for table in self.mesh.tables() {
            if !tables.iter().any(|known| known.name == table.name) {
                tables.push(table);
            }
        }
        let is_described = |name| tables.iter().any(|table| table.name == name);
        let touched = |kind| {
            let of_kind = accesses.iter().filter(move |access| access.kind == kind);
            let described = of_kind.filter(|access| is_described(access.table));
            described
                .map(|access| (access.table, access.row))
                .collect::<BTreeSet<_>>()
        };
        let (read, written) = (touched(AccessKind::Read), touched(AccessKind::Write));
        let changed = before.keys().chain(after.keys()).copied();
        let changed = changed.filter(|place| before.get(place) != after.get(place));
        let places: BTreeSet<_> = changed
            .chain(read.iter().chain(&written).copied())
            .collect();
        let mut rows = Vec::new();
        for table in &tables {
            let of_table = places.iter().filter(|(name, _)| *name == table.name);
            rows.extend(of_table.map(|place| RowChange {
                table: table.name,
                row: format!("{}{}", table.letter, place.1),
                columns: stored(table).map(|(_, column)| column.name).collect(),
                before: before.get(place).cloned(),
                after: after.get(place).cloned(),
                is_read: read.contains(place),
                is_written: written.contains(place),
            }));
        }
        let count = |kind| accesses.iter().filter(|access| access.kind == kind).count();
        let (reads, writes) = (count(AccessKind::Read), count(AccessKind::Write));
        let vertices = self.vertices.follow('v', &record.vertices);
        let faces = self.faces.follow('f', &record.faces);
        Ok(EditTrace {
            structure: M::NAME,
            edit: command.to_string(),
            refusal,
            before: elements,
            after: self.elements(),
            reads,
            writes,
            rows,
            created: [vertices.created, faces.created].concat(),
            removed: [vertices.removed, faces.removed].concat(),
            renamed: [vertices.renamed, faces.renamed].concat(),
        })
    }

    fn elements(&self) -> Elements {
        let elements = Elements {
            vertices: self.mesh.vertex_count(),
            edges: self.mesh.edge_count(),
            faces: self.mesh.face_count(),
        };
        self.probe.take();
        elements
    }

    /// Returns the stored fields of all rows.
    fn rows(&self) -> Rows {
        let mut rows = Rows::new();
        for table in self.mesh.tables() {
            for number in 0..table.rows {
                if let Some(fields) = self.mesh.record(table.name, number) {
                    let fields = stored(&table).map(|(place, _)| fields[place].to_string());
                    rows.insert((table.name, number), fields.collect());
                }
            }
        }
        // The description of the rows reads, too.
        self.probe.take();
        rows
    }

    fn missing(name: ElementName) -> ExplainError {
        ExplainError::NoSuchElement {
            structure: M::NAME,
            name,
        }
    }

    fn vertex(&self, name: ElementName) -> Result<M::Vertex, ExplainError> {
        let handle = match name {
            ElementName::Vertex(v) => self.vertices.handle(v),
            _ => None,
        };
        handle.ok_or_else(|| Self::missing(name))
    }

    fn edge(&self, name: ElementName) -> Result<M::Edge, ExplainError> {
        let ends = match name {
            ElementName::Edge(ends) => ends,
            _ => return Err(Self::missing(name)),
        };
        let [a, b] = ends.map(|v| self.vertices.handle(v).ok_or_else(|| Self::missing(name)));
        let edge = self.mesh.edge_between(a?, b?);
        edge.ok_or_else(|| Self::missing(name))
    }

    fn face(&self, name: ElementName) -> Result<M::Face, ExplainError> {
        let handle = match name {
            ElementName::Face(f) => self.faces.handle(f),
            _ => None,
        };
        handle.ok_or_else(|| Self::missing(name))
    }

    /// Returns the mean of positions.
    fn middle(&self, vertices: impl IntoIterator<Item = M::Vertex>) -> Point {
        let mut count = 0.0;
        let positions = vertices.into_iter().map(|v| self.mesh.position(v));
        let sum: Point = positions.inspect(|_| count += 1.0).sum();
        sum / count
    }

    /// Applies an edit. Returns the message if the structure refuses it.
    fn apply(
        &mut self,
        command: &EditCommand,
        record: &mut EditRecord<M::Probed<Traced>>,
    ) -> Result<Option<String>, ExplainError> {
        let names = &command.elements;
        let name = |i: usize| {
            names
                .get(i)
                .copied()
                .flatten()
                .expect("the command was checked")
        };
        let optional = |i: usize| match names.get(i).copied().flatten() {
            Some(name) => self.vertex(name).map(Some),
            None => Ok(None),
        };
        let given = command.at;
        let on_edge = |e| given.unwrap_or_else(|| self.middle(self.mesh.edge_vertices(e)));
        let refused = match command.edit {
            Edit::SetPosition => {
                let v = self.vertex(name(0))?;
                let at = given.unwrap_or(Point::ZERO);
                self.clean().set_position_logged(v, at, record).map(drop)
            }
            Edit::AddVertex => {
                let at = given.unwrap_or(Point::ZERO);
                self.clean().add_vertex_logged(at, record).map(drop)
            }
            Edit::AddFace => {
                let corners = (0..names.len()).map(|i| self.vertex(name(i)));
                let corners: Vec<M::Vertex> = corners.collect::<Result<_, _>>()?;
                self.clean().add_face_logged(&corners, record).map(drop)
            }
            Edit::RemoveFace => {
                let f = self.face(name(0))?;
                self.clean().remove_face_logged(f, record)
            }
            Edit::RemoveVertex => {
                let v = self.vertex(name(0))?;
                self.clean().remove_vertex_logged(v, record)
            }
            Edit::RemoveIsolatedVertices => {
                self.clean().remove_isolated_vertices_logged(record);
                Ok(())
            }
            Edit::SplitEdge => {
                let e = self.edge(name(0))?;
                let at = on_edge(e);
                self.clean().split_edge_logged(e, at, record).map(drop)
            }
            Edit::BisectEdge => {
                let e = self.edge(name(0))?;
                let at = on_edge(e);
                self.clean().bisect_edge_logged(e, at, record).map(drop)
            }
            Edit::PokeFace => {
                let f = self.face(name(0))?;
                let at = given.unwrap_or_else(|| self.middle(self.mesh.face_vertices(f)));
                self.clean().poke_face_logged(f, at, record).map(drop)
            }
            Edit::SplitFace => {
                let f = self.face(name(0))?;
                let ends = [self.vertex(name(1))?, self.vertex(name(2))?];
                self.clean().split_face_logged(f, ends, record).map(drop)
            }
            Edit::DissolveEdge => {
                let e = self.edge(name(0))?;
                self.clean().dissolve_edge_logged(e, record).map(drop)
            }
            Edit::FlipEdge => {
                let e = self.edge(name(0))?;
                self.clean().flip_edge_logged(e, record).map(drop)
            }
            Edit::CollapseEdge => {
                let (e, keep) = (self.edge(name(0))?, self.vertex(name(1))?);
                let at = on_edge(e);
                self.clean()
                    .collapse_edge_logged(e, keep, at, record)
                    .map(drop)
            }
            Edit::SplitVertex => {
                let v = self.vertex(name(0))?;
                let (left, right) = (optional(1)?, optional(2)?);
                let middle = || self.middle([Some(v), left, right].into_iter().flatten());
                let at = given.unwrap_or_else(middle);
                self.clean()
                    .split_vertex_logged(v, left, right, at, record)
                    .map(drop)
            }
            Edit::Compact => {
                self.clean().compact_logged(record);
                Ok(())
            }
        };
        Ok(refused
            .err()
            .map(|refusal: Refusal<M::Probed<Traced>>| refusal.to_string()))
    }

    /// Returns the mesh, after the reads that looked up the arguments are forgotten.
    fn clean(&mut self) -> &mut M::Probed<Traced> {
        self.probe.take();
        &mut self.mesh
    }
}

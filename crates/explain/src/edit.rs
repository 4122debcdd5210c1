//! What an edit reads and writes: the rows before and after.

use std::fmt::{self, Debug, Formatter};

use rustc_hash::FxHashSet;
use serde::Serialize;
use sixfold::{EditRecord, Handle, MeshEdit, Refusal};
use sixfold_core::{
    Access, AccessKind, Described, EditByName, EditOf, ElementName, FacesBefore, Field,
    NameChanges, RecordTable,
};

use crate::error::ExplainError;
use crate::named_mesh::{NamedMesh, RecordSource};
use crate::trace::{retain_named, stored_fields};

/// Maximum number of reads and writes of an edit that is shown. They take about 320 MB.
const MAX_ACCESSES: usize = 8_000_000;

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
    /// The number of rows whose fields differ before and after the edit.
    pub changed: usize,
    /// The rows that the edit changes or writes, by table and row.
    pub rows: Vec<RowChange>,
    /// The rows that the edit only reads, by table and row.
    pub only_read: Vec<ReadRows>,
    /// The names of new elements.
    pub created: Vec<String>,
    /// The names that no longer name an element.
    pub removed: Vec<String>,
    /// The elements whose rows have other numbers after the edit: the name of the element, and the rows
    /// before and after.
    pub renamed: Vec<[String; 3]>,
    /// The rows of [`rows`](Self::rows), and in their fields after the edit, whose elements have other
    /// numbers: the name of the row, and the name of the element.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moved: Vec<[String; 2]>,
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

/// Rows in order that an edit reads and does not change.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ReadRows {
    /// The name of the table.
    pub table: &'static str,
    /// The name of the first row, such as `h5`.
    pub row: String,
    /// The number of rows.
    pub rows: usize,
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

impl<P: MeshEdit + Described + Clone> NamedMesh<P> {
    /// Runs an edit. Returns the rule that it breaks, if the structure refuses it.
    pub(crate) fn run(&mut self, command: &EditByName) -> Result<Option<String>, ExplainError> {
        let edit = self.found(command)?;
        let (refusal, record, cut) = self.run_recorded(&edit, 0);
        self.follow(&record, &cut);
        self.probe.take();
        Ok(refusal)
    }

    fn follow(
        &mut self,
        record: &EditRecord<P>,
        cut: &FacesBefore,
    ) -> NameChanges<P::Vertex, P::Face> {
        let changes = self
            .probe
            .pause(|| self.names.follow(&self.mesh, record, cut));
        self.has_moved |= !changes.moved_vertices.is_empty() || !changes.moved_faces.is_empty();
        changes
    }

    /// Runs an edit, and returns what it does, with at most `most` entries in each list. O(size of the mesh),
    /// because all rows are compared.
    ///
    /// # Errors
    ///
    /// Returns an error if an element is missing, or if the edit makes more than [`MAX_ACCESSES`] reads and
    /// writes. The mesh is then unchanged.
    pub(crate) fn run_shown(
        &mut self,
        command: &EditByName,
        most: usize,
    ) -> Result<EditTrace, ExplainError> {
        let edit = self.found(command)?;
        let (before, elements) = (self.mesh.clone(), self.elements());
        let (refusal, record, cut) = self.run_recorded(&edit, MAX_ACCESSES + 1);
        let accesses = self.probe.take();
        if accesses.len() > MAX_ACCESSES {
            self.mesh = before;
            return Err(ExplainError::TooManyAccesses {
                structure: self.structure,
                edit: command.to_string(),
                limit: MAX_ACCESSES,
            });
        }
        let mut changes = Changed::new(most);
        self.probe
            .pause(|| changes.compare(&before, &self.mesh, &accesses));
        let after = self.elements();
        self.probe.take();
        let count = |kind| accesses.iter().filter(|access| access.kind == kind).count();
        let (reads, writes) = (count(AccessKind::Read), count(AccessKind::Write));
        let names = self.follow(&record, &cut);
        let mut other_rows = self.moved_rows();
        self.probe.take();
        let rows = changes.rows.iter().map(|row| &row.row);
        let fields = changes.rows.iter().filter_map(|row| row.after.as_ref());
        retain_named(&mut other_rows, rows.chain(fields.flatten()));
        let shown = |names: Vec<ElementName>| {
            let names = names.iter().take(most);
            names.map(ElementName::to_string).collect()
        };
        let moved_vertices = names.moved_vertices.iter();
        let moved_vertices = moved_vertices.map(|&(v, rows)| moved(ElementName::Vertex(v), rows));
        let moved_faces = names.moved_faces.iter();
        let moved_faces = moved_faces.map(|&(f, rows)| moved(ElementName::Face(f), rows));
        Ok(EditTrace {
            structure: self.structure,
            edit: command.to_string(),
            refusal,
            before: elements,
            after,
            reads,
            writes,
            changed: changes.changed,
            rows: changes.rows,
            only_read: changes.only_read,
            created: shown(names.created),
            removed: shown(names.removed),
            renamed: moved_vertices.chain(moved_faces).take(most).collect(),
            moved: other_rows,
        })
    }

    fn elements(&self) -> Elements {
        Elements {
            vertices: self.mesh.vertex_count(),
            edges: self.mesh.edge_count(),
            faces: self.mesh.face_count(),
        }
    }

    /// Returns the edit with the handles of its elements.
    fn found(&self, command: &EditByName) -> Result<EditOf<P>, ExplainError> {
        let edit = command.find(&self.mesh, &self.names);
        edit.map_err(|name| self.missing(name))
    }

    /// Runs an edit, whose first `limit` reads and writes the probe then has. Returns the rule that it breaks, if the
    /// structure refuses it, the changes, and the faces before.
    fn run_recorded(
        &mut self,
        edit: &EditOf<P>,
        limit: usize,
    ) -> (Option<String>, EditRecord<P>, FacesBefore) {
        let cut = self
            .probe
            .pause(|| self.names.faces_before(&self.mesh, edit));
        let mut record = EditRecord::new();
        // The reads that looked up the arguments are forgotten.
        self.probe.take();
        let refusal = self
            .probe
            .limit(limit, || edit.apply(&mut self.mesh, &mut record).err());
        let refusal = refusal.map(|refusal| self.probe.pause(|| self.in_names(refusal)));
        (refusal, record, cut)
    }

    /// Returns a refusal as text, with the names of the elements. The edit changed nothing, so the handles
    /// are those before it.
    fn in_names(&self, refusal: Refusal<P>) -> String {
        let names = &self.names;
        let vertex = |v| Shown::new(names.vertex_number(v).map(ElementName::Vertex), v);
        let edge = |e| {
            let ends = names.edge_numbers(self.mesh.edge_vertices(e));
            Shown::new(ends.map(ElementName::Edge), e)
        };
        let face = |f| Shown::new(names.face_number(f).map(ElementName::Face), f);
        refusal.map_handles(vertex, edge, face).to_string()
    }
}

/// An element in the message of a refusal: its name, or its handle.
struct Shown(String);

impl Shown {
    fn new(name: Option<ElementName>, handle: impl Debug) -> Self {
        Self(name.map_or_else(|| format!("{handle:?}"), |name| name.to_string()))
    }
}

impl Debug for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Returns the name of an element, and its handles before and after an edit, as text.
fn moved<H: Handle>(name: ElementName, handles: [H; 2]) -> [String; 3] {
    let [before, after] = handles.map(|handle| format!("{handle:?}"));
    [name.to_string(), before, after]
}

/// The rows that an edit changes, writes or reads.
struct Changed {
    /// Maximum number of entries of a list.
    most: usize,
    changed: usize,
    rows: Vec<RowChange>,
    only_read: Vec<ReadRows>,
}

impl Changed {
    fn new(most: usize) -> Self {
        Self {
            most,
            changed: 0,
            rows: Vec::new(),
            only_read: Vec::new(),
        }
    }

    /// Compares all rows before and after an edit.
    fn compare(
        &mut self,
        before: &dyn RecordSource,
        after: &dyn RecordSource,
        accesses: &[Access],
    ) {
        let touched = |kind| {
            let of_kind = accesses.iter().filter(move |access| access.kind == kind);
            of_kind
                .map(|access| (access.table, access.row))
                .collect::<FxHashSet<_>>()
        };
        let (read, written) = (touched(AccessKind::Read), touched(AccessKind::Write));
        // An edit can add tables, for example if the faces no longer have the same degree.
        let mut tables = before.record_tables();
        for table in after.record_tables() {
            match tables.iter_mut().find(|known| known.name == table.name) {
                Some(known) => known.rows = known.rows.max(table.rows),
                None => tables.push(table),
            }
        }
        for table in tables {
            // The row after the last one that is only read.
            let mut next = None;
            for row in 0..table.rows {
                let place = (table.name, row);
                let (is_read, is_written) = (read.contains(&place), written.contains(&place));
                let [before, after] = [before, after].map(|mesh| mesh.own_fields(table.name, row));
                let are_equal = are_equal(&table, before.as_deref(), after.as_deref());
                if is_written || !are_equal {
                    self.changed += usize::from(!are_equal);
                    if self.rows.len() < self.most {
                        let row = change(&table, row, [before, after], is_read, is_written);
                        self.rows.push(row);
                    }
                } else if is_read {
                    match self.only_read.last_mut() {
                        Some(last) if next == Some(row) => last.rows += 1,
                        _ => self.push_read(&table, row),
                    }
                    next = Some(row + 1);
                }
            }
        }
    }

    fn push_read(&mut self, table: &RecordTable, row: usize) {
        if self.only_read.len() < self.most {
            self.only_read.push(ReadRows {
                table: table.name,
                row: format!("{}{row}", table.letter),
                rows: 1,
            });
        }
    }
}

fn change(
    table: &RecordTable,
    row: usize,
    records: [Option<Vec<Field>>; 2],
    is_read: bool,
    is_written: bool,
) -> RowChange {
    let text = |record: Vec<Field>| {
        let fields = stored_fields(table, &record).into_iter();
        fields.map(|(_, field)| field).collect()
    };
    let columns = table.columns.iter().filter(|column| !column.is_derived);
    let [before, after] = records.map(|record| record.map(text));
    RowChange {
        table: table.name,
        row: format!("{}{row}", table.letter),
        columns: columns.map(|column| column.name).collect(),
        before,
        after,
        is_read,
        is_written,
    }
}

/// Returns whether two records of a table have the same stored fields. A coordinate that is not a number
/// equals itself.
fn are_equal(table: &RecordTable, before: Option<&[Field]>, after: Option<&[Field]>) -> bool {
    let are_equal = |pair: (&Field, &Field)| match pair {
        (Field::Point(a), Field::Point(b)) => {
            a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)
        }
        (a, b) => a == b,
    };
    match (before, after) {
        (Some(before), Some(after)) => {
            let mut columns = table.columns.iter().zip(before.iter().zip(after));
            columns.all(|(column, pair)| column.is_derived || are_equal(pair))
        }
        (before, after) => before.is_none() && after.is_none(),
    }
}

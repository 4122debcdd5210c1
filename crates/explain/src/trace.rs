//! The reads of one query, in their order, each with the reason for which its row is read.

use std::ops::Range;

use rustc_hash::FxHashSet;
use serde::Serialize;
use sixfold::Relation;
use sixfold_core::{Access, Column, Described, Element, ElementName, Field, Line, RecordTable};

use crate::error::ExplainError;
use crate::named_mesh::{NamedMesh, RecordSource};
use crate::reason::{Inference, Reason};

/// In a longer trace, reads of consecutive rows are one step if they have the same way, also without a scan.
const MOST_SINGLE_STEPS: usize = 10_000;

/// Bytes of a cache line.
const LINE_BYTES: usize = 64;

/// A relation, and the element from which a query starts.
pub type Query = (Relation, ElementName);

/// One query on one structure: what it reads, why, and what it yields.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Trace {
    /// The name of the structure.
    #[serde(rename = "backend")]
    pub structure: &'static str,
    /// The relation.
    pub relation: Relation,
    /// The name of the element of the query, such as `e4 = v0-v1`.
    pub element: String,
    /// The steps of the query, as a textbook writes them; empty if the structure does not say.
    pub algorithm: Vec<&'static str>,
    /// The reads and the results, in their order.
    pub steps: Vec<Step>,
    /// What the reads cost.
    #[serde(flatten)]
    pub cost: Cost,
    /// The names of the results, in their order.
    pub results: Vec<String>,
    /// The rows in the steps that an edit moved ([`BuiltMesh::moved_rows`](crate::BuiltMesh::moved_rows)).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moved: Vec<[String; 2]>,
}

/// What the reads of a query or of a walk cost. The marks of deleted elements do not count: the form of a structure
/// without edits, which programs query and studies measure, has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// The number of reads of rows. A row that is read twice counts twice.
    pub reads: usize,
    /// The number of different cache lines, if each table begins at the start of a line.
    pub cache_lines: usize,
    /// The bytes of the rows that are read. Each row counts once.
    pub bytes: usize,
}

/// One step of a query.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "step", rename_all = "snake_case")]
pub enum Step {
    /// A row of a table is read.
    Read(Read),
    /// The query yields a result.
    Yield {
        /// The name of the result.
        result: String,
        /// The line of the algorithm, from 0.
        line: Option<usize>,
    },
}

/// A read of a row, or of several rows in order that a scan reads for the same reason. After the first 10,000
/// steps of a trace also of other rows in order that are read in the same way, such as the corners of a face.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Read {
    /// The name of the table.
    pub table: &'static str,
    /// The name of the row, such as `h5`.
    pub row: String,
    /// The number of rows, of which `row` is the first.
    pub rows: usize,
    /// The bytes of one row.
    pub bytes: usize,
    /// The stored fields of the row: the name of the column and the value. Empty for several rows.
    pub fields: Vec<(&'static str, String)>,
    /// Why the row is read.
    pub reason: Reason,
    /// The line of the algorithm, from 0.
    pub line: Option<usize>,
}

/// Traces a query.
pub(crate) fn trace<P: Described>(
    named: &NamedMesh<P>,
    relation: Relation,
    element: ElementName,
) -> Result<Trace, ExplainError> {
    check_kind(relation, element)?;
    let handle = named.handle(element)?;
    let lines = P::algorithm(relation);
    let mut recorder = Recorder {
        inference: Inference::new(&named.mesh, lines, named.mesh.rows_of(handle)),
        mesh: &named.mesh,
        steps: Vec::new(),
        reads: Vec::new(),
        results: Vec::new(),
    };
    named.probe.take();
    run(named, relation, handle, &mut recorder);
    let Recorder {
        steps,
        reads,
        results,
        ..
    } = recorder;
    let name = named.name(handle);
    let moved = moved_among(named.moved_rows(), &steps);
    named.probe.take();
    Ok(Trace {
        structure: named.structure,
        relation,
        element: name,
        algorithm: lines.iter().map(|line| line.text).collect(),
        steps,
        cost: cost(&reads),
        results,
        moved,
    })
}

/// Returns those of `moved` whose rows are in the texts of the steps.
pub(crate) fn moved_among(mut moved: Vec<[String; 2]>, steps: &[Step]) -> Vec<[String; 2]> {
    if moved.is_empty() {
        return moved;
    }
    let reads = steps.iter().filter_map(|step| match step {
        Step::Read(read) => Some(read),
        Step::Yield { .. } => None,
    });
    let texts = reads.flat_map(|read| {
        let fields = read.fields.iter().map(|(_, value)| value);
        fields.chain([&read.row, &read.reason.text])
    });
    retain_named(&mut moved, texts);
    moved
}

/// Retains the rows whose names are words of the texts.
pub(crate) fn retain_named<'t>(
    moved: &mut Vec<[String; 2]>,
    texts: impl Iterator<Item = &'t String>,
) {
    let words = texts.flat_map(|text| text.split(|c: char| !c.is_alphanumeric()));
    let words: FxHashSet<&str> = words.collect();
    moved.retain(|[row, _]| words.contains(row.as_str()));
}

/// Runs a query, one result after the other.
fn run<P: Described>(
    named: &NamedMesh<P>,
    relation: Relation,
    element: Element<P>,
    recorder: &mut Recorder<'_>,
) {
    let mesh = &named.mesh;
    // Records the reads before each result, the result, and the reads after the last one.
    let mut record = |results: &mut dyn Iterator<Item = Element<P>>| {
        loop {
            let result = results.next();
            let accesses = named.probe.take();
            // The descriptions and names read rows, too.
            let result = named.probe.pause(|| {
                recorder.explain(accesses);
                result.map(|result| named.name(result))
            });
            match result {
                Some(result) => recorder.push_result(result),
                None => return,
            }
        }
    };
    macro_rules! record_relation {
        ($query:ident $list:ident $from:ident $to:ident) => {{
            let Element::$from(element) = element else {
                unreachable!("the kind of the element was checked")
            };
            record(&mut mesh.$query(element).into_iter().map(Element::$to));
        }};
    }
    sixfold_core::match_relation!(relation, record_relation!);
}

/// Reads of consecutive rows of a table.
#[derive(Clone, Debug)]
pub(crate) struct RowReads {
    pub(crate) table: &'static str,
    /// The numbers of the rows.
    pub(crate) rows: Range<usize>,
    /// The bytes of one row.
    pub(crate) bytes: usize,
}

/// Returns what reads cost. O(k log k) for k entries.
pub(crate) fn cost(reads: &[RowReads]) -> Cost {
    let count = reads.iter().map(|read| read.rows.len()).sum();
    let by_row = |read: &RowReads| ((read.table, read.bytes), read.rows.clone());
    let rows = united(reads.iter().map(by_row));
    let lines = rows.iter().map(|((table, bytes), rows)| {
        let end = (rows.end * bytes).max(rows.start * bytes + 1);
        (
            *table,
            rows.start * bytes / LINE_BYTES..end.div_ceil(LINE_BYTES),
        )
    });
    let lines = united(lines);
    Cost {
        reads: count,
        cache_lines: lines.iter().map(|(_, lines)| lines.len()).sum(),
        bytes: (rows.iter())
            .map(|((_, bytes), rows)| bytes * rows.len())
            .sum(),
    }
}

/// Returns the union of the ranges of each key, as ranges that have no number in common.
fn united<K: Ord>(ranges: impl Iterator<Item = (K, Range<usize>)>) -> Vec<(K, Range<usize>)> {
    let mut ranges: Vec<_> = ranges.collect();
    ranges.sort_by(|(a, left), (b, right)| (a, left.start).cmp(&(b, right.start)));
    ranges.dedup_by(|(key, next), (before, range)| {
        let is_together = key == before && next.start <= range.end;
        if is_together {
            range.end = range.end.max(next.end);
        }
        is_together
    });
    ranges
}

/// Checks that the element is of the kind that the relation starts from.
fn check_kind(relation: Relation, element: ElementName) -> Result<(), ExplainError> {
    let wanted = match relation {
        Relation::VertexVertices | Relation::VertexEdges | Relation::VertexFaces => "vertex",
        Relation::EdgeVertices | Relation::EdgeEdges | Relation::EdgeFaces => "edge",
        Relation::FaceVertices | Relation::FaceEdges | Relation::FaceFaces => "face",
    };
    match wanted == element.kind() {
        true => Ok(()),
        false => Err(ExplainError::WrongKind {
            relation,
            wanted,
            element,
        }),
    }
}

/// Records the steps of a query while it runs.
struct Recorder<'m> {
    inference: Inference<'m>,
    mesh: &'m dyn RecordSource,
    steps: Vec<Step>,
    reads: Vec<RowReads>,
    results: Vec<String>,
}

impl Recorder<'_> {
    fn push_result(&mut self, result: String) {
        let line = self.inference.yielding();
        self.results.push(result.clone());
        self.steps.push(Step::Yield { result, line });
    }

    fn explain(&mut self, accesses: Vec<Access>) {
        let mut i = 0;
        while i < accesses.len() {
            let Some(table) = self.inference.table(&accesses[i]) else {
                i += 1;
                continue;
            };
            let (reason, line) = self.inference.read(table, &accesses[i..]);
            self.push_read(table, &accesses[i], reason, line);
            let first = i;
            i += 1;
            // The rows of a scan have the same reason.
            let rows = self.inference.scan_length(&accesses[i..]);
            if rows > 0 {
                self.inference.scan_on(table, rows);
                self.push_rows(rows);
                i += rows;
            }
            let Access { row, bytes, .. } = accesses[first];
            self.reads.push(RowReads {
                table: table.name,
                rows: row..row + 1 + rows,
                bytes,
            });
        }
    }

    /// Adds rows to the last step, which is a read of a scan.
    fn push_rows(&mut self, rows: usize) {
        if let Some(Step::Read(last)) = self.steps.last_mut() {
            last.rows += rows;
            last.fields.clear();
        }
    }

    /// Adds a read. The rows of a scan become one step, and in a long trace also other rows in order.
    fn push_read(
        &mut self,
        table: RecordTable,
        access: &Access,
        reason: Reason,
        line: Option<usize>,
    ) {
        let row = access.row;
        if let Some(Step::Read(last)) = self.steps.last_mut()
            && reason.way == Line::SCAN
            && last.reason.way == Line::SCAN
            && last.table == table.name
            && row > 0
        {
            last.rows += 1;
            last.fields.clear();
            return;
        }
        let follows = (self.reads.last())
            .is_some_and(|read| read.table == table.name && read.rows.end == row);
        if self.steps.len() >= MOST_SINGLE_STEPS
            && follows
            && let Some(Step::Read(last)) = self.steps.last_mut()
            && last.reason.way == reason.way
        {
            last.rows += 1;
            last.fields.clear();
            return;
        }
        let record = self.mesh.own_fields(table.name, row).unwrap_or_default();
        self.steps.push(Step::Read(Read {
            table: table.name,
            row: format!("{}{row}", table.letter),
            rows: 1,
            bytes: access.bytes,
            fields: stored_fields(&table, &record),
            reason,
            line,
        }));
    }
}

/// Returns the stored fields of a record: the name of the column and the value.
pub(crate) fn stored_fields(table: &RecordTable, record: &[Field]) -> Vec<(&'static str, String)> {
    let fields = table.columns.iter().zip(record);
    let stored = fields.filter(|(column, _): &(&Column, _)| !column.is_derived);
    stored
        .map(|(column, field)| (column.name, field.to_string()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// The costs of runs of rows are those of their rows one by one.
    #[test]
    fn the_cost_of_runs_is_that_of_their_rows() {
        let runs = [
            ("a", 0..5, 12),
            ("a", 5..6, 12),
            ("a", 3..9, 12),
            ("a", 20..21, 12),
            ("a", 0..2, 12),
            ("b", 1..4, 4),
            ("b", 40..300, 4),
            ("c", 7..9, 0),
            ("d", 2..4, 200),
        ];
        let reads: Vec<RowReads> = (runs.iter().cloned())
            .map(|(table, rows, bytes)| RowReads { table, rows, bytes })
            .collect();
        let mut rows = BTreeSet::new();
        let mut lines = BTreeSet::new();
        let mut count = 0;
        for (table, run, bytes) in runs {
            for row in run {
                count += 1;
                rows.insert((table, row, bytes));
                // The bytes of the row one by one; a row without bytes is at one place.
                for byte in row * bytes..row * bytes + bytes.max(1) {
                    lines.insert((table, byte / 64));
                }
            }
        }
        let cost = cost(&reads);
        assert_eq!(cost.reads, count);
        assert_eq!(cost.cache_lines, lines.len());
        let bytes = rows.iter().map(|&(_, _, bytes)| bytes);
        assert_eq!(cost.bytes, bytes.sum::<usize>());
    }
}

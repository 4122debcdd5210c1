//! Walks that a reader writes, in the words of one structure.

use std::collections::{BTreeMap, HashMap, HashSet};

use serde::Serialize;
use sixfold::{Relation, UnknownName};
use sixfold_core::{Column, Described, ElementName, Field, RecordTable, RowName, Traced, Word};

use crate::error::ExplainError;
use crate::named_mesh::{NamedMesh, RecordSource};
use crate::reason::Reason;
use crate::records::row_name;
use crate::trace::{Cost, Query, Read, RowReads, Step, cost, moved_among, stored_fields, trace};
use crate::walk_parser::{Kind, Program, Statement, Value, loop_variable, parse, text};

/// A walk on one structure: what it reads, and what it yields.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Walk {
    /// The name of the structure.
    #[serde(rename = "backend")]
    pub structure: &'static str,
    /// The lines of the walk.
    pub algorithm: Vec<String>,
    /// The reads and the results, in their order.
    pub steps: Vec<Step>,
    /// What the reads cost.
    #[serde(flatten)]
    pub cost: Cost,
    /// The names of the results, in their order.
    pub results: Vec<String>,
    /// Why the walk ended before its last line, if it did.
    pub stopped: Option<String>,
    /// The comparison with a relation, if one was asked for.
    pub expected: Option<Comparison>,
    /// The rows in the steps that an edit moved ([`BuiltMesh::moved_rows`](crate::BuiltMesh::moved_rows)).
    /// The lines of the walk and the results have the names of the elements.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moved: Vec<[String; 2]>,
}

/// The comparison of the results of a walk with a relation. The order does not count, and each difference
/// is listed once.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// The relation.
    pub relation: Relation,
    /// The name of the element.
    pub element: String,
    /// The results of the relation that the walk does not yield.
    pub missing: Vec<String>,
    /// The results of the walk that the relation does not have.
    pub extra: Vec<String>,
    /// The results of the relation that the walk yields more than once.
    pub repeated: Vec<String>,
    /// The comparison as a sentence.
    pub verdict: String,
}

impl Comparison {
    /// Returns whether the walk yields the results of the relation, each once.
    pub fn is_right(&self) -> bool {
        self.missing.is_empty() && self.extra.is_empty() && self.repeated.is_empty()
    }

    fn sentence(&self) -> String {
        let (relation, element) = (self.relation, &self.element);
        if self.is_right() {
            return format!("Right: the walk yields {relation} of {element}.");
        }
        let differences = [
            ("does not yield ", &self.missing, ""),
            ("yields ", &self.extra, ", not in this relation"),
            ("repeats ", &self.repeated, ""),
        ];
        let differences = differences.iter().filter(|(_, names, _)| !names.is_empty());
        let differences = differences
            .map(|(verb, names, note)| format!("{verb}{}{note}", names.join(", ")))
            .collect::<Vec<_>>();
        let differences = differences.join("; it ");
        format!("Not {relation} of {element}: the walk {differences}.")
    }
}

/// Runs a walk.
pub(crate) fn walk<P: Described>(
    named: &NamedMesh<P>,
    source: &str,
    expected: Option<Query>,
) -> Result<Walk, ExplainError> {
    let program = parse(source)?;
    let mut walker = Walker {
        structure: named.structure,
        mesh: &named.mesh,
        probe: &named.probe,
        row_bytes: &named.row_bytes,
        words: P::WORDS,
        tables: named.mesh.tables(),
        moved: named.moved_rows(),
        variables: BTreeMap::new(),
        steps: Vec::new(),
        reads: Vec::new(),
        results: Vec::new(),
        line: 0,
    };
    let stopped = match walker.block(&program.statements) {
        Ok(()) => None,
        Err(End::NoAnswer(reason)) => Some(reason),
        Err(End::Error(error)) => return Err(error),
    };
    let Walker {
        steps,
        reads,
        results,
        moved,
        ..
    } = walker;
    let compared = |(relation, element)| compare(named, relation, element, &results);
    Ok(Walk {
        structure: named.structure,
        moved: moved_among(moved, &steps),
        expected: expected.map(compared).transpose()?,
        algorithm: program.lines,
        steps,
        cost: cost(&reads),
        results,
        stopped,
    })
}

/// Compares the results of a walk with those of a query.
fn compare<P: Described>(
    named: &NamedMesh<P>,
    relation: Relation,
    element: ElementName,
    results: &[String],
) -> Result<Comparison, ExplainError> {
    let query = trace(named, relation, element)?;
    // The name of an edge is its row and its ends.
    let row = |name: &String| name.split(' ').next().unwrap_or_default().to_owned();
    let right: Vec<String> = query.results.iter().map(row).collect();
    let mut missing = right.clone();
    let (mut extra, mut repeated) = (Vec::new(), Vec::new());
    for result in results {
        let list = match missing.iter().position(|name| name == result) {
            Some(place) => {
                missing.remove(place);
                continue;
            }
            None if right.contains(result) => &mut repeated,
            None => &mut extra,
        };
        if !list.contains(result) {
            list.push(result.clone());
        }
    }
    let mut comparison = Comparison {
        relation,
        element: query.element,
        missing,
        extra,
        repeated,
        verdict: String::new(),
    };
    comparison.verdict = comparison.sentence();
    Ok(comparison)
}

/// Why a walk ends before its last line.
enum End {
    /// A step has no answer.
    NoAnswer(String),
    /// The text is not a walk on this structure.
    Error(ExplainError),
}

impl From<ExplainError> for End {
    fn from(error: ExplainError) -> Self {
        Self::Error(error)
    }
}

/// A walk that runs.
struct Walker<'m> {
    /// The name of the structure.
    structure: &'static str,
    mesh: &'m dyn RecordSource,
    probe: &'m Traced,
    row_bytes: &'m HashMap<String, usize>,
    words: &'static [Word],
    tables: Vec<RecordTable>,
    /// The rows that an edit moved, and the names of their elements.
    moved: Vec<[String; 2]>,
    /// The values of the variables; `None` for none.
    variables: BTreeMap<String, Option<RowName>>,
    steps: Vec<Step>,
    reads: Vec<RowReads>,
    results: Vec<String>,
    /// The current line.
    line: usize,
}

impl Walker<'_> {
    fn block(&mut self, statements: &[Statement]) -> Result<(), End> {
        statements
            .iter()
            .try_for_each(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Statement) -> Result<(), End> {
        self.line = statement.line;
        match &statement.kind {
            Kind::Assign(name, value) => {
                let value = self.value(value)?;
                self.variables.insert(name.clone(), value);
                Ok(())
            }
            Kind::Yield(value) => {
                let Some(row) = self.value(value)? else {
                    return Err(self.stopped(format!("{} is none", text(value))));
                };
                let row = row.to_string();
                let moved = self.moved.iter().find(|[at, _]| *at == row);
                let result = moved.map_or(row, |[_, name]| name.clone());
                let line = Some(self.line);
                self.results.push(result.clone());
                self.steps.push(Step::Yield { result, line });
                Ok(())
            }
            Kind::If {
                left,
                is_equal,
                right,
                then,
                otherwise,
            } => {
                let is_met = (self.value(left)? == self.value(right)?) == *is_equal;
                self.block(if is_met { then } else { otherwise })
            }
            Kind::Repeat(body) => self.repeat(body),
        }
    }

    /// Runs a loop until its variable has the first value again, or is none.
    fn repeat(&mut self, body: &[Statement]) -> Result<(), End> {
        let variable = loop_variable(body).unwrap_or_default();
        let first = match self.variables.get(variable) {
            Some(&Some(first)) => first,
            Some(None) => return Ok(()),
            None => return Err(self.stopped(format!("{variable} has no value before the loop"))),
        };
        let mut visited = HashSet::from([first]);
        loop {
            self.block(body)?;
            match self.variables.get(variable).copied().flatten() {
                None => return Ok(()),
                Some(row) if row == first => return Ok(()),
                Some(row) if !visited.insert(row) => {
                    return Err(self.stopped(format!(
                        "the loop never comes back to {first}: it is at {row} for the second time"
                    )));
                }
                Some(_) => {}
            }
        }
    }

    fn stopped(&self, reason: String) -> End {
        let reason = format!("line {}: {reason}", self.line + 1);
        End::NoAnswer(reason)
    }

    fn value(&mut self, value: &Value) -> Result<Option<RowName>, End> {
        match value {
            Value::None => Ok(None),
            Value::Name(name) => match self.variables.get(name) {
                Some(row) => Ok(*row),
                None => self.row(name).map(Some),
            },
            Value::Field(word, argument) => match self.value(argument)? {
                Some(row) => self.field(word, row),
                None => {
                    let (argument, whole) = (text(argument), text(value));
                    Err(self.stopped(format!("{argument} is none, so there is no {whole}")))
                }
            },
        }
    }

    /// Returns the row with this name, or of the element with this name.
    fn row(&self, name: &str) -> Result<RowName, End> {
        let moved_here = self.moved.iter().find(|[_, element]| element == name);
        let row = moved_here.map_or(name, |[row, _]| row);
        // The element was removed, and its row has another one.
        let is_removed = row == name && self.moved.iter().any(|[row, _]| row == name);
        let (letter, row) = row_name(row).unzip();
        let mut tables = self.tables.iter();
        let table = tables.find(|table| Some(table.letter) == letter);
        if let (Some(table), Some(row)) = (table, row)
            && !is_removed
            && self.mesh.own_fields(table.name, row as usize).is_some()
        {
            self.probe.take();
            let letter = table.letter;
            return Ok(RowName { letter, row });
        }
        let reason = match (table, row) {
            (Some(table), Some(_)) => {
                format!(
                    "{} has no {} {name} in this mesh",
                    self.structure, table.element
                )
            }
            _ => format!(
                "{name} has no value, and {} has no row of this name",
                self.structure
            ),
        };
        Err(ExplainError::BadWalk { reason }.into())
    }

    /// Reads a field of a row.
    fn field(&mut self, word: &str, row: RowName) -> Result<Option<RowName>, End> {
        let Some((table, place)) = self.find(word, row.letter) else {
            return self.alias(word, row);
        };
        let column = table.columns[place];
        self.probe.take();
        let record = match column.is_searched {
            true => self.mesh.fields(table.name, row.row as usize),
            false => self.mesh.own_fields(table.name, row.row as usize),
        };
        let searched = self.probe.take();
        let record = record.unwrap_or_default();
        let line = Some(self.line);
        if column.is_searched {
            for access in searched {
                let table = self.tables.iter().find(|table| table.name == access.table);
                if let Some(&table) = table {
                    let fields = self.stored(table, access.row);
                    let text = format!("to find {word} of {row}");
                    self.push(table, access.row, fields, text, line);
                }
            }
        } else if !column.is_derived {
            let fields = stored_fields(&table, &record);
            self.push(
                table,
                row.row as usize,
                fields,
                format!("{word}({row})"),
                line,
            );
        }
        match record.get(place) {
            Some(Field::Row(to)) => Ok(Some(*to)),
            Some(Field::None) => Ok(None),
            Some(_) => {
                let reason = format!("{word}({row}) is no row");
                Err(ExplainError::BadWalk { reason }.into())
            }
            None => Err(self.stopped(format!("{row} was deleted"))),
        }
    }

    fn stored(&self, table: RecordTable, row: usize) -> Vec<(&'static str, String)> {
        let record = self.mesh.own_fields(table.name, row).unwrap_or_default();
        self.probe.take();
        stored_fields(&table, &record)
    }

    fn push(
        &mut self,
        table: RecordTable,
        row: usize,
        fields: Vec<(&'static str, String)>,
        text: String,
        line: Option<usize>,
    ) {
        // A program that has just read a row still has all of its fields.
        if let Some(last) = self.reads.last()
            && (last.table, last.rows.start) == (table.name, row)
        {
            return;
        }
        let bytes = self.row_bytes.get(table.name).copied().unwrap_or(0);
        self.reads.push(RowReads {
            table: table.name,
            rows: row..row + 1,
            bytes,
        });
        self.steps.push(Step::Read(Read {
            table: table.name,
            row: format!("{}{row}", table.letter),
            rows: 1,
            bytes,
            fields,
            reason: Reason {
                way: "walk",
                of: None,
                text,
            },
            line,
        }));
    }

    /// Returns the table and the column that a word names: the name of a column, or of a table with one
    /// column.
    fn find(&self, word: &str, letter: &str) -> Option<(RecordTable, usize)> {
        let tables = self.tables.iter().filter(|table| table.letter == letter);
        let of_column = |table: &RecordTable| {
            let column = table
                .columns
                .iter()
                .position(|column| as_word(column.name) == word);
            column.map(|column| (*table, column))
        };
        let of_table = |table: &&RecordTable| table.name == word && table.columns.len() == 1;
        let mut columns = tables.clone().filter_map(of_column);
        let mut names = tables.filter(of_table).map(|table| (*table, 0));
        columns.next().or_else(|| names.next())
    }

    /// Evaluates a word that stands for several fields, such as `target` for `origin(twin(x))`.
    fn alias(&mut self, word: &str, row: RowName) -> Result<Option<RowName>, End> {
        let words = self.words.iter().filter(|known| known.letter == row.letter);
        let Some(known) = words.clone().find(|known| known.name == word) else {
            let tables = self
                .tables
                .iter()
                .filter(|table| table.letter == row.letter);
            let is_row = |column: &&Column| column.name != Column::POSITION.name;
            let columns = tables
                .clone()
                .flat_map(|table| table.columns.iter().filter(is_row));
            let mut names: Vec<String> = columns.map(|column| as_word(column.name)).collect();
            let single = tables.filter(|table| table.columns.len() == 1);
            names.extend(single.map(|table| table.name.to_owned()));
            names.retain(|name| name != "positions");
            names.extend(words.map(|word| word.name.to_owned()));
            if names.is_empty() {
                let (structure, letter) = (self.structure, row.letter);
                let reason = format!(
                    "{structure} stores no fields of {letter}, so there is no {word}({row})"
                );
                return Err(ExplainError::BadWalk { reason }.into());
            }
            return Err(ExplainError::from(UnknownName::new("field", word, names)).into());
        };
        // The steps of the word are those of the line that uses it.
        let Program { statements, .. } = parse(&format!("x = {}", known.means))?;
        let [
            Statement {
                kind: Kind::Assign(name, value),
                ..
            },
        ] = statements.as_slice()
        else {
            unreachable!("one assignment was written above")
        };
        let hidden = self.variables.insert(name.clone(), Some(row));
        let result = self.value(value);
        match hidden {
            Some(hidden) => self.variables.insert(name.clone(), hidden),
            None => self.variables.remove(name),
        };
        result
    }
}

/// Returns a name of a column as a word: `left next` is `left_next`.
fn as_word(name: &str) -> String {
    name.replace([' ', '-'], "_")
}

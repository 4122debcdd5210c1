//! The records of an indexed face set, as textbooks show them.

use sixfold_core::{
    Column, Described, Editing, Element, Field, HoleSet, Line, Probe, RecordTable, Relation,
    RowName,
};
use sixfold_scanning::algorithm_of;

use crate::mesh::IndexedFaceSet;

impl<P: Probe, E: Editing> Described for IndexedFaceSet<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        let positions = RecordTable {
            name: "positions",
            element: "vertex",
            letter: "v",
            rows: self.positions.len(),
            columns: &[Column::POSITION],
        };
        let mut tables = vec![positions];
        tables.extend(self.faces.record_tables());
        tables
    }

    fn record(&self, table: &str, row: usize, _walks: bool) -> Option<Vec<Field>> {
        match table {
            "positions" if self.vertex_holes.has(row) => None,
            "positions" => Some(vec![Field::Point(*self.positions.rows().get(row)?)]),
            _ => self.faces.record(table, row, |v| Field::row("v", v)),
        }
    }

    fn rows_of(&self, element: Element<Self>) -> Vec<RowName> {
        match element {
            Element::Vertex(v) => vec![RowName::new("v", v)],
            Element::Edge(e) => e.ends().map(|v| RowName::new("v", v)).to_vec(),
            Element::Face(f) => vec![RowName::new("f", f)],
        }
    }

    fn algorithm(relation: Relation) -> &'static [Line] {
        algorithm_of(relation)
    }
}
